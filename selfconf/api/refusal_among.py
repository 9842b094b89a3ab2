"""The refusal of a task that runs, with the advertisements among which it was found.

What else a refusal can tell is found out later: by then another search may have been made, in another ecology.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import field, fields

from selfconf.model.immutable import FrozenMapping, immutable
from selfconf.model.optimum import Optimum
from selfconf.model.refusal import Outcome, Refusal
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement


@immutable
class RefusalAmong(Refusal):
    """A refusal that keeps among which advertisements no configuration was found, also where facts are added to it."""

    ecology: Mapping[IRI, Advertisement] = field(kw_only=True, repr=False, compare=False)


def outcome_among(answer: Optimum | Outcome, found: Mapping[IRI, Advertisement], lost: Collection[IRI]) -> Outcome:
    """What a search in an ecology without its lost components has come to: a refusal keeps that ecology."""
    if isinstance(answer, Refusal):
        able = FrozenMapping({component: one for component, one in found.items() if component not in lost})
        return RefusalAmong(**{one.name: getattr(answer, one.name) for one in fields(Refusal)}, ecology=able)
    return answer.configuration if isinstance(answer, Optimum) else answer


def searched_ecology(refusal: Refusal) -> Mapping[IRI, Advertisement]:
    """The advertisements among which a refusal was found; none if it does not keep them."""
    return refusal.ecology if isinstance(refusal, RefusalAmong) else {}
