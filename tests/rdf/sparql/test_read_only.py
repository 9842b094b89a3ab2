"""A query reads the graph that is there and nothing else."""

from __future__ import annotations

import pytest

from selfconf.errors import QueryError
from selfconf.rdf.sparql.read_only import fault, only_reads, says


def test_a_word_counts_as_a_keyword_alone() -> None:
    assert says("SELECT * { service <urn:x> {} }", "SERVICE")
    for text in ("{ ?service ?p 'SERVICE' } # SERVICE", "{ <urn:SERVICE> a :service }", "{ ?s :x-service 1 }"):
        assert not says(text, "SERVICE")


@pytest.mark.parametrize("text", ["SELECT * { SERVICE <urn:x> {} }", "SELECT * { ser\\u0076ice <urn:x> {} }"])
def test_a_query_that_asks_another_machine_is_refused(text: str) -> None:
    with pytest.raises(QueryError, match="SERVICE is not allowed"):
        only_reads(text)
    assert fault(text) is not None


def test_the_query_of_a_shape_names_no_graph() -> None:
    assert fault("SELECT $this FROM <file:///etc/passwd> { $this ?p ?o }") is not None
    assert fault("SELECT $this { $this ?p ?o }") is None
