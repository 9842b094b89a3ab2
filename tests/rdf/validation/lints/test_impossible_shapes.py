"""Lints about shapes that nothing conforms to."""

from __future__ import annotations

import pytest

from tests.rdf.validation.lints.linted_text import HEAD, TEMPLATE, lints, only


@pytest.mark.parametrize(
    "shape",
    [
        "sh:minCount 2 ; sh:maxCount 1",
        "sh:minCount 1 ; sh:in ()",
        "sh:minCount 3 ; sh:in ( :x :y )",
        "sh:hasValue :z ; sh:in ( :x :y )",
    ],
)
def test_a_property_shape_that_contradicts_itself_is_noticed(shape: str) -> None:
    assert only(TEMPLATE + f":r sh:property [ sh:path rob:place ; {shape} ] .").code == "SC-L11"


@pytest.mark.parametrize(
    "other",
    [
        ":q a sc:Role ; sh:class rob:Lamp ; sh:targetClass sc:Component ; sh:property [ sh:path rob:place ; %s ] .",
        ":q a sh:NodeShape ; sh:targetClass sc:Component ; sh:property [ sh:path rob:place ; %s ] .",
        ":q a sh:NodeShape ; sh:targetObjectsOf rob:place ; sh:nodeKind sh:Literal .",
    ],
)
def test_the_targets_of_other_shapes_of_the_file_say_nothing_of_a_role(other: str) -> None:
    asked = "sh:property [ sh:path rob:place ; sh:minCount 1 ; sh:nodeKind sh:IRI ]"
    text = TEMPLATE.replace("( :r )", "( :r :q )" if "Role" in other else "( :r )")
    assert not lints(f"{text} :r {asked} . {other.replace('%s', 'sh:maxCount 0')}")


def test_a_target_of_a_role_does_not_make_every_component_meet_its_shape() -> None:
    assert not lints(TEMPLATE + ":r sh:targetClass sc:Component .")


@pytest.mark.parametrize(
    "shape", ["sh:minCount 1 ; sh:maxCount 1", "sh:minCount 2 ; sh:in ( :x :y )", "sh:hasValue :x ; sh:in ( :x )"]
)
def test_a_property_shape_that_can_be_kept_is_left_alone(shape: str) -> None:
    assert not lints(TEMPLATE + f":r sh:property [ sh:path rob:place ; {shape} ] .")


def test_a_contradiction_is_shown_at_its_second_side_and_names_the_place_of_the_first() -> None:
    first = ":r sh:property [ sh:path rob:place ; sh:maxCount 1 ] .\n"
    found = only(TEMPLATE + first + ":r sh:node [ sh:property [ sh:path rob:place ; sh:minCount 2 ] ] .")
    assert (found.line - HEAD, found.column) == (3, 48)
    assert found.message == (
        f"sh:minCount 2 and sh:maxCount 1 (line {HEAD + 2}) exclude each other, so no component can play the role :r."
    )


def test_a_closed_role_that_does_not_let_a_component_have_a_type_is_told_how_to() -> None:
    found = only(TEMPLATE + ":r sh:closed true .")
    assert found.hint is not None
    assert "sh:ignoredProperties" in found.hint


def test_a_contradiction_in_a_shape_that_is_no_role_is_not_reported() -> None:
    shape = ":s a sh:NodeShape ; sh:property [ sh:path rob:place ; sh:minCount 2 ; sh:maxCount 1 ] ."
    assert not lints(TEMPLATE + shape)


ASKED, LATENCY = TEMPLATE + ":r {} .", "rob:latency ;"
RATED = ":a a sc:Component, rob:Tuner ; sc:hasInput [ sc:name 'i' ; sc:signalType rob:Audio ; sc:accepts [ {} ] ] ."


@pytest.mark.parametrize(
    ("text", "wrong", "right", "code"),
    [
        (ASKED, f"{LATENCY} sh:minInclusive 12 ;", f"{LATENCY} sh:minInclusive 5 ;", "SC-L11"),
        (ASKED, f"{LATENCY} sh:minInclusive 12 ;", f"{LATENCY} sh:maxCount 0 ;", "SC-L11"),
        (ASKED, "( sc:hasOutput sc:rate ) ;", "( sc:hasOutput sc:rate sc:value ) ;", "SC-L11"),
        (RATED, "sc:rate ;", "( sc:rate sc:value ) ;", "SC-L22"),
        (RATED, "sc:rate ; sh:minCount 1 ;", "( sc:rate sc:value ) ; sh:minCount 1 ;", "SC-L22"),
    ],
)
def test_what_no_value_can_meet_is_noticed_where_there_may_be_none(
    text: str, wrong: str, right: str, code: str
) -> None:
    assert only(text.format(f"sh:property [ sh:path {wrong} sh:maxInclusive 9 ]")).code == code
    assert not lints(text.format(f"sh:property [ sh:path {right} sh:maxInclusive 9 ]"))


@pytest.mark.parametrize(
    ("pattern", "hint"),
    [
        ("?lamp rob:place $This", "Write $this in place of $This."),
        ("?lamp rob:place $self", "In it $this is the component."),
        ("?lamp rob:place '$this' # $this", "In it $this is the component."),
    ],
)
def test_a_query_that_does_not_ask_about_its_component_is_noticed(pattern: str, hint: str) -> None:
    head = f'{TEMPLATE}:r sh:sparql [ sh:select """PREFIX rob: <https://w3id.org/selfconf/robotics#> SELECT $this {{'
    found = only(f'{head} {pattern}\n}}""" ] .')
    assert (found.code, found.hint) == ("SC-L34", hint)
    assert lints(f'{head} ?lamp rob:place ?this }}""" ] .') == []


@pytest.mark.parametrize("word", ["or", "xone"])
def test_alternatives_that_stand_alone_are_noticed_unless_there_is_one(word: str) -> None:
    one, other = "[ sh:class rob:Lamp ]", "[ sh:property [ sh:path rob:place ; sh:minCount 1 ] ]"
    assert only(f"{TEMPLATE}:r sh:{word} ( {one} ) , ( {other} ) .").code == "SC-L35"
    for said in (f"( {one} )", f"( {one} {other} )", f"( {one} {other} ) , ( {other} )"):
        assert lints(f"{TEMPLATE}:r sh:{word} {said} .") == []
