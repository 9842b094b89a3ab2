"""The fields of a kind of signal are those that the ontologies give it and the kinds of signals above it."""

from __future__ import annotations

import pytest

from selfconf import files, library
from selfconf.model.signal_fields import SignalField
from selfconf.model.term import IRI, XSD_NAMESPACE
from selfconf.rdf.signal_fields import SAYING, fields_of
from selfconf.rdf.turtle import parse
from selfconf.rdf.vocabulary import ROB, TYPE
from sim import signals
from tests.lab import PREFIXES, iri

DOUBLE = IRI(XSD_NAMESPACE + "double")
BELL = (
    ":Signal rob:field ( [ rob:fieldName 'at' ; rob:datatype xsd:dateTime ; rob:optional true ] ) .\n"
    ":Bell rdfs:subClassOf :Signal ; rob:field ( [ rob:fieldName 'rings' ; rob:datatype xsd:short ; rob:repeated true ]"
    " [ rob:fieldName 'loud' ; rob:datatype xsd:double ] ) .\n"
)


def described(text: str, kind: str) -> tuple[SignalField, ...] | None:
    """The fields of a kind of signal in a text."""
    found = fields_of([parse(PREFIXES + text, "a.ttl", predicates=SAYING)], iri(kind))
    return None if found is None else found.fields


def test_a_kind_of_signal_has_its_own_fields_and_those_of_the_kinds_above_it() -> None:
    assert described(BELL, "Bell") == (
        SignalField("rings", IRI(XSD_NAMESPACE + "short"), repeated=True),
        SignalField("loud", DOUBLE),
        SignalField("at", IRI(XSD_NAMESPACE + "dateTime"), required=False),
    )


def test_of_two_fields_of_one_name_the_nearer_one_counts() -> None:
    more = ":Carillon rdfs:subClassOf :Bell ; rob:field ( [ rob:fieldName 'loud' ; rob:datatype xsd:int ] ) ."
    found = described(BELL + more, "Carillon") or ()
    assert [one.name for one in found] == ["loud", "rings", "at"]
    assert found[0].datatype == XSD_NAMESPACE + "int"


def test_of_a_kind_without_fields_nothing_is_known() -> None:
    assert described(BELL, "Other") is None
    assert described(":Other rdfs:subClassOf :More . :More rdfs:subClassOf :Other .", "Other") is None


@pytest.mark.parametrize(
    "wrong",
    [
        "'text'",
        "( [ rob:fieldName 'x' ] )",
        "( [ rob:datatype xsd:int ] )",
        "[]",
        "( [ rob:fieldName :x ; rob:datatype 3 ] )",
    ],
)
def test_what_is_not_in_order_is_passed_over(wrong: str) -> None:
    assert described(f":Bell rob:field {wrong} .", "Bell") is None


def test_a_component_may_describe_its_own_kind_of_signal_below_one_that_ships() -> None:
    own = parse(PREFIXES + ":Scan rdfs:subClassOf rob:RangeScan .", "a.ttl")
    shipped = [parse(path.read_bytes(), path.name, "urn:x:", SAYING) for path in library.ontologies()]
    found = fields_of([own, *shipped], iri("Scan"))
    assert found is not None
    assert [one.name for one in found.fields] == ["angles", "ranges", "max_range"]


@pytest.mark.parametrize("name", ["PlanarPose2D", "Velocity2D", "Odometry2D", "RangeScan", "Audio"])
def test_the_signals_of_the_worlds_have_the_fields_of_their_kind(name: str) -> None:
    found = files.signal_fields(library.ontologies(), [ROB[name]])[ROB[name]]
    assert {one.name for one in found.fields} == set(getattr(signals, name).__annotations__)


def test_every_kind_of_signal_that_ships_has_fields() -> None:
    documents = [parse(path.read_bytes(), path.name, "urn:x:") for path in library.ontologies()]
    (robotics,) = [document for document in documents if document.source == "robotics.ttl"]
    kinds = [kind for kind in robotics.statements if robotics.values(kind, ROB.field)]
    assert len(kinds) > 5
    for kind in kinds:
        assert isinstance(kind, IRI)
        assert robotics.values(kind, TYPE)
        assert fields_of(documents, kind) is not None
