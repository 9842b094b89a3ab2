"""Irreducible sets of constraints that cannot hold together, by the cheapest way that there is.

1. Arc consistency leaves a role without candidates (a domain wipe-out). If each of them has a need that nothing
   supports, a minimal hitting set of such needs is the core; irreducible by itself, and found in linear time, which
   matters where a thousand candidates have as many needs. Else the constraints that the derivation used, from that role
   back to the needs that nothing supports, cannot hold together.
2. Matching fails: Hall's set of roles.
3. Groups of options that exclude each other are fewer than the slots that draw on them: these roles, and the needs from
   which the groups follow.
4. Needs of which no component supplies two have fewer slots to supply them than they are: these needs, and the roles
   whose components cannot do without.
5. Otherwise the clause-learning engine names assumptions that cannot hold together (an unsatisfiable core), again and
   again with one of them left out, until each is needed.

What else 1 to 4 give is made irreducible by QuickXplain (Junker, AAAI 2004), unless Hall's set lacks one component
only: then the rest is possible without any one of its roles. So is the set of all constraints where there is no such
engine: a question of the kind "can these hold together?" for about k log(n / k) subsets, k being what remains of n.
Each is decided on a subproblem with only these constraints in force, which is small when they are few.
Irreducible (a minimal unsatisfiable subset) does not mean smallest. It is, if all other constraints can hold without
any one of it, as then no set does without that one; else the smallest is looked for afterwards, with a budget of its
own (`smallest_core`). Where the budget for making it irreducible ends, the core is the smallest set that was met until
then.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Sequence

from selfconf.model.partition import ANY_VALUE
from selfconf.model.refusal import Undecided
from selfconf.search.budget import Budget
from selfconf.search.engines import (
    ClauseSolver,
    HallSet,
    Undersupply,
    counted_needs,
    exclusive_groups,
    first_solution,
    hall_set,
    smallest_core,
    solver_available,
    supplied,
)
from selfconf.search.reduction import (
    Constraint,
    Distinct,
    Fed,
    InterchangeabilityClass,
    Played,
    ReducedProblem,
    Shared,
    all_of,
    consistent,
    pruned,
    subproblem,
)

READINGS = 4_000_000
"""Needs and supports of classes that are read at most, a second or two: each question that arc consistency or matching
answers reads all of them, and writes down the options anew, and has no other cost."""
PORTS_PER_OPTION = 2
"""As how many needs and supports an option counts that is written down."""
SMALLEST_STEPS = 20_000
"""Steps spent at most on looking for a smaller reason."""
SMALLEST_OPTIONS = 5_000
"""In how many options at most a smaller reason is looked for."""
INDISPENSABLE_STEPS = 3_000
"""Steps of depth-first search at most to find a reason to be the smallest without a solver."""
QUESTION_STEPS = 1000
"""Steps of depth-first search for one question before clauses are written."""


class FeasibilityOracle:
    """Decides which constraints of a problem can hold together, within a budget for all questions."""

    def __init__(self, given: ReducedProblem, budget: Budget, readings: Budget | None = None) -> None:
        self.given, self.budget = given, budget
        self.readings = readings or Budget(READINGS)
        """How many needs and supports may still be read to prepare questions, which takes no steps of the other one."""
        ports = sum(len(kind.needs) + len(kind.supports) for kind in given.kinds())
        self._size = ports + PORTS_PER_OPTION * sum(map(len, given.options))
        """What a question has to read."""
        self.complete = True
        """False once a question was left open: then what remains may be reducible."""
        self.single = False
        """Whether needs are counted that only roles of one slot each may supply."""

    def feasible(self, constraints: Iterable[Constraint], aided: bool = True) -> bool | Undecided:
        """Return whether constraints can hold together, all others being dropped, where need be `aided` by a solver."""
        wanted = set(constraints)
        distinct = Distinct() in wanted
        if self.readings.steps == 0:
            return Undecided(0)
        self.readings.spend(self._size)
        part = subproblem(self.given, wanted)
        if part.wiped_out() is not None or (distinct and self._hall_set(part, wanted)):
            return False
        if isinstance(supplied(part, counted_needs(part, self.single)), Undersupply):
            return False
        aided = aided and solver_available()
        self.budget.spend(len(wanted) + sum(map(len, part.options)))
        if self.budget.steps == 0:
            return Undecided(0)
        found = first_solution(part, self.budget.part(QUESTION_STEPS) if aided else self.budget, distinct)
        if isinstance(found, Undecided) and aided:
            with ClauseSolver(part, distinct=distinct) as clauses:
                return clauses.solve((), self.budget)
        return found if isinstance(found, Undecided) else found is not None

    def _hall_set(self, part: ReducedProblem, constraints: set[Constraint]) -> HallSet | None:
        # Roles that need not be played could leave their slots empty, and lack nothing.
        required = {one.role for one in constraints if isinstance(one, Played)}
        return hall_set([role for role in part.slots if role in required], part.components())

    def irreducible(self, together: Sequence[Constraint]) -> tuple[Constraint, ...]:
        """Return some of the constraints that cannot hold together, but could without any one of them: QuickXplain."""
        order = sorted(together, key=_preference)
        return tuple(sorted(self._quickxplain((), order, changed=False), key=order.index)) if order else ()

    def _quickxplain(
        self, background: tuple[Constraint, ...], rest: Sequence[Constraint], changed: bool
    ) -> tuple[Constraint, ...]:
        if changed and self._infeasible(background):
            return ()
        if len(rest) == 1:
            return tuple(rest)
        half = len(rest) // 2
        first, second = tuple(rest[:half]), tuple(rest[half:])
        of_second = self._quickxplain((*background, *first), second, changed=True)
        of_first = self._quickxplain((*background, *of_second), first, changed=bool(of_second))
        return (*of_first, *of_second)

    def _infeasible(self, together: tuple[Constraint, ...]) -> bool:
        # With no role to be played, the empty assignment meets every other constraint.
        if not any(isinstance(one, Played) for one in together):
            return False
        answer = self.feasible(together)
        if isinstance(answer, Undecided):
            self.complete = False
            return False
        return not answer


def _preference(constraint: Constraint) -> int:
    """Return how late a constraint comes: QuickXplain drops late ones if it can, and readers think of roles first."""
    return [Played, Fed, Shared, Distinct].index(type(constraint))


def core(oracle: FeasibilityOracle) -> tuple[Constraint, ...]:
    """Return an irreducible set of constraints that cannot hold together."""
    given = oracle.given
    consistent_part = pruned(given)
    wiped_out = [role for role, slots in Counter(given.slots).items() if len(consistent_part.options[role]) < slots]
    if wiped_out:
        return never_met(given, wiped_out) or oracle.irreducible(derivation(given, wiped_out[0]))
    lack = hall_set(given.slots, given.components())
    if lack is not None:
        together: tuple[Constraint, ...] = (*map(Played, lack.roles), Distinct())
        return together if lack.wanted == lack.found + 1 else oracle.irreducible(together)
    crowded = exclusive_groups(consistent_part).crowded
    if crowded:
        together = _among(given, crowded)
        # What arc consistency removed before may have needed an input that a role outside feeds.
        if oracle.feasible(together) is False:
            return oracle.irreducible(together)
    for oracle.single in (False, True):
        short = supplied(consistent_part, counted_needs(consistent_part, oracle.single))
        if isinstance(short, Undersupply):
            # As above, other needs may have had a part in this; then all constraints are looked at.
            together = (*filter(_is_played, all_of(given)), *map(Fed, sorted(short.needs)))
            if oracle.feasible(together) is False:
                return oracle.irreducible(together)
    oracle.single = False
    if not solver_available():
        return oracle.irreducible(all_of(given))
    return _core_by_deletion(oracle)


def _is_played(constraint: Constraint) -> bool:
    return isinstance(constraint, Played)


def _among(given: ReducedProblem, roles: Collection[int]) -> tuple[Constraint, ...]:
    """Return the constraints that are about some roles alone."""
    return tuple(
        one
        for one in all_of(given)
        if isinstance(one, Distinct | Shared)
        or (isinstance(one, Played) and one.role in roles)
        or (isinstance(one, Fed) and {given.needs[one.need].role, *_sources(given, one.need)} <= set(roles))
    )


def _sources(given: ReducedProblem, need: int) -> set[int]:
    return {source.role for source in given.needs[need].sources}


def smallest_of(oracle: FeasibilityOracle, known: tuple[Constraint, ...]) -> tuple[tuple[Constraint, ...], bool]:
    """Return a smallest set of constraints that cannot hold together, given an irreducible one, and whether it is one.

    Of a set of two neither is enough: every role has as many candidates as it asks for, and where none has to be played
    nothing fails. A set of three is one of the smallest if no two fail. Beyond, a solver is asked only where some
    requirement of the set is not seen to be indispensable: to load it takes longer than all the rest.
    """
    given = oracle.given
    if len(known) <= 2 or (len(known) == 3 and not _two_may_fail(given)) or _each_indispensable(oracle, known):
        return known, True
    if not solver_available() or sum(map(len, given.options)) > SMALLEST_OPTIONS:
        return known, False
    budget = oracle.budget.part(SMALLEST_STEPS)
    with ClauseSolver(given, guarded=True) as clauses:
        constraint_of = {clauses.guards[one]: one for one in all_of(given) if one in clauses.guards}
        order = [*constraint_of]
        irreducible = [clauses.guards[one] for one in known]
        needed = set(irreducible)
        clauses.prefer(clauses.guards.values())

        def held(wanted: Collection[int]) -> Collection[int] | Undecided | None:
            """Return the guards of a maximal set of constraints that hold together with those that are wanted."""
            together = set(wanted)
            for one in (None, *order):
                if one in together:
                    continue
                with_it = together if one is None else together | {one}
                left = needed - with_it
                if not left:
                    continue
                asked = [*filter(with_it.__contains__, order)]
                if len(left) == 1:  # it cannot hold with the others, which may be hard to find out anew
                    asked.append(-left.pop())
                answer = clauses.solve(asked, budget)
                if isinstance(answer, Undecided):
                    return answer
                if answer:
                    together = set(clauses.holding(order))
                elif one is None:
                    return None
            return together

        found, proved = smallest_core(irreducible, order, held, budget)
        return tuple(constraint_of[guard] for guard in found), proved


def _two_may_fail(given: ReducedProblem) -> bool:
    """Return False if any two constraints can hold together.

    Two that cannot are a role that has to be played and a need that nothing supports, without which too few of its
    options go; or such a role and a variable of which its options admit no value, or, where it has several slots, no
    value in common, which is not looked at.
    """
    supported = _supported(given)
    for role, slots in Counter(given.slots).items():
        kinds = [option.kind for option in given.options[role]]
        unmet = Counter(need for kind in kinds for need in kind.needs if need not in supported)
        if any(len(kinds) - having < slots for having in unmet.values()):
            return True
        for variable, common in enumerate(given.values):
            if slots > 1 or not any(kind.admits.get(variable, ANY_VALUE) & common for kind in kinds):
                return True
    return False


def _each_indispensable(oracle: FeasibilityOracle, known: Collection[Constraint]) -> bool:
    """Return whether depth-first search soon finds that without any one of some constraints all others can hold.

    Then no set that cannot hold together does without one of them. Mostly that is so.
    """
    quick = FeasibilityOracle(oracle.given, oracle.budget.part(INDISPENSABLE_STEPS), oracle.readings)
    every = all_of(oracle.given)
    return all(quick.feasible([one for one in every if one != left_out], aided=False) is True for left_out in known)


def _core_by_deletion(oracle: FeasibilityOracle) -> tuple[Constraint, ...]:
    """Return a core of the clause-learning engine, made irreducible by leaving out one constraint at a time.

    All questions go to one solver, which keeps what it learned; each answer "no" names a smaller core to go on with.
    """
    constraints = sorted(all_of(oracle.given), key=_preference)
    with ClauseSolver(oracle.given, guarded=True) as clauses:
        left = [clauses.guards[one] for one in constraints if one in clauses.guards]
        needed: set[int] = set()
        if clauses.solve(left, oracle.budget) is False:
            named = clauses.core()
            left = [guard for guard in left if guard in named]
        for guard in reversed(list(left)):
            if guard not in left:
                continue
            answer = clauses.solve([other for other in left if other != guard], oracle.budget)
            if answer is False:
                # A core need not name what was found to be needed, which is in every core of what is left.
                named = clauses.core() | needed
                left = [other for other in left if other in named]
            else:
                needed.add(guard)
                oracle.complete &= answer is True
        remaining = set(left)
        return tuple(one for one in constraints if clauses.guards.get(one) in remaining)


def _supported(given: ReducedProblem) -> set[int]:
    """Return the needs that some class supports."""
    return {need for kind in given.kinds() for need in kind.supports}


def never_met(given: ReducedProblem, roles: Iterable[int]) -> tuple[Constraint, ...]:
    """Return that a role is played, and needs that nothing supports of which each of its candidates has one.

    It is the first of some roles of which this is true. Without any one of the constraints the others can hold: each is
    the only one of them that some class has, and this class could play alone. Nothing where each role has a candidate
    without such a need, or asks for several players.
    """
    supported, asked = _supported(given), Counter(given.slots)
    for role in roles:
        hopeless = [set(kind.needs) - supported for kind in {option.kind for option in given.options[role]}]
        if asked[role] == 1 and all(hopeless):
            return (Played(role), *map(Fed, sorted(_hitting_set(hopeless))))
    return ()


def _hitting_set(sets: Sequence[Collection[int]]) -> Collection[int]:
    """Return some of the members of sets, of which each set has one; without any one of them a set has none.

    Members of many sets are taken first, and those are left out again that later ones are enough beside.
    """
    having: dict[int, list[int]] = {}
    for place, members in enumerate(sets):
        for member in members:
            having.setdefault(member, []).append(place)
    times = [0] * len(sets)
    # Of members of as many sets the last, which for needs is the one that arc consistency comes to first.
    chosen = dict.fromkeys(sorted(having, key=lambda member: (-len(having[member]), -member)))
    for member in [*chosen]:
        if any(not times[place] for place in having[member]):
            for place in having[member]:
                times[place] += 1
        else:
            del chosen[member]
    for member in reversed([*chosen]):
        if all(times[place] > 1 for place in having[member]):
            del chosen[member]
            for place in having[member]:
                times[place] -= 1
    return chosen


def derivation(given: ReducedProblem, role: int) -> tuple[Constraint, ...]:
    """Return the constraints by which arc consistency leaves a role without candidates, from it back to the causes."""
    played = list(dict.fromkeys(given.slots))
    kinds = given.kinds()
    _, removals = consistent(kinds, len(given.needs), given.values, played)
    place_of = {id(removal.kind): place for place, removal in enumerate(removals)}
    supporting: dict[int, list[InterchangeabilityClass]] = {}
    for kind in kinds:
        for need in kind.supports:
            supporting.setdefault(need, []).append(kind)
    found: dict[Constraint, None] = {Played(role): None}
    waiting = [place_of[id(kind)] for kind in kinds if kind.role == role and id(kind) in place_of]
    seen = set(waiting)
    while waiting:
        place = waiting.pop()
        removal = removals[place]
        if removal.need is not None:
            found[Fed(removal.need)] = None
            causes = supporting.get(removal.need, [])
        else:
            found[Shared(removal.variable or 0)] = None
            found.update(dict.fromkeys(map(Played, played)))
            causes = kinds
        # What supported the need, or admitted the value, had been removed before: these removals are causes too.
        for earlier in [place_of.get(id(kind), place) for kind in causes]:
            if earlier < place and earlier not in seen:
                seen.add(earlier)
                waiting.append(earlier)
    return tuple(found)
