"""Lists in sentences, and text that steers no terminal."""

from __future__ import annotations

import re
from collections.abc import Iterable

MANY = 12
"""How many names are listed; the rest become a number."""
# The controls of ASCII and Latin-1 but for tab and line feed, and those that change the direction of writing.
_STEERING = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u202a-\u202e\u2066-\u2069]")


def plain(text: str) -> str:
    """The text with `\\x1b` and the like spelt out."""
    return _STEERING.sub(lambda found: found[0].encode("unicode_escape").decode(), text)


def listed(names: Iterable[str]) -> str:
    """`a`, `a and b`, `a, b and c`; of very many the first ones, `and 991 others`."""
    words = list(names)
    if len(words) > MANY:
        words = [*words[: MANY - 3], f"{len(words) - MANY + 3} others"]
    if len(words) < 2:
        return "".join(words)
    return f"{', '.join(words[:-1])} and {words[-1]}"
