"""The kernel of a problem: the candidates that can matter to its least solution, by kind.

Three cuts, each of which keeps the least solution.
(1) Of each kind of a role with k slots take the first k candidates. If nobody is among all these twice, they suffice:
of a least solution give each slot in turn the next of them that is of the kind in that slot. All are different, and of
those in a role, in order, none comes later than the one in its place did. So it is the same solution.
(2) Otherwise let S be the number of all slots. Of each kind of a role the first S suffice: were a later one in a slot
of the least solution, then at most S - 1 of the first S would play, one of them would be free, and putting it there
would give a lesser solution. This needs no knowledge of who is eligible for what else.
(3) Let a group be the candidates that are eligible for exactly the same roles R, with the same kind in each, and k
the number of slots of R. For each role of R the first k of the group suffice, by the same argument: members can only
play in the k slots of R. Keeping one per kind would be wrong as soon as roles share candidates.
Roles with no slots take no part: nobody plays them before the extension.

The cuts need no more of a kind than that whoever is of it can take the place of another. So they hold for any order of
the candidates, for what is left when requirements are dropped (`requirement`), and when components are added, as long
as nobody who is a candidate becomes one of a further role. Whoever may is set *apart*: of a kind of its own, so that
it is neither cut nor counted as one of the first; with somebody apart, cut (1) is left out.

Cost: a pass over the candidates of roles that have slots, and where these share candidates another one; after it only
kinds and kept candidates are touched.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Hashable, Mapping, Sequence
from functools import cached_property
from itertools import compress
from operator import attrgetter, not_

from selfconf.model.partition import Candidate
from selfconf.model.profile import Ports
from selfconf.model.term import IRI
from selfconf.search.problem import Problem
from selfconf.search.reduction.needs import Wiring
from selfconf.search.reduction.reduced_problem import InterchangeabilityClass, Option, ReducedProblem, likeness

_PORTS: Callable[[Candidate], Ports] = attrgetter("profile.ports")
_ADMITS: Callable[[Candidate], tuple[int, ...]] = attrgetter("admits")


def reduced(
    problem: Problem,
    apart: Collection[IRI] = (),
    order: Mapping[int, Sequence[int]] | None = None,
    roles: int | None = None,
) -> ReducedProblem:
    """The kernel of a problem; components that are set apart are of no kind but their own.

    `order` is another order of the candidates of each role, by number: then the first and the least are by that.
    With `roles` it is the kernel of what is asked of the first so many of them alone: where that has no solution, the
    problem has none. A role that asks for more than there are has one slot more than there are, which is as impossible.
    """
    slots = tuple(
        role
        for role, (asked, candidates) in enumerate(zip(problem.roles[:roles], problem.candidates, strict=False))
        for _ in range(min(asked.minimum, 1 + len(candidates)))
    )
    minima = Counter(slots)
    wiring = Wiring(problem, roles)
    numbers, shared = _enough(problem, apart, order, minima)
    most = dict.fromkeys(minima, len(slots)) if shared else minima
    left: dict[int, list[Option]] = {}
    kinds: dict[int, list[InterchangeabilityClass]] = {}
    for role, some in numbers.items():
        left[role], kinds[role] = _alike(role, problem.candidates[role], some, most[role], apart)
        needs = wiring.needed(role, [kind.likes[0][0].inputs for kind in kinds[role]])
        for kind, one in zip(kinds[role], needs, strict=True):
            kind.needs = one
    for role, alike in kinds.items():
        gives = wiring.served(role, [kind.likes[0][0].outputs for kind in alike])
        for kind, one in zip(alike, gives, strict=True):
            kind.gives = one
    if shared:
        left = thinned(left, minima)
    return ReducedProblem(
        slots,
        tuple(tuple(left.get(role, ())) for role in range(len(problem.roles))),
        tuple(wiring.needs),
        problem.open_values,
    )


def _enough(
    problem: Problem,
    apart: Collection[IRI],
    order: Mapping[int, Sequence[int]] | None,
    minima: Mapping[int, int],
) -> tuple[Mapping[int, Sequence[int]], bool]:
    """The candidates of each role that can matter, by number, by cut (1) or else (2), and whether it was (2)."""
    everybody: dict[int, Sequence[int]] = {
        role: range(len(problem.candidates[role])) if order is None else order[role] for role in minima
    }
    slots = sum(minima.values())
    if apart:
        return {role: _with(problem.candidates[role], some, slots, apart) for role, some in everybody.items()}, True
    if not _twice(problem, {role: some[:1] for role, some in everybody.items()}):
        firsts = {role: _first(problem.candidates[role], some, minima[role]) for role, some in everybody.items()}
        if not _twice(problem, firsts):
            return firsts, False
    return {role: _first(problem.candidates[role], some, slots) for role, some in everybody.items()}, True


def _with(candidates: Sequence[Candidate], numbers: Sequence[int], most: int, apart: Collection[IRI]) -> Sequence[int]:
    """Those of the first so many that share ports who are not apart, and all who are."""
    first = set(_first(candidates, numbers, most + len(apart)))
    return [number for number in numbers if number in first or candidates[number].profile.component in apart]


def _twice(problem: Problem, numbers: Mapping[int, Sequence[int]]) -> bool:
    """Whether some component is among these candidates twice."""
    names = [problem.candidates[role][number].profile.component for role, some in numbers.items() for number in some]
    return len(set(names)) < len(names)


def _alike(
    role: int,
    candidates: Sequence[Candidate],
    numbers: Sequence[int],
    most: int,
    apart: Collection[IRI],
) -> tuple[list[Option], list[InterchangeabilityClass]]:
    """Those of some candidates that are among the first so many of their kind, and the kinds."""
    many = len(numbers) > most
    kinds: dict[Hashable, InterchangeabilityClass] = {}
    met: dict[InterchangeabilityClass, int] = {}
    found: list[Option] = []
    for number in numbers:
        candidate = candidates[number]
        component = candidate.profile.component
        like = likeness(candidate)
        same = (like, component) if component in apart else like
        kind = kinds.get(same)
        if kind is None:
            kind = kinds[same] = InterchangeabilityClass(role, (), (), like[1], number, (like,))
        if many:
            seen = met[kind] = met.get(kind, 0) + 1
            if seen > most:
                continue
        found.append(Option(number, component, kind))
    return found, list(kinds.values())


def _first(candidates: Sequence[Candidate], numbers: Sequence[int], most: int) -> Sequence[int]:
    """Those among the first so many that share one and the same ports and values.

    The pass over all candidates: no step of Python for who is passed over, nor a look at what ports say. Ports that
    say the same but are not shared count as different here, which costs time alone.
    """
    if len(numbers) <= most:
        return numbers
    ordered = candidates if isinstance(numbers, range) else [candidates[number] for number in numbers]
    shared: list[Hashable] = list(map(id, map(_PORTS, ordered)))
    if ordered[0].admits:
        shared = list(zip(shared, map(id, map(_ADMITS, ordered)), strict=True))
    if most == 1:
        places = sorted(dict(zip(reversed(shared), reversed(range(len(shared))), strict=True)).values())
        return places if isinstance(numbers, range) else [numbers[place] for place in places]
    wanted = {one: min(count, most) for one, count in Counter(shared).items()}
    left = sum(wanted.values())
    found: list[int] = []
    enough: set[Hashable] = set()
    for place in compress(range(len(shared)), map(not_, map(enough.__contains__, shared))):
        found.append(numbers[place])
        if len(found) == left:
            break
        one = shared[place]
        wanted[one] -= 1
        if not wanted[one]:
            enough.add(one)
    return found


def thinned(left: Mapping[int, list[Option]], minima: Mapping[int, int]) -> dict[int, list[Option]]:
    """Of each group as many options as there are slots for it, the first ones: cut (3)."""
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


class LazyReduction:
    """A problem, made compact when that is first asked for."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem

    @cached_property
    def reduced(self) -> ReducedProblem:
        """The kernel of the problem."""
        return reduced(self.problem)
