"""What comes of asking the ecology and of a search: a configuration to deploy, another search, or a refusal.

A search that finds nothing counts only if nothing has appeared since the ecology was asked; else it is asked again. Nor
does it count before the lost components whose sites can start them again are searched with: they are woken as dormant
ones are, and how often that is done in vain is limited by their sites. What else has gone without a word may have been
cut off for a moment, and a task that has asked for a component may let go of another one, so a task that does not wait
is not refused before that has passed. And what runs goes on as it is, if nothing of it was lost but the sight of a site
that has advertised it.

Components that a task of the same or a higher priority holds do not count for the search; one that can be shared does,
until a configuration is found that wants something else of it than its holder: first the search avoids the sources that
it is not to follow, then the component itself. If the search fails for that reason, those of them that are eligible
where candidates lack are named.

A task that runs looks for something better. What ran before is what is wanted again if such a change does not come
about, whatever the policy: a component that was not part of it is only let go of when it is lost, or a task of higher
priority asks for it. Where what ran loses a component meanwhile, a repair keeps the rest of it: that acts, and the
better one may never.
"""

from __future__ import annotations

from selfconf.configurator import deploying, phases
from selfconf.configurator.deploying import Reaction
from selfconf.configurator.effects import Discover
from selfconf.configurator.events import Composed, Discovered, StayedAway
from selfconf.configurator.phases import NOTHING
from selfconf.configurator.state import Loss, Phase, State
from selfconf.model.configuration import Configuration
from selfconf.model.immutable import replace
from selfconf.model.refusal import Refusal
from selfconf.model.sharing import Avoided, avoid, avoided_in_vain
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause


def heed_discovery(state: State, event: Discovered) -> Reaction:
    """The ecology has answered: search among what there is, but for what others of the same rank or a higher hold."""
    if state.phase is not Phase.DISCOVERING and not state.improving:
        return state, ()
    taken, sharers = (
        {c: one for c, one in holders.items() if one.priority >= state.priority and c not in state.free | state.offered}
        for holders in (event.holders, event.sharers)
    )
    taken = {component: holder for component, holder in taken.items() if component not in state.held}
    lost = {component: loss for component, loss in state.lost.items() if not loss.busy}
    known = replace(
        state, taken=taken, sharers=sharers, lost=lost, unseen=event.unseen, free=frozenset(), improving=False
    )
    if state.phase is Phase.DISCOVERING:
        return phases.compose(known)
    return _improve(replace(known, news=known.news or known.heeds_others))


def _avoid(state: State, configuration: Configuration) -> tuple[State, Avoided]:
    """What to leave out so that no other task wants something else of what it shares than a configuration does."""
    taken, avoided = avoid(state.contested(configuration), configuration, state.avoided)
    return replace(state, taken={**state.taken, **taken}), avoided


def _avoided_in_vain(state: State, event: Composed) -> tuple[State, Avoided]:
    """Count as taken the shared components without whose sources there is no configuration; what else to avoid."""
    taken, avoided = avoided_in_vain(state.avoided, event.outcome, state.sharers)
    return replace(state, taken={**state.taken, **taken}), avoided


def heed_outcome(state: State, event: Composed) -> Reaction:
    """A search has ended; the result of one that is not the newest changes nothing."""
    if event.attempt != state.attempt:
        return state, ()
    if state.phase is Phase.RUNNING:
        return _improved(state, event)
    if state.phase is not Phase.COMPOSING:
        return state, ()
    if state.ignores_holders:
        return _refused(state) if state.asks_again else phases.refuse(_coveted(state, event))
    if isinstance(event.outcome, Configuration):
        if state.contested(event.outcome):
            fewer, avoided = _avoid(state, event.outcome)
            return phases.compose(fewer, avoided=avoided)
        return _found(replace(state, target=event.outcome, plan=event.plan))
    if state.avoided:
        return phases.compose(*_avoided_in_vain(state, event))
    if any(loss.startable for loss in state.lost.values()):
        return phases.compose(replace(state, lost={c: loss for c, loss in state.lost.items() if not loss.startable}))
    return _found_nothing(replace(state, refusal=event.outcome))


def _found(state: State) -> Reaction:
    return deploying.deploy(replace(state, refusal=None, put_off=0, return_awaited_since=0, has_awaited_return=False))


def _found_nothing(state: State) -> Reaction:
    """Nothing was found among all that there is, as far as it has answered."""
    if state.asks_again:
        return _refused(state)
    if state.goes_on_unseen:
        return _found(state)
    return phases.await_return(state) if state.may_await_return else _refused(state)


def heed_absence(state: State, event: StayedAway) -> Reaction:
    """What was lost has not come back while searches that found nothing waited for it."""
    if event.attempt != state.return_awaited_since:
        return state, ()
    waited = replace(state, return_awaited_since=0, has_awaited_return=True)
    if state.phase is not Phase.COMPOSING or not state.awaits_return:
        return replace(waited, news=True), ()  # what is being asked may be answered as it was before
    if state.heeds_others:  # they may have let go of what they held meanwhile
        return phases.discover(waited)
    return _refused(waited)


def _refused(state: State) -> Reaction:
    """A search that found nothing counts, unless something has appeared meanwhile."""
    if state.asks_again:
        return phases.discover(replace(state, put_off=state.put_off + 1))
    return phases.compose_ignoring_holders(state) if state.taken else phases.refuse(state)


def _coveted(state: State, event: Composed) -> State:
    """Count the components of other tasks as lost with which there may be a configuration, unless there is none at all.

    Where that was not decided, it is not said that they stand in the way.
    """
    outcome, refusal = event.outcome, state.refusal
    if isinstance(outcome, Refusal):
        return state
    wanted = event.usable or frozenset(outcome.components if isinstance(outcome, Configuration) else state.taken)
    busy = {
        component: Loss(Cause.REFUSED, str(state.taken[component]), busy=True)
        for component in sorted(wanted & state.taken.keys())
    }
    if isinstance(refusal, Refusal) and isinstance(outcome, Configuration):
        refusal = replace(refusal, held=tuple((component, state.taken[component]) for component in busy))
    return replace(state, lost={**state.lost, **busy}, refusal=refusal)


def look_for_better(state: State, unsettled: frozenset[IRI]) -> Reaction:
    """Ask the ecology anew, while everything runs on: what has appeared may not have been advertised before."""
    if state.phase is not Phase.RUNNING:
        return state, ()
    return replace(state, improving=True, unsettled=unsettled), (Discover(),)


def _improve(state: State, avoided: Avoided = NOTHING) -> Reaction:
    """Search for what the strategy would rather have, while everything runs on."""
    if state.phase is not Phase.RUNNING:
        return state, ()
    return phases.begin_search(state, None, avoided)


def _improved(state: State, event: Composed) -> Reaction:
    """Change to a configuration that the strategy prefers; the one that runs stays until the other delivers."""
    better = event.outcome
    assert state.target is not None
    if not isinstance(better, Configuration):
        return _improve(*_avoided_in_vain(state, event)) if state.avoided else (state, ())
    if (better.assignments, better.recruits) == (state.target.assignments, state.target.recruits):
        return state, ()
    if state.contested(better):
        return _improve(*_avoid(state, better))
    return deploying.deploy(replace(state, target=better, plan=event.plan, fallback=state.target))
