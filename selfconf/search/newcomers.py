"""Components that are yet to be added, as candidates, and the values of free parameters that they have to suit.

A component that does not exist yet suits any value of a parameter; but one that is made for a role whose shape mentions
the parameter will state one. Where what else plays leaves a few values, one of these is what it should state. Where it
leaves any, several such components have to share one. For the latter a parameter that nobody has stated a value for has
to be a variable as well.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import replace

from selfconf.model.partition import ANY_VALUE, Candidate, Variable
from selfconf.model.profile import Output, Ports, Profile
from selfconf.model.relaxation import AddComponents, Addition
from selfconf.model.term import IRI, Term
from selfconf.search.problem import Problem
from selfconf.search.supposed_outputs import supposed

ADDITION = "urn:selfconf:addition:"
"""What the names of added components begin with, which do not exist yet."""


def newcomer(problem: Problem, role: IRI, number: int, outputs: Sequence[Output]) -> Candidate:
    """Return a component to be added for a role, the one of some number, which issues some outputs."""
    ports = Ports(outputs=supposed(outputs))
    return Candidate(Profile(IRI(f"{ADDITION}{number}:{role}"), ports=ports), (ANY_VALUE,) * len(problem.variables))


def with_mentioned_variables(problem: Problem) -> Problem:
    """Return a problem in which each free parameter that a shape mentions is a variable, though nobody states a value.

    But for those that roles set something to, which without a value leave a role without components.
    """
    known = {variable.parameter for variable in problem.variables}
    set_ = {parameter.iri for parameter in problem.task.template.parameters if parameter.is_set}
    mentioned = {mention.parameter for mention in itertools.chain(*problem.partition.mentions)}
    missing = sorted(mentioned - known - set_)
    if not missing:
        return problem
    more = (ANY_VALUE,) * len(missing)
    candidates = tuple(tuple(replace(c, admits=(*c.admits, *more)) for c in some) for some in problem.candidates)
    variables = (*problem.variables, *(Variable(parameter, ()) for parameter in missing))
    partition = replace(problem.partition, candidates=candidates, variables=variables)
    return Problem(problem.task, partition, problem.hierarchy)


def with_values(problem: Problem, asked: AddComponents, playing: Sequence[Sequence[Candidate]]) -> AddComponents:
    """Return additions with the values of free parameters that all that plays leaves them, where that matters.

    It matters to components for a role whose shape mentions the parameter.
    """
    names = {parameter.iri: parameter.name for parameter in problem.task.template.parameters}
    index = {role.iri: number for number, role in enumerate(problem.roles)}
    values: list[dict[str, Term]] = [{} for _ in asked.additions]
    shared = []
    for variable, left in zip(problem.variables, _left(problem, playing), strict=True):
        name = names[variable.parameter]
        stating = [n for n, one in enumerate(asked.additions) if _mentions(problem, index[one.role], variable)]
        value = variable.first(left)
        if value is not None:
            for number in stating:
                values[number][name] = value
        elif sum(asked.additions[number].count for number in stating) > 1:
            shared.append(name)
    additions = tuple(_with(one, some) for one, some in zip(asked.additions, values, strict=True))
    return replace(asked, additions=additions, shared=tuple(shared))


def _with(addition: Addition, values: dict[str, Term]) -> Addition:
    return replace(addition, values=tuple(values.items()))


def _left(problem: Problem, playing: Sequence[Sequence[Candidate]]) -> Iterator[int]:
    """Yield for each variable the values that all that plays leaves it, as a mask; those in the domain, if any."""
    left = list(problem.open_values)
    for candidate in itertools.chain(*playing):
        left = [value & allowed for value, allowed in zip(left, candidate.admits, strict=True)]
    for variable, mask in zip(problem.variables, left, strict=True):
        known = mask & ((1 << len(variable.domain)) - 1)
        # What plays forbids some values: of the others one that is stated somewhere is the least surprise.
        yield known if mask != ANY_VALUE and known else mask


def _mentions(problem: Problem, role: int, variable: Variable) -> bool:
    return any(mention.parameter == variable.parameter for mention in problem.partition.mentioned(role))
