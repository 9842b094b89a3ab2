"""Act 4 as a transaction: wake, reserve, then activate; each function gives the next state and what is to be done.

All components of the target are woken at once, those that live are awake. Then each that is not held yet is reserved,
one after the other in the order of their IRIs; but what is kept for the task is reserved while others are woken. When
all are held, each is applied to as soon as everything before it in the starting order has confirmed. A component that
acts already, and gets other inputs, is applied to at once if a source of it is lost, else not before its new sources
have confirmed: make before break. In an upgrade that is so in a loop as well. What is not needed any more is released
when everything has confirmed, what is fed before what feeds it.

Why in the order of the IRIs: a task that waits for a component holds none that comes later, so tasks cannot wait for
each other in a circle (Havender 1968). One that was asked in a deployment which began anew before the answer came
counts as held, and so does one that has not obeyed its last release. In a repair, which holds components already, one
that is held by another task counts as taken, unless that task is of lower priority: it is made to let go.

A repair that lacks only one component, and that is no actuator, does not reserve it first: the apply is the
reservation, and everything else acts already.

What a task that is adopted holds acts under a configurator that is gone, or has come to rest since. So it is claimed
first, and while others are woken: reserved as it is. What does not act any more, or has obeyed a newer epoch, starts in
its turn, and what another task holds by now is reserved like all that is not held.
"""

from __future__ import annotations

from collections.abc import Container, Iterable

from selfconf.configurator.effects import (
    ApplyTo,
    AwaitRelease,
    Effect,
    ReleaseFrom,
    ReserveOf,
    Running,
    Unwatch,
    WakeUp,
    Watch,
)
from selfconf.configurator.events import Answered, Call
from selfconf.configurator.starting_order import Plan, plan_of, resting_waves
from selfconf.configurator.state import Applied, Held, Phase, Revival, State
from selfconf.model.holder import Holder
from selfconf.model.immutable import replace
from selfconf.model.term import IRI
from selfconf.protocol.messages import Verdict, Wires

Reaction = tuple[State, tuple[Effect, ...]]
"""The next state, and what is to be done."""
DEPLOYING = (Phase.RESERVING, Phase.DEPLOYING)
"""The phases of act 4."""
MOST_ASKED = 40
"""How often a component is asked again that is to be taken from a task of lower priority, each time half a second
later: one that obeys takes two seconds for that, and some more to come to rest."""
MOST_ASKED_BEHIND, MOST_ASKED_AHEAD = 2, 4
"""How often a component is asked again, each time half a second later, that acts for another task as well and that this
one wants to follow something else: of two tasks that disagree, one waits longer than the other."""


def then(effects: Iterable[Effect], following: Reaction) -> Reaction:
    """A reaction with other effects before its own."""
    state, more = following
    return state, (*effects, *more)


def deploy(state: State) -> Reaction:
    """Watch every component of the target, and wake those that are not held yet."""
    plan, epoch = _plan_of_target(state), state.epoch + 1
    state, releases = release_rest(state, plan.inputs)
    wires, held = plan.inputs, _to_be_confirmed(state, plan)
    asleep = sorted(component for component in wires if not held[component].reserved)
    claimed = _unclaimed(state)
    effects: list[Effect] = [*releases, *(Watch(component) for component in wires if component not in state.watched)]
    effects += [WakeUp(component, epoch) for component in asleep]
    effects += [ReserveOf(one, epoch, held[one].inputs, held[one].values) for one in claimed]
    effects += [Unwatch(component) for component in sorted(state.watched - wires.keys() - held.keys())]
    deployed = replace(
        state,
        phase=Phase.RESERVING,
        plan=plan,
        epoch=epoch,
        held=held,
        pending=frozenset((*((one, Call.WAKE) for one in asleep), *((one, Call.RESERVE) for one in claimed))),
        disagreeing=frozenset(),
        owed={component: since for component, since in state.owed.items() if component not in wires},
        watched=state.watched & held.keys() | wires.keys(),
    )
    return then(effects, proceed(deployed))


def _plan_of_target(state: State) -> Plan:
    """The plan of the target: the one that is known, if it is not that of another configuration."""
    assert state.target is not None
    known = state.plan
    return known if known is not None and known.configuration is state.target else plan_of(state.target)


