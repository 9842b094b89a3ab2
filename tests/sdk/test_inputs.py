"""The inputs of a component: what they pass on, what they pass over, and when they report silence."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import pytest

from selfconf.bus.memory import Faults, Network
from selfconf.bus.memory_bus import MemoryBus
from selfconf.bus.port import Replies, Request, Urgency
from selfconf.model.profile import Input, Ports
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Cause, Stamp, Wire
from selfconf.sdk.code_thread import CodeThread
from selfconf.sdk.inputs import BEGINNING, HANDOVER, JUST_COME, PATIENCE, UNSEEN, InputEvents, Inputs
from selfconf.sdk.runtime import ComponentRuntime
from selfconf.sdk.signal_queue import EVENTS
from selfconf.sdk.supervision import GRACE
from tests.lab import Recorder
from tests.sdk.stage import (
    CAP,
    CAP_PROFILE,
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


@pytest.mark.parametrize(
    ("payload", "attachment"),
    [
        (b"1", b""),
        (b"1", b"raw"),
        (b"not json", encode(Stamp(TRACKER, "l", 1, 0.0))),
        (b"[" * 100_000, encode(Stamp(TRACKER, "l", 1, 0.0))),
        (b"1", encode(Stamp(CAP, "l", 1, 0.0))),
        (b"1", encode(release(1, US))),
        (b"\xff\xfe", encode(Stamp(TRACKER, "l", 1, 0.0))),
    ],
)
def test_what_is_no_signal_of_the_source_is_passed_over(payload: bytes, attachment: bytes) -> None:
    stage = Stage()
    stage.call(follow())
    stage.others.publisher(KEYS.output(TRACKER, "pose"), Urgency.EVENT).put(payload, attachment)
    stage.let_pass(0.1)
    assert stage.recorder.said == [("started",)]
    assert stage.component.active


def test_signals_that_come_late_or_twice_are_passed_over_and_a_new_life_counts_from_one_again() -> None:
    stage = Stage()
    stage.call(follow())
    source = stage.others.publisher(KEYS.output(TRACKER, "pose"), Urgency.EVENT)
    for life, sequence in (("a", 1), ("a", 3), ("a", 2), ("a", 3), ("b", 1), ("b", 2)):
        source.put(b"%d" % sequence, encode(Stamp(TRACKER, life, sequence, 0.0)))
    stage.let_pass(0.1)
    assert [value for _, value in stage.recorder.said[1:]] == [1, 3, 1, 2]


def silence(stage: Stage) -> list[tuple[IRI, str]]:
    """Whose silence was reported, and in which life."""
    return [(fail.component, fail.life) for fail in stage.fails if fail.cause is Cause.SILENCE]


def test_an_output_that_promised_a_rate_and_stops_is_reported_and_again_as_long_as_nothing_comes() -> None:
    stage = Stage()
    tracker = stage.neighbour()
    stage.call(follow(period=0.1))
    tracker.component.emit("pose", 1)
    stage.let_pass(PATIENCE * 0.1 - 0.05)
    assert not silence(stage)
    stage.let_pass(0.1)
    assert silence(stage) == [(TRACKER, "")]
    assert stage.fails[-1].detail == f"no signal on 'pose' for {PATIENCE * 0.1:.2f} s"
    stage.let_pass(PATIENCE * 0.1)
    assert len(silence(stage)) == 2
    tracker.component.emit("pose", 2)
    stage.let_pass(0.1)
    assert len(silence(stage)) == 2


def test_an_output_that_keeps_its_promise_is_not_reported() -> None:
    stage = Stage()
    tracker = stage.neighbour()
    stage.call(follow(period=0.1))
    for number in range(50):
        tracker.component.emit("pose", number)
        stage.let_pass(0.1)
    assert not silence(stage)


def test_an_output_may_take_its_time_to_begin_but_not_for_ever() -> None:
    stage = Stage()
    stage.neighbour()
    stage.call(follow(period=0.1))
    stage.let_pass(BEGINNING - 1)
    assert not silence(stage)
    stage.let_pass(1.1)
    assert silence(stage)


def test_an_output_that_promised_nothing_may_be_silent() -> None:
    stage = Stage()
    stage.neighbour().component.emit("pose", 1)
    stage.call(follow())
    stage.let_pass(100)
    assert not silence(stage)


def test_an_output_that_is_followed_no_more_may_be_silent() -> None:
    stage = Stage()
    tracker = stage.neighbour()
    stage.call(follow(1, period=0.1))
    tracker.component.emit("pose", 1)
    stage.let_pass(0.05)
    stage.call(apply(2, US))
    stage.let_pass(10)
    assert not silence(stage)


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


ODOMETRY = IRI("urn:c:odometry")


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


def test_what_an_output_that_stands_by_issued_long_ago_does_not_count() -> None:
    stage, _ = with_stand_by("old")
    stage.let_pass(JUST_COME + 0.1)
    stage.call(apply(2, US, SPARE))
    stage.let_pass(0.1)
    assert stage.recorder.said == [("started",), ("unfed", "position")]


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

    def __init__(self, inputs: Mapping[str, tuple[Wire, ...]] = TO_ODOMETRY) -> None:
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


def test_a_gentle_call_that_is_repeated_goes_on_with_the_same_handover() -> None:
    change = Change()
    change.let_pass(HANDOVER / 2, change.tracker)
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


def test_an_output_that_promises_to_issue_seldom_has_time_for_what_it_promises() -> None:
    change = Change({"position": (Wire(ODOMETRY, "pose", HANDOVER),)})
    change.let_pass(PATIENCE * HANDOVER - 0.4, change.tracker)
    assert not silence(change.stage)
    change.let_pass(0.8, change.tracker)
    assert (ODOMETRY, "") in silence(change.stage)
    assert change.told == {TRACKER.short}


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


# Queues, where the component's code has a thread of its own.


class Slow:
    """An input that follows one output, and a component whose code has no time until `poll` of its thread."""

    def __init__(self, period: float | None = None, depth: int | None = None) -> None:
        self.network, self.code = Network(), CodeThread(inline=False)
        self.heard: list[Any] = []
        self.unfed: list[str] = []
        profile = replace(CAP_PROFILE, ports=Ports((Input("position", (IRI("urn:s:Pose"),), depth),)))
        events = InputEvents(lambda port, signal: self.heard.append(signal.value), lambda *_: None, self.unfed.append)
        self.inputs = Inputs(self.network.node(), KEYS, self.code, profile, events)
        self.inputs.follow(follow(period=period))
        self._source = self.network.node().publisher(KEYS.output(TRACKER, "pose"), Urgency.SIGNAL)
        self._numbers = itertools.count(1)

    def issue(self, count: int) -> None:
        """Signals come, numbered from 1."""
        for number in itertools.islice(self._numbers, count):
            self._source.put(b"%d" % number, encode(Stamp(TRACKER, "l", number, 0.0)))
        self.network.run(lambda: False, 0.1)


def test_of_an_output_with_a_rate_a_slow_component_gets_the_newest_signal() -> None:
    slow = Slow(period=0.1)
    slow.issue(100)
    slow.code.poll()
    assert slow.heard == [100]
    slow.issue(5)
    slow.code.poll()
    assert slow.heard == [100, 105]


def test_of_an_output_without_a_rate_a_slow_component_gets_every_signal_up_to_a_bound() -> None:
    slow = Slow()
    slow.issue(EVENTS)
    slow.code.poll()
    assert slow.heard == [*range(1, EVENTS + 1)]
    slow.heard.clear()
    slow.issue(EVENTS + 7)
    slow.code.poll()
    assert slow.heard == [*range(EVENTS + 8, 2 * EVENTS + 8)]


@pytest.mark.parametrize("period", [None, 0.1])
def test_an_input_may_say_itself_how_many_signals_wait(period: float | None) -> None:
    slow = Slow(period, depth=3)
    slow.issue(10)
    slow.code.poll()
    assert slow.heard == [8, 9, 10]


def test_what_is_dropped_is_counted() -> None:
    slow = Slow(depth=3)
    slow.issue(10)
    assert slow.inputs.dropped == 7
    slow.inputs.end()
    assert slow.inputs.dropped == 7


def test_what_waits_when_an_input_is_connected_to_something_else_is_not_delivered_any_more() -> None:
    slow = Slow()
    slow.issue(10)
    slow.inputs.follow(apply(2))
    slow.code.poll()
    assert slow.heard == []


def test_an_output_that_has_issued_nothing_is_asked_for_its_last_signal_again() -> None:
    stage = Stage()
    asked: list[str] = []

    def answer(request: Request) -> None:
        asked.append(request.key)
        if len(asked) > 1:  # the first question was there before the signal, and the signal before the subscription
            request.reply(KEYS.output(TRACKER, "pose"), b"7", encode(Stamp(TRACKER, "l", 1, 0.0)))
        request.finish()

    stage.others.serve(KEYS.outputs(TRACKER), answer)
    stage.call(follow(1))
    stage.let_pass(10.0)
    assert ("position", 7) in stage.recorder.said
    assert len(asked) == 2


def test_a_component_may_read_values_in_a_way_of_its_own() -> None:
    class Reader(Recorder):
        @staticmethod
        def signal_value(value: Any, media: str) -> Any:
            if value == b"broken":
                raise ValueError("broken")
            return value, media

    stage = Stage(Reader())
    tracker = stage.neighbour()
    stage.call(follow())
    for value in (b"broken", b"whole"):
        tracker.component.emit("pose", value, media="text/plain")
    stage.let_pass(0.1)
    assert stage.recorder.said == [("started",), ("position", (b"whole", "text/plain"))]


def test_what_waits_when_an_output_is_lost_is_not_delivered_after_its_loss_and_feeds_nothing() -> None:
    """A slow component acts on what has come since it was unfed, not on what its dead source had said before."""
    slow = Slow()
    leave = slow.network.node().announce(KEYS.life(TRACKER, "l"))
    slow.issue(10)
    leave()
    slow.network.run(lambda: False, 0.1)
    slow.code.poll()
    assert (slow.unfed, slow.heard) == (["position"], [])
    slow.issue(1)
    slow.code.poll()
    assert slow.heard == [11]
