"""The loop of a bus in real time."""

from __future__ import annotations

import logging
import threading
from functools import partial

import pytest

from selfconf.bus.loop import Loop


def test_polling_with_nothing_to_say_returns_at_once() -> None:
    loop = Loop()
    began = loop.now()
    loop.poll()
    assert loop.now() - began < 0.5


def test_polling_waits_no_longer_than_asked() -> None:
    loop = Loop()
    began = loop.now()
    loop.poll(0.03)
    assert 0.03 <= loop.now() - began < 1.0


def test_polling_returns_as_soon_as_something_was_said() -> None:
    loop = Loop()
    said: list[int] = []
    loop.wake_up(lambda: said.append(1))
    loop.poll(60.0)
    assert said == [1]


def test_polling_says_what_the_said_brings_about() -> None:
    loop = Loop()
    said: list[str] = []
    loop.wake_up(lambda: loop.wake_up(lambda: said.append("and so")))
    loop.poll()
    assert said == ["and so"]


def test_polling_waits_for_a_timer_that_is_due_before_the_deadline() -> None:
    loop = Loop()
    said: list[str] = []
    loop.later(0.02, lambda: said.append("timer"))
    loop.poll(60.0)
    assert said == ["timer"]


def test_a_timer_that_was_undone_is_not_waited_for() -> None:
    loop = Loop()
    loop.later(0.01, lambda: None)()
    began = loop.now()
    loop.poll(0.03)
    assert 0.03 <= loop.now() - began < 1.0


def test_a_callback_that_breaks_is_logged_and_the_loop_goes_on(caplog: pytest.LogCaptureFixture) -> None:
    loop = Loop()
    said: list[int] = []

    def breaks() -> None:
        raise RuntimeError("no such port")

    loop.wake_up(breaks)
    loop.wake_up(lambda: said.append(1))
    with caplog.at_level(logging.ERROR):
        loop.poll()
    assert said == [1]
    assert "no such port" in caplog.text


class Panic(BaseException):
    """As Zenoh has it: what a library in Rust panics with is no Exception."""


def test_a_panic_does_not_end_the_thread_of_the_loop(caplog: pytest.LogCaptureFixture) -> None:
    def panic() -> None:
        raise Panic("DidntWrite")

    loop, said = Loop(), threading.Event()
    loop.run_aside()
    loop.wake_up(panic)
    loop.wake_up(said.set)
    assert said.wait(10.0)
    loop.end()
    assert "a callback broke" in caplog.text
    assert "DidntWrite" in caplog.text


@pytest.mark.parametrize("ending", [KeyboardInterrupt, SystemExit])
def test_what_ends_a_program_ends_the_loop_too(ending: type[BaseException]) -> None:
    def end() -> None:
        raise ending

    loop = Loop()
    loop.wake_up(end)
    with pytest.raises(ending):
        loop.poll()


def test_a_flood_holds_up_neither_timers_nor_the_end() -> None:
    loop = Loop()
    said = 0
    went_off: list[float] = []

    def flood() -> None:
        nonlocal said
        said += 1
        loop.wake_up(flood)

    loop.wake_up(flood)
    began = loop.now()
    loop.later(0.02, lambda: went_off.append(loop.now() - began))
    loop.run(lambda: bool(went_off))
    assert said > 1
    assert went_off[0] < 2.0


def test_running_asks_until_after_each_round() -> None:
    loop = Loop()
    told: list[bool] = []
    loop.later(0.01, lambda: told.append(True))
    loop.run(lambda: bool(told))
    assert told


def test_a_thread_of_its_own_sleeps_until_there_is_something_to_do() -> None:
    rounds: list[float] = []

    class Counting(Loop):
        def poll(self, seconds: float = 0.0) -> None:
            rounds.append(seconds)
            super().poll(seconds)

    loop, told = Counting(), threading.Event()
    loop.run_aside()
    loop.later(0.01, told.set)
    assert told.wait(60)
    loop.end()
    assert min(rounds) > 60


def test_nothing_is_said_after_the_end() -> None:
    loop = Loop()
    said: list[int] = []
    loop.wake_up(lambda: said.append(1))
    loop.later(0.0, lambda: said.append(2))
    loop.end()
    loop.poll()
    assert not said


def test_the_end_waits_for_what_runs_on_the_thread_of_the_loop(caplog: pytest.LogCaptureFixture) -> None:
    loop, began, over = Loop(), threading.Event(), list[bool]()

    def slow() -> None:
        began.set()
        threading.Event().wait(0.1)
        over.append(True)

    loop.run_aside()
    loop.wake_up(slow)
    assert began.wait(10.0)
    loop.end()
    assert over == [True]
    own = Loop()
    own.run_aside()
    own.wake_up(own.end)
    thread = own._thread
    assert thread is not None
    thread.join(10.0)
    assert (thread.is_alive(), caplog.text) == (False, "")


def test_the_end_in_the_middle_of_a_round_is_the_end() -> None:
    loop = Loop()
    said: list[int] = []
    loop.wake_up(loop.end)
    loop.wake_up(lambda: said.append(1))
    loop.poll()
    assert not said


def test_timers_that_were_undone_are_not_kept_until_their_time() -> None:
    loop = Loop()
    said: list[int] = []
    kept = [loop.later(60.0, lambda: said.append(1)) for _ in range(10)]
    for _ in range(20_000):
        loop.later(60.0, lambda: said.append(2))()
    assert len(loop._timers) <= 2 * Loop.FEW_TIMERS
    assert sum(timer.action is not None for _, _, timer in loop._timers) == len(kept)


