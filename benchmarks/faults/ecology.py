"""The ecology of the benchmark: two sites that start the components, configurators, and a witness of who acts when."""

from __future__ import annotations

import json
import os
import secrets
import select
import signal
import socket
import subprocess
import sys
import threading
import time
from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.faults.actor import ADVERTISEMENTS
from selfconf import rendezvous
from selfconf.bus.zenoh import with_port

ROOT = Path(__file__).resolve().parents[2]
TASK = Path(__file__).parent / "task.ttl"
RIVAL = Path(__file__).parent / "rival.ttl"
"""A task that goes before: it shares the sonar, takes the drive, and has a composite for the control."""
SITES = ("robot", "room")
RIVALS_SITE = "room"
"""The site that also advertises what only the rival needs."""
HUB = "hub"
"""A site that advertises nothing, and through which all others and the configurators go, as if each had a host."""
PATIENCE = 30.0
"""Seconds that a process may take to begin, on a busy machine."""


@dataclass(frozen=True, slots=True)
class Sign:
    """What a component did, in which process, at what time of the machine's monotonic clock."""

    name: str
    process: int
    what: str
    time: float


class Witnesses:
    """Hears what the components do."""

    def __init__(self, address: Path) -> None:
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self._socket.bind(str(address))
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        self._socket.setblocking(False)
        self.signs: list[Sign] = []
        self.processes: dict[int, str] = {}
        """Every process that was born, with the name of its component."""

    @property
    def number(self) -> int:
        """The file number to wait on."""
        return self._socket.fileno()

    def listen(self) -> None:
        """Note everything that has been said."""
        while True:
            try:
                name, process, what, moment = json.loads(self._socket.recv(1 << 10))
            except BlockingIOError:
                return
            self.processes.setdefault(process, name)
            self.signs.append(Sign(name, process, what, moment))

    def close(self) -> None:
        """Hear no more."""
        self._socket.close()

    def process_of(self, name: str) -> int | None:
        """The process of a component that was born last, if it has not ended."""
        born = [process for process, owner in self.processes.items() if owner == name and alive(process)]
        return born[-1] if born else None

    def acting(self, since: float, until: float = float("inf")) -> list[Sign]:
        """The signs of those that acted between two times."""
        return [sign for sign in self.signs if sign.what == "acts" and since < sign.time < until]

    def forget(self, before: float) -> None:
        """Forget what was before."""
        self.signs = [sign for sign in self.signs if sign.time >= before]


class Program:
    """A process of selfconf with its lines of output."""

    def __init__(self, environment: dict[str, str], *arguments: str) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-m", "selfconf", *arguments],
            cwd=ROOT,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
        )
        assert self._process.stdout is not None
        os.set_blocking(self._process.stdout.fileno(), False)
        self._unread = b""
        self.lines: list[str] = []
        self._parsed = 0
        self._events: list[dict[str, Any]] = []

    @property
    def number(self) -> int:
        """The number of the process."""
        return self._process.pid

    @property
    def output(self) -> int:
        """The file number of its output."""
        assert self._process.stdout is not None
        return self._process.stdout.fileno()

    @property
    def ended(self) -> int | None:
        """Its exit code, once it has ended."""
        return self._process.poll()

    def read(self) -> None:
        """Read what it has said."""
        try:
            while more := os.read(self.output, 1 << 16):
                *lines, self._unread = (self._unread + more).split(b"\n")
                self.lines += [line.decode(errors="replace") for line in lines]
        except BlockingIOError:
            pass

    @property
    def acts(self) -> list[str]:
        """The acts of a run, in order."""
        return [str(event["act"]) for event in self.events]

    @property
    def events(self) -> list[dict[str, Any]]:
        """The events of a run, in order; each line is parsed once, however often they are looked at."""
        self._events += [json.loads(line) for line in self.lines[self._parsed :] if line.startswith("{")]
        self._parsed = len(self.lines)
        return self._events

    def send(self, number: int) -> None:
        """Send a signal."""
        if self.ended is None:
            self._process.send_signal(number)

    def end(self) -> None:
        """Kill it, and wait."""
        self.send(signal.SIGCONT)
        self.send(signal.SIGKILL)
        self._process.wait()
        assert self._process.stdout is not None
        self._process.stdout.close()


class Halted(Exception):
    """The benchmark has been halted while an ecology waited for something."""


