"""Who would play a role if only its type were the one that is asked for: misspelt, or above or below it.

A role that asks for :Clok finds nobody, and nothing is wrong with the components. So those whose type alone keeps them
out are near misses too, if the type is written nearly like the one wanted, or related to it by the ontologies.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from difflib import SequenceMatcher
from functools import lru_cache

from selfconf.model.hierarchy import Hierarchy
from selfconf.model.partition import NearMiss
from selfconf.model.term import IRI
from selfconf.rdf.eligibility import ClassTest, CompiledRole
from selfconf.rdf.kept_out import nearly
from selfconf.rdf.kinds import Ecology
from selfconf.rdf.partition import Partitioner
from selfconf.rdf.vocabulary import SC

CLOSE = 0.8
"""How alike two local names are (0 to 1) to be taken for one that is misspelt: one letter of five."""
MOST = 5
"""How many are named for one role."""


def near_misses(role: CompiledRole, partitioner: Partitioner, ecology: Ecology, known: Hierarchy) -> Iterator[NearMiss]:
    """Those whom one class test alone keeps out, the misspelt ones first, then by what was meant and by component.

    `known` is the hierarchy that the ontologies have, whatever the role sees.
    """
    found = {kind: _kinship(role.classes, kind, partitioner.hierarchy, known) for kind in ecology.kinds}
    kinds = sorted((kinship, kind) for kind, kinship in found.items() if kinship is not None)
    left = MOST
    for (_, obstacle), kind in kinds:
        near = nearly(partitioner, role, ecology, [kind])[:left]
        yield from (replace(miss, obstacle=obstacle) for miss in near)
        left -= len(near)
        if not left:
            return


def _kinship(
    classes: Iterable[ClassTest], types: frozenset[IRI], seen: Hierarchy, known: Hierarchy
) -> tuple[int, str] | None:
    """How likely (0 most) and in what words the one test that these types fail was meant to pass them."""
    failed = [test.kind for test in classes if not test.admits(types, seen)]
    if len(failed) != 1:
        return None
    (wanted,) = failed
    for offered in sorted(types - {SC.Component}):
        if _alike(offered, wanted):
            name = offered.short if offered.short != wanted.short else repr(offered)
            return 0, f"is no {wanted.short} (did you mean {name}?)"
        if known.matches(offered, wanted):
            return 1, f"is no {wanted.short} but a {offered.short}, which lies below it (see --reasoning subclass)"
        if known.matches(wanted, offered):
            return 2, f"is no {wanted.short} but a {offered.short}, which lies above it"
    return None


def _alike(offered: IRI, wanted: IRI) -> bool:
    matcher = _matcher(wanted)
    matcher.set_seq1(offered.short.lower())
    return matcher.real_quick_ratio() >= CLOSE and matcher.quick_ratio() >= CLOSE and matcher.ratio() >= CLOSE


@lru_cache(maxsize=64)
def _matcher(wanted: IRI) -> SequenceMatcher[str]:
    """What compares names with a wanted one: one name with many is quicker than many pairs."""
    return SequenceMatcher(None, "", wanted.short.lower(), autojunk=False)
