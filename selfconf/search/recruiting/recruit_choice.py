"""The recruits among which there is a choice: which are usable, what leads to a need, and what some are enough for."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Container, Iterable, Iterator, Mapping, Sequence, Set
from fractions import Fraction
from functools import reduce
from heapq import heapify, heappop, heappush
from itertools import chain
from operator import or_
from typing import NamedTuple

from selfconf.model.configuration import Configuration, Connection, ordered_connections
from selfconf.model.immutable import replace
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
from selfconf.search.supply import Issuers

Price = Callable[[int], tuple[Fraction, ...]]
"""What a recruit costs, by its number, level by level."""
UNSAID = Input("", ())
"""What a choice of suppliers is wanted for, where its number says all."""


class Suppliers:
    """The components of which one has to feed an input; one object for all inputs that want the same."""

    __slots__ = ("consumers", "issuers")

    def __init__(self, issuers: Iterable[Issuers]) -> None:
        self.issuers = tuple(issuers)
        self.consumers: list[int] = []
        """The numbers of the recruits with an input that one of these components has to feed."""


class UnfedInput(NamedTuple):
    """An input of a player that recruits have to feed."""

    component: IRI
    port: Input
    suppliers: Suppliers


class LeastChains(NamedTuple):
    """For suppliers a short chain of recruits that ends in one of them."""

    least: Mapping[Suppliers, int]
    """Which recruits are in the chain; bit k is the one at place k of the order."""
    order: Sequence[int]

    def joined(self, needs: Iterable[UnfedInput]) -> list[int]:
        """The recruits of the chains of some needs, sorted."""
        whole = reduce(or_, (self.least[need.suppliers] for need in needs), 0)
        return sorted(number for place, number in enumerate(self.order) if whole >> place & 1)


class RecruitChoice:
    """The recruits that matter to the players of one configuration, and what they could feed."""

    def __init__(
        self,
        problem: Problem,
        configuration: Configuration,
        running: Collection[IRI],
        among: Collection[int] | None = None,
        price: Price | None = None,
        busy: Collection[IRI] = (),
    ) -> None:
        """`among` are the only recruits that are looked at, where some were chosen by what else they are worth.

        By its `price`, if there is one, a recruit comes before others rather than because it runs or is preferred.
        Those that are `busy` in a role, which they might keep, come after others.
        """
        self.problem, self.plain, self.running, self._price = problem, configuration, running, price
        self._busy = frozenset(busy)
        self.players = dict(players_of(problem, configuration))
        self.recruits: Sequence[Recruit] = problem.supply.recruits
        outputs = [output for _, profile in self.players.values() for output in profile.outputs]
        # Without the players, which issue the same as recruits, so that they make no recruit usable.
        usable = (one for one in problem.supply.usable(outputs) if self.recruits[one].component not in self.players)
        if among is None:
            looked_at = self._undominated(self.ordered(usable))
        else:
            looked_at = filter(frozenset(among).__contains__, usable)
        self._issued = problem.supply.issued(looked_at)
        self._known: dict[tuple[WantedSignal, int | None], Suppliers] = {}
        self._served: dict[Issuers, list[Suppliers]] = {}
        """For the components that issue the same, the choices of suppliers that they are among."""
        self._from_players: dict[WantedSignal, tuple[IRI, Output] | None] = {}
        self.wanted = list(self._wanted())
        self.needs = dict(self._needs_of_recruits())
        """For each recruit that matters, the suppliers of each input that no player feeds."""
        self._place = {number: at for at, number in enumerate(self.ordered(self.needs))}
        self._lacking = {number: len(needs) for number, needs in self.needs.items()}
        for number, needs in self.needs.items():
            for suppliers in needs:
                suppliers.consumers.append(number)

    @property
    def possible(self) -> bool:
        """Whether each need of the players has a usable supplier; then each need of these has one, too."""
        return all(need.suppliers.issuers for need in self.wanted)

    @property
    def number_of_suppliers(self) -> int:
        """How many recruits could feed each input, all inputs that want different together."""
        return sum(len(one.members) for suppliers in self._known.values() for one in suppliers.issuers)

    def _undominated(self, ordered: Iterable[int]) -> Iterator[int]:
        """Yield of recruits in their order the first of those that need the same and issue the same for the same roles.

        In any solution it can take the place of another of them; both of them are one too many.
        """
        known: set[tuple[object, ...]] = set()
        for number in ordered:
            needed = frozenset([port.wanted for port in self.problem.supply.required[number]])
            key = needed, frozenset(self.problem.supply.outputs(number)), self.recruits[number].roles
            if key not in known:
                known.add(key)
                yield number

    def _suppliers(self, wanted: WantedSignal, role: int | None = None) -> Suppliers:
        """The components that could feed an input, of a player of a role or of a recruit; one object for equals."""
        key = wanted, role
        known = self._known.get(key)
        if known is None:
            known = self._known[key] = Suppliers(self._issued.serving(wanted, role))
            for issuers in known.issuers:
                self._served.setdefault(issuers, []).append(known)
        return known

    def _fed_by(self, number: int) -> Iterator[Suppliers]:
        """Yield each choice of suppliers that a recruit is among, perhaps again."""
        return chain.from_iterable(self._served.get(issuers, ()) for issuers in self._issued.by_recruit[number])

    def _served_by(self, issuers: Iterable[Issuers], known: Container[Suppliers]) -> list[Suppliers]:
        """Return the choices of suppliers, but for those known, that some components which issue the same are among."""
        found = dict.fromkeys(chain.from_iterable(self._served.get(one, ()) for one in issuers))
        return [suppliers for suppliers in found if suppliers not in known]

    def _wanted(self) -> Iterator[UnfedInput]:
        """The required inputs of players that no role feeds."""
        fed = {(connection.sink, connection.input) for connection in self.plain.connections}
        for component, (role, profile) in self.players.items():
            for port in profile.required:
                if (component, port.name) not in fed:
                    yield UnfedInput(component, port, self._suppliers(port.wanted, role))

    def _needs_of_recruits(self) -> Iterator[tuple[int, tuple[Suppliers, ...]]]:
        """The recruits from which a chain of suppliers leads to a player, each with what it needs of others."""
        required, needs_of = self.problem.supply.required, dict[WantedSignal, tuple[Suppliers, ...]]()
        waiting = list(dict.fromkeys(issuers for need in self.wanted for issuers in need.suppliers.issuers))
        seen, numbers = set(waiting), set[int]()
        while waiting:
            for number in waiting.pop().members:
                if number in numbers:
                    continue
                numbers.add(number)
                needs: list[Suppliers] = []
                for port in required[number]:
                    wanted = port.wanted
                    known = needs_of.get(wanted)
                    if known is None:
                        fed = self._source_among_players(port) is not None
                        known = needs_of[wanted] = () if fed else (self._suppliers(wanted),)
                        more = [one for some in known for one in some.issuers if one not in seen]
                        seen.update(more)
                        waiting += more
                    needs += known
                yield number, tuple(dict.fromkeys(needs))

    def _source_among_players(self, port: Input) -> tuple[IRI, Output] | None:
        """The first output of a player that could feed an input."""
        wanted = port.wanted
        if wanted not in self._from_players:
            issued = ((component, out) for component, (_, profile) in self.players.items() for out in profile.outputs)
            pairs = self.problem.hierarchy.pairs
            self._from_players[wanted] = next((source for source in issued if pairs(source[1], port)), None)
        return self._from_players[wanted]

    def ordered(self, numbers: Iterable[int]) -> list[int]:
        """Recruits in the order in which they are chosen: by price, then those that run, by preference and IRI."""
        if self._price is None and not self.running and not self._busy:
            return sorted(numbers)
        return sorted(numbers, key=self._rank)

    def _rank(self, number: int) -> tuple[tuple[Fraction, ...], bool, bool, int]:
        prices, component = () if self._price is None else self._price(number), self.recruits[number].component
        return prices, component not in self.running, component in self._busy, number

    def placed(self, chosen: Collection[int]) -> list[int]:
        """The chosen recruits that are fed without a cycle among them, each after those that feed it."""
        place = {number: at for at, number in enumerate(self.ordered(chosen))}
        waiting: dict[Suppliers, list[int]] = {}
        lacking: dict[int, int] = {}
        for number in place:
            lacking[number] = len(self.needs[number])
            for suppliers in self.needs[number]:
                waiting.setdefault(suppliers, []).append(number)
        order = list(place)
        ready = [place[number] for number, count in lacking.items() if not count]
        found: list[int] = []
        while ready:
            number = order[heappop(ready)]
            found.append(number)
            for suppliers in self._fed_by(number):
                for fed in waiting.pop(suppliers, ()):
                    lacking[fed] -= 1
                    if not lacking[fed]:
                        heappush(ready, place[fed])
        return found

    def sufficient(self, chosen: Collection[int]) -> bool:
        """Whether chosen recruits feed all needs, their own included."""
        placed = self.placed(chosen)
        issuing = self._issuing(placed)
        return len(placed) == len(chosen) and not any(
            issuing.isdisjoint(need.suppliers.issuers) for need in self.wanted
        )

    def _issuing(self, numbers: Iterable[int]) -> set[Issuers]:
        return {issuers for number in numbers for issuers in self._issued.by_recruit[number]}

    def chain(self) -> list[int]:
        """Recruits that are enough: for each need the supplier that takes the fewest, with all that feed it in turn."""
        return self._least_chains().joined(self.wanted)

    def exchanged(self, chosen: Collection[int], number: int) -> list[int] | None:
        """Recruits that are enough without one of those chosen, of which the others cost nothing; None if none are."""
        chains = self._least_chains(frozenset(chosen) - {number}, number)
        return chains.joined(self.wanted) if all(need.suppliers in chains.least for need in self.wanted) else None

    def _least_chains(self, free: Set[int] = frozenset(), without: int | None = None) -> LeastChains:
        """For suppliers a short chain that ends in one of them: for those of players, and those settled before them.

        Its length, without those that are free, is the cost of a need; that of a recruit is the number of all in the
        chains of its needs, each counted once (the set-additive heuristic of Keyder and Geffner, ECAI 2008), by the
        generalisation of Dijkstra's algorithm by Knuth (1977). What is settled has a chain of what was settled before
        it, so there is no cycle in one.
        """
        place, lacking = self._place, dict(self._lacking)
        order: list[int] = []
        costly = 0
        """The recruits of the order that are not free, as bits."""
        feeding: dict[int, int] = {}
        """For recruits that are not settled, those that feed them."""
        settled = [(0, place[number], number) for number, count in lacking.items() if not count and number != without]
        heapify(settled)
        least: dict[Suppliers, int] = {}
        unmet = {need.suppliers for need in self.wanted}
        issued: set[Issuers] = set()
        while settled and unmet:
            number = heappop(settled)[2]
            itself = 1 << len(order)
            order.append(number)
            costly |= 0 if number in free else itself
            whole = feeding.pop(number, 0) | itself
            fresh = [issuers for issuers in self._issued.by_recruit[number] if issuers not in issued]
            issued.update(fresh)
            for suppliers in self._served_by(fresh, least):
                least[suppliers] = whole
                unmet.discard(suppliers)
                for fed in suppliers.consumers:
                    feeding[fed] = feeding.get(fed, 0) | whole
                    lacking[fed] -= 1
                    if not lacking[fed] and fed != without:
                        cost = (feeding[fed] & costly).bit_count() + (fed not in free)
                        heappush(settled, (cost, place[fed], fed))
        return LeastChains(least, order)

    def without_spare(self, chosen: Sequence[int]) -> list[int]:
        """Recruits without those that can be spared, the last by preference first."""
        left = dict.fromkeys(self.ordered(chosen))
        feeds = {number: frozenset(self._fed_by(number)) for number in left}
        feeding = Counter(chain.from_iterable(feeds.values()))
        needed = Counter(chain((need.suppliers for need in self.wanted), *(self.needs[number] for number in left)))
        before = -1
        # Again until nothing goes: once one is spared, those that fed it alone can be spared as well.
        while len(left) != before:
            before = len(left)
            for number in reversed(list(left)):
                own = self.needs[number]
                if any(feeding[one] == 1 and needed[one] > (one in own) for one in feeds[number]):
                    continue  # it alone feeds a need of a player, or of another
                if self.sufficient([other for other in left if other != number]):
                    del left[number]
                    feeding.subtract(feeds[number])
                    needed.subtract(own)
        return list(left)

    def reduced(self) -> tuple[ReducedProblem, list[int]]:
        """The choice as options of a role without slots, in the order in which they are chosen, and needs of players.

        Each need stands for suppliers, of which one has to be chosen.
        """
        every = chain((need.suppliers for need in self.wanted), *self.needs.values())
        number = {suppliers: place for place, suppliers in enumerate(dict.fromkeys(every))}
        options = [
            Option(
                one,
                NO_COMPONENT,
                InterchangeabilityClass(
                    0,
                    tuple(number[suppliers] for suppliers in self.needs[one]),
                    tuple(sorted({number[suppliers] for suppliers in self._fed_by(one)})),
                    {},
                    one,
                ),
            )
            for one in self.ordered(self.needs)
        ]
        needs = Needs(Need(NeedScope(0, (Feeder(0),)), UNSAID) for _ in number)
        wanted = list(dict.fromkeys(number[need.suppliers] for need in self.wanted))
        return ReducedProblem((), (tuple(options),), needs, ()), wanted

    def configuration(self, chosen: Collection[int]) -> Configuration:
        """The configuration with chosen recruits; each input has the first source, players coming before recruits."""
        placed: dict[Issuers, list[int]] = {}
        found: list[Connection] = []
        order = self.placed(chosen)
        for number in order:
            profile = self.recruits[number].profile
            for port in self.problem.supply.required[number]:
                source = self._source_among_players(port) or self._source(port, placed, None)
                found.append(Connection(source[0], source[1].name, profile.component, port.name))
            for issuers in self._issued.by_recruit[number]:
                placed.setdefault(issuers, []).append(number)
        for need in self.wanted:
            role, _ = self.players[need.component]
            component, output = self._source(need.port, placed, role)
            found.append(Connection(component, output.name, need.component, need.port.name))
        recruits = tuple(self.recruits[number].component for number in sorted(order))
        whole = replace(self.plain, recruits=recruits)
        return replace(whole, connections=ordered_connections((*self.plain.connections, *found), whole.components))

    def _source(self, port: Input, placed: Mapping[Issuers, Sequence[int]], role: int | None) -> tuple[IRI, Output]:
        """The first recruit of those placed, by preference, that feeds an input, with its output."""
        serving = self._suppliers(port.wanted, role).issuers
        first = self.ordered(number for issuers in serving for number in placed.get(issuers, ()))[0]
        profile = self.recruits[first].profile
        output = next(output for output in profile.outputs if self.problem.hierarchy.pairs(output, port))
        return profile.component, output


def players_of(problem: Problem, configuration: Configuration) -> Iterator[tuple[IRI, tuple[int, Profile]]]:
    """Each player of a configuration with the number of its role and its profile."""
    for role, assignment in enumerate(configuration.assignments):
        profiles = {candidate.profile.component: candidate.profile for candidate in problem.candidates[role]}
        for component in assignment.components:
            yield component, (role, profiles[component])
