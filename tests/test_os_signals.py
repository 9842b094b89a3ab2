"""Handlers of signals that come to their end, whatever alarm rings meanwhile."""

from __future__ import annotations

import signal
import time
from collections.abc import Callable

import pytest

from selfconf.os_signals import run_to_its_end
from selfconf.rdf.deadline import Abandoned, abandonable


def endless() -> None:
    """Work without an end."""
    while True:
        pass


def test_no_alarm_ends_the_handler_of_a_signal_that_ends_the_program() -> None:
    """It would be as if that signal had never come."""
    noted: list[str] = []

    @run_to_its_end
    def ends(*_: object) -> None:
        end()
        began = time.process_time()
        while time.process_time() < began + 0.15:  # the alarm rings each 0.05 s
            pass
        noted.append("the end")

    def abandoned() -> None:
        nonlocal end
        with abandonable() as end:
            signal.signal(signal.SIGUSR1, ends)
            signal.raise_signal(signal.SIGUSR1)
            endless()

    end: Callable[[], None] = endless
    before = signal.getsignal(signal.SIGUSR1)
    with pytest.raises(Abandoned):
        abandoned()
    signal.signal(signal.SIGUSR1, before)
    assert noted == ["the end"]
