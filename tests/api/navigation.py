"""The paper's task, as the library answers it."""

from __future__ import annotations

from selfconf import configure, read, template
from selfconf.api.answer import Answer
from selfconf.model.refusal import Refusal, Undecided
from tests.lab import ADVERTISEMENTS, NAVIGATE, PREFIXES

EVERYTHING = PREFIXES + "\n".join(ADVERTISEMENTS.values())


def navigation(ads: str = EVERYTHING, **more: object) -> Answer | Refusal | Undecided:
    """The answer to the paper's task."""
    task = template(NAVIGATE).bind(robot=":Astrid", goal="(AT BEDROOM)")
    return configure(task, read(ads), **more)  # type: ignore[arg-type]  # options by name


def answered(**more: object) -> Answer:
    """The paper's configuration."""
    found = navigation(**more)  # type: ignore[arg-type]  # options by name
    assert isinstance(found, Answer)
    return found
