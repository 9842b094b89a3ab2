"""The inputs of a component: when one is unfed and fed again, and how one output takes over from another."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from selfconf.bus.memory import Faults, MemoryBus
from selfconf.bus.port import Replies, Urgency
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Wire, Wires
from selfconf.sdk.blindness import TOLERATES
from selfconf.sdk.component import Component
from selfconf.sdk.inputs.followed_output import JUST_COME
from selfconf.sdk.inputs.inputs import HANDOVER, HANDOVER_CHECK
from selfconf.sdk.inputs.silence_watch import BEGINNING, PATIENCE
from selfconf.sdk.inputs.source_watch import UNSEEN
from selfconf.sdk.runtime import ComponentRuntime
from selfconf.sdk.runtime.supervision import GRACE
from tests.lab import Recorder
from tests.sdk.stage import (
    CAP,
    DRIVE_PROFILE,
    KEYS,
    TASKS,
    THEM,
    TRACKER,
    TRACKER_PROFILE,
    US,
    Stage,
    apply,
    follow,
    release,
    reserve,
    silence,
)


def test_rewiring_an_input_neither_stops_nor_starts_the_component() -> None:
    stage = Stage()
    tracker = stage.neighbour()
    stage.call(follow(1))
    tracker.component.emit("pose", 1)
    stage.let_pass(0.1)
    stage.call(apply(2, US, {"position": (Wire(IRI("urn:c:odometry"), "pose"),)}))
    tracker.component.emit("pose", 2)
    stage.let_pass(0.1)
    stage.call(apply(3, US, {"position": (Wire(TRACKER, "pose"),)}))
    tracker.component.emit("pose", 3)
    stage.let_pass(0.1)
    assert [said for said in stage.recorder.said if said != ("position", 2)] == [
        ("started",),
        ("position", 1),
        ("position", 3),
    ]


# What an input that has lost its source says, and when it is fed again.


class Watchful(Recorder):
    """Writes down as well when it is blind."""

    def unfed(self, port: str) -> None:
        self.said.append(("unfed", port))

    def fed(self, port: str) -> None:
        self.said.append(("fed", port))


def end(runtime: ComponentRuntime) -> None:
    """End the process of a component, as kill -9 does."""
    runtime.bus.close()


def fall_silent(runtime: ComponentRuntime) -> None:
    """Do nothing."""


def raise_fail(runtime: ComponentRuntime) -> None:
    """Raise FAIL."""
    runtime.fail("broken")


def lose_sight(runtime: ComponentRuntime) -> None:
    """Lose sight of the configurator, but not of those that follow it, and let go of the task."""
    assert isinstance(runtime.bus, MemoryBus)
    runtime.bus.network.cut(runtime.bus, runtime.bus.network.nodes[0])
    runtime.bus.network.run(lambda: False, GRACE)


@pytest.mark.parametrize("loss", [end, fall_silent, raise_fail])
def test_an_input_that_has_lost_its_only_source_says_so_and_again_when_there_is_another(
    loss: Callable[[ComponentRuntime], None],
) -> None:
    stage = Stage(Watchful())
    tracker = stage.neighbour()
    stage.call(follow(period=0.1))
    tracker.component.emit("pose", 1)
    stage.let_pass(0.05)
    loss(tracker)
    stage.let_pass(PATIENCE * 0.1 + 0.1)
    assert stage.recorder.said == [("started",), ("position", 1), ("unfed", "position")]
    tracker.bus.close()
    stage.let_pass(10)
    stage.neighbour(life="life-u").component.emit("pose", 2)
    stage.let_pass(0.1)
    assert stage.recorder.said[2:] == [("unfed", "position"), ("fed", "position"), ("position", 2)]


def test_a_signal_that_is_overtaken_by_its_sources_fail_feeds_nothing() -> None:
    stage = Stage(Watchful())
    tracker = stage.neighbour()
    stage.call(follow())
    tracker.component.emit("pose", 1)
    stage.let_pass(0.1)
    stage.network.faults = Faults(least_delay=0.02, most_delay=0.02)
    tracker.component.emit("pose", 2)
    stage.network.faults = Faults()
    raise_fail(tracker)
    stage.let_pass(0.5)
    assert stage.recorder.said == [("started",), ("position", 1), ("unfed", "position")]
    stage.caller.ask(KEYS.call(TRACKER, "apply"), encode(apply(2)), 1.0, lambda _: None)
    stage.let_pass(0.1)
    tracker.component.emit("pose", 3)
    stage.let_pass(0.1)
    assert stage.recorder.said[3:] == [("fed", "position"), ("position", 3)]


def test_an_output_of_which_nothing_can_be_read_counts_as_silent(caplog: pytest.LogCaptureFixture) -> None:
    stage = Stage(Watchful())
    stage.neighbour().component.emit("pose", 1)
    stage.call(follow(period=0.1))
    stage.let_pass(0.1)
    liar = stage.others.publisher(KEYS.output(TRACKER, "pose"), Urgency.SIGNAL)
    for _ in range(20):
        liar.put(b"{}", b"no stamp")
        stage.let_pass(0.1)
    assert silence(stage)
    assert stage.recorder.said[-1] == ("unfed", "position")
    assert [record.levelname for record in caplog.records if "passed over" in record.message].count("WARNING") == 1


def test_an_input_whose_source_was_never_in_reach_says_so_and_is_fed_when_it_is() -> None:
    stage = Stage(Watchful())
    stage.call(follow())
    stage.let_pass(UNSEEN / 2)
    assert stage.recorder.said == [("started",)]
    stage.let_pass(UNSEEN)
    assert stage.recorder.said == [("started",), ("unfed", "position")]
    stage.neighbour().component.emit("pose", 1)
    stage.let_pass(0.1)
    assert stage.recorder.said[2:] == [("fed", "position"), ("position", 1)]


@pytest.mark.parametrize("seconds", [0.0, 0.5])
def test_an_input_hears_the_last_signal_again_of_a_source_that_was_out_of_sight_and_has_nothing_else_to_say(
    seconds: float,
) -> None:
    stage = Stage(Watchful())
    tracker = stage.neighbour()
    stage.call(follow())
    tracker.component.emit("pose", "map")
    stage.let_pass(0.1)
    assert isinstance(tracker.bus, MemoryBus)
    assert isinstance(stage.runtime.bus, MemoryBus)
    for _ in range(2):
        stage.recorder.said.clear()
        stage.network.cut(stage.runtime.bus, tracker.bus)
        stage.let_pass(seconds)
        stage.network.reconnect(stage.runtime.bus, tracker.bus)
        stage.let_pass(0.5)
        assert stage.recorder.said == [("unfed", "position"), ("fed", "position"), ("position", "map")]


def test_a_signal_that_is_doubled_while_its_source_is_out_of_sight_feeds_nothing() -> None:
    stage = Stage(Watchful())
    tracker = stage.neighbour()
    stage.call(follow())
    tracker.component.emit("pose", "map")
    stage.let_pass(0.1)
    doubled = dict(tracker.outputs._last)["pose"]
    tracker.bus.close()
    stage.let_pass(0.5)
    stage.others.publisher(KEYS.output(TRACKER, "pose"), Urgency.SIGNAL).put(*doubled)
    stage.let_pass(0.5)
    assert stage.recorder.said[-1] == ("unfed", "position")


def test_an_input_is_unfed_when_the_life_that_fed_it_has_ended_though_another_process_is_the_same_component() -> None:
    stage = Stage(Watchful())
    tracker = stage.neighbour()
    stage.call(follow())
    tracker.component.emit("pose", 1)
    stage.let_pass(0.1)
    other = ComponentRuntime(stage.network.node(), KEYS, TRACKER_PROFILE, Component(), "life-s")
    assert stage.network.run(lambda: tracker.closed, 5.0), "of two lives the smaller stays"
    stage.let_pass(0.1)
    assert stage.recorder.said == [("started",), ("position", 1), ("unfed", "position")]
    stage.caller.ask(KEYS.call(TRACKER, "apply"), encode(apply(2)), 1.0, lambda _: None)
    stage.let_pass(0.1)
    other.component.emit("pose", 2)
    stage.let_pass(0.1)
    assert stage.recorder.said[3:] == [("fed", "position"), ("position", 2)]


def test_an_input_that_follows_two_outputs_is_fed_while_one_of_them_is_left() -> None:
    stage = Stage(Watchful())
    tracker = stage.neighbour()
    odometry = other_source(stage)
    both = (Wire(TRACKER, "pose"), Wire(ODOMETRY, "pose"))
    stage.call(apply(1, US, {"position": both}))
    stage.let_pass(0.1)
    end(tracker)
    stage.let_pass(1.0)
    assert stage.recorder.said == [("started",)]
    end(odometry)
    stage.let_pass(1.0)
    assert stage.recorder.said == [("started",), ("unfed", "position")]


@pytest.mark.parametrize("gently", [False, True])
def test_an_input_that_is_left_with_an_output_that_is_lost_is_unfed_or_goes_on_with_the_other(gently: bool) -> None:
    stage = Stage(Watchful())
    tracker, odometry = stage.neighbour(), other_source(stage)
    stage.call(apply(1, US, {"position": (Wire(TRACKER, "pose"), Wire(ODOMETRY, "pose"))}))
    for source in (tracker, odometry):
        source.component.emit("pose", 1)
    stage.let_pass(0.1)
    end(tracker)
    stage.let_pass(0.1)
    assert ("unfed", "position") not in stage.recorder.said
    stage.caller.ask(KEYS.call(CAP, "apply"), encode(replace(follow(2), gently=gently)), 1.0, lambda _: None)
    stage.let_pass(0.1)
    odometry.component.emit("pose", 2)
    stage.let_pass(0.1)
    assert stage.recorder.said[-1] == (("position", 2) if gently else ("unfed", "position"))


def test_an_input_is_unfed_whose_source_ended_before_its_life_was_seen_though_another_process_is_it() -> None:
    stage = Stage(Watchful())
    tracker = stage.neighbour()
    stage.caller.ask(KEYS.call(CAP, "apply"), encode(follow()), 1.0, lambda _: None)
    assert stage.network.run(lambda: ("started",) in stage.recorder.said, 1.0)
    tracker.component.emit("pose", 1)
    ComponentRuntime(stage.network.node(), KEYS, TRACKER_PROFILE, Component(), "life-u")
    end(tracker)
    stage.let_pass(2 * UNSEEN + 0.1)
    assert stage.recorder.said == [("started",), ("position", 1), ("unfed", "position")]


def test_an_input_is_unfed_when_its_source_has_let_go_of_its_only_task() -> None:
    stage = Stage(Watchful())
    tracker = stage.neighbour()
    stage.call(follow())
    tracker.component.emit("pose", 1)
    lose_sight(tracker)
    stage.let_pass(0.1)
    assert stage.recorder.said == [("started",), ("position", 1), ("unfed", "position")]


def test_an_input_is_unfed_when_its_source_is_released_and_it_is_not_told() -> None:
    stage = Stage(Watchful())
    tracker = stage.neighbour()
    stage.call(follow())
    tracker.component.emit("pose", 1)
    stage.caller.ask(KEYS.call(TRACKER, "release"), encode(release(2, US)), 1.0, lambda _: None)
    stage.let_pass(0.1)
    assert stage.recorder.said == [("started",), ("position", 1), ("unfed", "position")]


def test_an_input_is_fed_by_a_source_that_lets_go_of_a_task_and_acts_for_another() -> None:
    stage = Stage(Watchful())
    tracker = stage.neighbour()
    stage.others.announce(THEM)
    stage.caller.ask(KEYS.call(TRACKER, "apply"), encode(apply(1, THEM)), 1.0, lambda _: None)
    stage.call(follow())
    tracker.component.emit("pose", 1)
    lose_sight(tracker)
    stage.let_pass(1.0)
    assert [hold.claim.task for hold in tracker.activation.holds] == [TASKS[THEM]]
    assert stage.recorder.said == [("started",), ("position", 1)]


def test_an_input_loses_no_source_that_acts_for_another_task_and_has_issued_nothing_yet() -> None:
    stage = Stage(Watchful(), DRIVE_PROFILE)
    button = stage.neighbour()
    stage.others.announce(THEM)
    stage.caller.ask(KEYS.call(TRACKER, "apply"), encode(apply(1, THEM)), 1.0, lambda _: None)
    stage.call(reserve())
    stage.call(follow())
    lose_sight(button)
    stage.let_pass(3.0)
    assert [hold.claim.task for hold in button.activation.holds] == [TASKS[THEM]]
    assert stage.recorder.said == [("started",)]
    stage.others.close()
    stage.let_pass(3.0)
    assert stage.recorder.said == [("started",), ("unfed", "position"), ("stopped",)]


ODOMETRY, BUTTON = IRI("urn:c:odometry"), IRI("urn:c:button")


def other_source(stage: Stage) -> ComponentRuntime:
    """Another component with an output `pose`, which acts."""
    profile = replace(TRACKER_PROFILE, component=ODOMETRY)
    runtime = ComponentRuntime(stage.network.node(), KEYS, profile, Recorder(), "life-o")
    stage.caller.ask(KEYS.call(ODOMETRY, "apply"), encode(apply()), 1.0, lambda _: None)
    stage.let_pass(0.1)
    return runtime


SPARE = {"position": (Wire(ODOMETRY, "pose"),)}


def with_stand_by(issued: str) -> tuple[Stage, ComponentRuntime]:
    """A stage whose input follows one output, and the component of another, which stands by and has just issued."""
    stage = Stage(Watchful())
    stage.neighbour()
    odometry = other_source(stage)
    stage.call(replace(follow(1), standby=SPARE))
    stage.let_pass(0.1)
    odometry.component.emit("pose", issued)
    return stage, odometry


def test_an_input_that_changes_its_source_is_unfed_until_the_first_signal_of_the_next() -> None:
    stage = Stage(Watchful())
    stage.neighbour()
    odometry = other_source(stage)
    stage.call(follow(1))
    stage.call(apply(2, US, {"position": (Wire(ODOMETRY, "pose"),)}))
    stage.let_pass(0.1)
    assert stage.recorder.said == [("started",), ("unfed", "position")]
    odometry.component.emit("pose", 3)
    stage.let_pass(0.1)
    assert stage.recorder.said[2:] == [("fed", "position"), ("position", 3)]


def test_an_input_that_changes_to_an_output_that_stands_by_and_has_just_issued_is_never_unfed() -> None:
    stage, _ = with_stand_by("newest")
    stage.let_pass(0.1)
    assert stage.recorder.said == [("started",)]
    stage.call(apply(2, US, SPARE))
    stage.let_pass(0.1)
    assert stage.recorder.said == [("started",), ("position", "newest")]


def test_what_an_output_that_stands_by_issued_long_ago_counts_if_it_is_still_its_last() -> None:
    stage, _ = with_stand_by("old")
    stage.let_pass(JUST_COME + 0.1)
    stage.call(apply(2, US, SPARE))
    stage.let_pass(0.1)
    assert stage.recorder.said == [("started",), ("unfed", "position"), ("fed", "position"), ("position", "old")]


def test_what_an_output_that_stands_by_issued_for_a_task_that_it_has_let_go_of_does_not_count() -> None:
    stage, _ = with_stand_by("of another task")
    stage.caller.ask(KEYS.call(ODOMETRY, "release"), encode(release(2)), 1.0, lambda _: None)
    stage.let_pass(0.1)
    stage.caller.ask(KEYS.call(ODOMETRY, "apply"), encode(apply(3)), 1.0, lambda _: None)
    stage.call(apply(2, US, SPARE))
    stage.let_pass(10.0)
    assert stage.recorder.said == [("started",), ("unfed", "position")]


def test_an_input_that_changes_back_to_an_output_hears_its_last_signal_again() -> None:
    stage, _ = with_stand_by("of the other")
    stage.call(apply(2, US, SPARE))
    stage.let_pass(JUST_COME + 0.1)
    stage.call(apply(3, US, {"position": (Wire(TRACKER, "pose"),)}, standby=SPARE))
    stage.let_pass(JUST_COME + 0.1)
    stage.recorder.said.clear()
    stage.call(apply(4, US, SPARE))
    stage.let_pass(0.1)
    assert stage.recorder.said == [("fed", "position"), ("position", "of the other")]


@pytest.mark.parametrize("gently", [False, True])
def test_what_an_output_that_stands_by_issued_for_a_task_that_it_acts_for_no_more_does_not_count(gently: bool) -> None:
    stage, odometry = with_stand_by("for another goal")
    stage.let_pass(0.1)
    for call, message in (("release", release(2, US)), ("apply", apply(3, US))):
        stage.caller.ask(KEYS.call(ODOMETRY, call), encode(message), 1.0, lambda _: None)
        stage.let_pass(0.1)
    answers: list[Replies] = []
    stage.caller.ask(KEYS.call(CAP, "apply"), encode(apply(2, US, SPARE, gently=gently)), 60.0, answers.append)
    stage.let_pass(0.1)
    assert stage.recorder.said == [("started",), *([] if gently else [("unfed", "position")])]
    assert bool(answers) is not gently
    odometry.component.emit("pose", "for this one")
    stage.let_pass(0.2)
    assert stage.recorder.said[-1] == ("position", "for this one")
    assert answers


# Handing over: what ran before is let go of only when the next delivers.


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


def test_an_actuator_that_starts_while_nothing_stands_behind_its_source_rests_until_something_does() -> None:
    """A composite that feeds it is being repaired inside."""
    stage = Stage(profile=DRIVE_PROFILE)
    stage.call(reserve())
    stage.call(apply(1))
    assert stage.recorder.said == [("started",)]
    stage.let_pass(TOLERATES + 0.1)
    assert stage.recorder.said == [("started",), ("stopped",)]
    tracker = stage.neighbour()
    stage.call(follow(2))
    tracker.component.emit("pose", 1)
    stage.let_pass(0.1)
    assert stage.recorder.said[2:] == [("started",), ("position", 1)]
