"""Measure living ecologies of several sizes, beside a bare Zenoh program that receives the same messages.

    python -m benchmarks.live [--smoke] [--write]

All processes are real, on one machine: sites, a crowd that lives, two sources, a sink. For each size

    sites up       from the first process to the last site that is reached
    discover       the first time, and again when nothing has changed
    bare           the same roll-calls and the same replies in a bare Zenoh program, which reads none of them
    running        from the beginning of a task to `running`, in an ecology that was never asked
    failover       kill -9 of the source in use to the first signal of the other one at the sink
    site MB        memory of a site, the mean;    idle   processor time of all sites, per cent of one core
"""

from __future__ import annotations

import argparse
import math
import os
import secrets
import select
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import zenoh
from zenoh.handlers import Callback

import selfconf as sc
from benchmarks.live import world
from benchmarks.machine import described, table
from selfconf import rendezvous, this_machine
from selfconf.protocol.keys import Keys
from selfconf.sdk import Host

PAGE = Path(__file__).resolve().parents[2] / "docs" / "benchmarks" / "live.md"
SIZES = ((100, 1), (1_000, 1), (1_000, 5), (1_000, 20), (10_000, 1), (10_000, 5), (10_000, 20))
SMOKE = ((20, 2),)
BY_HAND = "## Many sites\n"
"""From this heading on the page is written by hand, and is kept."""
PATIENCE = 60.0
IDLE = 3.0


class Measured(NamedTuple):
    """What was measured of one ecology, in seconds if nothing else is said."""

    components: int
    sites: int
    up: float
    discover: float
    again: float
    bare: float
    running: float
    failover: float
    megabytes: float
    idle: float


