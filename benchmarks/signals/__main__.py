"""Measure signals of several sizes between two components, beside bare Zenoh in the same run.

    python -m benchmarks.signals [--smoke] [--write]

Seven processes on one machine: a router, and a source and a sink of each of three programs:

    selfconf    components of the SDK, which are connected by calls as a configurator makes them
    bare        no more than put and subscribe; JSON is written and read where selfconf does, by the same library
    least       bare Zenoh, and the fewest lines of Python that keep what is promised of a signal: it says its source,
                life, number and time, and is issued in the order of the numbers; it is read on another thread than
                Zenoh's, so that slow code holds nothing up, from a bounded queue, and is not delivered twice

All pairs go through the router, with the same quality of service, and take turns. What `least` does not reach, cannot
be reached in Python with these promises, as far as is known.

    signals/s   that arrive while the source issues them as fast as it can, the median of all rounds
    ms          from just before `emit` to the sink's code, at 100 Hz (from 1 MB on at 30 Hz)
    JSON        a rob:RangeScan, checked against its fields, written and read as JSON
    bytes       a rob:Image as it is

Above 1 a ratio of rates is good, a ratio of times bad. Bare Zenoh has no shared memory here, as a program that sets
nothing up has none with a router; components have it from 32 KiB on.
"""

from __future__ import annotations

import argparse
import json
import os
import select
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, NamedTuple

from benchmarks.machine import described, quantile, table
from benchmarks.signals.ends import ECOLOGY, FOLDER_VARIABLE, OUTPUTS
from selfconf.bus.port import Replies
from selfconf.bus.zenoh import ZenohBus, client, router
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Apply, CallAnswer, Reserve, Verdict, Wire
from selfconf.sdk.inputs.signal_queue import EVENT_BYTES

PAGE = Path(__file__).resolve().parents[2] / "docs" / "benchmarks" / "signals.md"
PROGRAMS = ("bare", "least", "selfconf")
SLOW = ("bare", "selfconf")
"""Those that are given a slow consumer."""
CASES = (
    *(("JSON", size) for size in (100, 1_000, 10_000)),
    *(("bytes", size) for size in (100, 1_000, 10_000, 100_000, 300_000, 1_000_000, 4_000_000)),
)
PATIENCE = 60.0
QUIET = 0.2
"""Seconds without a signal after which no more is awaited."""
SOURCE, SINK = IRI("urn:signals:source"), IRI("urn:signals:sink")
TURTLE = """@prefix sc: <https://w3id.org/selfconf#> .
@prefix rob: <https://w3id.org/selfconf/robotics#> .
"""
ADVERTISEMENTS = {
    "source": f"""<{SOURCE}> a sc:Component, rob:Camera ;
    sc:hasOutput [ sc:name "scan" ; sc:signalType rob:RangeScan ] , [ sc:name "picture" ; sc:signalType rob:Image ] .
""",
    "sink": f"""<{SINK}> a sc:Component, rob:NavigationControl ;
    sc:hasInput [ sc:name "scan" ; sc:signalType rob:RangeScan ] , [ sc:name "picture" ; sc:signalType rob:Image ] .
""",
}


class Effort(NamedTuple):
    """How much is measured."""

    rounds: int
    seconds: float
    """Of each flood."""
    number: int
    """Signals of each round of latencies."""
    slow: int
    """Signals to a slow consumer."""


class Measured(NamedTuple):
    """Of one program with one case: signals in a second, round by round, seconds of every signal, signals lost."""

    rates: list[float]
    latencies: list[float]
    lost: list[int]


class Found(NamedTuple):
    """What was measured: the cases, and the megabytes by which the sink of each program grows when it is slow."""

    cases: dict[tuple[str, int], dict[str, Measured]]
    grown: dict[str, float]
    effort: Effort


SMOKE = Effort(1, 0.1, 5, 2)


