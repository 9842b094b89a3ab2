"""Why there are no recruits for any players: requirements that cannot hold together, none of which can be left out.

For a problem that would have a solution if all that could be recruited with some players were there at once
(`Problem.spared`), and has none, since what could be recruited has to play, or lacks what other players issue. The
solver of players and recruits has a guard for each constraint on players; what recruits need is always asked for.
"""

from __future__ import annotations

from collections.abc import Sequence

from selfconf.model import requirement as model
from selfconf.model.refusal import Conflict, Refusal
from selfconf.search.budget import Budget
from selfconf.search.engines import FoundedSolver, solver_available
from selfconf.search.problem import Problem
from selfconf.search.recruiting.recruiting import founded
from selfconf.search.reduction import Constraint, Distinct, Fed, Played, ReducedProblem, Shared, all_of, with_recruits

REFUSAL_STEPS = 50_000
"""Steps spent at most on making a reason irreducible."""


def refusal_of_recruits(problem: Problem, steps: int = REFUSAL_STEPS) -> Refusal:
    """Return the refusal of a problem whose players have no recruits."""
    template = problem.task.template.iri
    if not solver_available():
        roles = tuple(role.iri for role in problem.roles)
        conflict = Conflict(roles, requirements=tuple(map(model.RolePlayed, roles)))
        return Refusal(template, (conflict,), irreducible=False, smallest=False)
    given, budget = with_recruits(problem), Budget(steps)
    with founded(problem, given, guarded=True) as clauses:
        found = _core(clauses, [one for one in all_of(given) if one in clauses.guards], budget)
    return Refusal(template, (_conflict(problem, given, found),), irreducible=bool(budget.steps), smallest=False)


def _core(clauses: FoundedSolver, together: Sequence[Constraint], budget: Budget) -> Sequence[Constraint]:
    """Return some of the constraints that cannot hold together, but could without any one of them.

    Where the budget ends before, they may be more than that.
    """
    recruits = len(clauses.reduced.options) - 1
    always = [one for one in together if isinstance(one, Fed) and clauses.reduced.needs[one.need].role == recruits]
    left = [one for one in together if one not in always]
    # Roles are dropped last: readers think of these first.
    for one in sorted(left, key=lambda one: isinstance(one, Played)):
        fewer = [other for other in left if other != one]
        if one in left and clauses.solve([clauses.guards[c] for c in (*always, *fewer)], budget) is False:
            core = clauses.core()
            left = [other for other in fewer if clauses.guards[other] in core]
    return left


def _conflict(problem: Problem, given: ReducedProblem, found: Sequence[Constraint]) -> Conflict:
    """Return what cannot hold together in the words of the template."""
    names = {parameter.iri: parameter.name for parameter in problem.task.template.parameters}
    requirements: list[model.Requirement] = []
    for one in found:
        if isinstance(one, Played):
            requirements.append(model.RolePlayed(problem.roles[one.role].iri))
        elif isinstance(one, Fed):
            need = given.needs[one.need]
            requirements.append(model.InputFed(problem.roles[need.role].iri, need.wanted, need.input))
        elif isinstance(one, Shared):
            requirements.append(model.OneValue(names[problem.variables[one.variable].parameter]))
        else:
            assert isinstance(one, Distinct)
            requirements.append(model.OneRoleEach())
    roles = tuple(problem.roles[one.role].iri for one in found if isinstance(one, Played))
    parameters = tuple(one.parameter for one in requirements if isinstance(one, model.OneValue))
    return Conflict(roles or tuple(role.iri for role in problem.roles), parameters, tuple(requirements))
