"""What the shape of a role asks of ports, in the ways in which SHACL says it."""

from __future__ import annotations

import pytest

from selfconf.model.port_likeness import WantedPorts
from selfconf.model.term import IRI
from selfconf.rdf.eligibility.wanted_signals import required_signals, wanted_ports, without_port_shapes
from selfconf.rdf.turtle import Document
from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.vocabulary import SC, SH
from tests.lab import PREFIXES

ROLE, PRICE, TAX, CAR = (IRI(f"https://example.org/peis-home#{name}") for name in ("r", "Price", "Tax", "Car"))
OF_TYPE = "[ sh:property [ sh:path sc:signalType ; sh:hasValue :Price ] ]"
BELOW = "[ sh:zeroOrMorePath rdfs:subClassOf ]"


def role(shape: str) -> Document:
    return turtle.parse(f"{PREFIXES} :r a sc:Role ; sh:class :Service ; {shape} .", "t.ttl")


def wanted(shape: str) -> WantedPorts | None:
    return wanted_ports(role(shape), ROLE)


@pytest.mark.parametrize(
    "shape",
    [
        "sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:hasValue :Price ]",
        f"sh:property [ sh:path ( sc:hasOutput sc:signalType {BELOW} ) ; sh:hasValue :Price ]",
        "sh:property [ sh:path sc:hasOutput ; sh:property [ sh:path sc:signalType ; sh:in ( :Price ) ] ]",
        f"sh:property [ sh:path sc:hasOutput ; sh:qualifiedMinCount 1 ; sh:qualifiedValueShape {OF_TYPE} ]",
        "sh:and ( [ sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:hasValue :Price ] ] )",
        "sh:node [ sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:hasValue :Price ] ]",
    ],
)
def test_an_output_is_asked_for_in_many_ways(shape: str) -> None:
    assert wanted(shape) == WantedPorts(((PRICE,),), None)
    rest = without_port_shapes(role(shape), ROLE)
    assert wanted_ports(rest, ROLE) is None
    assert rest.values(ROLE, SH["class"])


def test_inputs_and_outputs_are_told_apart_and_alternatives_are_one_want() -> None:
    found = wanted(
        "sh:property [ sh:path ( sc:hasInput sc:signalType ) ; sh:hasValue :Car ] ;"
        " sh:or ( [ sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:hasValue :Price ] ]"
        " [ sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:hasValue :Tax ] ] )"
    )
    assert found == WantedPorts(((PRICE, TAX),), ((CAR,),))


@pytest.mark.parametrize(
    "shape",
    [
        "sh:property [ sh:path :room ; sh:hasValue :Price ]",
        "sh:property [ sh:path ( sc:hasOutput sc:name ) ; sh:hasValue 'out' ]",
        "sh:not [ sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:hasValue :Price ] ]",
        "sh:or ( [ sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:hasValue :Price ] ] [ sh:class :Shop ] )",
        "sh:node [ ]",
    ],
)
def test_other_shapes_ask_for_no_signal(shape: str) -> None:
    assert wanted(shape) is None


@pytest.mark.parametrize(
    ("path", "required"),
    [
        ("( sc:hasOutput sc:signalType )", True),
        ("( sc:hasOutput sc:signalType rdfs:subClassOf )", True),
        (f"( sc:hasOutput sc:signalType {BELOW} )", True),
        ("( sc:hasOutput sc:signalType :like )", False),
        ("( sc:hasOutput :like )", False),
        ("( :like sc:signalType )", False),
        ("sc:hasOutput", False),
    ],
)
def test_a_type_is_required_of_a_port_where_a_path_leads_to_types_of_ports_and_upward(
    path: str, required: bool
) -> None:
    found = required_signals(role(f"sh:property [ sh:path {path} ; sh:hasValue :Price ]"), ROLE)
    assert found == (((SC.hasOutput, PRICE),) if required else ())


def test_a_shape_within_itself_ends() -> None:
    text = f"{PREFIXES} :r a sc:Role ; sh:node :s . :s sh:node :s ; sh:property [ sh:path sc:hasOutput ; sh:node :s ] ."
    assert wanted_ports(turtle.parse(text, "t.ttl"), ROLE) is None
