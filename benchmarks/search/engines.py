"""The search of selfconf and the engines beside it, each fed with the problem as its users would write it down.

An engine gets a problem and answers whether there is a configuration. Ours gives the first one; the general solvers
may give any, which is the easier question (`first` asks them for the first one too). The families ask for fixed numbers
of components. Building the model is part of the time, importing a library is not.

*What is counted is the same for all*: from one and the same problem, in memory, to the answer. Each engine reads ports
and writes its model in Python, as ours does, so that a model that is written slowly would be an advantage of ours. So
the writing takes no step that a user who knows the library would not take: what may feed an input is worked out once
for each name of an input of a role (`Problem.feeding` remembers it), not once for each input of each candidate, and
outputs are looked up by name only where an interaction names one. With both mended, MiniCard took two thirds to four
fifths of the time on families that are wired pair by pair, and a third on 3-SAT, whose sink a hundred roles feed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from importlib import import_module
from importlib.util import find_spec
from typing import Any, TypeVar

from benchmarks.search import sparql
from selfconf.model.configuration import Configuration
from selfconf.search.budget import Budget
from selfconf.search.problem import Problem, Sources
from selfconf.search.reduction.dominance import LazyReduction
from selfconf.search.strategies import first as solve
from selfconf.search.strategies import paper

L = TypeVar("L")


def selfconf(problem: Problem) -> bool:
    """The strategy `first`."""
    return isinstance(solve.solution(LazyReduction(problem), Budget()), list)


def algorithm_1(problem: Problem) -> bool:
    """The paper's algorithm."""
    return isinstance(paper.algorithm_1(problem), Configuration)


PROGRAM = """
K { plays(R,C) : candidate(R,C) } K :- role(R,K).
:- shared(C), 2 { plays(R,C) }.
fed(R,N) :- plays(Q,C), gives(Q,C,R,N).
:- plays(R,C), needs(R,C,N), not fed(R,N).
1 { value(V,K) : domain(V,K) } 1 :- variable(V).
:- plays(R,C), constrained(R,C,V), not value(V,K) : allows(R,C,V,K).
"""


def clingo(problem: Problem) -> bool:
    """Answer set programming (Potassco), one program from facts; default configuration, first answer set."""
    import clingo as asp

    control = asp.Control(["--warn=none"])
    control.add("base", [], PROGRAM + "\n".join(facts(problem)))
    control.ground([("base", [])])
    return bool(control.solve().satisfiable)


def facts(problem: Problem) -> Iterator[str]:
    """A problem as facts of answer set programming; components are numbered as they come."""
    components: dict[str, int] = {}
    for role, candidates in enumerate(problem.candidates):
        yield f"role({role},{problem.roles[role].minimum})."
        for candidate in candidates:
            component = candidate.profile.component
            if component in components:
                yield f"shared({components[component]})."
            number = components.setdefault(component, len(components))
            yield f"candidate({role},{number})."
            for variable, mask in enumerate(candidate.admits):
                if mask >= 0:
                    yield f"constrained({role},{number},{variable})."
                    for value in _bits(mask):
                        yield f"allows({role},{number},{variable},{value})."
    named = [[components[c.profile.component] for c in candidates] for candidates in problem.candidates]
    labels = [[(role, number) for number in some] for role, some in enumerate(named)]
    for need, (needing, givers) in enumerate(_needs(problem, labels)):
        role = needing[0][0]
        yield from (f"needs({role},{number},{need})." for _, number in needing)
        yield from (f"gives({source},{number},{role},{need})." for source, number in dict.fromkeys(givers))
    for number, variable_ in enumerate(problem.variables):
        yield f"variable({number})."
        for value in range(len(variable_.domain)):
            yield f"domain({number},{value})."


def _bits(mask: int) -> Iterator[int]:
    while mask:
        yield (mask & -mask).bit_length() - 1
        mask &= mask - 1


def cp_sat(problem: Problem) -> bool:
    """OR-tools CP-SAT with Boolean variables; one worker, as every other engine has."""
    from ortools.sat.python import cp_model

    solver = cp_model.CpSolver()
    solver.parameters.num_workers = 1
    return bool(solver.solve(cp_model_of(problem)[0]) in (cp_model.OPTIMAL, cp_model.FEASIBLE))


def cp_model_of(problem: Problem) -> tuple[Any, list[list[Any]]]:
    """A problem as a model, and the variables that say who plays which role."""
    from ortools.sat.python import cp_model

    model = cp_model.CpModel()
    plays = [[model.new_bool_var("") for _ in candidates] for candidates in problem.candidates]
    for role, literals in zip(problem.roles, plays, strict=True):
        if role.minimum == 1:
            model.add_exactly_one(literals)
        else:
            model.add(cp_model.LinearExpr.sum(literals) == role.minimum)
    for same in _shared(problem, plays):
        model.add_at_most_one(same)
    for needing, givers in _needs(problem, plays):
        fed = model.new_bool_var("")
        model.add_bool_or([*givers, ~fed])
        for literal in needing:
            model.add_implication(literal, fed)
    for values, some in _values(problem, plays, lambda: model.new_bool_var("")):
        model.add_exactly_one(values)
        for literal, mask in some:
            model.add_bool_or([~literal, *(values[k] for k in _bits(mask))])
    return model, plays


def python_sat(problem: Problem, solver: str = "glucose4") -> bool:
    """python-sat, cardinalities by its encodings or, where the solver has them, by its own constraints."""
    with clauses_of(problem, solver) as (clauses, _):
        return bool(clauses.solve())


