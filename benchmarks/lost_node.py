"""How long a task is without its source when a node of ROS 2 is killed, beside a component of the SDK, in one run.

    python -m benchmarks.lost_node PROGRAM [--trials 8]

PROGRAM is that of the nodes: `PROGRAM ENDPOINT DOMAIN talker NAME` is a node NAME that publishes texts on /NAME/one,
such as tests/bridging/ros2/judge. All processes are real: a bridge, a site, one node and one component more than there
are trials, and two tasks, which take a source from the nodes and from the components. In turns the source in use of
one task is ended by kill -9; the next one stands by.

    noticed   kill -9 to the moment at which its task gives the source up
    repaired  kill -9 to the moment at which the task runs with the next one, with the search for it
"""

from __future__ import annotations

import argparse
import os
import secrets
import sys
import tempfile
import threading
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import Any, NamedTuple

from benchmarks.failover import PAUSE, Lines, Process
from benchmarks.machine import described, quantile, table
from selfconf.bus.zenoh import router
from selfconf.sdk import Component, Termination, open_host

DOMAIN = 7
TEXT = "https://w3id.org/selfconf/ros2/std_msgs/msg/String"
PREFIXES = """@prefix sc: <https://w3id.org/selfconf#> .
@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix ros2: <https://w3id.org/selfconf/ros2#> .
@prefix : <urn:lost:> .
"""
TASKS = {"nodes": "ros2:Node", "components": ":Source"}
"""The class of the sources of each task."""


class LostSource(NamedTuple):
    """What came of killing a source: seconds until its task gave it up, and until it ran again."""

    noticed: float
    repaired: float


class Source(Component):
    """Emits a text when it is started, as a source that is latched does."""

    def started(self) -> None:
        """A text at once."""
        self.emit("text", {"data": "hello"})


class Sink(Component):
    """Takes texts."""


def advertised(folder: Path, name: str) -> Path:
    """The advertisement of a source, or of the sink of a task."""
    kind = "Source" if name.startswith("source") else f"Sink-{name}"
    end = "sc:hasOutput" if kind == "Source" else "sc:hasInput"
    path = folder / f"{name}.ttl"
    text = f'{PREFIXES}:{name} a sc:Component, :{kind} ; {end} [ sc:name "text" ; sc:signalType <{TEXT}> ] .\n'
    if not path.exists():
        path.write_text(text)
    return path


def act(folder: Path, names: list[str]) -> None:
    """Be some components, until SIGTERM."""
    kinds: list[type[Component]] = [
        type(name, (Source if name.startswith("source") else Sink,), {"advertisement": str(advertised(folder, name))})
        for name in names
    ]
    host = open_host(kinds=kinds)
    for kind in kinds:
        host.add(kind())
    print('{"event": "ready"}', flush=True)
    host.run(Termination(host.bus))
    host.close()


