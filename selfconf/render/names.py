"""IRIs for people: shortened by the prefixes of a document."""

from __future__ import annotations

import re
from collections.abc import Mapping

from selfconf.model.term import IRI, Literal, Term

_LOCAL = re.compile(r"[A-Za-z0-9_](?:[\w.-]*[\w-])?")  # a dot at the end would end the statement


class Names:
    """Shortens IRIs by the prefixes of a document; a longer namespace comes before a shorter one."""

    def __init__(self, prefixes: Mapping[str, str]) -> None:
        self._prefixes = sorted(prefixes.items(), key=lambda item: -len(item[1]))

    def __call__(self, term: Term) -> str:
        """As Turtle writes it: a CURIE where a prefix fits, a number as such, a string in quotes."""
        if isinstance(term, Literal):
            return term.turtle(self)
        for prefix, base in self._prefixes:
            if term.startswith(base) and _LOCAL.fullmatch(term[len(base) :]):
                return f"{prefix}:{term[len(base) :]}"
        return f"<{term}>" if isinstance(term, IRI) else str(term)


def short(term: Term) -> str:
    """The local name of an IRI, or a literal as Turtle writes it: for a reader who has no prefixes."""
    if isinstance(term, Literal):
        return term.turtle(lambda datatype: datatype.short)
    return term.short if isinstance(term, IRI) else str(term)
