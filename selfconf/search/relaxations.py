"""Relaxations: changes that make a refused task possible, each of which was tried and found to work.

*Components to add.* A component without inputs that issues every signal that the roles fed by its own could need is the
most helpful that could be added for a role; an output that an interaction names has one signal, so that there may be a
choice of these. Wherever there is no solution, an irreducible set of constraints cannot
hold; only a component for one of its roles, or for a role that may feed one of its inputs, changes that. So
breadth-first search over sets of such additions, each extended by these roles alone, finds the fewest; then outputs are
taken away again one by one, as long as there is a solution without them. Where there are players, but none that have
recruits, one more component for any role may help. Recruits are added likewise (`recruits_to_add`).

*Things to change.* A role that asks for fewer, or for one where it asked for none and others need what it would
issue; one interaction more, where some candidate issues what is lacking; a near miss accepted. Each alone.

All this is tried on the reduced problem (`dominance`): adding, asking for fewer and linking leave its argument intact,
since candidates of one class have the same ports; near misses, which may become eligible for more, are distinguished in
it. A role that asks for none is not in the reduced problem, and is asked for one in the whole problem. The number of
trials, of their steps and of what is read to prepare them is limited (`_Effort`), so that a hard case may end with
fewer relaxations than there are, and says so, never with one that does not work.
"""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import replace

from selfconf.model.configuration import Configuration
from selfconf.model.partition import Candidate, NearMiss
from selfconf.model.profile import CALL_MARK, Input, Output, Ports, WantedSignal
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.relaxation import (
    AcceptNearMiss,
    AddComponents,
    AddInteraction,
    Addition,
    AddRecruits,
    AskForFewer,
    LetRecruit,
    Relaxation,
)
from selfconf.model.requirement import InputFed, RolePlayed
from selfconf.model.template import Interaction, Role
from selfconf.model.term import IRI
from selfconf.search.budget import Budget
from selfconf.search.engines import any_by_clauses, least_by_clauses
from selfconf.search.explain import READINGS, FeasibilityOracle, core
from selfconf.search.newcomers import (
    ADDITION,
    impossible,
    newcomer,
    with_mentioned_variables,
    with_values,
    without_values,
)
from selfconf.search.problem import Link, Problem
from selfconf.search.recruiting import first_recruited, possible_with_recruits
from selfconf.search.recruits_to_add import recruits_to_add, with_more_recruits
from selfconf.search.reduction import (
    Constraint,
    Fed,
    LazyReduction,
    Played,
    ReducedProblem,
    recruits_that_matter,
    reduced,
)
from selfconf.search.strategies import solution
from selfconf.search.supply import Issued
from selfconf.search.supposed_outputs import supposed

TRIALS = 24
"""How many changed problems are tried for each sort of relaxation."""
TRIAL_STEPS = 100_000
"""Steps for each trial."""
RELAXATION_STEPS = 200_000
"""Steps for all trials together, to read the ports and to write down the options of what is tried included."""
PORTS_PER_TRIAL_STEP = 4
"""How many ports are read for the price of a step."""
STEPS_PER_OPTION = 2
"""How many steps are paid for an option, each time that the options are written down."""
RECRUIT_TRIAL_STEPS = 5_000
"""Steps to find recruits after one of the changes."""
HELPFUL_STEPS = 10_000
"""Steps to find out whose help a conflict needs."""
CHOICES = 8
"""How many choices of outputs are tried for a role, where interactions name outputs."""
NEAR = 8
"""How many near misses are tried: no more than there is room for on a screen."""
MOST_ROLES = 8
"""How many roles of a conflict are tried with a smaller count; where more clash, that is no advice."""
MOST_ADDED = 200
"""How many components are asked for at most; a task that lacks more has asked for too many."""

NearMisses = Sequence[tuple[NearMiss, Candidate]]
"""Near misses, each with the candidate that it would be."""


def with_relaxations(
    problem: Problem, refused: Refusal, near_misses: NearMisses = (), steps: int | None = None
) -> Refusal:
    """Return a refusal with the relaxations that were found, within a number of steps."""
    effort = _Effort(steps)
    found = tuple(_relaxations(problem, refused, near_misses, effort))
    return replace(refused, repairs=found, repairs_stopped=effort.stopped)


def relaxations(
    problem: Problem, refused: Refusal, near_misses: NearMisses = (), steps: int | None = None
) -> Iterator[Relaxation]:
    """Yield changes that make a refused problem possible, those first that are easiest to make."""
    return _relaxations(problem, refused, near_misses, _Effort(steps))


