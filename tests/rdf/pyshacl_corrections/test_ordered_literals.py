"""pySHACL lets only literals pass beside others that have an order with them, as SPARQL does."""

from __future__ import annotations

from itertools import product

import pyshacl
import pytest
from pyoxigraph import RdfFormat, Store
from rdflib import Graph

from selfconf.rdf.pyshacl_corrections import only_ordered
from tests.lab import PREFIXES, iri


def test_in_the_block_pyshacl_lets_no_date_pass_a_limit_that_is_a_number() -> None:
    shape = ":s a sh:NodeShape ; sh:targetNode :a ; sh:property [ sh:path :p ; sh:minInclusive 5 ] ."
    shapes = Graph().parse(data=PREFIXES + shape, format="turtle")
    verdicts = []
    for value in ('"2024-01-01"^^xsd:date', "5.0", "4"):
        data = Graph().parse(data=f"{PREFIXES}:a :p {value} .", format="turtle")
        with only_ordered():
            verdicts.append(pyshacl.validate(data, shacl_graph=shapes)[0])
    assert verdicts == [False, True, False]


@pytest.mark.parametrize(
    ("constraint", "value"), [("sh:maxInclusive 5", '"NaN"^^xsd:double'), ("sh:minLength 0", "[]")]
)
def test_in_the_block_pyshacl_lets_neither_nan_pass_a_limit_nor_a_blank_node_a_length(
    constraint: str, value: str
) -> None:
    shape = f":s a sh:NodeShape ; sh:targetNode :a ; sh:property [ sh:path :p ; {constraint} ] ."
    shapes = Graph().parse(data=PREFIXES + shape, format="turtle")
    data = Graph().parse(data=f"{PREFIXES}:a :p {value} .", format="turtle")
    with only_ordered():
        assert not pyshacl.validate(data, shacl_graph=shapes)[0]
    assert pyshacl.validate(data, shacl_graph=shapes)[0]


@pytest.mark.parametrize("constraint", ["lessThan", "lessThanOrEquals"])
def test_in_the_block_pyshacl_compares_two_properties_as_sparql_does(constraint: str) -> None:
    shape = f":s a sh:NodeShape ; sh:targetNode :a ; sh:property [ sh:path :p ; sh:{constraint} :q ] ."
    shapes = Graph().parse(data=PREFIXES + shape, format="turtle")
    less = "<" if constraint == "lessThan" else "<="
    values = (
        '"2024-01-01"^^xsd:date',
        '"2024-01-02"^^xsd:date',
        "5",
        "5.0",
        "6",
        '"a"',
        '"b"',
        '"b"@en',
        '"c"@en',
        ":x",
        ":y",
        "[]",
    )
    for value, other in product(values, values):
        text = f"{PREFIXES}:a :p {value} ; :q {other} ."
        data = Graph().parse(data=text, format="turtle")
        with only_ordered():
            found = pyshacl.validate(data, shacl_graph=shapes)[0]
        store = Store()
        store.load(text.encode(), RdfFormat.TURTLE)
        query = (
            f"ASK {{ ?a <{iri('p')}> ?p ; <{iri('q')}> ?q FILTER ( isLiteral(?p) && isLiteral(?q) && ?p {less} ?q ) }}"
        )
        assert found == bool(store.query(query)), (value, other)
