"""What terms of a Thing Description stand for; Oxigraph's parser of JSON-LD judges what the contexts hold."""

from __future__ import annotations

import json
from typing import Any

import pyoxigraph as ox
import pytest

from selfconf.importing.wot.contexts import TermMeanings, spoken
from selfconf.model.term import STRING, Literal
from selfconf.rdf.vocabulary import RDF as LANGUAGES

W3C = "https://www.w3.org/2022/wot/td/v1.1"
SAREF = "https://w3id.org/saref#"
OWN: list[dict[str, Any]] = [
    {"saref": SAREF},
    {"saref": {"@id": SAREF, "@prefix": True}, "Lamp": "saref:LightSwitch"},
    {"a": "https://example.org/", "b": "a:b/", "Lamp": {"@id": "b:Lamp"}},
    {"@vocab": "https://example.org/v#"},
    {"saref": SAREF, "Lamp": "saref:Lamp", "@vocab": "https://example.org/v#"},
]


@pytest.mark.parametrize("term", ["saref:Lamp", "Lamp", "b:Lamp", "https://example.org/Lamp", "urn:x:Lamp"])
@pytest.mark.parametrize("context", OWN, ids=range(len(OWN)))
def test_terms_of_contexts_in_the_document_mean_what_json_ld_says(context: dict[str, Any], term: str) -> None:
    text = json.dumps({"@context": context, "@id": "urn:x:it", "@type": term})
    said = [quad.object.value for quad in ox.parse(text, format=ox.RdfFormat.JSON_LD)]
    # JSON-LD takes a prefix that is not declared for the scheme of an IRI.
    assert said == [TermMeanings(context).expanded(term) or term] or (said == [] and ":" not in term)


def test_terms_of_the_w3c_are_known_without_the_network() -> None:
    meanings = TermMeanings([W3C])
    assert meanings.expanded("Thing") == "https://www.w3.org/2019/wot/td#Thing"
    assert meanings.expanded("tm:ThingModel") == "https://www.w3.org/2019/wot/tm#ThingModel"
    assert meanings.remote == []
    assert TermMeanings("https://www.w3.org/2019/wot/td/v1").expanded("Thing") == meanings.expanded("Thing")


def test_a_word_that_no_context_defines_is_unknown_although_the_w3c_has_a_vocabulary() -> None:
    assert TermMeanings([W3C]).expanded("Lamp") is None


def test_a_prefix_of_a_context_on_the_web_is_unknown_and_both_are_named() -> None:
    meanings = TermMeanings([W3C, "https://example.org/context.jsonld"])
    assert meanings.expanded("iot:Lamp") is None
    assert meanings.family("iot:Lamp") == "terms with the prefix iot:"
    assert "not fetched: https://example.org/context.jsonld" in meanings.unknown()


@pytest.mark.parametrize(
    "context",
    [
        None, 5, [[]], {"a": "a"}, {"a": "b:x", "b": "a:y"}, {"a": {"@id": 5}}, {"a": "a:a"},
        {"a": "a1:x"} | {f"a{number}": f"a{number + 1}:x" for number in range(1, 2000)},
    ],
)  # fmt: skip
def test_a_context_that_makes_no_sense_defines_nothing(context: Any) -> None:
    meanings = TermMeanings(context)
    assert meanings.expanded("a:b") is None
    assert meanings.expanded("a") is None


def test_words_have_a_language_where_its_tag_can_be_one() -> None:
    assert spoken("Lampe", "de-CH") == Literal("Lampe", LANGUAGES.langString, "de-CH")
    for tag in ("not a tag", "a", "en-a", "en-us-us", "", None, 5, {}, ["en"]):  # Turtle has none of them
        assert spoken("Lampe", tag) == Literal("Lampe", STRING)
