"""Reduction by dominance: the candidates that can matter to the least solution, by interchangeability class.

A candidate is dominated if in every solution that has it an earlier one could take its place. Three cuts remove
dominated candidates; each of them keeps the least solution.
(1) Of each class of a role with k slots take the first k candidates. If no component is among all these twice, they
suffice: of a least solution give each slot in turn the next of them that is of the class in that slot. All are
different, and of those in a role, in order, none comes later than the one in its place did. So it is the same solution.
(2) Otherwise let S be the number of all slots. Of each class of a role the first S suffice: were a later one in a slot
of the least solution, then at most S - 1 of the first S would play, one of them would be free, and putting it there
would give a lesser solution. This needs no knowledge of which candidates are eligible for other roles as well.
(3) Let a group be the candidates that are eligible for exactly the same roles R, with the same class in each, and k
the number of slots of R. For each role of R the first k of the group suffice, by the same argument: members can only
play in the k slots of R. Keeping one per class would be wrong as soon as roles share candidates.
Roles with no slots take no part: no component plays them before the extension.

The cuts use only that a candidate can be exchanged for another one of its class. So they hold for any order of the
candidates, for what is left when constraints are dropped (`constraints`), and when components are added, as long as no
component that is a candidate becomes one for a further role. Components that may are *distinguished*: each is of a
class of its own, so that it is neither cut nor counted as one of the first; with such components, cut (1) is left out.

Cost: a pass over the candidates of roles that have slots, and where these share candidates another one; after it only
classes and kept candidates are touched.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Collection, Hashable, Mapping, Sequence
from functools import cached_property
from itertools import compress
from operator import not_

from selfconf.model.partition import ANY_VALUE, Candidate
from selfconf.model.term import IRI
from selfconf.search.problem import Problem
from selfconf.search.reduction.needs import Wiring
from selfconf.search.reduction.reduced_problem import InterchangeabilityClass, Option, ReducedProblem

ANY_VALUES: Mapping[int, int] = {}
"""What a class admits that constrains no variable."""
FEW_VARIABLES = 8
"""With more variables those are looked for that a role constrains, before the values that its classes admit are."""
MANY_PORTS = 8
"""From how many ports of a candidate on it is quicker to compare the first ones before all of them."""


class LazyReduction:
    """A problem that is reduced when its reduction is first asked for: many are solved before."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem

    @cached_property
    def reduced(self) -> ReducedProblem:
        """The reduced problem."""
        return reduced(self.problem)


def reduced(
    problem: Problem,
    distinguished: Collection[IRI] = (),
    order: Mapping[int, Sequence[int]] | None = None,
    roles: int | None = None,
) -> ReducedProblem:
    """Return a problem without its dominated candidates; distinguished components are of a class of their own.

    `order` is another order of the candidates of each role, by number: then the first and the least are by that.
    With `roles` only that many of the first roles are in the result: where that has no solution, the problem has none.
    """
    # A role that asks for more than there are gets one slot more than there are: as impossible, and never a million.
    slots = tuple(
        role
        for role, (asked, candidates) in enumerate(zip(problem.roles[:roles], problem.candidates, strict=False))
        for _ in range(min(asked.minimum, 1 + len(candidates)))
    )
    minima = Counter(slots)
    wiring = Wiring(problem, roles)
    numbers, shared = _undominated(problem, distinguished, order, minima)
    most = dict.fromkeys(minima, len(slots)) if shared else minima
    left: dict[int, list[Option]] = {}
    kinds: dict[int, list[InterchangeabilityClass]] = {}
    admitted = _AdmittedValues() if 0 < len(problem.variables) <= FEW_VARIABLES else None
    # The inputs of all roles are numbered before the first output is looked at: only then are all needs known.
    for role, some in numbers.items():
        left[role], kinds[role] = _classified(role, problem.candidates[role], some, most[role], distinguished, admitted)
        if problem.variables and admitted is None:
            _note_values(kinds[role])
        needs = wiring.needed(role, [kind.signatures[0][0].inputs for kind in kinds[role]])
        for kind, one in zip(kinds[role], needs, strict=True):
            kind.needs = one
    for role, of_role in kinds.items():
        supports = wiring.supported(role, [kind.signatures[0][0].outputs for kind in of_role])
        for kind, one in zip(of_role, supports, strict=True):
            kind.supports = one
    if shared:
        left = without_dominated(left, minima)
    return ReducedProblem(
        slots,
        tuple(tuple(left.get(role, ())) for role in range(len(problem.roles))),
        wiring.needs,
        problem.open_values,
    )


