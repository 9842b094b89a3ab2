"""Turtle 1.2 is refused wherever Turtle is read, at its place, and nothing else is taken for it."""

from __future__ import annotations

from pathlib import Path

import pyoxigraph as ox
import pytest

import selfconf as sc
from selfconf.errors import BindingError, TurtleError
from selfconf.rdf import turtle
from selfconf.rdf.advertisements import read_advertisements
from selfconf.rdf.turtle import check_turtle_1_1, read_ontology
from selfconf.rdf.validation import SourceText, validate_texts
from tests.lab import PREFIXES

NEWER = [
    ("<<( :a :b :c )>>", 1),
    ("<< :a :b :c >>", 1),
    (":c {| :by :me |}", 4),
    (":c ~ :e", 4),
    ('"""a "quoted" ~ word""" ~ :e', 25),
    ('"x"@en--ltr', 4),
    ("<http://x/~me> ~", 16),
]


def described(value: str) -> str:
    """An advertisement with that value, in its last line."""
    return f"{PREFIXES}# It's ~ or <<\n:k a sc:Component, :K ; :p\n{value} ."


@pytest.mark.parametrize(("value", "column"), NEWER)
def test_turtle_1_2_is_refused_at_its_place_by_every_reader(value: str, column: int) -> None:
    text = described(value)
    line = text.count("\n") + 1
    assert list(ox.parse(text, format=ox.RdfFormat.TURTLE))
    for read in (read_advertisements, turtle.parse, read_ontology):
        with pytest.raises(TurtleError, match=r"not Turtle 1\.1: this takes RDF 1\.2") as caught:
            read(text.encode(), "a.ttl")
        assert (caught.value.file, caught.value.line, caught.value.column) == ("a.ttl", line, column)
    (problem,) = validate_texts([SourceText("a.ttl", text.encode())], [], []).diagnostics
    assert (problem.code, problem.line) == ("SC-S01", line)


@pytest.mark.parametrize(
    "value",
    [
        "<http://x/~me>",
        r":a\~b",
        '"~ << {| @en--ltr"',
        "'''it's ~\n <<'''",
        '""" "~ << """',
        '"\\"~" , ""',
        '"x"@en-GB , :a--ltr',
    ],
)
def test_what_looks_like_turtle_1_2_and_is_not_is_read(value: str) -> None:
    text = described(value)
    check_turtle_1_1(text.encode(), "a.ttl")
    (advertisement,), malformed = read_advertisements(text.encode(), "a.ttl")
    assert (advertisement.component.short, malformed) == ("k", [])


def test_another_mistake_before_it_is_left_to_the_parser() -> None:
    with pytest.raises(TurtleError, match="not Turtle: The prefix nope: has not been declared"):
        turtle.parse(f"{PREFIXES}nope:a :b <<( :a :b :c )>> .", "a.ttl")


def test_an_ecology_with_such_an_advertisement_is_named_and_answers_no_query(tmp_path: Path) -> None:
    (tmp_path / "a.ttl").write_text(described("<<( :a :b :c )>>"))
    with pytest.raises(TurtleError, match=f"a.ttl:{PREFIXES.count(chr(10)) + 3}:1: not Turtle 1"):
        sc.read(tmp_path)


def test_a_statement_is_no_value_of_a_parameter() -> None:
    with pytest.raises(BindingError, match="is no Turtle term"):
        sc.template("examples/clock/tell-the-time.ttl").bind(room="<<( <urn:a> <urn:b> <urn:c> )>>")
