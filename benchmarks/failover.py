"""How long from FAIL to the first message over the new connection, beside a bare Zenoh round trip in the same run.

    python -m benchmarks.failover [--trials 50] [--kill] [--smoke] [--servers 3]

Nine processes on one machine: a site (the router), six components without physics, the configurator (`selfconf run`)
and an echo, all real. A trial: after a pause the position sensor in use raises FAIL; the configurator hears it,
searches, turns it off, activates the other one and connects it; the navigator hears its first pose. Between trials
one put-to-callback round trip is measured over the same router, after the same pause: cold, as the trial is.

With `--kill` the process of the sensor in use is ended by kill -9 instead, and started again after the trial.

    detect   FAIL raised, or the process killed -> the component is given up by the configurator
    decide   the search for the next configuration, or the look at what was found out beforehand
    deploy   the rest, until the first message has arrived
"""

from __future__ import annotations

import argparse
import http.client
import json
import os
import queue
import re
import secrets
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import zenoh
from zenoh.handlers import Callback

from benchmarks.machine import described, quantile, table

HERE = Path(__file__).parent / "failover"
ACTORS = ("sonar", "encoder", "position-a", "position-b", "control", "drive")
PAUSE = 0.3
"""Seconds of rest before each trial and each round trip: what a configurator finds out beforehand is known by then, and
does not take the processor from what is measured."""
PATIENCE = 20.0


class Process:
    """A process of the benchmark: its lines of JSON arrive in one queue with everybody else's."""

    def __init__(self, name: str, lines: queue.SimpleQueue[tuple[str, Any]], *command: str, **environment: str) -> None:
        self.name, self._lines = name, lines
        self._process = subprocess.Popen(
            [sys.executable, "-m", *command],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env={**os.environ, **environment},
        )
        self._listening = threading.Thread(target=self._listen, daemon=True)
        self._listening.start()

    def _listen(self) -> None:
        assert self._process.stdout is not None
        for text in self._process.stdout:
            try:
                fact = json.loads(text)
            except ValueError:
                fact = text.rstrip()
            self._lines.put((self.name, fact))

    def tell(self) -> None:
        """Write a line to its stdin."""
        assert self._process.stdin is not None
        self._process.stdin.write("go\n")
        self._process.stdin.flush()

    def kill(self) -> float:
        """End it as a crash does, and return when."""
        moment = time.time()
        self._process.kill()
        return moment

    def end(self) -> None:
        """End it and wait."""
        self._process.terminate()
        try:
            self._process.wait(10)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._listening.join()
        for pipe in (self._process.stdin, self._process.stdout):
            if pipe is not None:
                pipe.close()


class Lines:
    """The lines of all processes, waited for by what they say."""

    def __init__(self) -> None:
        self.queue: queue.SimpleQueue[tuple[str, Any]] = queue.SimpleQueue()

    def until(self, wanted: Callable[[str, Any], bool]) -> list[tuple[str, Any]]:
        """Every line up to and including the wanted one."""
        heard: list[tuple[str, Any]] = []
        deadline = time.monotonic() + PATIENCE
        while True:
            try:
                heard.append(self.queue.get(timeout=max(0.0, deadline - time.monotonic())))
            except queue.Empty:
                raise SystemExit(f"the benchmark stalled; last lines: {heard[-5:]}") from None
            if wanted(*heard[-1]):
                return heard


class Echo:
    """A bare Zenoh round trip over the same router: put, callback in another process, put, callback."""

    def __init__(self, endpoint: str) -> None:
        config = zenoh.Config()
        config.insert_json5("mode", '"client"')
        config.insert_json5("scouting/multicast/enabled", "false")
        config.insert_json5("connect/endpoints", json.dumps([endpoint]))
        self._session: Any = zenoh.open(config)
        self._back = threading.Event()
        self._subscriber = self._session.declare_subscriber("echo/back", Callback(self._heard, indirect=False))
        self._publisher = self._session.declare_publisher(
            "echo/go", congestion_control=zenoh.CongestionControl.BLOCK, express=True
        )

    def _heard(self, _: zenoh.Sample) -> None:
        self._back.set()

    def measure(self) -> float:
        """Seconds of one round trip."""
        self._back.clear()
        began = time.perf_counter()
        self._publisher.put(b"x" * 64)
        if not self._back.wait(PATIENCE):
            raise SystemExit("the echo does not answer")
        return time.perf_counter() - began

    def close(self) -> None:
        """Leave."""
        self._session.close()


