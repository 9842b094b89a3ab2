"""What a search leaves out, so that no other task wants something else of the components that it shares.

A component that other tasks hold and would share counts for a search until a configuration is found that wants
something else of it than its holder. Then the search is made again without the sources that it is not to follow, in
the roles in which they would feed it, and if there is no configuration so, without the component itself. Where that was
tried for several components, the reasons of the refusal say for which it was in vain: the others may still be shared.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeVar

from selfconf.model.configuration import Configuration
from selfconf.model.holder import Holder
from selfconf.model.immutable import immutable
from selfconf.model.optimum import Optimum, outcome_of
from selfconf.model.partition import Barred
from selfconf.model.refusal import Conflict, Outcome, Reason, Refusal, TooFewDistinct
from selfconf.model.term import IRI


@immutable
class SharedInput:
    """What a source is avoided for."""

    component: IRI
    """The component that is shared, and would follow the source."""
    role: IRI | None
    """The role in which the source would feed it; None for a recruit."""


Avoided = Mapping[Barred, SharedInput]
"""The sources that a search does without in the roles in which they would feed a shared component."""
MOST_AVOIDED = 10
"""How many sources a search avoids before it does without the components that would follow them."""
Found = TypeVar("Found", bound=Optimum | Outcome)


def avoid(
    contested: Mapping[IRI, Holder], configuration: Configuration, avoided: Avoided
) -> tuple[dict[IRI, Holder], dict[Barred, SharedInput]]:
    """The components to count as taken, and the sources to avoid, after a configuration that others contest.

    `contested` are the components of which their holders want something else, `avoided` what was avoided for it. A
    component is taken where there is nothing more to avoid for it.
    """
    taken, more = {}, dict(avoided)
    for component, holder in contested.items():
        wanted = {source for _, source, _ in holder.wants.inputs}
        sources = sorted({source for _, source, _ in configuration.wants(component).inputs} - wanted)
        # One that was avoided before, in vain, is what feeds a composite: its inside cannot do without that.
        roles = {source: _role(configuration, source) for source in sources}
        new = {(number, source): role for source, (number, role) in roles.items() if (number, source) not in avoided}
        if new and len(more) < MOST_AVOIDED:
            more.update((barred, SharedInput(component, role)) for barred, role in new.items())
        else:
            taken[component] = holder
    return taken, more


def _role(configuration: Configuration, component: IRI) -> tuple[int, IRI] | tuple[None, None]:
    """The number of the role that a component plays, and the role; neither if it is a recruit."""
    playing = (
        (number, one.role) for number, one in enumerate(configuration.assignments) if component in one.components
    )
    return next(playing, (None, None))


def avoided_in_vain(
    avoided: Avoided, outcome: Outcome, sharers: Mapping[IRI, Holder]
) -> tuple[dict[IRI, Holder], dict[Barred, SharedInput]]:
    """The components to count as taken, of those that are held still, and what to avoid for the rest.

    Their sources were avoided in roles which then cannot be played; where no reason names such a role, those of all
    were avoided in vain.
    """
    reasons = outcome.reasons if isinstance(outcome, Refusal) else ()
    unplayed = {role for reason in reasons for role in _roles(reason)}
    in_vain = {one.component for one in avoided.values() if one.role in unplayed}
    in_vain = in_vain or {one.component for one in avoided.values()}
    rest = {barred: one for barred, one in avoided.items() if one.component not in in_vain}
    return {component: sharers[component] for component in in_vain if component in sharers}, rest


def _roles(reason: Reason) -> tuple[IRI, ...]:
    return reason.roles if isinstance(reason, (TooFewDistinct, Conflict)) else (reason.role,)


def agreed(
    search: Callable[[frozenset[Barred]], Found],
    sharers: Mapping[IRI, Holder],
) -> tuple[Found, dict[IRI, Holder]]:
    """What a search finds that no sharer contests, and the sharers' components that are taken for it.

    `search` is given what to leave out.
    """
    taken: dict[IRI, Holder] = {}
    avoided: Avoided = {}
    while True:
        found = search(frozenset((*taken, *avoided)))
        outcome = outcome_of(found)
        if isinstance(outcome, Refusal) and avoided:
            more, avoided = avoided_in_vain(avoided, outcome, sharers)
            taken |= more
            continue
        free = {component: holder for component, holder in sharers.items() if component not in taken}
        contested = contested_by(free, outcome) if isinstance(outcome, Configuration) else {}
        if not isinstance(outcome, Configuration) or not contested:
            return found, taken
        more, avoided = avoid(contested, outcome, avoided)
        taken |= more


def contested_by(sharers: Mapping[IRI, Holder], configuration: Configuration) -> dict[IRI, Holder]:
    """The components of a configuration that others hold and would share, but want something else of."""
    return {
        component: sharers[component]
        for component in configuration.components
        if component in sharers and sharers[component].disagrees(component, configuration)
    }
