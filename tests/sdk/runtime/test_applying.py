"""What a call to act has the code of a component do, and what it is answered."""

from __future__ import annotations

from selfconf.protocol.activation import ActivationPhase
from selfconf.protocol.messages import Verdict
from selfconf.sdk.component import Refused
from selfconf.sdk.runtime.applying import LIFE_ENDS
from tests.lab import Recorder
from tests.sdk.stage import (
    THEM,
    US,
    Stage,
    apply,
)


def test_an_activation_that_is_repeated_starts_nothing_anew() -> None:
    stage = Stage()
    for epoch in (1, 1, 2):
        assert stage.call(apply(epoch, US)).verdict is Verdict.DONE
    assert stage.recorder.said == [("started",)]


def test_a_component_that_leaves_while_it_starts_does_not_say_that_it_refuses() -> None:
    class Ending(Recorder):
        def started(self) -> None:
            stage.runtime.close()

    stage = Stage(Ending())
    answer = stage.call(apply(1, US))
    assert (answer.verdict, answer.detail, answer.life) == (Verdict.OTHER_LIFE, LIFE_ENDS, "life-1")


def test_a_component_that_refuses_to_start_says_why_and_stays_free() -> None:
    stage = Stage()
    stage.recorder.refusal = Refused("no light")
    answer = stage.call(apply(1, US))
    assert (answer.verdict, answer.detail, answer.active) == (Verdict.REFUSED, "no light", False)
    stage.recorder.refusal = None
    stage.others.announce(THEM)
    assert stage.call(apply(2, THEM)).verdict is Verdict.DONE


def test_a_component_that_failed_and_refuses_to_start_again_is_free() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    stage.component.fail("lost her")
    stage.let_pass(0.1)
    stage.recorder.refusal = Refused("still dark")
    assert stage.call(apply(2, US)).verdict is Verdict.REFUSED
    assert stage.runtime.activation.phase is ActivationPhase.IDLE
    stage.recorder.refusal = None
    stage.others.announce(THEM)
    assert stage.call(apply(3, THEM)).verdict is Verdict.DONE
