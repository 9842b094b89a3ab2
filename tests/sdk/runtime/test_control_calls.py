"""The control calls of a component: what is no call for this life of it changes nothing, and each answer tells of it.

It tells whether the component acts, for which task, and how it is.
"""

from __future__ import annotations

import os
import socket

import pytest

from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Apply, Release, Reserve, Verdict, Wire
from selfconf.sdk.runtime.supervision import GRACE
from tests.sdk.stage import (
    TASKS,
    THEM,
    TRACKER,
    US,
    Stage,
    apply,
    release,
    reserve,
)


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


OTHER_LIFE: list[Apply | Reserve | Release] = [make(1, US, life="life-0") for make in (apply, reserve, release)]


@pytest.mark.parametrize("message", OTHER_LIFE)
def test_a_call_that_means_another_life_changes_nothing(message: Apply | Reserve | Release) -> None:
    stage = Stage()
    stage.call(apply(1, US, life="life-1"))
    answer = stage.call(message)
    assert (answer.verdict, answer.life) == (Verdict.OTHER_LIFE, "life-1")
    assert stage.component.active
    assert stage.recorder.said == [("started",)]


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