def measure(trials: int, kill: bool = False, keys: Path | None = None, servers: int = 0) -> dict[str, list[float]]:
    """Seconds by part: round trip, detect, decide, deploy, total without decide.

    With `servers` that total is measured once more in the same run, with so many `selfconf serve` attached, each with a
    page. With `keys`, the folder of an authority, nothing is measured beside it: a bare round trip is not let in.
    """
    ecology = f"failover-{secrets.token_hex(3)}"
    lines = Lines()
    parts: dict[str, list[float]] = {name: [] for name in ("round trip", "detect", "decide", "deploy", "undecided")}
    with ExitStack() as stack:

        def start(name: str, *command: str, **environment: str) -> Process:
            secret = {} if keys is None else {"SELFCONF_KEYS": str(keys)}
            process = Process(name, lines.queue, *command, **environment, **secret)
            stack.callback(process.end)
            return process

        advertisements = [str(HERE / f"{name}.ttl") for name in ACTORS]
        start("site", "selfconf", "site", *advertisements, "--ecology", ecology)
        said = lines.until(lambda name, fact: name == "site" and " on t" in str(fact))[-1][1]
        where = {"SELFCONF_ECOLOGY": ecology, "SELFCONF_CONNECT": str(said).rpartition(" on ")[2]}
        actors = {name: start(name, "benchmarks.failover_actors", name, **where) for name in ACTORS}
        for _ in ACTORS:
            lines.until(lambda name, fact: isinstance(fact, dict) and fact.get("event") == "ready")
        echo = None if keys is not None else _begun_echo(start, lines, where["SELFCONF_CONNECT"], stack)
        command = ["selfconf", "run", str(HERE / "task.ttl"), "--ecology", ecology]
        start("configurator", *command, "--connect", where["SELFCONF_CONNECT"], "--format", "json")
        lines.until(_said("configurator", "act", "running"))
        if echo is not None:
            echo.measure()

        def repeat(parts: dict[str, list[float]]) -> None:
            for trial in range(trials):
                threading.Event().wait(PAUSE)
                if echo is not None:
                    parts["round trip"].append(echo.measure())
                    threading.Event().wait(PAUSE)
                name = ("position-a", "position-b")[trial % 2]
                _trial(lines, actors[name], parts, kill)
                if kill:
                    actors[name].end()
                    actors[name] = start(name, "benchmarks.failover_actors", name, **where)
                    lines.until(_said(name, "event", "ready"))
                    threading.Event().wait(PAUSE)  # until it stands by

        repeat(parts)
        if servers:
            for number in range(servers):
                start(f"server-{number}", "selfconf", "serve", "--port", "0", **where)
                said = lines.until(lambda name, fact: name.startswith("server-") and "http://" in str(fact))[-1][1]
                _attached(str(said), stack)
            again: dict[str, list[float]] = {name: [] for name in parts}
            repeat(again)
            parts["attached"] = again["undecided"]
    return parts


def _attached(said: str, stack: ExitStack) -> None:
    """Follow a server as its page does, from when it has seen what runs."""
    found = re.search(r"http://([^:]+):(\d+)/", said)
    assert found is not None, said
    line = http.client.HTTPConnection(found[1], int(found[2]), timeout=PATIENCE)
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        line.request("GET", "/state")
        if any(task["configuration"] for task in json.loads(line.getresponse().read())["tasks"].values()):
            break
        threading.Event().wait(PAUSE)
    line.request("GET", "/changes")
    stack.callback(line.close)


def _begun_echo(start: Callable[..., Process], lines: Lines, endpoint: str, stack: ExitStack) -> Echo:
    """The round trip that is measured beside the failover, with its other end."""
    start("echo", "benchmarks.failover_echo", endpoint)
    lines.until(lambda name, fact: name == "echo")
    echo = Echo(endpoint)
    stack.callback(echo.close)
    return echo


def _trial(lines: Lines, sensor: Process, parts: dict[str, list[float]], kill: bool) -> None:
    facts: dict[str, dict[str, Any]] = {}
    wanted = {"fail", "first", "lost", "composed", "running"} | (set() if kill else {"back"})
    if kill:
        facts["fail"] = {"real": sensor.kill()}
    else:
        sensor.tell()

    def over(name: str, fact: Any) -> bool:
        if isinstance(fact, dict):
            facts[fact.get("event") or fact["act"]] = fact
        return wanted <= facts.keys()

    lines.until(over)
    raised, lost, first = facts["fail"]["real"], facts["lost"]["time"], facts["first"]["real"]
    decide = facts["composed"]["seconds"]
    parts["detect"].append(lost - raised)
    parts["decide"].append(decide)
    parts["deploy"].append(first - lost - decide)
    parts["undecided"].append(first - raised - decide)


def _said(process: str, key: str, value: str) -> Callable[[str, Any], bool]:
    return lambda name, fact: name == process and isinstance(fact, dict) and fact.get(key) == value


def report(parts: dict[str, list[float]], kill: bool = False) -> str:
    """The table, with each part as a ratio to the median round trip."""
    floor = quantile(parts["round trip"], 0.5)
    total = f"{'kill -9' if kill else 'FAIL'} to first message, without the search"
    names = {"undecided": total, "attached": f"{total}, with servers attached"}
    rows = []
    for name, values in parts.items():
        middle, high = quantile(values, 0.5), quantile(values, 0.95)
        cells = [f"{middle * 1000:.2f}", f"{high * 1000:.2f}", f"{middle / floor:.1f}", f"{high / floor:.1f}"]
        rows.append([names.get(name, name), *cells])
    head = ["", "median ms", "95 % ms", "median / round trip", "95 % / round trip"]
    count = len(parts["detect"])
    return f"{table(head, rows)}\n\n{count} trials; {described('eclipse-zenoh')}"


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description="FAIL to first message, beside a bare Zenoh round trip")
    parser.add_argument("--trials", type=int, default=50)
    parser.add_argument("--kill", action="store_true", help="end the process of the sensor instead of raising FAIL")
    parser.add_argument("--smoke", action="store_true", help="four trials, to see that it works")
    parser.add_argument("--servers", type=int, default=0, help="measure again with so many `selfconf serve` attached")
    given = parser.parse_args()
    parts = measure(4 if given.smoke else given.trials, given.kill, servers=given.servers)
    print(report(parts, given.kill))
    if given.servers:
        with_them, without = quantile(parts["attached"], 0.5), quantile(parts["undecided"], 0.5)
        print(f"\nwith {given.servers} servers / without: {with_them / without:.2f} (medians)")


if __name__ == "__main__":
    main()
