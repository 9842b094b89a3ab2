"""A task as it is handed to the sites, and as a site reads it."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace
from io import BytesIO, TextIOWrapper
from pathlib import Path
from typing import Any

import pyoxigraph as ox
import pytest

import selfconf as sc
from selfconf.api.method import Method
from selfconf.api.tasks.detached import request_of, task_record
from selfconf.api.tasks.explaining import explained_refusal
from selfconf.api.tasks.role_fits import role_fits
from selfconf.api.tasks.task_options import TaskOptions
from selfconf.errors import AuthorError, ProgrammerError, SelfconfError
from selfconf.model.configuration import Configuration
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.messages import TaskRecord
from selfconf.rdf.vocabulary import RDFS
from tests.lab import PREFIXES

ROOT = Path(__file__).resolve().parents[3]


def record() -> TaskRecord:
    """The clock's task, as its record arrives at a site."""
    task = sc.template(ROOT / "examples" / "clock" / "tell-the-time.ttl").bind(room=":kitchen")
    return decode(encode(task_record(task, Method.of("best"), TaskOptions(priority=2, upgrade=5.0))), TaskRecord)


def test_a_site_composes_what_the_library_composes() -> None:
    home = sc.read(ROOT / "examples" / "clock")
    request = request_of(record(), lambda work: work())
    outcome = request.compose(home.advertisements(), frozenset(), None)
    wanted = sc.configure(sc.template(ROOT / "examples" / "clock" / "tell-the-time.ttl").bind(room=":kitchen"), home)
    assert isinstance(outcome, Configuration)
    assert isinstance(wanted, Configuration)
    assert (outcome.assignments, outcome.connections) == (wanted.assignments, wanted.connections)
    assert (request.patient, request.priority, request.upgrade) == (True, 2, 5.0)


def test_a_site_explains_a_refusal_as_the_library_does() -> None:
    home, later, found = sc.read(ROOT / "examples" / "clock"), list[Callable[[], None]](), list[sc.Refusal]()
    task = sc.template(ROOT / "examples" / "clock" / "tell-the-time.ttl").bind(room=":cellar")
    kept = decode(encode(task_record(task, Method.of())), TaskRecord)
    request = request_of(kept, lambda work: lambda: None, at_leisure=later.append)
    plain = request.compose(home.advertisements(), frozenset(), None)
    wanted = sc.configure(task, home)
    assert isinstance(plain, sc.Refusal)
    assert isinstance(wanted, sc.Refusal)
    request.explain(plain, found.append)
    assert found == []
    (find,) = later
    find()
    assert (found[0].near_misses, found[0].repairs, found[0].hint) == (wanted.near_misses, wanted.repairs, wanted.hint)
    assert found[0].repairs
    assert not plain.repairs


HALL_LAMP = PREFIXES + ":lamp a sc:Component, <#HallLamp> ."
LIT = PREFIXES + ":lit a sc:Template ; sc:roles ( :light ) .\n:light a sc:Role ; sh:class <{}#Lamp> ."


def ontology(folder: Path, form: ox.RdfFormat) -> Path:
    """What a lamp in the hall is, by relative IRIs, in a file of a format."""
    path = folder / f"lamps.{form.file_extension}"
    words = f"@base <{path.as_uri()}> .\n<#HallLamp> <{RDFS.subClassOf}> <#Lamp> ."
    triples = [quad.triple for quad in ox.parse(words.encode(), format=ox.RdfFormat.TURTLE)]
    text = (ox.serialize(triples, format=form) or b"").decode()
    path.write_text(text.replace(path.as_uri(), ""))
    assert "lamps" not in path.read_text()
    return path


