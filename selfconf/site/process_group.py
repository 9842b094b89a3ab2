"""A process with all that it starts in turn: one session and one group, which is signalled and ended as a whole.

A session of its own, so that Ctrl-C on the terminal of the site reaches the site alone, which ends its processes in its
own time. What a process leaves behind when it ends (a shell's child, say) is ended with it: it might act on.

What has left the session (`setsid`, a daemon) is found by a variable that it has inherited, where the system shows the
environments of processes as Linux does: its parent may have ended long ago. A program that was started with an
environment of its own making, or for another user, is not found; nor is one without the variable, which so is allowed
to stay.

A number says what is meant only as long as no other process can have it. That of the group is free once the program has
been waited for and nothing is left in the group, after which it is never signalled again; a process outside is held by
a descriptor (pidfd_open(2), where there is such a thing) before it is looked at and signalled.
"""

from __future__ import annotations

import os
import secrets
import signal
import subprocess
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path

from selfconf.termination import alive, stopped

GROUP_VARIABLE = "SELFCONF_PROCESS_GROUP"
"""The variable that each process of a group inherits: words apart by spaces, the last of which no other group has.

Those before are of the groups around it: what a component starts may be a site, whose components are of its group too.
"""
_PROCESSES = Path("/proc")
"""Where Linux shows the processes."""
_BEGINNING = 0.05
"""For how many seconds at most a process may be on its way into a program (execve), where it shows no environment."""
_FIRST_LOOK = 0.02
"""Seconds after which it is checked again whether what a program has left behind has ended; then twice as many."""


class ProcessGroup:
    """One started program."""

    def __init__(self, words: Sequence[str], folder: Path, environment: Mapping[str, str]) -> None:
        """Start it. Raises OSError or ValueError for a command that cannot be started."""
        self._mark = secrets.token_hex(8)
        self._empty = False
        """Whether nothing is left in the group, so that its number may be another's."""
        self._process = subprocess.Popen(
            list(words),
            cwd=folder,
            env={**environment, GROUP_VARIABLE: f"{environment.get(GROUP_VARIABLE, '')} {self._mark}".strip()},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            start_new_session=True,
        )
        self.number = self._process.pid
        """The process id, which is the number of the group as well."""

    def pipes(self) -> tuple[tuple[str, int], ...]:
        """The streams that it prints on, by name. They are the caller's to close from now on. Raises OSError."""
        printed, complained = self._process.stdout, self._process.stderr
        assert printed is not None
        assert complained is not None
        with printed, complained:
            return ("stdout", os.dup(printed.fileno())), ("stderr", os.dup(complained.fileno()))

    def code(self) -> int | None:
        """The exit code of the program itself; None while it runs."""
        return self._process.poll()

    def gone(self) -> bool:
        """Whether the program has ended, and all that it started.

        What has ended and not been waited for by its parent (a zombie) is over: where process 1 does not wait for what
        it inherits, as in some containers, it stays so forever.
        """
        return self.code() is not None and not (self._is_in_group() or any(self._outside()))

    def frozen(self) -> bool:
        """Whether the program was stopped by a signal (SIGSTOP) and does not go on."""
        return self.code() is None and stopped(self.number)

    def terminate(self) -> None:
        """Ask all of it to end."""
        self._send(signal.SIGTERM)

    def kill(self) -> None:
        """End all of it."""
        self._send(signal.SIGKILL)

    def wait(self, seconds: float) -> bool:
        """Wait until the program itself has ended; return whether it has."""
        try:
            self._process.wait(seconds)
        except subprocess.TimeoutExpired:
            return False
        return True

    def wait_for_all(self, seconds: float) -> bool:
        """Wait until the program has ended, and all that it started; return whether they have."""
        deadline, pause = time.monotonic() + seconds, _FIRST_LOOK
        if not self.wait(seconds):
            return False
        while not self.gone():
            left = deadline - time.monotonic()
            if left <= 0:
                return False
            time.sleep(min(pause, left))  # nothing tells when what the program has left behind ends
            pause *= 2
        return True

    def _send(self, number: int) -> None:
        """Send a signal to all of the group, and to what has left it."""
        if self._has_number():
            _reached(os.killpg, self.number, number)
        for process in self._outside():
            self._send_outside(process, number)

    def _is_in_group(self) -> bool:
        """Whether a process is left in the group that has not ended."""
        if not (self._has_number() and _reached(os.killpg, self.number, 0)):
            return False
        shown = _shown()
        return not shown or any(map(self._has_member, shown))

    def _has_member(self, process: int) -> bool:
        try:
            return os.getpgid(process) == self.number and alive(process)
        except ProcessLookupError:
            return False

    def _has_number(self) -> bool:
        """Whether the number of the group is still its own.

        No other process and no other group has it as long as the program has not been waited for, or one of the group
        is left. So a process of that number is a later one, which may have come since the group was last looked at.
        """
        if self._process.returncode is not None and not self._empty:
            self._empty = _reached(os.kill, self.number, 0) or not _reached(os.killpg, self.number, 0)
        return not self._empty

    def _outside(self) -> Iterator[int]:
        """The processes that this one has started, or those in turn, and that have left its group."""
        return filter(self._is_outside, _shown())

    def _is_outside(self, process: int) -> bool:
        with suppress(OSError):  # it has ended, or it is another user's
            for line in _environment(process).split(b"\0"):
                name, _, words = line.partition(b"=")
                if name == GROUP_VARIABLE.encode() and self._mark.encode() in words.split():
                    return os.getpgid(process) != self.number
        return False

    def _send_outside(self, process: int, number: int) -> None:
        """Send a signal to a process outside, unless its number has become another's."""
        if not hasattr(os, "pidfd_open") or not hasattr(signal, "pidfd_send_signal"):
            _reached(os.kill, process, number)
            return
        try:
            held = os.pidfd_open(process)
        except ProcessLookupError:
            return
        except OSError:  # a kernel without it, or no descriptor is left
            _reached(os.kill, process, number)
            return
        try:
            if self._is_outside(process):
                _reached(signal.pidfd_send_signal, held, number)
        finally:
            os.close(held)


def _shown() -> list[int]:
    """The processes that the system shows: none where it never does, or not now, as where no file can be opened."""
    try:
        return [int(one.name) for one in _PROCESSES.iterdir() if one.name.isdecimal()]
    except OSError:
        return []


def _environment(process: int) -> bytes:
    """The environment of a process, apart by zeros. Raises OSError if it has ended, or is the kernel's.

    One that is just on its way into a program has neither an environment nor a command line: that is waited for.
    """
    shown = _PROCESSES / str(process)
    until = time.monotonic() + _BEGINNING
    while not (environment := (shown / "environ").read_bytes()) and time.monotonic() < until:
        if (shown / "cmdline").read_bytes():
            return (shown / "environ").read_bytes()
        (shown / "exe").readlink()  # what has ended and what is the kernel's has none
        time.sleep(0.001)  # nothing tells when the program has begun
    return environment


def _reached(send: Callable[[int, int], None], receiver: int, number: int) -> bool:
    """Send a signal; return whether it could be sent."""
    try:
        send(receiver, number)
    except (ProcessLookupError, PermissionError):
        return False
    return True
