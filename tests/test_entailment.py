"""The OWL RL closure: right, remembered, and never longer than its limit."""

from __future__ import annotations

from pathlib import Path

import pytest

import selfconf as sc
from selfconf import entailment
from selfconf.errors import AuthorError
from selfconf.model.hierarchy import Reasoning
from selfconf.model.term import IRI
from selfconf.rdf.reasoning.closure import hierarchy
from selfconf.rdf.turtle import document as turtle

ONTOLOGY = """
@prefix : <urn:x:> .
@prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
:Tracker rdfs:subClassOf :Sensor . :Sensor owl:equivalentClass :Fuehler .
:Mobile owl:unionOf ( :Robot :Tracker ) .
:height rdfs:label "10" . :width rdfs:label "10.0" .
"""


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("SELFCONF_CACHE_DIR", str(tmp_path))
    return tmp_path


def closed() -> set[tuple[str, str]]:
    found = hierarchy([turtle.parse(ONTOLOGY, "o.ttl")], Reasoning.OWL_RL, entailment.entailed_hierarchy)
    return {("Tracker", above.rpartition(":")[2]) for above in found.superclasses(IRI("urn:x:Tracker"))}


def test_a_union_is_above_its_parts_as_owl_says() -> None:
    assert closed() >= {("Tracker", "Sensor"), ("Tracker", "Fuehler"), ("Tracker", "Mobile")}


def test_a_closure_is_computed_once(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = closed()
    (kept,) = cache.rglob("*.nt")
    monkeypatch.setenv("SELFCONF_OWL_RL_SECONDS", "0.000001")  # computing it again would fail
    assert closed() == first
    assert kept.read_bytes()


def test_a_closure_that_takes_too_long_is_ended_with_advice(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SELFCONF_OWL_RL_SECONDS", "0.01")
    with pytest.raises(AuthorError, match=r"takes more than 0\.01 s; use reasoning='subclass'"):
        closed()


def test_without_a_home_nothing_is_remembered(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for variable in ("SELFCONF_CACHE_DIR", "XDG_CACHE_HOME", "HOME"):
        monkeypatch.delenv(variable, raising=False)
    monkeypatch.setattr("pwd.getpwuid", {}.__getitem__)  # the user is in no list
    file = tmp_path / "nothing.ttl"
    file.write_text("<urn:a> <urn:p> <urn:b> .")
    for _ in range(2):
        assert closed() >= {("Tracker", "Sensor")}
        assert sc.validate(file, cache=True).conforms


def test_a_cache_that_cannot_be_written_is_done_without(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    blocked = cache / "file"
    blocked.write_text("not a folder")
    monkeypatch.setenv("SELFCONF_CACHE_DIR", str(blocked))
    assert ("Tracker", "Sensor") in closed()


def test_a_closure_that_cannot_be_kept_leaves_no_half_of_it_behind(
    cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    closed()
    (kept,) = cache.rglob("*.nt")
    kept.unlink()
    kept.mkdir()  # a file cannot take the place of a folder
    assert ("Tracker", "Sensor") in closed()
    assert list(kept.parent.iterdir()) == [kept]


@pytest.mark.parametrize("given", ["abc", "0", "-1", "nan", "inf", "", "1_0", "\u0661"])
def test_a_limit_that_is_no_time_is_a_sentence(given: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SELFCONF_OWL_RL_SECONDS", given)
    with pytest.raises(
        AuthorError, match=f"SECONDS is a number of seconds above zero and at most 1,000,000, not '{given}'"
    ):
        closed()
