"""What the history of a server lacks after kill -9 in the middle of writing, again and again over one folder.

    python -m benchmarks.history [--kills 100] [--seed 1]

All processes are real: a site, and `selfconf serve --history`, which is killed at a random moment and started again. A
configurator of this program deploys another configuration every 50 ms, and notes when the server has been told of it.
After each kill the folder is read:

    opens     the store can be opened, as the next server does too
    whole     each configuration in it has all that was told of it
    kept      nothing is missing that was there after the kill before, or was told a second or more before the kill,
              but perhaps what ran as the server began to follow: the next one may have been heard before it
    lacks     the time before the kill from which on something is missing, in ms; zero if nothing is
"""

from __future__ import annotations

import argparse
import os
import random
import secrets
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import NamedTuple

from benchmarks.machine import described, quantile
from selfconf.api.living.past import past_graphs
from selfconf.api.sites.local_site import SiteProcess
from selfconf.bus.port import Request, Urgency
from selfconf.bus.zenoh import client
from selfconf.model.configuration import Assignment, Configuration
from selfconf.model.template import Task
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Notice, Status
from selfconf.rdf.provenance import Deployment, deployment_triples
from selfconf.rdf.turtle import to_turtle

ADS = Path(__file__).resolve().parent.parent / "examples" / "clock"
PERIOD = 0.05
"""Seconds between two configurations."""
ALLOWED = 1.0
"""Seconds before a kill from which on something may be missing."""
PATIENCE = 60.0
"""Seconds that anything may take on a busy machine."""
ROLE, TEMPLATE = IRI("https://example.org/my-home#source"), IRI("https://example.org/my-home#tell-the-time")
NAME = "restless"


class Restless:
    """A configurator that deploys another configuration all the time, and knows which of them a server was told."""

    def __init__(self, ecology: str, endpoint: str, task: Task) -> None:
        self._bus, self._keys, self._task = client([endpoint]), Keys(ecology), task
        self.told: dict[str, float] = {}
        """When each configuration was told first, by its name, on the clock `time.monotonic`."""
        self.sizes: dict[str, int] = {}
        """How many triples each of them has."""
        self._epoch = 0
        self._next()
        self._deployed = self._bus.publisher(self._keys.configuration(NAME), Urgency.SIGNAL)
        self._notices = self._bus.publisher(self._keys.notices(NAME), Urgency.SIGNAL)
        self._bus.serve(self._keys.configuration(NAME), self._tell)
        self._bus.serve(self._keys.notices(NAME), self._latest)
        self._bus.serve(self._keys.configurator_call(NAME, "status"), self._status)
        self._bus.announce(self._keys.configurator_life(NAME, secrets.token_hex(4)))
        self._bus.later(PERIOD, self._deploy)
        self._bus.run_aside()

    def close(self) -> None:
        """Leave the ecology."""
        self._bus.close()

    def _next(self) -> None:
        self._epoch += 1
        self._name = IRI(f"urn:selfconf:configuration:{self._epoch}")
        playing = IRI(f"https://example.org/my-home#clock-{self._epoch}")
        configuration = Configuration(TEMPLATE, (Assignment(ROLE, (playing,)),))
        before = Configuration(TEMPLATE, (Assignment(ROLE, (IRI(f"{playing}-before"),)),))
        deployment = Deployment(
            self._epoch,
            time.time(),
            NAME,
            ("restless", 0),
            revises=(IRI(f"urn:selfconf:configuration:{self._epoch - 1}"), before),
            failures=((IRI(f"{playing}-before"), "fail", "out of view", time.time()),),
        )
        triples = list(deployment_triples(configuration, self._name, self._task, deployment))
        self.sizes[self._name], self._turtle = len(triples), to_turtle(triples)

    def _deploy(self) -> None:
        self._bus.later(PERIOD, self._deploy)
        self._next()
        self._deployed.put(self._turtle.encode())  # in order, while of two answers the newer one may come first
        self._notices.put(self._notice())

    def _notice(self) -> bytes:
        event = {"act": "running", "time": time.time(), "configuration": {"roles": []}, "message": "running"}
        return encode(Notice(NAME, self._epoch, "restless~1", event))

    def _latest(self, request: Request) -> None:
        request.reply(self._keys.notices(NAME), self._notice())
        request.finish()

    def _tell(self, request: Request) -> None:
        request.reply(self._keys.configuration(NAME), self._turtle.encode())
        request.finish()
        self.told.setdefault(self._name, time.monotonic())

    def _status(self, request: Request) -> None:
        status = Status(NAME, "running", TEMPLATE, self._epoch, time.time(), task="restless~1")
        request.reply(self._keys.configurator_call(NAME, "status"), encode(status))
        request.finish()


