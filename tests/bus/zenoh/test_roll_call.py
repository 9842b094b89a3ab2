"""Roll-calls of a session that ends its answers too soon; the contract of the bus makes them with a real one."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterable
from types import SimpleNamespace
from typing import Any

import pytest
import zenoh

from selfconf.bus.loop import Loop
from selfconf.bus.zenoh.channels import READ_TOGETHER
from selfconf.bus.zenoh.reader_threads import ReaderThreads
from selfconf.bus.zenoh.roll_call import MOST_DOUBTFUL, MOST_ROLL_CALLS, MOST_ROLL_CALLS_OF_MANY, RollCalls


class Answer:
    """A channel with what the session itself answers, and with what its router answers later, or has answered."""

    def __init__(self, known: Iterable[str], others: Iterable[str] = (), too_soon: bool = False) -> None:
        self.known, self.others = list(known), list(others)
        self.too_soon = too_soon
        self.may_end = threading.Event()
        self.may_end.set()

    def try_recv(self) -> Any:
        """A life that is there already."""
        if self.known:
            return SimpleNamespace(ok=SimpleNamespace(key_expr=self.known.pop(0)))
        if self.too_soon:
            raise zenoh.ZError("it has ended")
        return None

    def recv(self) -> Any:
        """Wait for another life, or for the end."""
        self.may_end.wait(10.0)
        self.known, self.others, self.too_soon = self.known + self.others, [], True
        return self.try_recv()


class Session:
    """A session with answers, the last of which it gives again and again."""

    def __init__(self, *answers: Answer) -> None:
        self.answers, self.calls = list(answers), 0

    def liveliness(self) -> Session:
        """What the session asks by."""
        return self

    def get(self, key: str, channel: object, timeout: float) -> Answer:
        """Ask once more."""
        self.calls += 1
        return self.answers.pop(0) if len(self.answers) > 1 else self.answers[0]


class Caller:
    """A loop that makes roll-calls."""

    def __init__(self, *answers: Answer) -> None:
        self.session, self.loop, self.heard = Session(*answers), Loop(), list[tuple[str, ...]]()
        self.linked = True
        self.calls = RollCalls(self.loop, self.session, ReaderThreads(), lambda: self.linked)

    def call(self, key: str = "a/live/*") -> None:
        """Make one."""
        self.calls.call(key, 1.0, self.heard.append)

    def hear(self, count: int = 1) -> list[tuple[str, ...]]:
        """What came of so many calls."""
        for _ in range(1000):
            if len(self.heard) >= count:
                break
            self.loop.poll(0.01)
        return self.heard


@pytest.mark.parametrize("key", ["a/live/*", "*/live/*"], ids=["few", "many"])
def test_a_call_is_answered_by_the_session_and_by_its_router(key: str) -> None:
    caller = Caller(Answer(["a/live/2"], ["a/live/1", "a/live/2"]))
    caller.call(key)
    assert caller.hear() == [("a/live/1", "a/live/2")]
    assert caller.session.calls == 1


@pytest.mark.parametrize("key", ["a/live/*", "*/live/*"], ids=["few", "many"])
def test_a_call_whose_answer_has_ended_before_the_session_has_said_all_is_made_again(key: str) -> None:
    caller = Caller(Answer([], too_soon=True), Answer(["a/live/2"], too_soon=True), Answer(["a/live/1"]))
    caller.call(key)
    assert caller.hear() == [("a/live/1", "a/live/2")]
    assert caller.session.calls == 3


def test_a_call_whose_answers_all_end_at_once_is_not_made_for_ever() -> None:
    caller = Caller(Answer([], too_soon=True))
    caller.call()
    assert caller.hear() == [()]
    assert caller.session.calls == MOST_ROLL_CALLS


def test_a_call_without_a_router_is_made_once() -> None:
    caller = Caller(Answer(["a/live/1"], too_soon=True))
    caller.linked = False
    caller.call()
    assert caller.hear() == [("a/live/1",)]
    assert caller.session.calls == 1


@pytest.mark.parametrize(("knows_many", "calls"), [(True, MOST_ROLL_CALLS_OF_MANY), (False, 1)])
def test_a_call_that_very_many_answer_is_made_twice_if_the_session_knows_them(knows_many: bool, calls: int) -> None:
    crowd = [f"{number:04}/live/1" for number in range(2 * READ_TOGETHER)]
    caller = Caller(*(Answer(crowd) for _ in range(MOST_ROLL_CALLS)))
    caller.calls.knows_many = knows_many
    caller.call("*/live/*")
    assert caller.hear() == [tuple(crowd)]
    assert caller.session.calls == calls


def test_calls_for_a_few_lives_are_read_by_one_thread_in_turn() -> None:
    answers = [Answer([], [f"a/live/{number}"]) for number in range(20)]
    answers[0].may_end.clear()
    caller = Caller(*answers)
    before = threading.active_count()
    for _ in answers:
        caller.call()
    assert threading.active_count() <= before + 1
    answers[0].may_end.set()
    assert sorted(caller.hear(len(answers))) == sorted((f"a/live/{number}",) for number in range(20))
    caller.call()
    assert len(caller.hear(len(answers) + 1)) == len(answers) + 1


def test_a_call_for_a_few_does_not_keep_one_for_many_waiting() -> None:
    slow = Answer([], ["a/live/1"])
    slow.may_end.clear()
    caller = Caller(slow, Answer([], ["b/live/1"]))
    caller.call()
    caller.call("*/live/*")
    assert caller.hear() == [("b/live/1",)]
    slow.may_end.set()
    assert caller.hear(2) == [("b/live/1",), ("a/live/1",)]


LIFE = "a/live/1"


def test_a_life_that_an_answer_has_left_out_and_the_next_has_not_is_doubtful() -> None:
    caller = Caller(Answer(["a/live/2"], too_soon=True), Answer(["a/live/2"], [LIFE]))
    caller.call()
    assert caller.hear() == [(LIFE, "a/live/2")]
    assert list(caller.calls.doubtful) == [LIFE]


@pytest.mark.parametrize(
    ("answers", "alive", "is_so", "stays_doubtful"),
    [
        ([Answer([LIFE])], True, True, True),
        ([Answer([LIFE])], False, False, False),
        ([Answer([]), Answer([LIFE])], True, True, True),
        ([Answer([]), Answer([LIFE])], False, False, False),
        ([Answer([]), Answer([])], True, False, True),
        ([Answer([]), Answer([])], False, True, True),
    ],
)
def test_what_is_told_of_a_doubtful_life_is_believed_if_an_answer_confirms_it(
    answers: list[Answer], alive: bool, is_so: bool, stays_doubtful: bool
) -> None:
    caller, confirmed = Caller(*answers), list[bool]()
    caller.calls.doubtful[LIFE] = None
    caller.calls.confirm(LIFE, alive, lambda: confirmed.append(alive))
    for _ in range(30):
        caller.loop.poll(0.01)
    assert confirmed == [alive] * is_so
    assert list(caller.calls.doubtful) == [LIFE] * stays_doubtful


@pytest.mark.parametrize(("known", "alive"), [([LIFE], True), ([], False)])
def test_calls_for_a_doubtful_life_that_time_out_say_nothing_and_it_is_called_again(
    known: list[str], alive: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A life that none of them has shown is shown once its router answers again, and no end before that."""
    monkeypatch.setattr("selfconf.bus.zenoh.roll_call.CONFIRMATION", 0.05)
    late = [Answer([]) for _ in range(4)]
    caller, confirmed = Caller(*late, Answer(known)), list[bool]()
    caller.calls.doubtful[LIFE] = None
    caller.calls.confirm(LIFE, alive, lambda: confirmed.append(alive))
    for count, answer in enumerate(late, 1):
        answer.may_end.clear()
        deadline = time.monotonic() + 10.0
        while caller.session.calls < count and time.monotonic() < deadline:
            caller.loop.poll(0.01)
        assert caller.session.calls == count
        caller.loop.poll(0.06)
        assert not confirmed
        answer.may_end.set()
    for _ in range(30):
        caller.loop.poll(0.01)
    assert confirmed == [alive]
    assert caller.session.calls == len(late) + 1


def test_so_many_lives_are_doubtful_at_most_and_these_are_the_last() -> None:
    crowd = [f"{number:04}/live/1" for number in range(MOST_DOUBTFUL)]
    caller = Caller(Answer([], too_soon=True), Answer([], crowd), Answer([], too_soon=True), Answer([], [LIFE]))
    caller.call("*/live/*")
    assert caller.hear() == [tuple(crowd)]
    assert list(caller.calls.doubtful) == crowd
    caller.call()
    assert caller.hear(2)[1:] == [(LIFE,)]
    assert list(caller.calls.doubtful) == [*crowd[1:], LIFE]


def test_a_call_for_which_no_thread_can_be_started_is_answered_with_the_next(monkeypatch: pytest.MonkeyPatch) -> None:
    def cannot_start(thread: threading.Thread) -> None:
        raise RuntimeError("can't start new thread")

    caller = Caller(Answer(["a/live/1"]), Answer(["a/live/2"]))
    with monkeypatch.context() as full:
        full.setattr(threading.Thread, "start", cannot_start)
        with pytest.raises(RuntimeError, match="can't start new thread"):
            caller.call()
    caller.call()
    assert caller.hear(2) == [("a/live/1",), ("a/live/2",)]