def measure(program: str, trials: int) -> dict[str, list[LostSource]]:
    """What came of the trials of each task."""
    lines = Lines()
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        hub = router()
        hub.run_aside()
        stack.callback(hub.close)
        ecology = f"lost-{secrets.token_hex(3)}"
        where = {"SELFCONF_RUNTIME_DIR": str(folder / "runtime"), "SELFCONF_ECOLOGY": ecology}
        sources = {kind: [f"source-{kind}-{number:02}" for number in range(trials + 1)] for kind in TASKS}

        def start(name: str, *command: str) -> Process:
            process = Process(name, lines.queue, *command, **where)
            stack.callback(process.end)
            return process

        advertisements = [advertised(folder, name) for name in (*sources["components"], *TASKS)]
        start("site", "selfconf", "site", *map(str, advertisements), "--ecology", ecology)
        lines.until(lambda name, fact: name == "site" and " on t" in str(fact))
        start("bridge", "selfconf", "bridge", "ros2", "--connect", hub.endpoint, "--domain", str(DOMAIN))
        living = {}
        for name in sources["nodes"]:
            command = ("benchmarks.lost_node", "--node", program, hub.endpoint, str(DOMAIN), "talker", _node(name))
            living[name] = start(name, *command)
            lines.until(lambda who, fact, name=name: f"/{_node(name)} is here" in str(fact))  # type: ignore[misc]  # bound
        for name in sources["components"]:
            living[name] = start(name, "benchmarks.lost_node", "--act", str(folder), name)
            lines.until(_said(name, "event", "ready"))
        start("sinks", "benchmarks.lost_node", "--act", str(folder), *TASKS)
        lines.until(_said("sinks", "event", "ready"))
        playing = {}
        for kind, source in TASKS.items():
            task = folder / f"task-{kind}.ttl"
            task.write_text(_task(kind, source))
            start(kind, "selfconf", "run", str(task), "--format", "json", "--wait")
            playing[kind] = _source(lines.until(_said(kind, "act", "running"))[-1][1])
        found: dict[str, list[LostSource]] = {kind: [] for kind in TASKS}
        for _ in range(trials):
            for kind in TASKS:
                threading.Event().wait(PAUSE)
                killed = living[playing[kind]].kill()
                facts = [fact for name, fact in lines.until(_said(kind, "act", "running")) if name == kind]
                lost = next(fact for fact in facts if fact["act"] == "lost")
                found[kind].append(LostSource(lost["time"] - killed, facts[-1]["time"] - killed))
                playing[kind] = _source(facts[-1])
        return found


def _node(source: str) -> str:
    """The name of a node in ROS 2, which has no dashes."""
    return source.replace("-", "_")


def _task(kind: str, source: str) -> str:
    return f"""{PREFIXES}:task a sc:Template ; sc:roles ( :source :sink ) .
:source a sc:Role ; sh:class {source} ; sc:feeds :sink .
:sink a sc:Role ; sh:class :Sink-{kind} .
"""


def _source(running: dict[str, Any]) -> str:
    """The name of the source that plays, by what is said to run."""
    roles = {role["role"].rpartition(":")[2]: role["components"] for role in running["configuration"]["roles"]}
    (player,) = roles["source"]
    return str(player).replace("/", ":").rpartition(":")[2].replace("_", "-")


def _said(process: str, key: str, value: str) -> Callable[[str, Any], bool]:
    return lambda name, fact: name == process and isinstance(fact, dict) and fact.get(key) == value


def report(found: dict[str, list[LostSource]]) -> str:
    """The table, and the ratio of both medians."""
    rows = []
    for kind, trials in found.items():
        for part in LostSource._fields:
            values = [getattr(one, part) * 1000 for one in trials]
            rows.append([f"{kind}, {part}", f"{quantile(values, 0.5):.2f}", f"{quantile(values, 0.95):.2f}"])
    return f"{table(['', 'median ms', '95 % ms'], rows)}\n\nnodes / components, repaired: {ratio(found):.2f} (medians)"


def ratio(found: dict[str, list[LostSource]]) -> float:
    """How much longer a repair takes where a node is lost: the ratio of the medians."""
    nodes, components = (quantile([one.repaired for one in found[kind]], 0.5) for kind in TASKS)
    return nodes / components


def main() -> None:
    """Measure and print, or be one of the processes."""
    parser = argparse.ArgumentParser(description="kill -9 of a node of ROS 2, beside that of a component")
    parser.add_argument("program", nargs="?")
    parser.add_argument("--trials", type=int, default=8)
    parser.add_argument("--act", nargs="+", metavar=("FOLDER", "NAME"), help=argparse.SUPPRESS)
    parser.add_argument("--node", nargs=argparse.REMAINDER, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.act:
        act(Path(given.act[0]), given.act[1:])
    elif given.node:
        os.execv(given.node[0], given.node)  # so that it is the node that is killed
    elif given.program is None:
        sys.exit("name the PROGRAM of the nodes")
    else:
        found = measure(given.program, given.trials)
        print(f"{report(found)}\n\n{given.trials} trials of each; {described('eclipse-zenoh')}")


if __name__ == "__main__":
    main()
