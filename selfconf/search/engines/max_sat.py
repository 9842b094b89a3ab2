"""Weighted MaxSAT guided by unsatisfiable cores: the algorithm OLL (Andres et al., ICLP 2012; RC2, JSAT 2019).

Assume that no literal with a weight holds. As long as that cannot be, the solver names a *core*: some of the literals,
of which one at least must hold. The least weight in it is then unavoidable: it is added to the bound and taken off
each; that a second one of the core holds becomes a literal with that weight of its own (an output of a totalizer),
and so on. When all can be assumed, the bound is the least weight, and the assumptions describe exactly the solutions
that have it. Heavy literals are assumed before light ones (stratification), so that models come early and cores with
much weight first.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import ExitStack
from typing import Any, NamedTuple

from selfconf.model.refusal import Undecided
from selfconf.search.budget import Budget
from selfconf.search.engines.clause_learning import ClauseSolver
from selfconf.search.reduction import Option

TRIMS = 3
"""How often a smaller core is asked for."""


class Minimum(NamedTuple):
    """A lower bound of the weight of all models, whether a model has it, and the lightest solution that was met."""

    bound: int
    proved: bool
    lightest: list[Option] | None


def minimise(clauses: ClauseSolver, weights: Mapping[int, int], budget: Budget) -> Minimum:
    """Return the least weight of a model, or what is known of it when the budget ends.

    Once the least weight is proved, the clauses are narrowed to the models that have it, and the last model is one of
    them.
    """
    with ExitStack() as stack:
        return _Cores(clauses, weights, budget, stack).run()


class _Cores:
    def __init__(self, clauses: ClauseSolver, weights: Mapping[int, int], budget: Budget, stack: ExitStack) -> None:
        self.clauses, self.budget, self.stack = clauses, budget, stack
        self.stated = {literal: weight for literal, weight in weights.items() if weight > 0}
        self.weights = dict(self.stated)
        """What is left of the weights, with those of the totalizers."""
        self.lightest: tuple[int, list[Option]] | None = None
        self.counters: dict[int, tuple[Any, int]] = {}
        """For each output of a totalizer: of which one it is, and how many literals must hold for it."""
        self.bound = 0

    def run(self) -> Minimum:
        """Process cores until there are none, stratum by stratum."""
        for heavy in self._strata():
            while True:
                active = [literal for literal, weight in self.weights.items() if weight >= heavy]
                answer = self.clauses.solve([-literal for literal in active], self.budget)
                if isinstance(answer, Undecided):
                    return Minimum(self.bound, proved=False, lightest=self.lightest[1] if self.lightest else None)
                if answer:
                    self._meet()
                    break
                self._process(self._trimmed())
        for literal in self.weights:
            self.clauses.add([-literal])
        return Minimum(self.bound, proved=True, lightest=self.clauses.chosen())

    def _meet(self) -> None:
        """Remember the last model if none before it is lighter: a lower stratum may have heavier models than this."""
        weight = sum(weight for literal, weight in self.stated.items() if self.clauses.holds(literal))
        if self.lightest is None or weight < self.lightest[0]:
            self.lightest = weight, self.clauses.chosen()

    def _strata(self) -> Iterator[int]:
        """Yield falling limits of weight, each about half of the one before, down to all that is left."""
        heavy = max(self.weights.values(), default=1)
        while True:
            yield heavy
            if heavy == 1 or all(weight >= heavy for weight in self.weights.values()):
                return
            heavy = max(1, min(heavy // 2, max(w for w in self.weights.values() if w < heavy)))

    def _trimmed(self) -> list[int]:
        """Return the last core, made smaller by asking for a core of it again: a small one raises the bound more."""
        core = self.clauses.core()
        for _ in range(TRIMS):
            if len(core) < 3 or self.clauses.solve(sorted(core), self.budget) is not False:
                break
            smaller = self.clauses.core()
            if len(smaller) >= len(core):
                break
            core = smaller
        return sorted(-literal for literal in core)

    def _process(self, core: list[int]) -> None:
        """Move the least weight of a core from its literals to the bound, and count how many of them hold."""
        least = min(self.weights[literal] for literal in core)
        self.bound += least
        for literal in core:
            if literal in self.counters:
                self._next_output(literal, least)
            self.weights[literal] -= least
            if not self.weights[literal]:
                del self.weights[literal]
        if len(core) == 1:
            self.clauses.add(core)
        else:
            counter = self.clauses.counter(core, self.stack)
            self._soft(counter, 2, least)

    def _next_output(self, literal: int, weight: int) -> None:
        counter, number = self.counters[literal]
        if number < len(counter.lits):
            self._soft(counter, number + 1, weight)

    def _soft(self, counter: Any, number: int, weight: int) -> None:
        """Give this weight to the output of a totalizer that a number of its literals hold."""
        output = self.clauses.at_least(counter, number)
        self.counters[output] = counter, number
        self.weights[output] = self.weights.get(output, 0) + weight