class _Effort:
    """What may still be spent on all that is tried for a refusal."""

    def __init__(self, steps: int | None) -> None:
        self.budget = Budget(RELAXATION_STEPS if steps is None else min(steps, RELAXATION_STEPS))
        """The steps of all searches."""
        self.readings = Budget(READINGS)
        """The needs and supports that may be read to find out whose help a conflict needs."""
        self.stopped = False
        """Whether something was not tried, or not to its end, because too little was left."""

    def used_up(self) -> bool:
        """Return whether nothing is left; that something is not tried for this is noted."""
        over = not self.budget.steps or not self.readings.steps
        self.stopped = self.stopped or over
        return over

    def solution(self, given: LazyReduction, least: bool = True) -> list[list[Candidate]] | Undecided | None:
        """Return a solution of a changed problem, None if there is none, or Undecided if too little is left."""
        options = sum(map(len, given.problem.candidates))
        self.budget.spend(_ports(given.problem) // PORTS_PER_TRIAL_STEP + STEPS_PER_OPTION * options)
        if self.used_up():
            return Undecided(0)
        with self.budget.portion(TRIAL_STEPS + options) as part:
            found = solution(given, part, least_by_clauses if least else any_by_clauses)
        self.stopped = self.stopped or isinstance(found, Undecided)
        return found

    def possible(self, problem: Problem) -> bool:
        """Return whether a solution of a changed problem is found, be it the first one or another."""
        return isinstance(self.solution(LazyReduction(problem), least=False), list)

    def core(self, given: ReducedProblem) -> tuple[Constraint, ...]:
        """Return constraints that cannot hold together; none if too little is left to find any."""
        self.budget.spend(STEPS_PER_OPTION * sum(map(len, given.options)))
        if self.used_up():
            return ()
        with self.budget.portion(HELPFUL_STEPS) as part:
            return core(FeasibilityOracle(given, part, self.readings))

    def recruits_found(self, problem: Problem) -> bool:
        """Return whether some players have recruits, in a problem that has a solution if these are there at once."""
        if not any(role.recruits for role in problem.roles):
            return True
        supplying = sum(len(r.profile.inputs) + len(r.profile.outputs) for r in problem.supply.recruits)
        self.budget.spend((_ports(problem) + supplying) // PORTS_PER_TRIAL_STEP)
        return not self.used_up() and possible_with_recruits(problem, RECRUIT_TRIAL_STEPS)


def _relaxations(problem: Problem, refused: Refusal, near_misses: NearMisses, effort: _Effort) -> Iterator[Relaxation]:
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
        return relaxation if possible_with_recruits(changed, RECRUIT_TRIAL_STEPS) else None
    found = first_recruited(changed, RECRUIT_TRIAL_STEPS)
    if not isinstance(found, Configuration):
        return None
    playing = [
        [candidate for candidate in some if candidate.profile.component in one.components]
        for some, one in zip(changed.candidates, found.assignments, strict=True)
    ]
    return with_values(changed, relaxation, playing)


def _possible_relaxations(
    problem: Problem, refused: Refusal, near_misses: NearMisses, effort: _Effort
) -> Iterator[Relaxation]:
    """Yield changes that make a refused problem possible if all recruits were there at once."""
    near_misses = near_misses[:NEAR]
    matter = recruits_that_matter(problem) if problem.supply.recruits else ()
    recruitable = {problem.supply.recruits[number].component for number in matter}
    small = _reduced(problem, recruitable.union(miss.component for miss, _ in near_misses))

    def works(one: AddComponents) -> bool:
        """Whether an addition makes the task possible, once it would if all recruits were there at once."""
        return effort.recruits_found(relaxed_by(problem, one))

    def possible(one: Relaxation) -> bool:
        return effort.possible(relaxed_by(small, one))

    yield from filter(possible, itertools.starmap(AcceptNearMiss, near_misses))
    recruits = recruits_to_add(small, lambda one: possible(one) and works(one))
    added = _additions(small, effort, works)
    yield from (one for one in (recruits, added) if one is not None)
    yield from filter(possible, _interactions(small, refused))
    yield from _fewer(small, refused, effort)


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
        return _with_candidates(problem, {relaxation.role: [relaxation.candidate]})
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


def _ports(problem: Problem) -> int:
    """Return how many ports there are, which is what preparing a trial costs."""
    return sum(len(c.profile.inputs) + len(c.profile.outputs) for some in problem.candidates for c in some)


def _reduced(problem: Problem, distinguished: Collection[IRI]) -> Problem:
    """Return the problem with only the candidates that its reduction keeps."""
    kept = reduced(problem, distinguished).options
    candidates = tuple(
        tuple(candidates[option.number] for option in options)
        for candidates, options in zip(problem.candidates, kept, strict=True)
    )
    return Problem(problem.task, replace(problem.partition, candidates=candidates), problem.hierarchy)


def _with_candidates(problem: Problem, more: dict[IRI, list[Candidate]]) -> Problem:
    candidates = tuple(
        (*known, *more.get(role.iri, ())) for role, known in zip(problem.roles, problem.candidates, strict=True)
    )
    return Problem(problem.task, replace(problem.partition, candidates=candidates), problem.hierarchy)


Added = Counter[tuple[int, tuple[Output, ...]]]
"""How many components are added for each role and choice of outputs."""


Works = Callable[[AddComponents], bool]
"""Whether an addition works in the end, which is possible if all recruits are there at once."""


def _additions(problem: Problem, effort: _Effort, works: Works) -> AddComponents | None:
    """Return the fewest components to add, if a few are enough: breadth-first search over sets of additions."""
    problem = with_mentioned_variables(problem)
    lacking = _lacking(problem)
    if lacking is None:
        return None
    recruiting = any(role.recruits for role in problem.roles)
    choices = _choices(problem)
    waiting = _lacked(lacking, choices)
    seen = {frozenset[object](added.items()) for added in waiting}
    for added in itertools.islice(waiting, TRIALS):  # which grows meanwhile
        if effort.used_up():
            return None
        asked = _asked(problem, added)
        changed = LazyReduction(relaxed_by(problem, asked))
        playing = effort.solution(changed) if added or recruiting else None
        if isinstance(playing, Undecided):
            # What comes later in the queue may be possible, and would not be known to be the fewest.
            return None
        if playing is not None and added and works(asked):
            return _trimmed(problem, added, playing, effort, works)
        helpful = _helpful(changed.reduced, effort) if playing is None else _feeding_first(changed.problem)
        waiting += _with_one_more(added, [(role, outputs) for role in helpful for outputs in choices[role]], seen)
    return None


def _choices(problem: Problem) -> list[list[tuple[Output, ...]]]:
    """Return for each role the choices of outputs for a component to be added; none where none could be eligible."""
    closed = impossible(problem)
    return [[] if role in closed else wanted_of(problem, role) for role in range(len(problem.roles))]


def _with_one_more(
    added: Added, ones: Iterable[tuple[int, tuple[Output, ...]]], seen: set[frozenset[object]]
) -> Iterator[Added]:
    """Yield additions with one component more, given by its role and outputs, that were not seen, and note them."""
    for one in ones:
        further = added + Counter({one: 1})
        if frozenset(further.items()) not in seen:
            seen.add(frozenset(further.items()))
            yield further


def _lacked(lacking: Counter[int], choices: Sequence[Sequence[tuple[Output, ...]]]) -> list[Added]:
    """Return additions for what each role lacks by itself; all that are for one role issue the same."""
    ways = itertools.product(*([(role, outputs) for outputs in choices[role]] for role in lacking))
    return [Counter({one: lacking[one[0]] for one in chosen}) for chosen in itertools.islice(ways, TRIALS)]


def _lacking(problem: Problem) -> Counter[int] | None:
    """Return how many candidates each role lacks by itself, if adding as many could be advice at all."""
    if any(role.maximum is not None and role.maximum < role.minimum for role in problem.roles):
        return None
    pairs = zip(problem.roles, problem.candidates, strict=True)
    lacking = Counter({number: max(0, role.minimum - len(some)) for number, (role, some) in enumerate(pairs)})
    return +lacking if sum(lacking.values()) <= MOST_ADDED else None


def wanted_of(problem: Problem, role: int) -> list[tuple[Output, ...]]:
    """Return the choices of outputs for a component that could feed all that a role may have to feed.

    It issues each signal that the roles fed by it could need; but where an interaction names the output, that output
    has one signal only, so that there is a choice for each.
    """
    plain: dict[WantedSignal, None] = {}
    by_name: dict[str, dict[WantedSignal, None]] = {}
    for sink in problem.sinks[role]:
        for link in problem.links[sink]:
            if link.source == role:
                wanted = plain if link.output is None else by_name.setdefault(link.output, {})
                for candidate in problem.candidates[sink]:
                    wanted.update((port.wanted, None) for port in candidate.profile.required if _asks(link, port))
    names = set(by_name)
    others = []
    for one in plain:
        if not one.signals:
            continue  # nothing feeds it along an interaction that does not name it
        stem = name = one.signals[0].short
        number = 2
        while name in names:
            name, number = f"{stem}{number}", number + 1
        names.add(name)
        others.append(one.output(name))
    ways = itertools.product(*([one.output(name) for one in wanted] for name, wanted in by_name.items() if wanted))
    return [(*others, *chosen) for chosen in itertools.islice(ways, CHOICES)]


def _asks(link: Link, port: Input) -> bool:
    """Return whether an input could be fed along an interaction, by the names: no output feeds what calls, or back."""
    called = link.output is not None and link.output.endswith(CALL_MARK)
    return link.input in (None, port.name) and (link.output is None or called is port.is_operation)


def _helpful(given: ReducedProblem, effort: _Effort) -> list[int]:
    """Return the roles for which one more component could resolve the conflict that there is."""
    if given.wiped_out() is not None:
        return []
    together = effort.core(given)
    sources = [s.role for r in together if isinstance(r, Fed) for s in given.needs[r.need].sources]
    played = set(given.slots)
    # Roles that feed come first: of a role that others feed, a component without inputs is less likely to be had.
    found = dict.fromkeys((*sources, *(r.role for r in together if isinstance(r, Played))))
    return [role for role in found if role in played]


def _feeding_first(problem: Problem) -> list[int]:
    """Return the roles that ask for components, those first that feed others.

    Where players lack recruits alone, one more component for any role may leave another free to be recruited.
    """
    asked = [number for number, role in enumerate(problem.roles) if role.minimum]
    return sorted(asked, key=lambda number: not problem.sinks[number])


def _in_order(added: tuple[int, tuple[Output, ...]]) -> tuple[int, str]:
    """Return what additions are sorted by: the role, then the outputs, some of which say more than others."""
    return added[0], repr(added[1])


def _asked(problem: Problem, added: Added) -> AddComponents:
    """Return additions as a relaxation, those of a role and of equal outputs as one."""
    return AddComponents(
        tuple(
            Addition(problem.roles[role].iri, count, outputs, _named(problem, role) & {o.name for o in outputs})
            for (role, outputs), count in sorted(added.items(), key=lambda one: _in_order(one[0]))
        )
    )


def _named(problem: Problem, role: int) -> frozenset[str]:
    """Return the names by which interactions ask for outputs of a role."""
    links = (link for sink in problem.sinks[role] for link in problem.links[sink])
    return frozenset(link.output for link in links if link.source == role and link.output is not None)


def _trimmed(
    problem: Problem, added: Added, playing: list[list[Candidate]], effort: _Effort, works: Works
) -> AddComponents:
    """Return additions with only the outputs that are needed for a solution; `playing` is a solution with all."""
    for one in sorted(added, key=_in_order):
        role, left = one
        for output in one[1]:
            fewer = tuple(other for other in left if other != output)
            changed = [*playing[:role], [_without(c, left, fewer) for c in playing[role]], *playing[role + 1 :]]
            trial: Added = Counter()
            for (at, outputs), count in added.items():
                trial[at, fewer if (at, outputs) == (role, left) else outputs] += count
            if not all(
                problem.compatible(sink, c.profile, changed) for sink in problem.sinks[role] for c in changed[sink]
            ):
                found = effort.solution(LazyReduction(relaxed_by(problem, _asked(problem, trial))))
                if not isinstance(found, list):
                    continue
                changed = found
            if not works(_asked(problem, trial)):
                continue
            left, playing, added = fewer, changed, trial
    return with_values(problem, _asked(problem, added), playing)


def _without(candidate: Candidate, known: tuple[Output, ...], outputs: tuple[Output, ...]) -> Candidate:
    """Return a component that is added, and has the outputs that are known, with these instead; any other as it is."""
    profile = candidate.profile
    if not profile.component.startswith(ADDITION) or profile.outputs != supposed(known):
        return candidate
    return replace(candidate, profile=replace(profile, ports=Ports(profile.inputs, supposed(outputs))))


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
            if number in plain or pair in tried or len(tried) == TRIALS:
                continue
            if issued[number].serves(need.wanted):
                tried.add(pair)
                yield AddInteraction(*pair)


def _fewer(problem: Problem, refused: Refusal, effort: _Effort) -> Iterator[AskForFewer]:
    """Yield for each role of the conflict the largest number of components that it can ask for."""
    named = [r.role for reason in refused.reasons for r in reason.requirements if isinstance(r, RolePlayed)]
    recruits = any(role.recruits for role in problem.roles)  # of fewer players there may be none that have recruits
    for iri in list(dict.fromkeys(named))[:MOST_ROLES]:
        role: Role = problem.task.template.role(iri)
        # No role can ask for more than its candidates: the trials begin there, and not at a million.
        enough = min(role.minimum, 1 + len(problem.candidates[problem.roles.index(role)]))
        for minimum in reversed(range(max(0, enough - TRIALS), enough)):
            fewer = AskForFewer(iri, minimum)
            changed = relaxed_by(problem, fewer)
            if effort.possible(changed) and (not recruits or possible_with_recruits(changed, RECRUIT_TRIAL_STEPS)):
                yield fewer
                break
