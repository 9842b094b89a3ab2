"""How a task enters its phases: it asks the ecology, searches, comes to rest, waits for others, or is left to another.

A component that was released is *owed* a release until it answers: one that was cut off meanwhile may still act, and is
released again when it is seen again. What is to come to rest does so in its order: what is fed before what feeds it.
"""

from __future__ import annotations

from types import MappingProxyType

from selfconf.configurator.deploying import Reaction, acting_wires, release_next, release_rest, then
from selfconf.configurator.effects import (
    AwaitReturn,
    Compose,
    Decline,
    Discover,
    Effect,
    Finish,
    QueueFor,
    Unwatch,
)
from selfconf.configurator.starting_order import resting_waves
from selfconf.configurator.state import Phase, Policy, State
from selfconf.model.configuration import Configuration
from selfconf.model.immutable import replace
from selfconf.model.partition import Barred
from selfconf.model.sharing import Avoided

NOTHING: Avoided = MappingProxyType({})
"""What is avoided by most searches."""


def discover(state: State) -> Reaction:
    """Ask the ecology what there is: act 1."""
    state, releases = release_rest(state)
    asking = replace(state, phase=Phase.DISCOVERING, pending=frozenset(), news=False, repeats={}, improving=False)
    return asking, (*releases, Discover())


def compose(state: State, avoided: Avoided = NOTHING) -> Reaction:
    """Search for a configuration: act 3."""
    return _compose(replace(state, ignores_holders=False), avoided)


def compose_ignoring_holders(state: State) -> Reaction:
    """Search for what there would be if the other tasks let go of what they hold: it is named in a refusal."""
    return _compose(replace(state, ignores_holders=True), NOTHING)


def _compose(state: State, avoided: Avoided) -> Reaction:
    running = state.target if state.policy is Policy.REPAIR else None
    state, releases = release_rest(state)
    searching = replace(state, phase=Phase.COMPOSING, pending=frozenset())
    return then(releases, begin_search(searching, running, avoided))


def begin_search(state: State, running: Configuration | None, avoided: Avoided) -> Reaction:
    """Search near what runs, if anything, without what is lost, held by others or `avoided`; older searches end.

    While the task runs, nothing is changed to that has just appeared.
    """
    attempt = state.attempt + 1
    without: set[Barred] = {*state.lost}
    if not state.ignores_holders:
        without |= state.taken.keys() | avoided.keys()
    if state.phase is Phase.RUNNING:
        without |= state.unsettled - state.held.keys()
    searching = replace(state, attempt=attempt, avoided=avoided, awaits_return=False)
    return searching, (Compose(attempt, frozenset(without), running),)


def await_return(state: State) -> Reaction:
    """Wait a moment before a search that has found nothing counts (`State.may_await_return`): once for all of them."""
    awaiting = replace(state, awaits_return=True)
    if state.return_awaited_since:
        return awaiting, ()
    return replace(awaiting, return_awaited_since=state.attempt), (AwaitReturn(state.attempt),)


def refuse(state: State) -> Reaction:
    """End in a refusal, or wait where the task is patient, once everything is at rest."""
    return dismantle(replace(state, put_off=0), Phase.REFUSED)


def dismantle(state: State, afterwards: Phase) -> Reaction:
    """Release everything that is held or owed a release, what is fed before what feeds; then comes `afterwards`."""
    epoch = state.epoch + 1
    owed = dict.fromkeys((*state.owed, *state.held), epoch)
    dismantling = replace(
        state,
        phase=Phase.DISMANTLING,
        afterwards=afterwards,
        epoch=epoch,
        pending=frozenset(),
        unreleased=resting_waves({**state.surplus, **acting_wires(state)}, owed),
        queued=state.queued - owed.keys(),
        offered=state.offered - owed.keys(),
        fallback=None,
        owed=owed,
        watched=frozenset(),
        return_awaited_since=0,
    )
    return then([Unwatch(component) for component in sorted(state.watched)], released(dismantling))


def released(state: State) -> Reaction:
    """Go on once all that were to come to rest have: with those that feed nothing any more, or with what follows."""
    if state.pending or state.unreleased:
        return release_next(state)
    empty = replace(state, held={}, target=None, plan=None)
    if state.afterwards is Phase.COMPOSING:
        return compose(empty)
    ended = replace(empty, phase=state.afterwards)
    if not ended.ended:
        return discover(ended) if state.news else queue(ended)
    if state.queued:
        return _wait_no_more(state)
    return ended, (Finish(state.refusal if ended.phase is Phase.REFUSED else None),)


def _wait_no_more(state: State) -> Reaction:
    """Have the components that remember that this task waits forget it: the task is about to end."""
    waited_for = tuple(sorted(state.queued))
    owed = {**state.owed, **dict.fromkeys(waited_for, state.epoch)}
    return release_next(replace(state, queued=frozenset(), unreleased=(waited_for,), owed=owed))


def queue(state: State) -> Reaction:
    """Ask for each component that another task holds, so that it tells when it is free, and for no other any more.

    A task of lower priority may hold another one by now, and would have to yield it for nothing; and what is kept for
    this task, which cannot take it yet, goes to the next that waits.
    """
    busy = frozenset(component for component, loss in state.lost.items() if loss.busy)
    left = state.queued - busy
    effects: list[Effect] = [QueueFor(component, state.epoch) for component in sorted(busy - state.owed.keys())]
    effects += [Decline(component, state.epoch) for component in sorted(left - state.owed.keys())]
    return replace(state, queued=busy), tuple(effects)


def stand_down(state: State) -> Reaction:
    """Another configurator goes on with this task: leave everything as it is to that one.

    But for what is not needed any more, and what does not act yet, of which that one does not know: it would wait until
    the component has let go of a configurator that it may never have seen.
    """
    state, releases = release_rest(state) if state.phase is Phase.RUNNING else (state, ())
    fresh = (component for component, held in state.held.items() if held.may_be_held and not held.active)
    effects: list[Effect] = [*releases, *(Decline(component, state.epoch) for component in sorted(fresh))]
    effects += (Unwatch(component) for component in sorted(state.watched))
    left = replace(
        state,
        phase=Phase.STOPPED,
        target=None,
        plan=None,
        held={},
        owed={},
        pending=frozenset(),
        unreleased=(),
        watched=frozenset(),
        queued=frozenset(),
    )
    return left, (*effects, Finish())
