"""Time limits for work that may be long because of what strangers wrote, such as matching `^(a+)+$` against a text.

SHACL and SPARQL on rdflib are Python, and Python's regular expressions look for signals as they go, so an alarm
(`setitimer`, POSIX) ends both without a process or a thread of its own. An alarm reaches only the main thread, in which
every program of selfconf does its work; elsewhere there is no limit. What is raised inside a destructor or a callback
of the garbage collector is lost, so the alarm goes on ringing until the block is left, and Python's report of lost
exceptions (`sys.unraisablehook`) leaves it out. It also rings in vain while the block imports a module: a library that
is imported by half stays so, as Python forgets its package and keeps its modules, and no code can import it ever again.
And it does so while a handler runs by which another signal ends the program, as that signal would be lost; and while
python-sat frees a solver: left between this and the note that it is done, the solver would be freed a second time with
the object that has it, and the process would crash.

What no caller waits for any more is ended in the same way, by another thread (`abandonable`).

A verdict must not depend on what else the machine is doing. So what decides about files and shapes is limited in
processor time (`processor_limit`); the time of the clock (`deadline`) is for what a user waits for.
"""

from __future__ import annotations

import gc
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from functools import partial
from types import FrameType
from typing import NamedTuple

from selfconf.os_signals import is_handler

SHORT = 1.0
"""Seconds up to which a limit of processor time is short."""
RINGING = 0.05
"""Seconds between one ring of the alarm and the next."""


class TimeUp(BaseException):
    """The time is up; no `Exception`, because libraries on the way catch those."""


class ProcessorTimeUp(TimeUp):
    """The processor time is up, whatever the clock says."""


class Abandoned(BaseException):
    """No caller waits any more for what is being done; no `TimeUp`, after which something else may be tried."""


class _Timer(NamedTuple):
    """A timer of the process: its number, the signal that it sends, and the clock that it goes by."""

    number: int
    signal: signal.Signals
    clock: Callable[[], float]


def deadline(seconds: float) -> AbstractContextManager[None]:
    """Raise TimeUp in the block if it takes longer; an outer deadline still counts, and goes on."""
    return _limited(seconds, _Timer(signal.ITIMER_REAL, signal.SIGALRM, time.monotonic))


@contextmanager
def processor_limit(seconds: float) -> Iterator[None]:
    """Raise TimeUp in the block if it takes more processor time; an outer limit still counts, and goes on.

    The time of all threads of the process counts, and none of other processes. The garbage collector rests where the
    limit is `SHORT`: in a program with many values it may take longer than that, and not because of what is limited.
    """
    collecting = seconds <= SHORT and gc.isenabled()
    if collecting:
        gc.disable()
    try:
        with _limited(seconds, _Timer(signal.ITIMER_PROF, signal.SIGPROF, time.process_time)):
            yield
    finally:
        if collecting:
            gc.enable()


@contextmanager
def _limited(seconds: float, timer: _Timer) -> Iterator[None]:
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    began, entered, report = timer.clock(), True, sys.unraisablehook
    outside = _not_to_be_left(sys._getframe())

    def ring(number: int, frame: FrameType | None) -> None:
        if entered and _not_to_be_left(frame) == outside:
            raise ProcessorTimeUp if number == signal.SIGPROF else TimeUp

    handler = signal.signal(timer.signal, ring)
    outer, _ = signal.getitimer(timer.number)
    try:
        sys.unraisablehook = partial(_report_unless_ringing, report)
        signal.setitimer(timer.number, min(seconds, outer or seconds), RINGING)
        try:
            yield
        finally:
            entered = False  # an alarm that rings just now must not keep what follows from being done
    finally:
        signal.setitimer(timer.number, 0)
        signal.signal(timer.signal, handler)
        sys.unraisablehook = report
        if outer:
            signal.setitimer(timer.number, max(outer - (timer.clock() - began), 1e-6), RINGING)


@contextmanager
def abandonable() -> Iterator[Callable[[], None]]:
    """Give a function by which any thread ends the block, which then raises Abandoned; later it does nothing.

    Its alarm is a timer of the processor time in Python and libraries (ITIMER_VIRTUAL), which nothing else uses here,
    and passes while there is something to end. In another thread than the main one the block goes on to its end.
    """
    if threading.current_thread() is not threading.main_thread():
        yield lambda: None
        return
    entered, left, report = True, False, sys.unraisablehook
    lock = threading.RLock()  # the thread that is ended may be the one that calls, in a handler of a signal
    outside = _not_to_be_left(sys._getframe())

    def ring(number: int, frame: FrameType | None) -> None:
        if entered and _not_to_be_left(frame) == outside:
            raise Abandoned

    def abandon() -> None:
        with lock:
            if not left:
                signal.setitimer(signal.ITIMER_VIRTUAL, 1e-6, RINGING)

    handler = signal.signal(signal.SIGVTALRM, ring)
    try:
        sys.unraisablehook = partial(_report_unless_ringing, report)
        try:
            yield abandon
        finally:
            entered = False
    finally:
        with lock:
            left = True
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, handler)
        sys.unraisablehook = report


def _not_to_be_left(frame: FrameType | None) -> int:
    """Count the frames of an import, of what frees an object, or of a handler of another signal, from one outwards."""
    count = 0
    while frame is not None:
        code = frame.f_code
        frees = code.co_name == "delete" and "pysat" in code.co_filename
        count += code.co_filename.startswith("<frozen importlib") or frees or is_handler(frame)
        frame = frame.f_back
    return count


def _report_unless_ringing(report: Callable[[sys.UnraisableHookArgs], object], lost: sys.UnraisableHookArgs) -> None:
    """Report a lost exception, unless it is an alarm, which rings again."""
    if not isinstance(lost.exc_value, TimeUp | Abandoned):
        report(lost)
