"""The four acts and the monitoring as one pure function: `step(state, event) -> (state, effects)`.

    IDLE ──accepted──▶ DISCOVERING ──discovered──▶ COMPOSING ──configuration──▶ RESERVING ──all held──▶ DEPLOYING
                            ▲                        ▲   │                         │                       │
                            │                        │   └─refusal──▶ DISMANTLING ─┴──▶ REFUSED            ▼
                            └── something appeared ──┼──────────────────(patient)───────┘               RUNNING
                                                     └──────────────── a component is lost ────────────────┘

Deployment is a transaction (`deploying`): FAIL is watched before anything is called; every component is reserved before
any acts; those that feed act before those that they feed. Whatever ends it (a loss, a refusal, a stop) releases all
that was touched, those that are fed before those that feed them, so that nothing is left half deployed.

Events of a kind have a module of their own: what the ecology and a search answer (`searching`), what components answer
(`answering`), what is lost (`losing`); `phases` says how a task enters each phase. A task of higher priority that asks
for a component of this one makes it let go: everything comes to rest, sinks first, and is configured again without that
component.

Invariants, each a test: a component is watched before it is called; epochs grow; what is held or owed a release is a
superset of what may be active because of this configurator; in IDLE, REFUSED and STOPPED nothing is held; an answer to
an older epoch, or the result of an older search, changes nothing; no component is applied to before all are reserved.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import chain

from selfconf.configurator import answering, deploying, losing, phases, searching
from selfconf.configurator.deploying import DEPLOYING, Reaction, then
from selfconf.configurator.disconnecting import let_rest, loss_lasts
from selfconf.configurator.effects import ReleaseFrom, Watch
from selfconf.configurator.events import (
    Accepted,
    Adopted,
    Answered,
    Appeared,
    BegunElsewhere,
    Call,
    Composed,
    Discovered,
    Event,
    Failed,
    Freed,
    HandedOver,
    Improvable,
    LossLasts,
    Ranked,
    Reconnected,
    Rewired,
    StayedAway,
    Stopped,
    WaitedLong,
)
from selfconf.configurator.starting_order import parameter_values, wiring
from selfconf.configurator.state import Applied, Held, Loss, Phase, Revival, State
from selfconf.model.immutable import replace
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause, RecordedLoss


# complexity: one case for each event; what it does is a function of its own
def step(state: State, event: Event) -> Reaction:
    """What an event does. Total: every state answers every event, if only by staying as it is."""
    match event:
        case Accepted():
            return _accepted(state, event)
        case Adopted():
            return _adopted(state, event)
        case HandedOver():
            return (state, ()) if state.ended else phases.stand_down(state)
        case Discovered():
            return searching.heed_discovery(state, event)
        case Composed():
            return searching.heed_outcome(state, event)
        case Answered():
            return answering.heed_answer(state, event)
        case Failed():
            return losing.heed_failure(state, event)
        case LossLasts():
            return loss_lasts(state, event.actuators)
        case StayedAway():
            return searching.heed_absence(state, event)
        case Freed():
            return answering.heed_free(state, event.component)
        case BegunElsewhere():
            return answering.heed_beginning(state, event.component)
        case WaitedLong():
            return deploying.ask_again(state, event.component) if event.epoch == state.epoch else (state, ())
        case Appeared():
            return _appeared(state, event)
        case Rewired():
            return _rewired(state, event.component, event.rests)
        case Improvable():
            return searching.look_for_better(state, event.unsettled)
        case Reconnected():
            return _reconnected(state)
        case Ranked():
            return _ranked(state, event.priority)
        case Stopped():
            return _stopped(state)


def _accepted(state: State, event: Accepted) -> Reaction:
    if state.phase is not Phase.IDLE:
        return state, ()
    return phases.discover(replace(state, epoch=event.epoch, lost=_losses(event.lost)))


def _losses(recorded: Iterable[RecordedLoss]) -> dict[IRI, Loss]:
    """What another configurator of the task has lost."""
    return {one.component: Loss(one.cause, one.detail, one.life) for one in recorded}


def _adopted(state: State, event: Adopted) -> Reaction:
    """Go on with what runs: every component keeps what it does, and hears for which task from now on.

    It is applied to with the epoch that it acts in: one whose FAIL has not been heard refuses that.
    """
    if state.phase is not Phase.IDLE:
        return state, ()
    wires, values = wiring(event.configuration), parameter_values(event.configuration)
    held = {c: Held(inputs, values[c], asked=True, reserved=True, applied=Applied.ACTS) for c, inputs in wires.items()}
    lost = _losses(event.lost)
    adopted = replace(
        state, epoch=event.epoch - 1, target=event.configuration, held=held, watched=frozenset(wires), lost=lost
    )
    following = then([Watch(component) for component in wires], phases.discover(adopted))
    for component in sorted(lost.keys() & held.keys()):
        known, effects = following
        # The ecology is news to this configurator: a search before it has answered does not count.
        following = then(effects, losing.lose(replace(known, news=True), component, lost[component]))
    return following


def _appeared(state: State, event: Appeared) -> Reaction:
    """A component that lives a new life is not the one that was lost, and one that seemed dead was only cut off.

    A site that comes may bring those with it that could not be reached. What has broken before it acted, and was
    started again, is not tried again before the rest, or a few that break late enough would be tried for ever.
    """
    if state.phase is Phase.IDLE or state.ended:
        return state, ()
    lost = {component: loss for component, loss in state.lost.items() if _stays_lost(component, loss, event.lives)}
    if state.phase is not Phase.RUNNING and not state.waits_for_news:
        again = (one for one, loss in state.lost.items() if one not in lost and loss.broke_early)
        lost |= {one: replace(state.lost[one], revival=Revival.LIVES_ANEW) for one in again}
    owed = event.lives.keys() & state.owed.keys() - set(chain(*state.unreleased))  # those come to rest in their turn
    effects = [ReleaseFrom(component, state.owed[component]) for component in sorted(owed)]
    known = replace(state, lost=lost, news=True)
    if state.phase is Phase.REFUSED:  # what was kept for it when it was refused is kept no more
        known = replace(known, offered=frozenset())
    return then(effects, phases.discover(known)) if state.waits_for_news else (known, tuple(effects))


def _stays_lost(component: IRI, loss: Loss, lives: Mapping[IRI, str]) -> bool:
    """Whether a loss is not disproved by what has appeared: lives by component, or, without any, a site.

    A life without a name is no life in which something was lost. What was silent was cut off if its life has seemed to
    end and goes on.
    """
    if component not in lives:
        return loss.answered or bool(lives)
    cut_off = loss.cause is Cause.CRASH or (loss.cause is Cause.SILENCE and loss.startable)
    return not cut_off and loss.answered and lives[component] == loss.life != ""


def _rewired(state: State, component: IRI, rests: bool) -> Reaction:
    """Tell those that are connected to a component what stands behind it now, after all have received their links.

    The component is one of this configuration, or the composite that this is the inside of, which is what is outside.
    """
    changed = frozenset((component,))
    wired = component in state.held or any(held.is_wired_to(changed) for held in state.held.values())
    if component not in state.held and rests != state.rests:
        state, wired = replace(state, rests=rests), True
        changed |= state.held.keys() & (state.plan.order.actuators if state.plan is not None else frozenset())
    if state.phase is Phase.RUNNING or _waits_for(state, changed):
        return deploying.rewire(state, changed)
    if not wired:
        return state, ()
    known = replace(state, rewired=state.rewired | changed)  # also while another configuration is looked for
    return let_rest(known, changed) if known.rests else (known, ())


def _waits_for(state: State, components: frozenset[IRI]) -> bool:
    """Whether a component, in a change for the better, does not answer before it is fed by what stood behind others."""
    asked = (one for one, call in state.pending if call is Call.APPLY)
    return state.fallback is not None and any(state.held[one].is_wired_to(components) for one in asked)


def _reconnected(state: State) -> Reaction:
    """Components may have turned themselves off, or died: ask the ecology again, and apply to all of them anew."""
    if state.phase in (Phase.IDLE, Phase.DISMANTLING) or state.ended:
        return state, ()
    unsure = {component: held.at_most(Applied.SENT) for component, held in state.held.items()}
    return phases.discover(replace(state.unchanged, held=unsure, return_awaited_since=0))


def _ranked(state: State, priority: int) -> Reaction:
    """Claim everything that is held anew, with the rank that the task has now; what acts acts on."""
    if state.ended:
        return state, ()
    taken, sharers = (
        {component: holder for component, holder in holders.items() if holder.priority >= priority}
        for holders in (state.taken, state.sharers)
    )
    held = {
        component: replace(one.at_most(Applied.ACTS), reserved=one.reserved and one.active)
        for component, one in state.held.items()
    }
    known = replace(state, priority=priority, taken=taken, sharers=sharers, held=held)
    return deploying.deploy(known) if state.phase in (Phase.RUNNING, *DEPLOYING) else (known, ())


def _stopped(state: State) -> Reaction:
    if state.ended:
        return state, ()
    if state.phase is Phase.DISMANTLING:
        return replace(state, afterwards=Phase.STOPPED), ()
    return phases.dismantle(state, Phase.STOPPED)
