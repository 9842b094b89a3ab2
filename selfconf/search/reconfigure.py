"""Reconfiguration: after a failure, the configuration that changes the least of the one that runs.

*Which configuration is nearest.* Every solution is extended as usual, except that a component that runs is tried for
the role that it plays before all other candidates. Of the configurations that come out, the answer keeps the most
running components in their roles, among those the most running connections, and among those it belongs to the
lexicographically first solution. So the answer is determined, and does not depend on how it was found. Where a role
recruits the answer is not extended, as recruits come first; what it will keep is counted as if those that run stayed.

*How it is found.* By the number of losses, that is of running components that have to give up their roles: none, then
one, and so on. For each number, depth-first search in lexicographic order leaves out every candidate that would
displace more running components than that: a role with room for m that has taken k newcomers keeps at most m - k. The
first number with a solution is the least; among its solutions, one that keeps every connection that could be kept ends
the search. In the usual case, one component lost and the rest can stay, the first descent is the answer: a few
microseconds for each role.

When that takes long, what runs is tried by itself: a solution of those components alone that loses none of them, nor a
connection, is as near as can be, and the answer, though another one may come before it in lexicographic order. Else,
when every role asks for a fixed number, so that nothing is added to a solution, clause learning takes over: maximise
the running components, then the running connections, then minimise the solution. The answer is the one that depth-first
search would find.

*Budget.* The steps are limited. When they are used up, the answer is the incumbent: the nearest configuration that any
engine has met, the strategy `first` included. Then `proved` says that a nearer one may exist.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from operator import attrgetter

from selfconf.model.configuration import Configuration, Connection
from selfconf.model.immutable import immutable, replace
from selfconf.model.partition import Candidate
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.term import IRI
from selfconf.search import explain
from selfconf.search.budget import Budget
from selfconf.search.engines import CandidateSearch, ClauseSolver, least_of_clauses, solver_available
from selfconf.search.extension import solved, with_further_players
from selfconf.search.problem import Problem
from selfconf.search.reduction import LazyReduction, assigned, pruned, reduced
from selfconf.search.strategies import solution

DEPTH_FIRST_STEPS = 2_000
"""Steps of depth-first search before clauses are written."""
LEAST_STEPS = 20_000
"""Steps at least until the search for the nearest configuration answers with the incumbent."""
WORK = 2_000_000
"""The steps are this number divided by the number of slots, if that is more: a step costs in proportion to them."""
EXTENDED_IN_A_STEP = 6
"""How many candidates are tried, when a solution is extended, in the time of a step."""

Score = tuple[int, int]
"""Running components that stay in their roles, and running connections that stay: more is nearer."""
Numbered = list[tuple[int, Candidate]]
"""Candidates of a role with their places in the order of the role."""

_COMPONENT: Callable[[Candidate], IRI] = attrgetter("profile.component")


@immutable
class Reconfiguration:
    """The next configuration, what it keeps of the one that ran, and whether it is proved to be the nearest."""

    configuration: Configuration
    kept: int
    """Running components that stay in their roles."""
    connections: int
    """Running connections that stay."""
    proved: bool


def nearest_configuration(problem: Problem, running: Configuration) -> Configuration | Refusal:
    """Return the configuration nearest to the one that runs, or why there is none."""
    outcome = nearest(problem, running)
    return outcome.configuration if isinstance(outcome, Reconfiguration) else outcome


def nearest(problem: Problem, running: Configuration, steps: int | None = None) -> Reconfiguration | Refusal:
    """Return the nearest configuration that is met within a number of steps, what it keeps, and whether it is proved.

    The steps limit the search for the nearest configuration, not the decision whether there is one at all.
    """
    if steps is None:
        steps = max(LEAST_STEPS, WORK // (1 + sum(role.minimum for role in problem.roles)))
    fixed = all(role.minimum == role.maximum for role in problem.roles) and solver_available()
    search = _NearestSearch(problem, running)
    found, budget = search.without_losses(steps, fixed)
    if found is None or (fixed and not budget.steps and search.meet(found) < (search.whole, search.possible)):
        given = LazyReduction(problem)
        playing = solution(given, Budget())
        if not isinstance(playing, list):
            return explain.refusal(given)
        found = search.with_fewest_losses(budget) if found is None else found
        if not budget.steps and fixed:
            search.meet(found)
            budget = Budget(steps)
            found = search.by_clauses(budget)
        if found is None or not budget.steps:
            found = search.nearest_of(found, solved(problem, playing, running), search.incumbent)
    return Reconfiguration(found, *search.score(found), proved=bool(budget.steps))


def preserved(after: Configuration, before: Configuration) -> Score:
    """Count the components that stay in their roles, and the connections that stay."""
    played = {(a.role, component) for a in before.assignments for component in a.components}
    stays = sum((a.role, component) in played for a in after.assignments for component in a.components)
    return stays, len(set(after.connections) & set(before.connections))


class _NearestSearch:
    """The engines on one problem and one running configuration, and the incumbent that they share."""

    def __init__(self, problem: Problem, running: Configuration) -> None:
        self.problem, self.running = problem, running
        played = {a.role: set(a.components) for a in running.assignments}
        self.eligible: list[Numbered] = [
            _among(candidates, played.get(role.iri, set()))
            for role, candidates in zip(problem.roles, problem.candidates, strict=True)
        ]
        """For each role the components that run in it and are still eligible for it."""
        self.whole = sum(map(len, self.eligible))
        self.available = self._available()
        self.possible = sum(c.source in self.available and c.sink in self.available for c in running.connections)
        """How many running connections could stay, at most."""
        fixed = all(role.minimum == role.maximum for role in problem.roles)
        self.extension = 0 if fixed else sum(map(len, problem.candidates)) // EXTENDED_IN_A_STEP
        """The steps that it takes to extend a solution."""
        self.incumbent: Configuration | None = None
        self._score: Score = (-1, -1)
        self._grows_later = not fixed and any(role.recruits for role in problem.roles)
        """Whether a solution is extended only once it has its recruits."""

    def _available(self) -> set[IRI]:
        """Return the components that run and are still eligible for some role, if not for their own."""
        available = {candidate.profile.component for role in self.eligible for _, candidate in role}
        others = {component for component in self.running.components if component not in available}
        for candidates in self.problem.candidates if others else ():
            available |= others.intersection(map(_COMPONENT, candidates))
        return available

    def score(self, configuration: Configuration) -> Score:
        """Count what a configuration keeps, with the further players that it gets once it has its recruits."""
        if self._grows_later:
            beside = tuple(one for one in self.running.recruits if one not in configuration.players)
            configuration = with_further_players(self.problem, replace(configuration, recruits=beside), self.running)
        return preserved(configuration, self.running)

    def meet(self, configuration: Configuration | None) -> Score:
        """Make a configuration the incumbent if it is nearer than the last one; of equals the first one stays."""
        if configuration is None:
            return -1, -1
        score = self.score(configuration)
        if score > self._score:
            self._score, self.incumbent = score, configuration
        return score

    def nearest_of(self, *configurations: Configuration | None) -> Configuration:
        """Return the nearest of some configurations, at least one of which is there; of equals the first one."""
        met = [configuration for configuration in configurations if configuration is not None]
        return max(met, key=self.score)

    def without_losses(self, steps: int, fixed: bool) -> tuple[Configuration | None, Budget]:
        """Return the best configuration without losses, if one is met, and what is left of the steps.

        `fixed` says that clauses can go on from there.
        """
        few = min(steps, DEPTH_FIRST_STEPS)
        budget = Budget(few)
        found = None if self.problem.valueless else self.with_losses(0, budget)
        if budget.steps or self.problem.valueless or (fixed and found is not None):
            # Where no clauses go on from there, all other steps are for depth-first search too.
            return found, budget if fixed else Budget(steps - few + (budget.steps or 0))
        alone = self.running_alone()
        if alone is not None and self.meet(alone) == (self.whole, self.possible):
            return alone, Budget(0)  # none is nearer, but another one may be the first of the nearest
        if not fixed:
            budget = Budget(steps)
            found = self.with_losses(0, budget)
        return found, budget

    def running_alone(self) -> Configuration | None:
        """Return what the components that run make up without any other; None if that is not found in few steps."""
        problem = self.problem
        left = tuple(tuple(candidate for _, candidate in some) for some in self.eligible)
        if any(len(some) < role.minimum for role, some in zip(problem.roles, left, strict=True)):
            return None
        alone = Problem(problem.task, replace(problem.partition, candidates=left), problem.hierarchy)
        found = CandidateSearch(alone, Budget(DEPTH_FIRST_STEPS)).first()
        return None if found is None else solved(problem, found, self.running)

    def with_fewest_losses(self, budget: Budget) -> Configuration | None:
        """Return the best configuration with the fewest losses, one at least; None if the budget ends before."""
        for losses in range(1, 1 + self.whole):
            best = self.with_losses(losses, budget)
            if best is not None or not budget.steps:
                return best
        return None

    def with_losses(self, losses: int, budget: Budget) -> Configuration | None:
        """Return the best configuration with this number of losses, or None if none is met within the budget."""
        best: tuple[Score, Configuration] | None = None
        for playing in _LossBoundedSearch(self.problem, self.eligible, losses, budget).solutions():
            configuration = solved(self.problem, playing, self.running)
            budget.spend(self.extension)
            score = self.meet(configuration)
            # The bound of the search assumes that a role can be filled up again by the extension. Where it cannot, the
            # configuration has more losses than that: it is an incumbent only, and its turn comes with that number.
            if score[0] >= self.whole - losses and (best is None or score > best[0]):
                best = score, configuration
                if score[1] == self.possible:
                    break
        return best[1] if best is not None else None

    def by_clauses(self, budget: Budget) -> Configuration | None:
        """Return the nearest configuration of a problem whose roles ask for fixed numbers; None if none is met.

        When the budget ends before the proof, the answer is the best that the solver has met.
        """
        # A component that runs may be the only one to keep a connection: it is distinguished from those of its class.
        with ClauseSolver(pruned(reduced(self.problem, self.available))) as clauses:
            plays = {
                (role, option.number): literal
                for role, options in enumerate(clauses.reduced.options)
                for option, literal in zip(options, clauses.plays[role], strict=True)
            }
            stays = {(role, number) for role, some in enumerate(self.eligible) for number, _ in some}
            keeping = [literal for place, literal in plays.items() if place in stays]
            clauses.prefer(keeping)
            if clauses.solve((), budget) is not True:
                return None
            proved = self._maximised(clauses, plays, keeping, budget)
            # With a budget of its own: what was maximised is not thrown away for want of the steps to name the first.
            chosen = least_of_clauses(clauses, Budget(max(LEAST_STEPS, budget.steps or 0)))
            if isinstance(chosen, Undecided):
                chosen, proved = clauses.chosen(), False
            if not proved:
                budget.steps = 0
            return solved(self.problem, assigned(self.problem, chosen), self.running)

    def _maximised(
        self, clauses: ClauseSolver, plays: dict[tuple[int, int], int], keeping: list[int], budget: Budget
    ) -> bool:
        """Keep the most components, and then the most connections; return whether that is proved."""
        literals = [self._connection_literal(clauses, plays, connection) for connection in self.running.connections]
        connecting = [literal for literal in literals if literal]
        return (
            clauses.maximise(keeping, budget)
            # A model of the connections' literals is needed before they can be counted: hence the call in between.
            and clauses.solve((), budget) is True
            and clauses.maximise(connecting, budget)
        )

    def _connection_literal(
        self, clauses: ClauseSolver, plays: dict[tuple[int, int], int], connection: Connection
    ) -> int | None:
        """Return a literal that can hold only if a running connection stays; None if the connection cannot stay."""
        ways: list[int] = []
        for sink, source in self._ends(plays, connection):
            way = clauses.literal()
            clauses.add([-way, source])
            clauses.add([-way, sink])
            ways.append(way)
        if not ways:
            return None
        stays = clauses.literal()
        clauses.add([-stays, *ways])
        return stays

    def _ends(self, plays: dict[tuple[int, int], int], connection: Connection) -> Iterator[tuple[int, int]]:
        """Yield the pairs of a sink's and a source's literal that make a connection if both hold."""
        problem = self.problem
        for (sink, number), sink_literal in plays.items():
            profile = problem.candidates[sink][number].profile
            wanted = next((port for port in profile.inputs if port.name == connection.input), None)
            if profile.component != connection.sink or wanted is None:
                continue
            for (source, other), source_literal in plays.items():
                feeder = problem.candidates[source][other].profile
                output = feeder.output(connection.output)
                if feeder.component != connection.source or output is None:
                    continue
                if any(link.source == source and problem.matches(output, link, wanted) for link in problem.links[sink]):
                    yield sink_literal, source_literal


def _among(candidates: tuple[Candidate, ...], wanted: set[IRI]) -> Numbered:
    """Return the candidates that are wanted, and look no further than the last of them."""
    found: Numbered = []
    for number, candidate in enumerate(candidates):
        if len(found) == len(wanted):
            break
        if candidate.profile.component in wanted:
            found.append((number, candidate))
    return found


class _LossBoundedSearch(CandidateSearch):
    """Depth-first search that leaves out candidates by which too many running components would lose their roles."""

    def __init__(self, problem: Problem, eligible: list[Numbered], losses: int, budget: Budget) -> None:
        super().__init__(problem, budget)
        self.eligible, self.losses = eligible, losses
        self.home = {c.profile.component: role for role, some in enumerate(eligible) for _, c in some}
        """For each running component the role that it plays."""
        self._at: dict[IRI, int] = {}
        """For each component that was chosen its role."""
        self._away, self._new = [0] * len(eligible), [0] * len(eligible)
        """For each role how many of its running components were chosen for another one, and how many others for it."""
        self._lost = sum(map(self._lost_by, range(len(eligible))))

    def candidates(self, role: int, start: int) -> Iterator[tuple[int, Candidate]]:
        if self._displaced(role) > self.losses:
            yield from ((number, c) for number, c in self.eligible[role] if number >= start)
            return
        for number, candidate in super().candidates(role, start):
            home = self.home.get(candidate.profile.component)
            if home in (None, role) or self._displaced(role, candidate.profile.component) <= self.losses:
                yield number, candidate

    def _fill(self, place: int, start: int) -> int | None:
        number = super()._fill(place, start)
        if number is not None:
            role = self.slots[place]
            self._move(self.playing[role][-1].profile.component, role, 1)
        return number

    def _empty(self, place: int) -> None:
        role = self.slots[place]
        component = self.playing[role][-1].profile.component
        super()._empty(place)
        self._move(component, role, -1)

    def _move(self, component: IRI, role: int, by: int) -> None:
        """Count a component that is chosen for a role, or with -1 for by is chosen no more."""
        if by > 0:
            self._at[component] = role
        else:
            del self._at[component]
        home = self.home.get(component)
        if home == role:
            return
        for changed, counts in ((role, self._new), (home, self._away)):
            if changed is not None:
                self._lost -= self._lost_by(changed)
                counts[changed] += by
                self._lost += self._lost_by(changed)

    def _lost_by(self, role: int, away: int = 0, new: int = 0) -> int:
        """Count the running components that lose a role, if so many more went away, or so many more were new to it."""
        here, maximum = len(self.eligible[role]), self.problem.roles[role].maximum
        stay = here - self._away[role] - away
        if maximum is not None:
            stay = min(stay, maximum - self._new[role] - new)
        return here - max(0, stay)

    def _displaced(self, newcomer: int, moved: IRI | None = None) -> int:
        """Count the running components that lose their roles once a role takes a newcomer, perhaps one that moves."""
        lost = self._lost + self._lost_by(newcomer, new=1) - self._lost_by(newcomer)
        if moved is not None and self._at.get(moved, self.home[moved]) == self.home[moved]:
            lost += self._lost_by(self.home[moved], away=1) - self._lost_by(self.home[moved])
        return lost
