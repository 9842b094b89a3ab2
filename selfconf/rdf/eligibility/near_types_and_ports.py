"""Near misses by type and by ports: components that a role would take if it asked for their type, or for no ports.

*By type.* A role that asks for :Clok finds no component, and nothing is wrong with the components. So components that
their type alone keeps out are near misses too, if the type is written nearly like the one wanted, or related to it by
the ontologies; or if they are of all other classes that the role asks for.

*By ports.* Components that only what the shape of a role asks of ports keeps out. How near they come is found out
elsewhere (`composition.near_misses`), by these ports and by the words of the role.
"""

from __future__ import annotations

from collections.abc import Container, Iterator
from difflib import SequenceMatcher
from functools import lru_cache

from selfconf.model.hierarchy import Hierarchy
from selfconf.model.immutable import replace
from selfconf.model.obstacle import NoAlternative, TypeRelation, WrongType
from selfconf.model.partition import NearMiss
from selfconf.model.port_likeness import WantedPorts
from selfconf.model.term import IRI, Literal
from selfconf.model.text_likeness import words
from selfconf.rdf.eligibility.advertisement_index import AdvertisementIndex
from selfconf.rdf.eligibility.nearly_eligible import nearly
from selfconf.rdf.eligibility.partitioner import EligibleComponent, Partitioner
from selfconf.rdf.eligibility.role_tests import ClassTest, CompiledRole, Count, RoleTest
from selfconf.rdf.eligibility.wanted_signals import wanted_ports, without_port_shapes
from selfconf.rdf.turtle import Document
from selfconf.rdf.vocabulary import LABEL, RDFS, SC

CLOSE = 0.8
"""How alike two local names are (0 to 1) to be taken for one that is misspelt: one letter of five."""
MOST_NAMED = 5
"""How many are named for one role."""
UNRELATED = 3
"""How likely a type was meant that is related to none that is wanted."""


def near_misses_by_type(
    role: CompiledRole, partitioner: Partitioner, ecology: AdvertisementIndex, known: Hierarchy
) -> Iterator[NearMiss]:
    """The components that one class test alone keeps out: misspelt ones first, then by meaning, then by component.

    Those come last that have no related type, but another class that the role asks for.

    `known` is the hierarchy that the ontologies have, whatever the role sees.
    """
    found = {kind: _relation(role, kind, partitioner.hierarchy, known) for kind in ecology.type_sets}
    likely = [(relation, types) for types, relation in found.items() if relation is not None]
    type_sets = sorted(likely, key=lambda one: (one[0][0], str(one[0][1]), sorted(one[1])))
    left = MOST_NAMED
    for (_, obstacle), kind in type_sets:
        near = nearly(partitioner, role, ecology, [kind])[:left]
        yield from (replace(miss, obstacle=obstacle) for miss in near)
        left -= len(near)
        if not left:
            return


def _relation(
    role: CompiledRole, types: frozenset[IRI], seen: Hierarchy, known: Hierarchy
) -> tuple[int, WrongType | NoAlternative] | None:
    """How likely (0 most) and in what words the one test that these types fail was meant to pass them."""
    failed = [lacking for test in role.tests if (lacking := _lacking(test, types, seen))]
    if len(failed) != 1:
        return None
    (wanted,) = failed
    likely = [_likely(kind, types, known) for kind in wanted]
    rank = min(how for how, *_ in likely)
    if rank == UNRELATED and all(test.kind in wanted for test in role.classes):
        return None
    related = zip(wanted, likely, strict=True)
    obstacles = tuple(WrongType(kind, offered, relation) for kind, (_, offered, relation) in related)
    return rank, obstacles[0] if len(obstacles) == 1 else NoAlternative(obstacles)


def _lacking(test: RoleTest, types: frozenset[IRI], seen: Hierarchy) -> tuple[IRI, ...]:
    """The classes that some types lack for a test: one, or one of each alternative; none where they pass it.

    None as well of a test that looks at more than types.
    """
    if isinstance(test, ClassTest):
        return () if test.admits(types, seen) else (test.kind,)
    if not isinstance(test, Count) or not all(isinstance(one, ClassTest) for group in test.groups for one in group):
        return ()
    found = [next((c for one in group for c in _lacking(one, types, seen)), None) for group in test.groups]
    lacking = tuple(dict.fromkeys(kind for kind in found if kind is not None))
    return lacking if found.count(None) < test.minimum else ()


def _likely(wanted: IRI, types: frozenset[IRI], known: Hierarchy) -> tuple[int, IRI | None, TypeRelation | None]:
    """How likely (0 most) some types were meant to be of a class, by which of them, and how that is related to it."""
    for offered in sorted(types - {SC.Component}):
        if _alike(offered, wanted):
            return 0, offered, TypeRelation.SIMILAR
        if known.matches(offered, wanted):
            return 1, offered, TypeRelation.BELOW
        if known.matches(wanted, offered):
            return 2, offered, TypeRelation.ABOVE
    return UNRELATED, None, None


def _alike(offered: IRI, wanted: IRI) -> bool:
    matcher = _matcher(wanted)
    matcher.set_seq1(offered.short.lower())
    return matcher.real_quick_ratio() >= CLOSE and matcher.quick_ratio() >= CLOSE and matcher.ratio() >= CLOSE


@lru_cache(maxsize=64)
def _matcher(wanted: IRI) -> SequenceMatcher[str]:
    """What compares names with a wanted one: one name with many is quicker than many pairs."""
    return SequenceMatcher(None, "", wanted.short.lower(), autojunk=False)


_SAID = (LABEL, RDFS.comment)


def ports_asked(partitioner: Partitioner, role: IRI) -> WantedPorts | None:
    """What the shape of a role asks of ports; None if it asks nothing."""
    return wanted_ports(partitioner.document, role)


def kept_out_by_ports(
    partitioner: Partitioner, role: IRI, ecology: AdvertisementIndex, inside: Container[IRI]
) -> Iterator[EligibleComponent]:
    """The components that only what the shape asks of ports keeps out of a role; `inside` are those that it takes."""
    asking_less = partitioner.reading(without_port_shapes(partitioner.document, role), role)
    (found,) = asking_less.eligible(ecology)
    return (one for one in found if one.profile.component not in inside)


def words_of_role(document: Document, role: IRI, wanted: WantedPorts | None) -> list[str]:
    """The words of what a role asks for: its name, labels and comments, and the signals that it wants."""
    texts = [role.short, *(o.lexical for p in _SAID for o in document.values(role, p) if isinstance(o, Literal))]
    types = () if wanted is None else (*(wanted.issued or ()), *(wanted.given or ()))
    return [word for text in (*texts, *(one.short for some in types for one in some)) for word in words(text)]
