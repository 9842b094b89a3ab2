"""How much may be spent on the relaxations of a refusal, each of which is tried by a search.

The number of trials, of their steps and of what is read to prepare them is limited, so that a hard case may end with
fewer relaxations than there are, and says so, never with one that does not work.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TypeVar

from selfconf.model.partition import Candidate
from selfconf.model.refusal import Undecided
from selfconf.search.additions import with_optional_slots
from selfconf.search.budget import Budget
from selfconf.search.cores import READINGS, FeasibilityOracle, core
from selfconf.search.engines import any_by_clauses, least_by_clauses
from selfconf.search.problem import Problem
from selfconf.search.recruiting import possible_with_recruits
from selfconf.search.reduction import Constraint, LazyReduction, ReducedProblem
from selfconf.search.strategies import solution

TRIALS = 24
"""How many changed problems are tried for each sort of relaxation."""
TRIAL_STEPS = 100_000
"""Steps for each trial."""
RELAXATION_STEPS = 200_000
"""Steps for all trials together, to read the ports and to write down the options of what is tried included."""
PORTS_PER_TRIAL_STEP = 4
"""How many ports are read for the price of a step."""
STEPS_PER_OPTION = 2
"""How many steps are paid for an option, each time that the options are written down."""
RECRUIT_TRIAL_STEPS = 5_000
"""Steps to find recruits after one of the changes."""
HELPFUL_STEPS = 10_000
"""Steps to find out whose help a conflict needs."""

Trial = TypeVar("Trial")


class RelaxationEffort:
    """What may still be spent on all that is tried for a refusal."""

    def __init__(self, steps: int | None) -> None:
        self.budget = Budget(RELAXATION_STEPS if steps is None else min(steps, RELAXATION_STEPS))
        """The steps of all searches."""
        self.readings = Budget(READINGS)
        """The needs and supports that may be read to find out whose help a conflict needs."""
        self.stopped = False
        """Whether something was not tried, or not to its end: too little was left, or enough had been tried."""

    def first_of(self, some: Iterable[Trial], most: int) -> Iterator[Trial]:
        """Yield at most so many of what could be tried; that there is more is noted."""
        for number, one in enumerate(some):
            if number == most:
                self.stopped = True
                return
            yield one

    def used_up(self) -> bool:
        """Return whether nothing is left; that something is not tried for this is noted."""
        over = not self.budget.steps or not self.readings.steps
        self.stopped = self.stopped or over
        return over

    def solution(self, given: LazyReduction, least: bool = True) -> list[list[Candidate]] | Undecided | None:
        """Return a solution of a changed problem, None if there is none, or Undecided if too little is left.

        Where it has none as it stands, one with optional roles; candidates stand for those of their slots that are
        empty.
        """
        found = self._solution(given, least)
        if found is None and (optional := with_optional_slots(given.problem)) is not given.problem:
            return self._solution(LazyReduction(optional), least)
        return found

    def _solution(self, given: LazyReduction, least: bool) -> list[list[Candidate]] | Undecided | None:
        options = sum(map(len, given.problem.candidates))
        self.budget.spend(_ports(given.problem) // PORTS_PER_TRIAL_STEP + STEPS_PER_OPTION * options)
        if self.used_up():
            return Undecided(0)
        with self.budget.portion(TRIAL_STEPS + options) as part:
            found = solution(given, part, least_by_clauses if least else any_by_clauses)
        self.stopped = self.stopped or isinstance(found, Undecided)
        return found

    def possible(self, problem: Problem) -> bool:
        """Return whether a solution of a changed problem is found, be it the first one or another."""
        return isinstance(self.solution(LazyReduction(problem), least=False), list)

    def core(self, given: ReducedProblem) -> tuple[Constraint, ...]:
        """Return constraints that cannot hold together; none if too little is left to find any."""
        self.budget.spend(STEPS_PER_OPTION * sum(map(len, given.options)))
        if self.used_up():
            return ()
        with self.budget.portion(HELPFUL_STEPS) as part:
            return core(FeasibilityOracle(given, part, self.readings))

    def recruits_found(self, problem: Problem) -> bool:
        """Return whether some players have recruits, in a problem that has a solution if these are there at once."""
        if not any(role.recruits for role in problem.roles):
            return True
        supplying = sum(len(r.profile.inputs) + len(r.profile.outputs) for r in problem.supply.recruits)
        self.budget.spend((_ports(problem) + supplying) // PORTS_PER_TRIAL_STEP)
        return not self.used_up() and has_recruits(problem)


def has_recruits(problem: Problem) -> bool:
    """Return whether some players that have recruits are found soon, with the optional roles that it takes."""
    if possible_with_recruits(problem, RECRUIT_TRIAL_STEPS):
        return True
    optional = with_optional_slots(problem)
    return optional is not problem and possible_with_recruits(optional, RECRUIT_TRIAL_STEPS)


def _ports(problem: Problem) -> int:
    """Return how many ports there are, which is what preparing a trial costs."""
    return sum(len(c.profile.inputs) + len(c.profile.outputs) for some in problem.candidates for c in some)