class Ecology:
    """Sites, components and configurators, all real processes; everything is read by this one thread.

    It shares no name, port or folder with another one, so that several live beside each other, each with a thread. Once
    `halt` is set, whatever waits in it raises `Halted`; it can be closed all the same.
    """

    def __init__(
        self, folder: Path, through_hub: bool = False, halt: threading.Event | None = None, rival: bool = False
    ) -> None:
        self.name, self._rival = f"faults-{secrets.token_hex(3)}", rival
        self._hub = with_port("tcp/127.0.0.1:0") if through_hub else ""
        runtime = folder / self.name
        runtime.mkdir()
        self.witnesses = Witnesses(runtime / "witness")
        self.environment = {
            **os.environ,
            "SELFCONF_RUNTIME_DIR": str(runtime),
            "FAULTS_WITNESS": str(runtime / "witness"),
            "PYTHONPATH": str(ROOT),
        }
        if through_hub:
            self.environment[rendezvous.CONNECT_VARIABLE] = self._hub
        self._runtime = runtime
        self._halt = halt or threading.Event()
        self.programs: list[Program] = []
        self.sites: dict[str, Program] = {}
        try:
            for name in (HUB, *SITES) if through_hub else SITES:
                self.start_site(name)
        except BaseException:
            self.close()
            raise

    def start_site(self, name: str) -> None:
        """Start a site, and wait until it serves."""
        where = ("site", *map(str, self._advertisements(name)), "--ecology", self.name, "--name", name)
        site = Program(self._environment_of(name), *where, *(("--listen", self._hub) if name == HUB else ()))
        self.programs.append(site)
        self.sites[name] = site

        def serves() -> bool:
            return any(" on tcp/" in line for line in site.lines)

        self.until(lambda: serves() or site.ended is not None, PATIENCE)
        if not serves():
            raise RuntimeError(f"site {name} does not begin: {site.lines}")

    def _advertisements(self, name: str) -> list[Path]:
        folder = ADVERTISEMENTS / name if name in SITES else self._runtime / name / "ads"
        folder.mkdir(parents=True, exist_ok=True)
        return [folder, ADVERTISEMENTS / "rival"] if self._rival and name == RIVALS_SITE else [folder]

    def _environment_of(self, name: str) -> dict[str, str]:
        """What a site is told: where all go through a hub, a folder of its own, as on a host of its own."""
        if not self._hub:
            return self.environment
        found = {**self.environment, "SELFCONF_RUNTIME_DIR": str(self._runtime / name)}
        if name == HUB:
            del found[rendezvous.CONNECT_VARIABLE]
        return found

    def start(self, *arguments: str) -> Program:
        """Start a program of selfconf in this ecology."""
        program = Program(self.environment, *arguments)
        self.programs.append(program)
        return program

    def run(self, task: Path = TASK) -> Program:
        """Start a configurator that waits if it must."""
        return self.start("run", str(task), "--wait", "--format", "json", "--ecology", self.name)

    def until(self, condition: Callable[[], bool], seconds: float) -> bool:
        """Read what everybody says until a condition holds; whether it does in time."""
        return self._until(condition, seconds, self._halt)

    def _until(self, condition: Callable[[], bool], seconds: float, halt: threading.Event | None = None) -> bool:
        deadline = time.monotonic() + seconds
        while True:
            if halt is not None and halt.is_set():
                raise Halted
            self._read(0.0)
            if condition():
                return True
            left = deadline - time.monotonic()
            if left <= 0:
                return False
            self._read(min(left, 0.02))

    def let_pass(self, seconds: float) -> None:
        """Let time pass."""
        self.until(lambda: False, seconds)

    def _read(self, seconds: float) -> None:
        open_programs = {program.output: program for program in self.programs if program.ended is None}
        ready, _, _ = select.select([self.witnesses.number, *open_programs], [], [], seconds)
        self.witnesses.listen()
        for number in ready:
            if number in open_programs:
                open_programs[number].read()

    def forget(self, program: Program) -> None:
        """Read a program no more that has ended."""
        if program in self.programs:
            program.read()
            program.end()
            self.programs.remove(program)

    def left(self) -> list[int]:
        """The processes of components that have not ended."""
        return [process for process in self.witnesses.processes if alive(process)]

    def close(self) -> list[str]:
        """End everything; return the names of components that had not ended with their sites, and end them too."""
        for program in self.programs:
            program.send(signal.SIGCONT)
            program.send(signal.SIGTERM)
        self._until(lambda: all(program.ended is not None for program in self.programs), 8.0)
        self._until(lambda: not self.left(), 5.0)
        left = [self.witnesses.processes[process] for process in self.left()]
        for process in self.left():
            os.kill(process, signal.SIGKILL)
        for program in self.programs:
            program.end()
        self.programs.clear()
        self.witnesses.close()
        return left


def alive(process: int) -> bool:
    """Whether a process of a component runs, and is no zombie; another one with its number does not count."""
    try:
        command = Path(f"/proc/{process}/cmdline").read_bytes()
        state = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False
    return state != "Z" and b"benchmarks.faults.actor" in command


def lives_at_once(signs: list[Sign]) -> dict[str, float]:
    """For how many seconds each component acted in two processes at once, to a tenth of a second."""
    moments: dict[tuple[str, int], set[int]] = defaultdict(set)
    for sign in signs:
        moments[sign.name, int(sign.time * 10)].add(sign.process)
    seconds: dict[str, float] = defaultdict(float)
    for (name, _), processes in moments.items():
        if len(processes) > 1:
            seconds[name] += 0.1
    return dict(seconds)
