"""Real processes on one machine: sites, components, configurators, each started and ended by the test that needs it."""

from __future__ import annotations

import json
import os
import secrets
import select
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from selfconf.access import Authority, PrincipalKind, introduce
from selfconf.access.certificate_files import HOST_AUTHORITY
from selfconf.api.membership import Membership
from selfconf.bus.credentials import Credentials
from selfconf.bus.port import Replies
from selfconf.bus.zenoh import ZenohBus, client
from selfconf.errors import NetworkError, PeerError
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import CallAnswer
from tests.harness.fork_server import ForkedProgram
from tests.lab import ADVERTISEMENTS, NAVIGATE, PREFIXES, iri, write_advertisements

PATIENCE = 60.0
"""Seconds that a process may take for anything, on a busy machine."""
NO_NOHUP = pytest.mark.skipif(signal.getsignal(signal.SIGHUP) is signal.SIG_IGN, reason="SIGHUP is ignored here")
"""Marks what needs programs that the end of their terminal ends."""
PROGRAM = '''
"""Components for tests: each acts a little, and fails, or dies in `started`, when a file says so."""

import os
import sys
from pathlib import Path

from selfconf.sdk import Component, main

HERE = Path(__file__).parent


class Act(Component):
    """Counts on every output, and writes down what it is told."""

    def started(self):
        order = HERE / f"{self.name}.die"
        if order.exists():
            order.unlink()
            os._exit(3)
        self.count = 0
        self.every(0.05, self.act)

    def act(self):
        self.count += 1
        for output in self.outputs:
            self.emit(output, {**SIGNALS[output], "count": self.count})
        order = HERE / f"{self.name}.fail"
        if order.exists():
            order.unlink()
            self.fail("told to")

    def parameter_set(self, name, value):
        (HERE / f"{self.name}.{name}").write_text(str(value))


OUTPUTS = {"sonar": ["ranges"], "encoder": ["odometry"], "tracker": ["pose"], "odometry": ["pose"],
           "control": ["set.velocity"]}
SIGNALS = {
    "ranges": {"angles": [0.0], "ranges": [1.0], "max_range": 4.0},
    "odometry": {"x": 0.0, "y": 0.0, "theta": 0.0, "linear": 0.0, "angular": 0.0},
    "pose": {"x": 0.0, "y": 0.0, "theta": 0.0, "frame": "map"},
    "set.velocity": {"linear": 0.0, "angular": 0.0},
}
kinds = [
    type(name, (Act,), {"advertisement": HERE / "ads" / f"{name}.ttl", "name": name, "outputs": OUTPUTS.get(name, [])})
    for name in sys.argv[1].split(",")
]
main(*kinds, arguments=sys.argv[2:])
'''


COMPONENTS = "components.py"
"""The file of that program."""


class Program:
    """A process whose lines on stdout can be waited for."""

    def __init__(self, command: list[str], environment: dict[str, str], folder: Path) -> None:
        self._command = command
        self._read_end, write_end = os.pipe()
        self._process = _begun(command, environment, folder, write_end)
        os.close(write_end)
        self._unread, self._joined = b"", False
        self._said: list[str] = []
        self._complaints: list[str] = []
        self._listener = threading.Thread(target=self._listen, daemon=True)
        self._listener.start()

    def _listen(self) -> None:
        for line in self._process.stderr or ():
            self._complaints.append(line)

    def _line(self, deadline: float) -> bytes | None:
        """The next line on stdout, or None if there is none before the deadline."""
        while b"\n" not in self._unread:
            ready, _, _ = select.select([self._read_end], [], [], max(0.0, deadline - time.monotonic()))
            more = os.read(self._read_end, 1 << 16) if ready else b""
            if not more:
                return None
            self._unread += more
        line, _, self._unread = self._unread.partition(b"\n")
        self._said.append(line.decode(errors="replace"))
        return line

    @property
    def number(self) -> int:
        """The number of the process."""
        return self._process.pid

    @property
    def complaints(self) -> str:
        """What it has said on stderr."""
        return "".join(self._complaints)

    def read_what_is_there(self) -> None:
        """Take the lines on stdout that wait to be read."""
        while self._read_end >= 0 and self._line(0.0) is not None:
            pass

    @property
    def account(self) -> str:
        """Its command, how the lines on stdout that were read begin, and what it has said on stderr."""
        return "\n".join((" ".join(self._command), *(f"  {line[:200]}" for line in self._said), self.complaints))

    def act(self, act: str) -> dict[str, Any]:
        """The next account of an act on stdout; those before it are passed over."""
        deadline = time.monotonic() + PATIENCE
        while (line := self._line(deadline)) is not None:
            account: dict[str, Any] = json.loads(line)
            if account["act"] == act:
                return account
        raise AssertionError(f"no {act!r} before its end, or in {PATIENCE:.0f} s; stderr: {self.complaints}")

    def line(self) -> str:
        """The next line on stdout; empty if none comes."""
        return (self._line(time.monotonic() + PATIENCE) or b"").decode()

    def rest(self) -> str:
        """What is left on stdout, until it ends."""
        deadline, said = time.monotonic() + PATIENCE, list[bytes]()
        while (line := self._line(deadline)) is not None:
            said.append(line)
        return b"\n".join((*said, self._unread)).decode()

    def send(self, number: int) -> None:
        """Send a signal to the process."""
        self._process.send_signal(number)

    def children(self) -> list[int]:
        """The numbers of the processes that it has started."""
        threads = Path(f"/proc/{self.number}/task").glob("*/children")
        return [int(number) for thread in threads for number in thread.read_text().split()]

    def hang_up(self) -> None:
        """Read no more from its stdout."""
        if self._read_end >= 0:
            os.close(self._read_end)
            self._read_end = -1

    def end(self, how: int = signal.SIGTERM) -> int:
        """Signal the process, and wait for its exit code."""
        if self._process.poll() is None:
            self._process.send_signal(how)
        return self.ended()

    def ended(self) -> int:
        """The exit code of the process, which ends by itself."""
        code = self._process.wait(PATIENCE)
        self.hang_up()
        if not self._joined:
            self._joined = True
            self._listener.join(PATIENCE)
            if self._process.stderr is not None:
                self._process.stderr.close()
        return code

    @property
    def over(self) -> bool:
        """Whether the process has ended."""
        return self._process.poll() is not None


