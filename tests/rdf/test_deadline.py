"""Limits of time: nested ones, and those that only a process's own work uses up."""

from __future__ import annotations

import subprocess
import sys
import threading
from collections.abc import Callable
from contextlib import AbstractContextManager

import pytest

from selfconf.rdf.deadline import ProcessorTimeUp, TimeUp, deadline, processor_limit

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
