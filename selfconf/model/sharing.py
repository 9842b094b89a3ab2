"""What a search leaves out, so that no other task wants something else of the components that it shares.

A component that other tasks hold and would share counts for a search until a configuration is found that wants
something else of it than its holder. Then the search is made again without the sources that it is not to follow, in
the roles in which they would feed it, and if there is no configuration so, without the component itself.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeVar

from selfconf.model.configuration import Configuration
from selfconf.model.holder import Holder
from selfconf.model.optimum import Optimum, outcome_of
from selfconf.model.partition import Barred
from selfconf.model.refusal import Outcome, Refusal
from selfconf.model.term import IRI

Avoided = Mapping[Barred, IRI]
"""The sources that a search does without in the roles in which they would feed a shared component, with that."""
MOST_AVOIDED = 10
"""How many sources a search avoids before it does without the components that would follow them."""
Found = TypeVar("Found", bound=Optimum | Outcome)


def avoid(
    contested: Mapping[IRI, Holder], configuration: Configuration, avoided: Avoided
) -> tuple[dict[IRI, Holder], dict[Barred, IRI]]:
    """The components to count as taken, and the sources to avoid, after a configuration that others contest.

    `contested` are the components of which their holders want something else, `avoided` what was avoided for it. A
    component is taken where there is nothing more to avoid for it.
    """
    taken, more = {}, dict(avoided)
    for component, holder in contested.items():
        wanted = {source for _, source, _ in holder.wants.inputs}
        sources = sorted({source for _, source, _ in configuration.wants(component).inputs} - wanted)
        # One that was avoided before, in vain, is what feeds a composite: its inside cannot do without that.
        new = [one for source in sources if (one := (_number_of_role(configuration, source), source)) not in avoided]
        if new and len(more) < MOST_AVOIDED:
            more.update(dict.fromkeys(new, component))
        else:
            taken[component] = holder
    return taken, more


def _number_of_role(configuration: Configuration, component: IRI) -> int | None:
    """The number of the role that a component plays; None if it is a recruit."""
    playing = (number for number, one in enumerate(configuration.assignments) if component in one.components)
    return next(playing, None)


def avoided_in_vain(avoided: Avoided, sharers: Mapping[IRI, Holder]) -> dict[IRI, Holder]:
    """The shared components, of those that are held still, without whose sources there is no configuration."""
    return {component: sharers[component] for component in avoided.values() if component in sharers}


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
            taken |= avoided_in_vain(avoided, sharers)
            avoided = {}
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
