"""Statements that are recognised without parsing say what the careful reader reads of them; others are left to it."""

from __future__ import annotations

from decimal import Decimal

import pytest

from selfconf.model.profile import Input, OperationalParameter, Output, Ports, Profile
from selfconf.model.term import IRI, Literal, Term
from selfconf.rdf.advertisements.recognition import SUBJECT, port_of, ported, property_of, setting_of
from selfconf.rdf.advertisements.statement_table import WrittenStatement
from selfconf.rdf.permitted_fields import NEXT
from selfconf.rdf.vocabulary import RDF, SC, UNIT, XSD

TYPE = IRI("urn:x:Pose")
NAME, SIGNAL, KIND = f'<{SC.name}> "pose"', f"<{SC.signalType}> <{TYPE}>", f"<{SC.parameterType}> <{TYPE}>"
HERTZ = f"<{SC.rate}> [ <{SC.value}> 2.5{NEXT}<{SC.unit}> <{UNIT.HZ}> ]"
IN, OUT, PARAMETER = f"<{SC.hasInput}>", f"<{SC.hasOutput}>", f"<{SC.hasParameter}>"


def port(link: str, *said: str) -> Profile | Ports | None:
    """What a statement with one port adds to a profile, if it is recognised."""
    text = f"{link} [ {NEXT.join(said)} ]"
    found = port_of(link, text)
    return None if found is None else ported(link, found)


def carefully(text: str) -> Profile:
    """What the careful reader makes of a statement."""
    return WrittenStatement(text.partition(" ")[0], text).carefully()[0]


@pytest.mark.parametrize(
    ("link", "said", "part"),
    [
        (IN, (NAME, SIGNAL), Ports(inputs=(Input("pose", (TYPE,)),))),
        (IN, (NAME, SIGNAL, f"<{SC.depth}> 3"), Ports(inputs=(Input("pose", (TYPE,), 3),))),
        (OUT, (SIGNAL, NAME), Ports(outputs=(Output("pose", (TYPE,)),))),
        (OUT, (NAME, SIGNAL, HERTZ), Ports(outputs=(Output("pose", (TYPE,), 2.5),))),
        (PARAMETER, (NAME, KIND), Profile(SUBJECT, parameters=(OperationalParameter("pose", TYPE),))),
    ],
)
def test_a_port_in_order_is_recognised(link: str, said: tuple[str, ...], part: Profile | Ports) -> None:
    assert port(link, *said) == part
    careful = carefully(f"{link} [ {NEXT.join(said)} ]")
    parameters = part.parameters if isinstance(part, Profile) else ()
    assert (Ports(part.inputs, part.outputs), parameters) == (careful.ports, careful.parameters)


@pytest.mark.parametrize(
    ("link", "said"),
    [
        (IN, (NAME,)),
        (IN, (NAME, NAME, SIGNAL)),
        (IN, (NAME, SIGNAL, f"<{SC.depth}> 0")),
        (OUT, (NAME, SIGNAL, f"<{SC.depth}> 3")),
        (OUT, (NAME, SIGNAL, f"<{SC.rate}> 5")),
        (OUT, (f'<{SC.name}> ""', SIGNAL)),
        ("<urn:x:port>", (NAME, SIGNAL)),
    ],
)
def test_a_port_that_is_not_in_order_is_left_to_the_careful_reader(link: str, said: tuple[str, ...]) -> None:
    assert port(link, *said) is None


@pytest.mark.parametrize(
    ("predicate", "value", "profile"),
    [
        (SC.preference, "-2.5", Profile(SUBJECT, preference=Decimal("-2.5"))),
        (SC.shareable, "true", Profile(SUBJECT, shareable=True)),
        (SC.restarts, "3", Profile(SUBJECT, restarts=3)),
        (
            SC.deadline,
            f"[ <{SC.value}> 2.5{NEXT}<{SC.unit}> <{UNIT.SEC}> ]",
            Profile(SUBJECT, deadline=2.5),
        ),
        (SC.grounding, f'[ <{SC.command}> "lamp --on" ]', Profile(SUBJECT, command="lamp --on")),
    ],
)
def test_a_setting_in_order_is_recognised(predicate: IRI, value: str, profile: Profile) -> None:
    assert setting_of(f"<{predicate}>", f"<{predicate}> {value}") == profile


@pytest.mark.parametrize(
    ("predicate", "value"),
    [
        (SC.preference, '"high"'),
        (SC.preference, "1 , 2"),
        (SC.restarts, "-1"),
        (SC.shareable, '"yes"'),
        (SC.grounding, f'[ <{SC.command}> "" ]'),
    ],
)
def test_a_setting_that_is_not_in_order_is_left_to_the_careful_reader(predicate: IRI, value: str) -> None:
    assert setting_of(f"<{predicate}>", f"<{predicate}> {value}") is None


@pytest.mark.parametrize(
    ("written", "value"),
    [
        ("<urn:x:hall>", IRI("urn:x:hall")),
        ('"hall"', Literal("hall")),
        ('""', Literal("")),
        ('"hall"@en-gb', Literal("hall", RDF.langString, "en-gb")),
        ('"7"^^<urn:x:t>', Literal("7", IRI("urn:x:t"))),
        ("-7", Literal("-7", XSD.integer)),
        ("+.5", Literal("+.5", XSD.decimal)),
    ],
)
def test_a_property_with_one_value_is_recognised_as_it_is_read(written: str, value: Term) -> None:
    found = property_of(f"<urn:x:p> {written}")
    assert found == (IRI("urn:x:p"), value)
    assert [found] == list(carefully(f"<urn:x:p> {written}").properties)


@pytest.mark.parametrize("written", ["1 , 2", '"a\\"b"', "1e3", "true", "[ <urn:x:q> 1 ]", "( 1 )"])
def test_a_property_of_another_form_is_left_to_the_careful_reader(written: str) -> None:
    assert property_of(f"<urn:x:p> {written}") is None
