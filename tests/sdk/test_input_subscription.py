"""One input's subscription to one output: what is passed over, what waits, and when it is lost."""

from __future__ import annotations

import itertools
from dataclasses import replace
from typing import Any

import pytest

from selfconf.bus.memory import Network
from selfconf.bus.memory_bus import MemoryBus
from selfconf.bus.port import Request, Urgency
from selfconf.model.profile import Input, Ports
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Cause, Fail, Stamp, Wire
from selfconf.sdk.blindness import TOLERATES
from selfconf.sdk.code_thread import CodeThread
from selfconf.sdk.input_subscription import (
    ASK_FOR_LAST,
    UNSEEN,
    InputEvents,
    InputSubscription,
)
from selfconf.sdk.inputs import Inputs
from selfconf.sdk.signal_queue import EVENTS
from tests.lab import Recorder
from tests.sdk.stage import (
    CAP,
    CAP_PROFILE,
    DRIVE_PROFILE,
    KEYS,
    TRACKER,
    US,
    Stage,
    apply,
    follow,
    release,
    reserve,
)


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


def test_an_output_that_does_not_answer_is_asked_for_its_last_signal_until_it_does() -> None:
    """Though it has issued one before: it was out of sight, so that the input is unfed, and has nothing else to say."""
    stage = Stage()
    tracker = stage.network.node()
    unanswered: list[Request] = []
    tracker.announce(KEYS.life(TRACKER, "l"))
    stop = tracker.serve(KEYS.outputs(TRACKER), lambda request: request.finish())
    stage.call(follow(1))
    said = encode(Stamp(TRACKER, "l", 1, 0.0))
    tracker.publisher(KEYS.output(TRACKER, "pose"), Urgency.EVENT).put(b"7", said)
    stage.let_pass(10.0)
    stop()
    stop = tracker.serve(KEYS.outputs(TRACKER), unanswered.append)
    node = stage.runtime.bus
    assert isinstance(node, MemoryBus)
    stage.network.cut(node, tracker)
    stage.let_pass(0.1)
    stage.network.reconnect(node, tracker)
    stage.let_pass(8.0)
    assert len(unanswered) == 4  # each had twice the time of the one before
    stop()

    answered: list[Request] = []

    def answer(request: Request) -> None:
        answered.append(request)
        request.reply(KEYS.output(TRACKER, "pose"), b"7", said)
        request.finish()

    tracker.serve(KEYS.outputs(TRACKER), answer)
    stage.let_pass(8.0)
    assert stage.recorder.said.count(("position", 7)) == 2
    asked = len(answered)
    stage.let_pass(40.0)
    assert len(answered) == asked


def test_an_answer_that_takes_longer_than_a_second_is_had_in_the_end() -> None:
    """A large signal over a slow link: each question has twice the time of the one before."""
    stage = Stage()
    tracker = stage.network.node()
    asked: list[float] = []

    def answer(request: Request) -> None:
        def say() -> None:
            request.reply(KEYS.output(TRACKER, "pose"), b"7", encode(Stamp(TRACKER, "l", 1, 0.0)))
            request.finish()

        asked.append(stage.network.time)
        tracker.later(6.0, say)

    tracker.announce(KEYS.life(TRACKER, "l"))
    tracker.serve(KEYS.outputs(TRACKER), answer)
    stage.call(follow(1))
    stage.let_pass(60.0)
    assert stage.recorder.said.count(("position", 7)) == 1
    assert len(asked) < 10


