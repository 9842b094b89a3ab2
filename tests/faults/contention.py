"""Tasks that begin at once and want components that they share, in opposite order of their needs.

    python -m tests.faults.contention [--runs 1000]

plays as many contentions in simulated time, of two to eight tasks that wait, half of them with priorities, and prints
what they came to. The exit code is 1 if in one of them an actuator acted on a part of its configuration.
"""

from __future__ import annotations

import argparse
import random
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median

from selfconf.bus.memory import Faults
from selfconf.configurator.state import Phase
from selfconf.deployment import TaskRunner
from tests.lab import PREFIXES, Lab, Recorder

SENSORS, DRIVES = 4, 3


def advertisements() -> dict[str, str]:
    """Sensors with a parameter, so that no two tasks can share one, and drives that each follow one of them."""
    sensors = {
        f"sensor{number}": f":sensor{number} a sc:Component, :Sensor{number} ;"
        ' sc:hasOutput [ sc:name "out" ; sc:signalType :Signal ] ;'
        ' sc:hasParameter [ sc:name "mode" ; sc:parameterType :Mode ] .'
        for number in range(SENSORS)
    }
    drives = {
        f"drive{number}": f":drive{number} a sc:Component, :Drive ;"
        ' sc:hasInput [ sc:name "in" ; sc:signalType :Signal ] .'
        for number in range(DRIVES)
    }
    return {**sensors, **drives}


def template(sensors: Sequence[int], name: str) -> str:
    """A task that needs some sensors and a drive, in the order given."""
    roles = " ".join([*(f":role{number}" for number in sensors), ":drive-role"])
    lines = [f":{name} a sc:Template ; sc:roles ( {roles} ) ."]
    lines += [
        f":role{number} a sc:Role ; sh:class :Sensor{number} ; sc:feeds :drive-role ;"
        f' sc:sets [ sc:parameterType :Mode ; sc:value "{name}" ] .'
        for number in sensors
    ]
    return PREFIXES + "\n".join([*lines, ":drive-role a sc:Role ; sh:class :Drive ."])


@dataclass(slots=True)
class Settled:
    """What came of a contention: who runs, after how many seconds, and when an actuator acted on a part."""

    running: list[str]
    refused: list[str]
    waiting: list[str]
    undecided: list[str]
    seconds: float
    """When the number of running tasks changed last."""


class Observed(Recorder):
    """A component whose start is looked at."""

    def __init__(self, name: str, contention: Contention) -> None:
        super().__init__()
        self._name, self._contention = name, contention

    def started(self) -> None:
        super().started()
        self._contention.network.after(0.0, lambda: self._contention.started(self._name))


