"""Which task holds a component: reservations, sharing, and what is said as it is released."""

from __future__ import annotations

from dataclasses import replace

from selfconf.model.term import Literal
from selfconf.protocol.messages import Cause, Verdict
from tests.lab import Recorder
from tests.sdk.stage import (
    CAP_PROFILE,
    DRIVE_PROFILE,
    TASKS,
    THEM,
    TRACKER_PROFILE,
    US,
    Stage,
    apply,
    follow,
    release,
    reserve,
)


def test_a_component_is_reserved_without_acting() -> None:
    stage = Stage()
    answer = stage.call(reserve(1, US))
    assert (answer.verdict, answer.active, answer.task) == (Verdict.DONE, False, TASKS[US])
    assert stage.recorder.said == []
    stage.others.announce(THEM)
    answer = stage.call(apply(1, THEM))
    assert (answer.verdict, answer.task) == (Verdict.BUSY, TASKS[US])
    assert stage.call(apply(2, US)).active
    assert stage.recorder.said == [("started",)]


def test_an_actuator_does_not_act_for_a_task_that_has_not_reserved_it() -> None:
    stage = Stage(profile=DRIVE_PROFILE)
    assert stage.call(apply(1, US)).verdict is Verdict.NOT_HELD
    assert stage.recorder.said == []
    stage.call(reserve(1, US))
    assert stage.call(apply(1, US)).verdict is Verdict.DONE


def test_what_is_released_while_another_task_has_reserved_it_says_nothing_that_configurators_heed() -> None:
    stage = Stage(profile=TRACKER_PROFILE)
    stage.others.announce(THEM)
    stage.call(apply(1, US))
    assert stage.call(reserve(5, THEM)).verdict is Verdict.DONE
    assert not stage.call(release(2, US)).active
    stage.let_pass(0.1)
    assert [(fail.cause, fail.epoch, fail.task) for fail in stage.said] == [(Cause.LET_GO, 0, "")]


def test_a_component_that_is_asked_to_yield_still_feeds_those_that_follow_it() -> None:
    class Watchful(Recorder):
        def unfed(self, port: str) -> None:
            self.said.append(("unfed", port))

    stage = Stage(Watchful())
    tracker = stage.neighbour()
    stage.others.announce(THEM)
    stage.call(follow())
    tracker._put_fail(Cause.YIELD, "somebody asks for it")
    stage.let_pass(0.1)
    assert stage.recorder.said == [("started",)]


def test_a_shared_component_acts_while_one_of_its_tasks_has_applied_to_it() -> None:
    stage = Stage(profile=replace(CAP_PROFILE, shareable=True))
    stage.others.announce(THEM)
    for supervisor in (US, THEM):
        assert stage.call(apply(1, supervisor)).verdict is Verdict.DONE
    assert stage.call(apply(1, THEM, values={"goal": Literal("x")}, task="other~1")).verdict is Verdict.BUSY
    assert stage.call(release(2, US)).verdict is Verdict.DONE
    assert stage.component.active
    assert (stage.state(TASKS[THEM]).active, stage.state(TASKS[US]).task) == (True, TASKS[THEM])
    stage.call(release(2, THEM))
    assert stage.recorder.said == [("started",), ("stopped",)]
