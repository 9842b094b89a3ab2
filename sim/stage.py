"""The ecology of one demo: the programs of selfconf that are started in it, and what all its processes say."""

from __future__ import annotations

import secrets
import socket
import time
from collections.abc import Callable
from pathlib import Path

import selfconf
from sim.account import Account
from sim.crew import Crew, Line

STARTING = 60.0
"""Seconds that a process may take to be there."""
LINGERING = 86_400.0
"""Seconds that the page stays at most."""
LOOKING = 0.05
"""Seconds from one look whether something holds to the next while no process says anything."""
PAGE, USUAL_PORT = "page", 8000


class DemoError(Exception):
    """The demo cannot go on; the text says why."""


class Stage:
    """An ecology of its own for one demo: its name, its processes, and the account of what they do."""

    def __init__(self, crew: Crew, say: Callable[[str], None]) -> None:
        self.crew, self._say = crew, say
        self.ecology = f"demo-{secrets.token_hex(3)}"
        self.account = Account(time.time())
        self.endpoint = ""
        self._newest: dict[str, str | None] = {}
        """What each process has said last; None once it has ended."""

    def site(self, name: str, *advertisements: Path) -> None:
        """Start a site, connected to the one before, and wait until it listens."""
        connect = ["--connect", self.endpoint] if self.endpoint else []
        self._start(name, "site", *map(str, advertisements), "--name", name, *connect)

        def listens() -> bool:
            found = [site.endpoint for site in selfconf.sites(self.ecology) if site.site == name]
            self.endpoint = next(iter(found), self.endpoint)
            return bool(found)

        self.until(listens, STARTING, (name,), "it listened")

    def configurator(self, template: Path, policy: str, *bound: str) -> None:
        """Start the configurator with a task."""
        binds = [part for pair in bound for part in ("--bind", pair)]
        given = [str(template), *binds, "--connect", self.endpoint, "--format", "json", "--policy", policy]
        self._start("configurator", "run", *given)

    def serve(self) -> None:
        """Show the ecology in a browser, and wait until the page is there."""
        # Another program may take the usual port between the look at it and the server's own.
        if not (self._served(_free(USUAL_PORT)) or self._served(0)):
            raise DemoError("the page cannot be served")

    def _served(self, port: int) -> bool:
        """Start the server of the page and wait until it is there; False if it ends before."""
        self._start(PAGE, "serve", "--connect", self.endpoint, "--port", str(port))

        def there_or_ended() -> bool:
            said = self._newest[PAGE]
            return said is None or "http://" in said

        self.until(there_or_ended, STARTING, (), "the page was there")
        return self._newest[PAGE] is not None

    def _start(self, name: str, *arguments: str) -> None:
        """Start a program of selfconf in the ecology."""
        self._newest[name] = ""
        self.crew.start(name, "-m", "selfconf", *arguments, "--ecology", self.ecology)

    def linger(self) -> None:
        """Leave the page there until Ctrl-C."""
        self._say("the page shows what has happened; Ctrl-C ends it")
        try:
            self.listen(LINGERING)
        except KeyboardInterrupt:
            return

    def listen(self, seconds: float) -> None:
        """Take in and tell what is written within some seconds."""
        for line in self.crew.lines(seconds):
            self._hear(line)

    def until(self, condition: Callable[[], bool], seconds: float, vital: tuple[str, ...], what: str) -> None:
        """Listen until something holds. Raises DemoError once a vital process has ended before, or time is up."""
        deadline = time.monotonic() + seconds
        while not condition():
            ended = [process for process in vital if self._newest.get(process, "") is None]
            if ended:
                raise DemoError(f"{ended[0]} has ended before {what}")
            if time.monotonic() > deadline:
                raise DemoError(f"{seconds:.0f} s have passed before {what}")
            line = next(self.crew.lines(LOOKING), None)
            if line is not None:
                self._hear(line)

    def _hear(self, line: Line) -> None:
        """Take a line in and tell it."""
        self._newest[line.process] = line.text
        sentence = self.account.take(line)
        if sentence is not None:
            self._say(sentence)


def _free(port: int) -> int:
    """A port of this machine if nothing listens there, else 0 for any that is free."""
    try:
        socket.create_server(("127.0.0.1", port)).close()
    except OSError:
        return 0
    return port
