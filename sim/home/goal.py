"""Behavioural goals: propositions such as `(AT BEDROOM)`, which name a place by its skos:notation.

The Thinking Cap knows one predicate, AT. Case does not matter, nor do spaces.
"""

from __future__ import annotations

import re

from sim.geometry import Pose
from sim.home.apartment import Apartment
from sim.home.floor_plan import Place


class GoalError(ValueError):
    """A behavioural goal that no component could pursue: the author of the task can mend it. `goal` is its text."""

    def __init__(self, goal: str, reason: str) -> None:
        super().__init__(goal, reason)
        self.goal, self.reason = goal, reason

    def __str__(self) -> str:
        return f"the goal {self.goal!r} {self.reason}"


def read_goal(text: str, apartment: Apartment) -> tuple[Place, Pose]:
    """Return the place that a goal names, and the pose of a robot that stands there; or raise GoalError."""
    match = re.fullmatch(r"\s*\(\s*([\w-]+)\s+([\w-]+)\s*\)\s*", text)
    if match is None:
        raise GoalError(text, "is no proposition: write it like (AT BEDROOM)")
    predicate, name = match.group(1).upper(), match.group(2).upper()
    if predicate != "AT":
        raise GoalError(text, f"has the predicate {predicate}, and only AT is known: write it like (AT BEDROOM)")
    places = {place.notation.upper(): place for place in apartment.places if place.notation is not None}
    place = places.get(name)
    if place is None or place.standing is None:
        raise GoalError(text, f"names no known place: {name} is none of {', '.join(sorted(places))}")
    return place, place.standing