def test_an_answer_that_is_too_large_for_the_bus_is_asked_for_only_as_often_as_before_the_first_signal(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    stage = Stage()
    tracker = stage.network.node()
    asked: list[Request] = []

    def answer(request: Request) -> None:
        asked.append(request)
        request.reply(KEYS.output(TRACKER, "pose"), b"7" * 200_000, encode(Stamp(TRACKER, "l", 1, 0.0)))
        request.finish()

    monkeypatch.setattr("selfconf.bus.memory_questions.LARGEST_REPLIES", 100_000)
    tracker.announce(KEYS.life(TRACKER, "l"))
    tracker.serve(KEYS.outputs(TRACKER), answer)
    stage.call(follow(1))
    stage.let_pass(30.0)
    assert len(asked) == 1 + len(ASK_FOR_LAST)


def test_a_signal_is_not_new_of_an_output_that_says_it_has_none_by_now() -> None:
    """It was issued for a task of which its component has let go just before it was listened to."""
    stage = Stage()
    tracker = stage.network.node()
    tracker.announce(KEYS.life(TRACKER, "l"))
    tracker.serve(KEYS.outputs(TRACKER), lambda request: request.finish())

    def has_a_subscriber(matching: bool) -> None:
        publisher.put(b"7", encode(Stamp(TRACKER, "l", 1, 0.0)))

    publisher = tracker.publisher(KEYS.output(TRACKER, "pose"), Urgency.EVENT, has_a_subscriber)
    other = Wire(IRI("urn:c:other"), "pose", None)
    stage.call(apply(1, inputs={"position": (other,)}, standby={"position": (Wire(TRACKER, "pose", None),)}))
    stage.let_pass(0.1)
    stage.call(follow(2))
    stage.let_pass(0.1)
    assert ("position", 7) not in stage.recorder.said


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


# Signals that come after the end of what has issued them, as what is more urgent may overtake them.


class Late:
    """An actuator that follows a tracker whose every message is given by hand."""

    def __init__(self, lives: bool = True) -> None:
        """`lives`: its life is seen."""
        self.stage = Stage(profile=DRIVE_PROFILE)
        self.tracker = self.stage.others
        if lives:
            self.leave = self.tracker.announce(KEYS.life(TRACKER, "t"))
        self._asked: list[Request] = []
        self.tracker.serve(KEYS.outputs(TRACKER), self._asked.append)
        self.stage.call(reserve())
        self.stage.call(follow())
        self.stage.let_pass(0.1)
        self.answer_nothing()
        self.issue(1)

    @property
    def subscriptions(self) -> dict[tuple[str, Wire], InputSubscription]:
        """Those of the actuator."""
        inputs = self.stage.runtime.inputs
        assert isinstance(inputs, Inputs)
        return inputs._subscriptions

    def issue(self, sequence: int) -> None:
        """A signal comes."""
        stamp = encode(Stamp(TRACKER, "t", sequence, 0.0))
        self.tracker.publisher(KEYS.output(TRACKER, "pose"), Urgency.SIGNAL).put(b"%d" % sequence, stamp)
        self.stage.let_pass(0.01)

    def let_go(self, sequence: int) -> None:
        """The tracker says that it has let go of a task, after that signal."""
        fail = Fail(TRACKER, "t", 1, Cause.LET_GO, "it was released", sequence=sequence)
        self.tracker.publisher(KEYS.fail(TRACKER), Urgency.EVENT).put(encode(fail))
        self.stage.let_pass(0.01)

    def answer_nothing(self) -> None:
        """The tracker is not on: it has no last signal."""
        for request in self._asked:
            request.finish()
        self._asked.clear()
        self.stage.let_pass(0.01)

    def answer(self, sequence: int) -> None:
        """The tracker acts, and that was its last signal."""
        for request in self._asked:
            stamp = encode(Stamp(TRACKER, "t", sequence, 0.0))
            request.reply(KEYS.output(TRACKER, "pose"), b"%d" % sequence, stamp)
        self.answer_nothing()

    def came_to_rest(self) -> bool:
        """Whether the actuator is at rest, after the time that it may be blind."""
        self.stage.let_pass(TOLERATES + UNSEEN + 0.1)
        return self.stage.recorder.said[-1] == ("stopped",)


@pytest.mark.parametrize("before_the_answer", [True, False])
def test_a_signal_from_before_its_source_let_go_of_its_task_feeds_nothing(before_the_answer: bool) -> None:
    late = Late()
    late.let_go(3)
    if before_the_answer:
        late.issue(2)
        late.answer_nothing()
    else:
        late.answer_nothing()
        assert late.came_to_rest()
        late.issue(2)
    assert late.came_to_rest()
    late.issue(4)
    assert late.stage.recorder.said[-2:] == [("started",), ("position", 4)], "it acts again"


def test_what_stands_by_has_not_just_issued_what_comes_late_of_another_task() -> None:
    late = Late()
    late.stage.call(
        apply(2, US, {"position": (Wire(CAP, "velocity"),)}, standby={"position": (Wire(TRACKER, "pose"),)})
    )
    late.let_go(3)
    late.issue(2)
    late.answer_nothing()
    (by,) = [one for key, one in late.subscriptions.items() if key[1].component == TRACKER]
    assert not by.heard
    late.issue(4)
    assert by.heard


def test_what_stands_by_has_not_just_issued_what_it_may_have_issued_for_a_task_that_it_has_let_go_of() -> None:
    late = Late()
    standby = {"position": (Wire(TRACKER, "pose"),)}
    late.stage.call(apply(2, US, {"position": (Wire(CAP, "velocity"),)}, standby=standby))
    late.issue(2)
    (by,) = [one for key, one in late.subscriptions.items() if key[1].component == TRACKER]
    assert by.heard
    late.let_go(3)
    assert not by.heard, "it has not said yet whether it acts for another task"
    late.issue(3)
    assert not by.heard
    late.issue(4)
    assert by.heard
    late.answer_nothing()
    assert by.heard, "it acts, for another task or this one"


def test_what_stands_by_and_acts_on_for_another_task_still_has_its_last_signal() -> None:
    late = Late()
    standby = {"position": (Wire(TRACKER, "pose"),)}
    late.stage.call(apply(2, US, {"position": (Wire(CAP, "velocity"),)}, standby=standby))
    late.let_go(3)
    late.answer(3)
    change = encode(follow(3, gently=True))
    late.stage.caller.ask(KEYS.call(late.stage.profile.component, "apply"), change, 5.0, lambda replies: None)
    late.stage.let_pass(0.1)
    late.answer(3)
    late.stage.let_pass(0.1)
    assert late.stage.recorder.said[-1] == ("position", 3)


def test_a_signal_from_after_its_source_let_go_of_a_task_is_news() -> None:
    late = Late()
    late.let_go(3)
    late.issue(4)
    late.answer_nothing()
    assert not late.came_to_rest()


def test_a_signal_from_before_the_end_of_the_life_of_its_source_feeds_for_a_moment() -> None:
    """It may also be a sign that the source was only cut off: then more of them come, or its life shows again."""
    late = Late()
    late.leave()
    assert late.came_to_rest()
    late.issue(2)
    assert late.stage.recorder.said[-2:] == [("started",), ("position", 2)]
    assert late.came_to_rest()


def test_a_late_signal_of_a_life_that_has_ended_feeds_for_a_moment_though_another_life_has_begun() -> None:
    late = Late()
    late.leave()
    late.tracker.announce(KEYS.life(TRACKER, "u"))
    assert late.came_to_rest()
    late.issue(2)
    assert late.stage.recorder.said[-1] == ("position", 2)
    assert late.came_to_rest()


def test_a_signal_that_comes_with_the_end_of_the_life_of_its_source_feeds_for_a_moment() -> None:
    """So it is when the actuator was frozen: what is urgent comes first as it goes on, then what was issued before."""
    late = Late()
    node = late.stage.runtime.bus
    assert isinstance(node, MemoryBus)
    late.stage.network.pause(node)
    late.leave()
    late.issue(2)
    late.stage.network.resume(node)
    late.stage.let_pass(0.01)
    assert late.stage.recorder.said[-1] == ("position", 2)
    assert late.came_to_rest()


def test_a_signal_of_a_source_of_which_no_life_was_ever_seen_feeds_for_a_moment() -> None:
    late = Late(lives=False)
    assert late.stage.recorder.said[-1] == ("position", 1)
    late.stage.let_pass(UNSEEN)  # it is looked for at first
    assert late.came_to_rest()


@pytest.mark.parametrize("sign", ["signals", "a life"])
def test_a_source_that_was_only_cut_off_feeds_again(sign: str) -> None:
    late = Late()
    late.leave()
    assert late.came_to_rest()
    for number in range(2, 9):
        late.issue(number)
        if sign == "a life" and number == 3:
            late.tracker.announce(KEYS.life(TRACKER, "t"))
            break
        late.stage.let_pass(UNSEEN - 0.1)
        assert late.stage.recorder.said[-1] == ("position", number)
    if sign == "a life":
        assert not late.came_to_rest()
    else:
        assert late.came_to_rest()
