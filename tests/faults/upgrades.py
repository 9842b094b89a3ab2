"""What must hold when tasks change to components that their strategy would rather have.

A change for the better is made before what ran is let go of. So while it goes on, an input that was fed is fed; what
runs before and after it does not stop; and where it comes to nothing, what ran runs on, unless that has suffered as
well. In the end, when nothing fails any more, every task runs with the best that there is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

from selfconf.configurator.state import Phase, State
from selfconf.deployment import TaskRunner
from selfconf.model.configuration import Configuration
from selfconf.model.term import IRI
from selfconf.protocol.activation import ActivationPhase
from selfconf.protocol.messages import Cause
from selfconf.rdf.advertisements import Advertisement
from selfconf.sdk.inputs.followed_output import JUST_COME
from selfconf.sdk.inputs.handover import HANDOVER
from selfconf.sdk.inputs.inputs import Inputs
from tests.faults.final_invariants import disagreeing
from tests.faults.histories import History, Life
from tests.faults.invariants import Invariant, acting, awake, feeds, node_of

STAYS, GOES_ON = "a failed upgrade leaves what ran", "what runs on does not stop"
DELIVERS = "what is new delivers first"
NOTED = (STAYS, GOES_ON, DELIVERS)
"""What is noted of an upgrade: that it has come to neither configuration, that it has stopped what both have, and that
an input has let go of an output that had issued signals, for others that have issued none."""


def starves(history: History) -> Iterator[str]:
    """An input that was fed before an upgrade is fed while it goes on, if what fed it, and what is to, have not failed.

    An input without any of these is told of; not one that follows an output which has failed since it delivered, nor
    one that a composite feeds which is being repaired inside, or which has not said yet what stands behind it.
    """
    for agent in history.agents:
        before = agent.state.fallback
        for life in acting(history) if before is not None and history.lab.is_open(agent) else ():
            if life.holds.get(agent.supervisor) and isinstance(life.runtime.inputs, Inputs):
                assert before is not None
                yield from _starving(history, agent, before, life)


def _starving(history: History, agent: TaskRunner, before: Configuration, life: Life) -> Iterator[str]:
    for port in life.runtime.profile.signal_inputs:
        old = sources(before, life.component, port.name)
        if not history.watch.upgrades.has_followed(agent, life, port.name):
            continue
        followed = [wire.component for name, wire in life.followed if name == port.name]
        if not old or not all(delivers(history, source, life) for source in old):
            continue
        if not any(feeds(history, source, life) or _is_lost(history, agent, source, life) for source in followed):
            yield f"{life.name} follows {[one.short for one in followed]} by {port.name} during an upgrade"


def delivers(history: History, source: IRI, sink: Life) -> bool:
    """Whether a component feeds an input; a composite does not while its inside is configured again."""
    insides = [inside.runner for inside in history.insides() if inside.profile.component == source]
    return feeds(history, source, sink) and all(
        runner is not None and runner.state.phase is Phase.RUNNING for runner in insides
    )


def _is_lost(history: History, agent: TaskRunner, component: IRI, sink: Life) -> bool:
    """Whether a component has failed, ended, let go of a task, or is out of reach."""
    return not any(
        life.component == component
        and history.network.reaches(life.node, sink.node)
        and life.runtime.activation.phase is not ActivationPhase.FAILED
        and agent.supervisor in life.holds
        for life in awake(history)
    )


def worse_than_need_be(history: History) -> Iterator[str]:
    """A task that changes for the better runs with what its strategy would rather have, of what lives and is free.

    What it holds it may keep though the site is gone that has advertised it. Where a component takes too long to start,
    tasks take turns with it, and what is free is so for a moment.
    """
    if any(life.recorder.slow for life in history.lives):
        return
    alive = {life.component for life in history.lives if life.node.open}
    found: dict[bool, dict[IRI, Advertisement]] = {True: {}, False: {}}
    """What lives, by whether its site is there."""
    for name, site in history.sites.items():
        some = found[history.node(name) is not None]
        some.update((one, advertised) for one, advertised in site.shelf.advertisements.items() if one in alive)
    for agent in history.agents:
        state = agent.state
        if agent.request.upgrade is None or state.phase is not Phase.RUNNING or not history.lab.is_open(agent):
            continue
        taken = {
            life.component
            for life in history.lives
            for hold in life.runtime.activation.holds
            if hold.claim.task != state.task and not life.runtime.profile.is_shareable
            if life.node.open and hold.claim.priority >= state.priority
        }
        broken = {component for component, loss in state.lost.items() if loss.cause is not Cause.CRASH}
        kept = {one: advertised for one, advertised in found[False].items() if one in state.held}
        better = agent.request.compose({**kept, **found[True]}, frozenset(taken | broken), None)
        assert state.target is not None
        if not isinstance(better, Configuration) or disagreeing(history, agent, better):
            continue
        if (better.assignments, better.recruits) != (state.target.assignments, state.target.recruits):
            rather = sorted(one.short for one in {*better.components} - {*state.target.components})
            yield f"{agent.name} runs without {rather}"


SAID_OUTSIDE = 0.05
"""Seconds from when a composite runs again inside until those whom it feeds have been told what they are to follow, on
a quick network, where it says so once more if a message is lost."""


def until_said_outside(history: History) -> float:
    """How long that may take: the composite says so to its task, which asks it, is answered, and calls them."""
    return max(SAID_OUTSIDE, 4 * history.script.faults.most_delay) if history.script.ecology.composites else 0.0


STEPS = (Invariant("an upgrade starves nobody", starves, until_said_outside),)
ENDS = (Invariant("the better is reached", worse_than_need_be),)


@dataclass(slots=True)
class Upgrade:
    """An upgrade that goes on, or is being undone."""

    before: Configuration
    better: Configuration
    began: float
    suffered: bool = False
    """Whether what ran before has lost anything, or its configurator its way to it."""
    heard: dict[tuple[str, str], float] = field(default_factory=dict)
    """For each life and input, when it has heard last of what has fed it before the upgrade."""
    followed: set[tuple[str, str]] = field(default_factory=set)
    """Each life and input that has followed an output since it began."""
    acting: dict[str, tuple[Life, int]] = field(default_factory=dict)
    """The lives that have acted for the task all the time, each with how often it had stopped when it began."""


class UpgradeWatch:
    """Follows every upgrade of a history from its beginning to what has come of it."""

    def __init__(self, history: History, note: Callable[[str, str], None]) -> None:
        self._history, self._note = history, note
        self._going: dict[TaskRunner, Upgrade] = {}
        self.ended: list[bool] = []
        """The upgrades that have ended while nothing else happened to their tasks, each whether it came about."""

    def look(self) -> None:
        """Look at what has become of each."""
        for agent in self._history.agents:
            state = agent.state
            going = self._going.get(agent)
            if state.fallback is not None and (going is None or going.before is not state.fallback):
                going = self._going[agent] = self._begun(agent, state)
            if going is not None:
                self._follow(agent, state, going)

    def has_followed(self, agent: TaskRunner, life: Life, port: str) -> bool:
        """Whether an input has followed any output since an upgrade of a task began that goes on."""
        going = self._going.get(agent)
        return going is not None and (life.runtime.life, port) in going.followed

    def _begun(self, agent: TaskRunner, state: State) -> Upgrade:
        assert state.fallback is not None
        assert state.target is not None
        acting = {life.runtime.life: (life, stops(life)) for life in self._acting(agent, state.fallback)}
        return Upgrade(state.fallback, state.target, self._history.network.time, acting=acting)

    def _acting(self, agent: TaskRunner, configuration: Configuration) -> Iterator[Life]:
        for life in awake(self._history):
            acts = life.runtime.activation.phase is ActivationPhase.ACTIVE
            if acts and life.component in configuration.components and agent.supervisor in life.holds:
                yield life

    def _follow(self, agent: TaskRunner, state: State, going: Upgrade) -> None:
        history = self._history
        if not history.lab.is_open(agent) or node_of(agent).paused or agent._components.reachability.cut_off:
            del self._going[agent]
            return
        acting = {life.runtime.life for life in self._acting(agent, going.before) if self._is_fed(life)}
        going.acting = {name: one for name, one in going.acting.items() if name in acting}
        well = {life.component for life, _ in going.acting.values()} - state.lost.keys()  # one may be asked to yield
        going.suffered = going.suffered or not well.issuperset(going.before.components)
        for life in self._acting(agent, going.before):
            going.followed.update((life.runtime.life, port) for port, _ in life.followed)
        for life, _ in going.acting.values():
            self._look_at_inputs(life, going)
        if state.fallback is None and state.phase not in (Phase.RESERVING, Phase.DEPLOYING):
            del self._going[agent]
            self._end(agent, state, going)

    def _look_at_inputs(self, life: Life, going: Upgrade) -> None:
        """Note an input that follows only outputs that have issued nothing, though what it followed before goes on."""
        inputs = life.runtime.inputs
        for port in life.runtime.profile.signal_inputs if isinstance(inputs, Inputs) else ():
            assert isinstance(inputs, Inputs)
            old = sources(going.before, life.component, port.name)
            one = inputs._inputs[port.name]
            followed = {wire.component: one._subscriptions[wire] for wire in one.followed}
            now, one = self._history.network.time, (life.runtime.life, port.name)
            for source in old:
                if source in followed:
                    going.heard[one] = max(going.heard.get(one, 0.0), followed[source]._output.heard_at)
            lately = going.heard.get(one, 0.0) > now - HANDOVER / 2
            late = self._history.script.faults.most_event_delay  # so late it may be heard that a source was stopped
            delivered = any(
                following.heard_since(max(going.began - JUST_COME, self._started(source) - late))
                for source, following in followed.items()
            )
            kept = followed.keys() & {*old}
            if lately and not (kept or delivered) and all(feeds(self._history, source, life) for source in old):
                del going.heard[one]
                self._note(DELIVERS, f"{life.name} follows {sorted(source.short for source in followed)}")

    def _started(self, component: IRI) -> float:
        """When the life of a component that acts was started."""
        lives = (life for life in acting(self._history) if life.component == component)
        return max((life.recorder.started_at for life in lives), default=0.0)

    def _is_fed(self, life: Life) -> bool:
        """Whether what feeds a component acts and is in reach, and has issued something: else it is blind."""
        ports = {port for port, _ in life.followed}
        return not life.runtime.code._unfed_inputs.blind and all(
            any(feeds(self._history, wire.component, life) for name, wire in life.followed if name == port)
            for port in ports
        )

    def _end(self, agent: TaskRunner, state: State, going: Upgrade) -> None:
        """What has come of an upgrade, if nothing happened to what ran before."""
        runs = state.target if state.phase is Phase.RUNNING else None
        came_about = runs is not None and runs.assignments == going.better.assignments
        kept = runs.components if runs is not None else ()
        for life, stopped in going.acting.values():
            if life.component in kept and stops(life) > stopped:
                self._note(GOES_ON, f"{life.name} {life.runtime.life} has stopped, and acts for {agent.name} as before")
        stays = runs is not None and runs.assignments == going.before.assignments
        ended = state.ended or (state.phase is Phase.DISMANTLING and state.afterwards is Phase.STOPPED)
        if not (going.suffered or came_about or stays or ended):
            what = state.phase.value if runs is None else f"running with {sorted(c.short for c in kept)}"
            self._note(STAYS, f"{agent.name} is {what}, after an upgrade that began at {going.began:.3f}")
        if came_about or not going.suffered:
            self.ended.append(came_about)


def sources(configuration: Configuration, sink: IRI, port: str) -> list[IRI]:
    """The components that feed an input."""
    return [one.source for one in configuration.connections if (one.sink, one.input) == (sink, port)]


def stops(life: Life) -> int:
    """How often a component was stopped."""
    return life.recorder.said.count(("stopped",))
