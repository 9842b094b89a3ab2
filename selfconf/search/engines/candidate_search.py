"""Depth-first search over the candidates themselves: a few steps solve most real instances before any preparation.

Slots are filled in order and take their candidates in order, so that solutions come in lexicographic order, the
least first. Only candidates that are tried are looked at, where reducing a problem costs a pass over all of them; in
return it is seen late that a need has no support: once a role and all that feed it are filled. Where roles share
candidates, candidates that play already are skipped for a fraction of a step, so that many roles that draw on one pool
are filled without a matching; for a whole step where none is left, as matching then sees more.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

from selfconf.model.partition import Candidate
from selfconf.search.budget import Budget
from selfconf.search.problem import Problem

PORTS_PER_STEP = 4
"""How many ports can be compared for the price of a step."""

SKIPS_PER_STEP = 32
"""How many candidates that play already can be skipped for the price of a step."""

SLOT_HEADROOM = 8
"""For how many slots more than were reached steps may be taken."""


class CandidateSearch:
    """Fills the slots of a problem; a subclass may leave candidates out.

    With a pace, the budget is used up as soon as a dead end is met after more steps than that for each slot reached.
    """

    def __init__(self, problem: Problem, budget: Budget, pace: int | None = None) -> None:
        self.problem, self.budget, self.pace = problem, budget, pace
        self.slots = [role for role, asked in enumerate(problem.roles) for _ in range(asked.minimum)]
        self.playing: list[list[Candidate]] = [[] for _ in problem.roles]
        self.taken: set[str] = set()
        self.matters = len(self.slots) - 1
        """The last slot on which it depends whether a solution will do for the caller.

        Solutions that differ from one only in later slots are skipped.
        """
        self.furthest = 0
        """How many slots have been filled at the same time, at most."""
        self._values = [problem.open_values]
        """For each slot filled the values that the variables may still have."""
        self._checks, self._cost = self._checks_after_slots()

    def _checks_after_slots(self) -> tuple[list[list[int]], list[int]]:
        """Return for each slot the roles whose inputs can be checked after it, and its cost in steps with the check."""
        last = {role: place for place, role in enumerate(self.slots)}
        checks: list[list[int]] = [[] for _ in self.slots]
        cost = [1] * len(self.slots)
        candidates = self.problem.candidates
        for role, place in last.items():
            # The first candidate stands for all: an estimate, so that no pass over them is needed.
            ports = len(candidates[role][0].profile.ports.inputs) if candidates[role] else 0
            for source in self.problem.sources[role]:
                if source in last:
                    place = max(place, last[source])
                    ports += len(candidates[source][0].profile.ports.outputs) if candidates[source] else 0
            checks[place].append(role)
            cost[place] += ports // PORTS_PER_STEP
        return checks, cost

    def candidates(self, role: int, start: int) -> Iterator[tuple[int, Candidate]]:
        """Yield the candidates for the next slot of a role from a number on, in order, with their numbers."""
        candidates = self.problem.candidates[role]
        return zip(range(start, len(candidates)), islice(candidates, start, None), strict=True)

    def first(self) -> list[list[Candidate]] | None:
        """Return the least solution, if it is met within the budget."""
        return next(self.solutions(), None)

    def solutions(self) -> Iterator[list[list[Candidate]]]:
        """Yield solutions in lexicographic order, until there are no more or the budget is used up.

        Each is the list that the search goes on to change.
        """
        slots = self.slots
        self._values = [self.problem.open_values]
        following = [0] * (len(slots) + 1)
        place = 0
        given = self.budget.steps
        while place >= 0:
            if place < len(slots):
                number = self._fill(place, following[place])
                if number is not None:
                    following[place] = number + 1
                    place += 1
                    self.furthest = max(self.furthest, place)
                    # Slots of one role take candidates in ascending order: their permutations are the same solution.
                    same = place < len(slots) and slots[place] == slots[place - 1]
                    following[place] = number + 1 if same else 0
                    continue
                if self._given_up(given):
                    return
            else:
                yield self.playing
                for _ in range(place - 1 - max(self.matters, -1)):
                    place -= 1
                    self._empty(place)
            place -= 1
            if place >= 0:
                self._empty(place)

    def _empty(self, place: int) -> None:
        """Take the candidate out of a slot, the last one that is filled."""
        self.taken.discard(self.playing[self.slots[place]].pop().profile.component)
        self._values.pop()

    def _given_up(self, given: int | None) -> bool:
        """Return whether the budget is used up, or the search has taken more steps than its pace allows."""
        budget = self.budget
        if given is None or budget.steps is None:
            return False
        if self.pace is not None and given - budget.steps > self.pace * (self.furthest + SLOT_HEADROOM):
            budget.steps = 0
        if budget.steps <= 0:
            budget.steps = 0  # no less, though the last step may have cost more than was left
        return not budget.steps

    def _fill(self, place: int, start: int) -> int | None:
        """Put the next candidate that fits into a slot; its number, or None if there is none or the budget ends."""
        role, cost, budget, values = self.slots[place], self._cost[place], self.budget, self._values[-1]
        skipped, taken, checks = 0, self.taken, self._checks[place]
        for number, candidate in self.candidates(role, start):
            component = candidate.profile.component
            plays = component in taken
            if plays:
                skipped += 1
                if skipped % SKIPS_PER_STEP:
                    continue
            if budget.steps is not None:
                if budget.steps <= 0:
                    return None
                budget.steps -= 1 if plays else cost
            if plays:
                continue
            narrowed = self.problem.narrowed(values, candidate) if values else values
            if narrowed is None:
                continue
            self.playing[role].append(candidate)
            if not checks or self._inputs_fed(checks):
                taken.add(component)
                self._values.append(narrowed)
                return number
            self.playing[role].pop()
        # A slot for which none is left over pays in full for what it skipped: that is the pigeonhole principle at work,
        # on which depth-first search thrashes and matching does not.
        if budget.steps is not None:
            budget.steps = max(0, budget.steps - skipped)
        return None

    def _inputs_fed(self, roles: list[int]) -> bool:
        compatible, playing = self.problem.compatible, self.playing
        for role in roles:
            for candidate in playing[role]:
                if not compatible(role, candidate.profile, playing):
                    return False
        return True
