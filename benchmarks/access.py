"""What keys cost: failover, discovery and signals with them and without, taking turns in one run.

    python -m benchmarks.access [--rounds 3] [--smoke]

It takes a minute and a half a round.

All processes are real, and each round has a new ecology of either kind.

    failover    FAIL to the first message of the new source, without the search (`benchmarks.failover`)
    discovery   `living.discover()` in a joined ecology of 1,000 components of one site
    signal      put to callback over the hub, both ends in this process, as raw bytes on a declared key; one after the
                other, and many a second

With keys a site reads in Zenoh's log what its hub refuses, and Zenoh writes a line for each message that passes. What
that costs is what differs between `with keys` and `with keys, log off` (RUST_LOG=off).
"""

from __future__ import annotations

import argparse
import os
import secrets
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import selfconf as sc
from benchmarks import failover
from benchmarks.machine import described, quantile, table
from benchmarks.quiet import until_quiet
from selfconf.access import Authority, PrincipalKind, open_keys
from selfconf.api.sites.local_site import SiteProcess
from selfconf.bus.port import Urgency
from selfconf.bus.zenoh import ZenohBus, client
from selfconf.model.term import IRI
from selfconf.protocol.keys import Keys

SIZES = (100, 300_000)
"""Bytes of a signal."""
PATIENCE = 20.0
RATES = (1_000, 10_000)
"""Signals of 100 bytes a second."""
PLAIN, KEYED, UNREAD = "without keys", "with keys", "with keys, log off"
Times = dict[tuple[str, str], list[float]]
"""Seconds by what was measured, and in which of the three ways."""


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description="what keys cost, side by side")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--smoke", action="store_true", help="one short round, to see that it works")
    given = parser.parse_args()
    trials, components, signals, seconds = (1, 20, 20, 0.1) if given.smoke else (20, 1000, 300, 5.0)
    times: Times = {}
    ways = (PLAIN, KEYED, UNREAD)
    for number in range(1 if given.smoke else given.rounds):
        for way in ways if number % 2 == 0 else ways[::-1]:
            with tempfile.TemporaryDirectory() as folder, ecology_of(Path(folder), way) as keys:
                if way != UNREAD:  # for these, signals are few
                    found = failover.measure(trials, keys=keys)
                    times.setdefault(("failover", way), []).extend(found["undecided"])
                    observe(Path(folder), way, keys, components, signals, times)
                flood(Path(folder), way, keys, seconds, times)
    print(report(times))


@contextmanager
def ecology_of(folder: Path, way: str) -> Iterator[Path | None]:
    """A runtime folder of its own, and the folder of an authority if there are to be keys."""
    os.environ["SELFCONF_RUNTIME_DIR"] = str(folder / "runtime")
    for name in ("SELFCONF_KEYS", "RUST_LOG"):
        os.environ.pop(name, None)
    if way == UNREAD:
        os.environ["RUST_LOG"] = "off"
    yield None if way == PLAIN else Authority.init(folder / "keys").path


def observe(folder: Path, way: str, keys: Path | None, components: int, signals: int, times: Times) -> None:
    """Measure discovery and signals in an ecology of one site."""
    (folder / "ads").mkdir()
    (folder / "ads/all.ttl").write_text(
        "@prefix sc: <https://w3id.org/selfconf#> .\n@prefix rob: <https://w3id.org/selfconf/robotics#> .\n"
        + "".join(
            f'<urn:bench:c{n}> a sc:Component, rob:Encoder ; sc:hasOutput [ sc:name "o" ; sc:signalType rob:Pose ] .\n'
            for n in range(components)
        )
    )
    name = f"access-{secrets.token_hex(3)}"
    with SiteProcess([folder / "ads"], name, keys=keys) as site:
        with sc.join(name, connect=site.endpoints, keys=keys) as living:
            for _ in range(5):
                began = time.perf_counter()
                if len(living.discover().found) != components:
                    raise SystemExit("the discovery is not complete")
                times.setdefault(("discovery", way), []).append(time.perf_counter() - began)
                living._view.known.clear()  # as if it were the first
        shown = None if keys is None else open_keys(keys).credentials((PrincipalKind.SITE,), site.name)
        for size in SIZES:
            ends = [client(list(site.endpoints), credentials=shown) for _ in range(2)]
            what = f"signal of {size:,} bytes", way
            times.setdefault(what, []).extend(latencies(ends[0], ends[1], name, size, signals))
            for end in ends:
                end.close()


