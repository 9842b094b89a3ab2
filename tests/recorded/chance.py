"""Choices made from a seed, the same in every version of Python: only `random.Random.random` is promised to stay."""

from __future__ import annotations

import random
from collections.abc import Sequence
from typing import TypeVar

T = TypeVar("T")


class Chance:
    """A source of choices that depends on its seed alone."""

    def __init__(self, seed: int) -> None:
        self._random = random.Random(seed)

    def often(self, share: float) -> bool:
        """True in that share of cases."""
        return self._random.random() < share

    def below(self, bound: int) -> int:
        """A whole number from 0 up to, but not including, the bound."""
        return int(self._random.random() * bound)

    def one(self, choices: Sequence[T]) -> T:
        """One of the choices, each with the same probability."""
        return choices[self.below(len(choices))]

    def some(self, choices: Sequence[T], share: float) -> list[T]:
        """Each of the choices in that share of cases, in their order."""
        return [choice for choice in choices if self.often(share)]

    def shuffled(self, choices: Sequence[T]) -> list[T]:
        """All the choices in some order."""
        left = list(choices)
        return [left.pop(self.below(len(left))) for _ in choices]
