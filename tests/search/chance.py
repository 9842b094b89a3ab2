"""Many small choices from one string of bytes, which Hypothesis draws, and shrinks, as a single value.

To draw a problem of a hundred choices by a hundred strategies takes longer than to solve it by all searches. A byte
decides one choice; byte 0, towards which Hypothesis shrinks, is the first option, and so are those beyond the end.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

from hypothesis import strategies as st

T = TypeVar("T")


class Chance:
    """What a string of bytes decides, one choice after the other."""

    def __init__(self, decided: bytes) -> None:
        self._all, self._decided = decided, iter(decided)

    def __repr__(self) -> str:
        return f"Chance({self._all!r})"

    def below(self, number: int) -> int:
        """One of so many numbers from 0 on, at most 256."""
        return next(self._decided, 0) % number

    def number(self, least: int, most: int) -> int:
        """A number between two, both included."""
        return least + self.below(most - least + 1)

    def flip(self) -> bool:
        """Whether or not."""
        return self.below(2) == 1

    def one_of(self, options: Sequence[T]) -> T:
        """One of some options."""
        return options[self.below(len(options))]

    def some(self, options: Sequence[T], least: int, most: int) -> list[T]:
        """So many different ones of some options, in any order."""
        return self.order(options)[: self.number(least, min(most, len(options)))]

    def order(self, options: Sequence[T]) -> list[T]:
        """All options, in any order."""
        left = list(options)
        return [left.pop(self.below(len(left))) for _ in range(len(left))]


@st.composite
def by_chance(draw: st.DrawFn, make: Callable[[Chance], T], choices: int = 400) -> T:
    """Values that are made by so many choices at most; later ones fall on the first option."""
    return make(Chance(draw(st.binary(min_size=choices, max_size=choices))))


def with_chance(make: Callable[[Chance], T], choices: int = 420) -> st.SearchStrategy[tuple[T, Chance]]:
    """Values, each with chances for what has to be chosen later, among what is not known before.

    Both are of one string: of two strings Hypothesis copies one onto the other for every second example, so that half
    of the values were there before.
    """
    return by_chance(lambda chance: (make(chance), chance), choices)
