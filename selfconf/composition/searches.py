"""The answers to a problem by a strategy: players with their recruits, and with the optional roles that it takes.

A strategy finds players (`search.strategies`), or what keeps most of what runs (`search.reconfigure`). Recruits are
found for these; where they have none, the first players that have some are. Where there is no configuration, optional
roles are asked for. The strategy `best` chooses players and recruits together.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from enum import Enum

from selfconf.model.configuration import Configuration
from selfconf.model.optimum import Optimum, outcome_of
from selfconf.model.refusal import Outcome, Refusal, Undecided
from selfconf.search.additions import with_additions
from selfconf.search.problem import Problem
from selfconf.search.reconfigure import Reconfiguration, nearest, nearest_configuration
from selfconf.search.recruiting import RECRUIT_STEPS, REPAIR_STEPS, first_recruited, recruited, refusal_of_recruits
from selfconf.search.strategies import BEST_STEPS, algorithm_1, answers, best_configuration

SLICES = (10_000, 200_000, BEST_STEPS)
"""Steps after which the strategy `best` tells how far it has come, and begins again with more."""


class Strategy(str, Enum):
    """How to search; all but `BEST` give the lexicographically first configuration."""

    FIRST = "first"
    PAPER = "paper"
    BEST = "best"


AnswersOf = Callable[[Problem, Configuration | None], Iterator[Optimum | Outcome]]
"""Answers to a problem, with a configuration that runs or without; the last one holds."""


class Searches:
    """How the problems of one task are searched: by a strategy, within a number of steps for each search."""

    def __init__(self, strategy: Strategy, steps: int | None = None) -> None:
        self.strategy, self.steps = strategy, steps

    def answers(self, problem: Problem, running: Configuration | None = None) -> Iterator[Optimum | Outcome]:
        """Yield better and better answers to a problem, beside what runs; the last one holds."""
        yield from self._with_additions(self._search, problem, running)

    def after(self, problem: Problem, running: Configuration) -> Configuration | Refusal | Undecided:
        """Return what comes after a configuration that runs, as a running configurator would decide it."""
        *_, found = self.answers(problem, running)
        return outcome_of(found)

    def _with_recruits(
        self, problem: Problem, found: Iterator[Optimum | Outcome], running: Configuration | None
    ) -> Iterator[Optimum | Outcome]:
        """Answers with the recruits that they need; where there are none, the first answer that has some."""
        for answer in found:
            if not isinstance(answer, Configuration) or not any(role.recruits for role in problem.roles):
                yield answer
                continue
            steps = self.steps or (RECRUIT_STEPS if running is None else REPAIR_STEPS)
            whole = recruited(problem, answer, running, steps)
            other = first_recruited(problem, steps, running) if whole is None else whole[0]
            yield refusal_of_recruits(problem) if other is None else other

    def _with_additions(
        self, search: AnswersOf, problem: Problem, running: Configuration | None
    ) -> Iterator[Optimum | Outcome]:
        """The answers of a search; where there is no configuration, with the optional roles that it takes."""
        asked = False
        for answer in search(problem, running):
            if isinstance(answer, Refusal) and not asked:  # one without reasons comes before the one that has them
                asked, raised = True, with_additions(problem, self.steps)
                if raised is not None:
                    yield from (raised,) if isinstance(raised, Undecided) else search(raised, running)
                    return
            yield answer

    def _search(self, problem: Problem, running: Configuration | None) -> Iterator[Optimum | Outcome]:
        found = self._best if self.strategy is Strategy.BEST else self._first_or_nearest
        # The best are chosen together with their recruits.
        yield from self._with_recruits(problem, found(problem, running), running)

    def _first_or_nearest(self, problem: Problem, running: Configuration | None) -> Iterator[Outcome]:
        found = algorithm_1(problem, self.steps) if self.strategy is Strategy.PAPER else None
        if found is not None:
            yield found
        elif running is None or self.strategy is Strategy.PAPER:
            yield from answers(problem, self.steps)
        elif self.steps is None:
            yield nearest_configuration(problem, running)
        else:
            *_, whole = answers(problem, self.steps)
            near = nearest(problem, running, self.steps) if isinstance(whole, Configuration) else whole
            yield near.configuration if isinstance(near, Reconfiguration) else near

    def _best(self, problem: Problem, running: Configuration | None) -> Iterator[Optimum | Outcome]:
        most = SLICES[-1] if self.steps is None else self.steps
        for steps in (*(slice_ for slice_ in SLICES if slice_ < most), most):
            found = best_configuration(problem, steps, running)
            yield found
            if isinstance(found, Refusal) or (isinstance(found, Optimum) and found.proved and found.first):
                return
        if isinstance(found, Undecided) and self.steps is None:
            yield from answers(problem)
