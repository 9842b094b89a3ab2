"""What a configurator goes through before a first failure: it changes nothing, and is what a failure would do."""

from __future__ import annotations

import pytest

from selfconf.configurator import Failed, Phase, State
from selfconf.deployment import warm_up
from selfconf.deployment.warm_up import TIMES, warm_up_failure
from selfconf.protocol.messages import Cause
from tests.lab import Lab


def test_a_failure_is_gone_through_and_the_task_runs_on(lab: Lab, monkeypatch: pytest.MonkeyPatch) -> None:
    heard: list[tuple[State, object]] = []
    step = warm_up.step

    def stepped(state: State, event: object) -> object:
        heard.append((state, event))
        return step(state, event)  # type: ignore[arg-type]  # it is handed on

    monkeypatch.setattr(warm_up, "step", stepped)
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
