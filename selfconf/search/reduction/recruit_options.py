"""Recruits as options: the reduced problem of choosing the players of a configuration and their recruits together.

Recruits are the options of one role more, the last one, which has no slots: any number of them is chosen. What a player
needs is supported by the players of other roles, as ever, and by recruits of its own role; what a recruit needs, by the
players of all roles and by recruits. So nothing is spared here because it could be recruited (`Problem.spared`): each
need stands, with all that supports it. That recruits do not feed each other in a circle is no constraint of this kind:
a `FoundedSolver` sees to it.

*Dominance.* Of recruits with equal ports, for equal roles, one is enough, as it may feed many; but one that could be a
player is not always there to be recruited. So they are kept in the order of their rank up to the first that is no
candidate: whatever a later one feeds, that one could feed instead. A candidate that could be recruited is distinguished
(`dominance`): a free one of its class cannot always take its place.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction

from selfconf.model.partition import Recruit
from selfconf.model.profile import Input, Output, Profile, WantedSignal
from selfconf.model.term import IRI
from selfconf.search.problem import Feeder, Problem
from selfconf.search.reduction.constraints import NO_COMPONENT
from selfconf.search.reduction.dominance import reduced
from selfconf.search.reduction.needs import Need, Needs, NeedScope
from selfconf.search.reduction.reduced_problem import InterchangeabilityClass, Option, ReducedProblem

Rank = Callable[[int], tuple[Fraction, ...]]
"""Which of the recruits that could take each other's place comes first, by their numbers."""


def with_recruits(
    problem: Problem,
    distinguished: Iterable[IRI] = (),
    order: Mapping[int, Sequence[int]] | None = None,
    rank: Rank | None = None,
) -> ReducedProblem:
    """Return a problem in which recruits are the options of one role more, the last one.

    The number of such an option is that of the recruit; it has no component, as it is chosen besides all roles.
    `distinguished` candidates are of a class of their own, and `order` is another order of the candidates of each role.
    """
    alone = Problem(problem.task, problem.partition.without_recruits(), problem.hierarchy)
    matter = recruits_that_matter(problem)
    components = {candidate.profile.component for some in problem.candidates for candidate in some}
    recruitable = components.intersection(problem.supply.recruits[number].component for number in matter)
    part = reduced(alone, recruitable.union(distinguished), order)
    if rank is not None:
        matter.sort(key=rank)
    return _Joined(problem, part, list(_undominated(problem, matter, recruitable))).problem()


def recruits_that_matter(problem: Problem) -> list[int]:
    """Return the recruits that could be fed, and could feed a player or what feeds one, by number."""
    recruiting = [number for number, role in enumerate(problem.roles) if role.recruits]
    needed = needed_signals(problem, [c.profile for number in recruiting for c in problem.candidates[number]])
    outputs = {output for some in problem.candidates for c in some for output in c.profile.outputs}
    return sorted(
        number
        for number in problem.supply.usable(outputs)
        if not needed.isdisjoint(signals_served(problem, problem.supply.recruits[number].profile))
    )


def needed_signals(problem: Problem, profiles: Iterable[Profile]) -> set[IRI]:
    """Return the signals that some components need, and those that recruits for these need in turn."""
    suppliers: dict[IRI, list[Profile]] = {}
    for recruit in problem.supply.recruits:
        for signal in signals_served(problem, recruit.profile):
            suppliers.setdefault(signal, []).append(recruit.profile)
    waiting = [port for profile in profiles for port in profile.required]
    needed: set[IRI] = set()
    while waiting:
        for signal in waiting.pop().signals:
            if signal not in needed:
                needed.add(signal)
                waiting += [port for profile in suppliers.get(signal, ()) for port in profile.required]
    return needed


def signals_served(problem: Problem, profile: Profile) -> Iterator[IRI]:
    """Yield the signals that the outputs of a component serve."""
    return (signal for output in profile.outputs for signal in problem.hierarchy.served(output.signals))


