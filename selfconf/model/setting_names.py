"""What a message calls a setting: a keyword to a caller of the library, an option to a user of a command.

A message often ends in what to try, such as another time limit. A Python program sets it by the keyword `seconds`, a
user of `selfconf configure` by the option `--seconds`. So messages say `setting("seconds")`, and a program with a
command line uses the names of its options while it runs (`options_named`). That holds for the whole process, as all of
its messages have one reader, whichever of its threads words them.
"""

from __future__ import annotations

import shlex
from collections.abc import Iterator
from contextlib import contextmanager

KEYWORDS = {"ontology": "ontologies", "template": "name"}
"""The keyword of the library for an option of another name."""
ANY_TERM = "..."
"""Stands for a term that is the user's to choose."""
_options_are_named = False


def in_command() -> bool:
    """Whether the messages of this process name the options of a command line."""
    return _options_are_named


@contextmanager
def options_named(named: bool = True) -> Iterator[None]:
    """Have messages name the options of a command line meanwhile, or not; also a decorator of a function."""
    global _options_are_named
    before, _options_are_named = _options_are_named, named
    try:
        yield
    finally:
        _options_are_named = before


def setting(option: str, value: str = "") -> str:
    """A setting by the name of its option, in a message, perhaps with a value that it might have.

    >>> setting("seconds"), setting("reasoning", "subclass")
    ('seconds', "reasoning='subclass'")
    >>> with options_named():
    ...     setting("reasoning", "subclass")
    '--reasoning subclass'
    """
    if _options_are_named:
        return f"--{option} {value}".rstrip()
    keyword = KEYWORDS.get(option, option)
    return f"{keyword}={value!r}" if value else keyword


def binding(parameter: str, term: str = ANY_TERM) -> str:
    """How a parameter of a template is bound to a term in Turtle.

    >>> binding("goal")
    'bind(goal=...)'
    """
    if _options_are_named:
        return f"--bind {parameter}={term if term == ANY_TERM else shlex.quote(term)}"
    return f"bind({parameter}={term if term == ANY_TERM else repr(term)})"
