"""The lines in which a Turtle text describes what, found without reading it as RDF.

A parser that knows the place of every term takes a hundred times as long, and has to be loaded first
(`selfconf.rdf.positions`). A named node is the subject only of a whole statement, never of one in brackets. So it is
enough to know where statements begin, for which strings, IRIs, comments and brackets are followed.
"""

from __future__ import annotations

import re

from selfconf.rdf.turtle import COMMENT, QUOTED

_TOKEN = re.compile(
    rf"{QUOTED}|(?P<comment>{COMMENT})|<(?P<iri>[^<>\s]*)>|(?P<open>[\[(])|(?P<close>[\])])"
    r"|(?P<word>[^\s<>\"'()\[\]{};,#]+)|(?P<odd>[{}<>\"'])",
    re.DOTALL,
)
_LONE_RETURN = re.compile(r"\r(?!\n)")
_ABSOLUTE = re.compile(r"[A-Za-z][A-Za-z0-9+.-]*:[^\\]*")


def with_plain_lines(text: str) -> str:
    """A text of which the lines end with a line feed, without a byte order mark; the offsets go by it."""
    return _LONE_RETURN.sub("\n", text.removeprefix("\ufeff"))  # white space in Turtle, but not to rdflib


class _NotFollowedError(Exception):
    """A text has what is not followed: a relative IRI or an escape in a subject, or it is no Turtle."""


def subject_lines(text: str) -> dict[str, int]:
    """Return the line in which each named subject of a Turtle text is first described; nothing if that is not sure.

    It is not sure where a subject is named by a relative IRI or with an escape, or where the text is no Turtle; of what
    else is no Turtle nothing is noticed.
    """
    text = with_plain_lines(text)
    statements = _Statements()
    try:
        for token in _TOKEN.finditer(text):
            statements.take(token)
    except _NotFollowedError:
        return {}
    lines, line, counted = {}, 1, 0
    for subject, offset in statements.subjects.items():
        line, counted = line + text.count("\n", counted, offset), offset
        lines[subject] = line
    return lines


class _Statements:
    """Where the statements of a text begin, from its tokens in order."""

    def __init__(self) -> None:
        self.subjects: dict[str, int] = {}
        """The offset of each subject, in the order of the text."""
        self._prefixes: dict[str, str] = {}
        self._depth = 0
        self._begins = True
        """Whether a statement begins with the next token."""
        self._directive = ""
        """The first word of the directive that is being read, in small letters."""
        self._prefix = ""

    def take(self, token: re.Match[str]) -> None:
        """Go on by one token. Raises _NotFollowedError."""
        kind = token.lastgroup
        if kind == "word":
            if not self._depth:
                self._word(token[0], token.start())
        elif kind in ("open", "close"):
            self._bracket(1 if kind == "open" else -1)
        elif kind == "iri":
            self._iri(token["iri"], token.start())
        elif kind == "odd" or (kind is None and self._begins):
            raise _NotFollowedError

    def _bracket(self, step: int) -> None:
        self._depth += step
        self._begins = False
        if self._depth < 0:
            raise _NotFollowedError

    def _iri(self, iri: str, offset: int) -> None:
        if self._directive:
            self._declare(iri)
        elif self._begins:
            self._describe(iri, offset)

    def _word(self, word: str, offset: int) -> None:
        if word[0] == "." and not word[1:2].isdigit():
            self._begins, word, offset = True, word[1:], offset + 1
        name = word.rstrip(".")
        if name and self._directive.endswith("prefix") and name[-1] == ":":
            self._prefix = name[:-1]
        elif name and self._begins:
            self._begin(name, offset)
        if name != word:
            self._begins = True

    def _begin(self, name: str, offset: int) -> None:
        """A statement begins with a word: a keyword, a prefixed name, or the label of a blank node."""
        prefix, colon, local = name.partition(":")
        if not colon and name.removeprefix("@").lower() in ("prefix", "base"):
            self._directive = name.lower()
            self._begins = False
        elif prefix == "_":
            self._begins = False
        elif colon and prefix in self._prefixes:
            self._describe(self._prefixes[prefix] + local, offset)
        else:
            raise _NotFollowedError

    def _describe(self, subject: str, offset: int) -> None:
        if _ABSOLUTE.fullmatch(subject) is None:
            raise _NotFollowedError
        self.subjects.setdefault(subject, offset)
        self._begins = False

    def _declare(self, iri: str) -> None:
        """A directive ends with an IRI: one of SPARQL's without a full stop."""
        if self._directive.endswith("prefix"):
            self._prefixes[self._prefix] = iri
        self._begins = not self._directive.startswith("@")
        self._directive = self._prefix = ""