@contextmanager
def program(*command: str) -> Iterator[subprocess.Popen[str]]:
    """A Python program, ended at the end."""
    process = subprocess.Popen(
        [sys.executable, "-m", *command],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    try:
        yield process
    finally:
        process.kill()
        process.wait()


def line(process: subprocess.Popen[str]) -> str:
    """The next line that a program writes."""
    assert process.stdout is not None
    if not select.select([process.stdout], [], [], PATIENCE)[0]:
        raise SystemExit("the benchmark stalled")
    return process.stdout.readline().strip()


def act_until_stdin_ends(host: Host) -> None:
    """Say that the components of a host are ready, and run their code until nobody writes to stdin any more."""
    over = threading.Event()

    def end_with_stdin() -> None:
        sys.stdin.read()
        over.set()
        host.code.wake_up()

    threading.Thread(target=end_with_stdin, daemon=True).start()
    print("ready", flush=True)
    host.run(over.is_set)
    host.close()


def until(seconds: float, condition: Any) -> None:
    """Wait for a condition."""
    deadline = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > deadline:
            raise SystemExit("the benchmark stalled")
        threading.Event().wait(0.01)


def measure(components: int, sites: int) -> Measured:
    """One ecology, from nothing."""
    ecology = f"live-{secrets.token_hex(3)}"
    with tempfile.TemporaryDirectory() as name, ExitStack() as stack:
        folder = Path(name)
        os.environ.update(
            {
                "SELFCONF_RUNTIME_DIR": str(folder / "runtime"),
                rendezvous.ECOLOGY_VARIABLE: ecology,
                world.FOLDER_VARIABLE: name,
            }
        )
        began = time.monotonic()
        served = []
        for number, path in enumerate(world.write(folder, components, sites)):
            served.append(stack.enter_context(program("selfconf", "site", str(path), "--name", f"s{number}")))
        until(PATIENCE, lambda: len(this_machine.local_sites(ecology)) == sites)
        up = time.monotonic() - began
        actors = {}
        for who, count in (("crowd", components), ("first", 0), ("second", 0), ("sink", 0)):
            actors[who] = stack.enter_context(program("benchmarks.live.crowd", who, str(count)))
            assert line(actors[who]) == "ready"
        endpoints = rendezvous.find(ecology, [])[1]
        bare = bare_zenoh(endpoints, ecology, components + len(world.ACTORS))
        with sc.join(ecology) as living:
            discover, again = timed(living.discover), timed(living.discover)
        with sc.join(ecology) as living:
            began = time.monotonic()
            with living.run(sc.template(folder / "task.ttl")) as run:
                reached = threading.Event()
                threading.Thread(target=follow, args=(run, reached), daemon=True).start()
                if not reached.wait(PATIENCE):
                    raise SystemExit("the task does not run")
                running = time.monotonic() - began
                line(actors["sink"])
                idle, megabytes = cost(served)
                killed = time.time()
                actors["first"].send_signal(signal.SIGKILL)
                failover = float(line(actors["sink"])) - killed
                run.stop()
        return Measured(components, sites, up, discover, again, bare, running, failover, megabytes, idle)


def follow(run: sc.Run, reached: threading.Event) -> None:
    """Read the events of a run, and say when it runs."""
    for event in run.events():
        if event.act == "running":
            reached.set()


def timed(action: Any) -> float:
    """Seconds that something takes."""
    began = time.monotonic()
    action()
    return time.monotonic() - began


_SCHEDULER_CLOCK = 2
"""Which of a process's clocks counts to the nanosecond what it has used of processors."""


def cost(processes: list[subprocess.Popen[str]]) -> tuple[float, float]:
    """The share of a core that some processes take together while nothing happens, and the memory of one, in MB."""
    before = processor_time(processes)
    threading.Event().wait(IDLE)
    idle = (processor_time(processes) - before) / IDLE
    pages = sum(int(Path(f"/proc/{p.pid}/statm").read_text().split()[1]) for p in processes)
    return idle, pages * os.sysconf("SC_PAGE_SIZE") / len(processes) / 1e6


def processor_time(processes: list[subprocess.Popen[str]]) -> float:
    """Seconds of processor time of some processes, with that of threads that have ended."""
    return sum(time.clock_gettime(_processor_clock(process.pid)) for process in processes)


def _processor_clock(process: int) -> int:
    """The clock of a process, as `clock_getcpuclockid` of the GNU C library makes it, which Python does not offer."""
    return (~process << 3) | _SCHEDULER_CLOCK


def bare_zenoh(endpoints: list[str], ecology: str, expected: int) -> float:
    """Seconds of the roll-calls and of the question of a discovery in a program that only counts what comes."""
    config = zenoh.Config()
    for key, value in (("mode", '"client"'), ("scouting/multicast/enabled", "false")):
        config.insert_json5(key, value)
    config.insert_json5("connect/endpoints", f'["{endpoints[0]}"]')
    keys = Keys(ecology)
    with zenoh.open(config) as session:
        session_: Any = session
        began = time.monotonic()
        for key in (keys.any_life(), keys.any_site_life()):
            ended = threading.Event()
            session_.liveliness().get(key, Callback(lambda reply: None, ended.set, indirect=False))
            ended.wait(PATIENCE)
        came: list[None] = []
        ended = threading.Event()
        session_.get(
            keys.advertisements(),
            Callback(lambda reply: came.append(None), ended.set, indirect=False),
            target=zenoh.QueryTarget.ALL,
            consolidation=zenoh.ConsolidationMode.NONE,
        )
        ended.wait(PATIENCE)
        seconds = time.monotonic() - began
    if len(came) != expected:
        raise SystemExit(f"{len(came)} of {expected} advertisements came")
    return seconds


def report(found: list[Measured]) -> str:
    """The page."""
    head = "components, sites, sites up s, discover ms, again ms, bare ms, running ms, failover ms, site MB, idle %"
    rows = [
        [
            f"{m.components:,}",
            str(m.sites),
            f"{m.up:.1f}",
            *(f"{1000 * value:.0f}" for value in (m.discover, m.again, m.bare, m.running)),
            f"{1000 * m.failover:.1f}",
            f"{m.megabytes:.0f}",
            f"{100 * m.idle:.1f}",
        ]
        for m in found
    ]
    text = [f"# Living ecologies\n\n{(__doc__ or '').strip()}", table(head.split(", "), rows), growth(found)]
    machine = f"One run each; {described('eclipse-zenoh')}"
    return "\n\n".join(part for part in (*text, machine) if part) + "\n"


def growth(found: list[Measured]) -> str:
    """How the times grow with the number of components at one site: the exponents between the first and the last."""
    alone = [m for m in found if m.sites == 1]
    if len(alone) < 2:
        return ""
    small, large = alone[0], alone[-1]
    factor = math.log(large.components / small.components)
    exponents = (
        f"{name} {math.log(getattr(large, name) / getattr(small, name)) / factor:.2f}"
        for name in ("discover", "again", "bare", "running", "failover", "megabytes")
    )
    return f"Growth exponents from {small.components:,} to {large.components:,} components: {', '.join(exponents)}."


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description="living ecologies of several sizes")
    parser.add_argument("--smoke", action="store_true", help="a small one, to see that it works")
    parser.add_argument("--write", action="store_true", help=f"write the page to {PAGE.name}")
    parser.add_argument("--most", type=int, default=10_000, help="leave out ecologies of more components")
    given = parser.parse_args()
    sizes = SMOKE if given.smoke else [size for size in SIZES if size[0] <= given.most]
    found = []
    for components, sites in sizes:
        found.append(measure(components, sites))
        print(found[-1], file=sys.stderr, flush=True)
    text = report(found)
    print(text)
    if given.write:
        written = PAGE.read_text() if PAGE.exists() else ""
        _, head, kept = written.partition(BY_HAND)
        PAGE.write_text(f"{text}\n{head}{kept}" if head else text)


if __name__ == "__main__":
    main()
