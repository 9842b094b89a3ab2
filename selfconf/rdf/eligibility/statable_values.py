"""What a component that does not exist yet could state of free parameters and be eligible for a role.

The constraints of a role on the property in which a parameter stands decide: `sh:in ( :robot )` beside
`sh:in ( :Pippi :Emil )` leaves a component for Pippi's or Emil's robot. Where they contradict each other, no component
can be eligible at all. Only constraints that are compiled count, and those within `sh:or` and `sh:not` do not: what is
said here to be impossible is so, and the rest is not certain to be possible.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import chain

from selfconf.model.hierarchy import Hierarchy
from selfconf.model.immutable import immutable
from selfconf.model.partition import Mention
from selfconf.model.term import IRI, Term
from selfconf.rdf.eligibility.role_tests import Count, PropertyTest, RoleTest

Suiting = Callable[[IRI, frozenset[Term]], frozenset[Term]]
"""Those of some values that a parameter may have."""
_NONE: frozenset[Term] = frozenset()


@immutable
class StatedOnPath:
    """What the tests of a role together ask of the values of one property."""

    tests: tuple[PropertyTest, ...]
    """The tests of the property itself."""
    above: tuple[PropertyTest, ...]
    """Those of the property and of what lies above it, which see its values too."""

    @property
    def minimum(self) -> int:
        """How many values there have to be."""
        return max(test.minimum for test in self.tests)

    @property
    def required(self) -> frozenset[Term]:
        """The values that have to be there."""
        return frozenset(chain.from_iterable(test.required for test in self.tests))

    @property
    def allowed(self) -> frozenset[Term] | None:
        """The values that may be there, as far as they are listed; None if they are not."""
        lists = [members for test in self.above for members in test.allowed]
        return frozenset(filter(self.passes, _NONE.union(*lists).intersection(*lists))) if lists else None

    def passes(self, value: Term) -> bool:
        """Whether a value is like what each single value has to be."""
        return all(one.passes(value) for test in self.above for one in test.each)

    @property
    def contradictory(self) -> bool:
        """Whether no values at all are what the tests ask for, whatever free parameters are."""
        allowed, required = self.allowed, self.required
        maxima = [test.maximum for test in self.above if test.maximum is not None]
        return (
            (allowed is not None and (len(allowed) < self.minimum or not required <= allowed))
            or not all(map(self.passes, required))
            or any(most < max(self.minimum, len(required)) for most in maxima)
        )

    def mentions(self, known: Mapping[IRI, Iterable[Term]]) -> Iterator[Mention]:
        """What is asked for each free parameter; `known` are values that each could have."""
        allowed, required = self.allowed, self.required
        for test in self.tests:
            for parameter in test.free_required:
                yield Mention(parameter, allowed, self._never(known.get(parameter, ())), True)
            for parameter, members in test.free_in:
                beside = frozenset(filter(self.passes, members if allowed is None else members & allowed))
                # What has to be there is among the other members, or it is the value of the parameter.
                only = allowed if required <= members else required - members if len(required - members) == 1 else _NONE
                must = not required <= members or len(beside) < self.minimum
                if len(beside) + 1 < self.minimum:
                    only = _NONE
                yield Mention(parameter, only, self._never(known.get(parameter, ())), must)

    def _never(self, known: Iterable[Term]) -> frozenset[Term]:
        return frozenset(value for value in known if not self.passes(value))


def stated_on_paths(tests: Iterable[RoleTest], hierarchy: Hierarchy) -> list[StatedOnPath]:
    """What the tests of a role ask of the values of each property that they look at."""
    found = list(_conjuncts(tests))
    paths = dict.fromkeys(test.path for test in found)
    return [
        StatedOnPath(
            tuple(test for test in found if test.path == path),
            tuple(test for test in found if test.path in hierarchy.superproperties(path)),
        )
        for path in paths
    ]


def mentions_of(
    parameters: Iterable[IRI], paths: Sequence[StatedOnPath], known: Mapping[IRI, Iterable[Term]], suiting: Suiting
) -> tuple[Mention, ...]:
    """What a role asks of each free parameter that its shape mentions, all its properties together."""
    found = {parameter: Mention(parameter) for parameter in parameters}
    for mention in chain.from_iterable(path.mentions(known) for path in paths):
        one = found.get(mention.parameter)
        found[mention.parameter] = mention if one is None else one.beside(mention)
    return tuple(one if one.only is None else one.among(suiting(one.parameter, one.only)) for one in found.values())


def contradictory(paths: Iterable[StatedOnPath], mentions: Iterable[Mention]) -> bool:
    """Whether no component can be eligible for a role, whatever it states."""
    return any(path.contradictory for path in paths) or any(one.required and one.only == _NONE for one in mentions)


def _conjuncts(tests: Iterable[RoleTest]) -> Iterator[PropertyTest]:
    """Yield the tests of properties that all have to be passed, those within `sh:and` and `sh:node` too."""
    for test in tests:
        if isinstance(test, PropertyTest):
            yield test
        elif isinstance(test, Count) and test.minimum == len(test.groups):
            yield from _conjuncts(chain.from_iterable(test.groups))
