"""When a program of selfconf ends: SIGINT, SIGTERM, SIGHUP, or because the program that started it is gone.

SIGHUP comes when the terminal is closed, and ends a program as Ctrl-C does; one that `nohup` has started ignores it.

A program that starts others puts `parent_environment()` into their environment; they look at intervals whether it is
still there, so that a parent that is killed with -9 leaves no process behind.
"""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import FrameType

from selfconf.bus.port import Bus
from selfconf.os_signals import run_to_its_end

PARENT_CHECK = 0.5
"""How often, in seconds, a program looks whether the one that started it is still there."""
_PARENT = "SELFCONF_PARENT"


def parent_environment() -> Mapping[str, str]:
    """The variables by which a program that is started ends with this one."""
    return {_PARENT: str(os.getpid())}


def started_by_another() -> bool:
    """Whether this program was started by another one, such as a site."""
    return _PARENT in os.environ


def orphaned(parent: int) -> bool:
    """Whether this program, whose parent process at first was `parent`, was started by another one that is gone.

    The parent is the one that started it, or a shell in between; a shell goes on when that one is gone.
    """
    starter = os.environ.get(_PARENT)
    if starter is None or not starter.isdigit():
        return False
    return os.getppid() != parent or (parent != int(starter) and not alive(int(starter)))


def alive(process: int) -> bool:
    """Whether a process of this machine is there. One that has ended is not, waited for or not."""
    return alive_since(process) is not None


def alive_since(process: int) -> str | None:
    """The start time of a process of this machine if it is there, as `start_time` has it; None if it has ended."""
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return None
    except PermissionError:
        pass
    status = _status(process)
    return None if status[:1] in ([b"Z"], [b"X"]) else _began(status)


def start_time(process: int) -> str:
    """When a process of this machine began, to tell it from a later one with its number; empty where not known.

    It is counted in clock ticks since the machine began (proc_pid_stat(5), field 22).
    """
    return _began(_status(process))


def stopped(process: int) -> bool:
    """Whether a process of this machine was stopped by a signal such as SIGSTOP; a debugger's stop is none."""
    return _status(process)[:1] == [b"T"]


_STATM = 512
"""More bytes than the seven numbers of proc_pid_statm(5) take."""


def resident_memory() -> int:
    """The resident memory of this process in bytes; zero where this system does not say.

    It is counted in pages (proc_pid_statm(5), field 2).
    """
    try:
        # Not by `Path`, which takes thrice as long: every component is asked for its state from time to time.
        file = os.open("/proc/self/statm", os.O_RDONLY | os.O_CLOEXEC)
        try:
            return int(os.read(file, _STATM).split()[1]) * os.sysconf("SC_PAGE_SIZE")
        finally:
            os.close(file)
    except (OSError, ValueError, IndexError):
        return 0


def _began(status: Sequence[bytes]) -> str:
    return b"".join(status[19:20]).decode()


def _status(process: int) -> list[bytes]:
    """The fields of a process from its state on; none if it is gone, or this system has no such files."""
    try:
        return Path(f"/proc/{process}/stat").read_bytes().rpartition(b")")[2].split()
    except OSError:
        return []


def ending_signals() -> tuple[signal.Signals, ...]:
    """The signals that end a program in order: SIGINT, SIGTERM, and SIGHUP unless it is ignored, as by `nohup`."""
    ignored = signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    return (signal.SIGINT, signal.SIGTERM) if ignored else (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def end_as_by_ctrl_c() -> None:
    """Let the signals that end a program raise KeyboardInterrupt, until there is a `Termination` that handles them.

    A program that a shell has started in the background ignores SIGINT otherwise.
    """
    for number in ending_signals():
        signal.signal(number, signal.default_int_handler)


def ignore_from_now_on() -> None:
    """Let no signal that ends a program change anything: everything is taken down, and the exit code is decided."""
    for number in ending_signals():
        signal.signal(number, signal.SIG_IGN)


class Termination:
    """True, when called, once the program is to end; before that `then` is called once, on the bus's thread.

    Without `then` a signal ends the program also while that thread is held up.
    """

    def __init__(
        self, bus: Bus, then: Callable[[], None] | None = None, told: Callable[[], None] = lambda: None
    ) -> None:
        """`told` wakes what waits for the end: on the bus's thread and, without `then`, where a signal is noticed too.

        That is on the main thread, which may be about to wait: then only the call on the other thread wakes it.
        """
        self._bus, self._then, self._told, self._ending = bus, then, told, False
        self._parent = os.getppid()
        self._before = {number: signal.signal(number, self._signalled) for number in ending_signals()}
        if started_by_another():
            bus.wake_up(self._look)

    def __call__(self) -> bool:
        return self._ending

    def heed_no_more(self) -> None:
        """Let signals do again what they did before; on another thread than the main one nothing changes."""
        if threading.current_thread() is threading.main_thread():
            for number, handler in self._before.items():
                if signal.getsignal(number) == self._signalled:  # and no handler of later
                    signal.signal(number, signal.SIG_DFL if handler is None else handler)

    @run_to_its_end
    def _signalled(self, _: int, __: FrameType | None) -> None:
        if self._then is None:
            self._ending = True
            self._told()
        self._bus.wake_up(self.end)

    def end(self) -> None:
        """Let the program end, as a signal does; to be called on the bus's thread."""
        first, self._ending = not self._ending, True
        if first and self._then is not None:
            self._then()
        if first or self._then is None:
            self._told()

    def _look(self) -> None:
        if orphaned(self._parent):
            self.end()
        else:
            self._bus.later(PARENT_CHECK, self._look)
