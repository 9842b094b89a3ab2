"""The halves of a prefixed name: what passes for one is read by a parser, whatever script it is written in."""

from __future__ import annotations

import pytest

from selfconf.model.curie import is_local_name, is_prefix, suggested_local_name
from selfconf.model.term import IRI
from selfconf.rdf.turtle import parse

BASE = "https://example.org/home#"


@pytest.mark.parametrize("local", ["clock", "a.b", "a-b", "_x", "0", "xß", "камера", "時計", "a..b", "x·y", "е́"])
def test_a_local_name_of_any_script_is_read_as_it_was_meant(local: str) -> None:
    assert is_local_name(local)
    ((subject, _, _),) = parse(f"@prefix : <{BASE}> . :{local} a <urn:t> .", "a.ttl").triples()
    assert subject == IRI(BASE + local)


@pytest.mark.parametrize("local", ["", "-x", "x.", ".x", "a b", "µm", "m²", "x½", "ª", "a:b", "a/b", "\u0301x", "·"])
def test_what_a_parser_does_not_read_as_it_stands_is_no_local_name(local: str) -> None:
    assert not is_local_name(local)


@pytest.mark.parametrize("prefix", ["", "ex", "дом", "a.b-1"])
def test_a_prefix_may_be_empty_or_of_any_script(prefix: str) -> None:
    assert is_prefix(prefix)
    ((subject, _, _),) = parse(f"@prefix {prefix}: <{BASE}> . {prefix}:x a <urn:t> .", "a.ttl").triples()
    assert subject == IRI(BASE + "x")


@pytest.mark.parametrize("prefix", ["_", "1a", "a.", "-a", "µ"])
def test_what_no_parser_reads_before_a_colon_is_no_prefix(prefix: str) -> None:
    assert not is_prefix(prefix)


@pytest.mark.parametrize(
    ("words", "name"), [("living room", "living-room"), ("~/a.ttl", "a-ttl"), ("x", "x"), ("!", "")]
)
def test_words_that_are_no_local_name_suggest_one(words: str, name: str) -> None:
    assert suggested_local_name(words) == name
    assert is_local_name(name) or not name
