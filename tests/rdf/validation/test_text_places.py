"""Places in a text that is not read as RDF."""

from __future__ import annotations

import pytest

from selfconf.model.diagnostic import LONGEST_SOURCE
from selfconf.rdf.validation.text_places import TextPlaces

TEXT = """@prefix x: <urn:x#> . # x:a is told of below
@prefix : <urn:other#> .
:s :p "x:a", '''<urn:x#a>
x:a''', x:ab, y.x:a ; # x:a
  :q x:a . :t :p <urn:x#b> .
"""
PREFIXES = [("x", "urn:x#"), ("", "urn:other#")]


@pytest.mark.parametrize(
    ("iris", "line", "column"),
    [({"urn:x#a"}, 5, 6), ({"urn:x#b"}, 5, 18), ({"urn:x#ab", "urn:x#a"}, 4, 9), ({"urn:other#t"}, 5, 12)],
)
def test_a_first_use_is_found_outside_strings_and_comments(iris: set[str], line: int, column: int) -> None:
    places = TextPlaces("a.ttl", TEXT.encode())
    offset = places.first_use(iris, PREFIXES)
    assert offset is not None
    found = places.at(offset, "SC-L03", "Said.")
    assert (found.line, found.column, found.source) == (line, column, TEXT.splitlines()[line - 1])


def test_what_is_not_used_is_not_found() -> None:
    assert TextPlaces("a.ttl", TEXT.encode()).first_use({"urn:x#"}, PREFIXES) is None


def test_of_a_long_line_only_a_part_is_shown() -> None:
    places = TextPlaces("a.ttl", b"x" * 1_000_000)
    found = places.on(1, 500_000, "SC-S01", "m" * 10_000, "h" * 10_000)
    assert len(found.source) == LONGEST_SOURCE
    assert found.source_column < found.column < found.source_column + LONGEST_SOURCE
    assert len(found.message) < 1_100
    assert len(found.hint or "") < 1_100


def test_the_longest_string_or_iri_is_found() -> None:
    text = f'<urn:a> <urn:b> "short" . <urn:c> <urn:d> "{"x" * 100_000}\\"\\n" .'
    assert TextPlaces("a.ttl", text.encode()).largest_token() == text.index('"xxx')
