"""What would make a refused task possible: small changes, each of which was tried and found to work.

*Components to add.* A component without inputs that issues whatever the roles fed by its own want is the most helpful
that could be added for a role. Wherever there is no solution, an irreducible set of requirements cannot hold; only a
component for one of its roles, or for a role that may feed one of its inputs, changes that. So breadth-first search
over sets of such additions, each extended by these roles alone, finds the fewest; then outputs are taken away again
one by one, as long as there is a solution without them.

*Things to change.* A role that asks for fewer, or for one where it asked for nobody and others need what it would
issue; one interaction more, where some candidate issues what is lacking; a near miss let in. Each alone.

All this is tried on the kernel of the problem (`kernel`): adding, relaxing and linking leave its argument intact,
since candidates of one kind have the same ports; near misses, who may become eligible for more, are set apart in it. A
role that asks for nobody is not in the kernel, and is asked for one in the whole problem. The number of trials and of
their steps is limited, so that a hard case may end with fewer repairs than there are, never with a wrong one.
"""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace

from selfconf.model.partition import ANY_VALUE, Candidate, NearMiss, Partition
from selfconf.model.profile import Output, Ports, Profile
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.relaxation import (
    AcceptNearMiss,
    AddComponents,
    AddInteraction,
    Addition,
    AskForFewer,
    AskForOne,
    Relaxation,
)
from selfconf.model.requirement import InputFed, RolePlayed
from selfconf.model.template import Interaction, Role
from selfconf.model.term import IRI
from selfconf.search.budget import Budget
from selfconf.search.explain import Questions, core
from selfconf.search.problem import Problem
from selfconf.search.reduction import Fed, LazyReduction, Played, reduced
from selfconf.search.strategies import possible, solution

TRIALS = 24
"""How many changed problems are looked at for each sort of repair."""
NEAR = 8
"""How many near misses are tried: no more than there is room for on a screen."""
RELAXED = 8
"""How many roles of a conflict are tried with a smaller count; where more clash, that is no advice."""
ADDED = 200
"""How many components are asked for at most; who lacks more has asked for too many."""
ADDITION = "urn:selfconf:addition:"
"""What the names of components begin with that are not there yet."""
TRIAL_STEPS = 100_000
"""Steps for each of them."""
RELAXATION_STEPS = 1_000_000
"""Steps for all of them together."""
Near = Sequence[tuple[NearMiss, Candidate]]


def with_relaxations(problem: Problem, refused: Refusal, near: Near = (), steps: int | None = None) -> Refusal:
    """The refusal with repairs; `near` are near misses with what they would be as candidates."""
    return replace(refused, repairs=tuple(relaxations(problem, refused, near, steps)))


def relaxations(problem: Problem, refused: Refusal, near: Near = (), steps: int | None = None) -> Iterator[Relaxation]:
    """Changes that make a refused problem possible, what is easiest to do first."""
    budget, near = Budget(RELAXATION_STEPS if steps is None else min(steps, RELAXATION_STEPS)), near[:NEAR]
    small = _small(problem, {one.component for one, _ in near})
    yield from (a for a in itertools.starmap(AcceptNearMiss, near) if _possible(relaxed_by(small, a), budget))
    yield from (r for r in _asked_for_one(problem, refused) if _possible(relaxed_by(problem, r), budget))
    added = _additions(small, budget)
    if added is not None:
        yield added
    yield from (r for r in _interactions(small, refused) if _possible(relaxed_by(small, r), budget))
    yield from _fewer(small, refused, budget)


def relaxed_by(problem: Problem, repair: Relaxation) -> Problem:
    """The problem after a repair."""
    if isinstance(repair, AddComponents):
        more: dict[IRI, list[Candidate]] = {}
        for addition in repair.additions:
            some = more.setdefault(addition.role, [])
            some += [_newcomer(problem, addition.role, len(some) + k, addition.outputs) for k in range(addition.count)]
        return _with_candidates(problem, more)
    if isinstance(repair, AcceptNearMiss):
        return _with_candidates(problem, {repair.role: [repair.candidate]})
    template = problem.task.template
    if isinstance(repair, AddInteraction):
        interactions = (*template.interactions, Interaction(repair.role, repair.sink))
        template = replace(template, interactions=interactions)
    else:
        roles = tuple(
            replace(role, minimum=repair.minimum) if role.iri == repair.role else role for role in template.roles
        )
        template = replace(template, roles=roles)
    return Problem(replace(problem.task, template=template), problem.partition, problem.hierarchy)


