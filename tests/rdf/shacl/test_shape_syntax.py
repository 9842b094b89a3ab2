"""What may stand as the value of SHACL's own properties."""

from __future__ import annotations

import pytest

from selfconf.model.term import IRI
from selfconf.rdf.shacl.shape_syntax import misfit, unfit
from selfconf.rdf.turtle import parse
from selfconf.rdf.vocabulary import SH
from tests.lab import PREFIXES, iri


@pytest.mark.parametrize(
    ("said", "predicate"),
    [
        ("sh:minCount 'one'", "minCount"),
        ("sh:closed 1", "closed"),
        ("sh:in 5", "in"),
        ("sh:class 'A'", "class"),
        ("sh:nodeKind :Kind", "nodeKind"),
        ("sh:property [ sh:class :A ]", "property"),
        ("sh:pattern '('", "pattern"),
        ("sh:node 'x'", "node"),
    ],
)
def test_a_value_that_cannot_stand_there_is_named_with_its_statement(said: str, predicate: str) -> None:
    document = parse(f"{PREFIXES}:r {said} .", "r.ttl")
    found = misfit(document, list(document.triples()), frozenset())
    assert found is not None
    assert found[0][:2] == (iri("r"), SH[predicate])
    assert found[1] == unfit(SH[predicate]).rstrip(".")


def test_of_a_constraint_in_sparql_the_query_is_named() -> None:
    document = parse(f"{PREFIXES}:r sh:sparql [ sh:select 'SELECT' ] .", "r.ttl")
    found = misfit(document, list(document.triples()), frozenset())
    assert found is not None
    assert found[0][1] == SH.select


def test_a_parameter_may_stand_anywhere() -> None:
    document = parse(f"{PREFIXES}:r sh:minCount :n .", "r.ttl")
    assert misfit(document, list(document.triples()), frozenset({iri("n")})) is None
    assert misfit(document, list(document.triples()), frozenset({IRI("urn:other")})) is not None
