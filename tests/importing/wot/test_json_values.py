"""Values of members as terms; Oxigraph's parser of JSON-LD judges what types, languages and IRIs they have."""

from __future__ import annotations

import json
from typing import Any

import pyoxigraph as ox
import pytest

from selfconf.importing.wot.contexts import TermMeanings
from selfconf.importing.wot.json_values import NESTED, terms_of
from selfconf.rdf.turtle import ox_term

CONTEXT: dict[str, Any] = {
    "ex": "http://ex/",
    "xsd": "http://www.w3.org/2001/XMLSchema#",
    "ref": {"@id": "ex:ref", "@type": "@id"},
    "word": {"@id": "ex:word", "@type": "@vocab"},
    "built": {"@id": "ex:built", "@type": "xsd:date"},
    "ex:short": {"@type": "xsd:byte"},
    "nom": {"@id": "ex:nom", "@language": "fr"},
    "code": {"@id": "ex:code", "@language": None},
    "names": {"@id": "ex:names", "@container": "@language"},
    "set": {"@id": "ex:set", "@container": "@set"},
    "free": "ex:free",
}
VALUES: list[tuple[str, Any]] = [
    ("ref", "urn:robots:astrid"),
    ("ref", "ex:astrid"),
    ("ref", ["urn:a", {"@id": "ex:b"}]),
    ("word", "free"),
    ("word", "ex:b"),
    ("built", "2020-01-01"),
    ("built", {"@value": "2020", "@type": "xsd:gYear"}),
    ("ex:short", 5),
    ("ex:short", True),
    ("nom", "lampe"),
    ("nom", {"@value": "lamp", "@language": "en"}),
    ("code", "x"),
    ("names", {"de": "Lampe", "en": ["lamp", "light"]}),
    ("set", ["a", "b"]),
    ("free", "x"),
    ("free", {"@set": [1, None, True]}),
    ("free", {"@value": "5", "@type": "xsd:integer"}),
    ("free", {"@value": 5}),
    ("free", {"@id": "ex:b"}),
]


@pytest.mark.parametrize("language", [None, "en"])
@pytest.mark.parametrize(("member", "value"), VALUES)
def test_values_have_the_types_and_languages_that_json_ld_says(member: str, value: Any, language: str | None) -> None:
    context = {**CONTEXT, "@language": language}
    text = json.dumps({"@context": context, "@id": "urn:x:it", member: value})
    said = {quad.object for quad in ox.parse(text, format=ox.RdfFormat.JSON_LD)}
    found = list(terms_of(member, value, TermMeanings(context)))
    assert said
    assert {ox_term(term) for term in found if not isinstance(term, tuple)} == said


@pytest.mark.parametrize(
    ("member", "value", "what"),
    [
        ("ref", "astrid", "references that are no absolute IRIs"),
        ("free", {"@id": "astrid"}, "references that are no absolute IRIs"),
        ("free", {"@value": "5", "@type": "qudt:x"}, "values of datatypes that its contexts do not define"),
        ("free", {"@value": {"a": 1}, "@type": "@json"}, NESTED[0]),
        ("free", {"@list": [1]}, NESTED[0]),
        ("free", {"ex:deep": 1}, NESTED[0]),
        ("free", [[1]], NESTED[0]),
        ("free", float("nan"), NESTED[0]),
        ("names", {"de": 5}, NESTED[0]),
    ],
)
def test_what_is_no_value_of_an_advertisement_is_named(member: str, value: Any, what: str) -> None:
    (found,) = terms_of(member, value, TermMeanings(CONTEXT))
    assert isinstance(found, tuple)
    assert found[0] == what


def test_a_list_is_named_once_whatever_is_in_it() -> None:
    meanings = TermMeanings({"ex": "http://ex/", "row": {"@id": "ex:row", "@container": "@list"}})
    assert list(terms_of("row", [1, 2], meanings)) == [NESTED]


def test_the_last_definition_of_a_term_counts() -> None:
    w3c = "https://www.w3.org/2022/wot/td/v1.1"
    meanings = TermMeanings([{"license": {"@id": "http://x/l", "@type": "@id"}}, w3c])
    assert meanings.coerced("license", "@type") is None
