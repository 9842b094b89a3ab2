"""With all corrections pySHACL judges as SHACL and SPARQL say, and prints and logs nothing; afterwards as it did."""

from __future__ import annotations

import logging

import pyshacl
import pytest
from pyshacl.constraints import constraint_component
from rdflib import Graph

from selfconf.rdf.pyshacl_corrections import corrected
from tests.lab import PREFIXES


def conforms(data: str, asked: str) -> bool:
    """Whether pySHACL finds that `:a` is as a shape asks."""
    shapes = Graph().parse(data=f"{PREFIXES}:s a sh:NodeShape ; sh:targetNode :a ; {asked} .", format="turtle")
    return pyshacl.validate(Graph().parse(data=f"{PREFIXES}:a :p {data} .", format="turtle"), shacl_graph=shapes)[0]


@pytest.mark.parametrize(
    ("data", "asked", "right"),
    [
        ('"2024-01-01"^^xsd:date', "sh:property [ sh:path :p ; sh:minInclusive 5 ]", False),
        ('"a b"', "sh:property [ sh:path :p ; sh:pattern 'a    b' ; sh:flags 'x' ]", False),
        (":b", "sh:sparql [ sh:select 'SELECT $this { $this <urn:x:q>* 1 }' ]", True),
        ('"x"', "sh:sparql [ sh:select 'SELECT $this { $this ?p ?x FILTER (?x < 5 || true) }' ]", False),
    ],
)
def test_all_corrections_hold_in_the_block(data: str, asked: str, right: bool) -> None:
    with corrected():
        assert conforms(data, asked) == right


def test_the_text_of_a_report_that_nothing_reads_is_not_written(monkeypatch: pytest.MonkeyPatch) -> None:
    def written(graph: object, node: object) -> str:
        raise AssertionError("a term was written into a report")

    monkeypatch.setattr(constraint_component, "stringify_node", written)
    with corrected():
        assert not conforms("5", "sh:property [ sh:path :p ; sh:in ( 7 ) ; sh:minCount 2 ]")
    assert vars(constraint_component)["stringify_node"] is written  # put back where it was


def test_the_logs_of_pyshacl_are_silent_in_the_block_alone() -> None:
    logs = [logging.getLogger(name) for name in ("pyshacl.validator", "pyshacl-validate")]
    with corrected():
        assert all(log.disabled for log in logs)
    assert not any(log.disabled for log in logs)
