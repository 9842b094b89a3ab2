"""The strategy `first`: the lexicographically first solution, or a proof that there is none.

*Problem.* Given roles, candidates and interactions (`problem`), fill every slot with a component of its own so that
every input of every component is fed and the free parameters have a value. *Hardness.* Deciding this is NP-complete,
already with one sink: given a formula in conjunctive normal form, take a feeder role per variable with two
candidates, one per truth value, that issue a signal for each clause they satisfy, and a sink with an input per clause.
A configuration is a satisfying assignment. Without inputs it is bipartite matching.

*The answer.* Solutions are compared slot by slot. Algorithm 1 of the paper with its working set as a queue expands
partial configurations in the order of their roles and candidates, so that the first complete one is the least
(`paper`). The least is unique: which engine finds it, and how long each was allowed to try, changes the time alone.

*Invariants.* Every stage keeps the least solution: dominance and arc consistency by their proofs (`dominance`,
`arc_consistency`), depth-first search by its order (`candidate_search`, `reduced_search`), clause learning by asking
for a lesser solution until there is none (`clause_learning`). "None" follows from a role without candidates, from
Hall's theorem (`matching`), from an exhausted search or from a refuted set of clauses, never from a budget that ended.

*Costs.* An easy instance takes a few steps for each slot, however many candidates there are, and more where these are
so many that to reduce them takes longer; then a pass over the candidates and matching, slots times options; then
depth-first search, for no more steps than writing down the clauses would take, so that it never costs more than it
could have saved; then clause learning, exponential in the worst case. Depth-first search is left as soon as it has
taken more steps than it should have for the slots it has reached: where it succeeds, it goes ahead steadily; where it
thrashes, it is stuck early, and the cause is near: then the first roles are decided by themselves before the rest of
many is looked at. Without a solver library depth-first search goes on alone. The thresholds were chosen by measurement
(`benchmarks/search/tuning.py`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import reduce
from operator import or_

from selfconf.model.configuration import Configuration
from selfconf.model.immutable import replace
from selfconf.model.partition import Candidate
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.term import IRI
from selfconf.search import explain
from selfconf.search.budget import Budget
from selfconf.search.engines import (
    SLOT_HEADROOM,
    CandidateSearch,
    CountedNeeds,
    HallSet,
    MaintainedMatching,
    OtherWay,
    Undersupply,
    any_by_clauses,
    counted_needs,
    exclusive_groups,
    first_solution,
    hall_set,
    least_by_clauses,
    limits,
    probed,
    solver_available,
    supplied,
    unmatchable,
    value_cases,
    within_capacity,
)
from selfconf.search.extension import solved
from selfconf.search.problem import Problem
from selfconf.search.reduction import LazyReduction, Option, ReducedProblem, assigned, in_order, pruned, reduced

Engine = Callable[[ReducedProblem, Budget, OtherWay | None], list[Option] | Undecided | None]

CANDIDATE_STEPS = 4
"""Steps of search over candidates for each slot reached, at least, before the problem is reduced."""
REDUCED_PER_STEP = 32
"""How many candidates with ports of their own are to be reduced where search over candidates may take a step more.

