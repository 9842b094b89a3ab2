"""Members of JSON-LD say what an advertisement says; Oxigraph's parser judges them."""

from __future__ import annotations

import json

import pyoxigraph as ox

from selfconf.model.term import IRI, BlankNode, Literal, Term
from selfconf.rdf.turtle import SKOLEM, ox_term
from selfconf.rdf.vocabulary import RDF, ROB, XSD
from selfconf.serve.json_ld import CONTEXT, in_languages, members, name_of

IT = IRI("urn:x:it")
FAR = IRI("http://example.org/far#p")
VALUES: list[tuple[IRI, Term]] = [
    (ROB.place, IRI("urn:x:room")),
    (ROB.place, Literal("room")),
    (FAR, Literal("lampe", RDF.langString, "fr")),
    (FAR, Literal("2020-01-01", XSD.date)),
    *((FAR, Literal(lexical, XSD.integer)) for lexical in ("5", "-7", "0", "05", "+5", "12345678901234567890")),
    *((FAR, Literal(lexical, XSD.boolean)) for lexical in ("true", "false", "1")),
    (FAR, Literal("2.50", XSD.decimal)),
    (FAR, Literal("1e3", XSD.double)),
    (FAR, Literal("x", IRI("http://example.org/type"))),
]


def test_every_value_keeps_its_datatype_and_its_form() -> None:
    text = json.dumps({"@context": CONTEXT, "@id": str(IT), **members(VALUES)})
    said = {(quad.predicate.value, quad.object) for quad in ox.parse(text, format=ox.RdfFormat.JSON_LD)}
    assert said == {(str(predicate), ox_term(value)) for predicate, value in VALUES}


def test_nodes_without_a_name_are_left_out() -> None:
    assert members([(FAR, BlankNode("_:b")), (FAR, IRI(f"{SKOLEM}b"))]) == {}
    assert members([(ROB.place, IRI("urn:a"))]) == {"rob:place": {"@id": "urn:a"}}
    assert name_of(FAR) == FAR


def test_words_have_one_text_without_a_language_and_one_for_each() -> None:
    english, german = Literal("a", RDF.langString, "en"), Literal("b", RDF.langString, "de")
    plain, other, again = Literal("c"), Literal("d"), Literal("e", RDF.langString, "en")
    assert in_languages("title", []) == ({}, [])
    assert in_languages("title", [plain, other]) == ({"title": "c"}, [other])
    assert in_languages("title", [english, plain, german, again]) == (
        {"title": "c", "titles": {"en": "a", "de": "b"}},
        [again],
    )
    assert in_languages("title", [german, english]) == ({"title": "b", "titles": {"en": "a", "de": "b"}}, [])
    assert in_languages("title", [IRI("urn:x")]) == ({}, [IRI("urn:x")])
