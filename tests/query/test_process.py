"""`selfconf query`: its formats agree with Oxigraph's own, and whatever is asked comes to an end."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from selfconf.errors import ProgrammerError, QueryError
from selfconf.model.term import IRI
from selfconf.query import Question, answer
from selfconf.rdf.sparql.dataset import Dataset
from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.vocabulary import SC

pytestmark = pytest.mark.process

TEXT = '<urn:a> <urn:p> 1 , "x\\ty, \\"z\\""@en , "plain" , <urn:b> , [ <urn:q> 2.5 ] .'
EVERYTHING = "SELECT ?o ?x WHERE { <urn:a> <urn:p> ?o OPTIONAL { ?o <urn:nothing> ?x } }"


@pytest.fixture
def dataset() -> Dataset:
    found = Dataset()
    found.add(IRI("urn:g"), turtle.parse(TEXT, "a.ttl").triples())
    return found


def ask(dataset: Dataset, text: str, form: str = "table", rows: int = 100) -> str:
    return answer(dataset, Question(text, form, rows, seconds=30)).text


def test_a_table_shortens_by_the_prefixes_of_its_query(dataset: Dataset) -> None:
    text = "PREFIX u: <urn:> PREFIX : <urn:> SELECT ?s ?p WHERE { ?s ?p <urn:b> }"
    assert ask(dataset, text).splitlines()[-1].split() == ["u:a", "u:p"]
    assert ask(dataset, "SELECT ?s ?p WHERE { ?s ?p <urn:b> }").splitlines()[-1].split() == ["<urn:a>", "<urn:p>"]


def test_a_prefix_of_a_query_goes_before_one_that_is_lent(dataset: Dataset) -> None:
    text = f"PREFIX sc: <urn:> PREFIX s: <{SC.base}> SELECT ?s ?c WHERE {{ ?s ?p <urn:b> BIND (s:Role AS ?c) }}"
    assert ask(dataset, text).splitlines()[-1].split() == ["sc:a", "s:Role"]


JOIN = " ".join(f"?a{n} ?b{n} ?c{n} ." for n in range(30))


def test_a_query_without_end_is_ended(dataset: Dataset) -> None:
    with pytest.raises(QueryError, match=r"more than 0\.5 s"):
        answer(dataset, Question(f"SELECT (COUNT(*) AS ?n) WHERE {{ {JOIN} }}", seconds=0.5))


def test_a_process_for_queries_that_breaks_is_not_said_to_lack_memory(
    dataset: Dataset, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    broken = tmp_path / "python"
    broken.write_text("#!/bin/sh\ncat > /dev/null; echo 'KeyError: 1' >&2; exit 1\n")
    broken.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(broken))
    with pytest.raises(ProgrammerError, match="KeyError: 1"):
        answer(dataset, Question("ASK { ?s ?p ?o }"))


def test_a_query_that_takes_all_memory_is_ended(dataset: Dataset) -> None:
    text = f"SELECT * WHERE {{ {JOIN} }} ORDER BY ?a1"
    with pytest.raises(QueryError, match="GiB of memory"):
        answer(dataset, Question(text, memory=400 << 20))


def test_a_query_that_nests_too_deeply_ends_nothing_but_itself(dataset: Dataset) -> None:
    deep = 100_000
    with pytest.raises(QueryError, match="brings its engine down"):
        ask(dataset, "SELECT * WHERE " + "{" * deep + " ?s ?p ?o " + "}" * deep)
