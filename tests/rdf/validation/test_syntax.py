"""What is said of a file that is not Turtle: where, and what to try."""

from __future__ import annotations

import pytest

from selfconf.rdf.turtle import USUAL
from selfconf.rdf.validation.checking import SourceText, validate_texts

HEAD = "".join(f"@prefix {prefix}: <{namespace.base}> .\n" for prefix, namespace in USUAL.items() if prefix != "unit")
GOOD = """@prefix : <https://example.org/home#> .
:fridge a sc:Component, rob:Thermometer ;
    rdfs:label "Fridge" ;
    rob:place :kitchen ;
    sc:hasOutput [ sc:name "t" ; sc:signalType rob:Temperature ] .
"""


def said(text: str) -> list[tuple[int, str, str | None]]:
    """Line below the prefixes, message and hint of each problem."""
    head = HEAD.count("\n")
    report = validate_texts([SourceText("a.ttl", (HEAD + text).encode())], [], [])
    return [(each.line - head, each.message, each.hint) for each in report.diagnostics if each.code == "SC-S01"]


@pytest.mark.parametrize(
    ("right", "wrong", "line", "advice"),
    [
        ("] .\n", "]\n", 6, "the dot after the last statement is missing"),
        ('"Fridge" ;', '"Fridge"', 4, "a semicolon is missing"),
        (":kitchen ;", ":kitchen .", 5, "should be a semicolon"),
        ('"t" ; sc', '"t" , sc', 5, "the closing ] is missing"),
        ("rob:Temperature ]", "rob:Temperature", 5, "the closing ] is missing"),
        ('"Fridge"', '"Fridge', 3, "the closing quotation mark is missing"),
        ('"Fridge"', "“Fridge”", 3, "straight"),
        ("rob:place", "unit:place", 4, "Write @prefix unit: <http://qudt.org/vocab/unit/> ."),
        ("rob:place", "my:place", 4, "Write @prefix my: <...> ."),
        (":kitchen", "( :kitchen , :hall )", 4, "without commas"),
        (":kitchen", "<https://example.org/living room>", 4, "a blank is written %20"),
        ("a sc:Component", "is sc:Component", 2, "A predicate is an IRI or a"),
    ],
)
def test_a_slip_is_told_once_with_what_to_try(right: str, wrong: str, line: int, advice: str) -> None:
    assert right in GOOD
    ((found, _, hint),) = said(GOOD.replace(right, wrong))
    assert found == line
    assert hint is not None
    assert advice in hint


def test_a_prefix_that_is_used_twice_is_missed_once_and_two_are_missed_both() -> None:
    text = "<urn:a> x:b x:c . <urn:a> y:b x:c ."
    assert [message.split()[6] for _, message, _ in said(text)] == ["x:", "y:"]


def test_mistakes_on_different_lines_are_all_told() -> None:
    assert [line for line, _, _ in said("rdf:a rdf:b , .\nrdf:a rdf:b rdf:c .\nrdf:a rdf:b , .\n")] == [1, 3]
