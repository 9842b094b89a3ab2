"""The four acts and the monitoring as one pure function: `step(state, event) -> (state, effects)`.

    IDLE ──accepted──▶ DISCOVERING ──discovered──▶ COMPOSING ──configuration──▶ RESERVING ──all held──▶ DEPLOYING
                            ▲                        ▲   │                         │                       │
                            │                        │   └─refusal──▶ DISMANTLING ─┴──▶ REFUSED            ▼
                            └── something appeared ──┼──────────────────(patient)───────┘               RUNNING
                                                     └──────────────── a component is lost ────────────────┘

Deployment is a transaction (`deploying`): FAIL is watched before anything is called; every component is reserved before
any acts; those that feed act before those that they feed. Whatever ends it (a loss, a refusal, a stop) releases all
that was touched, those that are fed before those that feed them, so that nothing is left half deployed.

Two policies for a loss. `REPAIR` keeps what runs and changes what must change; `DISMANTLE` first takes everything
down, as the paper does (section 4.2). Either way the lost component is turned off and its profile dropped, and the
search runs again. A search that finds nothing counts only if nothing has appeared since the ecology was asked; else
it is asked again. Nor does it count before the lost components whose sites can start them again are searched with: they
are woken as dormant ones are, and how often that is done in vain is limited by their sites.

Other tasks. Components that a task of the same or a higher priority holds do not count for the search; one that can be
shared does, until a configuration is found that wants something else of it than its holder: first the search avoids
the sources that it is not to follow, then the component itself. If the search fails for that reason, those of them that
are eligible where candidates lack are named, and a patient task waits at each: whichever is free first may be what it
takes, and those that wait for one are served in order only if they all wait there. A component that has obeyed a newer
epoch of the task, by the clock of another configurator, does not remember one that waits in an older epoch: that one
asks again in the newer. A task of higher priority that asks for a component of this one makes it let go: everything
comes to rest, sinks first, and is configured again without that component. A component that acts for this task and for
others follows something else once all of them ask for that; a task that asks waits a moment for the others.

Changes for the better. What ran before is what is wanted again if such a change does not come about, whatever the
policy: a component that was not part of it is only let go of when it is lost, or a task of higher priority asks for it.
Where what ran loses a component meanwhile, a repair keeps the rest of it: that acts, and the better one may never.

A component that was released is *owed* a release until it answers: one that was cut off meanwhile may still act, and is
released again when it is seen again.

Invariants, each a test: a component is watched before it is called; epochs grow; what is held or owed a release is a
superset of what may be active because of this configurator; in IDLE, REFUSED and STOPPED nothing is held; an answer to
an older epoch, or the result of an older search, changes nothing; no component is applied to before all are reserved.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType

from selfconf.configurator import deploying
from selfconf.configurator.deploying import DEPLOYING, Reaction, then
from selfconf.configurator.disconnecting import disconnect, let_rest, loss_lasts
from selfconf.configurator.effects import (
    Compose,
    Decline,
    Discover,
    Effect,
    Finish,
    QueueFor,
    ReleaseFrom,
    Unwatch,
    WakeUp,
    Watch,
)
from selfconf.configurator.events import (
    Accepted,
    Adopted,
    Answered,
    Appeared,
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
    Stopped,
    WaitedLong,
)
from selfconf.configurator.starting_order import parameter_values, resting_next, wiring
from selfconf.configurator.state import Held, Loss, Phase, Policy, State
from selfconf.model.configuration import Configuration
from selfconf.model.refusal import Refusal
from selfconf.model.sharing import Avoided, avoid, avoided_in_vain
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause, Verdict

NOTHING: Avoided = MappingProxyType({})
"""What is avoided by most searches."""
OBEYED = (Verdict.DONE, Verdict.STALE, Verdict.OTHER_LIFE)
"""The answers to a release after which a component obeys no older call of this task."""
PROCESS_ENDS = (Cause.CRASH, Cause.HUNG)
"""The causes for which a component is started again: a site ends a process that hangs."""
MOST_REPEATS = 10
"""How often one component may make a deployment begin anew, by what it says of its epoch or of its holder."""
MOST_AHEAD = 100 * 366 * 86_400_000
"""By how much a component may say that a newer epoch was, in milliseconds as epochs are: no clock is that wrong."""


# complexity: one case for each event; what it does is a function of its own
def step(state: State, event: Event) -> Reaction:
    """What an event does. Total: every state answers every event, if only by staying as it is."""
    match event:
        case Accepted():
            return _discover(replace(state, epoch=event.epoch)) if state.phase is Phase.IDLE else (state, ())
        case Adopted():
            return _adopted(state, event)
        case HandedOver():
            return (state, ()) if state.ended else _stand_down(state)
        case Discovered():
            return _discovered(state, event)
        case Composed():
            return _composed(state, event)
        case Answered():
            return _answered(state, event)
        case Failed():
            return _failed(state, event)
        case LossLasts():
            return loss_lasts(state, event.actuators)
        case Freed():
            return _freed(state, event.component)
        case WaitedLong():
            return deploying.ask_again(state, event.component) if event.epoch == state.epoch else (state, ())
        case Appeared():
            return _appeared(state, event)
        case Rewired():
            return _rewired(state, event.component, event.rests)
        case Improvable():
            return _look_for_better(state)
        case Reconnected():
            return _reconnected(state)
        case Ranked():
            return _ranked(state, event.priority)
        case Stopped():
            return _stopped(state)


def _adopted(state: State, event: Adopted) -> Reaction:
    """Go on with what runs: every component keeps what it does, and hears for which task from now on.

    It is applied to with the epoch that it acts in: one whose FAIL has not been heard refuses that.
    """
    if state.phase is not Phase.IDLE:
        return state, ()
    wires, values = wiring(event.configuration), parameter_values(event.configuration)
    held = {c: Held(inputs, values[c], reserved=True, active=True, acts=True) for c, inputs in wires.items()}
    adopted = replace(state, epoch=event.epoch - 1, target=event.configuration, held=held, watched=frozenset(wires))
    return then([Watch(component) for component in wires], _discover(adopted))


def _discover(state: State) -> Reaction:
    asking = replace(state, phase=Phase.DISCOVERING, pending=frozenset(), news=False, repeats={}, improving=False)
    return asking, (Discover(),)


def _discovered(state: State, event: Discovered) -> Reaction:
    if state.phase is not Phase.DISCOVERING and not state.improving:
        return state, ()
    taken, sharers = (
        {c: one for c, one in holders.items() if one.priority >= state.priority and c not in state.free}
        for holders in (event.holders, event.sharers)
    )
    taken = {component: holder for component, holder in taken.items() if component not in state.held}
    lost = {component: loss for component, loss in state.lost.items() if not loss.busy}
    known = replace(state, taken=taken, sharers=sharers, lost=lost, free=frozenset(), improving=False)
    return _compose(known) if state.phase is Phase.DISCOVERING else _improve(known)


def _compose(state: State, despite: bool = False, avoided: Avoided = NOTHING) -> Reaction:
    running = state.target if state.policy is Policy.REPAIR else None
    searching = replace(state, phase=Phase.COMPOSING, pending=frozenset(), despite=despite)
    return _search(searching, running, avoided)


def _search(state: State, running: Configuration | None, avoided: Avoided) -> Reaction:
    attempt = state.attempt + 1
    without = state.lost.keys() if state.despite else state.lost.keys() | state.taken.keys() | avoided.keys()
    return replace(state, attempt=attempt, avoided=avoided), (Compose(attempt, frozenset(without), running),)


def _avoid(state: State, configuration: Configuration) -> tuple[State, Avoided]:
    """What to leave out so that no other task wants something else of what it shares than a configuration does."""
    taken, avoided = avoid(state.contested(configuration), configuration, state.avoided)
    return replace(state, taken={**state.taken, **taken}), avoided


def _avoided_in_vain(state: State) -> State:
    """Count as taken the shared components without whose sources there is no configuration."""
    return replace(state, taken={**state.taken, **avoided_in_vain(state.avoided, state.sharers)})


def _composed(state: State, event: Composed) -> Reaction:
    if event.attempt != state.attempt:
        return state, ()
    if state.phase is Phase.RUNNING:
        return _improved(state, event)
    if state.phase is not Phase.COMPOSING:
        return state, ()
    if state.despite:
        return _refuse(_coveted(state, event))
    if isinstance(event.outcome, Configuration):
        if state.contested(event.outcome):
            fewer, avoided = _avoid(state, event.outcome)
            return _compose(fewer, avoided=avoided)
        return deploying.deploy(replace(state, target=event.outcome, refusal=None, put_off=0))
    if state.avoided:
        return _compose(_avoided_in_vain(state))
    if any(loss.startable for loss in state.lost.values()):
        return _compose(replace(state, lost={c: loss for c, loss in state.lost.items() if not loss.startable}))
    if state.asks_again:
        return _discover(replace(state, put_off=state.put_off + 1))
    refused = replace(state, refusal=event.outcome)
    return _compose(refused, despite=True) if state.taken else _refuse(refused)


def _coveted(state: State, event: Composed) -> State:
    """Count the components of other tasks as lost with which there may be a configuration, if there is one at all."""
    if not isinstance(event.outcome, Configuration):
        return state
    wanted = event.usable or frozenset(event.outcome.components)
    busy = {
        component: Loss(Cause.REFUSED, str(state.taken[component]), "", True)
        for component in sorted(wanted & state.taken.keys())
    }
    refusal = state.refusal
    if isinstance(refusal, Refusal):
        refusal = replace(refusal, held=tuple((component, state.taken[component]) for component in busy))
    return replace(state, lost={**state.lost, **busy}, refusal=refusal)


def _refuse(state: State) -> Reaction:
    return _dismantle(replace(state, put_off=0), Phase.REFUSED)


def _answered(state: State, event: Answered) -> Reaction:
    known = state
    if event.call is Call.RELEASE and event.verdict in OBEYED and event.epoch >= state.owed.get(event.component, 0):
        known = replace(state, owed={c: since for c, since in state.owed.items() if c != event.component})
    if (event.component, event.call) not in state.pending or event.epoch != state.epoch:
        return _unasked(known, event)
    rest = replace(known, pending=state.pending - {(event.component, event.call)})
    if state.phase is Phase.DISMANTLING:
        return _released(rest)
    return deploying.confirmed(rest, event) if event.verdict is Verdict.DONE else _declined(rest, event)


def _declined(state: State, event: Answered) -> Reaction:
    """A component has not done what it was asked: ask once more where that may help, else do without it."""
    repeats = state.repeats.get(event.component, 0)
    counted = replace(_told(state, event), repeats={**state.repeats, event.component: repeats + 1})
    if event.verdict is Verdict.STALE and _can_catch_up(event) and repeats < MOST_REPEATS:
        return deploying.deploy(replace(counted, epoch=max(state.epoch, event.newest)))
    if event.verdict is Verdict.NOT_HELD and repeats < MOST_REPEATS:
        return _reserve_anew(counted, event.component)
    if event.verdict is Verdict.BUSY:
        return _busy(replace(counted, queued=state.queued | {event.component}), event)
    if event.verdict is Verdict.OTHER_LIFE:  # the life that was meant has ended, which may be heard of only later
        ended = event.detail or "it has begun another life"
        return _lose(state, event.component, Loss(Cause.CRASH, ended, startable=event.startable))
    silent = event.verdict is None
    detail = event.detail or ("it does not answer" if event.verdict is None else event.verdict.value)
    # Its site ends a life that does not obey its release, and can start it again; if it does not, once is enough.
    again = silent and event.startable and event.call is not Call.WAKE and not repeats
    return _lose(counted, event.component, Loss(Cause.REFUSED, detail, event.life, False, not silent, again))


def _told(state: State, event: Answered) -> State:
    """Note that a component that has declined a reserve is not held by that."""
    if event.verdict is None or event.call is not Call.RESERVE:
        return state
    return replace(state, held={**state.held, event.component: replace(state.held[event.component], asked=False)})


def _can_catch_up(event: Answered) -> bool:
    """Whether a component that has obeyed a newer epoch may have it from a clock that was ahead."""
    return 0 < event.newest - event.epoch < MOST_AHEAD


def _busy(state: State, event: Answered) -> Reaction:
    """Another task holds a component: wait for it, or do without it; nothing of this task follows it meanwhile."""
    if event.holder is not None and event.holder.task == state.task and not state.alone:
        return _stand_down(state)
    if event.shared and event.call is Call.APPLY:
        if deploying.may_agree(state, event.component, event.holder):
            return deploying.await_agreement(state, event.component)
        if state.fallback is not None and _is_needed(state, event.component):
            return deploying.deploy(replace(state, target=state.fallback, fallback=None))
    apart, effects = disconnect(state, frozenset((event.component,)))
    if deploying.may_wait_for(apart, event.component, event.holder):
        if event.call is Call.RESERVE and not effects:
            return deploying.await_release(state, event.component)
        if state.repeats[event.component] <= MOST_REPEATS:
            return then(effects, _reserve_anew(apart, event.component))
    if event.shared:  # others insist on something else: what that is says the ecology, before this is a refusal
        apart = replace(apart, news=True)
    busy = Loss(Cause.REFUSED, event.detail or "another task holds it", event.life, True)
    return then(effects, _lose(apart, event.component, busy))


def _reserve_anew(state: State, component: IRI) -> Reaction:
    """Reserve a component that does not act for this task, as it was not held any more, or not yet."""
    forgotten = replace(state.held[component], asked=False, reserved=False, active=False, acts=False, confirmed=False)
    return deploying.deploy(replace(state, held={**state.held, component: forgotten}))


def _unasked(state: State, event: Answered) -> Reaction:
    """An answer that is not waited for: a component that is held now for nothing is released."""
    if event.verdict is Verdict.STALE and event.component in state.queued and event.epoch == state.epoch:
        return _queue_anew(state, event)
    unwanted = event.component not in state.held and not state.ended
    if unwanted and event.call is Call.RESERVE and event.verdict is Verdict.DONE:
        owed = {**state.owed, event.component: state.epoch}
        release = ReleaseFrom(event.component, state.epoch)
        queued = state.queued - {event.component}
        return then((release,), _free(replace(state, owed=owed, queued=queued), event.component))
    return state, ()


def _stand_down(state: State) -> Reaction:
    """Another configurator goes on with this task: leave everything as it is to that one."""
    effects: list[Effect] = [Unwatch(component) for component in sorted(state.watched)]
    left = replace(
        state,
        phase=Phase.STOPPED,
        target=None,
        order=None,
        held={},
        owed={},
        pending=frozenset(),
        unreleased=(),
        watched=frozenset(),
        queued=frozenset(),
    )
    return left, (*effects, Finish())


def _failed(state: State, event: Failed) -> Reaction:
    held = state.held.get(event.component)
    if held is None or state.phase is Phase.DISMANTLING:
        return state, ()
    if event.life and not held.life and state.ended_lives.get(event.component) == event.life:
        return _lost_already(state, event.component)
    if _passes_over(held, event):
        return state, ()
    startable = event.startable and event.cause in PROCESS_ENDS
    if startable:  # the next life has not made the deployment begin anew
        state = replace(state, repeats={c: times for c, times in state.repeats.items() if c != event.component})
    loss = Loss(event.cause, event.detail, event.life or held.life, event.cause is Cause.YIELD, startable=startable)
    if event.cause not in (Cause.YIELD, Cause.LET_GO):
        return _lose(state, event.component, loss)
    if not held.reserved:
        return state, ()  # another task is asked to let go of it, perhaps for this one
    return _let_go(state, event.component, loss)


def _passes_over(held: Held, event: Failed) -> bool:
    """Whether it is another life than the one that is held which has failed, or one silent that may not have begun."""
    another = bool(event.life and held.life and event.life != held.life)
    return another or (event.cause is Cause.SILENCE and not held.confirmed)


def _lost_already(state: State, component: IRI) -> Reaction:
    """A component is held anew whose last life was lost: have it woken again, as its site may have thought it alive."""
    return state, (WakeUp(component, state.epoch),) if (component, Call.WAKE) in state.pending else ()


def _let_go(state: State, component: IRI, loss: Loss) -> Reaction:
    """Let go of a component that another task asks for, or that has let go of this one and so can be had again."""
    lost = {**state.lost, component: loss} if loss.busy else state.lost
    if not _is_needed(state, component):
        known, effects = _lose(state, component, loss)
        return replace(known, lost=lost), effects
    # Nothing may act on a part: all come to rest, the component in its turn.
    return _dismantle(replace(state, lost=lost, news=state.news or not loss.busy), Phase.COMPOSING)


def _lose(state: State, component: IRI, loss: Loss) -> Reaction:
    """Turn the lost one off, drop its profile, and search again, with the rest kept or dismantled first."""
    epoch = state.epoch + 1
    without = replace(
        state,
        epoch=epoch,
        held={kept: held for kept, held in state.held.items() if kept != component},
        owed={**state.owed, component: epoch},
        lost={**state.lost, component: loss},
        queued=state.queued - {component},
    )
    if loss.cause in PROCESS_ENDS and loss.life:
        without = replace(without, ended_lives={**state.ended_lives, component: loss.life})
    effects = (ReleaseFrom(component, epoch),)  # also what seems to be dead: it may hear, and not be heard
    if not _is_needed(state, component):
        return then(effects, deploying.deploy(replace(without, target=state.fallback or state.target, fallback=None)))
    if state.policy is Policy.DISMANTLE:
        return _dismantle(without, Phase.COMPOSING)
    if state.phase is Phase.DISCOVERING:
        return without, effects
    return then(effects, _compose(replace(without, target=state.fallback or state.target, fallback=None)))


def _is_needed(state: State, component: IRI) -> bool:
    """Whether a component may be part of what is to run: not if that is being deployed, or ran before, without it."""
    wanted = state.fallback or state.target
    return state.phase not in DEPLOYING or wanted is None or component in wanted.components


def _dismantle(state: State, afterwards: Phase) -> Reaction:
    """Release everything that is held or owed a release, what is fed before what feeds; then comes `afterwards`."""
    epoch = state.epoch + 1
    owed = dict.fromkeys((*state.owed, *state.held), epoch)
    dismantling = replace(
        state,
        phase=Phase.DISMANTLING,
        afterwards=afterwards,
        epoch=epoch,
        pending=frozenset(),
        unreleased=tuple(owed),
        queued=state.queued - owed.keys(),
        fallback=None,
        owed=owed,
        watched=frozenset(),
    )
    return then([Unwatch(component) for component in sorted(state.watched)], _released(dismantling))


def _released(state: State) -> Reaction:
    """Go on once all that were to come to rest have: with those that feed nothing any more, or with what follows."""
    if state.pending:
        return state, ()
    if state.unreleased:
        return _release_next(state)
    empty = replace(state, held={}, target=None, order=None)
    if state.afterwards is Phase.COMPOSING:
        return _compose(empty)
    ended = replace(empty, phase=state.afterwards)
    if not ended.ended:
        return _discover(ended) if state.news else _queue(ended)
    if state.queued:
        return _wait_no_more(state)
    return ended, (Finish(state.refusal if ended.phase is Phase.REFUSED else None),)


def _release_next(state: State) -> Reaction:
    """Release those that feed none of the others that are to come to rest."""
    wires = {component: held.inputs for component, held in state.held.items() if held.active}
    now = resting_next(wires, state.unreleased)
    left = tuple(component for component in state.unreleased if component not in set(now))
    pending = frozenset((component, Call.RELEASE) for component in now)
    effects = tuple(ReleaseFrom(component, state.epoch) for component in now)
    return replace(state, unreleased=left, pending=pending), effects


def _wait_no_more(state: State) -> Reaction:
    """Have the components that remember that this task waits forget it: the task is about to end."""
    waited_for = tuple(sorted(state.queued))
    owed = {**state.owed, **dict.fromkeys(waited_for, state.epoch)}
    return _release_next(replace(state, queued=frozenset(), unreleased=waited_for, owed=owed))


def _queue(state: State) -> Reaction:
    """Ask for each component that another task holds, so that it tells when it is free."""
    queued = state.queued.union(component for component, loss in state.lost.items() if loss.busy)
    effects = tuple(QueueFor(component, state.epoch) for component in sorted(queued - state.owed.keys()))
    return replace(state, queued=queued), effects


def _queue_anew(state: State, event: Answered) -> Reaction:
    """Ask again for a component that does not remember this task, as it has obeyed a newer epoch of it.

    That was another configurator of the task, by a clock that was ahead of this one's.
    """
    repeats = state.repeats.get(event.component, 0)
    if state.phase is not Phase.REFUSED or not _can_catch_up(event) or repeats >= MOST_REPEATS:
        return state, ()
    counted = {**state.repeats, event.component: repeats + 1}
    # All are asked: what one of them answers in the epoch that is over now would be passed over.
    return _queue(replace(state, epoch=event.newest, repeats=counted))


def _freed(state: State, component: IRI) -> Reaction:
    """A component is free, and kept for this task for a moment."""
    if state.phase is Phase.IDLE or state.ended:
        return state, (Decline(component, state.epoch),)
    if state.phase in DEPLOYING and {(component, Call.RESERVE), (component, Call.APPLY)} & state.pending:
        return deploying.ask_again(state, component)
    known, effects = _free(state, component)
    if effects or component in state.held:
        return known, effects  # it remembers this task until it is reserved or released
    return replace(known, queued=known.queued - {component}), (Decline(component, state.epoch),)


def _free(state: State, component: IRI) -> Reaction:
    """No other task holds a component any more: it counts again for the search."""
    lost = {c: loss for c, loss in state.lost.items() if c != component or not loss.busy}
    taken, sharers = (
        {c: holder for c, holder in holders.items() if c != component} for holders in (state.taken, state.sharers)
    )
    known = replace(state, lost=lost, taken=taken, sharers=sharers, free=state.free | {component}, news=True)
    return _discover(known) if state.phase is Phase.REFUSED else (known, ())


def _appeared(state: State, event: Appeared) -> Reaction:
    """A component that lives a new life is not the one that was lost, and one that seemed dead was only cut off.

    A site that comes may bring those with it that could not be reached.
    """
    if state.phase is Phase.IDLE or state.ended:
        return state, ()
    lost = {component: loss for component, loss in state.lost.items() if _stays_lost(component, loss, event.lives)}
    owed = event.lives.keys() & state.owed.keys() - set(state.unreleased)  # those come to rest in their turn
    effects = [ReleaseFrom(component, state.owed[component]) for component in sorted(owed)]
    known = replace(state, lost=lost, news=True)
    if state.phase is Phase.REFUSED:
        return then(effects, _discover(known))
    return known, tuple(effects)


def _stays_lost(component: IRI, loss: Loss, lives: Mapping[IRI, str]) -> bool:
    """Whether a loss is not disproved by what has appeared: lives by component, or, without any, a site."""
    if component not in lives:
        return loss.answered or bool(lives)
    return loss.cause is not Cause.CRASH and loss.answered and lives[component] == loss.life


def _look_for_better(state: State) -> Reaction:
    """Ask the ecology anew, while everything runs on: what has appeared may not have been advertised before."""
    if state.phase is not Phase.RUNNING:
        return state, ()
    return replace(state, improving=True), (Discover(),)


def _improve(state: State, avoided: Avoided = NOTHING) -> Reaction:
    """Search for what the strategy would rather have, while everything runs on."""
    if state.phase is not Phase.RUNNING:
        return state, ()
    return _search(state, None, avoided)


def _improved(state: State, event: Composed) -> Reaction:
    """Change to a configuration that the strategy prefers; the one that runs stays until the other delivers."""
    better = event.outcome
    assert state.target is not None
    if not isinstance(better, Configuration):
        return _improve(_avoided_in_vain(state)) if state.avoided else (state, ())
    if better.assignments == state.target.assignments:
        return state, ()
    if state.contested(better):
        return _improve(*_avoid(state, better))
    return deploying.deploy(replace(state, target=better, fallback=state.target))


def _rewired(state: State, component: IRI, rests: bool) -> Reaction:
    """Tell those that are connected to a component what stands behind it now, after all have received their links.

    The component is one of this configuration, or the composite that this is the inside of, which is what is outside.
    """
    changed = frozenset((component,))
    wired = component in state.held or any(deploying.is_wired_to(held, changed) for held in state.held.values())
    if component not in state.held and rests != state.rests:
        state, wired = replace(state, rests=rests), True
        changed |= state.held.keys() & (state.order.actuators if state.order is not None else frozenset())
    if state.phase is Phase.RUNNING or _waits_for(state, changed):
        return deploying.rewire(state, changed)
    if not wired:
        return state, ()
    known = replace(state, rewired=state.rewired | changed)  # also while another configuration is looked for
    return let_rest(known, changed) if known.rests else (known, ())


def _waits_for(state: State, components: frozenset[IRI]) -> bool:
    """Whether a component, in a change for the better, does not answer before it is fed by what stood behind others."""
    asked = (one for one, call in state.pending if call is Call.APPLY and one in state.held)
    return state.fallback is not None and any(deploying.is_wired_to(state.held[one], components) for one in asked)


def _reconnected(state: State) -> Reaction:
    """Components may have turned themselves off, or died: ask the ecology again, and apply to all of them anew."""
    if state.phase in (Phase.IDLE, Phase.DISMANTLING) or state.ended:
        return state, ()
    unsure = {component: replace(held, acts=False, confirmed=False) for component, held in state.held.items()}
    return _discover(replace(state, target=state.fallback or state.target, held=unsure, fallback=None))


def _ranked(state: State, priority: int) -> Reaction:
    """Claim everything that is held anew, with the rank that the task has now; what acts acts on."""
    if state.ended:
        return state, ()
    taken, sharers = (
        {component: holder for component, holder in holders.items() if holder.priority >= priority}
        for holders in (state.taken, state.sharers)
    )
    held = {
        component: replace(one, reserved=one.reserved and one.active, confirmed=False)
        for component, one in state.held.items()
    }
    known = replace(state, priority=priority, taken=taken, sharers=sharers, held=held)
    return deploying.deploy(known) if state.phase in (Phase.RUNNING, *DEPLOYING) else (known, ())


def _stopped(state: State) -> Reaction:
    if state.ended:
        return state, ()
    if state.phase is Phase.DISMANTLING:
        return replace(state, afterwards=Phase.STOPPED), ()
    return _dismantle(state, Phase.STOPPED)
