r"""What Turtle and SPARQL let the two halves of a prefixed name be, as far as nothing in it needs to be escaped.

Python's `\w` is no measure for that: it has the `µ` of micrometres and the `²` of square metres, which no parser of
Turtle reads in a prefixed name, so that an IRI with one of these has to be written out.
"""

from __future__ import annotations

import re
from functools import cache

_ASCII_LETTER = "A-Za-z"
_LETTER = (
    r"A-Za-z\u00C0-\u00D6\u00D8-\u00F6\u00F8-\u02FF\u0370-\u037D\u037F-\u1FFF\u200C\u200D\u2070-\u218F\u2C00-\u2FEF"
    r"\u3001-\uD7FF\uF900-\uFDCF\uFDF0-\uFFFD\U00010000-\U000EFFFF"
)
"""PN_CHARS_BASE (RDF 1.1 Turtle, section 6.5)."""
_ASCII_CHARACTER = rf"{_ASCII_LETTER}_0-9\-"
_CHARACTER = rf"{_LETTER}_0-9\u00B7\u0300-\u036F\u203F\u2040\-"
"""PN_CHARS."""
SCHEMES = ("http", "https", "urn", "file", "mailto", "tag")
"""What looks like a prefix where an IRI has no angle brackets."""


def is_local_name(text: str) -> bool:
    """Whether a text is a PN_LOCAL without colons and escapes."""
    return _local_name(text.isascii()).fullmatch(text) is not None


def suggested_local_name(words: str) -> str:
    """A local name in ASCII that resembles some words; empty where none of their characters can stand in one."""
    return re.sub(r"[^A-Za-z0-9]+", "-", words).strip("-")


def is_prefix(text: str) -> bool:
    """Whether a text is a PN_PREFIX, or nothing."""
    return not text or _prefix(text.isascii()).fullmatch(text) is not None


# A class of characters of all scripts takes milliseconds to compile, so it is not compiled for names in ASCII.


@cache
def _local_name(of_ascii: bool) -> re.Pattern[str]:
    letter, character = (_ASCII_LETTER, _ASCII_CHARACTER) if of_ascii else (_LETTER, _CHARACTER)
    return re.compile(f"[{letter}_0-9]{_more(character)}")


@cache
def _prefix(of_ascii: bool) -> re.Pattern[str]:
    letter, character = (_ASCII_LETTER, _ASCII_CHARACTER) if of_ascii else (_LETTER, _CHARACTER)
    return re.compile(f"[{letter}]{_more(character)}")


def _more(character: str) -> str:
    """What may follow: a dot at the end would end the statement."""
    return rf"(?:[{character}.]*[{character}])?"
