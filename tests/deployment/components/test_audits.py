"""Components that run are asked, in turns, whether they still act for the task."""

from __future__ import annotations

from collections import Counter

import pytest

from selfconf.configurator.state import Phase
from selfconf.deployment.components.audits import AUDIT, SILENT_AUDITS
from selfconf.model.term import IRI
from selfconf.sdk.inputs import Inputs
from selfconf.sdk.runtime import ComponentRuntime
from tests.deployment.tasks import TASK
from tests.lab import Lab, Recorder, iri

pytestmark = pytest.mark.usefixtures("followed")


def test_a_component_that_has_let_go_of_its_task_unnoticed_is_applied_to_anew(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It has seen the life of the configurator end, which goes on, and what it has said of that is lost."""
    agent = lab.agent()
    lab.running(agent)
    for name in ("tracker", "drive"):
        connected = len(lab.acts("connecting"))
        with monkeypatch.context() as patch:
            patch.setattr(lab.runtimes[name], "_put_fail", lambda *_: None)
            lab.runtimes[name]._orphaned(agent.supervisor)
        lab.let_pass(0.1)
        assert lab.active() == (TASK | {"tracker"}) - {name}
        lab.let_pass(2 * AUDIT)
        assert lab.active() == TASK | {"tracker"}
        assert len(lab.acts("connecting")) == connected + 4  # any may have turned itself off, and lost what it followed
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
    lab.let_pass((SILENT_AUDITS + 0.5) * AUDIT)
    assert lab.active() >= TASK | {"odometry"}
    (lost,) = lab.acts("lost")
    assert (lost.component, lost.cause) == (iri("person-tracker"), "hung")


def test_a_component_that_answers_no_question_is_replaced_though_another_process_answers_in_its_place(lab: Lab) -> None:
    """The other one stays, as its life has the smaller name, and the one that acts hangs, and so does not leave."""
    agent = lab.agent()
    lab.running(agent)
    hangs = lab.runtimes["tracker"]
    hangs.calls.close()
    hangs._other_lives.close()
    another = ComponentRuntime(lab.network.node(), lab.keys, hangs.profile, Recorder(), "0")
    lab.let_pass((SILENT_AUDITS + 0.5) * AUDIT)
    assert not another.closed
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


def test_only_audits_in_a_row_that_were_not_answered_count(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    for _ in range(2):
        for _ in range(SILENT_AUDITS - 1):
            agent._components.audits._judge(iri("person-tracker"), agent.state.epoch, None)
        lab.let_pass(2 * AUDIT)
    assert lab.acts("lost") == []


def test_components_that_are_more_than_one_audit_asks_take_turns(lab: Lab, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("selfconf.deployment.components.audits.AUDITED", 2)
    agent = lab.agent()
    lab.running(agent)
    asked = Counter[IRI]()
    monkeypatch.setattr(agent._components.calls, "look", lambda component, *_: asked.update([component]))
    lab.let_pass(5 * AUDIT)
    assert asked == dict.fromkeys(agent.state.held, 2)  # five components


def test_the_status_says_how_many_signals_a_slow_component_has_passed_over(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    inputs = lab.runtimes["control"].inputs
    assert isinstance(inputs, Inputs)
    next(iter(inputs._inputs.values()))._dropped = 7
    lab.let_pass(4 * AUDIT)
    assert agent.status().dropped == {lab.runtimes["control"].profile.component: 7}
