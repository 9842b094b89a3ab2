"""One input of a component: when it is unfed and fed again, and what it hears of an output that stood by."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from selfconf.bus.memory import Faults, MemoryBus
from selfconf.bus.port import Replies, Urgency
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Wire
from selfconf.sdk.component import Component
from selfconf.sdk.inputs.followed_output import JUST_COME
from selfconf.sdk.inputs.silence_watch import PATIENCE
from selfconf.sdk.inputs.source_watch import UNSEEN
from selfconf.sdk.runtime import ComponentRuntime
from selfconf.sdk.runtime.supervision import GRACE
from tests.sdk.stage import (
    CAP,
    DRIVE_PROFILE,
    KEYS,
    ODOMETRY,
    TASKS,
    THEM,
    TRACKER,
    TRACKER_PROFILE,
    US,
    Stage,
    Watchful,
    apply,
    follow,
    other_source,
    release,
    reserve,
    silence,
)


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
