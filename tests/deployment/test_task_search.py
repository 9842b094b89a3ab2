"""A search of a running task: what ends it, and what becomes of the task when it breaks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import pytest

from selfconf.bus.port import Undo
from selfconf.configurator.events import Appeared, Improvable
from selfconf.errors import TemplateError
from selfconf.model.refusal import Outcome
from selfconf.rdf import conformance as shacl
from tests.deployment.tasks import TASK
from tests.lab import NAVIGATE, Lab


def test_a_shape_that_cannot_be_judged_ends_the_task_with_its_error(lab: Lab, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shacl, "SHAPE_SECONDS", 0.001)  # over before any component is looked at
    pairs = " . ".join(f"$this ?p{number} ?o{number}" for number in range(9))
    broken = NAVIGATE + f':drive sh:sparql [ sh:select "SELECT $this {{ {pairs} FILTER ( ?o1 > 2 ) }}" ] .\n'
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


def test_a_search_is_abandoned_when_another_begins_and_no_sooner(lab: Lab) -> None:
    searches, abandoned = list[Callable[[], None]](), list[Callable[[], None]]()

    def aside(work: Callable[[], None]) -> Undo:
        searches.append(work)
        return partial(abandoned.append, work)

    agent = lab.agent()
    agent._search._request = replace(agent.request, aside=aside)  # of the search alone
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
