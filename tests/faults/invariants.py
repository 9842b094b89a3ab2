"""What must hold at every step of a history, and what must hold once the faults have ceased.

Some of it may fail for a moment: until the news has travelled, and the grace is over. So an invariant names conditions
that may not last for longer than its bound; a bound of zero means never. What must hold in the end has no bound.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import chain, combinations

from selfconf.bus.memory import LEASE, MemoryBus
from selfconf.configurator.state import Phase
from selfconf.deployment import TaskRunner
from selfconf.deployment.components.releases import RELEASE_AGAIN
from selfconf.model.configuration import Configuration
from selfconf.model.profile import CALL_MARK
from selfconf.model.refusal import Refusal
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause
from selfconf.rdf.advertisements import Advertisement
from selfconf.sdk.blindness import TOLERATES
from selfconf.sdk.runtime.supervision import GRACE
from tests.faults.histories import ASKED, History, Life, looked_up_once

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
DECIDED_WITHIN = 8.0
"""Seconds after the last fault within which a task is decided: the longest of 2,600 histories took less than 6."""
MOST_LEFT_OUT = 4
"""How many components that can be shared are left out at most, less one, where a configuration is looked for."""


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
        if len(holds) > 1 and len({str(hold.wants) for hold in holds}) > 1:
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
                if not _acts_for(history, agent, component):
                    yield f"{agent.name} is running without {component.short}"


def _acts_for(history: History, agent: TaskRunner, component: IRI) -> bool:
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


def undecided(history: History) -> Iterator[str]:
    """Every task is running or refused."""
    for agent in history.living():
        if agent.state.phase not in DECIDED:
            yield f"{agent.name} is still {agent.state.phase.value}"


def refused_in_vain(history: History) -> Iterator[str]:
    """No task that waits could run, with what is free or held by tasks of lower priority."""
    alive = {life.runtime.profile.component for life in history.lives if life.node.open}
    sites = {name: site for name, site in history.sites.items() if history.node(name) is not None}
    startable = {one for name in sites for one in history.script.ecology.sites[name] if one in history.script.startable}
    alive |= {history.lab.profile(name).component for name in startable}
    found = {c: a for site in sites.values() for c, a in site.shelf.advertisements.items() if c in alive}
    for agent in history.living():
        if agent.state.phase is not Phase.REFUSED or not agent.state.patient:
            continue
        taken = {
            life.runtime.profile.component
            for life in history.lives
            for hold in life.runtime.activation.holds
            if life.node.open and not life.runtime.profile.is_shareable and hold.claim.priority >= agent.state.priority
        }
        broken = {c for c, loss in agent.state.lost.items() if not loss.busy and loss.cause is not Cause.CRASH}
        for outcome in agreeing(history, agent, found, frozenset(taken | broken)):
            yield f"{agent.name} waits, although it could run with {[c.short for c in outcome.components]}"
        for component, loss in agent.state.lost.items():
            if component in alive and loss.cause is Cause.CRASH:
                yield f"{agent.name} thinks that {component.short} is dead"


def agreeing(
    history: History, agent: TaskRunner, found: Mapping[IRI, Advertisement], without: frozenset[IRI]
) -> Iterator[Configuration]:
    """A configuration that wants what others want of those components that they share, if there is one.

    Every choice of some that can be shared is tried.
    """
    outcome = agent.request.compose(found, without, None)
    if isinstance(outcome, Refusal):
        return
    shareable = sorted(c for c, a in found.items() if a.profile.is_shareable and c not in without)
    for left_out in chain.from_iterable(combinations(shareable, count) for count in range(MOST_LEFT_OUT)):
        outcome = agent.request.compose(found, without.union(left_out), None)
        if isinstance(outcome, Configuration) and not disagreeing(history, agent, outcome):
            yield outcome
            return


def disagreeing(history: History, agent: TaskRunner, plan: Configuration) -> list[IRI]:
    """The components of a configuration that tasks of the same or a higher priority have and want other things of."""
    others = [
        other.configuration
        for other in history.living()
        if other is not agent and other.state.priority >= agent.state.priority and other.configuration is not None
    ]
    return [c for c in plan.components for o in others if c in o.components and o.wants(c) != plan.wants(c)]


def acts_otherwise(history: History) -> Iterator[str]:
    """What a configuration needs acts as it says, and nothing else acts."""
    wanted = {
        component: agent
        for agent in history.living()
        if agent.state.phase is Phase.RUNNING and agent.configuration is not None
        for component in agent.configuration.components
    }
    for life in history.lives:
        if life.node.open and life.runtime.active and life.runtime.profile.component not in wanted:
            yield f"{life.name} acts for nobody"
    for component, agent in wanted.items():
        if not _acts_for(history, agent, component):
            yield f"{component.short} does not act for {agent.name}"


def wired_otherwise(history: History) -> Iterator[str]:
    """Every input follows what the configuration says; of a composite what stands behind it."""
    for agent in history.living():
        if agent.state.phase is Phase.RUNNING and agent.configuration is not None:
            for life in awake(history):
                if life.holds.get(agent.supervisor) and life.name not in history.script.ecology.composites:
                    wanted = {
                        (c.input, *end)
                        for c in agent.configuration.connections
                        if c.sink == life.component and not c.output.endswith(CALL_MARK)
                        for end in ends_behind(history, agent, c.source, c.output)
                    }
                    followed = {(port, wire.component, wire.output) for port, wire in life.followed}
                    if wanted != followed:
                        yield f"{life.name} follows {sorted(followed)}, not {sorted(wanted)}"


def ends_behind(history: History, agent: TaskRunner, source: IRI, output: str) -> Iterator[tuple[IRI, str]]:
    """The outputs that stand behind one of a configuration: inside of a composite, or outside of this one."""
    outside = agent.request.outside
    if outside is not None and source == outside.composite:
        behind = [one for one in history.living() if one is not agent and _acts_for(history, one, source)]
    else:
        behind = [i.runner for i in history.insides() if i.runner is not None and i.profile.component == source]
        if not behind:
            yield source, output
    for other in behind:
        for one in other.configuration.connections if other.configuration is not None else ():
            if one.sink == source and one.input == output:
                yield from ends_behind(history, other, one.source, one.output)


def unanswered(history: History) -> Iterator[str]:
    """Every operation that a component needs is answered, by a component that acts."""
    components = {life.component for life in acting(history)}
    for life in awake(history):
        for needed in life.runtime.profile.needed_operations:
            said = life.recorder.said
            if life.runtime.active and (ASKED, needed.name) in said:
                after = said[len(said) - said[::-1].index((ASKED, needed.name)) :]
                answers = [one for one in after if one[0] == needed.name.removesuffix(CALL_MARK)]
                if not any(len(one) == 3 and one[1] == "answered" and one[2] in components for one in answers):
                    yield f"{life.name} has asked by {needed.name}, and has come to {answers}"


def lacks_a_value(history: History) -> Iterator[str]:
    """Every component that acts has the parameters of its configuration."""
    for agent in history.living():
        if agent.state.phase is Phase.RUNNING and agent.configuration is not None:
            for life in awake(history):
                if life.holds.get(agent.supervisor):
                    said = since_rest(life)
                    for setting in agent.configuration.settings:
                        mine = setting.component == life.runtime.profile.component
                        if mine and (setting.name, str(setting.value)) not in said:
                            yield f"{life.name} was not told its {setting.name}"


def started_without_values(history: History) -> Iterator[str]:
    """A component has its parameters before it is started."""
    for life in history.lives:
        values = {parameter.name for parameter in life.runtime.profile.parameters}
        known: set[object] = set()
        for said in life.recorder.said if values else ():
            if said == ("stopped",):
                known.clear()
            elif said == ("started",) and not values <= known:
                yield f"{life.name} {life.runtime.life} was started without {sorted(values)}"
            known.add(said[0])


def unheard(history: History) -> Iterator[str]:
    """Every input has heard what each output that it follows has issued last, unless its code is still busy."""
    for life in acting(history):
        if life.thread.busy_until > history.network.time:
            continue
        for port, wire in life.followed:
            for source in (one for one in acting(history) if one.runtime.profile.component == wire.component):
                if (port, f"the last of {source.runtime.life}") not in life.recorder.said:
                    yield f"{life.name} has not heard the last of {source.name}"


def rests_for_nothing(history: History) -> Iterator[str]:
    """An actuator of a task that runs is on: something feeds it."""
    for agent in history.living():
        if agent.state.phase is Phase.RUNNING:
            for life in awake(history):
                rests = not life.runtime.profile.outputs and not is_on(life)
                if rests and life.holds.get(agent.supervisor) and life.thread.busy_until <= history.network.time:
                    yield f"{life.name} is at rest, and {agent.name} runs"


def since_rest(life: Life) -> list[tuple[object, ...]]:
    """What a component was told since it was stopped last before it was started last."""
    said = life.recorder.said
    started = len(said) - said[::-1].index(("started",)) if ("started",) in said else 0
    before = said[:started]
    return said[len(before) - before[::-1].index(("stopped",)) if ("stopped",) in before else 0 :]


ENDS = (
    Invariant("every task is decided", undecided),
    Invariant("nobody waits in vain", refused_in_vain),
    Invariant("what acts is wanted", acts_otherwise),
    Invariant("wired as composed", wired_otherwise),
    Invariant("parameters are set", lacks_a_value),
    Invariant("parameters come first", started_without_values),
    Invariant("the last signal is heard", unheard),
    Invariant("what is needed is answered", unanswered),
    Invariant("nothing rests for nothing", rests_for_nothing),
)
"""What must hold in the end."""
