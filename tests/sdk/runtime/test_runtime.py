"""The runtime of a component: it starts and stops the code as it is called, and ends with its life."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from selfconf.bus.port import Replies
from selfconf.errors import ProgrammerError
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Apply, CallAnswer, Release, Reserve, Verdict
from selfconf.sdk.component import Component
from selfconf.sdk.runtime.applying import LIFE_ENDS
from tests.lab import Recorder
from tests.sdk.stage import (
    CAP,
    KEYS,
    THEM,
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


def test_a_released_component_stops_and_may_be_activated_again() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    answer = stage.call(release(2, US))
    assert (answer.verdict, answer.active) == (Verdict.DONE, False)
    stage.call(apply(3, US))
    assert stage.recorder.said == [("started",), ("stopped",), ("started",)]


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
            stage.runtime.calls.answer(name, encode(make(1, THEM, life="life-1")), answers.append)

    stage = Stage(Stopping())
    stage.call(apply(1, US))
    stage.runtime.close()
    assert [(answer.verdict, answer.detail) for answer in answers] == [(verdict, LIFE_ENDS)]


def test_closing_an_idle_component_does_not_stop_it() -> None:
    stage = Stage()
    stage.runtime.close()
    assert stage.recorder.said == []
