"""Why there is no configuration: a derivation of irreducible reasons, cheapest first.

1. Roles that contradict themselves or have too few candidates, each a reason by itself. Nobody needs more than that.
2. Arc consistency runs a role out of candidates. The requirements that its derivation used, from that role back to
   the needs that nobody serves, cannot hold together.
3. Matching fails: Hall's set of roles.
4. Otherwise the clause-learning engine names assumptions that cannot hold together; without it, all requirements.

What 2 to 4 give is then made irreducible by QuickXplain (Junker, AAAI 2004): a question of the kind "can these hold
together?" for about k log(n / k) subsets, k being what remains of n. Each is decided on a problem with only these
requirements in force, which is small when they are few. Irreducible does not mean smallest.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from selfconf.model import refusal as model
from selfconf.model.refusal import (
    Conflict,
    Contradiction,
    InputUnfed,
    Reason,
    Refusal,
    Step,
    TooFewDistinct,
    TooFewEligible,
    Undecided,
    ValueUnknown,
)
from selfconf.model.term import IRI
from selfconf.search import sat
from selfconf.search.compact import Compact, Departure, compact, consistent
from selfconf.search.matching import shortage
from selfconf.search.problem import Problem
from selfconf.search.requirement import (
    Distinct,
    Fed,
    Played,
    Requirement,
    Shared,
    all_of,
    relaxed,
)
from selfconf.search.walk import Budget, walk

EFFORT = 1_000_000
"""Steps spent at most on making reasons irreducible."""
WALK_STEPS = 1000
"""Steps of depth-first search for one question before clauses are written."""


def reasons(problem: Problem, steps: int = EFFORT) -> tuple[tuple[Reason, ...], bool]:
    """The reasons of a problem that has no solution, and whether each is proved irreducible."""
    plain = tuple(_plain(problem))
    if plain:
        return plain, True
    given = compact(problem, prune=False)
    questions = Questions(given, Budget(steps))
    found = questions.irreducible(_start(problem, given, questions.budget))
    return (_worded(problem, given, found),), questions.settled


def _plain(problem: Problem) -> Iterator[Reason]:
    for role, candidates in zip(problem.roles, problem.candidates, strict=True):
        if role.maximum is not None and role.maximum < role.minimum:
            yield Contradiction(role.iri, role.minimum, role.maximum)
        elif len(candidates) < role.minimum:
            yield TooFewEligible(role.iri, role.minimum, len(candidates))
    for role_iri, parameter in problem.unvalued:
        yield ValueUnknown(role_iri, parameter)


class Questions:
    """Asks which requirements can hold together, within a budget."""

    def __init__(self, given: Compact, budget: Budget) -> None:
        self.given, self.budget = given, budget
        self.settled = True
        """False once a question was left open: then what remains may be reducible."""

    def possible(self, force: Iterable[Requirement]) -> bool | Undecided:
        """Whether these requirements can hold together."""
        wanted = set(force)
        distinct = Distinct() in wanted
        part = relaxed(self.given, wanted)
        if part.short() is not None:
            return False
        if distinct:
            required = {r.role for r in wanted if isinstance(r, Played)}
            slots = [role for role in part.slots if role in required]
            if shortage(slots, [[o.component for o in options] for options in part.options]):
                return False
        first = self.budget.part(WALK_STEPS) if sat.available() else self.budget
        found = walk(part, first, distinct)
        if isinstance(found, Undecided) and sat.available():
            with sat.Clauses(part, distinct=distinct) as clauses:
                return clauses.solve((), self.budget)
        return found if isinstance(found, Undecided) else found is not None

    def irreducible(self, together: Sequence[Requirement]) -> tuple[Requirement, ...]:
        """Of requirements that cannot hold together, as many as still cannot, but could without any one of them."""
        order = sorted(together, key=_KEEP_LAST)
        return tuple(sorted(self._explain((), order, False), key=order.index)) if order else ()

    def _explain(
        self, background: tuple[Requirement, ...], rest: Sequence[Requirement], changed: bool
    ) -> tuple[Requirement, ...]:
        if changed and self._impossible(background):
            return ()
        if len(rest) == 1:
            return tuple(rest)
        half = len(rest) // 2
        first, second = tuple(rest[:half]), tuple(rest[half:])
        of_second = self._explain((*background, *first), second, True)
        of_first = self._explain((*background, *of_second), first, bool(of_second))
        return (*of_first, *of_second)

    def _impossible(self, together: tuple[Requirement, ...]) -> bool:
        if not any(isinstance(r, Played) for r in together):
            return False
        answer = self.possible(together)
        if isinstance(answer, Undecided):
            self.settled = False
            return False
        return not answer


def _KEEP_LAST(requirement: Requirement) -> int:
    """QuickXplain drops what comes late: first roles, then needs, then what people think of last."""
    return [Played, Fed, Shared, Distinct].index(type(requirement))


def _start(problem: Problem, given: Compact, budget: Budget) -> tuple[Requirement, ...]:
    """Requirements that cannot hold together, as few as are found for little."""
    everything = all_of(given)
    played = list(dict.fromkeys(given.slots))
    kinds = list({id(o.kind): o.kind for options in given.options for o in options}.values())
    gone, departures = consistent(kinds, len(given.needs), given.values, played)
    for role in played:
        if sum(id(o.kind) not in gone for o in given.options[role]) < given.slots.count(role):
            return derivation(given, role, departures)
    lack = shortage(given.slots, [[o.component for o in options] for options in given.options])
    if lack is not None:
        return (*map(Played, lack.roles), Distinct())
    if not sat.available():
        return everything
    with sat.Clauses(given, guarded=True) as clauses:
        assumed = [clauses.guards[r] for r in everything if r in clauses.guards]
        while clauses.solve(assumed, budget) is False:
            core = clauses.core()
            if len(core) == len(assumed):
                break
            assumed = [guard for guard in assumed if guard in core]
        return tuple(r for r in everything if clauses.guards.get(r) in set(assumed))


def derivation(given: Compact, role: int, departures: Sequence[Departure]) -> tuple[Requirement, ...]:
    """The requirements by which arc consistency emptied a role."""
    before: dict[int, int] = {id(departure.kind): place for place, departure in enumerate(departures)}
    givers: dict[int, list[int]] = {}
    members: dict[int, list[int]] = {}
    for options in given.options:
        for kind in {id(o.kind): o.kind for o in options}.values():
            members.setdefault(kind.role, []).append(id(kind))
            for need in kind.gives:
                givers.setdefault(need, []).append(id(kind))
    found: dict[Requirement, None] = {Played(role): None}
    waiting = [before[kind] for kind in members.get(role, ()) if kind in before]
    seen: set[int] = set(waiting)
    while waiting:
        place = waiting.pop()
        departure = departures[place]
        if departure.need is not None:
            found[Fed(departure.need)] = None
            causes = givers.get(departure.need, [])
        else:
            found[Shared(departure.variable or 0)] = None
            found.update(dict.fromkeys(map(Played, dict.fromkeys(given.slots))))
            causes = [kind for some in members.values() for kind in some]
        for kind in causes:
            earlier = before.get(kind, place)
            if earlier < place and earlier not in seen:
                seen.add(earlier)
                waiting.append(earlier)
    return tuple(found)


def _worded(problem: Problem, given: Compact, found: Sequence[Requirement]) -> Reason:
    roles = tuple(problem.roles[r.role].iri for r in found if isinstance(r, Played))
    told = tuple(_told(problem, given, r) for r in found)
    needs = [r for r in found if isinstance(r, Fed)]
    shared = [r for r in found if isinstance(r, Shared)]
    if not needs and not shared and Distinct() in found:
        numbers = [r.role for r in found if isinstance(r, Played)]
        everybody = {o.component for role in numbers for o in given.options[role]}
        lack = shortage(
            [role for role in given.slots if role in numbers],
            [[c.profile.component for c in candidates] for candidates in problem.candidates],
        )
        found_number = len(everybody) if lack is None else lack.found
        return TooFewDistinct(roles, sum(problem.roles[r].minimum for r in numbers), found_number)
    if needs and not shared and Distinct() not in found:
        steps = list(_steps(problem, given, found))
        if steps:
            first = steps[0]
            return InputUnfed(
                first.role, first.component, first.input, first.signal, first.sources, told, tuple(steps[1:])
            )
    return Conflict(roles or tuple(role.iri for role in problem.roles), _parameters(told), told)


def _parameters(told: Iterable[model.Requirement]) -> tuple[str, ...]:
    return tuple(r.parameter for r in told if isinstance(r, model.OneValue))


def _steps(problem: Problem, given: Compact, found: Sequence[Requirement]) -> Iterator[Step]:
    """The derivation with these requirements alone, if arc consistency makes one: who leaves, and why."""
    part = relaxed(given, set(found))
    if part.short() is None:
        return
    whole: dict[tuple[int, int], list[int]] = {}
    for departure in part.departures:
        if departure.need is None:
            return
        whole.setdefault((departure.kind.role, departure.need), [])
    kept_needs = {r.need for r in found if isinstance(r, Fed)}
    gone: set[tuple[int, int]] = set()
    for role, need in whole:
        leaving = [
            number
            for number, candidate in enumerate(problem.candidates[role])
            if (role, number) not in gone
            and need in kept_needs
            and any(
                _is_need(given, need, role, problem, wanted.name, wanted.signal) for wanted in candidate.profile.inputs
            )
        ]
        if not leaving:
            continue
        gone.update((role, number) for number in leaving)
        profile = problem.candidates[role][leaving[0]].profile
        wanted = next(w for w in profile.inputs if _is_need(given, need, role, problem, w.name, w.signal))
        sources = tuple(dict.fromkeys(problem.roles[s].iri for s, _ in given.needs[need].sources))
        yield Step(problem.roles[role].iri, profile.component, len(leaving) - 1, wanted.name, wanted.signal, sources)


def _is_need(given: Compact, need: int, role: int, problem: Problem, name: str, signal: IRI) -> bool:
    known = given.needs[need]
    sources = tuple(dict.fromkeys((k.source, k.output) for k in problem.links[role] if k.input in (None, name)))
    return (known.role, known.signal, known.sources) == (role, signal, sources)


def _told(problem: Problem, given: Compact, requirement: Requirement) -> model.Requirement:
    """A requirement in the words of the template."""
    if isinstance(requirement, Played):
        return model.RolePlayed(problem.roles[requirement.role].iri)
    if isinstance(requirement, Fed):
        need = given.needs[requirement.need]
        return model.InputFed(problem.roles[need.role].iri, need.signal, need.input)
    if isinstance(requirement, Shared):
        names = {parameter.iri: parameter.name for parameter in problem.task.template.parameters}
        return model.OneValue(names[problem.variables[requirement.variable].parameter])
    return model.OneRoleEach()


def refusal(problem: Problem, steps: int = EFFORT) -> Refusal:
    """The refusal of a problem that has no solution."""
    found, irreducible = reasons(problem, steps)
    return Refusal(problem.task.template.iri, found, irreducible=irreducible)
