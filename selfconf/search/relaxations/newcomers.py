"""Components that are yet to be added, as candidates, and the values of free parameters that they have to suit.

A component that states no value of a parameter suits any, and a trial supposes that of one that does not exist yet,
unless the shape of its role asks for a value. But one that is made for a role whose shape mentions the parameter will
mostly state one. Where what else plays leaves a few values, it should be one of these, if the shape permits that, and
none otherwise. Where any are left, several such components have to share one. For the latter a parameter that no
component states a value of has to be a variable as well, and so have all values that shapes list.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence, Set

from selfconf.model.immutable import replace
from selfconf.model.partition import ANY_VALUE, Candidate, Mention, Variable
from selfconf.model.profile import Ports, Profile
from selfconf.model.relaxation import AddComponents, Addition
from selfconf.model.term import IRI, Term, sort_key
from selfconf.search.problem import Problem
from selfconf.search.relaxations.supposed_outputs import supposed

ADDITION = "urn:selfconf:addition:"
"""What the names of added components begin with, which do not exist yet."""


def newcomer(problem: Problem, addition: Addition, number: int) -> Candidate:
    """Return one of the components to be added, under a name with some number.

    It admits the values that the addition names, or what any component for the role may admit.
    """
    names = {parameter.iri: parameter.name for parameter in problem.task.template.parameters}
    named = dict(addition.values)
    role = _index(problem)[addition.role]
    admits = []
    for variable in problem.variables:
        mention, name = _mention(problem, role, variable), names[variable.parameter]
        if name in named:
            value = named[name]
            admits.append(ANY_VALUE if value is None else 1 << variable.domain.index(value))
        else:
            admits.append(_statable(mention, variable) if mention is not None and mention.required else ANY_VALUE)
    ports = Ports(outputs=supposed(addition.outputs))
    return Candidate(Profile(IRI.unchecked(f"{ADDITION}{number}:{addition.role}"), ports=ports), tuple(admits))


def impossible(problem: Problem) -> set[int]:
    """Return the roles, by number, for which no component can be added that would be eligible."""
    found = set(problem.partition.unaddable)
    for role, variable in itertools.product(range(len(problem.roles)), problem.variables):
        mention = _mention(problem, role, variable)
        if mention is not None and mention.required and not _statable(mention, variable):
            found.add(role)
    return found


def with_mentioned_variables(problem: Problem) -> Problem:
    """Return a problem in which every free parameter that a shape mentions is a variable, stated or not.

    All values that shapes list for it are in its domain. But what roles also set something to keeps the values that are
    stated, and has to have one; and what lists its values itself has all of them already.
    """
    fixed = {parameter.iri for parameter in problem.task.template.parameters if parameter.is_set}
    fixed |= {variable.parameter for variable in problem.variables if variable.listed}
    listed: dict[IRI, set[Term]] = {}
    for mention in itertools.chain(*problem.partition.mentions):
        if mention.parameter not in fixed:
            listed.setdefault(mention.parameter, set()).update(mention.only or ())
    return _with_values_in_domains(problem, listed)


def with_stated_values(problem: Problem, stated: Mapping[IRI, Set[Term]]) -> Problem:
    """Return a problem in which roles may be set to what a further component states for their free parameters.

    The same one where it states no value for them that no other component does.
    """
    listed = {variable.parameter for variable in problem.variables if variable.listed}
    is_set = {parameter.iri for parameter in problem.task.template.parameters if parameter.is_set} - listed
    return _with_values_in_domains(problem, {one: {*stated[one]} for one in is_set & stated.keys() if stated[one]})


def _with_values_in_domains(problem: Problem, values: dict[IRI, set[Term]]) -> Problem:
    """Return a problem in which parameters are variables that may have some values besides; the same one if they do."""
    variables = [_wider(one, values.pop(one.parameter, set())) for one in problem.variables]
    more = [Variable(parameter, tuple(sorted(values[parameter], key=sort_key))) for parameter in sorted(values)]
    if not more and tuple(variables) == problem.variables:
        return problem
    any_ = (ANY_VALUE,) * len(more)
    candidates = tuple(tuple(replace(c, admits=(*c.admits, *any_)) for c in some) for some in problem.candidates)
    partition = replace(problem.partition, candidates=candidates, variables=(*variables, *more))
    return Problem(problem.task, partition, problem.hierarchy)


def without_values(asked: AddComponents) -> AddComponents:
    """Return additions of which no values of parameters are known."""
    return replace(asked, additions=tuple(replace(one, values=(), shared=()) for one in asked.additions), shared=())


def with_values(problem: Problem, asked: AddComponents, playing: Sequence[Sequence[Candidate]]) -> AddComponents:
    """Return additions with the values of free parameters that all that plays leaves them, where that matters.

    It matters to components for a role whose shape mentions the parameter.
    """
    names = {parameter.iri: parameter.name for parameter in problem.task.template.parameters}
    index = _index(problem)
    values: list[dict[str, Term | None]] = [{} for _ in asked.additions]
    shared: dict[str, list[int]] = {}
    for variable, left in zip(problem.variables, _left(problem, playing), strict=True):
        name, stating = names[variable.parameter], []
        for number, one in enumerate(asked.additions):
            mention = _mention(problem, index[one.role], variable)
            if mention is None:
                continue
            if not left & _statable(mention, variable):
                values[number][name] = None
                continue
            left &= _statable(mention, variable)
            stating.append(number)
        value = variable.first(left)
        if value is not None:
            for number in stating:
                values[number][name] = value
        elif sum(asked.additions[number].count for number in stating) > 1:
            shared[name] = stating
    additions = tuple(
        replace(
            one,
            values=tuple(values[number].items()),
            shared=tuple(name for name, stating in shared.items() if number in stating),
        )
        for number, one in enumerate(asked.additions)
    )
    return replace(asked, additions=additions, shared=tuple(shared))


def _index(problem: Problem) -> dict[IRI, int]:
    return {role.iri: number for number, role in enumerate(problem.roles)}


def _wider(variable: Variable, values: set[Term]) -> Variable:
    """Return a variable with further values behind those of its domain, so that masks of candidates stay right."""
    return replace(variable, domain=(*variable.domain, *sorted(values.difference(variable.domain), key=sort_key)))


def _left(problem: Problem, playing: Sequence[Sequence[Candidate]]) -> Iterator[int]:
    """Yield for each variable the values that all that plays leaves it, as a mask; those in the domain, if any."""
    left = list(problem.open_values)
    for candidate in itertools.chain(*playing):
        left = [value & allowed for value, allowed in zip(left, candidate.admits, strict=True)]
    for variable, mask in zip(problem.variables, left, strict=True):
        known = mask & ((1 << len(variable.domain)) - 1)
        # What plays forbids some values: of the others one that is stated somewhere is the least surprise.
        yield known if mask != ANY_VALUE and known else mask


def _mention(problem: Problem, role: int, variable: Variable) -> Mention | None:
    """Return what the shape of a role says of a variable, if it mentions it."""
    mentioned = problem.partition.mentioned(role)
    return next((mention for mention in mentioned if mention.parameter == variable.parameter), None)


def _statable(mention: Mention, variable: Variable) -> int:
    """Return the values that a component may state for a variable, as a mask."""
    if mention.only is None:
        return ANY_VALUE & ~sum(1 << bit for bit, value in enumerate(variable.domain) if value in mention.never)
    return sum(1 << bit for bit, value in enumerate(variable.domain) if value in mention.only - mention.never)
