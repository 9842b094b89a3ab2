"""Whether an output is lost: also signals that come after the end of what has issued them count for a moment."""

from __future__ import annotations

import pytest

from selfconf.bus.memory import MemoryBus
from selfconf.bus.port import Request, Urgency
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Cause, Fail, Stamp, Wire
from selfconf.sdk.inputs import Inputs
from selfconf.sdk.inputs.input_subscription import InputSubscription
from selfconf.sdk.inputs.source_watch import UNSEEN
from selfconf.sdk.unfed_inputs import TOLERATES
from tests.sdk.stage import (
    CAP,
    DRIVE_PROFILE,
    KEYS,
    TRACKER,
    US,
    Stage,
    apply,
    follow,
    reserve,
)


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
        return {(name, wire): it for name, one in inputs._inputs.items() for wire, it in one._subscriptions.items()}

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

    def fail(self, sequence: int, cause: Cause = Cause.FAIL, life: str = "t") -> None:
        """The tracker raises FAIL after that signal; number 0 is that of its site, which knows of none."""
        fail = Fail(TRACKER, life, 1, cause, "it is dark", sequence=sequence)
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


@pytest.mark.parametrize(
    ("failed", "cause", "blind"),
    [(1, Cause.FAIL, False), (2, Cause.FAIL, True), (3, Cause.HUNG, True), (0, Cause.CRASH, True)],
)
def test_a_fail_that_comes_after_what_its_source_has_issued_since_makes_nobody_blind(
    failed: int, cause: Cause, blind: bool
) -> None:
    late = Late()
    late.issue(2)
    late.fail(failed, cause)
    assert late.came_to_rest() is blind


@pytest.mark.parametrize("lives", [True, False])
@pytest.mark.parametrize(("sequence", "cause"), [(7, Cause.HUNG), (0, Cause.CRASH)])
def test_a_fail_of_another_life_makes_nobody_blind_while_the_source_lives(
    sequence: int, cause: Cause, lives: bool
) -> None:
    """It may be that of a process which was frozen, and finds when it goes on that its code has not returned."""
    late = Late()
    if not lives:
        late.leave()
    late.fail(sequence, cause, life="s")
    assert late.came_to_rest() is not lives


def test_what_stands_by_has_not_just_issued_what_comes_late_of_another_task() -> None:
    late = Late()
    late.stage.call(
        apply(2, US, {"position": (Wire(CAP, "velocity"),)}, standby={"position": (Wire(TRACKER, "pose"),)})
    )
    late.let_go(3)
    late.issue(2)
    late.answer_nothing()
    (by,) = [one for key, one in late.subscriptions.items() if key[1].component == TRACKER]
    assert not by.just_issued
    late.issue(4)
    assert by.just_issued


def test_what_stands_by_has_not_just_issued_what_it_may_have_issued_for_a_task_that_it_has_let_go_of() -> None:
    late = Late()
    standby = {"position": (Wire(TRACKER, "pose"),)}
    late.stage.call(apply(2, US, {"position": (Wire(CAP, "velocity"),)}, standby=standby))
    late.issue(2)
    (by,) = [one for key, one in late.subscriptions.items() if key[1].component == TRACKER]
    assert by.just_issued
    late.let_go(3)
    assert not by.just_issued, "it has not said yet whether it acts for another task"
    late.issue(3)
    assert not by.just_issued
    late.issue(4)
    assert by.just_issued
    late.answer_nothing()
    assert by.just_issued, "it acts, for another task or this one"


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


@pytest.mark.parametrize(("answered", "delivered"), [(4, 4), (2, 3)])
def test_of_what_stands_by_and_acts_for_another_task_its_newest_signal_counts(answered: int, delivered: int) -> None:
    """Its answer is one that it has issued since it began to act for that task; what waits may be of before."""
    late = Late()
    standby = {"position": (Wire(TRACKER, "pose"),)}
    late.stage.call(apply(2, US, {"position": (Wire(CAP, "velocity"),)}, standby=standby))
    late.let_go(3)
    late.issue(3)
    late.answer(answered)
    late.stage.call(follow(3))
    late.stage.let_pass(0.01)
    assert late.stage.recorder.said[-1] == ("position", delivered)


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
