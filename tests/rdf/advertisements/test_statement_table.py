"""The table of statements: each is made once, knows what it says, and is suspect where only care can tell."""

from __future__ import annotations

import pytest

from selfconf.model.profile import Input
from selfconf.model.term import IRI, Literal
from selfconf.rdf.advertisements.statement_table import NotInlinableError, StatementTable, bracketed, links
from selfconf.rdf.permitted_fields import NEXT
from selfconf.rdf.vocabulary import OWL, RDFS, SC, TYPE

INPUT = f"<{SC.hasInput}>"
PORT = bracketed(INPUT, [f'<{SC.name}> "pose"', f"<{SC.signalType}> <urn:x:Pose>"])


def test_the_same_text_is_the_same_statement() -> None:
    table = StatementTable()
    assert table[PORT] is table[PORT]
    assert len(table) == 1


def test_a_statement_with_a_port_adds_it_to_a_profile() -> None:
    statement = StatementTable()[PORT]
    assert statement.read().inputs == (Input("pose", (IRI("urn:x:Pose"),)),)
    assert statement.bracketed


def test_a_statement_with_several_values_states_several_properties() -> None:
    table = StatementTable()
    statement = table['<urn:x:p> "b" , "a"']
    assert statement.properties == ((IRI("urn:x:p"), Literal("a")), (IRI("urn:x:p"), Literal("b")))
    assert not statement.bracketed
    assert not table.suspects


def test_two_ports_of_one_name_take_one_slot_and_those_of_two_names_take_two() -> None:
    table = StatementTable()
    other = table[PORT.replace("urn:x:Pose", "urn:x:Scan")]
    assert table[PORT].slot is other.slot
    assert table[PORT].slot is not table[PORT.replace('"pose"', '"scan"')].slot
    assert table[PORT].slot is table.slot(INPUT, "pose")


def test_a_property_may_be_stated_again_and_a_preference_may_not() -> None:
    table = StatementTable()
    assert table["<urn:x:p> 1"].slot is not table["<urn:x:p> 2"].slot
    assert table[f"<{SC.preference}> 1"].slot is table[f"<{SC.preference}> 2"].slot


@pytest.mark.parametrize(
    "text",
    [
        f"<{RDFS.subClassOf}> <urn:x:Light>",
        f"a <urn:x:Lamp> , <{OWL.Class}>",
        f'<{SC.preference}> "high"',
        bracketed(INPUT, [f'<{SC.name}> ""']),
        f"{INPUT} <urn:x:port>",
    ],
)
def test_what_only_the_careful_reader_can_judge_is_suspect(text: str) -> None:
    table = StatementTable()
    statement = table[text]
    assert table.suspects == {statement}


def test_a_component_inside_another_one_is_not_inlined() -> None:
    with pytest.raises(NotInlinableError):
        StatementTable()[bracketed("<urn:x:p>", [f"a <{SC.Component}>"])]


def test_all_types_of_a_subject_become_one_statement_in_the_place_of_the_first() -> None:
    table = StatementTable()
    said = [table["<urn:x:p> 1"], table["a <urn:x:A>"], table["<urn:x:q> 1"], table["a <urn:x:B>"]]
    table.typed(said)
    assert [statement.text for statement in said] == ["<urn:x:p> 1", "a <urn:x:A> , <urn:x:B>", "<urn:x:q> 1"]
    assert said[1].types == {IRI("urn:x:A"), IRI("urn:x:B")}
    assert said[1].slot is TYPE


def test_what_brackets_say_is_written_between_them() -> None:
    assert bracketed("<urn:x:p>", ["<urn:x:q> 1", "<urn:x:r> 2"]) == f"<urn:x:p> [ <urn:x:q> 1{NEXT}<urn:x:r> 2 ]"


@pytest.mark.parametrize(
    ("text", "names"),
    [
        (f"{INPUT} <urn:x:a> , <urn:x:b> , <urn:x:a>", ["<urn:x:a>", "<urn:x:b>"]),
        (PORT, []),
        ("<urn:x:p> <urn:x:a>", []),
        (f'{INPUT} "a"', []),
    ],
)
def test_only_links_to_ports_and_groundings_with_names_are_links(text: str, names: list[str]) -> None:
    assert list(links(text.partition(" ")[0], text)) == names
