"""The prologue of a query: which prefixes it declares."""

from __future__ import annotations

import pytest

from selfconf.rdf.sparql.prologue import declared_prefixes


@pytest.mark.parametrize(
    ("text", "prefixes"),
    [
        ("ASK {}", {}),
        ("", {}),
        ("PREFIX : <urn:a#> prefix b.c: <http://b/>\nSELECT * {}", {"": "urn:a#", "b.c": "http://b/"}),
        ("BASE <http://b/> # PREFIX no: <urn:no>\nPREFIX a:<urn:a> ASK {}", {"a": "urn:a"}),
        ("PREFIX a: <urn:a> PREFIX a: <urn:b> ASK {}", {"a": "urn:b"}),
        ("PREFIX a: <relative#> PREFIX b: <> ASK {}", {}),
        ("ASK { ?s ?p 'PREFIX a: <urn:a>' }", {}),
    ],
)
def test_the_prefixes_are_those_before_the_question(text: str, prefixes: dict[str, str]) -> None:
    assert declared_prefixes(text) == prefixes
