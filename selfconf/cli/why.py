"""What else a refusal can tell: who nearly fits by type, what would mend it, and the reasoning that would."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from dataclasses import replace

from selfconf.cli.budget import Clock
from selfconf.cli.inputs import read_hierarchy
from selfconf.composition import Composer
from selfconf.model.hierarchy import Hierarchy, Reasoning
from selfconf.model.partition import NearMiss
from selfconf.model.refusal import Refusal, TooFewEligible
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.eligibility import near_misses_by_type


def explained(
    composer: Composer,
    ecology: Mapping[IRI, Advertisement],
    refusal: Refusal,
    given: argparse.Namespace,
    clock: Clock,
) -> Refusal:
    """The refusal with all that the time allows to find out."""
    syntactic = given.reasoning == Reasoning.SYNTACTIC.value
    known = read_hierarchy(given, Reasoning.SUBCLASS) if syntactic else composer.hierarchy
    refusal = replace(refusal, near_misses=(*_by_type(composer, ecology, refusal, known), *refusal.near_misses))
    refusal = clock.within(lambda: composer.mended(ecology, refusal), refusal)
    if syntactic and clock.within(lambda: composer.possible_under(ecology, known), False):
        return replace(refusal, hint="with --reasoning subclass there is a configuration")
    return refusal


def _by_type(
    composer: Composer, ecology: Mapping[IRI, Advertisement], refusal: Refusal, known: Hierarchy
) -> tuple[NearMiss, ...]:
    """For roles with too few candidates, those whose type alone keeps them out: the most likely cause, a slip."""
    short = {reason.role for reason in refusal.reasons if isinstance(reason, TooFewEligible)}
    return tuple(
        miss
        for role in composer.partitioner.roles
        if role.iri in short
        for miss in near_misses_by_type(role, composer.partitioner, composer.gathered(ecology), known)
    )