class Killed(NamedTuple):
    """What came of one kill."""

    kept: int
    """How many configurations the history holds."""
    lacks: float
    """Seconds before the kill from which on something is missing; zero if nothing is."""
    lost: tuple[str, ...]
    """The configurations that are missing though they should not be."""
    torn: tuple[str, ...]
    """The configurations of which a part is missing."""


def kill(restless: Restless, serve: Callable[[], subprocess.Popen[str]], folder: Path, seconds: float) -> Killed:
    """Let a server write for some seconds, kill it, and look at what it has kept."""
    before = set(past_graphs(folder)) if (folder / "CURRENT").exists() else set()
    server = serve()
    try:
        assert server.stdout is not None
        said = server.stdout.readline()
        if "http://" not in said:
            raise RuntimeError(f"the server does not serve: {said}{server.communicate()[1]}")
        known, deadline = len(restless.told), time.monotonic() + PATIENCE
        while len(restless.told) == known:
            if time.monotonic() > deadline:
                raise RuntimeError("the server does not follow the configurator, and so writes nothing")
            time.sleep(0.01)  # until it follows the configurator
        told_before = set(restless.told)  # also what ran just now: the next one may have overtaken the answer
        time.sleep(seconds)  # the moment of the kill is random
    finally:
        moment = time.monotonic()
        server.kill()
        server.communicate()
    graphs = past_graphs(folder)
    missing = {name: at for name, at in restless.told.items() if name not in graphs and name not in told_before}
    missing = {name: at for name, at in missing.items() if at < moment}
    lost = [name for name, at in missing.items() if at < moment - ALLOWED] + sorted(before - set(graphs))
    sizes = {name: text.count(b" .\n") for name, text in graphs.items()}
    torn = [
        name for name, size in sizes.items() if not 0 <= size - restless.sizes[name] <= 1
    ]  # with or without its end
    return Killed(len(graphs), moment - min(missing.values(), default=moment), tuple(lost), tuple(torn))


def kills(number: int, seed: int) -> list[Killed]:
    """Kill a server that many times; the moments are those of the seed."""
    chance = random.Random(seed)
    with tempfile.TemporaryDirectory(prefix="selfconf-kills-") as scratch:
        os.environ["SELFCONF_RUNTIME_DIR"] = f"{scratch}/runtime"
        from selfconf.api.task import template

        task = template(ADS / "tell-the-time.ttl").document.task
        with SiteProcess([ADS], f"history-{secrets.token_hex(3)}") as site:
            restless, folder = Restless(site.ecology, site.endpoint, task), Path(scratch) / "history"
            words = ["serve", "--ecology", site.ecology, "--port", "0", "--history", str(folder)]
            serve = partial(
                subprocess.Popen,
                [sys.executable, "-m", "selfconf", *words],
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
            )
            try:
                found = [kill(restless, serve, folder, chance.uniform(0.0, 1.5)) for _ in range(number)]
            finally:
                restless.close()
    return found


def report(found: list[Killed]) -> str:
    """The outcome in words."""
    lacks = [1000 * one.lacks for one in found]
    lost, torn = sum(len(one.lost) for one in found), sum(len(one.torn) for one in found)
    return "\n".join(
        (
            f"kill -9 while it writes: {len(found)} times; {described()}",
            f"opens: {len(found)} of {len(found)}, {found[-1].kept} configurations in the end",
            f"whole: {torn} configurations are torn; kept: {lost} are missing that should be there",
            f"lacks the last {quantile(lacks, 0.5):.0f} ms in the median, {max(lacks):.0f} ms at most",
        )
    )


def main() -> int:
    """0 if each history opened, whole, and lacks at most the last second."""
    options = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    options.add_argument("--kills", type=int, default=100, help="default: %(default)s")
    options.add_argument("--seed", type=int, default=1, help="default: %(default)s")
    given = options.parse_args()
    found = kills(given.kills, given.seed)
    print(report(found))
    return 1 if any(one.lost or one.torn for one in found) else 0


if __name__ == "__main__":
    raise SystemExit(main())
