"""What components answer to the calls of a task, and tell of being free for it.

A patient task waits at each component that another task holds and with which it could run: whichever is free first may
be what it takes, and those that wait for one are served in order only if they all wait there. A component that has
obeyed a newer epoch of the task, by the clock of another configurator, does not remember one that waits in an older
epoch: that one asks again in the newer. A component that acts for this task and for others follows something else once
all of them ask for that; a task that asks waits a moment for the others.
"""

from __future__ import annotations

from selfconf.configurator import deploying, losing, phases
from selfconf.configurator.deploying import DEPLOYING, Reaction, then
from selfconf.configurator.disconnecting import disconnect
from selfconf.configurator.effects import Decline, ReleaseFrom
from selfconf.configurator.events import Answered, Call, Unanswered
from selfconf.configurator.state import Applied, Loss, Phase, Revival, State
from selfconf.model.immutable import replace
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause, Verdict

OBEYED = (Verdict.DONE, Verdict.STALE, Verdict.OTHER_LIFE)
"""The answers to a release after which a component obeys no older call of this task."""
MOST_REPEATS = 10
"""How often one component may make a deployment begin anew, by what it says of its epoch or of its holder."""
MOST_AHEAD = 100 * 366 * 86_400_000
"""By how much a component may say that a newer epoch was, in milliseconds as epochs are: no clock is that wrong."""


def heed_answer(state: State, event: Answered) -> Reaction:
    """A component has answered a call, or has not in time; an answer to a call of an older epoch is not waited for."""
    known = deploying.as_claimed(state, event)
    if event.call is Call.RELEASE and event.verdict in OBEYED and event.epoch >= state.owed.get(event.component, 0):
        known = replace(known, owed={c: since for c, since in state.owed.items() if c != event.component})
        if state.phase is Phase.REFUSED and event.component in state.queued & state.owed.keys():
            # It is not asked to remember this task before it has obeyed: a release, which may be doubled, ends that.
            return phases.queue(replace(known, epoch=state.epoch + 1))
    if (event.component, event.call) not in state.pending or event.epoch != state.epoch:
        return _unasked(known, event)
    rest = replace(known, pending=state.pending - {(event.component, event.call)})
    if state.phase is Phase.DISMANTLING:
        return phases.released(rest)
    if state.phase is Phase.RUNNING:
        return deploying.release_next(rest)
    if event.call is Call.RESERVE and state.held[event.component].is_adopted:
        return _answered_claim(rest, event)
    return deploying.confirmed(rest, event) if event.verdict is Verdict.DONE else _declined(rest, event)


def _answered_claim(state: State, event: Answered) -> Reaction:
    """A component that was adopted has answered its claim: what it says otherwise of it, it says again to the apply.

    But one that has obeyed a newer epoch has come to rest, or its configurator was repairing; and while another task
    holds one, nothing is to start.
    """
    if _is_held_elsewhere(state, event):
        return phases.stand_down(state)
    if event.verdict is Verdict.STALE:
        return _declined(state, event)
    taken = event.verdict is Verdict.BUSY and not event.shared
    return deploying.proceed(_forgotten(state, event.component) if taken else state)


def _declined(state: State, event: Answered) -> Reaction:
    """A component has not done what it was asked: ask once more where that may help, else do without it."""
    repeats = state.repeats.get(event.component, 0)
    counted = replace(_told(state, event), repeats={**state.repeats, event.component: repeats + 1})
    if event.verdict is Verdict.STALE and _can_catch_up(event) and repeats < MOST_REPEATS:
        return _catch_up(counted, event)
    if event.verdict is Verdict.NOT_HELD and repeats < MOST_REPEATS:
        return _reserve_anew(counted, event.component)
    if event.verdict is Verdict.BUSY:
        return _busy(replace(counted, queued=state.queued | {event.component}), event)
    if event.verdict is Verdict.OTHER_LIFE:  # the life that was meant has ended, which may be heard of only later
        ended = event.detail or "it has begun another life"
        return losing.lose(state, event.component, Loss(Cause.CRASH, ended, revival=Revival.where(event.startable)))
    return losing.lose(counted, event.component, _loss_by(event, state, again=not repeats))


def _loss_by(event: Answered, state: State, again: bool) -> Loss:
    """The loss of a component that has not done what it was asked; `again`: it had not declined before.

    Its site ends a life that does not obey its release, and can start it again; if it does not, once is enough. What
    has gone without a word, and with its site, may come back with it.
    """
    revival = Revival.where(event.verdict is Unanswered.SILENT and event.startable and again)
    is_gone = event.verdict is Unanswered.SITE_UNSEEN and event.component in state.ended_lives
    cause, detail = Cause.CRASH if is_gone else Cause.REFUSED, event.detail or event.verdict.value
    return Loss(cause, detail, event.life, answered=isinstance(event.verdict, Verdict), revival=revival)


