"""A few steps on the problem as it is: most real instances are solved before anything needs to be prepared.

Depth first like the search proper, so that what it finds is the least solution; but it looks at no candidate that it
does not try, where preparing costs a pass over all of them. It gives up after some steps per slot.
"""

from __future__ import annotations

from collections.abc import Iterator

from selfconf.model.partition import Candidate
from selfconf.search.problem import Problem


def probe(problem: Problem, steps: int) -> list[list[Candidate]] | None:
    """The least solution if it is met within so many steps; None tells nothing."""
    slots = [role for role, asked in enumerate(problem.roles) for _ in range(asked.minimum)]
    due = _due(problem, slots)
    playing: list[list[Candidate]] = [[] for _ in problem.roles]
    taken: set[str] = set()
    values = [problem.open_values]
    cursor = [0] * (len(slots) + 1)
    place = 0
    while place < len(slots):
        role = slots[place]
        index = cursor[place]
        for candidate in _from(problem.candidates[role], index):
            if not steps:
                return None
            steps -= 1
            index += 1
            if candidate.profile.component in taken:
                continue
            narrowed = problem.narrowed(values[-1], candidate)
            if narrowed is None:
                continue
            playing[role].append(candidate)
            if all(problem.compatible(r, c.profile, playing) for r in due[place] for c in playing[r]):
                taken.add(candidate.profile.component)
                values.append(narrowed)
                break
            playing[role].pop()
        else:
            if not place:
                return None
            place -= 1
            taken.discard(playing[slots[place]].pop().profile.component)
            values.pop()
            continue
        cursor[place] = index
        place += 1
        if place < len(slots):
            cursor[place] = index if slots[place] == role else 0
    return playing


def _due(problem: Problem, slots: list[int]) -> list[list[int]]:
    """After which slot the inputs of which roles can be checked: when it and all its sources are filled."""
    last = {role: place for place, role in enumerate(slots)}
    due: list[list[int]] = [[] for _ in slots]
    for role in last:
        due[max(last[r] for r in (role, *problem.sources[role]) if r in last)].append(role)
    return due


def _from(candidates: tuple[Candidate, ...], index: int) -> Iterator[Candidate]:
    while index < len(candidates):
        yield candidates[index]
        index += 1