def latencies(source: ZenohBus, sink: ZenohBus, ecology: str, size: int, number: int) -> list[float]:
    """Seconds from put to callback, one signal after the other."""
    heard = threading.Event()
    key = Keys(ecology).output(IRI("urn:bench:c0"), "o")
    sink.subscribe(key, lambda _: heard.set(), direct=True)
    matched = threading.Event()
    source.run_aside()
    publisher = source.publisher(key, Urgency.EVENT, lambda there: matched.set() if there else None)
    if not matched.wait(PATIENCE):
        raise SystemExit("the two ends do not see each other")
    found, payload = [], bytes(size)
    for _ in range(number):
        heard.clear()
        began = time.perf_counter()
        publisher.put(payload)
        if not heard.wait(PATIENCE):
            raise SystemExit("a signal is lost")
        found.append(time.perf_counter() - began)
    return found


def flood(folder: Path, way: str, keys: Path | None, seconds: float, times: Times) -> None:
    """Measure signals at their rates, and how much of a processor the hub takes for each, in an ecology of one site."""
    name = f"access-{secrets.token_hex(3)}"
    (folder / "none").mkdir()
    with SiteProcess([folder / "none"], name, keys=keys) as site:
        shown = None if keys is None else open_keys(keys).credentials((PrincipalKind.SITE,), site.name)
        (hub,) = (one.process for one in sc.sites(name))
        for rate in RATES:
            ends = [client(list(site.endpoints), credentials=shown) for _ in range(2)]
            found, taken = paced(ends[0], ends[1], name, rate, seconds, hub)
            what = f"100 bytes at {rate:,} a second"
            times.setdefault((what, way), []).extend(found)
            times.setdefault((f"{what}: the hub's processor, for each", way), []).append(taken / len(found))
            for end in ends:
                end.close()


def processor_seconds(process: int) -> float:
    """Seconds that a process has had a processor for, all its threads together, to a microsecond."""
    return time.clock_gettime((~process << 3) | 2)  # as clock_getcpuclockid(3) makes it; the file in /proc counts ticks


def paced(
    source: ZenohBus, sink: ZenohBus, ecology: str, rate: int, seconds: float, hub: int
) -> tuple[list[float], float]:
    """Seconds from put to callback of signals at a rate, and those that the process of the hub had a processor for.

    Some signals may be dropped, as signals are. What it takes to connect the two ends is not in it.
    """
    key, found, matched = Keys(ecology).output(IRI("urn:bench:c1"), "o"), list[float](), threading.Event()
    sink.subscribe(key, lambda sample: found.append(time.perf_counter() - float(sample.payload)), direct=True)
    source.run_aside()
    publisher = source.publisher(key, Urgency.SIGNAL, lambda there: matched.set() if there else None)
    if not matched.wait(PATIENCE):
        raise SystemExit("the two ends do not see each other")
    before, began, sent = processor_seconds(hub), time.perf_counter(), 0
    while (now := time.perf_counter()) - began < seconds:
        while sent < (now - began) * rate:
            publisher.put(f"{time.perf_counter():100.9f}".encode())
            sent += 1
        time.sleep(0.5 / rate)  # the rate of the signals
    taken = processor_seconds(hub) - before
    until_quiet(lambda: len(found))
    if not found:
        raise SystemExit("no signal has arrived")
    return found, taken


def report(times: Times) -> str:
    """The table: medians, and what keys cost as a ratio of them."""
    rows = []
    for what in dict.fromkeys(name for name, _ in times):
        ways = [way for way in (PLAIN, KEYED, UNREAD) if (what, way) in times]
        medians = {way: quantile(times[what, way], 0.5) for way in ways}
        shown = [f"{medians[way] * 1000:.3f}" if way in medians else "" for way in (PLAIN, KEYED, UNREAD)]
        ratios = [f"{medians[KEYED] / max(medians[way], 1e-9):.2f}" if way in ways else "" for way in (PLAIN, UNREAD)]
        rows.append([what, *shown, *ratios])
    head = ["median ms", PLAIN, KEYED, UNREAD, "keys / none", "log / no log"]
    return f"{table(head, rows)}\n\n{described('eclipse-zenoh', 'cryptography')}"


if __name__ == "__main__":
    main()
