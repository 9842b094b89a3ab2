"""How one output takes over from another where a call asks for that: what ran before is let go of only when the next
delivers.
"""

from __future__ import annotations

from dataclasses import replace

import pytest

from selfconf.bus.port import Replies
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Wire, Wires
from selfconf.sdk.inputs.followed_output import JUST_COME
from selfconf.sdk.inputs.handover import HANDOVER
from selfconf.sdk.inputs.inputs import HANDOVER_CHECK
from selfconf.sdk.inputs.silence_watch import BEGINNING, PATIENCE
from selfconf.sdk.runtime import ComponentRuntime
from tests.sdk.stage import (
    CAP,
    KEYS,
    ODOMETRY,
    TRACKER,
    US,
    Stage,
    Watchful,
    apply,
    follow,
    other_source,
    reserve,
    silence,
)

BUTTON = IRI("urn:c:button")


TO_ODOMETRY = {"position": (Wire(ODOMETRY, "pose"),)}


class Change:
    """A component that follows the tracker, and is to follow odometry instead, gently."""

    def __init__(self, inputs: Wires = TO_ODOMETRY) -> None:
        self.stage = Stage(Watchful())
        self.tracker = self.stage.neighbour()
        self.odometry = other_source(self.stage)
        self.stage.call(follow(1))
        self.message = apply(2, US, inputs, gently=True)
        self.answers: list[Replies] = []
        self.ask()

    def ask(self) -> None:
        """Make the call; the answer may take long."""
        key = KEYS.call(CAP, "apply")
        self.stage.caller.ask(key, encode(self.message), 60.0, self.answers.append)

    def let_pass(self, seconds: float, *emitting: ComponentRuntime) -> None:
        """Time passes while some sources issue a signal five times a second."""
        for _ in range(round(seconds / 0.2)):
            for source in emitting:
                source.component.emit("pose", source.profile.component.short)
            self.stage.let_pass(0.2)

    @property
    def told(self) -> set[str]:
        """What the component was told but to start."""
        return {said[0] if said[0] != "position" else said[1] for said in self.stage.recorder.said[1:]}


def test_an_input_goes_on_following_what_fed_it_while_the_next_issues_nothing_and_says_so() -> None:
    change = Change()
    change.let_pass(HANDOVER - 0.4, change.tracker)
    assert not silence(change.stage)
    change.let_pass(2 * HANDOVER + 0.4, change.tracker)
    assert silence(change.stage) == [(ODOMETRY, "")] * 2
    assert change.stage.fails[0].detail == f"no signal on 'pose' for {HANDOVER:.2f} s"
    assert change.told == {TRACKER.short}
    assert not change.answers
    assert change.stage.state().patience > 0.0
    change.stage.call(follow(3))  # the configurator wants again what ran before
    change.let_pass(1.0, change.tracker, change.odometry)
    assert change.told == {TRACKER.short}
    assert change.stage.state().patience == 0.0
    assert change.answers


def test_an_input_hears_nothing_of_what_fed_it_once_the_next_has_delivered() -> None:
    change = Change()
    change.stage.let_pass(0.1)
    change.stage.recorder.said.clear()
    for source in (change.tracker, change.odometry, change.tracker, change.odometry):
        source.component.emit("pose", source.profile.component.short)
        change.stage.let_pass(HANDOVER_CHECK / 10)
    heard = [said[1] for said in change.stage.recorder.said]
    assert heard == [TRACKER.short, ODOMETRY.short, ODOMETRY.short]
    change.stage.let_pass(0.2)
    change.stage.call(apply(4, US, {"position": (Wire(TRACKER, "pose"),)}, gently=True))
    change.tracker.component.emit("pose", "back")
    change.stage.let_pass(0.2)
    assert change.stage.recorder.said[-1] == ("position", "back")


def test_time_in_which_the_machine_stalls_is_none_in_which_the_next_output_issues_nothing() -> None:
    change = Change()
    change.let_pass(0.4, change.tracker)
    for _ in range(5):
        go_on = change.stage.network.stall()
        change.stage.let_pass(HANDOVER)
        go_on()
        change.let_pass(0.2, change.tracker)
    assert not silence(change.stage)
    assert not change.answers
    change.let_pass(0.4, change.tracker, change.odometry)
    assert change.answers
    assert not silence(change.stage)


