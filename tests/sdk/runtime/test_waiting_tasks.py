"""The tasks that wait for a component: it is offered to them, and those that hold it yield or are preempted."""

from __future__ import annotations

from selfconf.bus.port import Publisher, Urgency
from selfconf.protocol.messages import Cause, Verdict
from selfconf.sdk.runtime.waiting_tasks import OFFER, YIELDING
from tests.sdk.stage import (
    CAP,
    KEYS,
    TASKS,
    THEM,
    US,
    Stage,
    apply,
    release,
    reserve,
)


def test_a_component_that_is_free_is_offered_to_those_that_wait_in_order() -> None:
    """Higher priority first, then the earlier beginning; each has a moment to come for it."""
    stage = Stage()
    stage.call(apply(1, US))
    stage.others.announce(THEM)
    for task, priority, beginning in (("late~1", 0, 9.0), ("early~1", 0, 3.0), ("high~1", 0, 1.0)):
        message = reserve(1, THEM, task=task, priority=priority, beginning=beginning)
        assert stage.call(message).verdict is Verdict.BUSY
    assert stage.freed == []
    stage.call(release(2, US))
    stage.let_pass(0.05)
    assert stage.freed == ["high~1"]
    stage.let_pass(OFFER)
    assert stage.freed == ["high~1", "early~1"]
    assert stage.call(reserve(1, THEM, task="late~1", beginning=9.0)).verdict is Verdict.BUSY
    assert stage.call(reserve(1, THEM, task="early~1", beginning=3.0)).verdict is Verdict.DONE
    stage.let_pass(3 * OFFER)
    assert stage.freed == ["high~1", "early~1"]


def test_a_task_of_higher_priority_that_begins_to_wait_while_it_is_offered_has_it_offered_in_full() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    stage.others.announce(THEM)
    stage.call(reserve(1, THEM, task="low~1"))
    stage.call(release(2, US))
    stage.let_pass(OFFER / 2)
    assert stage.call(reserve(1, THEM, task="high~1", priority=1, waits=True)).verdict is Verdict.BUSY
    stage.let_pass(0.9 * OFFER)
    assert stage.freed == ["low~1", "high~1"]
    assert stage.call(reserve(1, THEM, task="low~1")).verdict is Verdict.BUSY
    stage.let_pass(0.2 * OFFER)
    assert stage.freed == ["low~1", "high~1", "low~1"], "it has not come for it"


def test_a_component_declares_what_tells_that_it_is_free_once() -> None:
    stage, declared = Stage(), list[str]()
    bus, declare = stage.runtime.bus, stage.runtime.bus.publisher

    def publisher(key: str, urgency: Urgency) -> Publisher:
        declared.append(key)
        return declare(key, urgency)

    bus.publisher = publisher  # type: ignore[assignment, method-assign]  # it is declared as a component declares it
    stage.others.announce(THEM)
    for epoch in (1, 3):
        stage.call(apply(epoch, US))
        assert stage.call(reserve(epoch, THEM, task="late~1")).verdict is Verdict.BUSY
        stage.call(release(epoch + 1, US))
        stage.let_pass(0.05)
        stage.call(release(epoch + 1, THEM, task="late~1"))
    assert stage.freed.count("late~1") == 2
    assert declared == [KEYS.free(CAP)]


def test_a_component_that_nobody_comes_for_is_offered_to_each_once_and_is_free_for_anybody_then() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    stage.others.announce(THEM)
    for task in ("a~1", "b~1"):
        stage.call(reserve(1, THEM, task=task))
    stage.call(release(2, US))
    stage.let_pass(10 * OFFER)
    assert stage.freed == ["a~1", "b~1"]
    assert stage.call(apply(1, THEM, task="c~1")).verdict is Verdict.DONE


def test_a_task_of_lower_priority_yields_when_it_is_asked_to() -> None:
    stage = Stage()
    stage.others.announce(THEM)
    stage.call(apply(1, US))
    assert stage.call(reserve(1, THEM, priority=1)).verdict is Verdict.BUSY
    stage.let_pass(0.1)
    assert [(fail.component, fail.cause, fail.task) for fail in stage.fails] == [(CAP, Cause.YIELD, TASKS[US])]
    assert stage.component.active
    stage.call(release(2, US))
    stage.let_pass(0.1)
    assert stage.freed == [TASKS[THEM]]
    assert stage.call(apply(1, THEM, priority=1)).verdict is Verdict.DONE
    stage.let_pass(2 * YIELDING)
    assert stage.component.active
    assert len(stage.fails) == 1


def test_a_task_of_lower_priority_that_does_not_yield_is_preempted() -> None:
    stage = Stage()
    stage.others.announce(THEM)
    stage.call(apply(1, US))
    stage.call(reserve(1, THEM, priority=1))
    stage.let_pass(YIELDING - 0.1)
    assert stage.component.active
    stage.let_pass(0.2)
    assert stage.recorder.said == [("started",), ("stopped",)]
    assert [(fail.cause, fail.task) for fail in stage.fails][1:] == [(Cause.LET_GO, TASKS[US])]
    assert stage.freed == [TASKS[THEM]]
    assert stage.call(reserve(1, THEM, priority=1)).verdict is Verdict.DONE


def test_a_task_is_asked_to_yield_before_it_is_preempted_even_if_another_was_asked_just_before() -> None:
    stage = Stage()
    stage.others.announce(THEM)
    stage.call(apply(1, US))
    stage.call(reserve(1, THEM, priority=1))
    stage.let_pass(YIELDING / 2)
    stage.call(release(2, US))
    stage.call(reserve(2, THEM, priority=1))
    stage.call(release(3, THEM))
    stage.call(apply(4, US))
    stage.call(reserve(4, THEM, priority=1))
    stage.let_pass(YIELDING - 0.1)
    assert stage.component.active
    assert [fail.cause for fail in stage.fails] == [Cause.YIELD] * 2
    stage.let_pass(0.2)
    assert not stage.component.active


def test_tasks_of_one_priority_never_take_from_each_other() -> None:
    stage = Stage()
    stage.others.announce(THEM)
    stage.call(apply(1, US, priority=1, beginning=9.0))
    stage.call(reserve(1, THEM, priority=1, beginning=1.0))
    stage.let_pass(10 * YIELDING)
    assert stage.component.active
    assert stage.fails == []
