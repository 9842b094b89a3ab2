"""What is lost is followed no more, and no actuator acts for long on a part of its configuration.

A component that is lost is released, and if it lives it may act for another task at once. What follows it is
disconnected, unless it follows something else within a moment (`LossLasts`), or as soon as another task is known to
hold it: what it issues is not meant for this one. If the configuration stays incomplete, its actuators come to rest,
but are held on; they start again when everything else acts.
"""

from __future__ import annotations

from collections.abc import Mapping

from selfconf.configurator import deploying
from selfconf.configurator.deploying import DEPLOYING, Reaction, then
from selfconf.configurator.effects import ApplyTo
from selfconf.configurator.state import Applied, Phase, State
from selfconf.model.immutable import replace
from selfconf.model.profile import CALL_MARK
from selfconf.model.term import IRI
from selfconf.protocol.messages import Wires


def disconnect(state: State, components: frozenset[IRI]) -> Reaction:
    """Let all that acts for this task follow some components no more: what they issue is for others, if for anybody."""
    fewer = {
        one: {port: tuple(w for w in wires if w.component not in components) for port, wires in mine.inputs.items()}
        for one, mine in state.held.items()
        if mine.active and one not in components and not components.isdisjoint(mine.sources)
    }
    return _follow_fewer(state, fewer)


def _follow_fewer(state: State, fewer: Mapping[IRI, Wires]) -> Reaction:
    """Let components follow less than before, in an epoch that is newer than that of any call which says otherwise.

    The call to one that is to rest says so once more, or it would act again.
    """
    if not fewer:
        return state, ()
    epoch, held, effects = state.epoch + 1, dict(state.held), []
    for one, inputs in fewer.items():
        mine = state.held[one]
        held[one] = replace(mine.at_most(Applied.ACTS), inputs=inputs)
        effects.append(
            ApplyTo(one, epoch, inputs, mine.values, mine.callers, adopted=mine.is_adopted, rests=mine.rests)
        )
    return replace(state, epoch=epoch, held=held), tuple(effects)


def loss_lasts(state: State, actuators: frozenset[IRI]) -> Reaction:
    """Follow nothing that was lost a while ago, and let actuators rest, if that is so long ago.

    What lives of a lost component is free for others, which may let it act by now.
    """
    if state.phase not in (Phase.DISCOVERING, Phase.COMPOSING, *DEPLOYING):
        return state, ()
    followed = {source for held in state.held.values() for source in held.sources}
    followed -= _outside(state)
    gone = frozenset(one for one in followed if one not in state.held or not state.held[one].active)
    act_on = state.fallback is not None or _lacks_actuators_alone(state)
    resting, effects = (state, ()) if act_on else _bring_to_rest(state, actuators)
    known, more = disconnect(resting, gone) if gone else (resting, ())
    effects += more
    return then(effects, deploying.deploy(known) if effects and state.phase in DEPLOYING else (known, ()))


def let_rest(state: State, actuators: frozenset[IRI]) -> Reaction:
    """Let actuators inside of a composite rest at once, whatever is done inside: what that is part of is incomplete."""
    if state.phase not in (Phase.DISCOVERING, Phase.COMPOSING, *DEPLOYING):
        return state, ()
    acting = {one: mine for one, mine in state.held.items() if one in actuators and mine.active and not mine.rests}
    resting = {one: replace(mine, rests=True) for one, mine in acting.items()}
    told = {one: mine.inputs for one, mine in acting.items()}
    known, effects = _follow_fewer(replace(state, held={**state.held, **resting}), told)
    return then(effects, deploying.deploy(known) if effects and state.phase in DEPLOYING else (known, ()))


def _outside(state: State) -> set[IRI]:
    """The composite that this is the inside of, if it is one: what follows that follows what is outside."""
    if state.target is None:
        return set()
    return {connection.source for connection in state.target.connections}.difference(state.target.components)


def _lacks_actuators_alone(state: State) -> bool:
    """Whether everything else acts: then actuators may, and one that rests would be started again at once."""
    if state.phase is not Phase.DEPLOYING or state.target is None or state.plan is None:
        return False
    return all(state.held[one].confirmed for one in state.target.components if one not in state.plan.order.actuators)


def _bring_to_rest(state: State, actuators: frozenset[IRI]) -> Reaction:
    """Let actuators follow nothing, so that they rest; they are held on, and start last, as in a new deployment.

    So do those that follow nothing, as all that they followed was lost, or as they act by operations or by themselves.
    """
    resting = {
        one: {port: wires if port.endswith(CALL_MARK) else () for port, wires in mine.inputs.items()}
        for one, mine in state.held.items()
        if one in actuators and mine.active
    }
    told = {one: ins for one, ins in resting.items() if ins != state.held[one].inputs or not state.held[one].rests}
    at_rest = {one: replace(state.held[one].at_most(Applied.SENT), rests=True) for one in resting}
    return _follow_fewer(replace(state, held={**state.held, **at_rest}), told)
