"""Many sites on one machine: what they cost while nothing happens, and whether they recover from a common stall.

    python -m benchmarks.live.stall [--sites 50] [--tasks 0] [--seconds 3] [--keys] [--smoke]

All sites are processes of one ecology. They are left alone, then all stopped at once (SIGSTOP) and let go on; a bare
client asks who lives until it sees as many as before, and the cost of idleness is measured once more. With tasks the
sites keep so many, each of a source and a sink of its own, which one more process runs and which go on. With keys all
programs have one authority's, and each site learns the certificates of the others.

    up       from the first process to the last site that is seen
    idle     processor time of all sites together, per cent of one core, before and after the stall
    back     from the end of the stall until all are seen, at two looks in a row
    running  from the end of the stall until every task runs
    busy     processor time of the sites, in seconds, from the end of the stall until all is back, or for ten seconds
"""

from __future__ import annotations

import argparse
import os
import secrets
import signal
import subprocess
import tempfile
import threading
import time
from contextlib import ExitStack, suppress
from pathlib import Path

import selfconf as sc
from benchmarks.live import world
from benchmarks.live.__main__ import cost, line, processor_time, program
from benchmarks.machine import described, table
from selfconf import rendezvous, this_machine
from selfconf.access import Authority, PrincipalKind, introduce
from selfconf.bus.zenoh import ZenohBus, client
from selfconf.protocol.keys import Keys

PATIENCE = 240.0
LOOK = 0.2
"""Seconds between two looks at who lives."""
SETTLING = 10.0
"""Seconds after which the cost of idleness is measured: uplinks that were replaced stay for a while. As long it is
measured how busy the sites are after the stall."""


def living(bus: ZenohBus, ecology: str) -> int:
    """How many sites live, as far as a bus can see."""
    heard: list[tuple[str, ...]] = []
    bus.roll_call(Keys(ecology).any_site_life(), 2.0, heard.append)
    deadline = bus.now() + 3.0
    bus.run(lambda: bool(heard) or bus.now() > deadline)
    return len(heard[0]) if heard else 0


def until_all_live(bus: ZenohBus, ecology: str, sites: int) -> float:
    """Seconds until all sites are seen at two looks in a row; the first of these counts."""
    began = time.monotonic()
    seen_at = None
    while time.monotonic() < began + PATIENCE:
        if living(bus, ecology) < sites:
            seen_at = None
        elif seen_at is not None:
            return seen_at - began
        else:
            seen_at = time.monotonic()
        threading.Event().wait(LOOK)
    raise SystemExit(f"after {PATIENCE:.0f} s {living(bus, ecology)} of {sites} sites are seen")


def until_all_run(ecology: str, tasks: int) -> float:
    """Seconds until all tasks run."""
    began = time.monotonic()
    while time.monotonic() < began + PATIENCE:
        with suppress(sc.SelfconfError), sc.join(ecology) as living:
            if sum(status.phase == "running" for status in living.tasks) == tasks:
                return time.monotonic() - began
        threading.Event().wait(LOOK)
    raise SystemExit(f"after {PATIENCE:.0f} s not all of {tasks} tasks run")


def joined(ecology: str) -> ZenohBus:
    """A bare client, let in by all sites where there are keys."""
    shown = rendezvous.credentials(None, PrincipalKind.CONFIGURATOR.value)
    bus = client(rendezvous.find(ecology, [], shown)[1], credentials=shown)
    if shown is not None:
        introduce(bus, ecology, shown)
    return bus


def measure(sites: int, tasks: int, seconds: float, keys: bool) -> list[str]:
    """The row of one ecology."""
    ecology = f"stall-{secrets.token_hex(3)}"
    with tempfile.TemporaryDirectory() as name, ExitStack() as stack:
        os.environ |= {
            "SELFCONF_RUNTIME_DIR": f"{name}/runtime",
            rendezvous.ECOLOGY_VARIABLE: ecology,
            world.FOLDER_VARIABLE: name,
        }
        if keys:
            os.environ[rendezvous.KEYS_VARIABLE] = str(Authority.init(Path(name) / "keys").path)
        empty, pairs = Path(name) / "empty", Path(name) / "pairs"
        empty.mkdir()
        pairs.mkdir()
        world.write_pairs(tasks)
        began = time.monotonic()
        served: list[subprocess.Popen[str]] = []
        for number in range(sites):
            folder = str(pairs if number == sites - 1 else empty)
            served.append(stack.enter_context(program("selfconf", "site", folder, "--name", f"s{number}")))
            if not number:
                while not this_machine.local_sites(ecology) and time.monotonic() < began + PATIENCE:
                    threading.Event().wait(LOOK)
        bus = joined(ecology)
        stack.callback(bus.close)
        until_all_live(bus, ecology, sites)
        up = time.monotonic() - began
        if tasks:
            assert line(stack.enter_context(program("benchmarks.live.crowd", "pairs", str(tasks)))) == "ready"
            with sc.join(ecology) as living:
                for number in range(tasks):
                    living.detach(sc.template(world.pair_file("task", number)), name=f"t{number}")
            until_all_run(ecology, tasks)
        threading.Event().wait(SETTLING)
        before, megabytes = cost(served)
        for process in served:
            process.send_signal(signal.SIGSTOP)
        threading.Event().wait(seconds)
        for process in served:
            process.send_signal(signal.SIGCONT)
        again, used = time.monotonic(), processor_time(served)
        back = until_all_live(bus, ecology, sites)
        running = f"{back + until_all_run(ecology, tasks):.1f}" if tasks else ""
        threading.Event().wait(max(0.0, again + SETTLING - time.monotonic()))
        busy = processor_time(served) - used
        threading.Event().wait(SETTLING)
        after, _ = cost(served)
        ended = sum(process.poll() is not None for process in served)
    shown = [f"{up:.1f}", f"{100 * before:.1f}", f"{back:.1f}", running, f"{busy:.1f}", f"{100 * after:.1f}"]
    return [str(sites), str(tasks), "yes" if keys else "no", f"{seconds:g}", *shown, f"{megabytes:.0f}", str(ended)]


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.live.stall", description="many sites, and a stall")
    parser.add_argument("--sites", type=int, default=50)
    parser.add_argument("--tasks", type=int, default=0, help="how many tasks the sites keep")
    parser.add_argument("--seconds", type=float, default=3.0, help="how long all stand still")
    parser.add_argument("--keys", action="store_true", help="all programs have keys")
    parser.add_argument("--smoke", action="store_true", help="three sites and six tasks, to see that it works")
    given = parser.parse_args()
    sites, tasks = (3, 6) if given.smoke else (given.sites, given.tasks)
    row = measure(sites, tasks, given.seconds, given.keys)
    head = [
        "sites",
        "tasks",
        "keys",
        "stall s",
        "up s",
        "idle %",
        "back s",
        "running s",
        "busy s",
        "idle afterwards %",
        "site MB",
        "ended",
    ]
    print(f"{table(head, [row])}\n\nOne run; {described('eclipse-zenoh')}")


if __name__ == "__main__":
    main()
