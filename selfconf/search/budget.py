"""How many steps a search may take; a step means the same on every machine, unlike a second."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass


@dataclass(slots=True)
class Budget:
    """The steps that are left, one for each option tried; shared by the engines that work on one question.

    None means that there is no limit. At zero the budget is used up, and an engine answers with what it has.
    """

    steps: int | None = None

    def part(self, most: int) -> Budget:
        """Return a separate budget of at most this number of the steps that are left."""
        return Budget(most if self.steps is None else min(most, self.steps))

    @contextmanager
    def portion(self, most: int) -> Iterator[Budget]:
        """Lend a part of the budget; what was spent of it is taken away at the end."""
        part = self.part(most)
        given = part.steps or 0
        yield part
        self.spend(given - (part.steps or 0))

    def spend(self, steps: int) -> None:
        """Take away steps that were done, down to zero."""
        if self.steps is not None:
            self.steps = max(0, self.steps - steps)