def _unclaimed(state: State) -> list[IRI]:
    """What was adopted, and has not answered this configurator in any deployment yet."""
    return sorted(one for one, mine in state.held.items() if mine.is_adopted and mine.asked)


def _to_be_confirmed(state: State, plan: Plan) -> dict[IRI, Held]:
    """What is held, and is to be: confirmed is what has confirmed that it does already what it is to do."""
    held = dict(state.held)
    for component, inputs in plan.inputs.items():
        before = held.get(component, Held({}, asked=component in state.owed))
        wanted = inputs, plan.values[component], plan.callers[component]
        same = before.confirmed and (before.inputs, before.values, before.callers) == wanted
        held[component] = before if same else before.at_most(Applied.ACTS)
    return held


def proceed(state: State) -> Reaction:
    """Go on once nothing is pending: reserve the next component, or begin to activate."""
    if state.pending:
        return state, ()
    if state.phase is Phase.RESERVING:
        assert state.target is not None
        free = sorted(component for component in state.target.components if not state.held[component].reserved)
        if free and not (len(free) == 1 and _is_reserved_by_apply(state, free[0])):
            return _reserve(state, free[0])
        return apply_to(replace(state, phase=Phase.DEPLOYING), state.target.components)
    return end_deployment(state)


def take_offered(state: State, component: IRI) -> Reaction:
    """Reserve a component while others are woken, out of turn, if it is kept for this task: not for as long as that.

    No circle comes of it, as a task does not wait for a component that comes before one that it holds. One that is held
    from before and not wanted any more is left to its release.
    """
    calls = {(component, Call.WAKE), (component, Call.RESERVE)}
    wanted = state.plan is not None and component in state.plan.inputs and not state.held[component].reserved
    known = wanted and component in state.offered
    wakes = any(call is Call.WAKE for _, call in state.pending)
    if not (wakes and known and calls.isdisjoint(state.pending)):
        return state, ()
    return _reserve(replace(state, offered=state.offered - {component}), component)


def _is_reserved_by_apply(state: State, component: IRI) -> bool:
    """Whether the only component that is not reserved may be applied to: it can turn no motor, and the rest acts."""
    assert state.target is not None
    assert state.plan is not None
    rest_acts = all(state.held[other].acts for other in state.target.components if other != component)
    return rest_acts and component not in state.plan.order.actuators and component not in state.queued


def _reserve(state: State, component: IRI) -> Reaction:
    plan = state.plan
    assert plan is not None
    reserve = ReserveOf(component, state.epoch, plan.inputs[component], plan.values[component])
    held = {**state.held, component: replace(state.held[component], asked=True)}
    return replace(state, held=held, pending=state.pending | {(component, Call.RESERVE)}), (reserve,)


def apply_to(state: State, candidates: Iterable[IRI]) -> Reaction:
    """Apply to those components that may be started, or changed, by now."""
    plan = state.plan
    assert plan is not None
    effects: list[Effect] = []
    held, pending = dict(state.held), set(state.pending)
    for component in candidates:
        before = held[component]
        if before.confirmed or (component, Call.APPLY) in pending or not _may_begin(state, component, plan):
            continue
        pending.add((component, Call.APPLY))
        inputs, set_, called_by = plan.inputs[component], plan.values[component], plan.callers[component]
        rests = state.rests and component in plan.order.actuators
        applied = max(before.applied, Applied.SENT)
        held[component] = replace(before, inputs=inputs, values=set_, callers=called_by, applied=applied, rests=rests)
        sources = (wire.component for wires in inputs.values() for wire in wires)
        # What is new in a loop cannot wait for a signal of what is started after it.
        feeds = before.acts or all(held[source].acts for source in sources if source in held)
        gently, adopted = state.fallback is not None and feeds, before.is_adopted
        effects.append(ApplyTo(component, state.epoch, inputs, set_, called_by, gently, adopted, rests))
    return then(effects, proceed(replace(state, held=held, pending=frozenset(pending))))


