"""The processes of a demo: started together, listened to line by line, and ended together, whatever happens."""

from __future__ import annotations

import os
import queue
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType

from selfconf.sdk import parent_environment


@dataclass(frozen=True, slots=True)
class Line:
    """A line that a process wrote; `text` is None when the process has ended."""

    process: str
    text: str | None


class Crew:
    """Named processes, and what they write to stdout and stderr in order of arrival."""

    def __init__(self, environment: Mapping[str, str] | None = None) -> None:
        path = os.pathsep.join(filter(None, (str(Path(__file__).parent.parent), os.environ.get("PYTHONPATH"))))
        own = {"PYTHONPATH": path}
        if "SELFCONF_RUNTIME_DIR" in os.environ:
            own["SELFCONF_RUNTIME_DIR"] = str(Path(os.environ["SELFCONF_RUNTIME_DIR"]).absolute())
        self._environment = {**os.environ, **(environment or {}), **parent_environment(), **own}
        self._processes: dict[str, subprocess.Popen[str]] = {}
        self._lines: queue.SimpleQueue[Line] = queue.SimpleQueue()

    def __enter__(self) -> Crew:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.end_all()

    def start(self, name: str, *arguments: str) -> int:
        """Start `python ARGUMENTS` in a process group of its own, away from Ctrl-C; its process number.

        It runs in the root folder, so paths are given in full: modules and a selfconf.toml that lie in the folder of
        the user have nothing to do with the demo.
        """
        process = subprocess.Popen(
            [sys.executable, *arguments],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env=self._environment,
            cwd=os.sep,
            start_new_session=True,
        )
        self._processes[name] = process
        threading.Thread(target=self._listen, args=(name, process), daemon=True).start()
        return process.pid

    def _listen(self, name: str, process: subprocess.Popen[str]) -> None:
        assert process.stdout is not None
        with process:
            for text in process.stdout:
                self._lines.put(Line(name, text.rstrip("\n")))
        self._lines.put(Line(name, None))

    def lines(self, seconds: float) -> Iterator[Line]:
        """What is written, until that much time has passed since the call."""
        deadline = time.monotonic() + seconds
        while (left := deadline - time.monotonic()) > 0:
            try:
                yield self._lines.get(timeout=left)
            except queue.Empty:
                return

    def kill(self, name: str) -> None:
        """End a process at once, with -9."""
        self._processes[name].kill()

    def end(self, name: str, number: signal.Signals = signal.SIGINT, seconds: float = 10.0) -> int | None:
        """Ask a process to end and wait for it; its exit code, or None if it had to be killed."""
        process = self._processes[name]
        if process.poll() is None:
            process.send_signal(number)
        try:
            return process.wait(seconds)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
            return None

    def end_all(self) -> None:
        """End every process, the last one first."""
        for name in reversed(self._processes):
            self.end(name, signal.SIGTERM, 5.0)