def _solution(problem: Problem, budget: Budget) -> list[list[Candidate]] | Undecided | None:
    with budget.portion(TRIAL_STEPS + sum(map(len, problem.candidates))) as part:
        return solution(LazyReduction(problem), part)


def _possible(problem: Problem, budget: Budget) -> bool:
    with budget.portion(TRIAL_STEPS + sum(map(len, problem.candidates))) as part:
        return possible(problem, part)


def _small(problem: Problem, apart: Collection[IRI]) -> Problem:
    """The problem with only the candidates of its kernel."""
    kept = reduced(problem, apart).options
    candidates = tuple(
        tuple(candidates[option.number] for option in options)
        for candidates, options in zip(problem.candidates, kept, strict=True)
    )
    return Problem(problem.task, Partition(candidates, problem.variables), problem.hierarchy)


def _with_candidates(problem: Problem, more: dict[IRI, list[Candidate]]) -> Problem:
    candidates = tuple(
        (*known, *more.get(role.iri, ())) for role, known in zip(problem.roles, problem.candidates, strict=True)
    )
    return Problem(problem.task, Partition(candidates, problem.variables), problem.hierarchy)


def _newcomer(problem: Problem, role: IRI, number: int, outputs: tuple[Output, ...]) -> Candidate:
    name = IRI(f"{ADDITION}{number}:{role}")
    return Candidate(Profile(name, ports=Ports(outputs=outputs)), tuple(ANY_VALUE for _ in problem.variables))


def _additions(problem: Problem, budget: Budget) -> AddComponents | None:
    """The fewest components to add, if a few are enough."""
    if any(role.maximum is not None and role.maximum < role.minimum for role in problem.roles):
        return None
    lacking: Counter[int] = Counter()
    for number, (role, candidates) in enumerate(zip(problem.roles, problem.candidates, strict=True)):
        lacking[number] = max(0, role.minimum - len(candidates))
    if sum(lacking.values()) > ADDED:
        return None
    outputs = [wanted_of(problem, role) for role in range(len(problem.roles))]
    waiting, seen = [+lacking], {frozenset((+lacking).items())}
    for trial in range(TRIALS):
        if trial >= len(waiting):
            return None
        here = waiting[trial]
        changed = relaxed_by(problem, _added(problem, here, outputs))
        playing = _solution(changed, budget) if here else None
        if isinstance(playing, list):
            return _trimmed(problem, here, outputs, playing, budget)
        if playing is not None:
            return None
        for number in _helpful(changed, budget):
            further = here + Counter({number: 1})
            if frozenset(further.items()) not in seen:
                seen.add(frozenset(further.items()))
                waiting.append(further)
    return None


def wanted_of(problem: Problem, role: int) -> tuple[Output, ...]:
    """All that the roles fed by a role could want of it."""
    wanted: dict[Output, None] = {}
    for sink in problem.sinks[role]:
        for link in problem.links[sink]:
            if link.source == role:
                for candidate in problem.candidates[sink]:
                    for port in candidate.profile.inputs:
                        if link.input in (None, port.name):
                            wanted[Output(link.output or port.signal.short, port.signal)] = None
    return tuple(wanted)


def _helpful(problem: Problem, budget: Budget) -> list[int]:
    """The roles for which one more component could resolve the conflict that there is."""
    given = reduced(problem)
    if given.short() is not None:
        return []
    with budget.portion(TRIAL_STEPS) as part:
        together = core(Questions(given, part))
    sources = [s for r in together if isinstance(r, Fed) for s, _ in given.needs[r.need].sources]
    played = set(given.slots)
    # What feeds comes first: a component that needs no inputs where others do is the less likely one to be had.
    found = dict.fromkeys((*sources, *(r.role for r in together if isinstance(r, Played))))
    return [role for role in found if role in played]