def _may_begin(state: State, component: IRI, plan: Plan) -> bool:
    """Whether everything is confirmed that must be before a component is applied to."""
    if state.held[component].acts:
        return _may_change(state, component, plan)
    order, held = plan.order, state.held
    if component in order.actuators and any(not held[c].confirmed for c in order.before if c not in order.actuators):
        return False
    # In an upgrade what acts waits for what begins, in a loop as well: so that does not wait for what acts.
    upgrades = state.fallback is not None
    return all(held[source].confirmed or (upgrades and held[source].acts) for source in order.before[component])


def _may_change(state: State, component: IRI, plan: Plan) -> bool:
    """Whether everything is confirmed that must be before a component that acts is applied to."""
    held, before, wanted = state.held, state.held[component].inputs, plan.inputs[component]
    changed = [port for port in {**before, **wanted} if before.get(port) != wanted.get(port)]
    followed = {wire.component for port in changed for wire in before.get(port, ())}
    if not changed or not all(source in held for source in followed):
        return True
    if state.fallback is not None:  # an upgrade
        new = (wire.component for port in changed for wire in wanted.get(port, ()))
        if not all(held[source].acts for source in new if source in held):
            return False
    return all(held[source].confirmed for source in plan.order.before[component])


def as_claimed(state: State, answer: Answered) -> State:
    """Note that a component that was adopted obeys its claim: one that is held and does not act starts in turn."""
    held = state.held.get(answer.component)
    if held is None or not held.is_adopted or answer.call is not Call.RESERVE:
        return state
    if answer.verdict is not Verdict.DONE:
        return state
    claimed = replace(held, asked=False)
    if not answer.acts:
        claimed = replace(claimed, life=answer.life, applied=Applied.NOT_YET)
    return replace(state, held={**state.held, answer.component: claimed})


def confirmed(state: State, answer: Answered) -> Reaction:
    """A component has done what it was asked: reserve the next one, or apply to those that wait for it."""
    held = state.held[answer.component]
    if answer.call is Call.WAKE:
        return take_offered(state, answer.component) if state.pending else proceed(state)
    if answer.call is Call.RESERVE:
        known = replace(held, life=answer.life, asked=False, reserved=True)
        plan, mine = state.plan, answer.component
        assert plan is not None
        # It was given up, and has not heard of that: it follows some of this. One that is not wanted is to be released.
        if answer.acts and not held.active and mine in plan.inputs:
            inputs, calling = plan.inputs[mine], plan.callers[mine]
            known = replace(known, applied=Applied.SENT, inputs=inputs, values=plan.values[mine], callers=calling)
        return proceed(replace(state, held={**state.held, answer.component: known}))
    known = replace(held, life=answer.life, asked=False, reserved=True, applied=Applied.CONFIRMED)
    done = replace(state, held={**state.held, answer.component: known})
    assert done.plan is not None
    waiting: Iterable[IRI] = done.plan.order.after[answer.component]
    if not done.pending:  # the last of a wave: actuators may be waiting for it
        waiting = (*waiting, *done.plan.order.actuators)
    if done.fallback is not None:  # what follows it by now waits for it, also where a loop has it come later
        waiting = done.plan.inputs
    return apply_to(done, dict.fromkeys(waiting))


def end_deployment(state: State) -> Reaction:
    """Everything acts: release what is not needed any more, once all know what stands behind composites."""
    assert state.target is not None
    if state.rewired:
        return rewire(replace(state, rewired=frozenset()), state.rewired)
    wanted = set(state.target.components)
    acting = acting_wires(state)
    surplus = [component for component in state.held if component not in wanted]
    unneeded = sorted(state.queued - wanted - state.held.keys())
    effects: list[Effect] = [Running(state.target)]
    effects += [ReleaseFrom(component, state.epoch) for component in unneeded]
    effects += [Unwatch(component) for component in sorted(state.watched - wanted)]
    running = replace(
        state,
        phase=Phase.RUNNING,
        fallback=None,
        queued=frozenset(),
        offered=frozenset(),
        asked_about=frozenset(),
        repeats={},
        has_yielded=False,
        lost={component: loss for component, loss in state.lost.items() if loss.revival is not Revival.LIVES_ANEW},
        news=state.news or state.heeds_others,  # by the next loss others may have let go, which they tell no task
        held={component: held for component, held in state.held.items() if component in wanted},
        unreleased=resting_waves(acting, surplus),
        surplus={component: acting[component] for component in surplus if component in acting},
        owed={**state.owed, **dict.fromkeys((*surplus, *unneeded), state.epoch)},
        watched=state.watched & wanted,
    )
    return then(effects, release_next(running))


