"""Recruits: the fewest components outside of the roles that feed what the players of a configuration still need.

*Problem.* Given players with inputs that no role feeds, choose recruits so that each of these inputs has a source among
them, and each required input of a recruit a source among recruits and players, without a cycle among recruits; as few
as possible, and of equally few the first by preference and IRI. Whether there are any is a least fixpoint (`supply`);
the fewest are NP-hard to find, as a minimal set cover is (Karp, 1972).

*How.* Recruits that matter are those that are usable and lead to a need. A literal for each says that it is chosen; an
input implies one of those that could feed it. The clauses allow cycles, so each answer is checked by forward chaining,
and a set of chosen recruits that only feed each other is excluded by its loop formula: one of the set is fed from
outside of it (Lin and Zhao, 2004). The bound on their number is lowered until there is no answer. Without a solver
library, or where the steps end, the answer is what is left of a chain of suppliers once none of them can be spared.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace

from selfconf.model.configuration import Configuration, Connection
from selfconf.model.partition import Recruit
from selfconf.model.profile import Input, Output, Profile
from selfconf.model.refusal import Undecided
from selfconf.model.term import IRI
from selfconf.search.budget import Budget
from selfconf.search.engines import CandidateSearch, ClauseSolver, solver_available
from selfconf.search.problem import Problem
from selfconf.search.reduction import ReducedProblem

RECRUIT_STEPS = 200_000
"""Steps spent at most on finding the fewest recruits, each a conflict of the solver or a call of it."""


@dataclass(frozen=True, slots=True)
class _Need:
    """An input that recruits have to feed."""

    component: IRI
    port: Input
    suppliers: tuple[int, ...]
    """The numbers of the recruits that could."""


def recruited(
    problem: Problem, configuration: Configuration, running: Collection[IRI] = (), steps: int = RECRUIT_STEPS
) -> tuple[Configuration, bool] | None:
    """Return a configuration with the recruits that it needs, and whether they are proved to be the fewest.

    None where its players have inputs that no recruits can feed. Of equally few recruits those that are `running` come
    before all others.
    """
    if not any(role.recruits for role in problem.roles):
        return configuration, True
    choice = _Choice(problem, configuration, running)
    if not choice.possible:
        return None
    chosen, proved = choice.fewest(Budget(steps))
    return choice.configuration(chosen), proved


def first_recruited(problem: Problem, steps: int = RECRUIT_STEPS) -> Configuration | Undecided | None:
    """Return the configuration of the first players for whom there are recruits, or None.

    For when the first solution is not one of them: recruits may need what a player issues, or play a role themselves.
    """
    budget = Budget(steps)
    for playing in CandidateSearch(problem, budget).solutions():
        found = recruited(problem, problem.solved(playing), steps=steps)
        if found is not None:
            return found[0]
    return None if budget.steps else Undecided(steps)


class _Choice:
    """The recruits that matter to the players of one configuration, and what they could feed."""

    def __init__(self, problem: Problem, configuration: Configuration, running: Collection[IRI]) -> None:
        self.problem, self.plain, self.running = problem, configuration, running
        self.players = dict(_players(problem, configuration))
        self.recruits: Sequence[Recruit] = problem.supply.recruits
        outputs = [output for _, profile in self.players.values() for output in profile.outputs]
        self.usable = problem.supply.usable(outputs, without=self.players.keys())
        self._by_signal = self._suppliers_by_signal()
        self.wanted = list(self._wanted())
        self.needs = dict(self._needs_of_recruits())
        """For each recruit that matters, the inputs that other recruits have to feed."""

    @property
    def possible(self) -> bool:
        """Whether each need of the players has a usable supplier; then each need of these has one, too."""
        return all(need.suppliers for need in self.wanted)

    def _suppliers_by_signal(self) -> Mapping[IRI, list[tuple[int, Output]]]:
        found: dict[IRI, list[tuple[int, Output]]] = {}
        for number in sorted(self.usable):
            for output in self.recruits[number].profile.outputs:
                for signal in self.problem.hierarchy.served(output.signals):
                    found.setdefault(signal, []).append((number, output))
        return found

    def _suppliers(self, port: Input, role: int | None = None) -> tuple[int, ...]:
        """The usable recruits that could feed an input, of a player of a role or of a recruit."""
        pairs = (pair for signal in port.signals for pair in self._by_signal.get(signal, ()))
        found = {
            number
            for number, output in pairs
            if (port.condition is None or port.condition.met_by(output))
            and (role is None or role in self.recruits[number].roles)
        }
        return tuple(sorted(found))

    def _wanted(self) -> Iterator[_Need]:
        """The required inputs of players that no role feeds."""
        fed = {(connection.sink, connection.input) for connection in self.plain.connections}
        for component, (role, profile) in self.players.items():
            for port in profile.required:
                if (component, port.name) not in fed:
                    yield _Need(component, port, self._suppliers(port, role))

    def _needs_of_recruits(self) -> Iterator[tuple[int, list[_Need]]]:
        """The recruits from which a chain of suppliers leads to a player, each with what it needs of others."""
        waiting = [number for need in self.wanted for number in need.suppliers]
        seen = set(waiting)
        while waiting:
            number = waiting.pop()
            profile = self.recruits[number].profile
            ports = [port for port in profile.required if self._source_among_players(port) is None]
            needs = [_Need(profile.component, port, self._suppliers(port)) for port in ports]
            yield number, needs
            for supplier in {one for need in needs for one in need.suppliers} - seen:
                seen.add(supplier)
                waiting.append(supplier)

    def _source_among_players(self, port: Input) -> tuple[IRI, Output] | None:
        """The first output of a player that could feed an input."""
        for component, (_, profile) in self.players.items():
            for output in profile.outputs:
                if self.problem.hierarchy.pairs(output, port):
                    return component, output
        return None

    def ordered(self, numbers: Iterable[int]) -> list[int]:
        """Recruits in the order in which they are chosen: those that run, then by preference and IRI."""
        return sorted(numbers, key=lambda number: (self.recruits[number].component not in self.running, number))

    def placed(self, chosen: Collection[int]) -> list[int]:
        """The chosen recruits that are fed without a cycle among them, each after those that feed it."""
        found: dict[int, None] = {}
        waiting = self.ordered(chosen)
        while waiting:
            ready = [n for n in waiting if all(any(s in found for s in need.suppliers) for need in self.needs[n])]
            if not ready:
                break
            found[ready[0]] = None
            waiting.remove(ready[0])
        return list(found)

    def sufficient(self, chosen: Collection[int]) -> bool:
        """Whether chosen recruits feed all needs, their own included."""
        placed = set(self.placed(chosen))
        return len(placed) == len(chosen) and all(placed.intersection(need.suppliers) for need in self.wanted)

    def fewest(self, budget: Budget) -> tuple[list[int], bool]:
        """The fewest recruits that are enough, the first of them by preference, and whether that is proved."""
        met = self.without_spare(self._chain())
        if not met or not solver_available():
            return met, not met
        with _FewestRecruits(self, met) as search:
            return search.best(budget)

    def _chain(self) -> list[int]:
        """Recruits that are enough: for each need the supplier that forward chaining finds first.

        Forward chaining finds what feeds a recruit before that recruit, so there is no cycle among them.
        """
        place = {number: at for at, number in enumerate(self.usable)}
        chosen: set[int] = set()
        waiting = list(self.wanted)
        while waiting:
            number = min(waiting.pop().suppliers, key=place.__getitem__)
            if number not in chosen:
                chosen.add(number)
                waiting += self.needs[number]
        return sorted(chosen)

    def without_spare(self, chosen: Sequence[int]) -> list[int]:
        """Recruits without those that can be spared, the last by preference first."""
        left = self.ordered(chosen)
        for number in reversed(left):
            fewer = [other for other in left if other != number]
            if self.sufficient(fewer):
                left = fewer
        return left

    def configuration(self, chosen: Collection[int]) -> Configuration:
        """The configuration with chosen recruits; each input has the first source, players coming before recruits."""
        placed: list[int] = []
        found: list[Connection] = []
        for number in self.placed(chosen):
            profile = self.recruits[number].profile
            for port in profile.required:
                source = self._source_among_players(port) or self._source(port, placed, None)
                found.append(Connection(source[0], source[1].name, profile.component, port.name))
            placed.append(number)
        for need in self.wanted:
            role, _ = self.players[need.component]
            component, output = self._source(need.port, placed, role)
            found.append(Connection(component, output.name, need.component, need.port.name))
        recruits = tuple(self.recruits[number].component for number in sorted(placed))
        whole = replace(self.plain, recruits=recruits)
        order = {component: place for place, component in enumerate(whole.components)}
        every = sorted(
            (*self.plain.connections, *found), key=lambda c: (order[c.source], c.output, order[c.sink], c.input)
        )
        return replace(whole, connections=tuple(every))

    def _source(self, port: Input, placed: Sequence[int], role: int | None) -> tuple[IRI, Output]:
        """The first recruit of those placed, by preference, that feeds an input, with its output."""
        suppliers = set(self._suppliers(port, role))
        profile = self.recruits[self.ordered(suppliers.intersection(placed))[0]].profile
        output = next(output for output in profile.outputs if self.problem.hierarchy.pairs(output, port))
        return profile.component, output


class _FewestRecruits:
    """The choice of recruits as clauses; use it in a `with` statement."""

    def __init__(self, choice: _Choice, met: list[int]) -> None:
        self.choice, self.met = choice, met
        self._stack = ExitStack()
        self._clauses = self._stack.enter_context(ClauseSolver(ReducedProblem((), (), (), ())))
        self._chosen = {number: self._clauses.literal() for number in choice.ordered(choice.needs)}
        for need in choice.wanted:
            self._clauses.add(self._literals(need.suppliers))
        for number, needs in choice.needs.items():
            for need in needs:
                self._clauses.add([-self._chosen[number], *self._literals(need.suppliers)])
        self._clauses.prefer(-literal for literal in self._chosen.values())
        self._counter = self._clauses.counter(list(self._chosen.values()), self._stack) if self._chosen else None

    def __enter__(self) -> _FewestRecruits:
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def _literals(self, numbers: Sequence[int]) -> list[int]:
        return [self._chosen[number] for number in numbers]

    def best(self, budget: Budget) -> tuple[list[int], bool]:
        """The fewest, and of these the first by preference; and whether both are proved."""
        while True:
            fewer = self._answer([], len(self.met) - 1, budget)
            if not isinstance(fewer, list):
                break
            self.met = fewer
        if fewer is not None:
            return self.met, False
        return self._first(budget)

    def _first(self, budget: Budget) -> tuple[list[int], bool]:
        """Of the sets of the number that was met, the one with the first recruits."""
        most, fixed = len(self.met), list[int]()
        for number, literal in self._chosen.items():
            if len(fixed) == most:
                break
            if number in self.met:
                fixed.append(literal)
                continue
            other = self._answer([*fixed, literal], most, budget)
            if isinstance(other, Undecided):
                return self.met, False
            if other is None:
                self._clauses.add([-literal] if not fixed else [-literal, *(-one for one in fixed)])
            else:
                self.met = other
                fixed.append(literal)
        return self.met, True

    def _answer(self, assumed: list[int], most: int, budget: Budget) -> list[int] | Undecided | None:
        """At most a number of recruits that are enough; None if there are none."""
        if most < 1:
            return None
        bound = [-self._clauses.at_least(self._counter, most + 1)] if 0 < most < len(self._chosen) else []
        while True:
            found = self._clauses.solve([*assumed, *bound], budget)
            if isinstance(found, Undecided):
                return found
            if not found:
                return None
            chosen = [number for number, literal in self._chosen.items() if self._clauses.holds(literal)]
            unfounded = set(chosen).difference(self.choice.placed(chosen))
            if not unfounded:
                return self.choice.without_spare(chosen)
            self._exclude(unfounded)

    def _exclude(self, loop: set[int]) -> None:
        """Add the loop formula of recruits that only feed each other: one of them is fed from outside."""
        outside: list[int] = []
        for number in sorted(loop):
            fed = self._clauses.literal()
            for need in self.choice.needs[number]:
                others = [supplier for supplier in need.suppliers if supplier not in loop]
                self._clauses.add([-fed, *self._literals(others)])
            outside.append(fed)
        for number in loop:
            self._clauses.add([-self._chosen[number], *outside])


def _players(problem: Problem, configuration: Configuration) -> Iterator[tuple[IRI, tuple[int, Profile]]]:
    """Each player of a configuration with the number of its role and its profile."""
    for role, assignment in enumerate(configuration.assignments):
        profiles = {candidate.profile.component: candidate.profile for candidate in problem.candidates[role]}
        for component in assignment.components:
            yield component, (role, profiles[component])
