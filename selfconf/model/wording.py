"""Lists and terms in sentences, and text that steers no terminal."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterable
from typing import TYPE_CHECKING

from selfconf.model.term import IRI, Literal, Term

if TYPE_CHECKING:
    from datetime import datetime
    from pathlib import PurePath

MANY = 12
"""How many names are listed; the rest become a number."""
LONGEST_REMARK = 4000
"""How many characters of a remark of a stranger are shown."""
# The controls of ASCII and Latin-1 but for tab and line feed, and those that change the direction of writing.
_DIRECTION = "\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069"
_STEERING = re.compile(f"[\x00-\x08\x0b-\x1f\x7f-\x9f{_DIRECTION}]")
STEERING_OR_BREAKING = f"\x00-\x1f\x7f-\x9f\u2028\u2029{_DIRECTION}"
"""What no text has that stands in a line as it is, as a part of a class of characters of a regular expression."""
_STEERING_OR_BREAKING = re.compile(f"[{STEERING_OR_BREAKING}]")


def plain(text: str) -> str:
    """The text with `\\x1b` and the like spelt out."""
    return _STEERING.sub(_spelt_out, text)


def one_line(text: str, most: int = LONGEST_REMARK) -> str:
    """A remark of a stranger as a part of one line: also the ends of lines and tabs spelt out, and cut to a length."""
    shown = text if len(text) <= most else f"{text[:most]}…"
    return shown if _is_harmless(shown) else _STEERING_OR_BREAKING.sub(_spelt_out, shown)


def as_typed(path: str | PurePath) -> str:
    """A path as an argument of a command that a message tells to type: quoted, and never taken for an option."""
    text = str(path)
    return shlex.quote(f"./{text}" if text.startswith("-") else text)


def sayable(said: object) -> str:
    """What a program says as a text that can travel: cut to a length, and with what is no character replaced."""
    return str(said)[:LONGEST_REMARK].encode(errors="replace").decode()


def utc_text(moment: datetime) -> str:
    """A moment in UTC, to the second."""
    return f"{moment:%Y-%m-%d %H:%M:%S} UTC"


def client_text(principal: str) -> str:
    """Which client was refused something: by the common name of its certificate, where it has shown a trusted one."""
    return principal or "a client without a trusted certificate"


def printable(text: str) -> str:
    """Text without control characters: a file from somewhere must not steer the terminal that shows it."""
    return "".join(character if character == "\t" or character.isprintable() else "\ufffd" for character in text)


def is_one_line(text: str) -> bool:
    """Whether a text can stand in a line as it is: it steers no terminal, and ends no line."""
    return _is_harmless(text) or _STEERING_OR_BREAKING.search(text) is None


def _is_harmless(text: str) -> bool:
    """Whether a text consists of printable characters of ASCII alone, as most do: to see that takes no time."""
    return text.isascii() and text.isprintable()


def _spelt_out(found: re.Match[str]) -> str:
    return found[0].encode("unicode_escape").decode()


def listed(names: Iterable[str]) -> str:
    """`a`, `a and b`, `a, b and c`; of very many the first ones, `and 991 others`."""
    words = list(names)
    if len(words) > MANY:
        words = [*words[: MANY - 3], f"{len(words) - MANY + 3} others"]
    if len(words) < 2:
        return "".join(words)
    return f"{', '.join(words[:-1])} and {words[-1]}"


def counted(number: int, thing: str) -> str:
    """A number of things: `1 site`, `2 sites`."""
    return f"{number} {thing}{'s' * (number != 1)}"


def in_english(messages: Iterable[tuple[str, str]]) -> str:
    """Of the language tags and texts of a message that in none, or in English, as all others are; else the first."""

    def rank(message: tuple[str, str]) -> tuple[bool, str, str]:
        language = message[0].lower()
        return language.partition("-")[0] not in ("", "en"), language, message[1]

    return min(messages, key=rank, default=("", ""))[1]


def in_words(values: Iterable[Term]) -> str:
    """Values for people: `Astrid or Pippi`; of literals also what tells them from others, `"1"` from `1`."""
    names = sorted({term_in_words(value) for value in values})
    return " or ".join(names) if names else "nothing"


def in_full(values: Iterable[Term]) -> str:
    """Values for people where local names do not tell them apart: IRIs as a whole."""
    said = sorted({repr(value) if isinstance(value, IRI) else term_in_words(value) for value in values})
    return " or ".join(said) if said else "nothing"


def term_in_words(value: Term) -> str:
    """A term for people: an IRI by its local name, a literal as in Turtle; a blank node has no name to show."""
    if isinstance(value, Literal):
        return value.turtle(lambda datatype: datatype.short)
    return value.short if isinstance(value, IRI) else "a blank node"


def with_article(kind: str) -> str:
    """A datatype, or a kind of node or signal, with its article: an integer, an IRI, a Pose."""
    return f"{'an' if kind[:1] in tuple('AEIOaeiou') else 'a'} {kind}"