def test_time_in_which_the_machine_stalls_counts_once_however_many_calls_wait_for_the_next_output() -> None:
    change = Change()
    for _ in range(3):
        change.ask()
    change.let_pass(0.4, change.tracker)
    go_on = change.stage.network.stall()
    change.stage.let_pass(HANDOVER)
    go_on()
    change.let_pass(HANDOVER, change.tracker)
    assert silence(change.stage) == [(ODOMETRY, "")]
    change.let_pass(0.4, change.tracker, change.odometry)
    assert len(change.answers) == 4


@pytest.mark.parametrize("gently", [True, False], ids=["repeated", "made for another task that shares the component"])
def test_a_gentle_call_that_is_repeated_goes_on_with_the_same_handover(gently: bool) -> None:
    change = Change()
    change.let_pass(HANDOVER / 2, change.tracker)
    change.message = replace(change.message, gently=gently)
    change.ask()
    change.let_pass(HANDOVER / 2 + 0.4, change.tracker)
    assert silence(change.stage) == [(ODOMETRY, "")]
    assert change.told == {TRACKER.short}
    change.let_pass(0.4, change.tracker, change.odometry)
    change.let_pass(0.4, change.tracker)
    assert len(change.answers) == 2
    assert change.stage.recorder.said[-1] == ("position", ODOMETRY.short)


def test_an_output_that_has_as_little_to_issue_as_the_one_before_takes_its_place() -> None:
    change = Change()
    change.let_pass(HANDOVER + 0.4)
    assert change.answers
    assert (silence(change.stage), change.told) == ([], set())
    change.let_pass(0.4, change.tracker, change.odometry)
    assert change.told == {ODOMETRY.short}


def test_an_output_whose_component_has_gone_does_not_take_the_place_of_one_that_issues_nothing() -> None:
    change = Change()
    change.odometry.close()
    change.let_pass(HANDOVER + 0.4)
    assert silence(change.stage) == [(ODOMETRY, "")]
    assert change.told == set()


def test_an_input_that_is_handed_over_is_unfed_when_what_fed_it_is_lost() -> None:
    change = Change()
    change.let_pass(0.4, change.tracker)
    change.tracker.component.fail("blind")
    change.let_pass(0.4)
    assert change.told == {TRACKER.short, "unfed"}
    assert change.answers
    change.let_pass(0.4, change.odometry)
    assert change.told == {TRACKER.short, "unfed", "fed", ODOMETRY.short}


def test_an_input_has_lost_nothing_when_the_next_output_has_just_delivered_as_what_fed_it_is_lost() -> None:
    change = Change()
    change.let_pass(0.4, change.tracker)
    change.odometry.component.emit("pose", "the last")
    assert change.stage.network.run(lambda: ("position", "the last") in change.stage.recorder.said, HANDOVER_CHECK)
    change.tracker.component.fail("blind")
    change.stage.let_pass(0.4)
    assert change.told == {TRACKER.short, "the last"}


def test_an_input_goes_on_following_what_fed_it_when_the_next_output_has_just_delivered_and_is_lost() -> None:
    change = Change()
    change.let_pass(0.4, change.tracker)
    change.odometry.component.emit("pose", "the last")
    assert change.stage.network.run(lambda: ("position", "the last") in change.stage.recorder.said, HANDOVER_CHECK)
    change.odometry.component.fail("blind")
    change.stage.let_pass(0.2)
    change.tracker.component.emit("pose", "goes on")
    change.let_pass(HANDOVER + 0.4, change.tracker)
    assert ("position", "goes on") in change.stage.recorder.said
    assert "unfed" not in change.told
    assert silence(change.stage) == [(ODOMETRY, "")]
    change.tracker.component.fail("blind as well")
    change.stage.let_pass(0.4)
    assert change.stage.recorder.said[-1] == ("unfed", "position")


def test_an_output_that_promises_to_issue_seldom_has_time_for_what_it_promises() -> None:
    change = Change({"position": (Wire(ODOMETRY, "pose", HANDOVER),)})
    change.let_pass(PATIENCE * HANDOVER - 0.4, change.tracker)
    assert not silence(change.stage)
    change.let_pass(0.8, change.tracker)
    assert (ODOMETRY, "") in silence(change.stage)
    assert change.told == {TRACKER.short}