def acting_wires(state: State) -> dict[IRI, Wires]:
    """What each component that may act follows."""
    return {component: held.inputs for component, held in state.held.items() if held.active}


def release_next(state: State) -> Reaction:
    """Release those that feed none of the others that are to come to rest, if those before them have."""
    if state.pending or not state.unreleased:
        return state, ()
    now, *left = state.unreleased
    pending = frozenset((component, Call.RELEASE) for component in now)
    effects = tuple(ReleaseFrom(component, state.epoch) for component in now)
    return replace(state, unreleased=tuple(left), pending=pending), effects


def release_rest(state: State, wanted: Container[IRI] = ()) -> Reaction:
    """Release at once what was not needed by a configuration that runs no more, but for what is `wanted` again."""
    left = (component for wave in state.unreleased for component in wave if component not in wanted)
    owed = tuple(ReleaseFrom(component, state.owed[component]) for component in left if component in state.owed)
    return replace(state, unreleased=()), owed


def rewire(state: State, components: frozenset[IRI]) -> Reaction:
    """Apply once more to those that follow some components, or are called by them, behind which others stand now.

    Of these components, also to the actuators: they are to rest, or to act again (`State.rests`).
    """
    assert state.plan is not None
    actuators = components & state.plan.order.actuators
    held = {
        one: held.at_most(Applied.ACTS) if one in actuators or held.is_wired_to(components) else held
        for one, held in state.held.items()
    }
    return deploy(replace(state, held=held))


def may_wait_for(state: State, component: IRI, holder: Holder | None) -> bool:
    """Whether it is safe and of use to wait until another task lets go of a component.

    A task that acts may do so for long: then everything else is let go of, instead of being held for nothing.
    """
    if holder is None:
        return False
    reserved = [one for one, held in state.held.items() if held.may_be_held and one != component]
    if not holder.task and reserved and not any(state.held[one].active for one in reserved):
        return False  # it is kept for a task that goes before, which may need what is held here
    if holder.priority < state.priority:  # it is asked to yield, and made to: the component waits two seconds for that
        return state.repeats.get(component, 0) <= MOST_ASKED
    return state.patient and not holder.acting and not any(one > component for one in reserved)


def may_agree(state: State, component: IRI, holder: Holder | None) -> bool:
    """Whether it is of use to wait until another task wants the same of a component that acts for both.

    A source that they have in common is lost to both. If they go on to disagree, one gives way before the other does.
    For the sake of something better only one of lower priority is to change: it is asked to yield.
    """
    if holder is None or (state.fallback is not None and holder.priority >= state.priority):
        return False
    behind = (-holder.priority, holder.task) < (-state.priority, state.task)
    return state.repeats.get(component, 0) <= (MOST_ASKED_BEHIND if behind else MOST_ASKED_AHEAD)


def await_agreement(state: State, component: IRI) -> Reaction:
    """Wait until a component that is shared may change; it tells, and is asked again if it does not."""
    asked = state.pending | {(component, Call.APPLY)}
    waiting = replace(state, pending=asked, disagreeing=state.disagreeing | {component})
    return waiting, (AwaitRelease(component, state.epoch),)


def await_release(state: State, component: IRI) -> Reaction:
    """Wait for a component that another task holds; it tells when it is free, and is asked again if it does not."""
    waiting = replace(state, pending=state.pending | {(component, Call.RESERVE)})
    return waiting, (AwaitRelease(component, state.epoch),)


def ask_again(state: State, component: IRI) -> Reaction:
    """Ask once more for a component that is waited for; none is that was adopted, and is being claimed."""
    if (component, Call.RESERVE) in state.pending and not state.held[component].is_adopted:
        return _reserve(state, component)
    if (component, Call.APPLY) in state.pending and component in state.disagreeing:
        asked, disagreeing = state.pending - {(component, Call.APPLY)}, state.disagreeing - {component}
        return apply_to(replace(state, pending=asked, disagreeing=disagreeing), (component,))
    return state, ()
