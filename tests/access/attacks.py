"""What an attacker tries, each with how to see whether it has come to anything."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass

from selfconf.bus.port import Replies, Request, Sample, Urgency
from selfconf.bus.zenoh import ZenohBus
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import (
    Cause,
    End,
    Fail,
    Free,
    Moved,
    Notice,
    Page,
    Release,
    Reserve,
    Stamp,
    StateOf,
    Status,
    TaskRecord,
    Wake,
)

ROUND_TRIP = 5.0
"""Seconds that a question may take on a busy machine."""


@dataclass
class Stage:
    """An attacker and an observer at the hub of one site, and those whom the attacker is after."""

    keys: Keys
    site: str
    victim: IRI
    dormant: IRI
    itself: IRI
    """The component that the attacker is, or would be."""
    attacker: ZenohBus
    observer: ZenohBus

    def asked(self, bus: ZenohBus, key: str, payload: bytes = b"", seconds: float = ROUND_TRIP) -> Replies:
        """Ask, and wait for all answers."""
        replies: list[Replies] = []
        bus.ask(key, payload, seconds, replies.append)
        deadline = bus.now() + 2 * seconds
        while not replies and bus.now() < deadline:
            self.attacker.poll(0.002)
            self.observer.poll(0.002)
        return replies[0] if replies else Replies()

    def settle(self) -> None:
        """What the attacker has sent is through the hub, and what the observer was to hear has arrived."""
        for bus in (self.attacker, self.observer, self.attacker, self.observer):
            self.asked(bus, self.keys.introduce(self.site))

    def put(self, key: str, payload: bytes, attachment: bytes = b"") -> bool:
        """Whether the observer hears what the attacker puts."""
        heard: list[Sample] = []
        undo = self.observer.subscribe(key, heard.append, Urgency.EVENT)
        publisher = self.attacker.publisher(key, Urgency.EVENT)
        self.settle()
        publisher.put(payload, attachment)
        self.settle()
        undo()
        publisher.undeclare()
        return any(sample.payload == payload for sample in heard)

    def live(self, key: str) -> bool:
        """Whether the observer sees the attacker live under a key."""
        lives: list[str] = []
        undo = self.observer.watch(key, lambda life, here: lives.append(life) if here else None)
        leave = self.attacker.announce(key)
        self.settle()
        undo()
        leave()
        return key in lives

    def serve(self, key: str, asked: str, reply: str, payload: bytes, attachment: bytes = b"") -> bool:
        """Whether the observer, who asks, gets an answer of the attacker."""

        def answer(request: Request) -> None:
            request.reply(reply, payload, attachment)
            request.finish()

        undo = self.attacker.serve(key, answer)
        self.settle()
        replies: list[Replies] = []
        self.observer.ask(asked, b"", 1.0, replies.append)
        deadline = self.observer.now() + 2.0
        while not replies and self.observer.now() < deadline:
            self.attacker.poll(0.01)
            self.observer.poll(0.01)
        undo()
        return bool(replies) and any(sample.payload == payload for sample in replies[0].samples)

    def ask(self, key: str, payload: bytes) -> bool:
        """Whether anybody answers what the attacker asks."""
        replies = self.asked(self.attacker, key, payload, seconds=1.0)
        return bool(replies.samples or replies.errors)

    def listen(self, key: str) -> bool:
        """Whether the attacker hears what is put by somebody who may."""
        heard: list[Sample] = []
        undo = self.attacker.subscribe(key, heard.append, Urgency.EVENT)
        publisher = self.observer.publisher(key, Urgency.EVENT)
        self.settle()
        publisher.put(b"{}")
        self.settle()
        undo()
        publisher.undeclare()
        return bool(heard)

    def overhear(self, key: str, asked: str) -> bool:
        """Whether the attacker gets an answer of somebody who may give one."""

        def answer(request: Request) -> None:
            request.reply(asked, b"{}")
            request.finish()

        undo = self.observer.serve(key, answer)
        self.settle()
        replies: list[Replies] = []
        self.attacker.ask(asked, b"", 1.0, replies.append)
        deadline = self.observer.now() + 2.0
        while not replies and self.observer.now() < deadline:
            self.observer.poll(0.01)
            self.attacker.poll(0.01)
        undo()
        return bool(replies and replies[0].samples)

    def live_ones(self, key: str) -> bool:
        """Whether the attacker learns who lives."""
        heard: list[tuple[str, ...]] = []
        self.attacker.roll_call(key, ROUND_TRIP, heard.append)
        self.attacker.run(lambda: bool(heard))
        return bool(heard[0])


_LIFE = "0badc0de"


def _claim(stage: Stage) -> tuple[int, str, str]:
    return 1 << 50, stage.keys.configurator_life("main-1", _LIFE), "theft~1"


def _status(stage: Stage) -> bytes:
    return encode(Status("honest", "running", IRI("urn:template"), 7, 0.0))


def _record() -> bytes:
    return encode(TaskRecord("theft~1", 1_000_000, ended=True, wanted="urn:t"))


ATTACKS: dict[str, Callable[[Stage], bool]] = {
    "signal for another": lambda s: s.put(
        s.keys.output(s.victim, "pose"), b"{}", encode(Stamp(s.victim, _LIFE, 1 << 60, 0.0))
    ),
    "FAIL for another": lambda s: s.put(s.keys.fail(s.victim), encode(Fail(s.victim, "", 1, Cause.FAIL, "not true"))),
    "free for another": lambda s: s.put(s.keys.free(s.victim), encode(Free(s.victim, _LIFE))),
    "life for another": lambda s: s.live(s.keys.life(s.victim, _LIFE)),
    "life of a dormant one": lambda s: s.live(s.keys.life(s.dormant, _LIFE)),
    "life of the site": lambda s: s.live(s.keys.site_life(s.site, _LIFE)),
    "life of a new site": lambda s: s.live(s.keys.site_life("zz", _LIFE)),
    "life of a configurator": lambda s: s.live(s.keys.configurator_life("honest", _LIFE)),
    "answers for a dormant one": lambda s: s.serve(
        s.keys.call(s.dormant), s.keys.call(s.dormant, "state"), s.keys.call(s.dormant, "state"), b"yes"
    ),
    "last signal of another": lambda s: s.serve(
        s.keys.outputs(s.dormant), s.keys.output(s.dormant, "pose"), s.keys.output(s.dormant, "pose"), b"{}"
    ),
    "answers an operation of a dormant one": lambda s: s.serve(
        s.keys.operation(s.dormant, "open", s.victim),
        s.keys.operation(s.dormant, "open", s.victim),
        s.keys.operation(s.dormant, "open", s.victim),
        b"{}",
    ),
    "moves the outputs of another": lambda s: s.put(s.keys.moved(s.victim), encode(Moved(s.victim, _LIFE))),
    "asks for an operation as itself": lambda s: s.overhear(
        s.keys.operations(s.dormant), s.keys.operation(s.dormant, "open", s.itself)
    ),
    "asks for an operation as another": lambda s: s.overhear(
        s.keys.operations(s.dormant), s.keys.operation(s.dormant, "open", s.victim)
    ),
    "advertises for the site": lambda s: s.serve(
        s.keys.advertisements(s.site),
        s.keys.advertisements("*"),
        s.keys.advertisement(s.site, s.victim),
        b"<urn:x> <urn:y> <urn:z> .",
        encode(Page(0, 1, 10**9, s.victim)),
    ),
    "advertises as a new site": lambda s: s.serve(
        s.keys.advertisements("zz"),
        s.keys.advertisements("*"),
        s.keys.advertisement("zz", s.victim),
        b"<urn:x> <urn:y> <urn:z> .",
        encode(Page(0, 1, 10**9, s.victim)),
    ),
    "says the site has changed": lambda s: s.put(s.keys.changed(s.site), encode(Page(0, 1, 10**9))),
    "says that the hub is opened anew": lambda s: s.put(s.keys.reopens(s.site), b""),
    "answers who shows a certificate": lambda s: s.serve(
        s.keys.introduce(s.site), s.keys.introduce("*"), s.keys.introduce(s.site), b"{}"
    ),
    "keeps a task as the site": lambda s: s.serve(
        s.keys.kept_tasks(s.site), s.keys.kept_tasks(), s.keys.kept_task(s.site, "theft~1"), b"{}"
    ),
    "forges a status": lambda s: s.serve(
        s.keys.configurator_call("honest"),
        s.keys.configurator_call("*", "status"),
        s.keys.configurator_call("honest", "status"),
        _status(s),
    ),
    "forges a configuration": lambda s: s.serve(
        s.keys.configuration("honest"), s.keys.configuration("*"), s.keys.configuration("honest"), b"# forged"
    ),
    "forges an event": lambda s: s.put(
        s.keys.notices("honest"), encode(Notice("honest", 1, "tidy~1", {"act": "running"}))
    ),
    "forges a task": lambda s: s.put(s.keys.task("theft~1"), _record()),
    "hears what configurators do": lambda s: s.listen(s.keys.notices("honest")),
    "reads a configuration": lambda s: s.overhear(s.keys.configuration("honest"), s.keys.configuration("honest")),
    "asks for a task": lambda s: s.overhear(
        s.keys.configurator_call("honest"), s.keys.configurator_call("honest", "task")
    ),
    "stops a task": lambda s: s.overhear(
        s.keys.configurator_call("honest"), s.keys.configurator_call("honest", "stop")
    ),
    "hears signals": lambda s: s.listen(s.keys.output(s.dormant, "pose")),
    "hears FAIL": lambda s: s.listen(s.keys.fail(s.dormant)),
    "hears what becomes of tasks": lambda s: s.listen(s.keys.task("tidy~1")),
    "asks for the last signal": lambda s: s.overhear(s.keys.outputs(s.dormant), s.keys.output(s.dormant, "pose")),
    "asks a component's state": lambda s: s.ask(s.keys.call(s.victim, "state"), encode(StateOf(""))),
    "reserves a component": lambda s: s.ask(s.keys.call(s.victim, "reserve"), encode(Reserve(*_claim(s)))),
    "releases a component": lambda s: s.ask(s.keys.call(s.victim, "release"), encode(Release(*_claim(s)))),
    "wakes a component": lambda s: s.ask(s.keys.wake(s.site), encode(Wake(s.victim))),
    "ends a component": lambda s: s.ask(s.keys.end(s.site), encode(End(s.victim, _LIFE))),
    "hands a task to the site": lambda s: s.ask(s.keys.keep(s.site), _record()),
    "reads what components have printed": lambda s: s.ask(s.keys.log(s.site), b""),
    "reads who may do what": lambda s: s.ask(s.keys.access(s.site), b""),
    "reads advertisements": lambda s: s.ask(s.keys.advertisements(s.site), b""),
    "reads which components live": lambda s: s.live_ones(s.keys.any_life()),
}


def refused(body: str) -> list[tuple[str, str, str]]:
    """Who has tried what under which key, as `access --format json` prints it."""
    return [
        (one["principal"], one["attempt"], one["key"]) for site in json.loads(body)["sites"] for one in site["refused"]
    ]
