"""What the functions of the library take besides tasks and ecologies: words, flags, paths, names, and limits."""

from __future__ import annotations

import os
from collections.abc import Iterable
from enum import Enum
from io import IOBase
from math import isfinite
from numbers import Integral, Real
from pathlib import Path
from typing import TypeAlias, TypeVar

from selfconf.errors import AuthorError, ProgrammerError
from selfconf.model.seconds import DELAY_IN_WORDS, LONGEST_SECONDS, is_delay, is_limit
from selfconf.model.template import MOST_PRIORITY

Paths: TypeAlias = str | Path | Iterable[str | Path]
"""One path, or several."""
Endpoints: TypeAlias = str | Iterable[str]
"""One endpoint, or several."""
Choice = TypeVar("Choice", bound=Enum)
_SECONDS_ASKED = f"seconds are a number above zero and at most {LONGEST_SECONDS:,.0f}"


def listed_paths(paths: Paths) -> list[str | Path]:
    """The paths; one by itself is a list of one, and not of its letters.

    Raises ProgrammerError for what is none, and AuthorError for a text that names none.
    """
    several = isinstance(paths, Iterable) and not isinstance(paths, IOBase)  # an open file would be taken for its lines
    listed = [paths] if isinstance(paths, str | Path) else list(paths) if several else None
    if listed is None or not all(isinstance(path, str | os.PathLike) for path in listed):
        raise ProgrammerError(f"paths are one path or several, as text or as Path, not {paths!r}")
    for path in listed:
        checked_path(path)
    return listed


def checked_path(path: str | Path) -> Path:
    """The path of a text. Raises AuthorError for a text that names none or one that cannot be looked for.

    Raises ProgrammerError for what is no text.
    """
    if not isinstance(path, str | os.PathLike):
        raise ProgrammerError(f"a path is text or a Path, not {path!r}")
    if not str(path):  # `Path` takes it for the current folder
        raise AuthorError("an empty text is no path; the current folder is '.'")
    if "\0" in str(path):
        raise AuthorError(f"a path holds no null character: {str(path)!r}")
    found, wrong = Path(path), ""
    try:
        there = found.exists()
    except OSError as error:  # a name that is too long, or a folder into which only others may look
        there, wrong = False, f"cannot read {found}: {error.strerror}"
    if not there and "\n" in str(path):  # where documents are read, their text is taken as well
        raise AuthorError("a path is wanted here, and not the text of a document; write it into a file")
    if wrong:
        raise AuthorError(wrong)
    return found


def checked_text(text: str, what: str) -> str:
    """A text by which something is named. Raises ProgrammerError, in which `what` says what it is.

    Raises AuthorError for one that cannot be written in UTF-8, as of bytes that were read in another encoding.
    """
    if not isinstance(text, str):
        raise ProgrammerError(f"{what} is text, not {text!r}")
    try:
        text.encode()
    except UnicodeEncodeError:
        raise AuthorError(f"{what} is no text in UTF-8: {text!r}") from None
    return text


def checked_flag(flag: bool, name: str) -> bool:
    """True or False. Raises ProgrammerError, in which `name` is that of the argument, for all else, as for "no"."""
    if not isinstance(flag, bool):
        raise ProgrammerError(f"{name} is True or False, not {flag!r}")
    return flag


def listed_endpoints(endpoints: Endpoints) -> list[str]:
    """The endpoints; one by itself is a list of one, not of its letters. Raises ProgrammerError for what is none."""
    listed = [endpoints] if isinstance(endpoints, str) else list(endpoints) if isinstance(endpoints, Iterable) else None
    if listed is None or not all(isinstance(endpoint, str) for endpoint in listed):
        raise ProgrammerError(f"endpoints are one or several, as text, not {endpoints!r}")
    return listed


def checked_priority(priority: int) -> int:
    """The priority of a task. Raises ProgrammerError for what is none."""
    if isinstance(priority, bool) or not isinstance(priority, Integral) or abs(priority) > MOST_PRIORITY:
        raise ProgrammerError(
            f"a priority is a whole number from {-MOST_PRIORITY} to {MOST_PRIORITY}, not {priority!r}"
        )
    return int(priority)


def checked_steps(steps: int | None) -> int | None:
    """The steps that a search may take, or None. Raises ProgrammerError for what is no number of steps."""
    return None if steps is None else _count(steps, "steps are a whole number above zero, or None for no limit")


def checked_rows(rows: int) -> int:
    """The rows that an answer may have. Raises ProgrammerError for what is no number of rows."""
    return _count(rows, "rows are a whole number above zero")


def _count(number: int, asked: str) -> int:
    """A whole number above zero. Raises ProgrammerError, with what was asked for, for anything else."""
    if isinstance(number, bool) or not isinstance(number, Integral) or number < 1:
        raise ProgrammerError(f"{asked}, not {number!r}")
    return int(number)


def checked_seconds(seconds: float) -> float:
    """The seconds that an answer may take. Raises ProgrammerError for what is no time, and for None."""
    return _seconds(seconds, _SECONDS_ASKED)


def _seconds(seconds: float, asked: str) -> float:
    """Seconds that something may take. Raises ProgrammerError, with what was asked for, for anything else."""
    if not is_limit(seconds):
        raise ProgrammerError(f"{asked}, not {seconds!r}")
    return float(seconds)


def checked_moment(moment: float | None) -> float | None:
    """A moment in seconds of the Unix epoch, or None for now. Raises ProgrammerError for what is none."""
    if moment is not None and (isinstance(moment, bool) or not isinstance(moment, Real) or not isfinite(moment)):
        raise ProgrammerError(f"a moment is a number of seconds of the Unix epoch, or None for now, not {moment!r}")
    return None if moment is None else float(moment)


def checked_seconds_limit(seconds: float | None) -> float | None:
    """The seconds that a search may take, or None. Raises ProgrammerError for what is no time."""
    return None if seconds is None else _seconds(seconds, f"{_SECONDS_ASKED}, or None for no limit")


def checked_upgrade(seconds: float | None) -> float | None:
    """After how many seconds a better component is changed to, or None. Raises ProgrammerError for what is no time."""
    if seconds is None:
        return None
    if not is_delay(seconds):
        raise ProgrammerError(f"an upgrade comes after {DELAY_IN_WORDS}, or never by None, not after {seconds!r}")
    return float(seconds)


def checked_delay(seconds: float) -> float:
    """The simulated seconds that are to pass. Raises ProgrammerError for what is no time."""
    if not is_delay(seconds):
        raise ProgrammerError(f"simulated seconds are a number from 0 to {LONGEST_SECONDS:,.0f}, not {seconds!r}")
    return float(seconds)


def checked_choice(kind: type[Choice], name: str, word: str) -> Choice:
    """The choice that a word stands for. Raises ProgrammerError, which names the words that there are."""
    try:
        return kind(word)
    except ValueError:
        known = ", ".join(repr(each.value) for each in kind)
        raise ProgrammerError(f"there is no {name} {word!r}; choose one of {known}") from None
