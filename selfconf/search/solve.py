"""The strategy `first`: the lexicographically first solution, or a proof that there is none.

*Problem.* Given roles, candidates and interactions (`problem`), fill every slot with a component of its own so that
every input of every component is fed and the free parameters have a value. *Hardness.* Deciding this is NP-complete,
already with one sink: given a formula in conjunctive normal form, take a feeder role per variable with two
candidates, one per truth value, that issue a signal for each clause they satisfy, and a sink with an input per clause.
A configuration is a satisfying assignment. Without inputs it is bipartite matching.

*The answer.* Solutions are compared slot by slot. Algorithm 1 of the paper with its working set as a queue expands
partial configurations in the order of their roles and candidates, so that the first complete one is the least
(`paper`). The least is unique: which engine finds it, and how long each was allowed to try, changes the time alone.

*Invariants.* Every step keeps the least solution: arc consistency and the kernel by their proofs (`compact`), depth
first by its order (`probe`, `walk`), the clause-learning engine by asking for a lesser solution until there is none
(`sat`). "None" comes from a role that runs out of candidates, from Hall's theorem (`matching`), from an exhausted
search or from a refuted set of clauses, never from a budget that ended.

*Costs.* An easy instance takes a few steps for each slot, however many candidates there are; then a pass over the
candidates and matching, slots times options; then depth first for about as many steps as writing down the clauses
would take, so that it never costs more than it could have saved; then clause learning, exponential in the worst
case. Without a solver library depth-first search goes on by itself.
"""

from __future__ import annotations

from selfconf.model.configuration import Configuration
from selfconf.model.partition import Candidate
from selfconf.model.refusal import Refusal, Undecided
from selfconf.search import explain, sat
from selfconf.search.compact import Compact, Option, compact
from selfconf.search.matching import shortage
from selfconf.search.probe import probe
from selfconf.search.problem import Problem
from selfconf.search.walk import Budget, walk

PROBE_STEPS = 8
"""Steps per slot before anything is prepared."""
WALK_STEPS = 1000
"""Steps of depth-first search before clauses are written, and one more per option."""


def search(problem: Problem) -> Configuration | Refusal:
    """The lexicographically first configuration, or why there is none."""
    playing = solution(problem, Budget())
    if isinstance(playing, list):
        return problem.solved(playing)
    return explain.refusal(problem)


def decide(problem: Problem, steps: int) -> Configuration | Refusal | Undecided:
    """The same within a number of steps, which mean the same on every machine."""
    playing = solution(problem, Budget(steps))
    if isinstance(playing, Undecided):
        return playing
    return explain.refusal(problem, steps) if playing is None else problem.solved(playing)


def solution(problem: Problem, budget: Budget) -> list[list[Candidate]] | Undecided | None:
    """The least solution as candidates per role; None if there is none."""
    if problem.unvalued or any(
        len(candidates) < role.minimum or (role.maximum is not None and role.maximum < role.minimum)
        for role, candidates in zip(problem.roles, problem.candidates, strict=True)
    ):
        return None
    slots = sum(role.minimum for role in problem.roles)
    most = budget.part(PROBE_STEPS * (slots + 4)).steps
    found = probe(problem, most or 0)
    if found is not None:
        return found
    budget.spend(most or 0)
    chosen = least(compact(problem), budget)
    if not isinstance(chosen, list):
        return chosen
    playing: list[list[Candidate]] = [[] for _ in problem.roles]
    for option in chosen:
        role = option.kind.role
        playing[role].append(problem.candidates[role][option.number])
    return playing


def least(given: Compact, budget: Budget) -> list[Option] | Undecided | None:
    """The least solution of a compact problem, by whichever engine finds it."""
    if given.short() is not None:
        return None
    if shortage(given.slots, [[option.component for option in options] for options in given.options]):
        return None
    if not sat.available():
        return walk(given, budget)
    part = budget.part(WALK_STEPS + sum(map(len, given.options)))
    steps = part.steps or 0
    chosen = walk(given, part)
    budget.spend(steps - (part.steps or 0))
    return sat.least(given, budget) if isinstance(chosen, Undecided) else chosen
