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


ELSEWHERE = "SERVICE <urn:x> { ?s ?p ?o }"


@pytest.mark.parametrize(
    "text",
    [
        rf"SELECT * {{ ?s <urn:x>/:a\#b ?o . {ELSEWHERE} }}",
        rf"SELECT * {{ ?s :a\' ?o . {ELSEWHERE} FILTER(?s != 'b') }}",
        "SELECT * { ?s ?p ?e FILTER(1<2)SERVICE?e#>\n{ ?s ?p ?o } }",
        f'SELECT * {{ ?s ?p ?e FILTER(1<2)#>"""\n {ELSEWHERE} #"""\n }}',
    ],
)
def test_what_asks_another_machine_hides_behind_no_name_or_comparison(text: str) -> None:
    with pytest.raises(QueryError, match="SERVICE is not allowed"):
        only_reads(text)


@pytest.mark.parametrize("said", ["<urn:x#Service>", "'SERVICE <urn:x> {}'", "?service", ":service", "1 # SERVICE"])
def test_a_query_that_has_the_word_and_asks_no_other_machine_is_answered(said: str) -> None:
    only_reads(f"PREFIX : <urn:> SELECT * {{ ?s ?p {said}\n }}")


def test_a_long_query_that_has_the_word_is_parsed_to_its_end() -> None:
    """The parser nests its calls with each triple."""
    many = "?s a <urn:Room> . " * 300
    only_reads(f"SELECT * {{ {many} ?s a <urn:CustomerService> }}")
    with pytest.raises(QueryError, match="SERVICE is not allowed"):
        only_reads(f"SELECT * {{ {many} FILTER(1<2)#>\nSERVICE <urn:x> {{}} }}")
    with pytest.raises(QueryError, match="not so deep"):
        only_reads("ASK " + "{" * 100_000 + "}" * 100_000 + " # service")


def test_what_has_the_word_and_cannot_be_parsed_is_refused() -> None:
    with pytest.raises(QueryError, match="cannot be parsed"):
        only_reads("SELECT * { ?s ?p <urn:x#Service>")


@pytest.mark.parametrize("marks", ['\\"', '"\\', "'\\"])
def test_strings_without_an_end_are_found_in_linear_time(marks: str) -> None:
    assert not says(f"ASK {{ {marks * 200_000} }}", "ASKED")  # minutes, if each quote is looked at as a beginning


def test_the_query_of_a_shape_names_no_graph() -> None:
    hidden = 'SELECT $this { $this ?p ?o FILTER(1<2)#>"""\n GRAPH <urn:x> { ?s ?p ?o } #"""\n }'
    assert fault(hidden) == "The query of a role reads the advertisements and nothing else: leave out GRAPH."
    assert fault("SELECT $this { $this ?p 'a graph from a service' }") is None
    assert fault("SELECT $this FROM <file:///etc/passwd> { $this ?p ?o }") is not None
    assert fault("SELECT $this { $this ?p ?o }") is None
