"""Lints about what flows in a template: loops that come to nothing, inputs that nobody feeds."""

from __future__ import annotations

import pytest

from selfconf.model.codes import PREAMBLE
from tests.rdf.validation.lints.linted_text import lints, only

LOOP = """
:t a sc:Template ; sc:roles ( :one :two :three ) .
:one a sc:Role ; sh:class rob:Camera ; sc:feeds :two .
:two a sc:Role ; sh:class rob:Controller .
:three a sc:Role ; sh:class rob:Display .
"""
PAIR = """
:t a sc:Template ; sc:roles ( :source :sink ) .
:source a sc:Role ; sh:class rob:Camera .
:sink a sc:Role ; sh:class rob:Display .
"""
FED = ":source sc:feeds :sink ."
WANTS = ":sink sh:property [ sh:path ( sc:hasInput sc:signalType ) ; sh:hasValue rob:Image ] ."

OPTIONAL = "[ sh:path sc:optional ; sh:hasValue true ]"


def asks(role: str, link: str, port: str) -> str:
    """A role that asks for a port by a shape of its own."""
    shape = f"sh:qualifiedMinCount 1 ; sh:qualifiedValueShape [ {port} ]"
    return f"{role} sh:property [ sh:path {link} ; {shape} ] .\n"


def typed(signal: str) -> str:
    return f"sh:property [ sh:path sc:signalType ; sh:hasValue {signal} ]"


def codes(text: str) -> list[str]:
    return [each.code for each in lints(text)]


@pytest.mark.parametrize(
    ("more", "found"),
    [
        (":two sc:feeds :one .", ["SC-L12"]),
        (":two sc:feeds :two .", ["SC-L12"]),
        ("[] a sc:Interaction ; sc:from :two ; sc:to :one .", ["SC-L12"]),
        (":two sc:feeds :three .", []),
        (":two sc:feeds :one, :three .", []),
        (":two sc:feeds :one . :three sc:feeds :one .", ["SC-L12"]),
        (":two sc:feeds :three . :three sc:feeds :one .", []),  # the display is an actuator
        (":two sh:class :Oracle ; sc:feeds :one .", []),  # who knows what an oracle does
        (":two sc:feeds :one . :t sc:hasOutput [ sc:name 'o' ; sc:signalType rob:Image ; sc:of :two ] .", []),
        (":two sc:feeds :one . :t sc:hasOperation [ sc:name 'o' ; sc:response rob:Image ; sc:of :one ] .", []),
        (":two sc:feeds :one . :t sc:hasInput [ sc:name 'i' ; sc:signalType rob:Image ; sc:of :one ] .", ["SC-L12"]),
    ],
)
def test_a_loop_has_to_act_on_the_world_or_to_feed_a_role(more: str, found: list[str]) -> None:
    assert codes(LOOP + more) == found


def test_a_role_without_a_class_may_be_an_actuator() -> None:
    assert "SC-L12" not in codes(":t a sc:Template ; sc:roles ( :any ) . :any a sc:Role ; sc:feeds :any .")


def test_a_loop_is_shown_where_it_closes() -> None:
    text = LOOP + ":two sc:feeds :one ."
    found = only(text)
    assert (PREAMBLE + text).splitlines()[found.line - 1][found.column - 1 :] == ":one ."


@pytest.mark.parametrize(
    ("more", "found"),
    [
        (WANTS, ["SC-L13"]),
        (WANTS + FED, []),
        (asks(":sink", "sc:hasInput", typed("rob:Image")), ["SC-L13"]),
        (asks(":sink", "sc:hasInput", typed("rob:Image")) + FED, []),
        (WANTS + FED + asks(":source", "sc:hasOutput", typed("rob:Text")), ["SC-L13"]),
        (WANTS + FED + asks(":source", "sc:hasOutput", typed("rob:Image")), []),
        (WANTS + FED + ":source sh:property [ sh:path sc:hasOutput ; sh:maxCount 0 ] .", ["SC-L13"]),
        (WANTS + FED + ":source sh:property [ sh:path sc:hasOutput ; sh:minCount 1 ] .", []),
        (FED + ":sink sh:property [ sh:path sc:hasInput ; sh:minCount 1 ] .", []),
        (":sink sh:property [ sh:path sc:hasInput ; sh:minCount 1 ] .", ["SC-L13"]),
        (":sink sh:property [ sh:path sc:hasInput ; sh:maxCount 1 ] .", []),
        (WANTS + ":sink sc:recruits true .", []),
        (WANTS + ":sink sc:recruits [ sh:class rob:Camera ] .", []),
        (WANTS + ":sink sc:recruits false .", ["SC-L13"]),
        (WANTS + ":t sc:hasInput [ sc:name 'i' ; sc:signalType rob:Image ; sc:of :sink ] .", []),
        (WANTS + ":t sc:hasOutput [ sc:name 'i' ; sc:signalType rob:Image ; sc:of :sink ] .", ["SC-L13"]),
        (asks(":sink", "sc:hasInput", f"{typed('rob:Image')} , {OPTIONAL}"), []),
        (f":sink sh:property [ sh:path sc:hasInput ; sh:minCount 1 ; sh:property {OPTIONAL} ] .", []),
    ],
)
def test_an_input_that_a_role_asks_for_has_to_be_fed_by_another(more: str, found: list[str]) -> None:
    assert codes(PAIR + more) == found


def test_an_output_below_the_wanted_type_feeds_it() -> None:
    wants = ":sink sh:property [ sh:path ( sc:hasInput sc:signalType ) ; sh:hasValue :Sight ] ."
    gives = asks(":source", "sc:hasOutput", typed(":Photo"))
    text = PAIR + wants + FED + gives
    assert codes(text) == ["SC-L13"]
    assert not codes(text + ":Photo rdfs:subClassOf :Picture . :Picture owl:equivalentClass :Sight .")


@pytest.mark.parametrize(("name", "found"), [("left", []), ("right", ["SC-L13"])])
def test_an_input_with_a_name_is_fed_by_an_interaction_that_does_not_name_another(name: str, found: list[str]) -> None:
    wants = ':sink sh:property [ sh:path ( sc:hasInput sc:name ) ; sh:hasValue "left" ] .'
    link = f'[] a sc:Interaction ; sc:from :source ; sc:to :sink ; sc:input "{name}" .'
    assert codes(PAIR + wants + link) == found