@pytest.mark.parametrize("delivers", [False, True])
def test_an_input_of_several_outputs_goes_on_following_each_until_what_takes_its_place_delivers(delivers: bool) -> None:
    stage = Stage(Watchful())
    button, tracker, odometry = stage.neighbour(component=BUTTON), stage.neighbour(), other_source(stage)
    kept = Wire(BUTTON, "pose")
    stage.call(apply(1, US, {"position": (kept, Wire(TRACKER, "pose"))}))
    answers: list[Replies] = []
    message = apply(2, US, {"position": (kept, Wire(ODOMETRY, "pose"))}, gently=True)
    stage.caller.ask(KEYS.call(CAP, "apply"), encode(message), 60.0, answers.append)
    for _ in range(round(HANDOVER / 0.2) + 2):
        for source in (tracker, odometry) if delivers else (button, tracker):
            source.component.emit("pose", source.profile.component.short)
        stage.let_pass(0.2)
    assert [component for component, _ in silence(stage)] == ([] if delivers else [ODOMETRY])
    assert bool(answers) is delivers
    heard = {said[1] for said in stage.recorder.said if said[0] == "position"}
    assert heard == ({ODOMETRY.short, TRACKER.short} if delivers else {BUTTON.short, TRACKER.short})
    assert stage.recorder.said[-1] == ("position", ODOMETRY.short if delivers else TRACKER.short)


class Opening(Change):
    """A component that is started gently, as a part of what is to take the place of something else."""

    def __init__(self, period: float | None, beside: tuple[Wire, ...] = ()) -> None:
        self.stage = Stage(Watchful())
        self.tracker, self.odometry = self.stage.neighbour(), other_source(self.stage)
        self.stage.call(reserve(1, US))
        self.message = apply(2, US, {"position": (Wire(ODOMETRY, "pose", period), *beside)}, gently=True)
        self.answers: list[Replies] = []
        self.ask()


def test_what_is_started_gently_answers_once_an_output_that_promises_a_rate_has_issued_a_signal() -> None:
    change = Opening(0.2)
    change.let_pass(0.4)
    change.ask()  # once more, as the answer takes long
    change.let_pass(0.4)
    assert change.stage.recorder.said == [("started",)]
    assert not change.answers
    change.let_pass(0.4, change.odometry)
    assert len(change.answers) == 2
    assert not silence(change.stage)


def test_what_is_started_gently_says_that_an_output_issues_nothing_and_follows_it_still() -> None:
    change = Opening(0.2)
    change.let_pass(HANDOVER + 0.4)
    assert silence(change.stage) == [(ODOMETRY, "")]
    assert not change.answers
    change.let_pass(0.4, change.odometry)
    assert change.answers


def test_what_is_started_gently_blames_no_output_that_has_promised_nothing() -> None:
    change = Opening(0.2)
    button = change.stage.neighbour()
    both = {"position": (*change.message.inputs["position"], Wire(TRACKER, "pose"))}
    change.message = replace(change.message, epoch=3, inputs=both)
    change.ask()
    change.let_pass(HANDOVER + 0.4)
    assert {component for component, _ in silence(change.stage)} == {ODOMETRY}
    change.let_pass(0.4, button)
    assert change.answers


@pytest.mark.parametrize("period", [None, BEGINNING])
def test_what_is_started_gently_waits_for_no_signal_that_nothing_promises_for_soon(period: float | None) -> None:
    change = Opening(period)
    change.let_pass(0.4)
    assert change.answers


def test_what_is_started_gently_answers_when_its_source_is_lost() -> None:
    change = Opening(0.2)
    change.let_pass(0.4)
    change.odometry.component.fail("no wheels")
    change.let_pass(0.4)
    assert change.answers
    assert change.told == {"unfed"}


@pytest.mark.parametrize("gently", [False, True])
def test_what_is_started_gently_is_unfed_when_it_is_left_with_a_source_that_is_lost(gently: bool) -> None:
    change = Opening(0.2, (Wire(TRACKER, "pose", 0.2),))
    change.stage.let_pass(0.1)
    change.odometry.component.fail("blind")
    change.stage.let_pass(0.2)
    assert change.told == set()
    change.message = apply(3, US, {"position": (Wire(ODOMETRY, "pose", 0.2),)}, gently=gently)
    change.ask()
    change.stage.let_pass(0.1)
    change.tracker.component.fail("blind as well")
    change.stage.let_pass(0.2)
    assert change.stage.recorder.said == [("started",), ("unfed", "position")]


def test_an_output_that_stood_by_is_asked_for_what_it_issued_before() -> None:
    change = Change({})
    change.stage.call(replace(follow(3), standby=TO_ODOMETRY))
    change.let_pass(0.2, change.odometry)
    change.let_pass(2 * JUST_COME, change.tracker)
    change.message = apply(4, US, TO_ODOMETRY, gently=True)
    change.ask()
    change.let_pass(0.4, change.tracker)
    assert len(change.answers) == 2
    assert change.stage.recorder.said[-1] == ("position", ODOMETRY.short)
