"""What importers yield: components as advertisements."""

from __future__ import annotations

from selfconf.importing.imported import (
    ImportedComponent,
    ImportedDocument,
    ImportedOperation,
    ImportedPort,
    NestedNode,
    Omission,
    Renaming,
)
from selfconf.model.term import IRI, Literal
from selfconf.rdf.vocabulary import ROB, SC, TYPE, UNIT, XSD

LAMP = IRI("urn:x:lamp")


def test_a_component_states_its_kind_first_and_nothing_that_it_does_not_have() -> None:
    description = ImportedComponent(LAMP, (ROB.Sensor,), outputs=(ImportedPort("on", (ROB.Switch,)),)).described()
    assert [predicate for predicate, _ in description.statements] == [TYPE, SC.hasOutput]
    assert description.values(TYPE) == (SC.Component, ROB.Sensor)


def test_a_port_keeps_all_its_types_its_unit_and_whether_it_may_stay_unfed() -> None:
    port = ImportedPort("t", (ROB.Temperature, ROB.Signal), UNIT.DEG_C, optional=True, depth=3)
    assert port.node() == NestedNode(
        (
            (SC.name, (Literal("t"),)),
            (SC.signalType, (ROB.Temperature, ROB.Signal)),
            (SC.unit, (UNIT.DEG_C,)),
            (SC.depth, (Literal("3", XSD.integer),)),
            (SC.optional, (Literal("true", XSD.boolean),)),
        )
    )


def test_a_port_without_a_type_is_a_name() -> None:
    assert ImportedPort("t").node() == NestedNode(((SC.name, (Literal("t"),)),))


def test_an_operation_has_a_request_and_a_response_where_they_are_known() -> None:
    node = ImportedOperation("toggle", response=ROB.Switch).node()
    assert [predicate for predicate, _ in node.statements] == [SC.name, SC.response]


def test_a_document_knows_which_of_its_subjects_are_components() -> None:
    lamp = ImportedComponent(LAMP, (ROB.Sensor,)).described()
    document = ImportedDocument("lamp", "lamp.json", (lamp,))
    assert list(document.subjects(SC.Component)) == [lamp]
    assert list(document.subjects(SC.Template)) == []


def test_what_is_left_out_and_what_is_renamed_are_sentences() -> None:
    assert str(Omission("forms", "they are not needed", ("a", "b"), 3)) == (
        "left out forms (3): they are not needed; in a and b"
    )
    assert str(Omission("forms", "why", ("a", "b", "c"), 3)).endswith("in a, b and c")
    assert str(Omission("forms", "why", ("a", "b", "c", "d"), 4)).endswith("in a, b and 2 others")
    renamed = Renaming(IRI("urn:x:lamp-2"), LAMP, "b.json")
    assert str(renamed) == f"b.json: another component is called {LAMP} already; here it is called urn:x:lamp-2"
