"""What must hold of a history in the end, once the faults have ceased and the news has travelled: it has no bound."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import chain, combinations

from selfconf.configurator.state import Phase
from selfconf.deployment import TaskRunner
from selfconf.model.configuration import Configuration
from selfconf.model.profile import CALL_MARK
from selfconf.model.refusal import Refusal
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause
from selfconf.rdf.advertisements import Advertisement
from tests.faults.histories import ASKED, History, Life
from tests.faults.invariants import DECIDED, Invariant, acting, acts_for, awake, is_on

MOST_LEFT_OUT = 4
"""How many components that can be shared are left out at most, less one, where a configuration is looked for."""


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
        if not acts_for(history, agent, component):
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
        behind = [one for one in history.living() if one is not agent and acts_for(history, one, source)]
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
