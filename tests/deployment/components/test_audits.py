"""Components that run are asked, in turns, whether they still act for the task."""

from __future__ import annotations

import pytest

from selfconf.configurator.state import Phase
from selfconf.deployment.components.audits import AUDIT, SILENT_AUDITS
from selfconf.sdk.inputs import Inputs
from tests.deployment.tasks import TASK
from tests.lab import Lab, iri

pytestmark = pytest.mark.usefixtures("followed")


def test_a_component_that_has_let_go_of_its_task_unnoticed_is_applied_to_anew(lab: Lab) -> None:
    """It has seen the life of the configurator end, which goes on, and the configurator has seen nothing."""
    agent = lab.agent()
    lab.running(agent)
    for name in ("tracker", "drive"):
        lab.runtimes[name]._orphaned(agent.supervisor)
        assert lab.active() == (TASK | {"tracker"}) - {name}
        lab.let_pass(2 * AUDIT)
        assert lab.active() == TASK | {"tracker"}
    assert lab.acts("lost") == []
    assert agent.state.phase is Phase.RUNNING


def test_a_component_that_has_failed_unnoticed_is_replaced(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.runtimes["tracker"].code.end_acting()
    lab.let_pass(2 * AUDIT)
    assert lab.active() == TASK | {"odometry"}
    (lost,) = lab.acts("lost")
    assert (lost.component, lost.detail) == (iri("person-tracker"), "it does not act any more")


def test_a_component_that_lives_and_answers_no_question_is_replaced(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.runtimes["tracker"].calls.close()
    lab.let_pass((SILENT_AUDITS + 1) * AUDIT)
    assert lab.active() >= TASK | {"odometry"}
    (lost,) = lab.acts("lost")
    assert (lost.component, lost.cause) == (iri("person-tracker"), "hung")


def test_what_a_component_has_not_answered_in_its_last_life_does_not_count_in_the_next(lab: Lab) -> None:
    lab.crash("odometry")
    agent = lab.agent(patient=True)
    for _ in range(2):
        assert lab.running(agent)
        lab.runtimes["tracker"].calls.close()
        lab.let_pass(1.5 * AUDIT)
        assert agent.state.phase is Phase.RUNNING
        assert lab.until(lambda: agent.state.phase is Phase.REFUSED)
        lab.crash("tracker")
        lab.let_pass(1.0)
        lab.component("tracker")


def test_the_status_says_how_many_signals_a_slow_component_has_passed_over(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    inputs = lab.runtimes["control"].inputs
    assert isinstance(inputs, Inputs)
    next(iter(inputs._inputs.values()))._dropped = 7
    lab.let_pass(4 * AUDIT)
    assert agent.status().dropped == {lab.runtimes["control"].profile.component: 7}
