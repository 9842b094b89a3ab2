"""A clause-learning solver for players and recruits together: recruits never feed each other in a circle.

The clauses say that each need of what is chosen has a support that is chosen; that allows recruits that only feed each
other. So each model is checked by forward chaining from the players, and recruits that are left over are excluded by
their loop formula: one of them has all of its needs supported from outside of them (Lin and Zhao, 2004). It holds in
every solution, so that nothing that the solver has learned is lost.

Where the weight of a recruit may be below zero, one that can be spared would be worth taking. `irredundant` excludes
models with such recruits: the players, and those recruits that are enough beside it, imply that it is not chosen.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from types import MappingProxyType

from selfconf.model.term import IRI
from selfconf.search.budget import Budget
from selfconf.search.engines.clause_learning import ClauseSolver
from selfconf.search.reduction import Distinct, Option, ReducedProblem

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
        self._supporting: dict[int, list[int]] = {}
        """For each need the literals of what supports it."""
        self._suppliers: dict[int, set[int]] = {}
        """For each need the recruits that support it, by number."""
        for literal, option in (*self._players, *zip(self.plays[-1], reduced.options[-1], strict=True)):
            for need in option.kind.supports:
                self._supporting.setdefault(need, []).append(literal)
        for number, option in self._option.items():
            for need in option.kind.supports:
                self._suppliers.setdefault(need, set()).add(number)
        for need in wanted:
            self.add(self._supporting.get(need, ()))
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
            chosen = self.recruited()
            playing = [option for literal, option in self._players if self.holds(literal)]
            circular = set(chosen).difference(self._placed(playing, chosen))
            if circular:
                self._exclude(circular)
            elif not self.irredundant or not self._exclude_spare(playing, chosen):
                return True
            self._model = kept
            if budget.steps == 0:
                return None
        return found

    def recruited(self) -> list[int]:
        """Return the recruits of the last model, by number."""
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

    def _exclude(self, circle: set[int]) -> None:
        """Add the loop formula of recruits that only feed each other."""
        outside: list[int] = []
        for number in sorted(circle):
            fed = self.literal()
            outside.append(fed)
            inside = {self.recruits[one] for one in circle}
            for need in self._option[number].kind.needs:
                self.add([-fed, *(one for one in self._supporting.get(need, ()) if one not in inside)])
        for number in circle:
            self.add([-self.recruits[number], *outside])

    def _exclude_spare(self, playing: Sequence[Option], chosen: Sequence[int]) -> bool:
        """Exclude a recruit that can be spared, beside others that are enough; return whether there is one."""
        enough = self.without_spare(playing, chosen)
        spare = next((one for one in chosen if one not in enough), None)
        if spare is None:
            return False
        players = [literal for literal, option in self._players if option in playing]
        self.add([-literal for literal in (*players, *(self.recruits[one] for one in (*enough, spare)))])
        return True

    def without_spare(self, playing: Sequence[Option], chosen: Sequence[int]) -> list[int]:
        """Return chosen recruits that are enough for players, and of which none can be spared; the last goes first."""
        left = list(chosen)
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
