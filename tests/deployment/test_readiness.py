"""A task that runs is ready for a failure: what may come next is found out once, and told to those that it concerns.

A first failure is gone through before: that changes nothing, and is what a failure would do.
"""

from __future__ import annotations

from typing import Any

import pytest

from selfconf.configurator import Failed, Phase, State
from selfconf.deployment import readiness
from selfconf.deployment.readiness import TIMES, warm_up_failure
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause
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


def test_a_failure_is_gone_through_and_the_task_runs_on(lab: Lab, monkeypatch: pytest.MonkeyPatch) -> None:
    heard: list[tuple[State, object]] = []
    step = readiness.step

    def stepped(state: State, event: object) -> object:
        heard.append((state, event))
        return step(state, event)  # type: ignore[arg-type]  # it is handed on

    monkeypatch.setattr(readiness, "step", stepped)
    agent = lab.agent()
    assert lab.running(agent)
    assert len(heard) >= TIMES
    state, failed = heard[-1]
    assert state.phase is Phase.RUNNING
    assert isinstance(failed, Failed)
    assert (failed.component in state.held, failed.cause) == (True, Cause.FAIL)
    after, effects = step(state, failed)
    assert failed.component in after.lost
    assert effects
    assert agent.state.lost == {}
    assert agent.state.phase is Phase.RUNNING


def test_nothing_is_gone_through_where_nothing_is_held() -> None:
    warm_up_failure(State())
