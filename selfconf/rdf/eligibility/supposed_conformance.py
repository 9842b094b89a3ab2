"""Whether an output that does not exist yet could conform to the shape that an input asks of it (`sc:accepts`).

Of such an output its signal type is known, the unit and frame that the input asks for, and the name where an
interaction asks for it. These have to pass what the shape asks of them, with further values of the shape's where they
may be stated. Of everything else it is supposed to state what the shape asks for, and so is its component; but not of
what the role of the component looks at too, as it is not known whether both can be met.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain, islice, product

from selfconf.model.hierarchy import Hierarchy
from selfconf.model.profile import Output, Profile
from selfconf.model.term import IRI, Literal, Term
from selfconf.rdf.eligibility.logical_constraints import MOST_COMBINATIONS
from selfconf.rdf.eligibility.role_tests import Count, PropertyTest, RoleTest, obstacles
from selfconf.rdf.vocabulary import SC

_SUPPOSED = IRI("urn:selfconf:supposed")
"""An output that does not exist yet, and a value that no shape names."""
_STATED = (SC.signalType, SC.unit, SC.frame, SC.name)

StatedValues = tuple[Term, ...]


def could_conform(
    tests: Iterable[RoleTest], names: Mapping[IRI, IRI], output: Output, named: bool, hierarchy: Hierarchy
) -> bool:
    """Whether an output of which so much is known could pass the tests of a shape.

    `names` are what the tests call the properties of an output; `named` tells whether the name is known.
    """
    known = {names[one]: _known(output, one, named) for one in _STATED if one in names}
    asked = [test for test in tests if _decided(test, known)]
    constants = {path: _constants(asked, path) for path in known}
    choices = [
        [(path, some) for some in _choices(path == names.get(SC.signalType), stated, constants[path])]
        for path, stated in known.items()
    ]
    tried = list(islice(product(*choices), MOST_COMBINATIONS + 1))
    return len(tried) > MOST_COMBINATIONS or any(not obstacles(asked, _stating(some), hierarchy) for some in tried)


def _known(output: Output, stated: IRI, named: bool) -> StatedValues:
    """What is known of an output that it states, by the property; nothing if it may be anything, or lack."""
    if stated == SC.signalType:
        return output.signals
    if stated == SC.name:
        return (Literal(output.name),) if named else ()
    value = output.unit if stated == SC.unit else output.frame
    return () if value is None else (value,)


def _choices(several: bool, stated: StatedValues, constants: Sequence[Term]) -> Iterator[StatedValues]:
    """Yield what an output may state of a property, besides what is known: one value, or `several`."""
    yield stated
    if several or not stated:
        yield from ((*stated, one) for one in (*constants, _SUPPOSED) if one not in stated)


def _decided(test: RoleTest, known: Mapping[IRI, StatedValues]) -> bool:
    """Whether a test looks at nothing but properties of which it is known which values an output may state."""
    if isinstance(test, Count):
        return all(_decided(one, known) for one in chain.from_iterable(test.groups))
    if not isinstance(test, PropertyTest) or not known.keys() >= {*test.looked_at}:
        return False
    return bool(known[test.path]) or not (test.each or test.compared or test.qualified)


def _constants(tests: Iterable[RoleTest], path: IRI) -> list[Term]:
    """The values of a property that tests name."""
    found: dict[Term, None] = {}
    for test in tests:
        if isinstance(test, Count):
            found.update(dict.fromkeys(_constants(chain.from_iterable(test.groups), path)))
        elif isinstance(test, PropertyTest) and test.path == path:
            found.update(dict.fromkeys(sorted((*test.required, *chain.from_iterable(test.allowed)), key=str)))
    return list(found)


def _stating(values: Iterable[tuple[IRI, StatedValues]]) -> Profile:
    return Profile(_SUPPOSED, properties=tuple((path, value) for path, some in values for value in some))