def _added(problem: Problem, here: Counter[int], outputs: Sequence[tuple[Output, ...]]) -> AddComponents:
    return AddComponents(tuple(Addition(problem.roles[role].iri, here[role], outputs[role]) for role in sorted(here)))


def _trimmed(
    problem: Problem,
    here: Counter[int],
    outputs: Sequence[tuple[Output, ...]],
    playing: list[list[Candidate]],
    budget: Budget,
) -> AddComponents:
    """The same additions with only the outputs without which there is no solution; `playing` is one with them all."""
    left = list(outputs)
    for role in sorted(here):
        for output in outputs[role]:
            fewer = tuple(one for one in left[role] if one != output)
            # All that is added for the role changes alike, so that one addition can stand for them all.
            changed = [*playing[:role], [_without(c, fewer) for c in playing[role]], *playing[role + 1 :]]
            if not all(
                problem.compatible(sink, c.profile, changed) for sink in problem.sinks[role] for c in changed[sink]
            ):
                asked = _added(problem, here, [*left[:role], fewer, *left[role + 1 :]])
                found = _solution(relaxed_by(problem, asked), budget)
                if not isinstance(found, list):
                    continue
                changed = found
            left[role], playing = fewer, changed
    return _added(problem, here, left)


def _without(candidate: Candidate, outputs: tuple[Output, ...]) -> Candidate:
    if not candidate.profile.component.startswith(ADDITION):
        return candidate
    return replace(candidate, profile=replace(candidate.profile, ports=Ports(candidate.profile.inputs, outputs)))


def _lacking(refused: Refusal) -> list[InputFed]:
    """The inputs of which the reasons say that nobody feeds them."""
    return [r for reason in refused.reasons for r in reason.requirements if isinstance(r, InputFed)]


def _asked_for_one(problem: Problem, refused: Refusal) -> Iterator[AskForOne]:
    """The roles that could feed what is lacking but ask for nobody."""
    index = {role.iri: number for number, role in enumerate(problem.roles)}
    sources = dict.fromkeys(source for need in _lacking(refused) for source in problem.sources[index[need.role]])
    for role in [problem.roles[source] for source in sources][:TRIALS]:
        if role.minimum == 0 and role.maximum != 0:
            yield AskForOne(role.iri)


def _interactions(problem: Problem, refused: Refusal) -> Iterator[AddInteraction]:
    """Links that are not there, from roles with a candidate that issues a signal which is lacking."""
    index = {role.iri: number for number, role in enumerate(problem.roles)}
    tried: set[tuple[IRI, IRI]] = set()
    for need in _lacking(refused):
        for number, role in enumerate(problem.roles):
            pair = role.iri, need.role
            known = any(
                link.source == number and link.output is None and link.input is None
                for link in problem.links[index[need.role]]
            )
            issues = any(
                problem.hierarchy.matches(output.signal, need.signal)
                for candidate in problem.candidates[number]
                for output in candidate.profile.outputs
            )
            if issues and not known and pair not in tried and len(tried) < TRIALS:
                tried.add(pair)
                yield AddInteraction(*pair)


def _fewer(problem: Problem, refused: Refusal, budget: Budget) -> Iterator[AskForFewer]:
    """For each role of the conflict the most that it can ask for."""
    named = [r.role for reason in refused.reasons for r in reason.requirements if isinstance(r, RolePlayed)]
    for iri in list(dict.fromkeys(named))[:RELAXED]:
        role: Role = problem.task.template.role(iri)
        enough = min(role.minimum, 1 + len(problem.candidates[problem.roles.index(role)]))
        for minimum in reversed(range(max(0, enough - TRIALS), enough)):
            repair = AskForFewer(iri, minimum)
            if _possible(relaxed_by(problem, repair), budget):
                yield repair
                break
