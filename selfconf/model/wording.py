"""Lists in sentences."""

from __future__ import annotations

from collections.abc import Iterable

MANY = 12
"""More names than that are not read by anybody; the last ones become a number."""


def listed(names: Iterable[str]) -> str:
    """`a`, `a and b`, `a, b and c`; of very many the first ones, `and 991 others`."""
    words = list(names)
    if len(words) > MANY:
        words = [*words[: MANY - 3], f"{len(words) - MANY + 3} others"]
    if len(words) < 2:
        return "".join(words)
    return f"{', '.join(words[:-1])} and {words[-1]}"
