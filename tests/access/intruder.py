"""An insider that turns bad, as a program of its own: it tries all that is not its, over a real link.

    python -m tests.access.intruder KIND KEYS ECOLOGY ENDPOINT

It is told its kind, and has keys of that kind; it prints the attacks that were answered as a line of JSON.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from selfconf.access import PrincipalKind, open_keys
from selfconf.access.introduction import introduce
from selfconf.bus.port import Replies, Request
from selfconf.bus.zenoh import ZenohBus, client
from selfconf.protocol.codec import encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Cause, End, Fail, Page, Release, Stamp, Wake
from tests.cli.processes import component_of

SITE, CONFIGURATOR = "home", "main-1"
VICTIM, DORMANT = component_of("tracker"), component_of("odometry")
FLOOD = 3.0
"""Seconds of a flood."""
ANSWER = 1.0
LIFE = "0badc0de"
Attack = Callable[[ZenohBus, Keys], bool]


class Tried(NamedTuple):
    """What is tried: how Zenoh calls the message that is refused, under which key, and the attack."""

    message: str
    key: Callable[[Keys], str]
    attack: Attack


def put(key: Callable[[Keys], str], payload: bytes, attachment: bytes = b"", rate: int = 0) -> Tried:
    """Put something once, or so many times a second.

    Nothing is declared before: who is not told of any listener would not send what it has declared.
    """

    def attack(bus: ZenohBus, keys: Keys) -> bool:
        began, sent = bus.now(), 0
        while sent < max(1, (bus.now() - began) * rate) and bus.now() - began < FLOOD:
            bus._session.put(key(keys), payload, attachment=attachment)
            sent += 1
            time.sleep(1 / rate if rate else 0.0)  # the rate of the flood
        bus.poll(0.1)
        return False

    return Tried("Put", key, attack)


def ask(key: Callable[[Keys], str], payload: bytes) -> Tried:
    """Ask something; whether anybody answers."""

    def attack(bus: ZenohBus, keys: Keys) -> bool:
        heard: list[Replies] = []
        bus.ask(key(keys), payload, ANSWER, heard.append)
        bus.run(lambda: bool(heard))
        return bool(heard[0].samples or heard[0].errors)

    return Tried("Query", key, attack)


def live(key: Callable[[Keys], str]) -> Tried:
    """Live as somebody else, until the end of the program."""
    return Tried("Liveliness Token", key, lambda bus, keys: bus.announce(key(keys)) is None)


def serve(key: Callable[[Keys], str], reply: Callable[[Keys], str], payload: bytes, attachment: bytes = b"") -> Tried:
    """Answer for somebody else, until the end of the program."""

    def attack(bus: ZenohBus, keys: Keys) -> bool:
        def answer(request: Request) -> None:
            request.reply(reply(keys), payload, attachment)
            request.finish()

        bus.serve(key(keys), answer)
        return False

    return Tried("Declare Queryable", key, attack)


CLAIM = (1 << 50, Keys("x").configurator_life(CONFIGURATOR, LIFE), "theft~1")
FAIL = encode(Fail(VICTIM, "", 1, Cause.FAIL, "not true"))
STOLEN = Page(0, 1, 10**9, VICTIM)
ATTACKS: dict[str, Tried] = {
    "signal for another": put(lambda k: k.output(VICTIM, "pose"), b"{}", encode(Stamp(VICTIM, LIFE, 1 << 60, 0.0))),
    "FAIL for another": put(lambda k: k.fail(DORMANT), FAIL),
    "flood of FAIL": put(lambda k: k.fail(VICTIM), FAIL, rate=1000),
    "flood of changed": put(lambda k: k.changed(SITE), b"", rate=500),
    "says that its hub is opened anew": put(lambda k: k.reopens(SITE), b""),
    "event of a configurator": put(lambda k: k.notices(CONFIGURATOR), b"{}"),
    "life for another": live(lambda k: k.life(VICTIM, LIFE)),
    "life of the site": live(lambda k: k.site_life(SITE, LIFE)),
    "life of a configurator": live(lambda k: k.configurator_life(CONFIGURATOR, LIFE)),
    "advertises another's IRI": serve(
        lambda k: k.advertisements(SITE),
        lambda k: k.advertisement(SITE, VICTIM),
        b"<urn:x> <urn:y> <urn:z> .",
        encode(STOLEN),
    ),
    "answers who shows a certificate": serve(lambda k: k.introduce(SITE), lambda k: k.introduce(SITE), b"{}"),
    "keeps a task as the site": serve(lambda k: k.kept_tasks(SITE), lambda k: k.kept_task(SITE, "theft~1"), b"{}"),
    "operation as another": ask(lambda k: k.operation(DORMANT, "open", VICTIM), b""),
    "answers for a dormant one": serve(lambda k: k.call(DORMANT), lambda k: k.call(DORMANT, "state"), b"yes"),
    "call": ask(lambda k: k.call(VICTIM, "release"), encode(Release(*CLAIM))),
    "set": ask(lambda k: k.call(VICTIM, "apply"), b"{}"),
    "wake": ask(lambda k: k.wake(SITE), encode(Wake(DORMANT))),
    "end": ask(lambda k: k.end(SITE), encode(End(VICTIM, ""))),
    "stop": ask(lambda k: k.configurator_call("*", "stop"), b""),
}
CALLS = {"call", "set", "wake", "end", "stop"}
MAY = {
    "comp": set[str](),
    "read": set[str](),
    "conf": CALLS,
    "site": CALLS | {"event of a configurator", "life of a configurator"},
}
"""What each kind may do, and so is no attack; a site relays the configurators that are connected to it."""


def attempts(kind: str) -> list[str]:
    """What is not for a kind."""
    return [attack for attack in ATTACKS if attack not in MAY[kind]]


def main() -> None:
    """Try everything; the floods first, as they are over then."""
    kind, folder, ecology, endpoint = sys.argv[1:]
    credentials = open_keys(Path(folder)).credentials((PrincipalKind(kind),))
    bus = client([endpoint], credentials=credentials)
    introduce(bus, ecology, credentials)
    answered = [attack for attack in attempts(kind) if ATTACKS[attack].attack(bus, Keys(ecology))]
    print(json.dumps(answered), flush=True)
    sys.stdin.read()  # it lives as others for as long as the test looks
    bus.close()


if __name__ == "__main__":
    main()
