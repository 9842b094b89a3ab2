"""The alternatives in the shape of a role (`sh:or`, `sh:xone`, `sh:not`), and what they leave to a component to add.

Each alone may be passed, and all together with the rest of the shape by no component: a property that must have a value
and must not. Where they look at constants alone, few combinations of values tell: those that the shape names, and one
that it does not.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain, combinations, islice, product

from selfconf.model.hierarchy import Hierarchy
from selfconf.model.profile import Profile
from selfconf.model.term import IRI, Term
from selfconf.rdf.eligibility.free_values import conjuncts
from selfconf.rdf.eligibility.role_tests import Count, PropertyTest, RoleTest

UNNAMED = IRI("urn:selfconf:unnamed")
"""A value that no shape names."""
MOST_VALUES = 2
"""How many values a property is given at most."""
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

    True as well where that is not known: where they look at more than how many values there are, and which.
    """
    asked: list[RoleTest] = list(_alternatives(tests))
    if not asked:
        return True
    paths = {test.path for test in _properties(asked)}
    asked += [test for test in conjuncts(tests) if isinstance(test, PropertyTest) and test.path in paths]
    if not all(map(_of_constants, asked)):
        return True
    named: dict[IRI, set[Term]] = {path: {UNNAMED} for path in paths}
    for test in _properties(asked):
        named[test.path].update(test.required, *test.allowed)
    choices = [[(path, values) for values in _few(named[path])] for path in sorted(paths)]
    tried = list(islice(product(*choices), MOST_COMBINATIONS + 1))
    if len(tried) > MOST_COMBINATIONS:
        return True
    return any(all(test.obstacle(_stating(some), hierarchy) is None for test in asked) for some in tried)


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
    if not isinstance(test, PropertyTest) or test.minimum > MOST_VALUES or len(test.required) > MOST_VALUES:
        return False
    return not (test.free_in or test.free_required or test.each or test.compared or test.qualified)


def _few(values: Iterable[Term]) -> Iterator[tuple[Term, ...]]:
    ordered = sorted(values, key=str)
    return chain.from_iterable(combinations(ordered, size) for size in range(MOST_VALUES + 1))


def _stating(values: Iterable[tuple[IRI, tuple[Term, ...]]]) -> Profile:
    """A component that states some values, and nothing else."""
    stated = [(path, value) for path, some in values for value in some]
    return Profile(UNNAMED, properties=tuple(stated))
