"""Terms of selfconf and SHACL that there are not are named, and all that there are pass."""

from __future__ import annotations

from pathlib import Path

import pytest

import selfconf as sc
from selfconf.api.unknown_terms import undeclared_terms, unknown_in_ecology, unknown_in_query, unknown_in_task
from selfconf.rdf.turtle import parse
from tests.cli.command import run
from tests.lab import PREFIXES

ROOT = Path(__file__).resolve().parents[2]
TEMPLATE = ":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class :Lamp ."
LAMP = ":lamp a sc:Component, :Lamp ."


def test_predicates_and_types_that_there_are_not_are_found() -> None:
    text = (
        f"{PREFIXES} :a a sc:Componnent ; sc:feed :b ; sh:minCnt 1 ; rob:whatever :c ; sc:feeds sc:nothing ; :own 1 ."
    )
    assert undeclared_terms(parse(text.encode(), "a.ttl").triples()) == ["sc:Componnent", "sc:feed", "sh:minCnt"]


@pytest.mark.parametrize("path", sorted((ROOT / "examples").rglob("*.ttl")), ids=lambda path: path.stem)
def test_the_examples_use_terms_that_there_are(path: Path) -> None:
    assert undeclared_terms(parse(path.read_bytes(), path.name, path.as_uri()).triples()) == []


def test_a_template_and_files_of_advertisements_are_told_of_once_each(tmp_path: Path) -> None:
    (tmp_path / "t.ttl").write_text(f"{PREFIXES} {TEMPLATE} :r sh:minCnt 1 ; sc:feed :x .")
    (said,) = unknown_in_task(sc.template(tmp_path / "t.ttl"))
    assert said.startswith(f"{tmp_path / 't.ttl'}: no ontology has the terms sc:feed, sh:minCnt, so they say nothing;")
    (tmp_path / "ads").mkdir()
    (tmp_path / "ads" / "a.ttl").write_text(
        f"{PREFIXES} {LAMP} :lamp sc:preferense 3 . :b a sc:Component, :B ; sc:x 1 ."
    )
    (tmp_path / "ads" / "b.ttl").write_text(f"{PREFIXES} :c a sc:Component, :C .")
    (said,) = unknown_in_ecology(sc.read(tmp_path / "ads").advertisements())
    assert "a.ttl: no ontology has the terms sc:preferense, sc:x" in said


@pytest.mark.parametrize(
    ("query", "unknown"),
    [
        ("SELECT ?c { ?c sc:hasOuput/sc:name ?n ; rob:plaze ?p ; home:x ?y }", ["rob:plaze", "sc:hasOuput"]),
        ("PREFIX s: <https://w3id.org/selfconf#> ASK { ?c s:feed ?x ; sc:feeds ?x }", ["s:feed"]),
        ("PREFIX sc: <urn:x:> ASK { ?c sc:feed 'sh:x' ; <urn:sh:x> ?y } # rob:x", []),
    ],
)
def test_a_query_is_told_of_the_terms_by_which_it_finds_nothing(query: str, unknown: list[str]) -> None:
    said = [f"no ontology of selfconf has the term {term}; is it misspelt?" for term in unknown]
    assert list(unknown_in_query(query)) == said


def test_the_examples_of_queries_use_terms_that_there_are() -> None:
    pages = [*(ROOT / "docs").glob("*.md"), ROOT / "README.md"]
    queries = [line for page in pages for line in page.read_text().splitlines() if "SELECT" in line]
    assert len(queries) > 9
    assert [said for query in queries for said in unknown_in_query(query)] == []


def test_query_says_it_and_answers_all_the_same(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "lamp.ttl").write_text(f"{PREFIXES} {LAMP}")
    outcome = run(capsys, "query", "SELECT ?c { ?c rob:plaze ?p }", "--ads", str(tmp_path / "lamp.ttl"))
    assert outcome.code == 0
    assert outcome.err == "no ontology of selfconf has the term rob:plaze; is it misspelt?\n"


def test_configure_says_it_and_answers_all_the_same(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "t.ttl").write_text(f"{PREFIXES} {TEMPLATE}")
    (tmp_path / "lamp.ttl").write_text(f"{PREFIXES} {LAMP} :lamp sc:preferense 3 .")
    outcome = run(capsys, "configure", str(tmp_path / "t.ttl"), "--ads", str(tmp_path / "lamp.ttl"))
    assert outcome.code == 0
    lamp = tmp_path / "lamp.ttl"
    words = "no ontology has the term sc:preferense, so it says nothing"
    assert outcome.err == f"{lamp}: {words}; `selfconf validate {lamp}` shows where\n"
