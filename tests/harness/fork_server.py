"""Programs begun by a fork of a process that has imported already what they use, not by Python anew.

A command of selfconf imports for a tenth of a second and more before it does anything, and the tests begin hundreds.
Forked, it has its own arguments, environment, folder, streams, number and end; only its parent is the process that was
forked, not the one that runs the tests. That programs begin by themselves is tested by those that sites and users
begin: in `tests/api`, the readme, the tutorial, the demo, the benchmarks.
"""

from __future__ import annotations

import atexit
import multiprocessing
import os
import runpy
import signal
import subprocess
import sys
import threading
from collections.abc import Mapping, Sequence
from contextlib import suppress
from multiprocessing.connection import Connection
from pathlib import Path
from typing import NoReturn

PRELOADED = (
    "selfconf.api.tasks.run",
    "selfconf.api.sites.site_program",
    "selfconf.cli.main",
    "selfconf.cli.run",
    "selfconf.cli.site",
    "selfconf.sdk",
    "tests.harness.fork_server",
)
"""What the process has imported that is forked."""


class ForkedProgram:
    """A program that runs in a process of its own, with the methods of `subprocess.Popen`."""

    def __init__(self, words: Sequence[str], environment: Mapping[str, str], folder: Path, out: int) -> None:
        """`words` are what follows `python` on a command line, and `out` is what the program writes to."""
        context = multiprocessing.get_context("forkserver")
        context.set_forkserver_preload(list(PRELOADED))
        complaints, error = os.pipe()
        self.stderr = os.fdopen(complaints)
        streams = Connection(os.dup(out), readable=False), Connection(error, readable=False)
        self._process = context.Process(target=_run, args=(list(words), dict(environment), str(folder), *streams))
        self._process.start()
        for stream in streams:
            stream.close()
        assert self._process.pid is not None
        self.pid: int = self._process.pid

    def poll(self) -> int | None:
        """The exit code, None while it runs."""
        return self._process.exitcode

    def wait(self, timeout: float) -> int:
        """The exit code, once it has ended; TimeoutExpired if it does not in time."""
        self._process.join(timeout)
        if self._process.exitcode is None:
            raise subprocess.TimeoutExpired(self._process.name, timeout)
        return self._process.exitcode

    def send_signal(self, number: int) -> None:
        """Send a signal to the process, if it runs."""
        if self.poll() is None:
            with suppress(ProcessLookupError):  # it has ended, which this process is told later
                os.kill(self.pid, number)


def _run(words: list[str], environment: dict[str, str], folder: str, out: Connection, error: Connection) -> NoReturn:
    """Be the program, to its end."""
    nothing = os.open(os.devnull, os.O_RDONLY)
    for stream, number in ((nothing, 0), (out.fileno(), 1), (error.fileno(), 2)):
        os.dup2(stream, number)
    os.close(nothing)
    out.close()
    error.close()
    # Those that are there know of other files whether they can be sought in, and whether they are terminals.
    sys.stdout = os.fdopen(1, "w", closefd=False)
    sys.stderr = os.fdopen(2, "w", 1, errors="backslashreplace", closefd=False)
    vars(sys).update(__stdout__=sys.stdout, __stderr__=sys.stderr)  # to assign them is for an interpreter alone
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(environment)
    sys.path[:0] = [folder, *filter(None, environment.get("PYTHONPATH", "").split(os.pathsep))]
    code = 0
    try:
        if words[0] == "-m":
            sys.argv = words[1:]
            runpy.run_module(words[1], run_name="__main__", alter_sys=True)
        else:
            sys.argv = words
            runpy.run_path(words[0], run_name="__main__")
    except SystemExit as ended:
        code = ended.code if isinstance(ended.code, int) else 0 if ended.code is None else 1
        if isinstance(ended.code, str):
            print(ended.code, file=sys.stderr)
    except KeyboardInterrupt:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        os.kill(os.getpid(), signal.SIGINT)
    except BaseException:
        sys.excepthook(*sys.exc_info())
        code = 1
    threading._shutdown()  # type: ignore[attr-defined]
    atexit._run_exitfuncs()
    sys.stdout.flush()
    os._exit(code)
