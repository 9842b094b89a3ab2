"""Histories in which everything goes wrong, each decided by its script, which is made from a seed.

A history plays the actions of a script in an ecology, the paper's or one with operations and a composite, on a network
that loses, delays and doubles messages:
components fail, crash, come back, are started twice, are slow; nodes are paused, cut off, or cut off from one other;
sites and configurators die and come back; several tasks compete. At every step of the network the invariants of
`tests/faults/invariants.py` are looked at. Then the faults cease, every node reaches every other, and after a while the
ecology must be in order (`final_invariants`).

A history that breaks an invariant fails its test, and the message shows what happened, in order, and the command that
plays it again and drops every action that is not needed (`tests.faults.replay`).
"""

from __future__ import annotations

import traceback
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import wraps
from itertools import chain
from pathlib import Path
from typing import Any, TypeVar
from unittest import mock

from selfconf.bus.memory import Faults, MemoryBus
from selfconf.composites import InsideOfComposite
from selfconf.deployment import TaskRunner
from selfconf.deployment.retries import LONGEST_PAUSE
from selfconf.discovery import ecology_view
from selfconf.model.profile import CALL_MARK
from selfconf.model.term import IRI
from selfconf.protocol.activation import Activation
from selfconf.protocol.messages import Wire
from selfconf.sdk.inputs import Inputs
from selfconf.sdk.program import HUNG_ENDS
from selfconf.sdk.runtime import ComponentRuntime, control_calls
from selfconf.site import Site
from tests.faults.actions import Actions
from tests.faults.harsh import KINDS as HARSH
from tests.faults.harsh import calm, promising
from tests.faults.script import Action, Script
from tests.faults.simulated_code import SimulatedCodeThread, SimulatedComponentCode
from tests.faults.simulated_processes import SimulatedProcesses
from tests.lab import Lab, Recorder

SETTLED = 75.0
"""Seconds after the last fault in which the ecology must come into order."""
QUIET = 10.0
"""Seconds in which everything comes that comes again and again, as audits and calls that are repeated."""
SPOKEN = 1.0
"""Seconds in which everybody must have heard what was said last."""
ASKED = "asked"
"""What a component writes down when it calls an operation at the end of a history."""
LOOKED_AGAIN = 1.0
"""Seconds that a task which waits may take to look again, as it does from time to time: it is undecided meanwhile."""
TURNS = 3
"""How often everybody speaks at most in the end, until every task is decided meanwhile, and stays as it is."""


Found = TypeVar("Found")


def looked_up_once(look_up: Callable[[History], Found]) -> Callable[[History], Found]:
    """Keep what is found in a history for as long as this stands still."""

    @wraps(look_up)
    def find(history: History) -> Found:
        known = history.known
        if known is None:
            return look_up(history)
        if find not in known:
            known[find] = look_up(history)
        found: Found = known[find]
        return found

    return find


def startable(advertisement: str) -> str:
    """An advertisement with a command, by which its site can start the component."""
    return advertisement.removesuffix(".") + '; sc:grounding [ sc:command "simulated" ] .'


@dataclass(slots=True)
class Life:
    """One process of a component: its runtime, its code and its node."""

    name: str
    runtime: ComponentRuntime
    recorder: Speaker
    node: MemoryBus
    thread: SimulatedCodeThread
    _held: tuple[Activation | None, bool, Mapping[str, bool]] = field(default=(None, False, {}), repr=False)
    """By whom it is held, and the activation that says so."""

    @property
    def awake(self) -> bool:
        """Whether it lives, and does something with what arrives."""
        return self.node.open and not self.node.paused

    @property
    def component(self) -> IRI:
        """Which component it is a life of."""
        return self.runtime.profile.component

    @property
    def holds(self) -> Mapping[str, bool]:
        """The supervisors of the tasks that hold it, each with whether it acts for it."""
        activation, active = self.runtime.activation, self.runtime.active
        known, acted, held = self._held
        if known is not activation or acted is not active:
            held = {hold.claim.supervisor: hold.active and active for hold in activation.holds}
            self._held = activation, active, held
        return held

    @property
    def followed(self) -> set[tuple[str, Wire]]:
        """Which output each input follows; none of a composite, of which others do."""
        inputs = self.runtime.inputs
        return inputs.followed if isinstance(inputs, Inputs) else set()