class End:
    """A process at one end."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self._process = process

    def tell(self, **order: Any) -> Any:
        """Have it do something, and return what it says."""
        assert self._process.stdin is not None
        self._process.stdin.write(json.dumps(order) + "\n")
        self._process.stdin.flush()
        return self._answer()

    def wait(self) -> None:
        """Wait until it is ready."""
        assert self._answer() == "ready"

    def _answer(self) -> Any:
        assert self._process.stdout is not None
        if not select.select([self._process.stdout], [], [], PATIENCE)[0]:
            raise SystemExit("the benchmark stalled")
        return json.loads(self._process.stdout.readline())


@contextmanager
def program(*command: str) -> Iterator[End]:
    """A process, ended at the end."""
    process = subprocess.Popen(
        [sys.executable, "-m", "benchmarks.signals.ends", *command],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        yield End(process)
    finally:
        process.kill()
        process.wait()


class Connection:
    """A source and a sink."""

    def __init__(self, source: End, sink: End) -> None:
        self._source, self._sink = source, sink

    def rate(self, form: str, size: int, seconds: float) -> float:
        """Signals that arrive in a second when they are issued as fast as that goes."""
        self._source.tell(form=form, size=size, seconds=seconds)
        moments = self._arrived().values()
        if len(moments) < 2:  # a process that gets no processor for a second counts as dead
            raise SystemExit("nothing arrives any more: the machine is too busy for the links to last; try again")
        return (len(moments) - 1) / (max(moments) - min(moments))

    def latencies(self, form: str, size: int, count: int) -> list[float]:
        """Seconds from just before a signal is issued to when it was received and read, of those that arrive."""
        rate = 100.0 if size < 1_000_000 else 30.0
        issued = self._source.tell(form=form, size=size, count=count, rate=rate)
        arrived = self._arrived()
        return [arrived[number] - moment for number, moment in issued.items() if number in arrived]

    def slow_consumer(self, count: int) -> float:
        """Megabytes by which the sink grows while it takes longer with each signal than the source."""
        before = self._sink.tell(anew=0.1)["megabytes"]
        self._source.tell(form="bytes", size=1_000_000, count=count, rate=60.0)
        grown: float = self._sink.tell(anew=0.0)["megabytes"] - before
        self._arrived()
        return grown

    def _arrived(self) -> dict[str, float]:
        """When each signal has arrived, once no more do."""
        before = -1
        while (count := self._sink.tell()["count"]) != before:
            before = count
            threading.Event().wait(QUIET)
        moments: dict[str, float] = self._sink.tell(anew=0.0)["moments"]
        return moments


@contextmanager
def connections() -> Iterator[dict[str, Connection]]:
    """Both programs, over one router."""
    with tempfile.TemporaryDirectory() as folder, ExitStack() as stack:
        os.environ[FOLDER_VARIABLE] = folder
        for role, text in ADVERTISEMENTS.items():
            (Path(folder) / f"{role}.ttl").write_text(TURTLE + text)
        hub = router()
        hub.run_aside()
        stack.callback(hub.close)
        ends = {
            (name, role): stack.enter_context(program(name, role, hub.endpoint))
            for name in PROGRAMS
            for role in ADVERTISEMENTS
        }
        for end in ends.values():
            end.wait()
        found = {name: Connection(ends[name, "source"], ends[name, "sink"]) for name in PROGRAMS}
        caller = client([hub.endpoint])
        caller.run_aside()
        stack.callback(caller.close)
        configure(caller)
        yield found


def configure(caller: ZenohBus) -> None:
    """Activate the components, and connect them."""
    keys = Keys(ECOLOGY)
    supervisor = keys.configurator_life("benchmark", "1")
    caller.announce(supervisor)
    wires = {port: (Wire(SOURCE, port),) for port in OUTPUTS.values()}
    claim = (1, supervisor, "benchmark~1")
    calls: tuple[tuple[IRI, str, Reserve | Apply], ...] = (
        (SOURCE, "apply", Apply(*claim)),
        (SINK, "reserve", Reserve(*claim, inputs=wires)),
        (SINK, "apply", Apply(*claim, inputs=wires)),
    )
    for component, call, message in calls:
        answered: list[Replies] = []
        caller.ask(keys.call(component, call), encode(message), PATIENCE, answered.append)
        deadline = time.monotonic() + PATIENCE
        while not answered and time.monotonic() < deadline:
            threading.Event().wait(0.01)
        verdicts = [decode(sample.payload, CallAnswer).verdict for replies in answered for sample in replies.samples]
        if verdicts != [Verdict.DONE]:
            raise SystemExit(f"{component} answers {call} with {verdicts}")
    threading.Event().wait(0.5)


def measure(cases: Sequence[tuple[str, int]], effort: Effort) -> Found:
    """Every case, the programs in turn; at last the slow consumer."""
    found: dict[tuple[str, int], dict[str, Measured]] = {}
    with connections() as ends:
        for form, size in cases:
            found[form, size] = {name: Measured([], [], []) for name in PROGRAMS}
            for turn in range(effort.rounds):
                for name in PROGRAMS if turn % 2 else reversed(PROGRAMS):
                    one = found[form, size][name]
                    one.rates.append(ends[name].rate(form, size, effort.seconds))
                    latencies = ends[name].latencies(form, size, effort.number)
                    one.latencies.extend(latencies)
                    one.lost.append(effort.number - len(latencies))
            print(row(form, size, found[form, size]), file=sys.stderr, flush=True)
        return Found(found, {name: ends[name].slow_consumer(effort.slow) for name in SLOW}, effort)


def row(form: str, size: int, both: dict[str, Measured]) -> list[str]:
    """A row of the table."""
    programs = [both[name] for name in PROGRAMS]
    rates = [quantile(one.rates, 0.5) for one in programs]
    middles = [quantile(one.latencies, 0.5) for one in programs]
    highs = [quantile(one.latencies, 0.95) for one in programs]
    return [
        form,
        f"{size:,}",
        *(f"{rate:,.0f}" for rate in rates),
        f"{rates[2] / rates[0]:.2f}",
        f"{rates[1] / rates[0]:.2f}",
        *(f"{1e3 * middle:.2f}" for middle in middles),
        f"{middles[2] / middles[0]:.2f}",
        f"{middles[1] / middles[0]:.2f}",
        *(f"{1e3 * high:.2f}" for high in highs),
        " / ".join(str(sum(one.lost)) for one in programs),
    ]


def report(found: Found) -> str:
    """The page."""
    head = (
        "form, bytes, bare signals/s, least signals/s, selfconf signals/s, selfconf of bare, least of bare, "
        "bare ms, least ms, selfconf ms, selfconf of bare, least of bare, "
        "bare 95 % ms, least 95 % ms, selfconf 95 % ms, lost at rate: bare / least / selfconf"
    )
    effort = found.effort
    grown = ", ".join(f"{name} {found.grown[name]:.0f} MB" for name in SLOW)
    slow = (
        f"A slow consumer, which takes 0.1 s with each of {effort.slow} signals of 1 MB that come at 60 Hz without a "
        f"promised rate, grows by: {grown}. Of selfconf at most {EVENT_BYTES / 1e6:.0f} MB wait."
    )
    rows = [row(*case, both) for case, both in found.cases.items()]
    machine = f"{effort.rounds} rounds; {described('eclipse-zenoh')}"
    text = ("# Signals", (__doc__ or "").strip(), table(head.split(", "), rows), verdict(rows), slow, machine)
    return "\n\n".join(text) + "\n"


def verdict(rows: Sequence[Sequence[str]]) -> str:
    """Where the goals are met: at least 0.9 of the rate of bare Zenoh, at most 1.3 times its median latency."""
    slow = [f"{row[0]} of {row[1]} ({row[5]})" for row in rows if float(row[5]) < 0.9]
    least = [f"{row[0]} of {row[1]} ({row[6]})" for row in rows if float(row[6]) < 0.9]
    late = [f"{row[0]} of {row[1]} ({row[10]})" for row in rows if float(row[10]) > 1.3]
    return (
        f"Less than 0.9 of the rate: {', '.join(slow) or 'nowhere'}. "
        f"`least` has less than 0.9 of it at: {', '.join(least) or 'nowhere'}. "
        f"More than 1.3 times the median latency: {', '.join(late) or 'nowhere'}."
    )


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description="signals between two components, beside bare Zenoh")
    parser.add_argument("--smoke", action="store_true", help="one case once, to see that it works")
    parser.add_argument("--write", action="store_true", help=f"write the page to {PAGE.name}")
    given = parser.parse_args()
    found = measure(CASES[1:2], SMOKE) if given.smoke else measure(CASES, Effort(7, 0.4, 60, 300))
    text = report(found)
    print(text)
    if given.write:
        PAGE.write_text(text)


if __name__ == "__main__":
    main()
