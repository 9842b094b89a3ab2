"""The general solvers asked the question that selfconf answers: which configuration is lexicographically the first.

Each is asked as its users would ask it. clingo can be told to decide on the candidates in order, the first one left
first, so that it meets the first configuration first; or to weigh them, a level for each role. CP-SAT weighs some
roles at a time. With python-sat one asks for an earlier candidate, role after role, until there is none. All must name
the same components.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from itertools import accumulate
from typing import Any

from benchmarks.search.engines import PROGRAM, clauses_of, cp_model_of, facts
from selfconf.model.term import IRI
from selfconf.search.budget import Budget
from selfconf.search.problem import Problem
from selfconf.search.reduction.dominance import LazyReduction
from selfconf.search.strategies import first as solve

First = tuple[IRI, ...] | bool
"""Who plays the roles in the first configuration, or False if there is none."""


def selfconf(problem: Problem) -> First:
    """The strategy `first`."""
    playing = solve.solution(LazyReduction(problem), Budget())
    return tuple(c.profile.component for some in playing for c in some) if isinstance(playing, list) else False


WEIGHED = ":~ plays(R,C), rank(R,C,K). [K@-R]\n"
IN_ORDER = "#heuristic plays(R,C) : rank(R,C,K), before(R,B), total(T). [T-B-K,true]\n"
LEVELS = 32_767
"""How many decisions clingo can be told the order of."""
WEIGHT = 2**40
"""How much a solution may weigh for CP-SAT."""
BITS = 30
"""How many candidates of a role with several players are weighed at once, as each has twice the weight of the next."""


def able(engine: str, problem: Problem) -> bool:
    """Whether an engine can be asked at all."""
    if engine == "clingo, weights":
        return all(role.minimum == 1 for role in problem.roles)
    return engine != "clingo, heuristic" or sum(map(len, problem.candidates)) <= LEVELS


def clingo(problem: Problem, rule: str, options: Sequence[str] = ()) -> First:
    """The program for any configuration with one more rule; the last answer set is the best one."""
    import clingo as asp

    numbers: dict[IRI, int] = {}
    place = {
        (role, numbers.setdefault(candidate.profile.component, len(numbers))): rank
        for role, candidates in enumerate(problem.candidates)
        for rank, candidate in enumerate(candidates)
    }
    ranks = [f"rank({role},{component},{rank})." for (role, component), rank in place.items()]
    sizes = [0, *accumulate(map(len, problem.candidates))]
    order = [f"before({role},{size})." for role, size in enumerate(sizes[:-1])] + [f"total({sizes[-1]})."]
    control = asp.Control(["--warn=none", *options])
    control.add("base", [], PROGRAM + rule + "#show plays/2.\n" + "\n".join([*facts(problem), *ranks, *order]))
    control.ground([("base", [])])
    found: First = False
    names = list(numbers)
    with control.solve(yield_=True) as models:
        for model in models:
            pairs = [tuple(one.number for one in symbol.arguments) for symbol in model.symbols(shown=True)]
            pairs.sort(key=lambda pair: (pair[0], place[pair]))
            found = tuple(names[component] for _, component in pairs)
            if not model.cost:
                break
    return found


def cp_sat(problem: Problem) -> First:
    """CP-SAT: as many roles at once as an integer can weigh, what is settled being fixed for the rest."""
    from ortools.sat.python import cp_model

    model, plays = cp_model_of(problem)
    solver = cp_model.CpSolver()
    solver.parameters.num_workers = 1
    # What is weighed as one: a role with one player, or some candidates of one with several.
    parts: list[tuple[int, list[Any], bool]] = []
    for number, (role, literals) in enumerate(zip(problem.roles, plays, strict=True)):
        size = max(1, len(literals)) if role.minimum == 1 else BITS
        starts = range(0, len(literals), size)
        parts += [(number, literals[start : start + size], role.minimum == 1) for start in starts]
    found: list[list[bool]] = [[] for _ in plays]
    settled = 0
    while settled < len(parts):
        spans: list[int] = []
        for _, literals, single in parts[settled:]:
            spans.append(len(literals) if single else 2 ** len(literals))
            if len(spans) > 1 and math.prod(spans) > WEIGHT:
                spans.pop()
                break
        weighed = parts[settled : settled + len(spans)]
        weight = math.prod(spans)
        terms = []
        for (_, literals, single), span in zip(weighed, spans, strict=True):
            weight //= span
            ranks = range(span) if single else [-(2**k) for k in reversed(range(len(literals)))]
            terms += [weight * rank * literal for rank, literal in zip(ranks, literals, strict=True) if rank]
        model.minimize(cp_model.LinearExpr.sum(terms))
        if solver.solve(model) != cp_model.OPTIMAL:
            return False
        for number, literals, _ in weighed:
            values = [solver.boolean_value(literal) for literal in literals]
            found[number] += values
            for literal, holds in zip(literals, values, strict=True):
                model.add(literal == holds)
        settled += len(weighed)
    return _named(problem, found)


def python_sat(problem: Problem, solver: str = "glucose4") -> First:
    """python-sat: role after role, earlier candidates are assumed to play until one can.

    To assume that one of all that are left does, or of half of them, took as long or many times longer: propagation
    refutes a single one in no time, and each such question is a clause more.
    """
    with clauses_of(problem, solver) as (clauses, plays):
        if not clauses.solve():
            return False
        true = set(clauses.get_model())
        for role, literals in zip(problem.roles, plays, strict=True):
            left = role.minimum
            for literal in literals:
                if literal not in true:
                    if not clauses.solve(assumptions=[literal]):
                        clauses.add_clause([-literal])
                        continue
                    true = set(clauses.get_model())
                clauses.add_clause([literal])
                left -= 1
                if not left:
                    break
        return _named(problem, [[literal in true for literal in literals] for literals in plays])


def _named(problem: Problem, playing: list[list[bool]]) -> First:
    return tuple(
        candidate.profile.component
        for candidates, some in zip(problem.candidates, playing, strict=True)
        for candidate, plays in zip(candidates, some, strict=True)
        if plays
    )


ENGINES: dict[str, Callable[[Problem], First]] = {
    "selfconf": selfconf,
    "clingo, weights": partial(clingo, rule=WEIGHED),
    "clingo, heuristic": partial(clingo, rule=IN_ORDER, options=["--heuristic=Domain"]),
    "CP-SAT": cp_sat,
    "python-sat": python_sat,
    "CaDiCaL": partial(python_sat, solver="cadical195"),
    "MiniCard": partial(python_sat, solver="minicard"),
}
