"""The four acts and the monitoring as one pure function: `step(state, event) -> (state, effects)`.

    IDLE ──accepted──▶ DISCOVERING ──discovered──▶ COMPOSING ──configuration──▶ DEPLOYING ──all applied──▶ SETTING
                            ▲                        ▲   │                         │                         │
                            │                        │   └─refusal──▶ DISMANTLING ─┴──▶ REFUSED              ▼
                            └── something appeared ──┼──────────────────(patient)───────┘                 RUNNING
                                                     └──────────────── a component is lost ──────────────────┘

Deployment is a transaction: FAIL is watched before anything is activated; components are activated and connected;
parameters are set when everything is connected. Whatever ends it (a loss, a refusal, a stop) releases all that was
touched, so that nothing is left half deployed.

Two policies for a loss. `REPAIR` keeps what runs and changes what must change; `DISMANTLE` first takes everything
down, as the paper does (section 4.2). Either way the lost component is turned off and its profile dropped, and the
search runs again. A search that finds nothing counts only if nothing has appeared since the ecology was asked; else
it is asked again.

A component that was released is *owed* a release until it answers: one that was cut off meanwhile may still act, and is
released again when it is seen again. One that another configurator holds is owed it until it is free.

Invariants, each a test: a component is watched before it is applied to; epochs grow; what is held or owed a release
is a superset of what may be active because of this configurator; in IDLE, REFUSED and STOPPED nothing is held; an
answer to an older epoch, or the result of an older search, changes nothing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from selfconf.configurator.effects import (
    ApplyTo,
    Compose,
    Discover,
    Effect,
    Finish,
    ReleaseFrom,
    Running,
    SetOn,
    Unwatch,
    Watch,
)
from selfconf.configurator.events import (
    Accepted,
    Answered,
    Appeared,
    Call,
    Composed,
    Discovered,
    Event,
    Failed,
    Reconnected,
    Stopped,
)
from selfconf.configurator.state import Held, InputWires, Loss, Phase, Policy, State
from selfconf.model.configuration import Configuration
from selfconf.model.term import IRI, Term
from selfconf.protocol.messages import Cause, Verdict, Wire

OBEYED = (Verdict.DONE, Verdict.STALE)
"""The answers after which a component obeys no older call; a busy one may yet, once it is free."""
Reaction = tuple[State, tuple[Effect, ...]]
"""The next state, and what is to be done."""


def step(state: State, event: Event) -> Reaction:
    """What an event does. Total: every state answers every event, if only by staying as it is."""
    match event:
        case Accepted():
            return _accepted(state, event)
        case Discovered():
            return _compose(state) if state.phase is Phase.DISCOVERING else (state, ())
        case Composed():
            return _composed(state, event)
        case Answered():
            return _answered(state, event)
        case Failed():
            return _failed(state, event)
        case Appeared():
            return _appeared(state, event)
        case Reconnected():
            return _reconnected(state)
        case Stopped():
            return _stopped(state)


def wiring(configuration: Configuration) -> dict[IRI, dict[str, tuple[Wire, ...]]]:
    """For each component of a configuration, which outputs each of its inputs follows."""
    wires: dict[IRI, dict[str, tuple[Wire, ...]]] = {component: {} for component in configuration.components}
    for connection in configuration.connections:
        inputs = wires[connection.sink]
        inputs[connection.input] = (
            *inputs.get(connection.input, ()),
            Wire(connection.source, connection.output),
        )
    return wires


def _accepted(state: State, event: Accepted) -> Reaction:
    if state.phase is not Phase.IDLE:
        return state, ()
    return _discover(replace(state, epoch=event.epoch))


def _discover(state: State) -> Reaction:
    return replace(state, phase=Phase.DISCOVERING, pending=frozenset(), news=False), (Discover(),)


def _compose(state: State) -> Reaction:
    attempt = state.attempt + 1
    running = state.target if state.policy is Policy.REPAIR else None
    return (
        replace(state, phase=Phase.COMPOSING, attempt=attempt, pending=frozenset()),
        (Compose(attempt, frozenset(state.lost), running),),
    )


def _composed(state: State, event: Composed) -> Reaction:
    if state.phase is not Phase.COMPOSING or event.attempt != state.attempt:
        return state, ()
    if isinstance(event.outcome, Configuration):
        return _deploy(replace(state, target=event.outcome, refusal=None))
    if state.news:
        return _discover(state)
    return _dismantle(replace(state, refusal=event.outcome), Phase.REFUSED)


def _deploy(state: State) -> Reaction:
    """Watch, then apply to every component that is new or wired differently, and release those not needed any more."""
    target = state.target
    assert target is not None
    epoch = state.epoch + 1
    wires = wiring(target)
    surplus = [component for component in state.held if component not in wires]
    changed = [component for component, inputs in wires.items() if not _as_wanted(state.held.get(component), inputs)]
    changed.sort(key=state.held.__contains__)  # new components first: others wait for their signals
    effects: list[Effect] = [Watch(component) for component in wires if component not in state.watched]
    effects += [ApplyTo(component, epoch, wires[component]) for component in changed]
    effects += [ReleaseFrom(component, epoch) for component in surplus]
    effects += [Unwatch(component) for component in sorted(state.watched - wires.keys())]
    owed = {component: since for component, since in state.owed.items() if component not in wires}
    deployed = replace(
        state,
        phase=Phase.DEPLOYING,
        epoch=epoch,
        held=_rewired(state.held, wires, changed),
        pending=frozenset((component, Call.APPLY) for component in changed),
        owed={**owed, **dict.fromkeys(surplus, epoch)},
        watched=frozenset(wires),
    )
    return _then(effects, _proceed(deployed))


def _rewired(held: Mapping[IRI, Held], wires: Mapping[IRI, InputWires], changed: Sequence[IRI]) -> dict[IRI, Held]:
    """What is held of a configuration once the changed components are applied to: those have yet to confirm."""
    rewired = {component: before for component, before in held.items() if component in wires}
    for component in changed:
        before = rewired.get(component, Held({}))
        rewired[component] = replace(before, inputs=wires[component], confirmed=False)
    return rewired


def _as_wanted(held: Held | None, inputs: InputWires) -> bool:
    return held is not None and held.confirmed and held.inputs == inputs


def _proceed(state: State) -> Reaction:
    """Go on to the next part of the deployment once nothing is pending."""
    if state.pending:
        return state, ()
    target = state.target
    assert target is not None
    if state.phase is Phase.DEPLOYING:
        wanted: dict[IRI, dict[str, Term]] = {}
        for setting in target.settings:
            if state.held[setting.component].values.get(setting.name) != setting.value:
                wanted.setdefault(setting.component, {})[setting.name] = setting.value
        pending = frozenset((component, Call.SET) for component in wanted)
        effects = [SetOn(component, state.epoch, values) for component, values in wanted.items()]
        return _then(effects, _proceed(replace(state, phase=Phase.SETTING, pending=pending)))
    return replace(state, phase=Phase.RUNNING), (Running(target),)


def _answered(state: State, event: Answered) -> Reaction:
    known = state
    if event.call is Call.RELEASE and event.verdict in OBEYED and event.epoch >= state.owed.get(event.component, 0):
        known = replace(state, owed={c: since for c, since in state.owed.items() if c != event.component})
    if (event.component, event.call) not in state.pending or event.epoch != state.epoch:
        return known, ()
    rest = replace(known, pending=state.pending - {(event.component, event.call)})
    if state.phase is Phase.DISMANTLING:
        return _released(rest)
    if event.verdict is Verdict.DONE:
        held = _confirmed(state, state.held[event.component], event)
        return _proceed(replace(rest, held={**state.held, event.component: held}))
    if event.verdict is Verdict.STALE and event.newest > event.epoch:
        return _deploy(replace(rest, epoch=max(state.epoch, event.newest)))
    detail = event.detail or ("it does not answer" if event.verdict is None else event.verdict.value)
    busy = event.verdict is Verdict.BUSY
    return _lose(state, event.component, Loss(Cause.REFUSED, detail, event.life, busy))


def _confirmed(state: State, held: Held, event: Answered) -> Held:
    """What is known of a component that has obeyed; a new life has nothing set on it."""
    values = held.values if held.life in ("", event.life) else {}
    if event.call is Call.SET and state.target is not None:
        values = {**values, **{s.name: s.value for s in state.target.settings if s.component == event.component}}
    return replace(held, life=event.life, confirmed=True, values=values)


def _failed(state: State, event: Failed) -> Reaction:
    held = state.held.get(event.component)
    if held is None or state.phase is Phase.DISMANTLING:
        return state, ()
    if event.life and held.life and event.life != held.life:
        return state, ()
    if event.cause is Cause.SILENCE and not held.confirmed:
        return state, ()  # it may not have begun
    return _lose(state, event.component, Loss(event.cause, event.detail, event.life or held.life))


def _lose(state: State, component: IRI, loss: Loss) -> Reaction:
    """Turn the lost one off, drop its profile, and search again, with the rest kept or dismantled first."""
    epoch = state.epoch + 1
    without = replace(
        state,
        epoch=epoch,
        held={kept: held for kept, held in state.held.items() if kept != component},
        owed={**state.owed, component: epoch},
        lost={**state.lost, component: loss},
    )
    if state.policy is Policy.DISMANTLE:
        return _dismantle(without, Phase.COMPOSING)
    effects = [ReleaseFrom(component, epoch)] if loss.cause is not Cause.CRASH else []
    if state.phase is Phase.DISCOVERING:
        return without, tuple(effects)
    return _then(effects, _compose(without))


def _dismantle(state: State, afterwards: Phase) -> Reaction:
    """Release everything that is held or owed a release; then comes `afterwards`."""
    epoch = state.epoch + 1
    owed = dict.fromkeys((*state.owed, *state.held), epoch)
    effects: list[Effect] = [ReleaseFrom(component, epoch) for component in owed]
    effects += [Unwatch(component) for component in sorted(state.watched)]
    dismantling = replace(
        state,
        phase=Phase.DISMANTLING,
        afterwards=afterwards,
        epoch=epoch,
        pending=frozenset((component, Call.RELEASE) for component in owed),
        owed=owed,
        watched=frozenset(),
    )
    return _then(effects, _released(dismantling))


def _released(state: State) -> Reaction:
    if state.pending:
        return state, ()
    empty = replace(state, held={}, target=None)
    if state.afterwards is Phase.COMPOSING:
        return _compose(empty)
    ended = replace(empty, phase=state.afterwards)
    if state.afterwards is Phase.STOPPED:
        return ended, (Finish(),)
    if not state.patient:
        return ended, (Finish(state.refusal),)
    return _discover(ended) if state.news else (ended, ())


def _appeared(state: State, event: Appeared) -> Reaction:
    """A component that lives a new life is not the one that was lost, and one that seemed dead was only cut off."""
    if state.phase in (Phase.IDLE, Phase.STOPPED):
        return state, ()
    lost = {
        component: loss
        for component, loss in state.lost.items()
        if component not in event.lives or (loss.cause is not Cause.CRASH and event.lives[component] == loss.life)
    }
    effects = [ReleaseFrom(component, since) for component, since in state.owed.items() if component in event.lives]
    known = replace(state, lost=lost, news=True)
    if state.phase is Phase.REFUSED and state.patient:
        return _then(effects, _discover(known))
    return known, tuple(effects)


def _reconnected(state: State) -> Reaction:
    """Components may have turned themselves off, or died: ask the ecology again, and apply to all of them anew."""
    if state.phase in (Phase.IDLE, Phase.DISMANTLING, Phase.STOPPED):
        return state, ()
    if state.phase is Phase.REFUSED and not state.patient:
        return state, ()
    unsure = {component: Held(held.inputs, held.life) for component, held in state.held.items()}
    return _discover(replace(state, held=unsure))


def _stopped(state: State) -> Reaction:
    if state.phase is Phase.STOPPED or (state.phase is Phase.REFUSED and not state.patient):
        return state, ()
    if state.phase is Phase.DISMANTLING:
        return replace(state, afterwards=Phase.STOPPED), ()
    return _dismantle(state, Phase.STOPPED)


def _then(effects: Sequence[Effect], following: Reaction) -> Reaction:
    state, more = following
    return state, (*effects, *more)