def _undominated(
    problem: Problem,
    distinguished: Collection[IRI],
    order: Mapping[int, Sequence[int]] | None,
    minima: Mapping[int, int],
) -> tuple[Mapping[int, Sequence[int]], bool]:
    """Return the candidates of each role that cut (1) or else (2) leaves, by number, and whether it was (2)."""
    every: dict[int, Sequence[int]] = {
        role: range(len(problem.candidates[role])) if order is None else order[role] for role in minima
    }
    slots = sum(minima.values())
    if distinguished:
        return {
            role: _first_and_distinguished(problem.candidates[role], some, slots, distinguished)
            for role, some in every.items()
        }, True
    # The very first candidates are looked at before the pass: where these are shared, cut (1) fails at once.
    if not _share_components(problem, {role: some[:1] for role, some in every.items()}):
        firsts = {role: _first(problem.candidates[role], some, minima[role]) for role, some in every.items()}
        if not _share_components(problem, firsts):
            return firsts, False
    return {role: _first(problem.candidates[role], some, slots) for role, some in every.items()}, True


def _first_and_distinguished(
    candidates: Sequence[Candidate], numbers: Sequence[int], most: int, distinguished: Collection[IRI]
) -> Sequence[int]:
    """Return the first candidates of each signature, as many as asked for, and all that are distinguished."""
    # Distinguished candidates among the first are not counted as such, so that more of the others have to be kept.
    first = set(_first(candidates, numbers, most + len(distinguished)))
    return [number for number in numbers if number in first or candidates[number].profile.component in distinguished]


def _share_components(problem: Problem, numbers: Mapping[int, Sequence[int]]) -> bool:
    """Return whether some component is among these candidates of several roles."""
    names = [
        candidates[number].profile.component
        for role, some in numbers.items()
        for candidates in [problem.candidates[role]]
        for number in some
    ]
    return len(set(names)) < len(names)


def _classified(
    role: int,
    candidates: Sequence[Candidate],
    numbers: Sequence[int],
    most: int,
    distinguished: Collection[IRI],
    admitted: _AdmittedValues | None,
) -> tuple[list[Option], list[InterchangeabilityClass]]:
    """Return the first candidates of each class, as many as asked for, as options; and the classes."""
    many = len(numbers) > most
    apart = not distinguished and _differ_at_once(candidates, numbers)
    kinds: list[InterchangeabilityClass] = []
    place_of: dict[Hashable, int] = {}
    met: dict[InterchangeabilityClass, int] = {}
    found: list[Option] = []
    for number in numbers:
        candidate = candidates[number]
        profile = candidate.profile
        component = profile.component
        signed = (profile.ports, candidate.admits)
        key: Hashable = number if apart else (signed, component) if component in distinguished else signed
        place = place_of.setdefault(key, len(kinds))  # once, as to hash all ports takes as long as the rest
        if place == len(kinds):
            admits = ANY_VALUES if admitted is None else admitted[signed[1]]
            kinds.append(InterchangeabilityClass(role, (), (), admits, number, (signed,)))
        kind = kinds[place]
        if many:
            seen = met[kind] = met.get(kind, 0) + 1
            if seen > most:
                continue
        found.append(Option(number, component, kind))
    return found, kinds


def _note_values(kinds: Sequence[InterchangeabilityClass]) -> None:
    """Note for the classes of a role the values that they admit of the variables that they constrain."""
    every = [kind.signatures[0][1] for kind in kinds]
    any_value = (ANY_VALUE,) * len(kinds)
    # Of many variables most roles constrain few, so that the others are passed over for all classes at once.
    variables = [variable for variable, masks in enumerate(zip(*every, strict=True)) if masks != any_value]
    for kind, masks in zip(kinds, every, strict=True) if variables else ():
        kind.admits = {variable: mask for variable in variables if (mask := masks[variable]) != ANY_VALUE}