def _told(state: State, event: Answered) -> State:
    """Note that a component that has declined a reserve is not held by that; one that was adopted is to be claimed."""
    held = state.held[event.component] if event.call is Call.RESERVE else None
    if held is None or isinstance(event.verdict, Unanswered) or held.is_adopted:
        return state
    return replace(state, held={**state.held, event.component: replace(held, asked=False)})


def _can_catch_up(event: Answered) -> bool:
    """Whether a component that has obeyed a newer epoch may have it from a clock that was ahead."""
    return 0 < event.newest - event.epoch < MOST_AHEAD


def _catch_up(state: State, event: Answered) -> Reaction:
    """Deploy in an epoch newer than what a component has obeyed: one that is adopted may have let go of the task."""
    known = _forgotten(state, event.component) if state.held[event.component].is_adopted else state
    return deploying.deploy(replace(known, epoch=max(state.epoch, event.newest)))


def _busy(state: State, event: Answered) -> Reaction:
    """Another task holds a component: wait for it, or do without it; nothing of this task follows it meanwhile."""
    if _is_held_elsewhere(state, event):
        return phases.stand_down(state)
    if event.shared and event.call is Call.APPLY:
        if deploying.may_agree(state, event.component, event.holder):
            return deploying.await_agreement(state, event.component)
        if state.fallback is not None and losing.is_needed(state, event.component):
            return deploying.deploy(replace(state, target=state.fallback, fallback=None))
    apart, effects = disconnect(state, frozenset((event.component,)))
    if deploying.may_wait_for(apart, event.component, event.holder):
        if event.call is Call.RESERVE and not effects:
            return deploying.await_release(state, event.component)
        if state.repeats[event.component] <= MOST_REPEATS:
            return then(effects, _reserve_anew(apart, event.component))
    if event.component not in apart.asked_about:  # before this is a refusal: who holds it, and what they insist on
        apart = replace(apart, news=True, asked_about=apart.asked_about | {event.component})
    busy = Loss(Cause.REFUSED, event.detail or "another task holds it", event.life, busy=True)
    return then(effects, losing.lose(apart, event.component, busy))


def _is_held_elsewhere(state: State, event: Answered) -> bool:
    """Whether another configurator of the same task holds a component, and goes on with the task."""
    return event.holder is not None and event.holder.task == state.task and not state.alone


def _reserve_anew(state: State, component: IRI) -> Reaction:
    """Reserve a component that does not act for this task, as it was not held any more, or not yet."""
    return deploying.deploy(_forgotten(state, component))


def _forgotten(state: State, component: IRI) -> State:
    """The state in which a component is not held, and does not act, as far as is known."""
    forgotten = replace(state.held[component], asked=False, reserved=False, applied=Applied.NOT_YET)
    return replace(state, held={**state.held, component: forgotten})


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


def _queue_anew(state: State, event: Answered) -> Reaction:
    """Ask again for a component that does not remember this task, as it has obeyed a newer epoch of it.

    That was another configurator of the task, by a clock that was ahead of this one's.
    """
    repeats = state.repeats.get(event.component, 0)
    if state.phase is not Phase.REFUSED or not _can_catch_up(event) or repeats >= MOST_REPEATS:
        return state, ()
    counted = {**state.repeats, event.component: repeats + 1}
    # All are asked: what one of them answers in the epoch that is over now would be passed over.
    return phases.queue(replace(state, epoch=event.newest, repeats=counted))


def heed_free(state: State, component: IRI) -> Reaction:
    """A component is free, and kept for this task for a moment."""
    if state.phase is Phase.IDLE or state.ended:
        return state, (Decline(component, state.epoch),)
    if state.phase in DEPLOYING and {(component, Call.RESERVE), (component, Call.APPLY)} & state.pending:
        return deploying.ask_again(state, component)
    known, effects = _free(state, component)
    searches = known.phase in (Phase.DISCOVERING, Phase.COMPOSING)  # and may find that it is what it takes
    if searches or effects:
        return replace(known, offered=known.offered | {component}), effects
    if component in state.held:  # it remembers this task until it is reserved or released
        return deploying.take_offered(replace(known, offered=known.offered | {component}), component)
    return replace(known, queued=known.queued - {component}), (Decline(component, state.epoch),)


def heed_beginning(state: State, component: IRI) -> Reaction:
    """A component acts for another task, which may want the same of it: a task that waits looks whether it does."""
    if state.phase is not Phase.REFUSED:
        return deploying.ask_again(state, component)
    return phases.discover(state) if component in state.queued & state.sharers.keys() else (state, ())


def _free(state: State, component: IRI) -> Reaction:
    """No other task holds a component any more: it counts again for the search."""
    lost = {c: loss for c, loss in state.lost.items() if c != component or not loss.busy}
    taken, sharers = (
        {c: holder for c, holder in holders.items() if c != component} for holders in (state.taken, state.sharers)
    )
    known = replace(state, lost=lost, taken=taken, sharers=sharers, free=state.free | {component}, news=True)
    known = replace(known, asked_about=state.asked_about - {component})
    return phases.discover(known) if state.waits_for_news else (known, ())
