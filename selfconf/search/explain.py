"""Why there is no configuration: a derivation of irreducible reasons, cheapest first.

1. Roles that contradict themselves or have too few candidates, each a reason by itself. Nobody needs more than that.
2. Arc consistency runs a role out of candidates. The requirements that its derivation used, from that role back to
   the needs that nobody serves, cannot hold together.
3. Matching fails: Hall's set of roles.
4. Otherwise the clause-learning engine names assumptions that cannot hold together, again and again with one of
   them left out, until each is needed.

What 2 and 3 give is made irreducible by QuickXplain (Junker, AAAI 2004), unless Hall's set lacks one component only:
then any of its roles can be left out. So is everything together where there is no such engine: a question of the kind
"can these hold together?" for about k log(n / k) subsets, k being what remains of n. Each is decided on a problem with
only these requirements in force, which is small when they are few.
Irreducible does not mean smallest.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from selfconf.model import requirement as model
from selfconf.model.refusal import (
    Conflict,
    Contradiction,
    DerivationStep,
    InputUnfed,
    Reason,
    Refusal,
    TooFewDistinct,
    TooFewEligible,
    Undecided,
    ValueUnknown,
)
from selfconf.search.budget import Budget
from selfconf.search.engines import ClauseSolver, first_solution, shortage, solver_available
from selfconf.search.problem import Problem
from selfconf.search.reduction import (
    Constraint,
    Distinct,
    Fed,
    InterchangeabilityClass,
    LazyReduction,
    Played,
    ReducedProblem,
    Shared,
    all_of,
    consistent,
    likeness,
    pruned,
    relaxed,
)

EXPLANATION_STEPS = 1_000_000
"""Steps spent at most on making reasons irreducible."""
QUESTION_STEPS = 1000
"""Steps of depth-first search for one question before clauses are written."""


def refusal(given: LazyReduction, steps: int = EXPLANATION_STEPS) -> Refusal:
    """The refusal of a problem that has no solution."""
    problem = given.problem
    template = problem.task.template.iri
    plain = tuple(_plain(problem))
    if plain:
        return Refusal(template, plain)
    questions = Questions(given.reduced, Budget(steps))
    found = core(questions)
    return Refusal(template, (_worded(problem, given.reduced, found),), irreducible=questions.settled)


def _plain(problem: Problem) -> Iterator[Reason]:
    for role, candidates in zip(problem.roles, problem.candidates, strict=True):
        if role.maximum is not None and role.maximum < role.minimum:
            yield Contradiction(role.iri, role.minimum, role.maximum)
        elif len(candidates) < role.minimum:
            yield TooFewEligible(role.iri, role.minimum, len(candidates))
    for position, parameter in problem.unvalued:
        if problem.roles[position].minimum:
            yield ValueUnknown(problem.roles[position].iri, parameter)


class Questions:
    """Asks which requirements can hold together, within a budget."""

    def __init__(self, given: ReducedProblem, budget: Budget) -> None:
        self.given, self.budget = given, budget
        self.settled = True
        """False once a question was left open: then what remains may be reducible."""

    def possible(self, force: Iterable[Constraint]) -> bool | Undecided:
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
        first = self.budget.part(QUESTION_STEPS) if solver_available() else self.budget
        found = first_solution(part, first, distinct)
        if isinstance(found, Undecided) and solver_available():
            with ClauseSolver(part, distinct=distinct) as clauses:
                return clauses.solve((), self.budget)
        return found if isinstance(found, Undecided) else found is not None

    def irreducible(self, together: Sequence[Constraint]) -> tuple[Constraint, ...]:
        """Of requirements that cannot hold together, as many as still cannot, but could without any one of them."""
        order = sorted(together, key=_rank)
        return tuple(sorted(self._explain((), order, False), key=order.index)) if order else ()

    def _explain(
        self, background: tuple[Constraint, ...], rest: Sequence[Constraint], changed: bool
    ) -> tuple[Constraint, ...]:
        if changed and self._impossible(background):
            return ()
        if len(rest) == 1:
            return tuple(rest)
        half = len(rest) // 2
        first, second = tuple(rest[:half]), tuple(rest[half:])
        of_second = self._explain((*background, *first), second, True)
        of_first = self._explain((*background, *of_second), first, bool(of_second))
        return (*of_first, *of_second)

    def _impossible(self, together: tuple[Constraint, ...]) -> bool:
        if not any(isinstance(r, Played) for r in together):
            return False
        answer = self.possible(together)
        if isinstance(answer, Undecided):
            self.settled = False
            return False
        return not answer


def _rank(requirement: Constraint) -> int:
    """QuickXplain drops what comes late: first roles, then needs, then what people think of last."""
    return [Played, Fed, Shared, Distinct].index(type(requirement))


def core(questions: Questions) -> tuple[Constraint, ...]:
    """An irreducible set of requirements that cannot hold together."""
    given = questions.given
    whole = pruned(given)
    role = whole.short()
    if role is not None:
        return questions.irreducible(derivation(given, role))
    lack = shortage(given.slots, [[o.component for o in options] for options in given.options])
    if lack is not None:
        together: tuple[Constraint, ...] = (*map(Played, lack.roles), Distinct())
        return together if lack.wanted == lack.found + 1 else questions.irreducible(together)
    if not solver_available():
        return questions.irreducible(all_of(given))
    return _clash(questions)


def _clash(questions: Questions) -> tuple[Constraint, ...]:
    """Assumptions that the clause-learning engine finds to clash, made irreducible by leaving out one at a time.

    All questions go to one solver, which keeps what it learned; each answer "no" names a smaller set to go on with.
    """
    everything = sorted(all_of(questions.given), key=_rank)
    with ClauseSolver(questions.given, guarded=True) as clauses:
        left = [clauses.guards[r] for r in everything if r in clauses.guards]
        needed: set[int] = set()
        if clauses.solve(left, questions.budget) is False:
            named = clauses.core()
            left = [guard for guard in left if guard in named]
        for guard in reversed(list(left)):
            if guard not in left:
                continue
            answer = clauses.solve([other for other in left if other != guard], questions.budget)
            if answer is False:
                named = clauses.core() | needed
                left = [other for other in left if other in named]
            else:
                needed.add(guard)
                questions.settled &= answer is True
        return tuple(r for r in everything if clauses.guards.get(r) in set(left))


def derivation(given: ReducedProblem, role: int) -> tuple[Constraint, ...]:
    """The requirements by which arc consistency empties a role: back from it to what nobody gives."""
    played = list(dict.fromkeys(given.slots))
    kinds = given.kinds()
    _, departures = consistent(kinds, len(given.needs), given.values, played)
    before = {id(departure.kind): place for place, departure in enumerate(departures)}
    givers: dict[int, list[InterchangeabilityClass]] = {}
    for kind in kinds:
        for need in kind.gives:
            givers.setdefault(need, []).append(kind)
    found: dict[Constraint, None] = {Played(role): None}
    waiting = [before[id(kind)] for kind in kinds if kind.role == role and id(kind) in before]
    seen = set(waiting)
    while waiting:
        place = waiting.pop()
        departure = departures[place]
        if departure.need is not None:
            found[Fed(departure.need)] = None
            causes = givers.get(departure.need, [])
        else:
            found[Shared(departure.variable or 0)] = None
            found.update(dict.fromkeys(map(Played, played)))
            causes = kinds
        for kind in causes:
            earlier = before.get(id(kind), place)
            if earlier < place and earlier not in seen:
                seen.add(earlier)
                waiting.append(earlier)
    return tuple(found)


def _worded(problem: Problem, given: ReducedProblem, found: Sequence[Constraint]) -> Reason:
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
                first.role,
                first.component,
                first.input,
                first.signal,
                first.sources,
                told,
                tuple(steps[1:]),
                first.optional,
            )
    return Conflict(roles or tuple(role.iri for role in problem.roles), _parameters(told), told)


def _parameters(told: Iterable[model.Requirement]) -> tuple[str, ...]:
    return tuple(r.parameter for r in told if isinstance(r, model.OneValue))


def _steps(problem: Problem, given: ReducedProblem, found: Sequence[Constraint]) -> Iterator[DerivationStep]:
    """The derivation with these requirements alone, if arc consistency makes one: who leaves, and why."""
    part = relaxed(given, set(found))
    if part.short() is None or any(departure.need is None for departure in part.departures):
        return
    leaving: dict[tuple[int, int], list[InterchangeabilityClass]] = {}
    for departure in part.departures:
        leaving.setdefault((departure.kind.role, departure.need or 0), []).append(departure.kind)
    for (role, number), kinds in leaving.items():
        need = given.needs[number]
        profile = problem.candidates[role][min(kind.number for kind in kinds)].profile
        wanting = [name for name, signal in profile.inputs if signal == need.signal]
        unfed = next(name for name in wanting if problem.feeding(role, name) == need.sources)
        feeding = [problem.roles[source] for source in dict.fromkeys(source for source, _ in need.sources)]
        sources = tuple(feeder.iri for feeder in feeding)
        optional = tuple(feeder.iri for feeder in feeding if feeder.minimum == 0)
        same = {like for kind in kinds for like in kind.likes}
        more = sum(map(same.__contains__, map(likeness, problem.candidates[role]))) - 1
        yield DerivationStep(problem.roles[role].iri, profile.component, more, unfed, need.signal, sources, optional)


def _told(problem: Problem, given: ReducedProblem, requirement: Constraint) -> model.Requirement:
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
