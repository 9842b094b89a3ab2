"""Repair: the next configuration changes as little as possible of the one that runs.

*What is least change.* Every solution is extended as usual, except that what runs and plays the same role is tried
before all others. Of the configurations that come out, the answer keeps the most running components in their roles,
among those the most running connections, and among those it belongs to the lexicographically first solution. So it
is determined, and it does not depend on how it was found.

*How.* By the number of running components given up: none, then one, and so on. With a number given, depth-first
search in lexicographic order leaves out every candidate that would push out more running ones than that: a role with
room for m that has taken k newcomers keeps at most m - k. The first number with a solution is the least; among its
solutions, one that keeps every connection that could be kept ends the search. In the usual case, one component lost
and the rest can stay, the first descent is the answer: a few microseconds for each role.

When that takes long and every role asks for a fixed number, so that nothing is added to a solution, clause learning
takes over: maximise the running components, then the running connections, then minimise the solution. The answer is
the same.

The steps are limited. When they are used up the answer is the best that was met, or else what `first` answers: a
configuration all the same, and `proved` says that it may not be the nearest.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from operator import attrgetter

from selfconf.model.configuration import Configuration, Connection
from selfconf.model.partition import Candidate
from selfconf.model.refusal import Refusal
from selfconf.model.term import IRI
from selfconf.search import explain
from selfconf.search.budget import Budget
from selfconf.search.engines import CandidateSearch, ClauseSolver, solver_available
from selfconf.search.problem import Problem
from selfconf.search.reduction import LazyReduction, pruned, reduced
from selfconf.search.strategies import solution

SPARING_STEPS = 2_000
"""Steps of depth-first search before clauses are written."""
LEAST_STEPS = 20_000
"""Steps at least until the search for the nearest configuration is content with a near one."""
WORK = 2_000_000
"""So many, divided by the number of slots, if that is more: a step costs in proportion to them."""


_COMPONENT: Callable[[Candidate], IRI] = attrgetter("profile.component")


@dataclass(frozen=True, slots=True)
class Reconfiguration:
    """The next configuration, what it keeps of the one that ran, and whether nothing nearer exists for sure."""

    configuration: Configuration
    kept: int
    """Running components that stay in their roles."""
    connections: int
    """Running connections that stay."""
    proved: bool


def nearest_configuration(problem: Problem, running: Configuration) -> Configuration | Refusal:
    """The configuration nearest to the one that runs, or why there is none."""
    outcome = nearest(problem, running)
    return outcome.configuration if isinstance(outcome, Reconfiguration) else outcome


def nearest(problem: Problem, running: Configuration, steps: int | None = None) -> Reconfiguration | Refusal:
    """The same, with what is kept and whether that is proved to be the most."""
    if steps is None:
        steps = max(LEAST_STEPS, WORK // (1 + sum(role.minimum for role in problem.roles)))
    alive = _alive(problem, running)
    fixed = all(role.minimum == role.maximum for role in problem.roles) and solver_available()
    budget = Budget(min(steps, SPARING_STEPS) if fixed else steps)
    near = None if problem.valueless else _best(problem, running, alive, 0, budget)
    if near is None:
        given = LazyReduction(problem)
        playing = solution(given, Budget())
        if not isinstance(playing, list):
            return explain.refusal(given)
        near = _wider(problem, running, alive, budget)
        if not budget.steps and fixed:
            budget = Budget(steps)
            near = _by_clauses(problem, running, alive, budget)
        if near is None:
            near = problem.solved(playing, running)
    return Reconfiguration(near, *kept(near, running), proved=bool(budget.steps))


def _wider(
    problem: Problem, running: Configuration, alive: list[list[tuple[int, Candidate]]], budget: Budget
) -> Configuration | None:
    for lost in range(1, 1 + sum(map(len, alive))):
        best = _best(problem, running, alive, lost, budget)
        if best is not None or not budget.steps:
            return best
    return None


def kept(after: Configuration, before: Configuration) -> tuple[int, int]:
    """How many components stay in their roles, and how many connections stay."""
    played = {(a.role, component) for a in before.assignments for component in a.components}
    stays = sum((a.role, component) in played for a in after.assignments for component in a.components)
    return stays, len(set(after.connections) & set(before.connections))


def _alive(problem: Problem, running: Configuration) -> list[list[tuple[int, Candidate]]]:
    """For each role what runs in it and is still eligible, with its number."""
    played = {a.role: set(a.components) for a in running.assignments}
    return [
        _numbered(candidates, played.get(role.iri, set()))
        for role, candidates in zip(problem.roles, problem.candidates, strict=True)
    ]


def _living(problem: Problem, running: Configuration, alive: list[list[tuple[int, Candidate]]]) -> set[IRI]:
    """What runs and is still eligible for some role, if not for its own."""
    living = {candidate.profile.component for role in alive for _, candidate in role}
    others = {component for component in running.components if component not in living}
    for candidates in problem.candidates if others else ():
        living |= others.intersection(map(_COMPONENT, candidates))
    return living


def _numbered(candidates: tuple[Candidate, ...], wanted: set[IRI]) -> list[tuple[int, Candidate]]:
    found: list[tuple[int, Candidate]] = []
    for number, candidate in enumerate(candidates):
        if len(found) == len(wanted):
            break
        if candidate.profile.component in wanted:
            found.append((number, candidate))
    return found


def _best(
    problem: Problem, running: Configuration, alive: list[list[tuple[int, Candidate]]], lost: int, budget: Budget
) -> Configuration | None:
    """The best configuration that gives up so many running components, if there is one."""
    whole = sum(map(len, alive))
    living = _living(problem, running, alive)
    possible = sum(c.source in living and c.sink in living for c in running.connections)
    best: tuple[int, int] | None = None
    answer: Configuration | None = None
    for playing in _Sparing(problem, alive, lost, budget).solutions():
        configuration = problem.solved(playing, running)
        score = kept(configuration, running)
        if score[0] >= whole - lost and (best is None or score > best):
            best, answer = score, configuration
            if score[1] == possible:
                break
    return answer


def _by_clauses(
    problem: Problem, running: Configuration, alive: list[list[tuple[int, Candidate]]], budget: Budget
) -> Configuration | None:
    """The nearest configuration of a problem that has one and whose roles ask for fixed numbers."""
    part = pruned(reduced(problem, _living(problem, running, alive)))
    stays = {(role, number) for role, some in enumerate(alive) for number, _ in some}
    with ClauseSolver(part) as clauses:
        plays = {
            (role, option.number): literal
            for role, options in enumerate(part.options)
            for option, literal in zip(options, clauses.plays[role], strict=True)
        }
        keeping = [plays[one] for one in plays if one in stays]
        clauses.prefer(keeping)
        if clauses.solve((), budget) is not True:
            return None
        connections = [_lasting(problem, clauses, plays, connection) for connection in running.connections]
        lasting = [literal for literal in connections if literal]
        # A model of the connections' literals is needed before they can be counted: hence the call in between.
        if not (
            clauses.maximise(keeping, budget)
            and clauses.solve((), budget) is True
            and clauses.maximise(lasting, budget)
        ):
            budget.steps = 0
        chosen = clauses.least(Budget())
        playing: list[list[Candidate]] = [[] for _ in problem.roles]
        for option in chosen if isinstance(chosen, list) else ():
            playing[option.kind.role].append(problem.candidates[option.kind.role][option.number])
        return problem.solved(playing, running)


def _lasting(
    problem: Problem, clauses: ClauseSolver, plays: dict[tuple[int, int], int], connection: Connection
) -> int | None:
    """A literal that can hold only if a running connection stays; None if it cannot stay."""
    ways: list[int] = []
    for (sink, number), second in plays.items():
        profile = problem.candidates[sink][number].profile
        wanted = next((port for port in profile.inputs if port.name == connection.input), None)
        if profile.component != connection.sink or wanted is None:
            continue
        for (source, other), first in plays.items():
            feeder = problem.candidates[source][other].profile
            output = feeder.output(connection.output)
            if feeder.component != connection.source or output is None:
                continue
            if any(link.source == source and problem.matches(output, link, wanted) for link in problem.links[sink]):
                way = clauses.literal()
                clauses.add([-way, first])
                clauses.add([-way, second])
                ways.append(way)
    if not ways:
        return None
    lasting = clauses.literal()
    clauses.add([-lasting, *ways])
    return lasting


class _Sparing(CandidateSearch):
    """Fills the slots without pushing out more than so many running components."""

    def __init__(self, problem: Problem, alive: list[list[tuple[int, Candidate]]], lost: int, budget: Budget) -> None:
        super().__init__(problem, budget)
        self.alive, self.lost = alive, lost
        self.home = {c.profile.component: role for role, some in enumerate(alive) for _, c in some}

    def candidates(self, role: int, start: int) -> Iterator[tuple[int, Candidate]]:
        if self._pushed_out(role) > self.lost:
            yield from ((number, c) for number, c in self.alive[role] if number >= start)
            return
        for number, candidate in super().candidates(role, start):
            home = self.home.get(candidate.profile.component)
            if home in (None, role) or self._pushed_out(role, candidate.profile.component) <= self.lost:
                yield number, candidate

    def _pushed_out(self, newcomer: int, moved: str | None = None) -> int:
        """How many running components have no place any more once a role takes a newcomer, who may be a moved one."""
        total = 0
        for role, some in enumerate(self.alive):
            maximum = self.problem.roles[role].maximum
            playing = [c.profile.component for c in self.playing[role]]
            here = {c.profile.component for _, c in some}
            away = sum(c == moved or (c in self.taken and c not in playing) for c in here)
            stay = len(here) - away
            if maximum is not None:
                new = sum(c not in here for c in playing) + (role == newcomer)
                stay = min(stay, maximum - new)
            total += len(here) - max(0, stay)
        return total
