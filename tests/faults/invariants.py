"""What must hold at every step of a history; what must hold once the faults have ceased is in `final_invariants`.

Some of it may fail for a moment: until the news has travelled, and the grace is over. So an invariant names conditions
that may not last for longer than its bound; a bound of zero means never.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from selfconf.bus.memory import LEASE, MemoryBus
from selfconf.configurator.state import Phase
from selfconf.deployment import TaskRunner
from selfconf.deployment.components.releases import RELEASE_AGAIN
from selfconf.model.configuration import Configuration
from selfconf.model.term import IRI
from selfconf.sdk.runtime.supervision import GRACE
from selfconf.sdk.unfed_inputs import TOLERATES
from tests.faults.histories import History, Life, looked_up_once

CALLS = 2.0
"""Seconds after which a configurator looks again at a call that was not answered."""
MOST_WAITING = 2_000
"""How many messages and timers may wait in the network."""
LATE = ("answer_late", "end_before_answer")
"""The kinds of actions by which answers come late."""
LOOKS = 10.0
"""Seconds within which a configurator notices that a component does not act any more without having said so."""
DECIDED = (Phase.RUNNING, Phase.REFUSED, Phase.STOPPED)
"""The phases in which a task is decided."""
DECIDED_WITHIN = 10.0
"""Seconds after the last fault within which a task is decided: a call may take 8, and two tasks may take turns with a
component that refuses; the longest of 8,000 histories took 9.5."""


@dataclass(frozen=True, slots=True)
class Invariant:
    """Conditions that may not last for longer than a bound, in seconds; each is described by a text."""

    name: str
    conditions: Callable[[History], Iterator[str]]
    bound: Callable[[History], float] = lambda history: 0.0


def travel(history: History) -> float:
    """How long news may take from one node to another, and back, in seconds."""
    faults = history.script.faults
    return 2 * (faults.most_delay + faults.most_event_delay) + 0.2


def loses(history: History) -> bool:
    """Whether calls or answers may be lost: one that comes too late is none."""
    return bool(history.script.faults.loss) or any(one.kind in LATE for one in history.script.actions)


def retries(history: History) -> float:
    """How long it may take until a call has got through, in seconds."""
    return 20 * CALLS if loses(history) else 2 * CALLS


def told_again(history: History) -> float:
    """How much later an actuator may hear that it is to rest, as the first message was lost, in seconds."""
    return CALLS if loses(history) else 0.0


def tolerated(history: History) -> float:
    """How long an actuator may act on at most without what feeds it, in seconds."""
    profiles = map(history.lab.profile, history.script.ecology.processes)
    return max(TOLERATES, *(profile.tolerates or 0.0 for profile in profiles))


def heeded(history: History) -> float:
    """How long an actuator may follow what acts for others, in seconds: its release may be lost twice."""
    lost_twice = 2 * RELEASE_AGAIN if loses(history) else 0.0
    return max(GRACE, tolerated(history)) + LEASE + travel(history) + lost_twice


def supervisors(history: History, life: Life) -> Iterator[TaskRunner]:
    """The living configurators that a component acts for."""
    held = life.holds
    return (agent for agent in history.living() if held.get(agent.supervisor))


def node_of(agent: TaskRunner) -> MemoryBus:
    """The node of a configurator."""
    assert isinstance(agent.bus, MemoryBus)
    return agent.bus


@looked_up_once
def awake(history: History) -> list[Life]:
    """The lives that are neither over, nor paused, nor busy."""
    return [life for life in history.lives if life.awake]


@looked_up_once
def acting(history: History) -> list[Life]:
    """The lives of `awake` that act."""
    return [life for life in awake(history) if life.runtime.active]


@looked_up_once
def lives_by_component(history: History) -> Mapping[IRI, list[Life]]:
    """The lives of each component that are not over."""
    found: dict[IRI, list[Life]] = {}
    for life in history.lives:
        if life.node.open:
            found.setdefault(life.component, []).append(life)
    return found


def two_lives_act(history: History) -> Iterator[str]:
    """One life acts: of several processes of one component at most one is active."""
    numbers = Counter(life.name for life in acting(history))
    yield from (f"{name} acts in {number} lives" for name, number in numbers.items() if number > 1)


def acts_for_nobody(history: History) -> Iterator[str]:
    """A component that acts is held by a configurator that lives, and that it sees."""
    for life in acting(history):
        if not any(history.network.reaches(node_of(one), life.node) for one in supervisors(history, life)):
            yield f"{life.name} {life.runtime.life} acts for {sorted(life.holds)}, which is gone"


def acts_unknown(history: History) -> Iterator[str]:
    """The configurator of a component that acts counts on it, or wants it released."""
    for life in acting(history):
        component = life.component
        for agent in supervisors(history, life):
            known = component in agent.state.held or component in agent.state.owed
            if not known and not node_of(agent).paused:
                yield f"{life.name} {life.runtime.life} acts for {agent.name}, which does not know"


def held_for_nothing(history: History) -> Iterator[str]:
    """A component is held only by tasks that know of it."""
    for life in awake(history):
        component, held = life.component, life.holds
        for agent in history.living() if held else ():
            known = component in agent.state.held or component in agent.state.owed
            if agent.supervisor in held and not known and not node_of(agent).paused:
                yield f"{life.name} {life.runtime.life} is held for {agent.name}, which does not know"


def obeys_two(history: History) -> Iterator[str]:
    """No component acts for two tasks that disagree."""
    for life in acting(history):
        holds = [hold for hold in life.runtime.activation.holds if hold.active]
        if any(hold.wants != holds[0].wants for hold in holds):
            yield f"{life.name} {life.runtime.life} acts for tasks that disagree"


def acts_on_part(history: History) -> Iterator[str]:
    """An actuator acts only while no other task holds a part of its configuration.

    That is the one that ran before for as long as a better one is being prepared, of which parts may be held. One that
    is at rest, as it is blind, does not act; one that has no part in what its task wants now is about to be released.
    """
    for life in acting(history):
        if not life.runtime.profile.outputs and is_on(life):
            for agent in supervisors(history, life):
                plans = [plan for plan in (agent.state.target, agent.state.fallback) if plan is not None]
                plans = [plan for plan in plans if life.component in plan.components]
                amiss = [list(held_by_others(history, plan, agent)) for plan in plans]
                for part in amiss[-1] if amiss and all(amiss) else ():
                    yield f"{life.name} acts for {agent.name}, and {part}"


def held_by_others(history: History, plan: Configuration, agent: TaskRunner) -> Iterator[str]:
    """Which parts of a configuration of a task another one holds, in words."""
    for component in plan.components:
        for other in strangers(history, component, agent):
            yield f"{component.short} is held by {other}"


def strangers(history: History, component: IRI, agent: TaskRunner) -> Iterator[str]:
    """The other tasks that hold a component which cannot be shared, and its only life."""
    lives = lives_by_component(history).get(component, ())
    if not any(agent.supervisor in life.holds for life in lives):
        for life in lives:
            for hold in life.runtime.activation.holds:
                if not life.runtime.profile.is_shareable:
                    yield hold.claim.task


def heeds_a_stranger(history: History) -> Iterator[str]:
    """An actuator that acts follows nothing that acts for other tasks alone: what that issues is not meant for it.

    What stands behind a composite acts for the inside of that.
    """
    insides = {inside.runner.supervisor for inside in history.insides() if inside.runner is not None}
    for life in acting(history):
        if life.runtime.profile.outputs or not is_on(life):
            continue
        mine = {supervisor for supervisor, acts in life.holds.items() if acts}
        followed = {wire.component for _, wire in life.followed}
        for source in acting(history) if mine else ():
            theirs = {supervisor for supervisor, acts in source.holds.items() if acts}
            if source.component in followed and theirs and not theirs & (mine | insides):
                yield f"{life.name} follows {source.name}, which acts for {sorted(theirs)}"


def runs_without(history: History) -> Iterator[str]:
    """A task is running only as long as each of its components acts for it, or its configurator is cut off, and knows.

    It has said so then, and can be asked by nobody.
    """
    for agent in history.living():
        claims = agent.state.phase is Phase.RUNNING and not agent._components.reachability.cut_off
        if claims and not node_of(agent).paused and agent.configuration is not None:
            for component in agent.configuration.components:
                if not acts_for(history, agent, component):
                    yield f"{agent.name} is running without {component.short}"


def acts_for(history: History, agent: TaskRunner, component: IRI) -> bool:
    return any(life.holds.get(agent.supervisor) for life in lives_by_component(history).get(component, ()))


def runs_with_anothers(history: History) -> Iterator[str]:
    """No two tasks run with one component that cannot be shared, as far as their configurators can know.

    Two sites may for a moment believe that they run one task.
    """
    running: dict[IRI, TaskRunner] = {}
    for agent in history.living():
        if agent.state.phase is Phase.RUNNING and not node_of(agent).paused and agent.configuration is not None:
            for component in {*agent.configuration.components}:
                other = running.setdefault(component, agent)
                theirs = other.state.task != agent.state.task and component in alone(history)
                if theirs and node_of(agent).link and node_of(other).link:
                    yield f"{agent.name} and {other.name} both run with {component.short}"
                running[component] = agent


@looked_up_once
def alone(history: History) -> set[IRI]:
    """The components that cannot be shared."""
    return {life.component for life in history.lives if not life.runtime.profile.is_shareable}


def acts_blind(history: History) -> Iterator[str]:
    """No actuator is on while nobody feeds it; one that is in `started` comes to rest as soon as that returns."""
    for life in acting(history):
        actuates = bool(life.runtime.profile.signal_inputs) and not life.runtime.profile.outputs
        if not actuates or life.thread.starting:
            continue
        if is_on(life):
            sources = {wire.component for _, wire in life.followed}
            if not any(feeds(history, source, life) for source in sources):
                yield f"{life.name} {life.runtime.life} is on, and nobody feeds it"


def is_on(life: Life) -> bool:
    """Whether the code of a component was started, and has not come to rest since."""
    told = (said for said in reversed(life.recorder.said) if said in (("started",), ("stopped",)))
    return next(told, None) == ("started",)


def feeds(history: History, source: IRI, life: Life) -> bool:
    """Whether a component acts, and its signals get through."""
    return any(one.component == source and history.network.reaches(one.node, life.node) for one in acting(history))


def hangs_unnoticed(history: History) -> Iterator[str]:
    """A component whose code hangs does not count as active."""
    for life in acting(history):
        if life.thread.hangs:
            yield f"{life.name} {life.runtime.life} hangs, and counts as active"


def undecided_after_faults(history: History) -> Iterator[str]:
    """Once the faults have ceased, a task is soon running or refused, if no component is slow to start, or busy."""
    busy = (life.recorder.slow or life.thread.busy_until > history.network.time for life in history.lives)
    if history.ceased and not any(busy):
        for agent in history.living():
            if agent.state.phase not in DECIDED:
                yield f"{agent.name} is neither running nor refused"


def network_overflows(history: History) -> Iterator[str]:
    """What waits is bounded."""
    if len(history.network._events) > MOST_WAITING:
        yield "more than 2,000 messages and timers wait"


STEPS = (
    Invariant("one life acts", two_lives_act, lambda history: GRACE + travel(history) + 1.0),
    Invariant("nobody acts for nobody", acts_for_nobody, lambda history: GRACE + travel(history)),
    Invariant("who acts is known", acts_unknown, lambda history: retries(history) + travel(history)),
    Invariant("running means running", runs_without, lambda history: LOOKS + retries(history) + travel(history)),
    Invariant("each runs with its own", runs_with_anothers, lambda h: LOOKS + retries(h) + travel(h)),
    Invariant("held is known", held_for_nothing, lambda history: retries(history) + travel(history)),
    Invariant("nobody obeys two", obeys_two),
    Invariant(
        "no actuator acts on part",
        acts_on_part,
        lambda h: max(GRACE, tolerated(h)) + LEASE + travel(h) + told_again(h),
    ),
    Invariant("nobody heeds a stranger", heeds_a_stranger, heeded),
    Invariant("no actuator acts blind", acts_blind, lambda h: tolerated(h) + LEASE + GRACE + travel(h) + 1.0),
    Invariant("who hangs has failed", hangs_unnoticed, lambda history: 0.05),
    Invariant("what waits is bounded", network_overflows),
    Invariant("every task is soon decided", undecided_after_faults, lambda history: DECIDED_WITHIN),
)
"""What must hold at every step."""
