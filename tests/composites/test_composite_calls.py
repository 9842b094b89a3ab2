"""When calls to a composite are answered, and with what: once its inside does as the newest of them says."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.composites.inside_of_composite import STARTING_INSIDE
from selfconf.deployment.notices import AT_LEISURE
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.messages import Apply, CallAnswer, Release, Reserve, StateOf, Verdict
from tests.composites.test_composites_at_rest import FAST, SLOW, Motor
from tests.deployment.simulated import slow_code
from tests.lab import iri
from tests.sdk.stage import KEYS, TASKS, US, apply, release, reserve


class Caller:
    """Calls a composite, and notes what was answered, and what its inside did at that moment."""

    def __init__(self, motor: Motor) -> None:
        self.motor, self.lab = motor, motor.lab
        self.answers: list[tuple[Verdict, bool, str]] = []
        """Of each answer: the verdict, whether the pilot acts, and the rate that was set last."""
        self.details: list[str] = []

    @property
    def rate(self) -> str:
        """What the parameter of the pilot was set to last."""
        return next((said[1] for said in reversed(self.lab.components["pilot"].said) if said[0] == "rate"), "")

    def call(self, *messages: Reserve | Apply | Release) -> None:
        """Call the composite, one call after the other, and wait for none of the answers."""
        for message in messages:
            name = {Reserve: "reserve", Apply: "apply", Release: "release"}[type(message)]
            self.motor.caller.ask(
                KEYS.call(iri("base"), name),
                encode(message),
                STARTING_INSIDE,
                lambda replies: self._note(decode(replies.samples[0].payload, CallAnswer)),
            )

    def _note(self, answer: CallAnswer) -> None:
        self.answers.append((answer.verdict, self.lab.runtimes["pilot"].active, self.rate))
        self.details.append(answer.detail)

    def answered(self, seconds: float = 5.0) -> tuple[Verdict, bool, str]:
        """What the last of the calls is answered, within that time."""
        before = len(self.answers)
        assert self.lab.until(lambda: len(self.answers) > before, seconds)
        return self.answers[-1]

    def state(self) -> CallAnswer:
        """What the composite says of itself."""
        found: list[CallAnswer] = []
        question = encode(StateOf(TASKS[US]))
        self.motor.caller.ask(
            KEYS.call(iri("base"), "state"),
            question,
            1.0,
            lambda replies: found.append(decode(replies.samples[0].payload, CallAnswer)),
        )
        assert self.lab.until(lambda: bool(found))
        return found[0]


@pytest.fixture
def caller(tmp_path: Path) -> Caller:
    """The caller of a composite that a task has reserved."""
    caller = Caller(Motor(tmp_path))
    caller.call(reserve(values=SLOW))
    assert caller.answered()[0] is Verdict.DONE
    return caller


def test_a_call_is_answered_once_the_inside_runs_with_its_values(caller: Caller) -> None:
    for epoch, values, rate in ((1, SLOW, "slow"), (2, FAST, "fast")):
        caller.call(apply(epoch, values=values))
        assert caller.answered() == (Verdict.DONE, True, rate)
    caller.call(release(3))
    assert caller.answered(1.0) == (Verdict.DONE, False, "fast")
    caller.call(reserve(4, values=SLOW))
    caller.answered()
    caller.call(apply(4, values=SLOW))
    assert caller.answered() == (Verdict.DONE, True, "slow")


def test_a_call_with_other_values_as_the_inside_has_just_begun_to_run_waits_for_the_one_that_has_them(
    caller: Caller,
) -> None:
    caller.call(apply(1, values=SLOW))
    inside = caller.lab.composites["home"].living[iri("base")]
    assert caller.lab.until(lambda: inside.runner is not None and inside.runner.status().phase == "running")
    caller.lab.let_pass(AT_LEISURE / 2)  # it is reported that it runs after the next call
    caller.call(apply(2, values=FAST))
    assert caller.answered() == (Verdict.DONE, True, "fast")


def test_a_call_with_values_that_the_inside_cannot_have_is_refused_with_the_reason(caller: Caller) -> None:
    caller.call(apply(1, values=SLOW))
    caller.answered()
    caller.call(apply(2, values={"speed": IRI("urn:c:speed")}))
    assert caller.answered()[:2] == (Verdict.REFUSED, False)
    assert "cannot stand for the parameter 'speed': " in caller.details[-1]
    caller.call(apply(3, values=FAST))
    assert caller.answered() == (Verdict.DONE, True, "fast")


def test_a_composite_asks_for_patience_until_its_inside_runs(caller: Caller) -> None:
    slow_code(caller.lab, "pilot")
    caller.lab.components["pilot"].slow = 5.0
    assert caller.state().patience == 0.0
    for epoch, values in ((1, SLOW), (2, FAST)):
        caller.call(apply(epoch, values=values))
        caller.lab.let_pass(3.0)
        assert (caller.state().patience, caller.state().active) == (STARTING_INSIDE, False)
        caller.answered(10.0)
        assert (caller.state().patience, caller.state().active) == (0.0, True)


def test_the_newest_call_counts_while_the_last_inside_ends(caller: Caller) -> None:
    caller.call(apply(1, values=SLOW))
    caller.answered()
    caller.call(apply(2, values=FAST), apply(3, values=SLOW))
    caller.answered()
    caller.lab.let_pass(5.0)
    assert (caller.rate, caller.lab.runtimes["pilot"].active) == ("slow", True)


def test_nothing_begins_anew_that_was_released_while_the_last_inside_ended(caller: Caller) -> None:
    caller.call(apply(1, values=SLOW))
    caller.answered()
    caller.call(apply(2, values=FAST), release(3))
    caller.lab.let_pass(5.0)
    assert not caller.lab.runtimes["pilot"].active
