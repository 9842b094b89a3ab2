"""A task as it is handed to the sites, and as a site reads it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import selfconf as sc
from selfconf.api.answer import Method
from selfconf.api.detached import request_of, task_record
from selfconf.configurator.state import Policy
from selfconf.errors import AuthorError, ProgrammerError, SelfconfError
from selfconf.model.configuration import Configuration
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.messages import TaskRecord

ROOT = Path(__file__).resolve().parents[2]


def record() -> TaskRecord:
    """The clock's task, as its record arrives at a site."""
    task = sc.template(ROOT / "examples" / "clock" / "tell-the-time.ttl").bind(room=":kitchen")
    return decode(encode(task_record(task, Method.of("best"), Policy.REPAIR, priority=2, upgrade=5.0)), TaskRecord)


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
    kept = decode(encode(task_record(task, Method.of(), Policy.REPAIR)), TaskRecord)
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


def test_a_refusal_is_explained_by_the_ecology_in_which_it_was_found() -> None:
    home, later, found = sc.read(ROOT / "examples" / "clock"), list[Callable[[], None]](), list[sc.Refusal]()
    task = sc.template(ROOT / "examples" / "clock" / "tell-the-time.ttl").bind(room=":cellar")
    kept = decode(encode(task_record(task, Method.of(), Policy.REPAIR)), TaskRecord)
    request = request_of(kept, lambda work: lambda: None, at_leisure=later.append)
    refused = request.compose(home.advertisements(), frozenset(), None)
    request.compose({}, frozenset(), None)  # the next search begins before the refusal of the first is reported
    assert isinstance(refused, sc.Refusal)
    request.explain(refused.told_of_held({}), found.append)
    later[0]()
    wanted = sc.configure(task, home)
    assert isinstance(wanted, sc.Refusal)
    assert found[0].near_misses == wanted.near_misses != ()


def test_a_task_is_named_after_its_template_unless_it_is_told_otherwise() -> None:
    assert record().task.startswith("tell-the-time~")
    task = sc.template(ROOT / "examples" / "clock" / "tell-the-time.ttl")
    with pytest.raises(AuthorError, match="cannot name a task"):
        task_record(task, Method.of(), Policy.REPAIR, "no/name")


def test_a_priority_that_no_component_would_take_and_an_upgrade_that_never_comes_are_refused() -> None:
    task = sc.template(ROOT / "examples" / "clock" / "tell-the-time.ttl")
    with pytest.raises(ProgrammerError, match="a priority is a whole number"):
        task_record(task, Method.of(), Policy.REPAIR, priority=10**23)
    with pytest.raises(ProgrammerError, match="an upgrade comes after"):
        task_record(task, Method.of(), Policy.REPAIR, upgrade=-1)


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
    ],
    ids=str,
)
def test_options_that_are_none_are_refused_by_the_reader_and_break_nothing_later(options: dict[str, Any]) -> None:
    with pytest.raises(SelfconfError):
        request_of(replace(record(), options=options), lambda work: work())
