"""The thread on which the code of components runs: its order, and the watch over code that does not return."""

from __future__ import annotations

import threading
import time

import pytest

from selfconf.sdk.code_thread import RUSH, CodeThread, RunningCode


def test_without_a_thread_of_its_own_everything_runs_at_once() -> None:
    ran: list[str] = []
    code = CodeThread(inline=True)
    code.signal(lambda: ran.append("signal"))
    code.call(lambda: ran.append("call"))
    assert ran == ["signal", "call"]


def test_calls_run_before_signals_and_each_in_their_order() -> None:
    ran: list[str] = []
    code = CodeThread(inline=False)
    for number in range(2):
        code.signal(lambda number=number: ran.append(f"signal {number}"))  # type: ignore[misc]  # a default binds it
    for number in range(2):
        code.call(lambda number=number: ran.append(f"call {number}"))  # type: ignore[misc]  # a default binds it
    assert ran == []
    code.poll()
    assert ran == ["call 0", "call 1", "signal 0", "signal 1"]


def test_a_call_that_comes_while_signals_run_is_next() -> None:
    ran: list[str] = []
    code = CodeThread(inline=False)
    code.signal(lambda: (ran.append("first"), code.call(lambda: ran.append("call"))))
    code.signal(lambda: ran.append("second"))
    code.poll()
    assert ran == ["first", "call", "second"]


def test_what_is_due_at_intervals_does_not_wait_for_all_signals_nor_these_for_it() -> None:
    ran = ""
    code = CodeThread(inline=False)

    def run(what: str) -> None:
        nonlocal ran
        ran += what

    def due(times: int) -> None:
        run("t")
        if times > 1:
            code.tick(lambda: due(times - 1))

    for _ in range(6):
        code.signal(lambda: run("s"))
    code.tick(lambda: due(4))
    code.poll()
    assert ran == "tststst"
    code.poll()
    assert ran == "tststst" + "sss"
    code.tick(lambda: run("t"))
    code.poll()
    assert ran == "tststst" + "sss" + "t"


def test_a_poll_runs_what_waits_and_not_what_that_hands_over_again() -> None:
    thread, ran = CodeThread(inline=False), list[str]()

    def go_on() -> None:
        ran.append("signal")
        if len(ran) < 10:
            thread.signal(go_on)

    thread.signal(go_on)
    thread.call(lambda: ran.append("call"))
    thread.poll()
    assert ran == ["call", "signal"]
    thread.poll(1.0)
    assert ran == ["call", "signal", "signal"]


def test_it_waits_for_the_first_thing_to_do_and_may_be_woken() -> None:
    code = CodeThread(inline=False)
    ran, ended = threading.Event(), threading.Event()
    thread = threading.Thread(target=code.run, args=(ended.is_set,))
    thread.start()
    code.signal(ran.set)
    assert ran.wait(5.0)
    ended.set()
    code.wake_up()
    thread.join(5.0)
    assert not thread.is_alive()


def test_what_is_handed_over_while_it_sleeps_wakes_it_at_once() -> None:
    code, ended = CodeThread(inline=False), threading.Event()
    thread = threading.Thread(target=code.run, args=(ended.is_set,))
    began = time.monotonic()
    thread.start()
    for _ in range(20):
        ran = threading.Event()
        ran.wait(10 * RUSH)  # until nothing more is expected, and the thread sleeps
        code.signal(ran.set)
        assert ran.wait(5.0)
    ended.set()
    code.wake_up()
    thread.join(5.0)
    assert time.monotonic() - began < 4.0  # by itself it looks twice a second


def test_whatever_several_threads_hand_over_runs_in_their_order_though_it_goes_to_sleep_in_between() -> None:
    code = CodeThread(inline=False)
    ran: dict[tuple[int, int], None] = {}
    all_ran = threading.Event()
    count = 300

    def hand_over(who: int) -> None:
        for number in range(count):
            code.signal(lambda number=number: ran.update({(who, number): None}))  # type: ignore[misc]  # a default binds it
            while number % 10 == 0 and (who, number) not in ran and not all_ran.is_set():
                all_ran.wait(0.0001)  # until it has run, so that the thread sleeps again and again

    thread = threading.Thread(target=code.run, args=(all_ran.is_set,))
    thread.start()
    others = [threading.Thread(target=hand_over, args=(who,)) for who in range(3)]
    for one in others:
        one.start()
    for one in others:
        one.join(20.0)
    code.signal(all_ran.set)
    assert all_ran.wait(5.0)
    thread.join(5.0)
    for who in range(3):
        assert [number for one, number in ran if one == who] == list(range(count))


def test_code_that_has_not_returned_in_its_time_is_seen_by_another_thread_and_only_that() -> None:
    code = CodeThread(inline=False)
    begun, end = threading.Event(), threading.Event()

    def hang() -> None:
        begun.set()
        end.wait(10.0)

    assert code.overdue() is None
    code.call(lambda: code.limited("me", "received", 0.0, hang))
    thread = threading.Thread(target=code.poll)
    thread.start()
    assert begun.wait(5.0)
    overdue = code.overdue()
    assert overdue is not None
    assert (overdue.owner, overdue.what, overdue.limit) == ("me", "received", 0.0)
    assert code.overdue() == overdue
    end.set()
    thread.join(5.0)
    assert code.overdue() is None


def test_code_may_not_take_long_while_something_is_to_come_to_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("selfconf.sdk.code_thread.TO_REST", 0.0)
    code, seen = CodeThread(inline=False), list[object]()

    def look() -> None:
        time.sleep(0.01)  # what is measured: the code takes longer than it may
        seen.append(code.overdue())

    code.call(lambda: code.limited("me", "received", 60.0, look))
    code.rest(lambda: code.limited("you", "stopped", 60.0, look))
    code.call(lambda: code.limited("me", "started", 60.0, look))
    code.poll()
    first, second, third = seen
    assert isinstance(first, RunningCode)
    assert (first.owner, first.why_overdue) == (
        "me",
        "`received` has not returned within 0 s, though a component is to come to rest",
    )
    assert isinstance(second, RunningCode)
    assert (second.owner, second.what) == ("you", "stopped")
    assert third is None


def test_code_within_its_time_is_not_overdue_and_what_breaks_in_it_breaks_out() -> None:
    code = CodeThread(inline=True)
    seen: list[object] = []
    code.limited("me", "started", 60.0, lambda: seen.append(code.overdue()))
    assert seen == [None]
    try:
        code.limited("me", "started", 60.0, lambda: 1 / 0)
    except ZeroDivisionError:
        seen.append("broke")
    assert seen == [None, "broke"]
    assert code.running is None
