"""What is refused of a text before it is parsed: what is not UTF-8, and what only Turtle 1.2 has."""

from __future__ import annotations

from pathlib import Path

import pyoxigraph as ox
import pytest

import selfconf as sc
from selfconf.errors import BindingError, TurtleError
from selfconf.rdf import turtle
from selfconf.rdf.advertisements import read_advertisements
from selfconf.rdf.turtle import check_turtle_1_1, check_utf_8, first_not_utf_8, read_ontology
from selfconf.rdf.validation import SourceText, validate_texts
from tests.lab import PREFIXES


@pytest.mark.parametrize("before", ["", "\ufeff"])
@pytest.mark.parametrize("text", ["# ä\n<urn:a> <urn:b> 'ä%s' .\n", "# ä\n# another line ä%s\n"])
def test_a_byte_that_is_no_utf_8_is_named_with_its_place(text: str, before: str) -> None:
    head, tail = f"{before}{text}".split("%s")
    with pytest.raises(TurtleError) as caught:
        check_utf_8(head.encode() + "ö".encode("latin-1") + tail.encode(), "t.ttl")
    wrong = "this is not UTF-8: the byte 0xF6 cannot stand here; save the file in the encoding UTF-8"
    place = len(head.rpartition("\n")[2]) + 1
    assert str(caught.value) == f"t.ttl:2:{place}: {wrong}"


@pytest.mark.parametrize("text", ["", "a", "ä\U0001f916", "\ufeffa"])
def test_a_text_that_is_utf_8_is_passed(text: str) -> None:
    assert first_not_utf_8(text.encode()) is None
    check_utf_8(text.encode(), "t.ttl")


@pytest.mark.parametrize("octets", [b"\xff", b"\xc3", b"\xed\xa0\x80", b"\xc0\xaf"])
def test_what_only_looks_like_utf_8_is_found(octets: bytes) -> None:
    found = first_not_utf_8(b"\n ab" + octets)
    assert found is not None
    assert found[:2] == (2, 4)


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
        ':VERSION , :a.VERSION , "VERSION"@en',
    ],
)
def test_what_looks_like_turtle_1_2_and_is_not_is_read(value: str) -> None:
    text = described(value)
    check_turtle_1_1(text.encode(), "a.ttl")
    (advertisement,), malformed = read_advertisements(text.encode(), "a.ttl")
    assert (advertisement.component.short, malformed) == ("k", [])


@pytest.mark.parametrize("version", ['@version "1.2" .', 'VERSION "1.2"'])
def test_a_version_is_refused_by_every_reader(version: str) -> None:
    text = f"{version}\n{described(':a')}"
    assert list(ox.parse(text, format=ox.RdfFormat.TURTLE))
    for read in (read_advertisements, turtle.parse, read_ontology):
        with pytest.raises(TurtleError, match=r"a\.ttl:1:1: not Turtle 1\.1"):
            read(text.encode(), "a.ttl")


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
