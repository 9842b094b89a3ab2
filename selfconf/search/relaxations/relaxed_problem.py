"""The problem as it is after a relaxation."""

from __future__ import annotations

from selfconf.model.immutable import replace
from selfconf.model.partition import ANY_VALUE, Candidate, NearMiss
from selfconf.model.relaxation import AcceptNearMiss, AddComponents, AddInteraction, AddRecruits, LetRecruit, Relaxation
from selfconf.model.template import Interaction
from selfconf.model.term import IRI
from selfconf.search.problem import Problem
from selfconf.search.relaxations.newcomers import newcomer, with_mentioned_variables, with_stated_values
from selfconf.search.relaxations.recruits_to_add import with_more_recruits


def relaxed_by(problem: Problem, relaxation: Relaxation) -> Problem:
    """Return the problem after a relaxation."""
    if isinstance(relaxation, AddRecruits):
        return with_more_recruits(problem, relaxation)
    if isinstance(relaxation, AddComponents):
        problem = with_mentioned_variables(problem)
        more: dict[IRI, list[Candidate]] = {}
        for addition in relaxation.additions:
            some = more.setdefault(addition.role, [])
            some += [newcomer(problem, addition, len(some) + k) for k in range(addition.count)]
        return _with_candidates(problem, more)
    if isinstance(relaxation, AcceptNearMiss):
        return _with_near_miss(problem, relaxation.near, relaxation.candidate)
    template = problem.task.template
    if isinstance(relaxation, AddInteraction):
        interactions = (*template.interactions, Interaction(relaxation.role, relaxation.sink))
        template = replace(template, interactions=interactions)
    else:
        # Who may be recruited is for the partition to know, which is not changed here.
        changed = {"recruits": True} if isinstance(relaxation, LetRecruit) else {"minimum": relaxation.minimum}
        roles = tuple(replace(role, **changed) if role.iri == relaxation.role else role for role in template.roles)
        template = replace(template, roles=roles)
    return Problem(replace(problem.task, template=template), problem.partition, problem.hierarchy)


def _with_near_miss(problem: Problem, near: NearMiss, candidate: Candidate) -> Problem:
    """Return the problem with a near miss as a candidate, and with the values that it alone states for what is set."""
    changed = with_stated_values(problem, near.allows)
    if changed is not problem:
        admits = []
        for variable in changed.variables:
            allowed = near.allows.get(variable.parameter)
            stated = sum(1 << bit for bit, value in enumerate(variable.domain) if allowed and value in allowed)
            admits.append(ANY_VALUE if allowed is None else stated)
        candidate = replace(candidate, admits=tuple(admits))
    return _with_candidates(changed, {near.role: [candidate]})


def _with_candidates(problem: Problem, more: dict[IRI, list[Candidate]]) -> Problem:
    candidates = tuple(
        (*known, *more.get(role.iri, ())) for role, known in zip(problem.roles, problem.candidates, strict=True)
    )
    return Problem(problem.task, replace(problem.partition, candidates=candidates), problem.hierarchy)