def _undominated(problem: Problem, ranked: Iterable[int], candidates: set[IRI]) -> Iterator[int]:
    """Yield the recruits, given in the order of their rank, that none before them could always take the place of."""
    enough = set[tuple[int, frozenset[int]]]()
    for number in ranked:
        recruit = problem.supply.recruits[number]
        key = id(recruit.profile.ports), recruit.roles
        if key not in enough:
            yield number
            if recruit.component not in candidates:
                enough.add(key)


class _Joined:
    """Numbers what recruits need beside what players need, and finds what supports it."""

    def __init__(self, given: Problem, part: ReducedProblem, recruits: list[int]) -> None:
        self.given, self.part, self.recruits = given, part, recruits
        self.role = len(part.options)
        """The number of the role of the recruits."""
        self.needs = list(part.needs)
        self._known: dict[WantedSignal, int] = {}
        """The needs of recruits by what they want."""
        self._wanting: dict[IRI, list[int]] = {}
        """For each signal the needs of recruits that it could meet."""
        self._needs_of = {number: self._needed(self._recruit(number).profile.required) for number in recruits}
        self._of_players = self._needs_of_players()

    def _recruit(self, number: int) -> Recruit:
        return self.given.supply.recruits[number]

    def _needed(self, ports: Iterable[Input]) -> tuple[int, ...]:
        found: list[int] = []
        scope = NeedScope(self.role, (Feeder(self.role),))
        for port in ports:
            number = self._known.get(port.wanted)
            if number is None:
                number = self._known[port.wanted] = len(self.needs)
                self.needs.append(Need(scope, port))
                for signal in port.signals:
                    self._wanting.setdefault(signal, []).append(number)
            found.append(number)
        return tuple(dict.fromkeys(found))

    def _needs_of_players(self) -> Mapping[IRI, list[int]]:
        """For each signal the needs of players of roles that recruit."""
        found: dict[IRI, list[int]] = {}
        for number, need in enumerate(self.part.needs):
            if self.given.roles[need.role].recruits:
                for signal in need.wanted.signals:
                    found.setdefault(signal, []).append(number)
        return found

    def problem(self) -> ReducedProblem:
        """The problem of both."""
        for kind in self.part.kinds():
            outputs = kind.signatures[0][0].outputs
            kind.supports = (*kind.supports, *self._met(outputs, self._wanting))
        options: list[Option] = []
        helped: set[int] = set()
        known: dict[object, tuple[int, ...]] = {}
        for number in self.recruits:
            recruit = self._recruit(number)
            key = id(recruit.profile.ports), recruit.roles
            if key not in known:
                of_players = self._met(recruit.profile.outputs, self._of_players)
                mine = [one for one in of_players if self.needs[one].role in recruit.roles]
                helped.update(mine)
                known[key] = (*mine, *self._met(recruit.profile.outputs, self._wanting))
            kind = InterchangeabilityClass(self.role, self._needs_of[number], known[key], {}, number)
            options.append(Option(number, NO_COMPONENT, kind))
        for number in helped:
            need = self.needs[number]
            scope = NeedScope(need.role, (*need.sources, Feeder(self.role)), need.scope.named)
            self.needs[number] = Need(scope, need.port)
        return ReducedProblem(
            self.part.slots, (*self.part.options, tuple(options)), Needs(self.needs), self.part.values
        )

    def _met(self, outputs: Sequence[Output], wanting: Mapping[IRI, list[int]]) -> tuple[int, ...]:
        """Return those of some needs, by signal, that outputs meet."""
        served = self.given.hierarchy.served
        return tuple(
            dict.fromkeys(
                number
                for output in outputs
                for signal in served(output.signals)
                for number in wanting.get(signal, ())
                if (condition := self.needs[number].wanted.condition) is None or condition.met_by(output)
            )
        )