class Contention:
    """Several tasks that begin at once, decided by a seed."""

    def __init__(self, seed: int, folder: Path, tasks: int, patient: bool, priorities: bool) -> None:
        self.chance = random.Random(seed)
        faults = Faults(most_delay=self.chance.choice((0.0005, 0.005, 0.02)))
        self.lab = Lab(folder, seed, faults, advertisements(), still=True)
        self.network = self.lab.network
        self.shelf = self.lab.site("shared", *advertisements()).shelf
        self.agents: list[TaskRunner] = []
        self.wrong: list[str] = []
        """When an actuator acted on a part of its configuration, or before what feeds it."""
        for name in advertisements():
            self.lab.component(name, Observed(name, self))
        self._runtimes = {runtime.profile.component: runtime for runtime in self.lab.runtimes.values()}
        self.network.stepped = self._look
        for number in range(tasks):
            wanted = self.chance.sample(range(SENSORS), self.chance.randint(1, SENSORS))
            self.begin(number, wanted, patient, self.chance.choice((0, 0, 1, 2)) if priorities else 0)

    def begin(self, number: int, wanted: Sequence[int], patient: bool, priority: int) -> None:
        """Begin a task that needs some sensors and a drive."""
        agent = self.lab.agent(
            template(wanted, f"task{number}"), (), patient=patient, name=f"task{number}", priority=priority
        )
        self.agents.append(agent)

    def settle(self, seconds: float = 8.0) -> Settled:
        """Let time pass until every task runs, waits or is refused, and stays so."""
        began, last = self.network.time, 0.0
        running: set[str] = set()
        while self.network.time < began + seconds:
            self.lab.let_pass(0.01)
            now = {agent.name for agent in self.agents if agent.state.phase is Phase.RUNNING}
            if now != running:
                running, last = now, self.network.time - began
        named = {
            phase: [agent.name for agent in self.agents if agent.state.phase is phase]
            for phase in (Phase.RUNNING, Phase.STOPPED, Phase.REFUSED)
        }
        decided = {name for names in named.values() for name in names}
        patient = [agent.name for agent in self.agents if agent.state.patient]
        return Settled(
            named[Phase.RUNNING],
            [name for name in named[Phase.REFUSED] if name not in patient],
            [name for name in named[Phase.REFUSED] if name in patient],
            [agent.name for agent in self.agents if agent.name not in decided],
            last,
        )

    def started(self, name: str) -> None:
        """A component is started: what feeds it must act."""
        runtime = self.lab.runtimes[name]
        for _, wire in runtime.inputs.followed:
            source = next(one for one in self.lab.runtimes.values() if one.profile.component == wire.component)
            if not source.active:
                self.wrong.append(f"{self.network.time:.4f} {name} is started before {wire.component.short}")

    def _look(self) -> None:
        """No component is held for two tasks, no actuator acts while a part of its configuration is not held."""
        for name, runtime in self.lab.runtimes.items():
            if len(holds := runtime.activation.holds) > 1:
                tasks = " and ".join(hold.claim.task for hold in holds)
                self.wrong.append(f"{self.network.time:.4f} {name} is held for {tasks}")
        for agent in self.agents:
            configuration = agent.configuration
            if configuration is None:
                continue
            task = agent.identity.task
            for component in configuration.components:
                runtime = self._runtimes[component]
                hold = runtime.activation.hold(task)
                if runtime.profile.outputs or hold is None or not hold.active or not runtime.active:
                    continue
                for part in configuration.components:
                    if self._runtimes[part].activation.hold(task) is None:
                        self.wrong.append(
                            f"{self.network.time:.4f} {component.short} acts for {task} without {part.short}"
                        )


def main() -> int:
    """Play contentions, and print a row for each number of tasks; times in milliseconds of the simulated network."""
    parser = argparse.ArgumentParser(prog="python -m tests.faults.contention", description="tasks that begin at once")
    parser.add_argument("--runs", type=int, default=1000)
    given = parser.parse_args()
    found: dict[int, list[tuple[float, float, bool]]] = {size: [] for size in range(2, 9)}
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(given.runs):
            size, ranked = 2 + seed % 7, seed % 2 == 0
            alone = Contention(seed, Path(folder), 1, True, ranked).settle(1.0).seconds
            contention = Contention(seed, Path(folder), size, True, ranked)
            settled = contention.settle(4.0)
            if contention.wrong or settled.undecided or not settled.running:
                print(f"seed {seed}, {size} tasks: {settled} {contention.wrong[:3]}", file=sys.stderr, flush=True)
            found[size].append((alone, settled.seconds, bool(contention.wrong)))
    print("| tasks | runs | alone | settled | beyond that | beyond, 95 % | actuators on a part |")
    print("|---|---|---|---|---|---|---|")
    for size, runs in found.items():
        beyond = sorted(settled - alone for alone, settled, _ in runs)
        times = (median(one[0] for one in runs), median(one[1] for one in runs), median(beyond))
        shown = [f"{1000 * seconds:.0f}" for seconds in (*times, beyond[int(0.95 * (len(beyond) - 1))])]
        print(f"| {' | '.join([str(size), str(len(runs)), *shown, str(sum(one[2] for one in runs))])} |")
    return 1 if any(wrong for runs in found.values() for *_, wrong in runs) else 0


if __name__ == "__main__":
    sys.exit(main())
