"""Components in real time, each host with a thread for its bus and one for the code, as a program has them."""

from __future__ import annotations

import secrets
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from selfconf.bus.port import Replies, Sample
from selfconf.bus.zenoh import ZenohBus, client
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Apply, CallAnswer, Cause, Fail, Release, Reserve
from selfconf.sdk import Component, Host

PREFIXES = """@prefix sc: <https://w3id.org/selfconf#> .
@prefix unit: <http://qudt.org/vocab/unit/> .
@prefix : <urn:c:> .
"""
PATIENCE = 10.0
"""Seconds that anything may take on a busy machine."""
Kind = TypeVar("Kind", bound=Component)


class LivingStage:
    """Hosts on a router, and a configurator that can call their components."""

    def __init__(self, endpoint: str, folder: Path) -> None:
        self.endpoint, self.folder = endpoint, folder
        self.ecology = f"test-{secrets.token_hex(4)}"
        self.keys = Keys(self.ecology)
        self.supervisor = self.keys.configurator_life("us", "1")
        self.caller = self.node()
        self.caller.run_aside()
        self.leave = self.caller.announce(self.supervisor)
        self.fails: list[tuple[float, Fail]] = []
        """What configurators heed, with the time: that a component has obeyed a release is no FAIL."""
        self.caller.subscribe(self.keys.any_fail(), self._heard_fail)
        self._lives: set[str] = set()
        self.caller.watch(self.keys.any_life(), lambda key, here: self._lives.add(key) if here else None)
        self.hangs: list[str] = []
        self._hosts: list[Callable[[], None]] = []
        self.release_code = threading.Event()
        """What code that hangs waits for; set at the end of the test."""

    def _heard_fail(self, sample: Sample) -> None:
        fail = decode(sample.payload, Fail)
        if fail.epoch or fail.cause is not Cause.LET_GO:
            self.fails.append((time.monotonic(), fail))

    def node(self) -> ZenohBus:
        """A client of the router."""
        return client([self.endpoint])

    def host(self) -> Host:
        """A host without components."""
        return Host(self.node(), self.ecology, self.hangs.append)

    def advertised(self, kind: type[Kind], turtle: str) -> type[Kind]:
        """A class of components with an advertisement."""
        path = self.folder / f"{secrets.token_hex(4)}.ttl"
        path.write_text(PREFIXES + turtle)
        kind.advertisement = path
        return kind

    def run(self, host: Host) -> None:
        """Run the code of a host on a thread of its own, until the end of the test."""
        ended = threading.Event()

        def work() -> None:
            host.run(ended.is_set)
            host.close()

        thread = threading.Thread(target=work)
        thread.start()

        def end() -> None:
            ended.set()
            host.code.wake_up()
            thread.join(PATIENCE)
            assert not thread.is_alive()

        self._hosts.append(end)

    def component(self, component: Kind) -> Kind:
        """A component that lives on a host of its own, and can be called."""
        known = len(self._lives)
        host = self.host()
        host.add(component)
        self.run(host)
        assert until(lambda: len(self._lives) > known)
        return component

    def call(self, component: str, call: str, message: Reserve | Apply | Release | None = None) -> list[CallAnswer]:
        """Make a call; the list receives the answer when it comes.

        A call may be quicker than the declaration of the component that it is for; then it finds none, and is repeated.
        """
        answers: list[CallAnswer] = []
        payload = b"" if message is None else encode(message)

        def ask() -> None:
            self.caller.ask(self.keys.call(IRI(component), call), payload, PATIENCE, answered)

        def answered(replies: Replies) -> None:
            answers.extend(decode(sample.payload, CallAnswer) for sample in replies.samples)
            if replies == Replies():
                self.caller.later(0.01, ask)

        ask()
        return answers

    def apply(self, component: str, **more: object) -> list[CallAnswer]:
        """Activate a component."""
        return self.call(component, "apply", Apply(1, self.supervisor, "task~1", **more))  # type: ignore[arg-type]  # by name

    def close(self) -> None:
        """End every host, and the configurator."""
        self.release_code.set()
        for end in self._hosts:
            end()
        self.caller.close()


def until(condition: Callable[[], object], seconds: float = PATIENCE) -> bool:
    """Let real time pass until something holds; whether it does."""
    deadline = time.monotonic() + seconds
    pause = threading.Event()
    while not condition():
        if time.monotonic() > deadline:
            return False
        pause.wait(0.005)
    return True