@pytest.mark.parametrize("form", [ox.RdfFormat.TURTLE, ox.RdfFormat.RDF_XML, ox.RdfFormat.JSON_LD], ids=str)
@pytest.mark.parametrize("reasoning", ["syntactic", "subclass"])
def test_a_site_explains_the_refusal_of_a_task_with_an_ontology(
    tmp_path: Path, form: ox.RdfFormat, reasoning: str
) -> None:
    path, later, found = ontology(tmp_path, form), list[Callable[[], None]](), list[sc.Refusal]()
    task = sc.template(LIT.format(path.as_uri()))
    lamp = sc.read(HALL_LAMP.replace("<#", f"<{path.as_uri()}#"))
    method = Method.of(reasoning=reasoning, ontologies=tmp_path)
    record = decode(encode(task_record(task.complete(), method)), TaskRecord)
    path.unlink()
    request = request_of(record, lambda work: lambda: None, at_leisure=later.append)
    assert isinstance(request.compose(lamp.advertisements(), frozenset(), None), Configuration) == (
        reasoning == "subclass"
    )
    ecology = {} if reasoning == "subclass" else lamp.advertisements()
    refused = request.compose(ecology, frozenset(), None)
    assert isinstance(refused, sc.Refusal)
    request.explain(refused, found.append)
    later[0]()
    hint = None if reasoning == "subclass" else "with reasoning='subclass' there is a configuration"
    assert found[0].hint == hint
    told = explained_refusal(record, ecology, ())
    assert (hint in str(told["repairs"])) if hint else (told["repairs"] != [])
    for advertisement in lamp.advertisements().values():
        assert [fit.near for fit in role_fits(record, advertisement)] == [True]


def test_an_ontology_on_standard_input_is_kept_with_its_task(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdin", TextIOWrapper(BytesIO(b"<urn:HallLamp> <urn:x> <urn:Lamp> .")))
    task = sc.template(LIT.format("urn:"))
    kept = task_record(task.complete(), Method.of(ontologies="-"))
    assert [text.partition(" . ")[2] for text in kept.ontologies] == ["<urn:HallLamp> <urn:x> <urn:Lamp> ."]


def test_a_refusal_is_explained_by_the_ecology_in_which_it_was_found() -> None:
    home, later, found = sc.read(ROOT / "examples" / "clock"), list[Callable[[], None]](), list[sc.Refusal]()
    task = sc.template(ROOT / "examples" / "clock" / "tell-the-time.ttl").bind(room=":cellar")
    kept = decode(encode(task_record(task, Method.of())), TaskRecord)
    request = request_of(kept, lambda work: lambda: None, at_leisure=later.append)
    refused = request.compose(home.advertisements(), frozenset(), None)
    request.compose({}, frozenset(), None)  # the next search begins before the refusal of the first is reported
    assert isinstance(refused, sc.Refusal)
    request.explain(refused.told_of_held({}), found.append)
    later[0]()
    wanted = sc.configure(task, home)
    assert isinstance(wanted, sc.Refusal)
    assert found[0].near_misses == wanted.near_misses != ()


def test_a_template_in_a_file_whose_name_is_no_text_can_be_handed_to_the_sites(tmp_path: Path) -> None:
    file = tmp_path / os.fsdecode(b"clock-\xff.ttl")
    file.write_bytes((ROOT / "examples" / "clock" / "tell-the-time.ttl").read_bytes())
    handed = task_record(sc.template(file).bind(room=":kitchen"), Method.of())
    assert decode(encode(handed), TaskRecord).source.endswith("clock-?.ttl")


def test_a_task_is_named_after_its_template_unless_it_is_told_otherwise() -> None:
    assert record().task.startswith("tell-the-time~")
    task = sc.template(ROOT / "examples" / "clock" / "tell-the-time.ttl")
    with pytest.raises(AuthorError, match="cannot name a task"):
        task_record(task, Method.of(), TaskOptions(name="no/name"))


def test_a_priority_that_no_component_would_take_and_an_upgrade_that_never_comes_are_refused() -> None:
    task = sc.template(ROOT / "examples" / "clock" / "tell-the-time.ttl")
    with pytest.raises(ProgrammerError, match="a priority is a whole number"):
        task_record(task, Method.of(), TaskOptions(priority=10**23))
    with pytest.raises(ProgrammerError, match="an upgrade comes after"):
        task_record(task, Method.of(), TaskOptions(upgrade=-1))


@pytest.mark.parametrize(
    "options",
    [
        {"policy": "x"},
        {"policy": ["repair"]},
        {"strategy": 3},
        {"steps": 2.5},
        {"steps": True},
        {"seconds": "soon"},
        {"seconds": -1},
        {"upgrade": {}},
        {"upgrade": float("inf")},
        {"upgrade": 2e6},
    ],
    ids=str,
)
def test_options_that_are_none_are_refused_by_the_reader_and_break_nothing_later(options: dict[str, Any]) -> None:
    with pytest.raises(SelfconfError):
        request_of(replace(record(), options=options), lambda work: work())
