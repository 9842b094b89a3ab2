"""The strategy `first`: the lexicographically first solution, or a proof that there is none.

*Problem.* Given roles, candidates and interactions (`problem`), fill every slot with a component of its own so that
every input of every component is fed and the free parameters have a value. *Hardness.* Deciding this is NP-complete,
already with one sink: given a formula in conjunctive normal form, take a feeder role per variable with two
candidates, one per truth value, that issue a signal for each clause they satisfy, and a sink with an input per clause.
A configuration is a satisfying assignment. Without inputs it is bipartite matching.

*The answer.* Solutions are compared slot by slot. Algorithm 1 of the paper with its working set as a queue expands
partial configurations in the order of their roles and candidates, so that the first complete one is the least
(`paper`). The least is unique: which engine finds it, and how long each was allowed to try, changes the time alone.

*Invariants.* Every step keeps the least solution: the kernel and arc consistency by their proofs (`kernel`,
`consistency`), depth first by its order (`filling`, `walk`), the clause-learning engine by asking for a lesser
solution until there is none (`sat`). "None" comes from a role that runs out of candidates, from Hall's theorem
(`matching`), from an exhausted search or from a refuted set of clauses, never from a budget that ended.

*Costs.* An easy instance takes a few steps for each slot, however many candidates there are; then a pass over the
candidates and matching, slots times options; then depth first, for no more steps than writing down the clauses would
take, so that it never costs more than it could have saved; then clause learning, exponential in the worst case.
Whoever is stuck early often is for a reason that lies near: the first roles by themselves are tried before the rest
of many is so much as looked at.
Depth-first search is left as soon as it has taken more steps than it should have for the slots it has reached: where
it succeeds, it goes ahead steadily; where it thrashes, it is stuck early. Without a solver library it goes on by
itself. The thresholds were chosen by measurement (`benchmarks/search/tuning.py`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

from selfconf.model.configuration import Configuration
from selfconf.model.partition import Candidate
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.term import IRI
from selfconf.search import explain
from selfconf.search.budget import Budget
from selfconf.search.engines import (
    SLOT_HEADROOM,
    CandidateSearch,
    FollowedMatching,
    Shortage,
    any_by_clauses,
    first_solution,
    impossible,
    least_by_clauses,
    solver_available,
)
from selfconf.search.problem import Problem
from selfconf.search.reduction import LazyReduction, Option, ReducedProblem, assigned, pruned, reduced

Engine = Callable[[ReducedProblem, Budget], list[Option] | Undecided | None]

FILL_STEPS = 4
"""Steps per slot reached before anything is prepared; a few slots more, for the smallest problems."""
WALK_PACE = 0.6
"""Steps of depth-first search for each option of the slots reached before clauses are written."""
NEARBY = 3
"""How many times as far as depth first has come the cause is sought why it comes no further."""
SHARE = 3
"""One in how many slots at most may lie that near, or everything is prepared at once."""


def answers(problem: Problem, steps: int | None = None) -> Iterator[Configuration | Refusal | Undecided]:
    """The lexicographically first configuration; or that it is not decided within a number of steps.

    Or that there is none: at first without a word of why, as finding reasons may take longer than the search.
    """
    given = LazyReduction(problem)
    playing = solution(given, Budget(steps))
    if isinstance(playing, list):
        yield problem.solved(playing)
    elif isinstance(playing, Undecided):
        yield Undecided(playing.steps if steps is None else steps, unaided=not solver_available())
    else:
        yield Refusal(problem.task.template.iri, ())
        yield explain.refusal(given) if steps is None else explain.refusal(given, steps)


def search(problem: Problem) -> Configuration | Refusal:
    """The lexicographically first configuration, or why there is none."""
    *_, answer = answers(problem)
    assert not isinstance(answer, Undecided)
    return answer


def decide(problem: Problem, steps: int) -> Configuration | Refusal | Undecided:
    """The same within a number of steps, which mean the same on every machine."""
    *_, answer = answers(problem, steps)
    return answer


def possible(problem: Problem, budget: Budget) -> bool:
    """Whether a configuration is found within the budget, be it the first one or another."""
    return isinstance(solution(LazyReduction(problem), budget, any_by_clauses), list)


def solution(
    given: LazyReduction, budget: Budget, by_clauses: Engine = least_by_clauses
) -> list[list[Candidate]] | Undecided | None:
    """Return the least solution as candidates per role; None if there is none.

    With `any_by_clauses` it is any solution, where clause learning takes over: it need not be proved to be the least.
    """
    problem = given.problem
    if problem.valueless or any(
        len(candidates) < role.minimum or (role.maximum is not None and role.maximum < role.minimum)
        for role, candidates in zip(problem.roles, problem.candidates, strict=True)
    ):
        return None
    slots = sum(role.minimum for role in problem.roles)
    part = budget.part(FILL_STEPS * (slots + SLOT_HEADROOM))
    steps = part.steps or 0
    filling = CandidateSearch(problem, part, FILL_STEPS)
    found = filling.first()
    if found is not None or (part.steps or 0) > 0:
        return found
    budget.spend(steps)
    near = NEARBY * (filling.furthest + SLOT_HEADROOM)
    if SHARE * near < slots and _impossible(problem, filling.slots[near] + 1, budget):
        return None
    chosen = least_of(given.reduced, budget, by_clauses)
    return assigned(problem, chosen) if isinstance(chosen, list) else chosen


def _impossible(problem: Problem, roles: int, budget: Budget) -> bool:
    """Whether the first so many roles are found to have no solution, even without what later ones ask of them."""
    part = Budget(None if budget.steps is None else budget.steps // 2)
    steps = part.steps
    found = least_of(reduced(problem, roles=roles), part, any_by_clauses)
    budget.spend((steps or 0) - (part.steps or 0))
    return found is None


def least_of(
    given: ReducedProblem, budget: Budget, by_clauses: Engine = least_by_clauses
) -> list[Option] | Undecided | None:
    """The least solution of a compact problem, by whichever engine finds it."""
    part = pruned(given)
    if part.short() is not None:
        return None
    components = [[option.component for option in options] for options in part.options]
    partners: FollowedMatching | None = None
    if len(set().union(*components)) < sum(map(len, components)):
        partners = FollowedMatching(part.slots, components)
        if partners.shortage is not None:
            return None
    chosen = first_solution(part, budget, partners=partners, pace=WALK_PACE)
    if not isinstance(chosen, Undecided) or budget.steps == 0:
        return chosen
    if partners is not None:
        never = impossible(part.slots, components)
        assert not isinstance(never, Shortage)
        part = _without(part, never)
        partners = FollowedMatching(part.slots, [[option.component for option in options] for options in part.options])
    return by_clauses(part, budget) if solver_available() else first_solution(part, budget, partners=partners)


def _without(part: ReducedProblem, never: set[tuple[int, IRI]]) -> ReducedProblem:
    return replace(
        part,
        options=tuple(
            tuple(option for option in options if (role, option.component) not in never)
            for role, options in enumerate(part.options)
        ),
    )