def nothing() -> int:
    """No memory at all."""
    return 0


class Speaker(Recorder):
    """A component that issues signals while it acts, each so many seconds after the last, or one as it starts."""

    def __init__(self, period: float | None, at_once: bool = False) -> None:
        super().__init__()
        self._period, self._at_once = period, at_once
        self.hushed = False
        """Whether it issues nothing, though it acts."""
        self.started_at = 0.0
        """When it was started last."""

    def started(self) -> None:
        self.started_at = self._runtime.bus.now() if self._runtime is not None else 0.0
        super().started()
        if self._period is not None:
            self.every(self._period, self._speak)
        if self._at_once and not self.hushed:
            self.say_last()

    def say_last(self) -> None:
        """Issue what nothing follows."""
        runtime = self._runtime
        for output in runtime.profile.signal_outputs if runtime is not None else ():
            self.emit(output.name, f"the last of {runtime.life}")

    def _speak(self) -> None:
        runtime = self._runtime
        for output in runtime.profile.signal_outputs if runtime is not None and not self.hushed else ():
            self.emit(output.name, runtime.bus.now())


class History:
    """A script that is played; `broken` says what was not as it must be, and when."""

    def __init__(self, script: Script, folder: Path) -> None:
        from tests.faults.harsh_actions import HarshActions
        from tests.faults.watch import Watch

        self.script = script
        ecology = script.ecology
        advertised = {
            name: startable(text) if name in script.startable else text for name, text in ecology.advertisements.items()
        }
        if script.promised:
            advertised = {name: promising(text) for name, text in advertised.items()}
        self.lab = Lab(folder, script.seed, script.faults, advertised, still=True)
        self.network = self.lab.network
        self.told: list[str] = []
        self.processes: list[Life] = []
        """The lives of components that are processes, those that are over too."""
        self.sites: dict[str, Site] = {}
        self.tasks: dict[str, TaskRunner] = {}
        self.begun: list[TaskRunner] = []
        """Every configurator that was begun, the dead ones too."""
        self._nodes: dict[str, MemoryBus] = {}
        self.isolated: set[str] = set()
        """The components, sites and tasks that are cut off from all others."""
        self.powerless: list[MemoryBus] = []
        """The nodes of hosts that have lost their power, which others notice later."""
        self.ceased = False
        """Whether nothing goes wrong any more."""
        self.done: Counter[str] = Counter()
        """How many actions of each kind were possible."""
        self._actions, self._harsh = Actions(self), HarshActions(self)
        self.known: dict[Callable[[History], object], Any] | None = None
        """What was looked up while the history stands still; None while it goes on."""
        for name in ecology.sites:
            self.begin_site(name)
        for name in ecology.processes:
            if name not in script.startable:
                self.begin_life(name)
        self.watch = Watch(self)
        self.network.stepped = self.watch.look

    @property
    def agents(self) -> list[TaskRunner]:
        """The configurators of tasks, which may have died."""
        return self.begun

    @property
    def broken(self) -> list[str]:
        """What was not as it must be, and when."""
        return self.watch.broken

    def run(self) -> None:
        """Play the script, then let nothing go wrong any more; what breaks in a program is an invariant too."""
        try:
            with (
                mock.patch.object(ecology_view, "MANY_LIVES", 0 if self.script.large else ecology_view.MANY_LIVES),
                # All components are in this process: what memory it takes is news to nobody.
                mock.patch.object(control_calls, "resident_memory", nothing),
            ):
                self._play()
        except Exception:
            self.watch.note("nothing breaks", traceback.format_exc(limit=-4))

    def _play(self) -> None:
        if self.script.stormy:
            self.network.faults = calm(self.script.faults)
        for action in self.script.actions:
            self.lab.let_pass(max(0.0, action.time - self.network.time))
            if self.perform(action):
                self.told.append(str(action))
                self.done[action.kind] += 1
        self._cease()
        self._come_to_an_end()
        if self.script.mended:
            self._mend_all()
            self._come_to_an_end()

    def _come_to_an_end(self) -> None:
        """Let everything come into order, everybody speak, and look at what must hold in the end."""
        self._come_into_order()
        for _ in range(TURNS):
            self._let_be_decided()
            epochs = [agent.state.epoch for agent in self.agents]
            self._speak()
            self.lab.let_pass(SPOKEN)
            self._ask_all()
            self.lab.let_pass(SPOKEN)
            if self.watch.all_decided() and epochs == [agent.state.epoch for agent in self.agents]:
                break
        self.watch.end()

    def _come_into_order(self) -> None:
        """Let pass what time that may take; less where all that is still to come has come before, and changed nothing.

        That is so after two quiet stretches at the ends of which nothing waits that comes later than in a third: what
        waited at the end of the first has come in the second. Every fifth history lasts to the end all the same.
        """
        end, quiet = self.network.time + SETTLED, 0
        while self.network.time < end and (quiet < 2 or self.script.seed % 5 == 0):
            self.lab.let_pass(min(QUIET, end - self.network.time))
            later = any(self.network.time + QUIET < event[0] <= end for event in self.network._events)
            quiet = 0 if later or not self.watch.is_quiet(QUIET) else quiet + 1

    def _let_be_decided(self) -> None:
        """Let time pass until no task is being started, as long as that may take.

        What takes too long to start is tried again by each task that waits, in turns, and after longer and longer
        pauses: there is not always one after the other before these have grown.
        """
        slowest = max((life.recorder.slow for life in self.lives), default=0.0)
        turns = LONGEST_PAUSE + 2 * slowest * len(self.living()) if slowest else 0.0
        self.lab.until(self.watch.all_decided, LOOKED_AGAIN + turns)

    def _mend_all(self) -> None:
        """Have every component and every site live, and be able to act; those that were lost begin another life."""
        self.told.append(f"{self.network.time:8.3f}  everything is mended")
        for name in self.script.ecology.sites:
            if self.node(name) is None:
                self.begin_site(name)
        for life in self.processes:
            lost = any(life.component in agent.state.lost for agent in self.agents if self.lab.is_open(agent))
            if lost and not life.runtime.active:
                life.node.close()
            life.recorder.refusal, life.recorder.slow, life.recorder.hushed = None, 0.0, False
        for name in self.script.ecology.processes:
            if name not in self.script.startable and not self.lives_of(name):
                self.begin_life(name)

    def _speak(self) -> None:
        """Let every source that acts say something, unless it has said all as it was started."""
        has_said_all = self.script.ecology.latched and self.script.period is None
        for life in () if has_said_all else self.processes:
            if life.awake and life.runtime.active:
                life.recorder.say_last()

    def _ask_all(self) -> None:
        """Let every component that needs operations call them, but for those whose code is busy."""
        for life in self.processes:
            if life.awake and life.runtime.active and life.thread.busy_until <= self.network.time:
                for needed in life.runtime.profile.needed_operations:
                    life.recorder.said.append((ASKED, needed.name))
                    life.recorder.ask(needed.name.removesuffix(CALL_MARK))

    def perform(self, action: Action) -> bool:
        """Do what an action says, if that is possible; whether it was."""
        if action.kind in HARSH:
            return self._harsh.perform(action)
        return self._actions.perform(action)

    def _cease(self) -> None:
        """Undo what is wrong with the network, and let everybody go on."""
        self.told.append(f"{self.network.time:8.3f}  the faults cease")
        self.ceased = True
        self._harsh.cease()
        self.network.faults = Faults()
        for node in self.powerless:
            node.close()
        nodes = [node for node in self.network.nodes if node.open]
        for node in nodes:
            self.network.resume(node)
        for number, left in enumerate(nodes):
            for right in nodes[:number]:
                self.network.reconnect(left, right)
        self.isolated.clear()

    # What there is.

    @contextmanager
    def standing_still(self) -> Iterator[None]:
        """Look up only once what is asked for several times, while nothing happens."""
        self.known = {}
        try:
            yield
        finally:
            self.known = None

    @property
    @looked_up_once
    def lives(self) -> list[Life]:
        """The lives of all components, with those of the composites that live now."""
        return [*self.processes, *self.composites()]

    def composites(self) -> Iterator[Life]:
        """The composites that live now: what they do themselves is nothing, and takes no time."""
        for site, composites in self.lab.composites.items() if self.script.ecology.composites else ():
            node = self.node(site) if composites.living else None
            for inside in composites.living.values() if node is not None else ():
                assert node is not None
                thread = SimulatedCodeThread(node, inside.runtime.hung)
                yield Life(inside.profile.component.short, inside.runtime, Speaker(None), node, thread)

    def insides(self) -> Iterator[InsideOfComposite]:
        """The composites that live now, with what they are inside."""
        for site, composites in self.lab.composites.items() if self.script.ecology.composites else ():
            if composites.living and self.node(site) is not None:
                yield from composites.living.values()

    @looked_up_once
    def living(self) -> list[TaskRunner]:
        """The configurators that have not died, those inside of composites too."""
        runners = [inside.runner for inside in self.insides() if inside.runner is not None]
        return [agent for agent in chain(self.agents, runners) if self.lab.is_open(agent)]

    def life(self, name: str) -> Life | None:
        """The latest life of a component, if it has not ended."""
        return next(reversed(self.lives_of(name)), None)

    def lives_of(self, name: str) -> list[Life]:
        """All lives of a component that have not ended, the latest last."""
        on = (life for life in self.processes if life.node.open and life.node not in self.powerless)
        return [life for life in on if life.name == name]

    def node(self, who: str) -> MemoryBus | None:
        """The node of a component, a site or a task, if it is there."""
        node = self._nodes.get(who)
        return node if node is not None and node.open else None

    def joined(self, who: str, node: MemoryBus) -> None:
        """The node of a component, a site or a task has come: it does not reach what is cut off."""
        self._nodes[who] = node
        self.isolated.discard(who)
        for other in self.isolated:
            lone = self.node(other)
            if lone is not None:
                self.network.cut(node, lone)
        self._harsh.joined(node)

    def leave(self, who: str) -> None:
        """Have what is done to a task from now on be done to another one of its name, and not to this one."""
        del self._nodes[who]

    def begin_site(self, name: str) -> None:
        """Let a site live, on a node of its own."""
        site = self.lab.site(name, *self.script.ecology.sites[name])
        self.sites[name] = site
        assert isinstance(site.bus, MemoryBus)
        names = {self.lab.profile(one).component: one for one in self.script.ecology.processes}
        processes: Any = SimulatedProcesses(self, site.bus, names)
        site.processes = processes
        self.joined(name, site.bus)

    def begin_life(self, name: str) -> Life:
        """Let a component live, on a node of its own; one that has to leave later leaves with its node."""
        node = self.network.node()
        recorder = Speaker(self.script.period, self.script.ecology.latched)

        def hung(why: str) -> None:
            runtime.hung(why)
            if self.script.hangs_on and name not in self.script.startable:
                return
            for share in (0.25, 0.75):  # so that it is looked what has become of it
                self.network.after(share * HUNG_ENDS, lambda: None)
            self.network.after(HUNG_ENDS, node.close)

        thread = SimulatedCodeThread(node, hung)
        recorder.spend = thread.spend
        runtime = ComponentRuntime(
            node,
            self.lab.keys,
            self.lab.profile(name),
            recorder,
            f"{name}{node.number}",
            thread,
            superseded=lambda reason: node.close(),
        )
        SimulatedComponentCode.simulate(runtime.code, node, thread)
        recorder.served = lambda operation, caller: self.watch.served(runtime, operation, caller)
        self.processes.append(Life(name, runtime, recorder, node, thread))
        self.joined(name, node)
        return self.processes[-1]

    def begin_process(self, name: str, begun: Callable[[MemoryBus | None], None]) -> None:
        """Start a process of a component; it ends at once if it sees another one. `begun` hears of its node, if any."""
        scout = self.network.node()
        for other in self.isolated:
            lone = self.node(other)
            if lone is not None:
                self.network.cut(scout, lone)

        def called(lives: tuple[str, ...]) -> None:
            scout.close()
            begun(None if lives else self.begin_life(name).node)

        scout.roll_call(self.lab.keys.lives(self.lab.profile(name).component), 1.0, called)

    def try_to_begin(self, name: str, attempts: int = 8) -> None:
        """Start a process of a component, and again if another one seems to live, but does not."""

        def begun(node: MemoryBus | None) -> None:
            if (
                node is None
                and attempts > 1
                and all(not life.node.open for life in self.processes if life.name == name)
            ):
                self.network.after(1.0, lambda: self.try_to_begin(name, attempts - 1))

        self.begin_process(name, begun)
