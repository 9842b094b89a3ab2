"""A program of this machine that has claimed the name of a task, as `run` does, and was suspended, as by Ctrl-Z."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

_PROGRAM = """
import os, signal, sys
from selfconf.this_machine import claim

claimed = claim(*sys.argv[1:3], sys.argv[3:])
os.kill(os.getpid(), signal.SIGSTOP)
signal.pause()
"""


@contextmanager
def suspended_run(ecology: str, name: str, *endpoints: str) -> Iterator[subprocess.Popen[bytes]]:
    """A program that was suspended once it had claimed a name; it is killed at the end."""
    with subprocess.Popen([sys.executable, "-c", _PROGRAM, ecology, name, *endpoints]) as program:
        try:
            assert os.WIFSTOPPED(os.waitpid(program.pid, os.WUNTRACED)[1])
            yield program
        finally:
            program.send_signal(signal.SIGKILL)
