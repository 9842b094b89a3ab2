"""Relaxations: changes that make a refused task possible, each of which was tried and found to work.

*Things to add.* The fewest components for roles (`components_to_add`), or recruits (`recruits_to_add`).

*Things to change.* A role that asks for fewer; one interaction more, where some candidate issues what is lacking; a
near miss accepted. Each alone.

All this is tried on the reduced problem (`dominance`): adding, asking for fewer and linking leave its argument intact,
since candidates of one class have the same ports; near misses, which may become eligible for more, are distinguished in
it. Optional roles may help after a change, as they do without one (`additions`), so that their candidates are kept.
What may be spent on all this is limited (`RelaxationEffort`).
"""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterable, Iterator

from selfconf.model.configuration import Configuration
from selfconf.model.immutable import replace
from selfconf.model.partition import Candidate, NearMiss
from selfconf.model.refusal import Refusal
from selfconf.model.relaxation import (
    AcceptNearMiss,
    AddComponents,
    AddInteraction,
    AddRecruits,
    AskForFewer,
    Relaxation,
)
from selfconf.model.requirement import InputFed, RolePlayed
from selfconf.model.template import Role
from selfconf.model.term import IRI
from selfconf.search.additions import asking_for_all, with_optional_slots
from selfconf.search.problem import Problem
from selfconf.search.recruiting import first_recruited
from selfconf.search.reduction import recruits_that_matter, reduced
from selfconf.search.relaxations.components_to_add import components_to_add
from selfconf.search.relaxations.newcomers import with_values, without_values
from selfconf.search.relaxations.recruits_to_add import recruits_to_add
from selfconf.search.relaxations.relaxation_effort import RECRUIT_TRIAL_STEPS, TRIALS, RelaxationEffort, has_recruits
from selfconf.search.relaxations.relaxed_problem import relaxed_by
from selfconf.search.supply import Issued

NEAR = 8
"""How many near misses are tried: no more than there is room for on a screen."""
MOST_ROLES = 8
"""How many roles of a conflict are tried with a smaller count; where more clash, that is no advice."""

NearMisses = Iterable[tuple[NearMiss, Candidate]]
"""Near misses, each with the candidate that it would be."""


def with_relaxations(
    problem: Problem, refused: Refusal, near_misses: NearMisses = (), steps: int | None = None
) -> Refusal:
    """Return a refusal with the relaxations that were found, within a number of steps."""
    effort = RelaxationEffort(steps)
    found = tuple(_relaxations(problem, refused, near_misses, effort))
    return replace(refused, repairs=found, repairs_stopped=effort.stopped)


def _relaxations(
    problem: Problem, refused: Refusal, near_misses: NearMisses, effort: RelaxationEffort
) -> Iterator[Relaxation]:
    """Yield changes that make a refused problem possible, those first that are easiest to make.

    The trials take it that whatever can be recruited is there at once; in the end a change counts only if some players
    have recruits then.
    """
    recruits = any(role.recruits for role in problem.roles)
    for one in _possible_relaxations(problem, refused, near_misses, effort):
        in_the_end = _with_recruits(problem, one) if recruits else one
        if in_the_end is not None:
            yield in_the_end


def _with_recruits(problem: Problem, relaxation: Relaxation) -> Relaxation | None:
    """Return a change as it has to be for players that have recruits; None if there are none."""
    changed = relaxed_by(problem, without_values(relaxation) if isinstance(relaxation, AddComponents) else relaxation)
    if isinstance(relaxation, AddRecruits) or not isinstance(relaxation, AddComponents) or not changed.variables:
        return relaxation if has_recruits(changed) else None
    found = first_recruited(changed, RECRUIT_TRIAL_STEPS) or first_recruited(
        with_optional_slots(changed), RECRUIT_TRIAL_STEPS
    )
    if not isinstance(found, Configuration):
        return None
    playing = [
        [candidate for candidate in some if candidate.profile.component in one.components]
        for some, one in zip(changed.candidates, found.assignments, strict=True)
    ]
    return with_values(changed, relaxation, playing)


