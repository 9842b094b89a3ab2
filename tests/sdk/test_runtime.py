"""The runtime of a component: the calls that it answers, which life they mean, and its end."""

from __future__ import annotations

import os
import socket
from collections.abc import Callable

import pytest

from selfconf.bus.port import Replies
from selfconf.errors import ProgrammerError
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Apply, CallAnswer, Release, Reserve, Verdict, Wire
from selfconf.sdk.component import Component
from selfconf.sdk.runtime import LIFE_ENDS
from selfconf.sdk.supervision import GRACE
from tests.lab import Recorder
from tests.sdk.stage import (
    CAP,
    KEYS,
    TASKS,
    THEM,
    TRACKER,
    US,
    Stage,
    apply,
    release,
    reserve,
)


def test_a_component_is_idle_until_it_is_activated() -> None:
    stage = Stage()
    answer = stage.state()
    assert (answer.verdict, answer.active, answer.life, answer.component) == (Verdict.DONE, False, "life-1", CAP)
    answer = stage.call(apply(7, US))
    assert (answer.verdict, answer.active, answer.epoch) == (Verdict.DONE, True, 7)
    assert stage.recorder.said == [("started",)]
    assert stage.component.active


def test_it_says_which_configurator_holds_it_and_a_busy_component_says_so_in_words() -> None:
    stage = Stage()
    assert stage.state().supervisor == ""
    assert stage.call(apply(1, US)).supervisor == US
    stage.others.announce(THEM)
    answer = stage.call(apply(2, THEM))
    assert (answer.verdict, answer.supervisor) == (Verdict.BUSY, US)
    assert answer.detail == "the task task (priority 0, configurator us) holds it"
    stage.component.fail("lost her")
    stage.let_pass(0.1)
    assert (stage.state().active, stage.state().supervisor) == (False, US)
    stage.leave()
    stage.let_pass(2 * GRACE)
    assert (stage.state().active, stage.state().supervisor) == (False, "")


def test_an_activation_that_is_repeated_starts_nothing_anew() -> None:
    stage = Stage()
    for epoch in (1, 1, 2):
        assert stage.call(apply(epoch, US)).verdict is Verdict.DONE
    assert stage.recorder.said == [("started",)]


def test_a_released_component_stops_and_may_be_activated_again() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    answer = stage.call(release(2, US))
    assert (answer.verdict, answer.active) == (Verdict.DONE, False)
    stage.call(apply(3, US))
    assert stage.recorder.said == [("started",), ("stopped",), ("started",)]


def test_an_input_that_is_not_there_is_refused_and_nothing_starts() -> None:
    stage = Stage()
    answer = stage.call(apply(1, US, {"sonar": (Wire(TRACKER, "pose"),)}))
    assert (answer.verdict, answer.detail) == (Verdict.REFUSED, "it has no input 'sonar'")
    assert stage.recorder.said == []


@pytest.mark.parametrize(
    ("call", "payload"),
    [
        ("apply", b""),
        ("apply", b"{}"),
        ("apply", encode(release(1, US))),
        ("dance", encode(apply(1, US))),
        ("*", encode(apply(1, US))),
        ("apply", encode(Apply(1, US))),
        ("release", encode(Release(1, US))),
        ("reserve", b"\xff"),
        ("state", b"\xff"),
        ("apply", encode(apply(1, "**"))),
        ("apply", encode(apply(1, "selfconf/lab/conf/*/live/*"))),
        ("apply", encode(apply(1, "selfconf/other/conf/us/live/1"))),
    ],
)
def test_a_call_that_is_none_is_refused_and_changes_nothing(call: str, payload: bytes) -> None:
    stage = Stage()
    replies = stage.ask(call, payload)
    assert replies.samples == ()
    assert len(replies.errors) == 1
    assert stage.recorder.said == []
    assert stage.call(apply(1, US)).verdict is Verdict.DONE


def test_a_component_that_is_part_of_no_ecology_says_so() -> None:
    component = Component()
    for use in (lambda: component.emit("a", 1), lambda: component.fail("x"), lambda: component.every(1.0, print)):
        with pytest.raises(ProgrammerError, match="not part of an ecology"):
            use()
    assert not Component().active


def test_a_call_of_an_older_epoch_is_stale_and_names_the_newest() -> None:
    stage = Stage()
    stage.call(apply(5, US))
    answer = stage.call(release(4, US))
    assert (answer.verdict, answer.epoch) == (Verdict.STALE, 5)
    assert stage.component.active


def test_closing_turns_the_component_off_and_ends_its_life() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    called: list[tuple[str, ...]] = []
    stage.runtime.close()
    stage.caller.roll_call(KEYS.any_life(), 1.0, called.append)
    stage.let_pass(0.1)
    assert called == [()]
    assert stage.recorder.said == [("started",), ("stopped",)]
    assert stage.ask("state", b"") == Replies((), (), True)


@pytest.mark.parametrize(
    ("make", "verdict"),
    [(apply, Verdict.OTHER_LIFE), (reserve, Verdict.OTHER_LIFE), (release, Verdict.DONE)],
)
def test_a_call_that_waits_for_code_that_leaves_hears_that_this_life_is_over_and_no_refusal(
    make: Callable[..., Apply | Reserve | Release], verdict: Verdict
) -> None:
    answers: list[CallAnswer] = []

    class Stopping(Recorder):
        def stopped(self) -> None:
            name = make.__name__
            stage.runtime._answer(name, encode(make(1, THEM, life="life-1")), answers.append)

    stage = Stage(Stopping())
    stage.call(apply(1, US))
    stage.runtime.close()
    assert [(answer.verdict, answer.detail) for answer in answers] == [(verdict, LIFE_ENDS)]


def test_a_component_that_leaves_while_it_starts_does_not_say_that_it_refuses() -> None:
    class Ending(Recorder):
        def started(self) -> None:
            stage.runtime.close()

    stage = Stage(Ending())
    answer = stage.call(apply(1, US))
    assert (answer.verdict, answer.detail, answer.life) == (Verdict.OTHER_LIFE, LIFE_ENDS, "life-1")


def test_closing_an_idle_component_does_not_stop_it() -> None:
    stage = Stage()
    stage.runtime.close()
    assert stage.recorder.said == []


OTHER_LIFE: list[Apply | Reserve | Release] = [make(1, US, life="life-0") for make in (apply, reserve, release)]


@pytest.mark.parametrize("message", OTHER_LIFE)
def test_a_call_that_means_another_life_changes_nothing(message: Apply | Reserve | Release) -> None:
    stage = Stage()
    stage.call(apply(1, US, life="life-1"))
    answer = stage.call(message)
    assert (answer.verdict, answer.life) == (Verdict.OTHER_LIFE, "life-1")
    assert stage.component.active
    assert stage.recorder.said == [("started",)]


def test_what_a_component_says_of_itself_names_its_process_and_who_holds_it_since_when() -> None:
    stage = Stage()
    stage.call(apply(1, US, priority=3, beginning=12.0))
    answer = stage.state()
    assert (answer.task, answer.priority, answer.beginning, answer.supervisor) == (TASKS[US], 3, 12.0, US)
    assert answer.place == f"process {os.getpid()} on {socket.gethostname()}"


def test_the_answer_to_state_says_how_long_it_has_lived_what_it_takes_and_what_it_has_issued() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    stage.component.emit("velocity", 1)
    stage.let_pass(2.0)
    answer = stage.state()
    assert answer.age >= 2.0
    assert answer.memory > 0
    assert answer.issued == {"velocity": 1}
    assert stage.call(apply(2, US)).issued == {}
