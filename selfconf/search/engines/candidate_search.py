"""Depth first over the candidates themselves: a few steps solve most real instances before anything is prepared.

Slots are filled in order and take their candidates in order, so that solutions come in lexicographic order, the
least first. It looks at no candidate that it does not try, where making a problem compact costs a pass over all of
them; in return it sees late that a need cannot be served: once a role and all that feed it are filled. Where roles
share candidates, those who play already are passed over for a fraction of a step, so that many roles that draw on
one pool are filled without a matching; for a whole one where nobody else is left, as matching then sees more.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

from selfconf.model.partition import Candidate
from selfconf.search.budget import Budget
from selfconf.search.problem import Problem

PORTS_PER_STEP = 4
"""How many ports can be compared for the price of a step."""

TAKEN = 32
"""How many candidates that play already can be passed over for the price of a step."""

SLOT_HEADROOM = 8
"""How many slots more than it has reached it may have taken steps for."""


class CandidateSearch:
    """Fills the slots of a problem; a subclass may leave candidates out.

    With a pace it uses up its budget as soon as a dead end is met after more steps than that for each slot reached.
    """

    def __init__(self, problem: Problem, budget: Budget, pace: int | None = None) -> None:
        self.problem, self.budget, self.pace = problem, budget, pace
        self.slots = [role for role, asked in enumerate(problem.roles) for _ in range(asked.minimum)]
        self.playing: list[list[Candidate]] = [[] for _ in problem.roles]
        self.taken: set[str] = set()
        self.furthest = 0
        """How many slots have been filled at the same time, at most."""
        self._values = [problem.open_values]
        self._due, self._work = self._checks()

    def _checks(self) -> tuple[list[list[int]], list[int]]:
        """After which slot the inputs of which roles can be checked, and about how many steps that is worth."""
        last = {role: place for place, role in enumerate(self.slots)}
        due: list[list[int]] = [[] for _ in self.slots]
        work = [1] * len(self.slots)
        candidates = self.problem.candidates
        for role, place in last.items():
            ports = len(candidates[role][0].profile.ports.inputs) if candidates[role] else 0
            for source in self.problem.sources[role]:
                if source in last:
                    place = max(place, last[source])
                    ports += len(candidates[source][0].profile.ports.outputs) if candidates[source] else 0
            due[place].append(role)
            work[place] += ports // PORTS_PER_STEP
        return due, work

    def candidates(self, role: int, start: int) -> Iterator[tuple[int, Candidate]]:
        """The candidates for the next slot of a role from a number on, in order, with their numbers."""
        candidates = self.problem.candidates[role]
        return zip(range(start, len(candidates)), islice(candidates, start, None), strict=True)

    def first(self) -> list[list[Candidate]] | None:
        """The least solution, if it is met within the budget."""
        return next(self.solutions(), None)

    def solutions(self) -> Iterator[list[list[Candidate]]]:
        """Solutions in lexicographic order, until there are no more or the budget is used up."""
        slots = self.slots
        self._values = [self.problem.open_values]
        following = [0] * (len(slots) + 1)
        place = 0
        given = self.budget.steps
        while place >= 0:
            if place < len(slots):
                number = self._next(place, following[place])
                if number is not None:
                    following[place] = number + 1
                    place += 1
                    self.furthest = max(self.furthest, place)
                    same = place < len(slots) and slots[place] == slots[place - 1]
                    following[place] = number + 1 if same else 0
                    continue
                if given is not None and self.budget.steps is not None:
                    if self.pace is not None and given - self.budget.steps > self.pace * (
                        self.furthest + SLOT_HEADROOM
                    ):
                        self.budget.steps = 0
                    if self.budget.steps <= 0:
                        self.budget.steps = 0  # no less, though the last step may have cost more than was left
                        return
            else:
                yield self.playing
            place -= 1
            if place >= 0:
                self.taken.discard(self.playing[slots[place]].pop().profile.component)
                self._values.pop()

    def _next(self, place: int, start: int) -> int | None:
        """Put the next candidate that fits into a slot; its number, or None if there is none or the budget ends."""
        role, work, budget, values = self.slots[place], self._work[place], self.budget, self._values[-1]
        passed, taken, due = 0, self.taken, self._due[place]
        for number, candidate in self.candidates(role, start):
            component = candidate.profile.component
            plays = component in taken
            if plays:
                passed += 1
                if passed % TAKEN:
                    continue
            if budget.steps is not None:
                if budget.steps <= 0:
                    return None
                budget.steps -= 1 if plays else work
            if plays:
                continue
            narrowed = self.problem.narrowed(values, candidate) if values else values
            if narrowed is None:
                continue
            self.playing[role].append(candidate)
            if not due or self._fed(due):
                taken.add(component)
                self._values.append(narrowed)
                return number
            self.playing[role].pop()
        if budget.steps is not None:
            budget.steps = max(0, budget.steps - passed)
        return None

    def _fed(self, roles: list[int]) -> bool:
        compatible, playing = self.problem.compatible, self.playing
        for role in roles:
            for candidate in playing[role]:
                if not compatible(role, candidate.profile, playing):
                    return False
        return True
