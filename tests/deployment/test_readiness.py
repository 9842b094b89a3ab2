"""A task that runs is ready for a failure: what may come next is found out once, and told to those that it concerns."""

from __future__ import annotations

from typing import Any

import pytest

from selfconf.model.term import IRI
from tests.lab import Lab


def test_however_many_components_come_back_at_once_it_is_found_out_once_what_may_come_next(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.let_pass(1.0)
    found_out: list[object] = []
    monkeypatch.setattr(agent._components.calls, "stand_by", lambda configuration, standby: found_out.append(standby))
    for _ in range(5):
        lab.crash("odometry")
        lab.let_pass(0.01)
        lab.component("odometry")
        lab.let_pass(0.01)
    lab.let_pass(1.0)
    assert len(found_out) == 1


def test_no_component_is_told_anew_what_may_come_next_where_that_has_stayed(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.let_pass(1.0)
    asked: list[IRI] = []
    ask = agent._components.calls._calling.ask

    def noted(component: IRI, *more: Any) -> None:
        asked.append(component)
        ask(component, *more)

    monkeypatch.setattr(agent._components.calls._calling, "ask", noted)
    lab.crash("odometry")
    lab.let_pass(0.1)
    lab.component("odometry")
    lab.let_pass(1.0)
    assert asked == []


def test_a_component_that_is_applied_to_anew_is_told_again_what_may_come_next(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    agent = lab.agent()
    calls, applied, asked = agent._components.calls, dict[IRI, Any](), list[IRI]()
    apply, ask = calls._apply, calls._calling.ask

    def noted(effect: Any) -> None:
        applied[effect.component] = effect
        apply(effect)

    def noted_ask(component: IRI, *more: Any) -> None:
        asked.append(component)
        ask(component, *more)

    monkeypatch.setattr(calls, "_apply", noted)
    lab.running(agent)
    lab.let_pass(1.0)
    component = next(iter(calls._stood_by))
    monkeypatch.setattr(calls._calling, "ask", noted_ask)
    apply(applied[component])
    agent._readiness.prepare()
    lab.let_pass(1.0)
    assert asked == [component] * 2, "it is applied to, and then told"


def test_what_was_found_out_for_a_configuration_that_runs_no_more_is_told_to_none(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.let_pass(1.0)
    told: list[object] = []
    monkeypatch.setattr(agent._components.calls, "stand_by", lambda configuration, standby: told.append(standby))
    agent._readiness.prepare()
    agent.stop()
    lab.let_pass(1.0)
    agent._readiness.prepare()
    lab.let_pass(1.0)
    assert told == []
