"""Who would play a role if only its type were the one that is asked for: misspelt, or above or below it.

A role that asks for :Clok finds nobody, and nothing is wrong with the components. So those whose type alone keeps them
out are near misses too, if the type is written nearly like the one wanted, or related to it by the ontologies.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from difflib import SequenceMatcher

from selfconf.model.hierarchy import Hierarchy
from selfconf.model.partition import NearMiss
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.eligibility import ClassTest, CompiledRole
from selfconf.rdf.vocabulary import SC

CLOSE = 0.8
"""How alike two local names are (0 to 1) to be taken for one that is misspelt: one letter of five."""
MOST = 5
"""How many are named for one role."""


def near_misses(
    role: CompiledRole, advertisements: Iterable[Advertisement], seen: Hierarchy, known: Hierarchy
) -> Iterator[NearMiss]:
    """Those whom one class test alone keeps out, the misspelt ones first.

    `seen` is the hierarchy that the role sees, `known` the one that the ontologies have.
    """
    by_types: dict[frozenset[IRI], tuple[int, str] | None] = {}
    found: list[tuple[int, IRI, str]] = []
    for advertisement in advertisements:
        types = advertisement.types
        if types not in by_types:
            by_types[types] = _kinship(role.classes, types, seen, known)
        kinship = by_types[types]
        if kinship is None:
            continue
        if len(list(role.obstacles(advertisement.profile, seen))) == 1:
            found.append((kinship[0], advertisement.component, kinship[1]))
    for _, component, obstacle in sorted(found)[:MOST]:
        yield NearMiss(role.iri, component, obstacle)


def _kinship(
    classes: Iterable[ClassTest], types: frozenset[IRI], seen: Hierarchy, known: Hierarchy
) -> tuple[int, str] | None:
    """How likely (0 most) and in what words the one test that these types fail was meant to pass them."""
    failed = [test.kind for test in classes if not test.admits(types, seen)]
    if len(failed) != 1:
        return None
    wanted = failed[0]
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
    one, other = offered.short.lower(), wanted.short.lower()
    return one == other or SequenceMatcher(None, one, other, autojunk=False).ratio() >= CLOSE