def test_timers_that_are_due_again_at_once_hold_up_nothing_that_arrives() -> None:
    loop = Loop()
    said: list[str] = []

    def again() -> None:
        said.append("timer")
        loop.later(0.0, again)

    again()
    again()
    loop.wake_up(lambda: said.append("call"))
    loop.poll()
    assert said.index("call") <= 4


def test_timers_go_off_in_order_though_others_between_them_were_undone() -> None:
    class TurnedByHand(Loop):
        time = 0.0

        def now(self) -> float:
            return self.time

    loop = TurnedByHand()
    said: list[int] = []
    undone = []
    for number in range(500):
        undo = loop.later(number % 7, partial(said.append, number))
        if number % 5:
            undone.append(undo)
    for undo in undone:
        undo()
        undo()
    loop.time = 7.0
    loop.poll()
    assert said == sorted(range(0, 500, 5), key=lambda number: number % 7)
    assert not loop._timers


def test_undoing_a_timer_that_has_gone_off_does_nothing() -> None:
    loop = Loop()
    said: list[int] = []
    undo = loop.later(0.0, lambda: said.append(1))
    loop.poll()
    undo()
    assert (said, loop._taken_back) == ([1], 0)


def test_what_is_urgent_waits_for_one_of_the_bulk_at_most() -> None:
    loop = Loop()
    said: list[str] = []
    for _ in range(5000):
        loop.enqueue_bulk(lambda: said.append("bulk"))
    loop.wake_up(lambda: said.append("call"))
    loop.poll()
    assert said.index("call") == 1


def test_the_bulk_goes_on_in_a_flood_of_what_is_urgent() -> None:
    loop = Loop()
    said: list[str] = []

    def flood() -> None:
        loop.wake_up(flood)

    loop.wake_up(flood)
    loop.enqueue_bulk(lambda: said.append("one"))
    loop.enqueue_bulk(lambda: said.append("two"))
    loop.poll()
    assert said == ["one", "two"]


def test_a_bulk_that_is_full_drops_the_oldest_and_counts_them() -> None:
    loop = Loop()
    said: list[int] = []
    for number in range(Loop.MOST_IN_BULK + 5):
        loop.enqueue_bulk(partial(said.append, number))
    while len(said) < Loop.MOST_IN_BULK:
        loop.poll()
    assert said == list(range(5, Loop.MOST_IN_BULK + 5))
    assert loop.dropped == 5


def test_a_bulk_that_is_too_large_drops_the_oldest_but_never_the_newest() -> None:
    loop = Loop()
    said: list[int] = []
    for number in range(5):
        loop.enqueue_bulk(partial(said.append, number), Loop.MOST_BYTES // 2 - Loop.OVERHEAD)
    loop.enqueue_bulk(partial(said.append, 5), 2 * Loop.MOST_BYTES)
    loop.poll()
    assert (said, loop.dropped) == ([5], 5)


def test_what_has_run_takes_no_room_and_leaves_nothing_to_do() -> None:
    loop, said = Loop(), list[int]()
    for number in range(10):
        loop.enqueue_bulk(partial(said.append, number), Loop.MOST_BYTES // 2)
        loop.poll()
    loop.enqueue_bulk(partial(said.append, 10), Loop.MOST_BYTES // 2 - Loop.OVERHEAD)
    loop.enqueue_bulk(partial(said.append, 11), Loop.MOST_BYTES // 2 - Loop.OVERHEAD)
    loop.poll()
    assert (said, loop.dropped) == (list(range(12)), 0)
    assert loop._waiting.empty()


@pytest.mark.parametrize("urgent", [True, False])
def test_messages_that_say_nothing_are_bounded_too(urgent: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Loop, "MOST_BYTES", 10 * Loop.OVERHEAD)
    loop, said = Loop(), list[int]()
    for number in range(12):
        (loop.enqueue_urgent if urgent else loop.enqueue_bulk)(partial(said.append, number), 0)
    loop.poll()
    assert said == (list(range(10)) if urgent else list(range(2, 12)))


def test_urgent_messages_that_find_no_room_are_dropped_until_those_before_have_run() -> None:
    loop = Loop()
    said: list[int] = []
    half = Loop.MOST_BYTES // 2 - Loop.OVERHEAD
    assert [loop.enqueue_urgent(partial(said.append, number), half) for number in range(3)] == [True, True, False]
    loop.wake_up(partial(said.append, 3))
    loop.poll()
    assert loop.enqueue_urgent(partial(said.append, 4), 2 * Loop.MOST_BYTES)
    loop.poll()
    assert (said, loop.dropped) == ([0, 1, 3, 4], 1)


def test_nothing_of_the_bulk_is_lost_or_doubled_among_many_threads() -> None:
    loop = Loop()
    said: list[int] = []

    def put(thread: int) -> None:
        for number in range(1000):
            loop.enqueue_bulk(partial(said.append, 1000 * thread + number))

    threads = [threading.Thread(target=put, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    loop.run(lambda: len(said) == 4000)
    for thread in threads:
        thread.join()
    loop.poll()
    assert sorted(said) == list(range(4000))
    assert all([s for s in said if s // 1000 == t] == list(range(1000 * t, 1000 * t + 1000)) for t in range(4))
