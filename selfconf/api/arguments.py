"""What the functions of the library take besides tasks and ecologies: words for options, and paths."""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum
from pathlib import Path
from typing import TypeAlias, TypeVar

from selfconf.errors import ProgrammerError

Paths: TypeAlias = str | Path | Iterable[str | Path]
"""One path, or several."""
Choice = TypeVar("Choice", bound=Enum)


def listed_paths(paths: Paths) -> list[str | Path]:
    """The paths; one by itself is a list of one, and not of its letters."""
    return [paths] if isinstance(paths, str | Path) else list(paths)


def option(kind: type[Choice], name: str, word: str) -> Choice:
    """The choice that a word stands for. Raises ProgrammerError, which names the words that there are."""
    try:
        return kind(word)
    except ValueError:
        known = ", ".join(repr(each.value) for each in kind)
        raise ProgrammerError(f"there is no {name} {word!r}; choose one of {known}") from None
