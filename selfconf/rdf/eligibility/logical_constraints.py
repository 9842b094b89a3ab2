"""The alternatives in the shape of a role (`sh:or`, `sh:xone`, `sh:not`), and what they leave to a component to add.

Each alone may be passed, and all together with the rest of the shape by no component: a property that must have a value
and must not. Where they look at constants alone, few combinations of values tell: of those that the shape does not tell
apart it matters only how many there are, and of no more than it counts.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Sequence
from itertools import chain, islice, permutations, product

from selfconf.model.hierarchy import Hierarchy
from selfconf.model.profile import Profile
from selfconf.model.term import IRI, Term
from selfconf.rdf.eligibility.free_values import conjuncts
from selfconf.rdf.eligibility.role_tests import Count, PropertyTest, RoleTest

UNNAMED = IRI("urn:selfconf:unnamed")
"""What the values are called that no shape names, with numbers behind it."""
MOST_TOLD_APART = 20
"""The highest count of values of which something is said."""
MOST_COMBINATIONS = 500
"""How many combinations of values are tried at most; where there are more, nothing is said."""


def in_doubt(tests: Sequence[RoleTest]) -> bool:
    """Whether what a free parameter may be depends on which alternatives of a role a component passes.

    So it is where the parameter stands in one, or its property is looked at in one: what a component that is added has
    to state is then not known.
    """
    alternatives = list(_properties(_alternatives(tests)))
    looked_at = {test.path for test in alternatives}
    every = chain(alternatives, (test for test in conjuncts(tests) if isinstance(test, PropertyTest)))
    return any((test.free_in or test.free_required) and test.path in looked_at for test in every)


def passable(tests: Sequence[RoleTest], hierarchy: Hierarchy) -> bool:
    """Whether some component passes the alternatives of a role beside what else it asks of the same properties.

    True as well where that is not known: where they look at more than how many values there are, and which, or at a
    property and one below it, which share values.
    """
    asked: list[RoleTest] = list(_alternatives(tests))
    if not asked:
        return True
    paths = {test.path for test in _properties(asked)}
    asked += [test for test in conjuncts(tests) if isinstance(test, PropertyTest) and test.path in paths]
    if any(above in hierarchy.superproperties(path) for path, above in permutations(paths, 2)):
        return True
    return not all(map(_of_constants, asked)) or _some_pass(asked, hierarchy)


def _some_pass(asked: Sequence[RoleTest], hierarchy: Hierarchy) -> bool:
    """Whether some values of properties pass all of some tests of constants; true as well where these are too many."""
    by_path: dict[IRI, list[PropertyTest]] = {}
    for test in _properties(asked):
        by_path.setdefault(test.path, []).append(test)
    choices = [[(path, values) for values in _choices(tests)] for path, tests in sorted(by_path.items())]
    tried = list(islice(product(*choices), MOST_COMBINATIONS + 1))
    return len(tried) > MOST_COMBINATIONS or any(
        all(test.obstacle(_stating(some), hierarchy) is None for test in asked) for some in tried
    )


def _alternatives(tests: Iterable[RoleTest]) -> Iterator[RoleTest]:
    return (test for test in conjuncts(tests) if isinstance(test, Count))


def _properties(tests: Iterable[RoleTest]) -> Iterator[PropertyTest]:
    """Yield the tests of properties among tests and in their alternatives."""
    for test in tests:
        if isinstance(test, Count):
            yield from _properties(chain.from_iterable(test.groups))
        elif isinstance(test, PropertyTest):
            yield test


def _of_constants(test: RoleTest) -> bool:
    """Whether a test looks only at how many values a property has, and which."""
    if isinstance(test, Count):
        return all(map(_of_constants, chain.from_iterable(test.groups)))
    if not isinstance(test, PropertyTest) or _counted(test) > MOST_TOLD_APART:
        return False
    return not (test.free_in or test.free_required or test.each or test.compared or test.qualified)


def _counted(test: PropertyTest) -> int:
    """Up to how many values a test tells numbers of values apart."""
    return max(test.minimum, 0 if test.maximum is None else test.maximum + 1)


def _choices(tests: Sequence[PropertyTest]) -> Iterator[tuple[Term, ...]]:
    """Yield values that a property may have: what any values pass, one of these does, up to more than are tried."""
    most = max(1, *map(_counted, tests))
    lists = [members for test in tests for members in test.allowed]
    required = frozenset(chain.from_iterable(test.required for test in tests))
    alike: dict[Hashable, list[Term]] = {}
    for value in sorted(required.union(*lists), key=str):
        kind = value if value in required else None, *(value in members for members in lists)
        alike.setdefault(kind, []).append(value)
    groups = [some[:most] for some in alike.values()]
    groups.append([IRI.unchecked(f"{UNNAMED}:{number}") for number in range(most)])
    numbers = islice(product(*(range(len(some) + 1) for some in groups)), MOST_COMBINATIONS + 1)
    for each in numbers:
        yield tuple(chain.from_iterable(some[:number] for some, number in zip(groups, each, strict=True)))


def _stating(values: Iterable[tuple[IRI, tuple[Term, ...]]]) -> Profile:
    """A component that states some values, and nothing else."""
    stated = [(path, value) for path, some in values for value in some]
    return Profile(UNNAMED, properties=tuple(stated))