class _AdmittedValues(dict[tuple[int, ...], Mapping[int, int]]):
    """The values that classes admit of the variables that they constrain, by those of all: many admit the same."""

    def __missing__(self, masks: tuple[int, ...]) -> Mapping[int, int]:
        found = self[masks] = {variable: mask for variable, mask in enumerate(masks) if mask != ANY_VALUE}
        return found


def _differ_at_once(candidates: Sequence[Candidate], numbers: Sequence[int]) -> bool:
    """Return whether candidates with many ports all differ in the first of these, so that no other has to be read."""
    if not numbers or sum(map(len, candidates[numbers[0]].profile.ports)) < MANY_PORTS:
        return False
    ports = [candidates[number].profile.ports for number in numbers]
    return len({(inputs[:1], outputs[:1]) for inputs, outputs in ports}) == len(ports)


def _first(candidates: Sequence[Candidate], numbers: Sequence[int], most: int) -> Sequence[int]:
    """Return the first candidates, as many as asked for, of each set of candidates that share ports and values.

    This is the pass over all candidates: it takes no step of Python for a candidate that is dominated, and does not
    read the ports. They are compared by identity: equal ports that are not shared count as different here, which costs
    time alone.
    """
    if len(numbers) <= most:
        return numbers
    ordered = candidates if isinstance(numbers, range) else [candidates[number] for number in numbers]
    # Attributes are read in comprehensions: getters of `operator` take nearly twice as long.
    shared: list[Hashable]
    if ordered[0].admits:
        shared = [(id(candidate.profile.ports), id(candidate.admits)) for candidate in ordered]
    else:
        shared = [id(candidate.profile.ports) for candidate in ordered]
    places = _first_of_each(shared) if most == 1 else _first_few_of_each(shared, most)
    return places if isinstance(numbers, range) else [numbers[place] for place in places]


def _first_of_each(shared: Sequence[Hashable]) -> list[int]:
    # Filled backwards, a dictionary is left with the first place of each key.
    return sorted(dict(zip(reversed(shared), reversed(range(len(shared))), strict=True)).values())


def _first_few_of_each(shared: Sequence[Hashable], most: int) -> Sequence[int]:
    counts = Counter(shared)
    if max(counts.values()) <= most:
        return range(len(shared))
    wanted = {one: min(count, most) for one, count in counts.items()}
    left = sum(wanted.values())
    found: list[int] = []
    enough: set[Hashable] = set()
    # The iterator reads `enough` as it goes on, and skips in C what the loop has put there.
    for place in compress(range(len(shared)), map(not_, map(enough.__contains__, shared))):
        found.append(place)
        if len(found) == left:
            break
        one = shared[place]
        wanted[one] -= 1
        if not wanted[one]:
            enough.add(one)
    return found


def without_dominated(left: Mapping[int, list[Option]], minima: Mapping[int, int]) -> dict[int, list[Option]]:
    """Return of each group as many options as there are slots for it, the first ones: cut (3)."""
    kinds: defaultdict[IRI, list[InterchangeabilityClass]] = defaultdict(list)
    for options in left.values():
        for option in options:
            kinds[option.component].append(option.kind)
    sizes = Counter(map(tuple, kinds.values()))
    limits = {group: sum(minima[kind.role] for kind in group) for group, size in sizes.items() if size > 1}
    crowded = {group: limit for group, limit in limits.items() if limit < sizes[group]}
    if not crowded:
        return dict(left)
    kept: dict[int, list[Option]] = {}
    for role, options in left.items():
        count: Counter[tuple[InterchangeabilityClass, ...]] = Counter()
        kept[role] = []
        for option in options:
            group = tuple(kinds[option.component])
            if group in crowded:
                count[group] += 1
                if count[group] > crowded[group]:
                    continue
            kept[role].append(option)
    return kept
