"""The recruits among which there is a choice: who is usable, what leads to a need, and what some are enough for."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import replace
from functools import reduce
from heapq import heapify, heappop, heappush
from itertools import chain
from operator import or_
from typing import NamedTuple

from selfconf.model.configuration import Configuration, Connection, ordered_connections
from selfconf.model.partition import Recruit
from selfconf.model.profile import Input, Output, Profile, WantedSignal
from selfconf.model.term import IRI
from selfconf.search.problem import Feeder, Problem
from selfconf.search.reduction import (
    NO_COMPONENT,
    InterchangeabilityClass,
    Need,
    Needs,
    NeedScope,
    Option,
    ReducedProblem,
)

UNSAID = Input("", ())
"""What a choice of suppliers is wanted for, where its number says all."""
Suppliers = tuple[int, ...]
"""The numbers of the recruits that could feed an input."""


BESIDES_TYPES = Output._fields.index("unit")
"""From which field of an output on an input may ask for what it says, besides the signal types."""


class UnfedInput(NamedTuple):
    """An input that recruits have to feed."""

    component: IRI
    port: Input
    suppliers: tuple[int, ...]
    """The numbers of the recruits that could."""


class LeastChains(NamedTuple):
    """For choices of suppliers a short chain that ends in one of them."""

    least: Mapping[int, int]
    """For a choice, by identity, which recruits are in the chain; bit k is the one at place k of the order."""
    order: Sequence[int]

    def joined(self, needs: Iterable[UnfedInput]) -> list[int]:
        """The recruits of the chains of some needs, sorted."""
        whole = reduce(or_, (self.least[id(need.suppliers)] for need in needs), 0)
        return sorted(number for place, number in enumerate(self.order) if whole >> place & 1)


class RecruitChoice:
    """The recruits that matter to the players of one configuration, and what they could feed."""

    def __init__(
        self,
        problem: Problem,
        configuration: Configuration,
        running: Collection[IRI],
        among: Collection[int] | None = None,
    ) -> None:
        """`among` are the only recruits that are looked at, where some were chosen by what else they are worth."""
        self.problem, self.plain, self.running = problem, configuration, running
        self.players = dict(players_of(problem, configuration))
        self.recruits: Sequence[Recruit] = problem.supply.recruits
        outputs = [output for _, profile in self.players.values() for output in profile.outputs]
        # Without the players, who issue the same as recruits, so that they make nobody usable.
        usable = (one for one in problem.supply.usable(outputs) if self.recruits[one].component not in self.players)
        if among is None:
            looked_at = self._undominated(self.ordered(usable))
        else:
            looked_at = filter(frozenset(among).__contains__, usable)
        self._issued = problem.supply.issued(looked_at)
        self._known: dict[tuple[WantedSignal, int | None], Suppliers] = {}
        self._from_players: dict[WantedSignal, tuple[IRI, Output] | None] = {}
        self.wanted = list(self._wanted())
        self.needs = dict(self._needs_of_recruits())
        """For each recruit that matters, the inputs that other recruits have to feed."""
        self._place = {number: at for at, number in enumerate(self.ordered(self.needs))}
        self._lacking = {number: len(needs) for number, needs in self.needs.items()}
        self._feeds = self._needs_by_supplier()
        self._consumers: dict[int, list[int]] = {}
        """For each choice of suppliers, by identity, the recruits that need one of them."""
        for number, needs in self.needs.items():
            for need in needs:
                self._consumers.setdefault(id(need.suppliers), []).append(number)

    @property
    def possible(self) -> bool:
        """Whether each need of the players has a usable supplier; then each need of these has one, too."""
        return all(need.suppliers for need in self.wanted)

    @property
    def number_of_suppliers(self) -> int:
        """How many recruits could feed each choice, all choices together."""
        return sum(map(len, self._feeds.values()))

    def _undominated(self, ordered: Iterable[int]) -> Iterator[int]:
        """Yield of recruits in their order the first of those that need the same and issue the same for the same roles.

        In any solution it can take the place of another of them; both of them are one too many.
        """
        known: set[tuple[object, ...]] = set()
        for number in ordered:
            recruit = self.recruits[number]
            needed = frozenset([port.wanted for port in self.problem.supply.required[number]])
            issued = frozenset([(output.signals, output[BESIDES_TYPES:]) for output in recruit.profile.outputs])
            key = needed, issued, recruit.roles
            if key not in known:
                known.add(key)
                yield number

    def _suppliers(self, port: Input, role: int | None = None) -> tuple[int, ...]:
        """The usable recruits that could feed an input, of a player of a role or of a recruit; one tuple for equals."""
        key = port.wanted, role
        if key not in self._known:
            found = set(self._issued.serving(port.wanted))
            self._known[key] = tuple(sorted(one for one in found if role is None or role in self.recruits[one].roles))
        return self._known[key]

    def _needs_by_supplier(self) -> dict[int, list[Suppliers]]:
        """For each recruit the choices of suppliers that it is among."""
        found: dict[int, list[Suppliers]] = {}
        for suppliers in {id(need.suppliers): need.suppliers for need in self._every_need()}.values():
            for number in suppliers:
                found.setdefault(number, []).append(suppliers)
        return found

    def _every_need(self) -> Iterator[UnfedInput]:
        """The needs of players, then those of recruits."""
        return chain(self.wanted, *self.needs.values())

    def _wanted(self) -> Iterator[UnfedInput]:
        """The required inputs of players that no role feeds."""
        fed = {(connection.sink, connection.input) for connection in self.plain.connections}
        for component, (role, profile) in self.players.items():
            for port in profile.required:
                if (component, port.name) not in fed:
                    yield UnfedInput(component, port, self._suppliers(port, role))

    def _needs_of_recruits(self) -> Iterator[tuple[int, list[UnfedInput]]]:
        """The recruits from which a chain of suppliers leads to a player, each with what it needs of others."""
        waiting = [number for need in self.wanted for number in need.suppliers]
        seen = set(waiting)
        looked_at = {id(need.suppliers) for need in self.wanted}
        while waiting:
            number = waiting.pop()
            component = self.recruits[number].component
            ports = [port for port in self.problem.supply.required[number] if self._source_among_players(port) is None]
            needs = [UnfedInput(component, port, self._suppliers(port)) for port in ports]
            yield number, needs
            for suppliers in (need.suppliers for need in needs if id(need.suppliers) not in looked_at):
                looked_at.add(id(suppliers))
                more = [one for one in suppliers if one not in seen]
                seen.update(more)
                waiting += more

    def _source_among_players(self, port: Input) -> tuple[IRI, Output] | None:
        """The first output of a player that could feed an input."""
        wanted = port.wanted
        if wanted not in self._from_players:
            issued = ((component, out) for component, (_, profile) in self.players.items() for out in profile.outputs)
            pairs = self.problem.hierarchy.pairs
            self._from_players[wanted] = next((source for source in issued if pairs(source[1], port)), None)
        return self._from_players[wanted]

    def ordered(self, numbers: Iterable[int]) -> list[int]:
        """Recruits in the order in which they are chosen: those that run, then by preference and IRI."""
        if not self.running:
            return sorted(numbers)
        return sorted(numbers, key=lambda number: (self.recruits[number].component not in self.running, number))

    def placed(self, chosen: Collection[int]) -> list[int]:
        """The chosen recruits that are fed without a cycle among them, each after those that feed it."""
        place = {number: at for at, number in enumerate(self.ordered(chosen))}
        waiting: dict[int, list[int]] = {}
        lacking: dict[int, int] = {}
        for number in place:
            choices = {id(need.suppliers) for need in self.needs[number]}
            lacking[number] = len(choices)
            for choice in choices:
                waiting.setdefault(choice, []).append(number)
        order = list(place)
        ready = [place[number] for number, count in lacking.items() if not count]
        found: list[int] = []
        while ready:
            number = order[heappop(ready)]
            found.append(number)
            for suppliers in self._feeds.get(number, ()):
                for fed in waiting.pop(id(suppliers), ()):
                    lacking[fed] -= 1
                    if not lacking[fed]:
                        heappush(ready, place[fed])
        return found

    def sufficient(self, chosen: Collection[int]) -> bool:
        """Whether chosen recruits feed all needs, their own included."""
        placed = set(self.placed(chosen))
        return len(placed) == len(chosen) and all(placed.intersection(need.suppliers) for need in self.wanted)

    def chain(self) -> list[int]:
        """Recruits that are enough: for each need the supplier that takes the fewest, with all that feed it in turn."""
        return self._least_chains().joined(self.wanted)

    def exchanged(self, chosen: Collection[int], number: int) -> list[int] | None:
        """Recruits that are enough without one of those chosen, of which the others cost nothing; None if none are."""
        chains = self._least_chains(frozenset(chosen) - {number}, number)
        return chains.joined(self.wanted) if all(id(need.suppliers) in chains.least for need in self.wanted) else None

    def _least_chains(self, free: Set[int] = frozenset(), without: int | None = None) -> LeastChains:
        """For choices of suppliers a short chain that ends in one of them.

        For each choice of a player, and for each that is settled before them.

        Its length, without those that are free, is the cost of a need; that of a recruit is the number of all in the
        chains of its needs, each counted once (the set-additive heuristic of Keyder and Geffner, ECAI 2008), by the
        generalisation of Dijkstra's algorithm by Knuth (1977). What is settled has a chain of what was settled before
        it, so there is no cycle in one.
        """
        place, lacking = self._place, dict(self._lacking)
        order: list[int] = []
        costly = 0
        """Those in the order that are not free."""
        feeding: dict[int, int] = {}
        """For recruits that are not settled, those that feed them."""
        settled = [(0, place[number], number) for number, count in lacking.items() if not count and number != without]
        heapify(settled)
        least: dict[int, int] = {}
        unmet = {id(need.suppliers) for need in self.wanted}
        while settled and unmet:
            number = heappop(settled)[2]
            itself = 1 << len(order)
            order.append(number)
            costly |= 0 if number in free else itself
            whole = feeding.pop(number, 0) | itself
            for suppliers in self._feeds.get(number, ()):
                if id(suppliers) in least:
                    continue
                least[id(suppliers)] = whole
                unmet.discard(id(suppliers))
                for fed in self._consumers.get(id(suppliers), ()):
                    feeding[fed] = feeding.get(fed, 0) | whole
                    lacking[fed] -= 1
                    if not lacking[fed] and fed != without:
                        cost = (feeding[fed] & costly).bit_count() + (fed not in free)
                        heappush(settled, (cost, place[fed], fed))
        return LeastChains(least, order)

    def without_spare(self, chosen: Sequence[int]) -> list[int]:
        """Recruits without those that can be spared, the last by preference first."""
        left, before = self.ordered(chosen), -1
        # Again until nothing goes: once one is spared, those that fed it alone can be spared as well.
        while len(left) != before:
            before = len(left)
            for number in reversed(left):
                fewer = [other for other in left if other != number]
                if not self._only_supplier(number, set(fewer)) and self.sufficient(fewer):
                    left = fewer
        return left

    def reduced(self) -> tuple[ReducedProblem, list[int]]:
        """The choice as options of a role without slots, in the order in which they are chosen, and needs of players.

        The needs are the choices of suppliers, by number.
        """
        choices = dict.fromkeys(id(need.suppliers) for need in self._every_need())
        number = {key: place for place, key in enumerate(choices)}
        options = [
            Option(
                one,
                NO_COMPONENT,
                InterchangeabilityClass(
                    0,
                    tuple(dict.fromkeys(number[id(need.suppliers)] for need in self.needs[one])),
                    tuple(number[id(suppliers)] for suppliers in self._feeds.get(one, ())),
                    (),
                    one,
                ),
            )
            for one in self.ordered(self.needs)
        ]
        needs = Needs(Need(NeedScope(0, (Feeder(0),)), UNSAID) for _ in number)
        wanted = list(dict.fromkeys(number[id(need.suppliers)] for need in self.wanted))
        return ReducedProblem((), (tuple(options),), needs, ()), wanted

    def _only_supplier(self, number: int, others: set[int]) -> bool:
        """Whether a need of a player, or of others that are chosen, has no supplier but this recruit."""
        wanted = {id(need.suppliers) for need in self.wanted}
        return any(
            others.isdisjoint(suppliers)
            and (id(suppliers) in wanted or not others.isdisjoint(self._consumers.get(id(suppliers), ())))
            for suppliers in self._feeds.get(number, ())
        )

    def configuration(self, chosen: Collection[int]) -> Configuration:
        """The configuration with chosen recruits; each input has the first source, players coming before recruits."""
        placed: list[int] = []
        found: list[Connection] = []
        for number in self.placed(chosen):
            profile = self.recruits[number].profile
            for port in self.problem.supply.required[number]:
                source = self._source_among_players(port) or self._source(port, placed, None)
                found.append(Connection(source[0], source[1].name, profile.component, port.name))
            placed.append(number)
        for need in self.wanted:
            role, _ = self.players[need.component]
            component, output = self._source(need.port, placed, role)
            found.append(Connection(component, output.name, need.component, need.port.name))
        recruits = tuple(self.recruits[number].component for number in sorted(placed))
        whole = replace(self.plain, recruits=recruits)
        return replace(whole, connections=ordered_connections((*self.plain.connections, *found), whole.components))

    def _source(self, port: Input, placed: Sequence[int], role: int | None) -> tuple[IRI, Output]:
        """The first recruit of those placed, by preference, that feeds an input, with its output."""
        suppliers = set(self._suppliers(port, role))
        profile = self.recruits[self.ordered(suppliers.intersection(placed))[0]].profile
        output = next(output for output in profile.outputs if self.problem.hierarchy.pairs(output, port))
        return profile.component, output


def players_of(problem: Problem, configuration: Configuration) -> Iterator[tuple[IRI, tuple[int, Profile]]]:
    """Each player of a configuration with the number of its role and its profile."""
    for role, assignment in enumerate(configuration.assignments):
        profiles = {candidate.profile.component: candidate.profile for candidate in problem.candidates[role]}
        for component in assignment.components:
            yield component, (role, profiles[component])
