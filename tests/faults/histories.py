"""Histories in which everything goes wrong, each replayed by its seed.

A history runs the paper's ecology on a network that loses, delays and doubles messages, while components fail, crash
and come back, nodes are cut off, and configurators die. Then the faults cease, every node reaches every other, and
after a while the ecology must be in order: `disorder` names everything that is not.

*Replaying a failure.* A history that ends in disorder fails its test; the first line of the message has its seed, then
comes what happened, in order, and what is not in order. Its seed decides everything in it, the network included, so
`python -m pytest tests/faults --seed N` lets the failure happen again, as long as the code and the list of mishaps in
`run` are unchanged. The test whose name ends in `[0]` then is seed N, the others are the seeds that follow; give its
name to run seed N alone, and add `--log-level DEBUG` to see every change of a configurator's phase:

    python -m pytest --seed N 'tests/faults/test_histories.py::test_after_every_history_the_ecology_is_in_order[0]'
"""

from __future__ import annotations

import random
from collections.abc import Iterator
from pathlib import Path

from selfconf.bus.memory import Faults
from selfconf.configurator.machine import wiring
from selfconf.configurator.state import Phase, Policy
from selfconf.deployment import TaskRunner
from selfconf.model.refusal import Refusal
from selfconf.protocol.messages import Cause
from selfconf.sdk.component import Refused
from selfconf.site import Site
from tests.lab import ADVERTISEMENTS, Lab

SETTLED = 60.0
"""Seconds after which the ecology must be in order again."""
COMPONENTS = sorted(ADVERTISEMENTS)


