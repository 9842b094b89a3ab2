"""The supervision of a component: it obeys a configurator only as long as that is alive."""

from __future__ import annotations

from dataclasses import replace

import pytest

from selfconf.protocol.activation import ActivationPhase
from selfconf.protocol.messages import Verdict
from selfconf.sdk.runtime.supervision import GRACE
from tests.sdk.stage import CAP_PROFILE, TASKS, THEM, US, Stage, apply, release, reserve


def test_a_component_whose_configurator_is_gone_turns_itself_off_after_the_grace_period() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    stage.let_pass(100)
    assert stage.component.active
    stage.leave()
    stage.let_pass(GRACE - 0.1)
    assert stage.component.active
    stage.let_pass(0.2)
    assert stage.recorder.said == [("started",), ("stopped",)]
    assert stage.runtime.activation.phase is ActivationPhase.IDLE


def test_a_configurator_that_is_back_within_the_grace_period_is_still_obeyed() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    stage.leave()
    stage.let_pass(GRACE / 2)
    stage.caller.announce(US)
    stage.let_pass(10 * GRACE)
    assert stage.component.active


def test_a_component_that_is_cut_off_turns_itself_off() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    node = stage.network.nodes[2]
    assert stage.runtime.bus is node
    stage.network.cut(node, stage.caller)
    stage.let_pass(GRACE + 0.1)
    assert not stage.component.active


def test_a_configurator_that_was_never_there_is_not_obeyed_for_long() -> None:
    stage = Stage()
    stage.call(apply(1, THEM))
    stage.let_pass(GRACE + 0.1)
    assert not stage.component.active


def test_a_component_that_has_failed_is_free_again_when_its_configurator_is_gone() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    stage.component.fail("lost her")
    stage.leave()
    stage.let_pass(GRACE + 0.1)
    assert stage.runtime.activation.phase is ActivationPhase.IDLE
    assert stage.recorder.said[-1] == ("stopped",)


@pytest.mark.parametrize("task", TASKS.values())
def test_a_held_component_is_busy_for_another_configurator_as_long_as_its_own_lives(task: str) -> None:
    """Whether that one runs another task, or believes that it runs this one."""
    stage = Stage()
    stage.others.announce(THEM)
    stage.call(apply(1, US))
    stage.let_pass(0.1)
    assert stage.call(apply(2, THEM, task=task)).verdict is Verdict.BUSY
    assert stage.call(reserve(2, THEM, task=task)).verdict is Verdict.BUSY
    stage.call(release(2, THEM, task=task))
    assert stage.component.active


def test_another_configurator_goes_on_with_the_task_without_a_stop_as_soon_as_the_first_is_gone() -> None:
    stage = Stage()
    leave = stage.others.announce(THEM)
    stage.call(apply(1, US))
    stage.let_pass(0.1)
    stage.leave()
    stage.let_pass(0.1)
    assert stage.call(apply(2, THEM, task=TASKS[US])).verdict is Verdict.DONE
    stage.let_pass(10 * GRACE)
    assert stage.component.active
    assert stage.recorder.said == [("started",)]
    stage.caller.announce(US)
    stage.let_pass(0.1)
    assert stage.call(apply(3, US)).verdict is Verdict.BUSY
    leave()
    stage.let_pass(GRACE + 0.1)
    assert not stage.component.active


def test_another_configurator_goes_on_with_the_task_of_one_whose_last_call_came_after_it_had_left() -> None:
    stage = Stage()
    stage.leave()
    stage.let_pass(0.1)
    stage.call(apply(1, US))
    stage.others.announce(THEM)
    stage.let_pass(GRACE / 2)
    assert stage.call(apply(2, THEM)).verdict is Verdict.BUSY, "to other tasks it may be there"
    assert stage.call(apply(1, THEM, task=TASKS[US])).verdict is Verdict.DONE
    stage.let_pass(10 * GRACE)
    assert stage.recorder.said == [("started",)]


def test_a_configurator_that_is_gone_keeps_the_component_from_no_other_task() -> None:
    stage = Stage()
    stage.others.announce(THEM)
    stage.call(apply(1, US))
    stage.let_pass(0.1)
    stage.leave()
    stage.let_pass(0.1)
    assert stage.call(apply(1, THEM)).verdict is Verdict.DONE
    stage.let_pass(10 * GRACE)
    assert stage.component.active
    assert stage.state().task == TASKS[THEM]


def test_a_reservation_ends_with_the_configurator_that_made_it() -> None:
    stage = Stage()
    stage.others.announce(THEM)
    assert stage.call(reserve(1, US)).verdict is Verdict.DONE
    assert stage.call(reserve(1, THEM)).verdict is Verdict.BUSY
    stage.leave()
    stage.let_pass(GRACE + 0.1)
    assert stage.state().task == ""
    assert stage.freed == [TASKS[THEM]]
    assert stage.recorder.said == []


def test_a_shared_component_acts_on_for_the_task_whose_configurator_lives() -> None:
    stage = Stage(profile=replace(CAP_PROFILE, shareable=True))
    stage.others.announce(THEM)
    for supervisor in (US, THEM):
        assert stage.call(apply(1, supervisor)).verdict is Verdict.DONE
    stage.leave()
    stage.let_pass(10 * GRACE)
    assert stage.component.active
    assert stage.recorder.said == [("started",)]
    assert stage.state().task == TASKS[THEM]


def test_the_supervision_of_an_earlier_configuration_has_ended_with_it() -> None:
    stage = Stage()
    stage.others.announce(THEM)
    stage.call(apply(1, US))
    stage.call(release(2, US))
    stage.call(apply(3, THEM))
    stage.leave()
    stage.let_pass(10 * GRACE)
    assert stage.component.active