def _begun(
    command: list[str], environment: dict[str, str], folder: Path, out: int
) -> subprocess.Popen[str] | ForkedProgram:
    """The process of a command; that of a program of selfconf has imported already what it uses."""
    if command[:3] == [sys.executable, "-m", "selfconf"] or command[:2] == [sys.executable, COMPONENTS]:
        return ForkedProgram(command[1:], environment, folder, out)
    nothing, complaints = subprocess.DEVNULL, subprocess.PIPE
    return subprocess.Popen(
        command, cwd=folder, env=environment, stdin=nothing, stdout=out, stderr=complaints, text=True
    )


class Home:
    """An ecology of real processes."""

    def __init__(self, folder: Path, keys: bool | None = None) -> None:
        """With `keys` everything is done with those of an authority of its own, by default as in other tests."""
        self.folder, self.ecology = folder, f"test-{secrets.token_hex(4)}"
        self.keys = Keys(self.ecology)
        write_advertisements(folder / "ads")
        (folder / COMPONENTS).write_text(PROGRAM)
        (folder / "navigate.ttl").write_text(NAVIGATE)
        self.runtime = folder / "runtime"
        self.environment = {
            **{name: value for name, value in os.environ.items() if not name.startswith("SELFCONF_")},
            "SELFCONF_RUNTIME_DIR": str(self.runtime),
            "PYTHONPATH": str(Path(__file__).parent.parent.parent),
        }
        given = os.environ.get("SELFCONF_KEYS") if keys is None else None
        self.authority = Authority(Path(given)) if given else Authority.init(folder / "keys") if keys else None
        if self.authority is not None:
            self.environment["SELFCONF_KEYS"] = str(self.authority.path)
        self._programs: list[Program] = []
        self._bus: ZenohBus | None = None

    # Programs.

    def program(self, *command: str) -> Program:
        """Start a program."""
        program = Program(list(command), self.environment, self.folder)
        self._programs.append(program)
        return program

    def selfconf(self, *arguments: str) -> Program:
        """Start a command."""
        return self.program(sys.executable, "-m", "selfconf", *arguments)

    def site(self, name: str, *paths: str, connect: tuple[str, ...] = (), options: tuple[str, ...] = ()) -> Program:
        """Start a site, and wait until it listens."""
        self._meeting(name).unlink(missing_ok=True)
        options = (*options, *(option for endpoint in connect for option in ("--connect", endpoint)))
        site = self.selfconf("site", *paths, "--ecology", self.ecology, "--name", name, *options)
        assert self.until(lambda: self._meeting(name).exists() or site.over), site.complaints
        assert not site.over, site.complaints
        return site

    def components(self, *names: str, connect: tuple[str, ...] = ()) -> Program:
        """Start components as one process, and wait until all of them live."""
        options = [option for endpoint in connect or (self.endpoint(),) for option in ("--connect", endpoint)]
        command = (sys.executable, COMPONENTS, ",".join(names), "--ecology", self.ecology)
        program = self.program(*command, *options)
        profiles = [component_of(name) for name in names]
        assert self.until(lambda: program.over or all(self.state(c) is not None for c in profiles)), program.complaints
        assert not program.over, program.complaints
        return program

    def run(self, *arguments: str) -> Program:
        """Start a configurator for the paper's task."""
        return self.selfconf(
            "run",
            "navigate.ttl",
            *("--bind", "robot=:Astrid", "--bind", "goal=(AT BEDROOM)"),
            *("--ecology", self.ecology, "--format", "json"),
            *arguments,
        )

    def _meeting(self, name: str) -> Path:
        return self.runtime / f"{self.ecology}@{name}.json"

    def endpoint(self, name: str | None = None) -> str:
        """Where a site listens; the first one's if none is named."""
        path = self._meeting(name) if name else min(self.runtime.glob("*.json"))
        endpoint: str = json.loads(path.read_text())["endpoint"]
        return endpoint

    @property
    def protocol(self) -> str:
        """What links speak."""
        return "tcp" if self.authority is None else "tls"

    @property
    def anywhere(self) -> str:
        """An endpoint on any free port of loopback."""
        return f"{self.protocol}/127.0.0.1:0"

    def arguments(self) -> tuple[str, ...]:
        """The options by which a command in this process finds the ecology."""
        return "--ecology", self.ecology, "--connect", self.endpoint()

    def credentials(self, kind: PrincipalKind = PrincipalKind.CONFIGURATOR) -> Credentials | None:
        """What a program of this process shows."""
        return None if self.authority is None else self.authority.credentials((kind,))

    def node(self) -> ZenohBus:
        """A client of the sites, which may do what a configurator may."""
        endpoints = [json.loads(path.read_text())["endpoint"] for path in sorted(self.runtime.glob("*.json"))]
        shown = self.credentials()
        bus = client(endpoints, credentials=shown)
        if shown is not None:
            introduce(bus, self.ecology, shown)
        return bus

    @contextmanager
    def mute_configurator(self) -> Iterator[str]:
        """A configurator that lives and does not answer meanwhile; its name."""
        name = Membership(self.ecology, (), self.credentials()).configurator_name() or "mute"
        node = self.node()
        try:
            node.announce(self.keys.configurator_life(name, "1"))
            yield name
        finally:
            node.close()

    # Observing.

    def left_behind(self) -> list[str]:
        """What is in the runtime folder, but for the key with which sites issue to components, which stays."""
        return sorted(path.name for path in self.runtime.iterdir() if not path.name.startswith(HOST_AUTHORITY))

    def ask(self, key: str, payload: bytes = b"", seconds: float = 10.0) -> Replies:
        """Ask the ecology something."""
        if self._bus is None or not self._bus.link:
            if self._bus is not None:
                self._bus.close()
                self._bus = None
            try:
                self._bus = self.node()
            except NetworkError:  # the hub is opened anew
                return Replies()
        replies: list[Replies] = []
        self._bus.ask(key, payload, seconds, replies.append)
        bus = self._bus
        deadline = time.monotonic() + PATIENCE
        while not replies and time.monotonic() < deadline:
            bus.poll(0.05)
        return replies[0] if replies else Replies()

    def state(self, component: IRI) -> CallAnswer | None:
        """What a component says of itself, if it answers."""
        for sample in self.ask(self.keys.call(component, "state"), seconds=1.0).samples:
            try:
                return decode(sample.payload, CallAnswer)
            except PeerError:
                return None
        return None

    def active(self, *names: str) -> set[str]:
        """Which of these components act."""
        answers = {name: self.state(component_of(name)) for name in names}
        return {name for name, answer in answers.items() if answer is not None and answer.active}

    def until(self, condition: Callable[[], bool], seconds: float = PATIENCE) -> bool:
        """Wait for a condition, until a deadline."""
        deadline = time.monotonic() + seconds
        moment = threading.Event()
        while not condition():
            if time.monotonic() > deadline:
                return False
            moment.wait(0.02)
        return True

    def close(self) -> None:
        """End everything that was started; what it has said is shown with a test that has failed."""
        if self._bus is not None:
            self._bus.close()
        for program in self._programs:
            program.read_what_is_there()
        for program in reversed(self._programs):
            program.end(signal.SIGKILL)
        for program in self._programs:
            print(program.account)


def component_of(name: str) -> IRI:
    """The component with an advertisement of that name."""
    return iri(
        {
            "sonar": "sonar-array",
            "encoder": "wheels",
            "tracker": "person-tracker",
            "odometry": "absolute-odometry",
            "control": "thinking-cap",
            "drive": "astrid-drive",
            "pippi": "pippi-drive",
        }[name]
    )


def dormant(home: Home, name: str, names: str = "") -> None:
    """Let the site of a component start it, in a process of its own, or of several components."""
    command = f"python {home.folder}/components.py {names or name}"
    (home.folder / "ads" / f"{name}.ttl").write_text(
        PREFIXES + ADVERTISEMENTS[name].rstrip(" .") + f' ; sc:grounding [ sc:command "{command}" ] .\n'
    )
