"""What else a refusal can tell: which components nearly fit by type, what would mend it, the reasoning that would."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from selfconf.composition.composer import Composer
from selfconf.composition.time_limit import TimeLimit
from selfconf.model.hierarchy import Hierarchy
from selfconf.model.partition import NearMiss
from selfconf.model.refusal import Refusal, TooFewEligible
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.eligibility import near_misses_by_type


def explained(
    composer: Composer,
    ecology: Mapping[IRI, Advertisement],
    refusal: Refusal,
    wider: Hierarchy | None,
    limit: TimeLimit,
) -> Refusal:
    """The refusal of an ecology with all that the time allows to find out.

    `wider` is the hierarchy of the mode `subclass` where the task was composed without one: it is tried whether there
    is a configuration under it. None where the composer has seen a hierarchy already.
    """
    known = composer.hierarchy if wider is None else wider
    refusal = replace(refusal, near_misses=(*_by_type(composer, ecology, refusal, known), *refusal.near_misses))
    refusal = limit.within(lambda: composer.mended(ecology, refusal), refusal)
    if wider is not None and limit.within(lambda: composer.possible_under(ecology, wider), False):
        return replace(refusal, hint="with --reasoning subclass there is a configuration")
    return refusal


def _by_type(
    composer: Composer, ecology: Mapping[IRI, Advertisement], refusal: Refusal, known: Hierarchy
) -> tuple[NearMiss, ...]:
    """For roles with too few candidates, the components whose type alone keeps them out: most likely a slip."""
    short = {reason.role for reason in refusal.reasons if isinstance(reason, TooFewEligible)}
    return tuple(
        miss
        for role in composer.partitioner.roles
        if role.iri in short
        for miss in near_misses_by_type(role, composer.partitioner, composer.gathered(ecology), known)
    )
