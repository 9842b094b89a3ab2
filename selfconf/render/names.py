"""IRIs for people: shortened by the prefixes of a document."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping

from selfconf.model.curie import is_local_name
from selfconf.model.term import IRI, Literal, Term


class Names:
    """Shortens IRIs by the prefixes of a document; a longer namespace comes before a shorter one."""

    def __init__(self, prefixes: Mapping[str, str]) -> None:
        self._prefixes = sorted(prefixes.items(), key=lambda item: -len(item[1]))

    def __call__(self, term: Term) -> str:
        """As Turtle writes it: a CURIE where a prefix fits, a number as such, a string in quotes."""
        if isinstance(term, Literal):
            return term.turtle(self)
        for prefix, base in self._prefixes:
            if term.startswith(base) and is_local_name(term[len(base) :]):
                return f"{prefix}:{term[len(base) :]}"
        return f"<{term}>" if isinstance(term, IRI) else str(term)

    def means(self, word: object, iri: IRI) -> bool:
        """Whether a word stands for an IRI: it is that, with or without brackets, or its local name, or its CURIE."""
        return word in (iri, f"<{iri}>", iri.short, self(iri))


def ecology_names(prefixes: Mapping[str, str], iris: Iterable[str]) -> tuple[Names, str]:
    """What shortens the IRIs of an ecology, and a line that says what the empty prefix stands for; empty if for none.

    Advertisements travel without their prefixes. So beside the prefixes that are known the empty one stands for the
    namespace that most of the IRIs have, and of several for the first.
    """
    spaces = Counter(iri[: len(iri) - len(IRI.unchecked(iri).short)] for iri in iris)
    known = set(prefixes.values())
    found = min((space for space in spaces if space not in known), key=lambda one: (-spaces[one], one), default="")
    if not found or "" in prefixes:
        return Names(prefixes), ""
    return Names({**prefixes, "": found}), f": is <{found}>"


def short(term: Term) -> str:
    """The local name of an IRI, or a literal as Turtle writes it: for a reader who has no prefixes."""
    if isinstance(term, Literal):
        return term.turtle(lambda datatype: datatype.short)
    return term.short if isinstance(term, IRI) else str(term)
