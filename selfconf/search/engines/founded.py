"""A clause-learning solver for players and recruits together: recruits never feed each other in a circle.

The clauses say that each need of what is chosen has a support that is chosen; that allows recruits that only feed each
other. So each model is checked by forward chaining from the players. Where that does not meet what a player needs, the
chosen are extended by all that can be added without meeting it: one of those left out has to be chosen, too. Such a
*landmark* is short, holds in every solution, and says more than that a circle is none: choosing the fewest recruits is
planning without deletions, for which hitting all landmarks is the method of choice (Bonet and Helmert, ECAI 2010;
Haslum, Slaney and Thiebaux, ICAPS 2012). What is chosen and not fed is no recruit of the model.

Where the weight of a recruit may be below zero, one that can be spared would be worth taking. `irredundant` excludes
models with such recruits: the players, and those recruits that are enough beside it, imply that it is not chosen.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from copy import copy
from types import MappingProxyType

from selfconf.model.term import IRI
from selfconf.search.budget import Budget
from selfconf.search.engines.clause_learning import ClauseSolver
from selfconf.search.reduction import Distinct, Fed, Option, ReducedProblem

INPUTS_PER_STEP = 200
"""How many inputs of recruits are looked at, to find a landmark, in about the time of a conflict of the solver."""
EVERYONE_APART: Mapping[IRI, int] = MappingProxyType({})
"""No component that could be a player could be recruited."""


class FoundedSolver(ClauseSolver):
    """The solver of a reduced problem whose last role is that of the recruits; use it in a `with` statement."""

    def __init__(
        self,
        reduced: ReducedProblem,
        wanted: Sequence[int] = (),
        components: Mapping[IRI, int] = EVERYONE_APART,
        irredundant: bool = False,
        guarded: bool = False,
    ) -> None:
        """`wanted` are needs that recruits have to feed beside those of options.

        `components` are those that could be players as well as recruits, with their numbers as these: each is one of
        both at most. With guards, needs of recruits have one each as well.
        """
        super().__init__(reduced, guarded)
        self.irredundant, self.wanted = irredundant, wanted
        self.recruits: dict[int, int] = dict(
            zip([option.number for option in reduced.options[-1]], self.plays[-1], strict=True)
        )
        """The literal of each recruit, by number."""
        self._option = {option.number: option for option in reduced.options[-1]}
        self._players = [
            (literal, option)
            for options, literals in zip(reduced.options[:-1], self.plays[:-1], strict=True)
            for option, literal in zip(options, literals, strict=True)
        ]
        self._all = [*self._players, *zip(self.plays[-1], reduced.options[-1], strict=True)]
        self._needing: dict[int, list[int]] = {}
        """For each need the literals of the recruits that have it."""
        for literal, option in self._all[len(self._players) :]:
            for need in option.kind.needs:
                self._needing.setdefault(need, []).append(literal)
        for need in wanted:
            self.add(literal for literal, option in self._all if need in option.kind.supports)
        for literal, option in self._players:
            if option.component in components:
                self.add([*self._one_role_each(guarded), -literal, -self.recruits[components[option.component]]])

    def _one_role_each(self, guarded: bool) -> list[int]:
        """What a clause begins with by which a component does not play and is not recruited at once."""
        if guarded and Distinct() not in self.guards:
            self.guards[Distinct()] = self.literal()
        return [-self.guards[Distinct()]] if guarded else []

    def __enter__(self) -> FoundedSolver:
        return self

    def ask(self, assumed: Sequence[int], budget: Budget, most: int | None = None) -> bool | None:
        """Return whether the clauses can hold under assumptions with recruits that are fed without a circle.

        None where that takes more conflicts than a call may, or the budget ends. The last such model is kept.
        """
        kept = self._model
        while found := super().ask(assumed, budget, most):
            playing = [option for literal, option in self._players if self.holds(literal)]
            if not self._add_landmarks(budget) and not (self.irredundant and self._exclude_spare(playing)):
                return True
            self._model = kept
            if budget.steps == 0:
                return None
        return found

    def recruited(self) -> list[int]:
        """Return the recruits of the last model, by number."""
        playing = [option for literal, option in self._players if self.holds(literal)]
        return sorted(self._placed(playing, self._chosen()))

    def _chosen(self) -> list[int]:
        return [number for number, literal in self.recruits.items() if self.holds(literal)]

    def _placed(self, playing: Iterable[Option], chosen: Collection[int]) -> set[int]:
        """Return the recruits that are fed by players, or by others that are, without a circle."""
        met = {need for option in playing for need in option.kind.supports}
        waiting, placed = set(chosen), set[int]()
        while ready := {one for one in waiting if met.issuperset(self._option[one].kind.needs)}:
            placed |= ready
            waiting -= ready
            met.update(need for one in ready for need in self._option[one].kind.supports)
        return placed

    def _add_landmarks(self, budget: Budget) -> bool:
        """Add a landmark for each need of a player that the last model does not meet; return whether there is one."""
        reach = Reach(self._all, self._needing, len(self._players))
        for literal, _ in self._all:
            if self.holds(literal):
                reach.add(literal)
        unmet = [(need, condition) for need, condition in self._asked() if need not in reach.met]
        spent = 0
        for need, condition in dict(unmet).items():
            self.add([*condition, *reach.without(need)])
            steps = reach.looks // INPUTS_PER_STEP
            budget.spend(steps - spent)
            spent = steps
            if budget.steps == 0:
                break  # one is enough to exclude the model, and where there are many recruits each takes its time
        return bool(unmet)

    def _asked(self) -> Iterator[tuple[int, tuple[int, ...]]]:
        """Yield what has to be met by the last model, with the literals of which one holds where it need not be."""
        yield from ((need, ()) for need in self.wanted)
        for literal, option in self._players:
            if self.holds(literal):
                for need in option.kind.needs:
                    guard = self.guards.get(Fed(need))
                    if guard is None or self.holds(guard):
                        yield need, (-literal,) if guard is None else (-literal, -guard)

    def _exclude_spare(self, playing: Sequence[Option]) -> bool:
        """Exclude a recruit that can be spared, beside others that are enough; return whether there is one."""
        chosen = self._chosen()
        enough = self.without_spare(playing, chosen)
        spare = next((one for one in chosen if one not in enough), None)
        if spare is None:
            return False
        players = [literal for literal, option in self._players if option in playing]
        self.add([-literal for literal in (*players, *(self.recruits[one] for one in (*enough, spare)))])
        return True

    def without_spare(self, playing: Sequence[Option], chosen: Sequence[int]) -> list[int]:
        """Return chosen recruits that are enough for players, and of which none can be spared; the last goes first."""
        placed = self._placed(playing, chosen)
        left = [number for number in chosen if number in placed]
        while True:
            for number in reversed(left):
                fewer = [one for one in left if one != number]
                if self._enough(playing, fewer):
                    left = fewer
                    break
            else:
                return left

    def _enough(self, playing: Sequence[Option], chosen: Sequence[int]) -> bool:
        met = {need for option in playing for need in option.kind.supports}
        met.update(need for one in chosen for need in self._option[one].kind.supports)
        needs = {need for option in playing for need in option.kind.needs}.union(self.wanted)
        return met.issuperset(needs) and len(self._placed(playing, chosen)) == len(chosen)


class Reach:
    """The needs that some players and recruits meet, by forward chaining; players meet what they support at once."""

    def __init__(self, every: Sequence[tuple[int, Option]], needing: Mapping[int, Sequence[int]], players: int) -> None:
        """`every` option is given with its literal, the players before all recruits."""
        self._supports = {literal: option.kind.supports for literal, option in every}
        self._lacking = {literal: 0 for literal, _ in every[:players]}
        self._lacking |= {literal: len(option.kind.needs) for literal, option in every[players:]}
        self._needing = needing
        self._added: set[int] = set()
        self._fatal: set[int] = set()
        """The needs that must not be met, and those by each of which one of these would be."""
        self.met: set[int] = set()
        self.looks = 0
        """How many inputs of recruits were looked at."""

    def add(self, literal: int) -> bool:
        """Add an option, unless a fatal need were met then; return whether it was added."""
        if not self._lacking[literal] and not self._meet(self._supports[literal]):
            return False
        self._added.add(literal)
        return True

    def without(self, need: int) -> list[int]:
        """Return options, one of which has to be added for a need to be met: all others are not enough."""
        reach = copy(self)
        reach._lacking, reach._added, reach.met = dict(self._lacking), set(self._added), set(self.met)
        reach._fatal = {need}
        found = [literal for literal in self._supports if literal not in reach._added and not reach._admitted(literal)]
        self.looks = reach.looks
        return found

    def _admitted(self, literal: int) -> bool:
        """Add an option, or learn which of the needs that it supports are fatal alone; return whether it was added.

        As more is added, what is fatal stays so: each such need is learned once, however many options support it.
        """
        if self.add(literal):
            return True
        supports = self._supports[literal]
        if self._fatal.isdisjoint(supports):
            fresh = [need for need in supports if need not in self.met]
            self._fatal.update(need for need in fresh if len(fresh) == 1 or not self._meet((need,), trial=True))
        return False

    def _meet(self, needs: Sequence[int], trial: bool = False) -> bool:
        """Meet needs, and all that follows from what was added; if that would be fatal, or for a trial, undo it.

        Return whether it is not fatal.
        """
        met: list[int] = []
        fed: list[int] = []
        waiting = [needs]
        fatal = False
        while waiting and not fatal:
            supported = waiting.pop()
            fatal = not self._fatal.isdisjoint(supported)
            for need in () if fatal else supported:
                if need in self.met:
                    continue
                self.met.add(need)
                met.append(need)
                for other in self._needing.get(need, ()):
                    self._lacking[other] -= 1
                    fed.append(other)
                    if not self._lacking[other] and other in self._added:
                        waiting.append(self._supports[other])
        self.looks += len(fed)
        if fatal or trial:
            self.met.difference_update(met)
            for other in fed:
                self._lacking[other] += 1
        return not fatal
