"""A search of a running task: what ends it, and what becomes of the task when it breaks."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest

from selfconf.bus.port import Undo
from selfconf.configurator.events import Appeared, Improvable
from selfconf.deployment import TaskRunner
from selfconf.deployment.improvement import LET_GO_OF
from selfconf.errors import TemplateError
from selfconf.model.configuration import Configuration
from selfconf.model.refusal import Outcome
from selfconf.model.term import IRI
from selfconf.rdf import conformance as shacl
from selfconf.rdf.advertisements import Advertisement
from tests.deployment.tasks import DRIVEN, SPARE, TASK
from tests.lab import NAVIGATE, Lab, iri


def test_a_shape_that_cannot_be_judged_ends_the_task_with_its_error(lab: Lab, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shacl, "SHAPE_SECONDS", 0.00001)  # over before any component is looked at
    pairs = " . ".join(f"$this ?p{number} ?o{number}" for number in range(9))
    broken = NAVIGATE + f':drive sh:sparql [ sh:select "SELECT $this {{ {pairs} FILTER ( ?o8 > 2 ) }}" ] .\n'
    agent = lab.agent(broken)
    assert lab.until(lambda: bool(lab.ended))
    assert isinstance(agent.trouble, TemplateError)
    assert lab.active() == set()


def test_a_search_that_breaks_ends_the_task_which_says_so(lab: Lab) -> None:
    def broken(*_: object) -> Outcome:
        raise TypeError("soon is no number")

    agent = lab.agent(patient=True)
    agent._search._request = replace(agent.request, compose=broken)
    assert lab.until(lambda: bool(lab.ended))
    assert "soon is no number" in str(agent.trouble)
    assert lab.active() == set()


def searching_aside(lab: Lab) -> tuple[TaskRunner, list[Callable[[], None]], list[Callable[[], None]]]:
    """A task, the searches that it begins, each to be made by calling it, and those of them that it abandons."""
    searches, abandoned = list[Callable[[], None]](), list[Callable[[], None]]()

    def aside(work: Callable[[], None]) -> Undo:
        searches.append(work)
        return partial(abandoned.append, work)

    agent = lab.agent()
    agent._search._request = replace(agent.request, aside=aside)  # of the search alone
    return agent, searches, abandoned


def test_a_search_is_abandoned_when_its_task_ends(lab: Lab) -> None:
    agent, searches, abandoned = searching_aside(lab)
    assert lab.until(lambda: bool(searches))
    agent.stop()
    assert lab.until(lambda: bool(lab.ended))
    assert abandoned == searches


def test_a_search_is_abandoned_when_another_begins_and_no_sooner(lab: Lab) -> None:
    agent, searches, abandoned = searching_aside(lab)
    assert lab.until(lambda: len(searches) == 1)
    searches[0]()
    assert lab.running(agent)
    agent._step(Improvable())
    assert lab.until(lambda: len(searches) == 2)
    agent._step(Appeared({}))  # no reason to begin anew: what appears all the time must not keep a task from its answer
    lab.let_pass(1.0)
    assert abandoned == searches[:1]  # which is over
    lab.components["tracker"].fail("Astrid has left the picture")
    assert lab.until(lambda: len(searches) == 3)
    assert abandoned == searches[:2]
    searches[2]()
    assert lab.running(agent)
    assert lab.active() == TASK | {"odometry"}


def test_a_task_that_runs_searches_for_something_better_once_for_each_change(tmp_path: Path) -> None:
    advertised = SPARE | {"third": SPARE["left"].replace(":left", ":third")}
    lab = Lab(tmp_path, advertised=advertised)
    lab.site("shared", *SPARE)
    for name in SPARE:
        lab.component(name)
    first = lab.agent(DRIVEN, (), name="first")
    assert lab.running(first)
    agent, searches = lab.agent(DRIVEN, (), upgrade=1.0), list[frozenset[IRI]]()
    compose = agent.request.compose

    def counted(found: Mapping[IRI, Advertisement], lost: frozenset[IRI], running: Configuration | None) -> Outcome:
        if running is None:
            searches.append(lost)
        return compose(found, lost, running)

    agent._search._request = replace(agent.request, compose=counted)
    assert lab.running(agent)
    lab.let_pass(10 * LET_GO_OF)
    assert searches == [{iri("left")}] * 2, "to be configured, and to look for something better"
    first.stop()
    lab.let_pass(2 * LET_GO_OF)
    assert lab.active() == {"left"}
    assert searches[2:] == [frozenset()]
    lab.site("another", "third")
    lab.component("third")
    lab.let_pass(2 * LET_GO_OF)
    assert len(searches) == 4
