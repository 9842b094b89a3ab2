"""Cases by the values of free parameters: each combination of values that leaves all slots enough components.

*Why.* Where all that play have to agree on the value of a free parameter, as people on the site at which they work,
each value leaves another part of the components. Matching over all of them (Hall's theorem) sees none of these parts;
clause learning refutes each in exponential time, counting by cases. With a value given, arc consistency and matching
see at once that it leaves too few.

*What is kept.* Every solution is one of some case, and every solution of a case is one of the problem: so the least
solution of all is the least among those of the cases. A value is dominated if each option that admits it admits another
one as well: what is a solution with it is one with that, so that it needs no case.

*When.* Where most combinations leave enough components, nothing is gained by looking at them one by one: there are no
cases then, and clause learning gets the parameters as they are. Nor are any looked at where each combination should
leave each slot at least as many options as one component has roles, at most: then components are enough, by Hall's
theorem, as some slots with d options each have as many components as they are, if each of these is an option of d of
them at most. What arc consistency sees beside, clause learning sees as well.

*Which.* Parameters on which all have to agree: of the roles that constrain one, most options do so. Where a few people
of each role have hours for something, whatever hour is given leaves all the others.

*Cost.* A pass over all needs and supports, and a matching, for each value or combination that is tried, while there are
few of these.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from functools import reduce
from itertools import chain
from operator import or_

from selfconf.model.immutable import replace
from selfconf.model.partition import ANY_VALUE
from selfconf.search.engines.matching import hall_set
from selfconf.search.reduction import ReducedProblem, pruned

MOST_CASES = 256
"""How many combinations of values are looked at at most."""
SHARE_FREE = 3
"""At most one in this number of the options leaves a parameter with cases free, in the roles where any does not."""
MARGIN = 16
"""By how many those that leave enough components may outnumber the others, at any time, if there are to be cases."""
MOST_COUNTED = 1_000_000
"""How many needs, supports and options are counted for that at most, some tenths of a second."""


def value_cases(given: ReducedProblem) -> list[ReducedProblem] | None:
    """Return the problem once for each combination of values that leaves all slots enough components.

    Where there would be too many combinations, those with the most values stay free. None if no parameter has a choice
    among few enough values, or if too many combinations leave enough.
    """
    size = sum(1 + len(kind.needs) + len(kind.supports) for kind in given.kinds()) + sum(map(len, given.options))
    most, chosen = min(MOST_CASES, MOST_COUNTED // max(1, size)), list[int]()
    choices = sorted((len(_values(given, variable)), variable) for variable in _agreed_on(given))
    for count, variable in choices:
        if count > 1 and (most := most // count) > 0:
            chosen.append(variable)
    if not chosen or not _may_be_scarce(given, chosen):
        return None
    cases: list[ReducedProblem] = []
    refuted = 0
    for case in _cases(given, chosen):
        if case is None:
            refuted += 1
            continue
        cases.append(case)
        if len(cases) > refuted + MARGIN:
            return None
    return cases


def _agreed_on(given: ReducedProblem) -> Iterator[int]:
    """Yield the variables that most options constrain, in the roles where any does."""
    for variable, constrained in enumerate(given.constraining()):
        options = sum([len(given.options[role]) for role in {role for role, _, _ in constrained}])
        if SHARE_FREE * (options - len(constrained)) <= options:
            yield variable


def _may_be_scarce(given: ReducedProblem, variables: list[int]) -> bool:
    """Return whether some values of some variables are likely to leave slots too few components."""
    most = max(Counter(chain.from_iterable(given.components())).values(), default=0)
    values = [(variable, _values(given, variable)) for variable in variables]
    for role, slots in Counter(given.slots).items():
        admits = [option.kind.admits for option in given.options[role]]
        left = float(len(admits))
        for variable, each in values:
            masks = [masks.get(variable, ANY_VALUE) for masks in admits]
            if masks.count(ANY_VALUE) < len(masks):
                left *= min(sum([mask & value > 0 for mask in masks]) for value in each) / len(masks)
        if left < slots * most:
            return True
    return False


def _cases(given: ReducedProblem, variables: list[int]) -> Iterator[ReducedProblem | None]:
    """Yield the case of each combination of values, and None for all that begin with values which leave too few."""
    if not variables:
        yield given
        return
    for value in _values(given, variables[0]):
        case = pruned(_with_value(given, variables[0], value))
        if case.wiped_out() is None and hall_set(case.slots, case.components()) is None:
            yield from _cases(case, variables[1:])
        else:
            yield None


def _values(given: ReducedProblem, variable: int) -> list[int]:
    """Return masks of one value each that a variable may still have, in order, but for values that are dominated.

    Where it may have a value that no option states, the last one stands for all of these; where no option states any,
    the only mask is of all that it may have.
    """
    common, stated = given.values[variable], 0
    every: dict[int, None] = {}
    for role in dict.fromkeys(given.slots):
        masks = {option.kind.admits.get(variable, ANY_VALUE) for option in given.options[role]}
        every |= dict.fromkeys(masks)
        stated = max(stated, *((mask if mask >= 0 else ~mask).bit_length() for mask in masks), 0)
        if ANY_VALUE not in masks:
            common &= reduce(or_, masks, 0)
    if common < 0 and not stated:
        return [common]
    width = common.bit_length() if common >= 0 else stated + 1
    return _undominated([1 << bit for bit in range(width) if common >> bit & 1], list(every))


def _undominated(values: list[int], masks: list[int]) -> list[int]:
    """Return the values without those that another one, or of equal ones the first, could always stand for."""
    admitting = [sum([1 << place for place, mask in enumerate(masks) if mask & value]) for value in values]
    kept: list[int] = []
    for number, some in enumerate(admitting):
        others = enumerate(admitting)
        if not any(some & other == some and (some != other or place < number) for place, other in others):
            kept.append(values[number])
    return kept


def _with_value(given: ReducedProblem, variable: int, value: int) -> ReducedProblem:
    options = tuple(
        tuple(one for one in some if one.kind.admits.get(variable, ANY_VALUE) & value) for some in given.options
    )
    values = (*given.values[:variable], value, *given.values[variable + 1 :])
    return replace(given, options=options, values=values)
