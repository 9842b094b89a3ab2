"""`selfconf query`: its formats agree with Oxigraph's own, and whatever is asked comes to an end."""

from __future__ import annotations

import csv
import io
import json
import sys
from pathlib import Path

import pytest

from selfconf.cli.main import main
from selfconf.errors import AuthorError, ProgrammerError, QueryError
from selfconf.model.term import IRI
from selfconf.query import Question, answer
from selfconf.rdf.sparql.dataset import Dataset
from selfconf.rdf.turtle import document as turtle

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


def test_json_is_that_of_sparql(dataset: Dataset) -> None:
    body = json.loads(ask(dataset, EVERYTHING, "json"))
    assert body["head"]["vars"] == ["o", "x"]
    found = {(term["type"], term["value"]) for row in body["results"]["bindings"] for term in row.values()}
    assert {("uri", "urn:b"), ("literal", "plain"), ("literal", "1"), ("literal", 'x\ty, "z"')} < found
    assert {"type": "literal", "value": 'x\ty, "z"', "xml:lang": "en"} in [
        row["o"] for row in body["results"]["bindings"]
    ]


def test_csv_and_tsv_are_those_of_sparql(dataset: Dataset) -> None:
    rows = list(csv.reader(io.StringIO(ask(dataset, EVERYTHING, "csv"))))
    assert rows[0] == ["o", "x"]
    assert ['x\ty, "z"', ""] in rows
    lines = ask(dataset, EVERYTHING, "tsv").split("\n")
    assert lines[0] == "?o\t?x"
    assert '"x\\ty, \\"z\\""@en\t' in lines


@pytest.mark.parametrize(("form", "word"), [("turtle", "<urn:b>"), ("json", '"@id":"urn:b"')])
def test_triples_are_turtle_or_json_ld(dataset: Dataset, form: str, word: str) -> None:
    assert word in ask(dataset, "CONSTRUCT WHERE { ?s ?p ?o }", form)


def test_a_format_that_does_not_fit_the_query_is_refused(dataset: Dataset) -> None:
    for text, form in ((EVERYTHING, "turtle"), ("CONSTRUCT WHERE { ?s ?p ?o }", "csv")):
        with pytest.raises(AuthorError, match="--format"):
            ask(dataset, text, form)


@pytest.mark.parametrize("text", [EVERYTHING, "CONSTRUCT WHERE { ?s ?p ?o }"])
def test_rows_beyond_the_limit_are_left_out_and_said_to_be(dataset: Dataset, text: str) -> None:
    assert answer(dataset, Question(text, "json", 2)).cut
    assert not answer(dataset, Question(text, "json", 100)).cut
    assert len(json.loads(ask(dataset, EVERYTHING, "json", 2))["results"]["bindings"]) == 2


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
    with pytest.raises(QueryError, match="nested too deeply"):
        ask(dataset, "SELECT * WHERE " + "{" * deep + " ?s ?p ?o " + "}" * deep)


@pytest.mark.parametrize("option", [["--rows", "0"], ["--seconds", "0"]])
def test_a_limit_of_nothing_is_misuse(option: list[str], tmp_path: Path) -> None:
    assert main(["query", "ASK {}", "--ads", str(tmp_path), *option]) == 2


def test_what_was_cut_is_said_on_stderr(capsys: pytest.CaptureFixture[str]) -> None:
    example = Path(__file__).parents[2] / "examples" / "peis-home"
    assert main(["query", "SELECT ?c { ?c a sc:Component }", "--ads", str(example), "--rows", "1"]) == 0
    said = capsys.readouterr()
    assert len(said.out.splitlines()) == 3
    assert "more than 1 rows" in said.err
