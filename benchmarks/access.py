"""What keys cost: failover, discovery and signals with them and without, taking turns in one run.

    python -m benchmarks.access [--rounds 3] [--smoke]

All processes are real, and each round has a new ecology of either kind.

    failover    FAIL to the first message of the new source, without the search (`benchmarks.failover`)
    discovery   `living.discover()` in a joined ecology of 1,000 components of one site
    signal      put to callback over the hub, both ends in this process, as raw bytes on a declared key
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
from selfconf.access import KeysFolder, PrincipalKind
from selfconf.api.local_site import SiteProcess
from selfconf.bus.port import Urgency
from selfconf.bus.zenoh_bus import ZenohBus, client
from selfconf.model.term import IRI
from selfconf.protocol.keys import Keys

SIZES = (100, 300_000)
"""Bytes of a signal."""
PATIENCE = 20.0
Times = dict[tuple[str, bool], list[float]]
"""Seconds by what was measured, and whether with keys."""


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description="what keys cost, side by side")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--smoke", action="store_true", help="one short round, to see that it works")
    given = parser.parse_args()
    trials, components, signals = (2, 20, 20) if given.smoke else (20, 1000, 300)
    times: Times = {}
    for number in range(1 if given.smoke else given.rounds):
        for keyed in (False, True) if number % 2 == 0 else (True, False):
            with tempfile.TemporaryDirectory() as folder, ecology_of(Path(folder), keyed) as keys:
                found = failover.measure(trials, keys=keys)
                times.setdefault(("failover", keyed), []).extend(found["undecided"])
                observe(Path(folder), keyed, keys, components, signals, times)
    print(report(times))


@contextmanager
def ecology_of(folder: Path, keyed: bool) -> Iterator[Path | None]:
    """A runtime folder of its own, and the folder of an authority if there are to be keys."""
    os.environ["SELFCONF_RUNTIME_DIR"] = str(folder / "runtime")
    os.environ.pop("SELFCONF_KEYS", None)
    yield KeysFolder.init(folder / "keys").path if keyed else None


def observe(folder: Path, keyed: bool, keys: Path | None, components: int, signals: int, times: Times) -> None:
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
                times.setdefault(("discovery", keyed), []).append(time.perf_counter() - began)
                living._view.known.clear()  # as if it were the first
        shown = None if keys is None else KeysFolder(keys).credentials((PrincipalKind.SITE,), site.name)
        for size in SIZES:
            ends = [client(list(site.endpoints), credentials=shown) for _ in range(2)]
            what = f"signal of {size:,} bytes", keyed
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


def report(times: Times) -> str:
    """The table: medians, and what keys cost as a ratio of them."""
    rows = []
    for what in dict.fromkeys(name for name, _ in times):
        plain, keyed = (quantile(times[what, with_keys], 0.5) for with_keys in (False, True))
        rows.append([what, f"{plain * 1000:.2f}", f"{keyed * 1000:.2f}", f"{keyed / plain:.2f}"])
    head = ["", "without keys, median ms", "with keys, median ms", "with / without"]
    return f"{table(head, rows)}\n\n{described('eclipse-zenoh', 'cryptography')}"


if __name__ == "__main__":
    main()