So it takes a fiftieth of the time of reducing, at most.
"""
REDUCED_PACE = 0.6
"""Steps of search over the reduced problem for each option of the slots reached, before clauses are written."""
PREFIX_REACH = 3
"""For each slot reached, how many of the first slots are decided by themselves to find why none was reached beyond."""
PREFIX_SHARE = 3
"""These are at most one in this number of all slots; where they would be more, the whole problem is decided at once."""


def answers(problem: Problem, steps: int | None = None) -> Iterator[Configuration | Refusal | Undecided]:
    """Yield the lexicographically first configuration, or that it is not decided within a number of steps.

    Where there is none, a refusal without reasons is the first answer, as finding reasons may take longer than the
    search; the second one has them.
    """
    given = LazyReduction(problem)
    playing = solution(given, Budget(steps))
    if isinstance(playing, list):
        yield solved(problem, playing)
    elif isinstance(playing, Undecided):
        yield Undecided(playing.steps if steps is None else steps, unaided=not solver_available())
    else:
        yield Refusal(problem.task.template.iri, ())
        yield explain.refusal(given) if steps is None else explain.refusal(given, steps)


def search(problem: Problem) -> Configuration | Refusal:
    """Return the lexicographically first configuration, or why there is none."""
    *_, answer = answers(problem)
    assert not isinstance(answer, Undecided)
    return answer


def possible(problem: Problem, budget: Budget) -> bool:
    """Return whether a configuration is found within the budget, be it the first one or another."""
    return isinstance(solution(LazyReduction(problem), budget, any_by_clauses), list)


def solution(
    given: LazyReduction, budget: Budget, by_clauses: Engine = least_by_clauses
) -> list[list[Candidate]] | Undecided | None:
    """Return the least solution as candidates per role; None if there is none.

    With `any_by_clauses` it is any solution, where clause learning takes over: it need not be proved to be the least.
    """
    problem = given.problem
    if _short_of_candidates(problem):
        return None
    slots = sum(role.minimum for role in problem.roles)
    for most in _candidate_steps(problem, slots + SLOT_HEADROOM):
        part = budget.part(most)
        steps = part.steps or 0
        search = CandidateSearch(problem, part, most // (slots + SLOT_HEADROOM))
        found = search.first()
        if found is not None or part.steps:
            # Found, or exhausted with steps to spare, which proves that there is none. Neither is charged to the
            # budget: it bounds what takes long.
            return found
        budget.spend(steps)
    prefix = PREFIX_REACH * (search.furthest + SLOT_HEADROOM)
    if PREFIX_SHARE * prefix < slots and _prefix_impossible(problem, search.slots[prefix] + 1, budget):
        return None
    chosen = least_of(given.reduced, budget, by_clauses)
    return assigned(problem, chosen) if isinstance(chosen, list) else chosen


def _candidate_steps(problem: Problem, reach: int) -> Iterator[int]:
    """Yield how many steps search over candidates may take to reach some slots, and again where reducing takes longer.

    Candidates that share their ports take next to no time to reduce. So the ports among the first of each role are
    counted, a step for each of them.
    """
    few = CANDIDATE_STEPS * reach
    yield few
    many = sum(
        len({id(candidate.profile.ports) for candidate in candidates[: len(candidates) // REDUCED_PER_STEP]})
        for role, candidates in zip(problem.roles, problem.candidates, strict=True)
        if role.minimum
    )
    if many > few:
        yield many


def _short_of_candidates(problem: Problem) -> bool:
    """Return whether a role by itself makes the problem impossible."""
    return problem.valueless or any(
        len(candidates) < role.minimum or (role.maximum is not None and role.maximum < role.minimum)
        for role, candidates in zip(problem.roles, problem.candidates, strict=True)
    )


def _prefix_impossible(problem: Problem, roles: int, budget: Budget) -> bool:
    """Return whether the first roles have no solution, even without what later ones ask of them."""
    # Half the budget at most: the prefix may be possible, and then the whole problem is still to be decided.
    part = Budget(None if budget.steps is None else budget.steps // 2)
    steps = part.steps
    found = least_of(reduced(problem, roles=roles), part, any_by_clauses)
    budget.spend((steps or 0) - (part.steps or 0))
    return found is None


def least_of(
    given: ReducedProblem, budget: Budget, by_clauses: Engine = least_by_clauses, dividing: bool = True
) -> list[Option] | Undecided | None:
    """Return the least solution of a reduced problem, by the first engine that finds it; None if there is none.

    It is divided by the values of parameters only with `dividing`.
    """
    remaining = pruned(given)
    if remaining.wiped_out() is not None:
        return None
    matching = _matching(remaining)
    if matching is not None and matching.hall_set is not None:
        return None
    chosen = first_solution(remaining, budget, matching=matching, pace=REDUCED_PACE)
    if not isinstance(chosen, Undecided) or budget.steps == 0:
        return chosen
    supplying = _supplying(remaining)
    if supplying is None:
        return None
    remaining, counted = supplying
    if counted:
        matching = _matching(remaining)
        chosen = first_solution(remaining, budget, matching=matching, pace=REDUCED_PACE, counted=counted)
        if not isinstance(chosen, Undecided) or budget.steps == 0:
            return chosen
        remaining = replace(remaining, limits=limits(remaining, counted))
    if matching is not None:
        return _least_of_sharing(remaining, budget, by_clauses, dividing)
    return _by_clauses(remaining, budget, by_clauses)


def _supplying(given: ReducedProblem) -> tuple[ReducedProblem, list[CountedNeeds]] | None:
    """Return a problem without options that leave counted needs unsupplied, and these needs; None if it is impossible.

    What is left may make more needs unavoidable, so that they are counted until no option is removed: to search in
    between takes longer, and finds little.
    """
    counted = counted_needs(given)
    while (left := supplied(given, counted)) is not given:
        if isinstance(left, Undersupply):
            return None
        given = pruned(left)
        if given.wiped_out() is not None or hall_set(given.slots, given.components()) is not None:
            return None
        counted = counted_needs(given)
    return given, counted


def _matching(given: ReducedProblem) -> MaintainedMatching[IRI] | None:
    """Return a matching of slots and components; None where no component is an option of two roles."""
    return MaintainedMatching(given.slots, given.components()) if given.shares_components() else None


def _least_of_sharing(
    given: ReducedProblem, budget: Budget, by_clauses: Engine, dividing: bool
) -> list[Option] | Undecided | None:
    """Return the least solution of a problem whose roles share components, given that these can be matched.

    Options in no matching are removed only now: that costs about as much as a matching, and an easy search needs none
    of it.
    """
    excluded = unmatchable(given.slots, given.components())
    assert not isinstance(excluded, HallSet)
    remaining = _without(given, excluded)

    def divided() -> list[Option] | Undecided | None:
        cases = value_cases(remaining)
        return Undecided(0) if cases is None else _least_of_cases(cases, budget, by_clauses)

    return _by_clauses(remaining, budget, by_clauses, divided if dividing else None)


def _by_clauses(
    given: ReducedProblem, budget: Budget, by_clauses: Engine, divided: OtherWay | None = None
) -> list[Option] | Undecided | None:
    """Return a solution by clause learning, or by depth-first search without an end where there is no solver.

    The problem is `divided` where clause learning has not decided it soon, or at once where there is no solver.
    """
    if solver_available():
        return by_clauses(given, budget, divided)
    chosen = Undecided(0) if divided is None else divided()
    if not isinstance(chosen, Undecided) or budget.steps == 0:
        return chosen
    if given.shares_components():
        given = probed(given)
        if given.wiped_out() is not None or hall_set(given.slots, given.components()) is not None:
            return None
    able = within_capacity(given)
    if able is None or able.wiped_out() is not None or exclusive_groups(able).impossible:
        return None
    given, matching = able, _matching(able)
    return first_solution(given, budget, matching=matching, counted=counted_needs(given))


def _least_of_cases(cases: list[ReducedProblem], budget: Budget, by_clauses: Engine) -> list[Option] | Undecided | None:
    """Return the least solution of a problem, given all its cases by the values of free parameters.

    Cases that only clause learning decides are decided together: what it learns in one of them it knows in the others,
    and where one has a solution, of the others only lesser ones matter. A case is not divided again: cases of cases of
    many parameters would be too many.
    """
    found: list[list[Option]] = []
    left: list[ReducedProblem] = []
    for case in cases:
        chosen = least_of(case, budget, _left_open if solver_available() else by_clauses, dividing=False)
        if chosen is not None and not isinstance(chosen, Undecided):
            found.append(chosen)
            if by_clauses is any_by_clauses:
                return chosen
        elif chosen is not None:
            left.append(case)
            if budget.steps == 0 or not solver_available():
                return chosen
    if left:
        several = len(left) > 1
        chosen = (
            by_clauses(_together(left), budget, None)
            if several
            else least_of(left[0], budget, by_clauses, dividing=False)
        )
        if isinstance(chosen, Undecided):
            return chosen
        found += [] if chosen is None else [chosen]
    return min(found, key=_numbers, default=None)


def _left_open(_: ReducedProblem, __: Budget, ___: OtherWay | None) -> Undecided:
    """Stand in for clause learning where that is to come later."""
    return Undecided(0)


def _together(cases: list[ReducedProblem]) -> ReducedProblem:
    """Return a problem that has all solutions of some of its cases."""
    merged = [
        {option.number: option for case in cases for option in case.options[role]}
        for role in range(len(cases[0].options))
    ]
    values = tuple(reduce(or_, some) for some in zip(*(case.values for case in cases), strict=True))
    return in_order(replace(cases[0], options=tuple(tuple(some.values()) for some in merged), values=values, limits=()))


def _numbers(chosen: list[Option]) -> list[int]:
    """The order of solutions: slot by slot, option by option."""
    return [option.number for option in chosen]


def _without(given: ReducedProblem, excluded: set[tuple[int, IRI]]) -> ReducedProblem:
    return replace(
        given,
        options=tuple(
            tuple(option for option in options if (role, option.component) not in excluded)
            for role, options in enumerate(given.options)
        ),
    )
