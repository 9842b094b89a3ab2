"""Processes that are shown while they play: what the examples of bridges have in common."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from importlib.util import find_spec
from typing import IO

PATIENCE = 60.0
"""Seconds that anything may take, on a busy machine."""
LAST_WORDS = 1.0
"""Seconds that the last lines of a process that has ended may take."""
INSTALLED_BY = {
    "aiohttp": "'.[wot]'",
    "numpy": "numpy",
    "rosbags": "'.[ros2]'",
    "zenoh_ros2_sdk": "zenoh-ros2-sdk",
}
"""What `pip install` takes in the checkout for each module that an example may need besides those of selfconf."""


def need(*modules: str) -> None:
    """Say what is to be installed first. Raises SystemExit if a module is missing."""
    missing = [module for module in modules if find_spec(module) is None]
    if missing:
        packages = " ".join(INSTALLED_BY[module] for module in missing)
        raise SystemExit(f"this example needs {', '.join(missing)}; type in the checkout: pip install {packages}")


class Player:
    """A process whose lines are shown, and can be waited for."""

    def __init__(self, *command: str) -> None:
        self.command = command
        environment = {**os.environ, "PYTHONUNBUFFERED": "1"}
        self.process = subprocess.Popen(
            [sys.executable, *command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment
        )
        self.lines: list[str] = []
        self._listening = threading.Thread(target=self._listen, args=(self.process.stdout,), daemon=True)
        self._listening.start()

    def _listen(self, said: IO[str]) -> None:
        with said:
            for line in said:
                print(line, end="", flush=True)
                self.lines.append(line.strip())

    def says(self, words: str, times: int = 1) -> str:
        """Wait until so many lines have some words in them; the last of these."""

        def found() -> list[str]:
            return [line for line in self.lines if words in line]

        until(lambda: len(found()) >= times or self.process.poll() is not None, f"{words!r}")
        self._listening.join(0.0 if self.process.poll() is None else LAST_WORDS)
        if len(found()) < times:
            raise SystemExit(f"{' '.join(self.command)} has ended before it said {words!r}")
        return found()[times - 1]

    def shines(self) -> bool:
        """Whether it has said that it is on."""
        return any(line.endswith(" is on") for line in self.lines)

    def end(self) -> None:
        """End the process, and wait until it is gone."""
        self.process.terminate()
        self.process.wait()


def until(condition: Callable[[], bool], what: str) -> None:
    """Wait for something. Raises SystemExit if it does not come."""
    deadline = time.monotonic() + PATIENCE
    pause = threading.Event()
    while not condition():
        if time.monotonic() > deadline:
            raise SystemExit(f"waited in vain for {what}")
        pause.wait(0.02)


def free_port() -> int:
    """A port of this machine on which no program listens."""
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        port: int = taken.getsockname()[1]
        return port


@contextmanager
def stage() -> Iterator[Callable[..., Player]]:
    """Start players inside the `with` block, by their commands; all of them end with it, the last one first."""
    with ExitStack() as stack:

        def play(*command: str) -> Player:
            player = Player(*command)
            stack.callback(player.end)
            return player

        yield play