@contextmanager
def clauses_of(problem: Problem, solver: str) -> Iterator[tuple[Any, list[list[int]]]]:
    """A solver of python-sat that has a problem as clauses, and the literals that say who plays which role."""
    from pysat.card import CardEnc, EncType
    from pysat.solvers import Solver

    top = 0

    def new() -> int:
        nonlocal top
        top += 1
        return top

    plays = [[new() for _ in candidates] for candidates in problem.candidates]
    needs = list(_needs(problem, plays))
    values = list(_values(problem, plays, new))
    with Solver(name=solver) as clauses:
        for needing, givers in needs:
            fed = new()
            clauses.add_clause([*givers, -fed])
            for literal in needing:
                clauses.add_clause([-literal, fed])
        groups = [
            *((literals, role.minimum, True) for role, literals in zip(problem.roles, plays, strict=True)),
            *((same, 1, False) for same in _shared(problem, plays)),
        ]
        for domain, some in values:
            groups.append((domain, 1, True))
            for literal, mask in some:
                clauses.add_clause([-literal, *(domain[k] for k in _bits(mask))])
        for literals, number, exactly in groups:
            for some_literals, most in _bounds(literals, number, exactly):
                if clauses.supports_atmost():
                    clauses.add_atmost(some_literals, most)
                    continue
                encoded = CardEnc.atmost(some_literals, most, top_id=top, encoding=EncType.seqcounter)
                top = max(top, encoded.nv)
                clauses.append_formula(encoded.clauses)
            if exactly and number == 1:
                clauses.add_clause(literals)
        yield clauses, plays


def _bounds(literals: list[int], number: int, exactly: bool) -> Iterator[tuple[list[int], int]]:
    """At most so many of which literals hold, where a number of some hold; one at least is a clause of its own."""
    if number < len(literals):
        yield literals, number
    if exactly and number != 1:
        yield [-literal for literal in literals], len(literals) - number


def _shared(problem: Problem, plays: list[list[L]]) -> list[list[L]]:
    """The literals of components that are candidates for several roles."""
    by_name: dict[str, list[L]] = {}
    for candidates, literals in zip(problem.candidates, plays, strict=True):
        for candidate, literal in zip(candidates, literals, strict=True):
            by_name.setdefault(candidate.profile.component, []).append(literal)
    return [same for same in by_name.values() if len(same) > 1]


def _needs(problem: Problem, plays: list[list[L]]) -> Iterator[tuple[list[L], list[L]]]:
    """For each role, signal and set of links that may feed it: who needs it there, and who gives it."""
    gives: list[dict[tuple[str, str | None], list[L]]] = [{} for _ in plays]
    named = {(source, output) for links in problem.links for source, output, _ in links if output is not None}
    for role, candidates in enumerate(problem.candidates):
        for candidate, literal in zip(candidates, plays[role], strict=True):
            for name, signals, *_ in candidate.profile.outputs:
                gives[role].setdefault((signals[0], None), []).append(literal)
                if named and (role, name) in named:
                    gives[role].setdefault((signals[0], name), []).append(literal)
    for role, candidates in enumerate(problem.candidates):
        needing: dict[tuple[str, Sources], list[L]] = {}
        for candidate, literal in zip(candidates, plays[role], strict=True):
            for wanted in candidate.profile.inputs:
                needing.setdefault((wanted.signals[0], problem.feeding(role, wanted.name)), []).append(literal)
        for (signal, sources), some in needing.items():
            yield some, [g for source, output, _ in sources for g in gives[source].get((signal, output), ())]


def _values(
    problem: Problem, plays: list[list[L]], new: Callable[[], L]
) -> Iterator[tuple[list[L], list[tuple[L, int]]]]:
    """For each variable a literal per value, and who allows which."""
    for number, variable in enumerate(problem.variables):
        yield (
            [new() for _ in variable.domain],
            [
                (literal, candidate.admits[number])
                for candidates, literals in zip(problem.candidates, plays, strict=True)
                for candidate, literal in zip(candidates, literals, strict=True)
                if candidate.admits[number] >= 0
            ],
        )


ENGINES: dict[str, Callable[[Problem], bool]] = {
    "selfconf": selfconf,
    "clingo": clingo,
    "CP-SAT": cp_sat,
    "python-sat": python_sat,
    "CaDiCaL": partial(python_sat, solver="cadical195"),
    "MiniCard": partial(python_sat, solver="minicard"),
    "Oxigraph": sparql.oxigraph,
    "rdflib": sparql.rdflib_graph,
    "Algorithm 1": algorithm_1,
}
LIBRARIES = {
    "selfconf": "pysat.solvers",
    "clingo": "clingo",
    "CP-SAT": "ortools.sat.python.cp_model",
    "python-sat": "pysat.solvers",
    "CaDiCaL": "pysat.solvers",
    "MiniCard": "pysat.solvers",
}
"""What an engine imports, before its time begins."""
GENERAL = ("clingo", "CP-SAT", "python-sat", "CaDiCaL", "MiniCard")
"""The general solvers."""
SMALL = {"Oxigraph": 100, "rdflib": 10, "Algorithm 1": 10}
"""Up to which size an engine is tried that is hopeless beyond."""


def installed() -> list[str]:
    """The engines whose libraries are there, and now imported."""
    found = [engine for engine in ENGINES if find_spec(LIBRARIES.get(engine, "selfconf").partition(".")[0])]
    for engine in found:
        import_module(LIBRARIES.get(engine, "selfconf"))
    return found
