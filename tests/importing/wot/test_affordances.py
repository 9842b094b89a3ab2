"""The properties, events and actions of a thing as ports and operations."""

from __future__ import annotations

from typing import Any

import pytest

from selfconf.errors import AuthorError
from selfconf.importing.imported import TRUE, ImportedOperation, ImportedPort
from selfconf.importing.ledger import ImportLedger
from selfconf.importing.sources import SourceDocument
from selfconf.importing.wot.affordances import AffordanceReader
from selfconf.importing.wot.contexts import TermMeanings
from selfconf.model.term import IRI, Literal
from selfconf.rdf.vocabulary import UNIT, XSD

A, B = IRI("urn:x:A"), IRI("urn:x:B")


class Reading:
    """The affordances of a thing, as they are read, and what was left out."""

    def __init__(self, **thing: Any) -> None:
        self.ledger = ImportLedger("urn:x:", list[AuthorError]().append)
        context = ["https://www.w3.org/2022/wot/td/v1.1", {"x": "urn:x:", "sc": "https://w3id.org/selfconf#"}]
        reader = AffordanceReader(TermMeanings(context), self.ledger, SourceDocument("lamp", "lamp", b""))
        self.ports, self.operations = list(reader.ports(thing)), list(reader.operations(thing))

    @property
    def left_out(self) -> dict[str, int]:
        return {each.what: each.number for each in self.ledger.omissions()}


def test_a_property_is_an_output_and_an_input_that_may_stay_unfed() -> None:
    assert Reading(properties={"t": {"@type": ["x:A", "x:B"], "unit": "°C"}}).ports == [
        ("output", ImportedPort("t", (A, B), UNIT.DEG_C)),
        ("input", ImportedPort("t", (A, B), UNIT.DEG_C, optional=True)),
    ]


@pytest.mark.parametrize("name", ["", "f()", "a\tb", "a\u202eb"])
def test_what_has_a_name_that_no_port_has_is_left_out(name: str) -> None:
    reading = Reading(properties={name: {}, "t": {}})
    assert {port.name for _, port in reading.ports} == {"t"}
    assert reading.left_out["properties without a name, or that are no object"] == 1


@pytest.mark.parametrize(
    ("affordance", "kinds"),
    [
        ({"readOnly": True}, ["output"]),
        ({"writeOnly": True}, ["input"]),
        ({"readOnly": True, "writeOnly": True}, []),
        ({"forms": [{"op": "readproperty"}, {"op": ["observeproperty", "unobserveproperty"]}]}, ["output"]),
        ({"forms": [{"op": "writeproperty"}]}, ["input"]),
        ({"forms": [{"op": "writeproperty"}, {}]}, ["output", "input"]),
        ({"forms": [{"op": ["readproperty", "writeproperty"]}], "readOnly": True}, ["output"]),
    ],
    ids=range(7),
)
def test_whether_a_property_can_be_read_and_written(affordance: dict[str, Any], kinds: list[str]) -> None:
    reading = Reading(properties={"t": affordance})
    assert [kind for kind, _ in reading.ports] == kinds
    assert ("properties that can be neither read nor written" in reading.left_out) == (not kinds)


def test_an_event_is_an_output_of_its_own_types_or_those_of_its_data() -> None:
    events = {"a": {"@type": "x:A", "data": {"@type": "x:B"}}, "b": {"data": {"@type": "x:B", "unit": "lux"}}, "c": {}}
    assert [port for _, port in Reading(events=events).ports] == [
        ImportedPort("a", (A,)), ImportedPort("b", (B,), UNIT.LUX), ImportedPort("c"),
    ]  # fmt: skip


def test_an_event_with_the_name_of_a_property_gets_another() -> None:
    """The W3C has names differ within properties and within events; two outputs of one name would not conform."""
    reading = Reading(
        properties={"a": {"writeOnly": True}, "b": {"readOnly": True}, "event b": {"readOnly": True}},
        events={"a": {}, "b": {"@type": "x:A"}, "event a": {}, "c": {}},
    )
    assert [port.name for kind, port in reading.ports if kind == "output"] == [
        "b", "event b", "event event a", "event event b", "event a", "c",
    ]  # fmt: skip
    assert next(port.types for _, port in reading.ports if port.name == "event event b") == (A,)


