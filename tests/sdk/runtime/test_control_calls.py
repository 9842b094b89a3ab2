"""The control calls of a component: what is no call for this life of it changes nothing."""

from __future__ import annotations

import pytest

from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Apply, Release, Reserve, Verdict, Wire
from tests.sdk.stage import (
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
