"""The advertisements of an ecology by kind, and those of a kind by what tests look at in them.

Components are many, kinds are few: which classes a component is of, and so which roles could want it, depends on its
types alone. An ecology is gone through once, when it is gathered; from then on what a role costs depends on
the components of the kinds that it wants, however many others there are. Of these, those are *alike* that say the same
of everything that the role's tests look at. One verdict serves them all.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Hashable, Iterable, Iterator, Mapping, Sequence, ValuesView
from operator import attrgetter

from selfconf.model.hierarchy import Hierarchy
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement, LoadedAdvertisement
from selfconf.rdf.eligibility.role_tests import Count, ParameterTest, PropertyTest, RoleTest, SelfTest
from selfconf.rdf.permitted_fields import STRUCTURE
from selfconf.rdf.vocabulary import SC

_BRACKETED = attrgetter("bracketed")
TypeSet = frozenset[IRI]
"""The types of a component."""


class AdvertisementIndex(Mapping[IRI, Advertisement]):
    """Advertisements by component, and by kind; it never changes."""

    def __init__(self, advertisements: Mapping[IRI, Advertisement]) -> None:
        self._by_component = dict(advertisements)
        type_sets: defaultdict[TypeSet, list[Advertisement]] = defaultdict(list)
        for advertisement in self._by_component.values():
            type_sets[advertisement.types].append(advertisement)
        self.type_sets: Mapping[TypeSet, Sequence[Advertisement]] = dict(type_sets)
        self._grouped: dict[TypeSet, list[tuple[AdvertisementSignature, Collection[Sequence[Advertisement]]]]] = {}

    @staticmethod
    def of(advertisements: Mapping[IRI, Advertisement] | Iterable[Advertisement]) -> AdvertisementIndex:
        """Some advertisements as an ecology; one that is an ecology already is returned as it is."""
        if isinstance(advertisements, AdvertisementIndex):
            return advertisements
        if isinstance(advertisements, Mapping):
            return AdvertisementIndex(advertisements)
        return AdvertisementIndex({advertisement.component: advertisement for advertisement in advertisements})

    def alike(self, types: TypeSet, signature: AdvertisementSignature) -> Collection[Sequence[Advertisement]]:
        """The components of a kind, those together that have the same signature."""
        known = self._grouped.setdefault(types, [])
        for other, groups in known:
            if signature.agrees(other):
                return groups
        found: dict[Hashable, list[Advertisement]] = {}
        for advertisement in self.type_sets[types]:
            found.setdefault(signature(advertisement), []).append(advertisement)
        known.append((signature, found.values()))
        return found.values()

    def __reduce__(self) -> tuple[object, ...]:
        return AdvertisementIndex, (self._by_component,)  # the groups are found anew

    def __getitem__(self, component: IRI) -> Advertisement:
        return self._by_component[component]

    def __iter__(self) -> Iterator[IRI]:
        return iter(self._by_component)

    def __len__(self) -> int:
        return len(self._by_component)

    def values(self) -> ValuesView[Advertisement]:
        """The advertisements, in the order in which they were gathered."""
        return self._by_component.values()


class ClassClosure(dict[TypeSet, frozenset[IRI]]):
    """For the types of a component, the classes that it is of; worked out when they are first asked for."""

    def __init__(self, hierarchy: Hierarchy) -> None:
        self._hierarchy = hierarchy

    def __missing__(self, types: TypeSet) -> frozenset[IRI]:
        self[types] = found = self._hierarchy.classes_of(types)
        return found


class RelevantPredicates(dict[str, bool]):
    """Whether some tests look at a predicate, as statements name it; worked out when it is first met."""

    def __init__(self, tests: Iterable[RoleTest], hierarchy: Hierarchy) -> None:
        tests = list(tests)
        self._paths = {path for test in tests if isinstance(test, PropertyTest) for path in test.looked_at}
        self._hierarchy = hierarchy
        self.update({f"<{predicate}>": False for predicate in STRUCTURE}, a=False)
        self[f"<{SC.hasParameter}>"] = any(isinstance(test, ParameterTest) for test in tests)

    def __missing__(self, predicate: str) -> bool:
        above = self._hierarchy.superproperties(IRI.unchecked(predicate[1:-1]))
        self[predicate] = found = not self._paths.isdisjoint(above)
        return found


class AdvertisementSignature:
    """What some tests look at in an advertisement: of one kind, equal signatures pass the same tests."""

    def __init__(self, tests: Iterable[RoleTest], hierarchy: Hierarchy) -> None:
        inner = list(_flat(tests))
        self._looked = RelevantPredicates(inner, hierarchy)
        self._itself = any(isinstance(test, SelfTest) for test in inner)

    def __call__(self, advertisement: Advertisement) -> Hashable:
        """The signature of an advertisement; where it shares its statements with others, its profile is not needed."""
        looked = self._looked
        itself = advertisement.component if self._itself else None
        statements = advertisement.statements if isinstance(advertisement, LoadedAdvertisement) else ()
        if statements:
            said = tuple([statement for statement in statements if looked[statement.predicate]])
            if not any(map(_BRACKETED, said)):  # the same words, but another blank node for each
                return said, itself
        profile = advertisement.profile
        pairs = tuple([pair for pair in profile.properties if looked[f"<{pair[0]}>"]])
        return pairs, profile.parameters if looked[f"<{SC.hasParameter}>"] else None, itself

    def agrees(self, other: AdvertisementSignature) -> bool:
        """Whether this one looks at just what another one has looked at so far."""
        return self is other or (
            self._itself == other._itself
            and all(self._looked[predicate] == looked for predicate, looked in other._looked.items())
        )


def _flat(tests: Iterable[RoleTest]) -> Iterator[RoleTest]:
    for test in tests:
        yield test
        if isinstance(test, Count):
            for group in test.groups:
                yield from _flat(group)
