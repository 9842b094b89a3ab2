"""Support clauses: an option plays only if some option of each role that it feeds can do with it.

*Why.* The clauses of a need say that an option which has it plays only beside one that supports it. The converse
follows, as each role is played, but unit propagation does not see it. Of two words that cross, the first excludes all
words for the second with another letter in that place; as long as several are left for the second, these exclude
nothing for the first. With support clauses unit propagation does what arc consistency does, in both directions and
after each decision (Gent, ECAI 2002). Where an option goes with few of another role, a solver then meets a fifth to a
thousandth of the conflicts; where it goes with many, there is little to propagate, so that only short clauses are made.

*Values.* An option that admits some values of a variable implies one of them, which excludes no other option as long
as several are left: of two people who can come at other hours, either seems possible. So an option also excludes each
value that it does not admit, where clauses are hard in spite of support clauses; options that admit the same values
have one literal for that. Two options without a common value, or three, then exclude each other at once.

*Where.* For needs that one role alone supports, with one slot: what plays there supports all of them that anything in
the other role has. For values, in each role that they constrain, as all that plays has them in common.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

SHARE_FITTING = 3
"""A support clause has at most one in this number of the options of a role."""


def clauses_of_needs(
    source: Sequence[int],
    sink: Sequence[int],
    needs: Mapping[int, tuple[list[int], list[int]]],
    any_of: Callable[[list[int]], int],
) -> Iterator[list[int]]:
    """Yield the support clauses of the needs of one role that another role alone supports.

    Given are the literals of the options of both roles, those that have and those that support each need, and what
    returns a literal that holds iff one of some does.
    """
    if len(needs) < SHARE_FITTING:
        return
    most = len(sink) // SHARE_FITTING
    having = {need: some for need, (some, _) in needs.items()}
    counted = sum(map(len, having.values()))
    if len(sink) - counted > most:
        return  # so many have no need of these
    needing = set[int]().union(*having.values())
    content = [literal for literal in sink if literal not in needing]
    if len(content) > most:
        return
    wanted = _by_option(having.items()) if len(needing) < counted else None  # mostly none has two of the needs
    for supported, some in _alike(source, {need: supporting for need, (_, supporting) in needs.items()}):
        fitting = content.copy()
        for need in supported:
            fitting += having[need] if wanted is None else _met_by(supported, need, having[need], wanted)
            if len(fitting) > most:
                break
        else:
            yield [-any_of(some), *fitting]


def _alike(source: Sequence[int], supporting: Mapping[int, list[int]]) -> Iterable[tuple[tuple[int, ...], list[int]]]:
    """Return sets of some needs, with the options of a role that support just these, the earliest first."""
    able = set[int]().union(*supporting.values())
    if len(able) == sum(map(len, supporting.values())):
        # Each supports one at most, so that the options of each need are known, and no option has to be looked at.
        others = [literal for literal in source if literal not in able]
        sets = [*(((need,), some) for need, some in supporting.items()), *([((), others)] if others else [])]
        return sorted(sets, key=_first_option)
    issued = _by_option(supporting.items())
    alike: defaultdict[tuple[int, ...], list[int]] = defaultdict(list)
    for literal in source:
        alike[tuple(issued.get(literal, ()))].append(literal)
    return alike.items()


def _first_option(alike: tuple[tuple[int, ...], list[int]]) -> int:
    return alike[1][0]


def _by_option(options: Iterable[tuple[int, list[int]]]) -> dict[int, list[int]]:
    """Return the needs of each option, or those that it supports, given the options of each need."""
    found: defaultdict[int, list[int]] = defaultdict(list)
    for need, literals in options:
        for literal in literals:
            found[literal].append(need)
    return found


def _met_by(
    supported: Sequence[int], first: int, having: Sequence[int], wanted: Mapping[int, list[int]]
) -> Iterator[int]:
    """Yield those of some options all of whose needs are among some, where a certain one is the first of them."""
    for literal in having:
        needs = wanted[literal]
        if len(needs) == 1 or (needs[0] == first and set(supported).issuperset(needs)):
            yield literal


def clauses_of_values(
    role: Sequence[int], admitted: Mapping[int, int], values: Sequence[tuple[int, int]]
) -> Iterator[list[int]]:
    """Yield the support clauses of the values of a variable for one role.

    Given are the literals of the options of the role; those of the options that constrain the variable, with the mask
    of what each admits; and masks of values with their literals.
    """
    most = len(role) // SHARE_FITTING
    content = [literal for literal in role if literal not in admitted]
    if len(content) > most:
        return
    for alike, value in values:
        fitting = [*content, *[literal for literal, mask in admitted.items() if mask & alike]]
        if len(fitting) <= most:
            yield [-value, *fitting]


def exclusions_of_values(
    admitting: Mapping[int, list[int]], values: Sequence[tuple[int, int]], any_of: Callable[[list[int]], int]
) -> Iterator[list[int]]:
    """Yield the clauses by which options that admit several values of a variable exclude all others.

    Given are the literals of the options that admit each mask of values; masks of values with their literals; and what
    returns a literal that holds iff one of some does.
    """
    for mask, options in admitting.items():
        others = [value for alike, value in values if not mask & alike]
        # One value excludes all others already, and a mask below zero those that are not in it.
        if mask >= 0 and others and len(others) < len(values) - 1:
            one = any_of(options)
            yield from ([-one, -value] for value in others)
