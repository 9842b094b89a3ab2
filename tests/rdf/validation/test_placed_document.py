"""A checked file as a document: its statements stand in the order of the text, each with its place."""

from __future__ import annotations

from selfconf.rdf.positions import parse_with_positions
from selfconf.rdf.validation.placed_document import PlacedDocument
from tests.lab import PREFIXES


def test_the_statements_stand_in_the_order_of_the_text_each_with_the_place_of_its_object() -> None:
    _, positions = parse_with_positions(PREFIXES + ':b :p 2 , 1 ; :q "x"@en , [ :r ( 5 ) ] . :a :p 01 .', "a.ttl")
    placed = PlacedDocument.of(positions)
    triples = list(placed.document.triples())
    assert placed.document.source == "a.ttl"
    assert {*triples} == placed.places.keys()
    for one in placed.document.statements:
        offsets = [placed.places[(one, *said)].object for said in placed.document.about(one)]
        assert offsets == sorted(offsets)
    places = [
        (str(value), placed.places[subject, said, value].object)
        for subject, said, value in triples
        if said.short == "p"
    ]
    assert [text for text, _ in places] == ["2", "1", "01"]
    assert all(positions.text[offset:].startswith(text) for text, offset in places)
