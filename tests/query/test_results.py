"""The formats of an answer agree with Oxigraph's own."""

from __future__ import annotations

import csv
import io
import json

import pytest

from selfconf.errors import AuthorError
from selfconf.model.term import IRI
from selfconf.query import Question, answer
from selfconf.rdf.sparql.dataset import Dataset
from selfconf.rdf.turtle import document as turtle

pytestmark = pytest.mark.usefixtures("asked_here")


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


def test_a_text_with_a_carriage_return_is_one_field_of_csv(dataset: Dataset) -> None:
    written = ask(dataset, "SELECT ?a ?b { VALUES (?a ?b) { ('x\\ry' 'z') ('' UNDEF) } }", "csv")
    assert list(csv.reader(io.StringIO(written, newline=""))) == [["a", "b"], ["x\ry", "z"], ["", ""]]


@pytest.mark.parametrize(("form", "word"), [("turtle", "<urn:b>"), ("json", '"@id":"urn:b"')])
def test_triples_are_turtle_or_json_ld(dataset: Dataset, form: str, word: str) -> None:
    assert word in ask(dataset, "CONSTRUCT WHERE { ?s ?p ?o }", form)


def test_a_format_that_does_not_fit_the_query_is_refused(dataset: Dataset) -> None:
    for text, form in ((EVERYTHING, "turtle"), ("CONSTRUCT WHERE { ?s ?p ?o }", "csv")):
        with pytest.raises(AuthorError, match="format="):
            ask(dataset, text, form)


@pytest.mark.parametrize("text", [EVERYTHING, "CONSTRUCT WHERE { ?s ?p ?o }"])
def test_rows_beyond_the_limit_are_left_out_and_said_to_be(dataset: Dataset, text: str) -> None:
    assert answer(dataset, Question(text, "json", 2)).cut
    assert not answer(dataset, Question(text, "json", 100)).cut
    assert len(json.loads(ask(dataset, EVERYTHING, "json", 2))["results"]["bindings"]) == 2
