"""Limits of time: nested ones, and those that only a process's own work uses up."""

from __future__ import annotations

import gc
import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from contextlib import AbstractContextManager, suppress
from importlib import import_module
from pathlib import Path

import pytest

from selfconf.rdf.deadline import Abandoned, ProcessorTimeUp, TimeUp, abandonable, deadline, processor_limit

Limit = Callable[[float], AbstractContextManager[None]]
LIMITS = pytest.mark.parametrize("limit", [deadline, processor_limit])


def endless() -> None:
    """Work without an end."""
    while True:
        pass


@LIMITS
def test_what_takes_longer_is_ended(limit: Limit) -> None:
    with pytest.raises(TimeUp), limit(0.1):
        endless()


@LIMITS
def test_a_limit_within_another_leaves_the_outer_one_alone(limit: Limit) -> None:
    def inner() -> None:
        with limit(30):
            pass
        endless()

    with pytest.raises(TimeUp), limit(0.2):
        inner()


@pytest.mark.parametrize(("outer", "inner"), [(deadline, processor_limit), (processor_limit, deadline)])
def test_a_limit_of_each_kind_may_be_set_within_the_other(outer: Limit, inner: Limit) -> None:
    with pytest.raises(TimeUp), outer(0.1), inner(30):
        endless()
    with pytest.raises(TimeUp), outer(30), inner(0.1):
        endless()


@pytest.mark.parametrize(("seconds", "rests"), [(0.1, True), (30.0, False)])
def test_the_collector_of_garbage_takes_nothing_of_a_short_limit(seconds: float, rests: bool) -> None:
    with processor_limit(seconds):
        assert gc.isenabled() is not rests
        with processor_limit(seconds / 2):
            assert gc.isenabled() is not rests
        assert gc.isenabled() is not rests
    assert gc.isenabled()
    gc.disable()
    try:
        with processor_limit(seconds):
            pass
        assert not gc.isenabled()
    finally:
        gc.enable()


class _Slow:
    """Its destructor takes longer than any limit of these tests."""

    def __del__(self) -> None:
        endless()


@LIMITS
def test_an_alarm_that_is_lost_in_a_destructor_rings_again_and_is_not_reported(limit: Limit) -> None:
    def work() -> None:
        _Slow()
        endless()

    with pytest.raises(TimeUp), limit(0.05):
        work()


@LIMITS
def test_an_alarm_that_is_lost_in_a_callback_of_the_collector_rings_again_and_is_not_reported(limit: Limit) -> None:
    def collecting(phase: str, facts: dict[str, int]) -> None:
        gc.callbacks.remove(collecting)
        endless()

    def work() -> None:
        gc.callbacks.append(collecting)
        gc.collect()
        endless()

    with pytest.raises(TimeUp), limit(0.05):
        work()


def test_what_else_is_lost_within_a_limit_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    reported: list[object] = []
    monkeypatch.setattr(sys, "unraisablehook", lambda lost: reported.append(lost.exc_type))
    with processor_limit(30), deadline(30):
        _Broken()
    _Broken()
    assert reported == [ZeroDivisionError] * 2


class _Broken:
    """Its destructor fails."""

    def __del__(self) -> None:
        raise ZeroDivisionError


def test_waiting_uses_up_no_processor_time() -> None:
    with processor_limit(0.2):
        subprocess.run([sys.executable, "-c", "import time; time.sleep(0.5)"], check=True)


@LIMITS
def test_outside_of_the_main_thread_there_is_no_limit(limit: Limit) -> None:
    done: list[int] = []

    def work() -> None:
        with limit(1e-6):
            done.append(sum(range(100_000)))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert done


def test_processor_time_and_the_time_of_the_clock_are_told_apart() -> None:
    with pytest.raises(TimeUp) as ended, deadline(0.05):
        _spin()
    assert not isinstance(ended.value, ProcessorTimeUp)
    with pytest.raises(ProcessorTimeUp), processor_limit(0.05):
        _spin()


def _spin() -> None:
    while True:
        pass


def test_what_is_abandoned_is_not_taken_for_late_by_a_limit_within() -> None:
    late: list[BaseException] = []

    def work() -> None:
        try:
            with deadline(30), processor_limit(30):
                endless()
        except TimeUp as error:
            late.append(error)

    def abandoned() -> None:
        with abandonable() as abandon:
            threading.Timer(0.05, abandon).start()
            work()

    with pytest.raises(Abandoned):
        abandoned()
    assert not late


def test_a_handler_of_a_signal_may_abandon_what_it_interrupts() -> None:
    def abandoned() -> None:
        with abandonable() as abandon:
            signal.signal(signal.SIGUSR1, lambda *_: abandon())
            signal.raise_signal(signal.SIGUSR1)
            endless()

    before = signal.getsignal(signal.SIGUSR1)
    with pytest.raises(Abandoned):
        abandoned()
    signal.signal(signal.SIGUSR1, before)


def test_what_is_over_cannot_be_abandoned() -> None:
    with abandonable() as abandon:
        pass
    abandon()
    assert signal.getitimer(signal.ITIMER_VIRTUAL) == (0.0, 0.0)


@pytest.mark.parametrize(("name", "function"), [("Minicard", "minicard_del"), ("Cadical195", "cadical195_del")])
@LIMITS
def test_no_solver_is_freed_twice(limit: Limit, name: str, function: str, monkeypatch: pytest.MonkeyPatch) -> None:
    solvers = pytest.importorskip("pysat.solvers")
    freed: list[object] = []

    def free(solver: object, *_: object) -> None:
        freed.append(solver)
        if len(freed) == 1:
            signal.raise_signal(signal.SIGALRM if limit is deadline else signal.SIGPROF)

    monkeypatch.setattr(import_module("pysolvers"), function, free)
    with suppress(TimeUp), limit(60), getattr(solvers, name)():
        pass
    gc.collect()
    assert len(freed) == 1


def test_outside_of_the_main_thread_what_is_abandoned_goes_on_to_its_end() -> None:
    done: list[int] = []

    def work() -> None:
        with abandonable() as abandon:
            abandon()
            done.append(sum(range(100_000)))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert done


@pytest.mark.parametrize("limit", [deadline, processor_limit, None])
def test_no_module_is_imported_by_half(limit: Limit | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / "by_half"
    package.mkdir()
    (package / "__init__.py").write_text("from by_half import inner\n")
    work = "import time\nbegan = time.process_time()\nwhile time.process_time() < began + 0.2:\n    pass\n"
    (package / "inner.py").write_text(work)
    monkeypatch.syspath_prepend(str(tmp_path))

    def imported() -> None:
        with limit(0.05) if limit is not None else abandonable() as abandon:
            if abandon is not None:
                abandon()
            import_module("by_half")
            endless()

    with pytest.raises(Abandoned if limit is None else TimeUp):
        imported()
    assert {"by_half", "by_half.inner"} <= sys.modules.keys()


@LIMITS
def test_a_limit_is_kept_in_what_an_import_runs(limit: Limit, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    name = limit.__name__
    program = f"from selfconf.rdf.deadline import {name}\nwith {name}(0.05):\n    while True:\n        pass\n"
    (tmp_path / f"endless_{name}.py").write_text(program)
    monkeypatch.syspath_prepend(str(tmp_path))
    with pytest.raises(TimeUp):
        import_module(f"endless_{name}")