def test_forms_that_are_none_are_not_said_to_be_left_out() -> None:
    assert Reading(properties={"a": {"forms": []}}).left_out == {}


def test_an_action_is_an_operation_asked_for_by_its_input_or_its_own_type() -> None:
    actions = {
        "a": {"@type": "x:A", "output": {"@type": "x:B"}},
        "b": {"@type": "x:A", "input": {"@type": ["x:B", "x:A"]}},
        "c": {},
    }
    reading = Reading(actions=actions)
    assert reading.operations == [ImportedOperation("a", A, B), ImportedOperation("b", B), ImportedOperation("c")]
    assert reading.left_out == {"further types of requests and responses": 1}


def test_what_is_unknown_is_left_out_and_the_port_is_kept() -> None:
    reading = Reading(
        properties={
            "t": {"@type": ["y:A", "A", 5, "PropertyAffordance", "xsd:float"], "unit": "furlong", "readOnly": True}
        }
    )
    assert reading.ports == [("output", ImportedPort("t"))]
    assert reading.left_out == {
        "terms with the prefix y:": 1,
        "terms without a prefix": 1,
        "types that are no strings": 1,
        "types of the W3C's vocabulary": 1,
        "datatypes as types": 1,
        "the unit 'furlong'": 1,
    }


def test_a_unit_may_be_a_term_of_a_context() -> None:
    ledger = ImportLedger("urn:x:", list[AuthorError]().append)
    meanings = TermMeanings({"q": "http://qudt.org/vocab/unit/"})
    reader = AffordanceReader(meanings, ledger, SourceDocument("lamp", "lamp", b""))
    assert [port.unit for _, port in reader.ports({"events": {"e": {"data": {"unit": "q:LUX"}}}})] == [UNIT.LUX]


@pytest.mark.parametrize(
    "thing", [{"properties": []}, {"properties": {"": {}}}, {"events": {"e": 5}}, {"actions": "x"}]
)
def test_what_is_no_affordance_is_left_out(thing: dict[str, Any]) -> None:
    reading = Reading(**thing)
    assert reading.ports == reading.operations == []
    assert sum(reading.left_out.values()) == 1


def test_what_has_no_counterpart_is_counted() -> None:
    reading = Reading(
        properties={"t": {"forms": [{}, {}], "title": "T", "minimum": 0, "readOnly": True}},
        actions={"a": {"forms": {}, "input": {"unit": "m", "type": "number"}, "safe": True, "synchronous": True}},
    )
    assert reading.left_out == {
        "forms": 3,
        "titles and descriptions of affordances": 1,
        "data schemas": 2,
        "units of actions": 1,
        "marks of affordances, such as observable": 2,
    }


def test_what_an_affordance_says_in_other_vocabularies_is_said_of_its_port_or_operation() -> None:
    reading = Reading(
        properties={"t": {"x:A": 0.5, "x:B": {"@id": "urn:b"}, "sc:depth": 3, "z": 1}},
        events={"e": {"x:A": 1, "data": {"x:B": True}}},
        actions={"a": {"x:A": "soon", "output": {"x:B": 2, "type": "object"}}},
    )
    said = (A, Literal("0.5", XSD.double)), (B, IRI("urn:b"))
    assert reading.ports == [
        ("output", ImportedPort("t", properties=said)),
        ("input", ImportedPort("t", optional=True, properties=said)),
        ("output", ImportedPort("e", properties=((A, Literal("1", XSD.integer)), (B, TRUE)))),
    ]
    assert reading.operations == [ImportedOperation("a", properties=((A, Literal("soon")),))]
    assert reading.left_out == {
        "terms of selfconf": 1,
        "terms without a prefix": 1,
        "values of other vocabularies at requests and responses": 1,
        "data schemas": 1,
    }


def test_a_rate_that_is_none_is_left_out_with_its_number() -> None:
    said = {"https://w3id.org/selfconf#rate": {"https://w3id.org/selfconf#value": 0}}
    assert Reading(properties={"a": said}).left_out == {"rates that promise nothing": 1}