class History:
    """A seeded history; `told` says what happened, for people who replay it."""

    def __init__(self, seed: int, folder: Path) -> None:
        self.chance = random.Random(seed)
        faults = Faults(
            loss=self.chance.choice((0.0, 0.02, 0.1, 0.3)),
            doubling=self.chance.choice((0.0, 0.1, 0.5)),
            least_delay=0.0005,
            most_delay=self.chance.choice((0.0005, 0.02, 0.2, 1.0)),
        )
        self.told: list[str] = [f"seed {seed}: {faults}"]
        self.lab = Lab(folder, seed, faults)
        self.sites: list[Site] = [
            self.lab.site("living-room", "tracker"),
            self.lab.site("astrid", "sonar", "encoder", "odometry", "control", "drive", "pippi"),
        ]
        for name in COMPONENTS:
            self.lab.component(name)
        self.agents: list[TaskRunner] = []
        self.alone: list[TaskRunner | Site | str] = []
        self.policy = self.chance.choice(list(Policy))
        self.patient = self.chance.random() < 0.7

    def run(self) -> None:
        """Let everything go wrong for a while, and then nothing any more."""
        self._new_configurator()
        for _ in range(self.chance.randint(2, 12)):
            self.lab.let_pass(self.chance.choice((0.0, 0.001, 0.01, 0.1, 0.5, 1.5, 5.0)))
            self.chance.choice(
                (
                    self._fail,
                    self._crash,
                    self._come_back,
                    self._restart,
                    self._restart,
                    self._refuse,
                    self._isolate,
                    self._isolate,
                    self._rejoin,
                    self._emit,
                    self._replace_configurator,
                    self._stop_configurator,
                    self._second_configurator,
                )
            )()
        self.lab.network.faults = Faults()
        while self.alone:
            self._rejoin()
        self._say("the faults cease")
        self.lab.let_pass(SETTLED)

    def disorder(self) -> Iterator[str]:
        """Everything that is not in order."""
        wanted: dict[str, TaskRunner] = {}
        names = {runtime.profile.component: name for name, runtime in self.lab.runtimes.items()}
        for agent in self.living():
            phase = agent.state.phase
            if phase is Phase.RUNNING and agent.configuration is not None:
                for component in agent.configuration.components:
                    if names[component] in wanted:
                        yield f"two configurators hold {names[component]}"
                    wanted[names[component]] = agent
            elif phase not in (Phase.REFUSED, Phase.STOPPED):
                yield f"{agent.name} is still {phase.value}"
            elif phase is Phase.REFUSED and agent.state.patient:
                yield from self._hasty_refusal(agent)
        active = self.lab.active()
        yield from (f"{name} acts for nobody" for name in sorted(active - set(wanted)))
        yield from (f"{name} does not act" for name in sorted(set(wanted) - active))
        for name in sorted(set(wanted) & active):
            yield from self._wrong(name, wanted[name])

    def living(self) -> list[TaskRunner]:
        """The configurators that have not died."""
        return [agent for agent in self.agents if self.lab.is_open(agent)]

    def _wrong(self, name: str, agent: TaskRunner) -> Iterator[str]:
        """What is wrong with a component that acts for a configurator."""
        runtime, configuration = self.lab.runtimes[name], agent.configuration
        assert configuration is not None
        hold = runtime.activation.hold(agent.identity.task)
        if hold is None or hold.claim.supervisor != agent.supervisor:
            yield f"{name} obeys {hold}"
        wires = wiring(configuration)[runtime.profile.component]
        wanted = {(port, wire.component, wire.output) for port, followed in wires.items() for wire in followed}
        followed = {(port, wire.component, wire.output) for port, wire in runtime.inputs.followed}
        if wanted != followed:
            yield f"{name} follows {sorted(followed)}, not {sorted(wanted)}"
        said = self.lab.components[name].said
        for setting in configuration.settings:
            if setting.component == runtime.profile.component:
                since = len(said) - said[::-1].index(("stopped",)) if ("stopped",) in said else 0
                if (setting.name, str(setting.value)) not in said[since:]:
                    yield f"{name} was not told its {setting.name}"

    def _hasty_refusal(self, agent: TaskRunner) -> Iterator[str]:
        """A refusal that is waited out must still be right."""
        alive = {
            runtime.profile.component for name, runtime in self.lab.runtimes.items() if self.lab.node_of(name).open
        }
        found = {c: a for site in self.sites for c, a in site.shelf.advertisements.items() if c in alive}
        if not isinstance(agent.request.compose(found, frozenset(agent.state.lost), None), Refusal):
            yield f"{agent.name} has given up, although there is a configuration"
        free = {
            runtime.profile.component for runtime in self.lab.runtimes.values() if not runtime.activation.holds
        }
        for component, loss in agent.state.lost.items():
            if component in alive and loss.cause is Cause.CRASH:
                yield f"{agent.name} thinks that {component.short} is dead"
            if component in alive and loss.busy and component in free:
                yield f"{agent.name} thinks that {component.short} is busy"

    # What goes wrong.

    def _say(self, what: str) -> None:
        self.told.append(f"{self.lab.network.time:8.3f}  {what}")

    def _some(self, alive: bool = True) -> str | None:
        names = [name for name in COMPONENTS if self.lab.node_of(name).open == alive]
        return self.chance.choice(names) if names else None

    def _fail(self) -> None:
        name = self._some()
        if name is not None:
            self._say(f"{name} fails")
            self.lab.components[name].fail("seeded")

    def _crash(self) -> None:
        name = self._some()
        if name is not None:
            self._say(f"{name} crashes")
            self.lab.crash(name)

    def _come_back(self) -> None:
        name = self._some(alive=False)
        if name is not None:
            self._revive(name)

    def _restart(self) -> None:
        names = {runtime.profile.component: name for name, runtime in self.lab.runtimes.items()}
        lost = sorted({names[component] for agent in self.living() for component in agent.state.lost})
        name = self.chance.choice(lost or COMPONENTS)
        if self.lab.node_of(name).open:
            self._say(f"{name} is restarted")
            self.lab.crash(name)
            self.lab.let_pass(self.chance.choice((0.0, 0.01, 1.0)))
        self._revive(name)

    def _revive(self, name: str) -> None:
        self._say(f"{name} comes back")
        self.alone = [alone for alone in self.alone if alone != name]
        self.lab.component(name)

    def _refuse(self) -> None:
        name = self._some()
        if name is not None:
            self._say(f"{name} will refuse to start, or will not any more")
            recorder = self.lab.components[name]
            recorder.refusal = None if recorder.refusal else Refused("seeded")

    def _emit(self) -> None:
        name = self._some()
        if name is not None:
            for output in self.lab.runtimes[name].profile.outputs:
                self.lab.components[name].emit(output.name, self.lab.network.time)

    def _isolate(self) -> None:
        candidates: list[TaskRunner | Site | str] = [*self.living(), *self.sites]
        candidates += [name for name in COMPONENTS if self.lab.node_of(name).open]
        who = self.chance.choice(candidates)
        self._say(f"{_name(who)} is cut off")
        self.lab.isolate(who)
        self.alone.append(who)

    def _rejoin(self) -> None:
        if self.alone:
            who = self.alone.pop(self.chance.randrange(len(self.alone)))
            self._say(f"{_name(who)} is reached again")
            self.lab.rejoin(who)

    def _new_configurator(self) -> None:
        agent = self.lab.agent(policy=self.policy, patient=self.patient)
        self._say(f"{agent.name} begins")
        self.agents.append(agent)

    def _replace_configurator(self) -> None:
        for agent in self.living():
            self._say(f"{agent.name} crashes")
            self.alone = [alone for alone in self.alone if alone is not agent]
            self.lab.crash(agent)
        self._new_configurator()

    def _second_configurator(self) -> None:
        if len(self.living()) < 2:
            self._new_configurator()

    def _stop_configurator(self) -> None:
        agents = self.living()
        if len(agents) > 1:
            self._say(f"{agents[0].name} is stopped")
            agents[0].stop()


def _name(who: TaskRunner | Site | str) -> str:
    return who if isinstance(who, str) else who.name