def _possible_relaxations(
    problem: Problem, refused: Refusal, near_misses: NearMisses, effort: RelaxationEffort
) -> Iterator[Relaxation]:
    """Yield changes that make a refused problem possible if all recruits were there at once."""
    near_misses = list(effort.first_of(near_misses, NEAR))
    matter = recruits_that_matter(problem) if problem.supply.recruits else ()
    recruitable = {problem.supply.recruits[number].component for number in matter}
    small = _reduced(problem, recruitable.union(miss.component for miss, _ in near_misses))

    def works(one: AddComponents) -> bool:
        """Whether an addition makes the task possible, once it would if all recruits were there at once."""
        return effort.recruits_found(relaxed_by(problem, one))

    def possible(one: Relaxation) -> bool:
        return effort.possible(relaxed_by(small, one))

    yield from filter(possible, itertools.starmap(AcceptNearMiss, near_misses))
    recruits = recruits_to_add(small, effort, lambda one: possible(one) and works(one))
    added = components_to_add(small, effort, works)
    yield from (one for one in (recruits, added) if one is not None)
    interactions = effort.first_of(_interactions(small, refused), TRIALS)
    yield from filter(possible, interactions)
    yield from _fewer(small, refused, effort)


def _reduced(problem: Problem, distinguished: Collection[IRI]) -> Problem:
    """Return the problem with only the candidates that its reduction keeps."""
    kept = reduced(asking_for_all(problem), distinguished).options
    candidates = tuple(
        tuple(candidates[option.number] for option in options)
        for candidates, options in zip(problem.candidates, kept, strict=True)
    )
    return Problem(problem.task, replace(problem.partition, candidates=candidates), problem.hierarchy)


def _unfed(refused: Refusal) -> list[InputFed]:
    """Return the inputs of which the reasons say that no output feeds them."""
    return [r for reason in refused.reasons for r in reason.requirements if isinstance(r, InputFed)]


def _interactions(problem: Problem, refused: Refusal) -> Iterator[AddInteraction]:
    """Yield interactions that do not exist, from roles with a candidate that issues a signal which is lacking."""
    index = {role.iri: number for number, role in enumerate(problem.roles)}
    tried: set[tuple[IRI, IRI]] = set()
    issued = [Issued(problem.hierarchy) for _ in problem.roles]
    for candidates, some in zip(problem.candidates, issued, strict=True):
        for number, candidate in enumerate(candidates):
            some.add(number, candidate.profile.outputs)
    for need in _unfed(refused):
        # An interaction that names a port is another one than the plain one, which also feeds what that does not.
        plain = {link.source for link in problem.links[index[need.role]] if link.output is None and link.input is None}
        for number, role in enumerate(problem.roles):
            pair = role.iri, need.role
            if number in plain or pair in tried:
                continue
            if issued[number].serves(need.wanted):
                tried.add(pair)
                yield AddInteraction(*pair)


def _fewer(problem: Problem, refused: Refusal, effort: RelaxationEffort) -> Iterator[AskForFewer]:
    """Yield for each role of the conflict the largest number of components that it can ask for."""
    named = [r.role for reason in refused.reasons for r in reason.requirements if isinstance(r, RolePlayed)]
    recruits = any(role.recruits for role in problem.roles)  # of fewer players there may be none that have recruits
    for iri in effort.first_of(dict.fromkeys(named), MOST_ROLES):
        role: Role = problem.task.template.role(iri)
        # No role can ask for more than its candidates: the trials begin there, and not at a million.
        enough = min(role.minimum, 1 + len(problem.candidates[problem.roles.index(role)]))
        for minimum in effort.first_of(reversed(range(enough)), TRIALS):
            fewer = AskForFewer(iri, minimum)
            changed = relaxed_by(problem, fewer)
            if effort.possible(changed) and (not recruits or has_recruits(changed)):
                yield fewer
                break
