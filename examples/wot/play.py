"""A switch and two lamps that never heard of each other: `python examples/wot/play.py`.

It starts three Things, a bridge that lets them play in an ecology, and a task. Then it presses the switch, pulls the
plug of the lamp that shines, and presses the switch again: the other lamp has taken its place.
"""

from __future__ import annotations

import os
import secrets
import subprocess
import sys
import threading
import time
import urllib.request
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import IO

HERE = Path(__file__).parent
PATIENCE = 60.0
"""Seconds that anything may take, on a busy machine."""


class Player:
    """A process whose lines are shown, and can be waited for."""

    def __init__(self, *command: str) -> None:
        environment = {**os.environ, "PYTHONUNBUFFERED": "1"}
        self.process = subprocess.Popen(
            [sys.executable, *command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment
        )
        self.lines: list[str] = []
        threading.Thread(target=self._listen, args=(self.process.stdout,), daemon=True).start()

    def _listen(self, said: IO[str]) -> None:
        for line in said:
            print(line, end="", flush=True)
            self.lines.append(line.strip())

    def says(self, words: str, times: int = 1) -> str:
        """Wait until so many lines have some words in them; the last of these."""

        def found() -> list[str]:
            return [line for line in self.lines if words in line]

        until(lambda: len(found()) >= times, f"{words!r}")
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


def press(switch: str) -> None:
    """Press a switch, as a hand would."""
    print("* the switch is pressed", flush=True)
    urllib.request.urlopen(urllib.request.Request(f"{switch}press", method="POST"), timeout=PATIENCE).close()


def main() -> None:
    """Play the scene once."""
    ecology = f"light-{secrets.token_hex(3)}"
    with ExitStack() as stack:

        def play(*command: str) -> Player:
            player = Player(*command)
            stack.callback(player.end)
            return player

        things = [
            play(str(HERE / "thing.py"), *who) for who in (("switch", "hall"), ("lamp", "desk"), ("lamp", "shelf"))
        ]
        urls = [thing.says("http://") for thing in things]
        bridge = play("-m", "selfconf", "bridge", "wot", *urls, "--rate", "5", "--ecology", ecology)
        bridge.says("is here", times=len(things))
        task = play("-m", "selfconf", "run", str(HERE / "light.ttl"), "--wait", "--ecology", ecology)
        task.says("running")
        lamps = things[1:]
        press(urls[0])
        until(lambda: any(lamp.shines() for lamp in lamps), "light")
        one, other = sorted(lamps, key=Player.shines, reverse=True)
        print("* the plug of the lamp that shines is pulled", flush=True)
        one.process.kill()
        other.says("is on")
        press(urls[0])
        other.says("is off")
        print("* that was all", flush=True)


if __name__ == "__main__":
    main()
