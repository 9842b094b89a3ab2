"""RDF terms as plain values, so that the core needs no RDF library (RDF 1.1 Concepts, section 3)."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from typing import TYPE_CHECKING

from selfconf.model.immutable import immutable

if TYPE_CHECKING:
    from typing_extensions import Self

XSD_NAMESPACE = "http://www.w3.org/2001/XMLSchema#"


_NOT_IN_AN_IRI = re.compile(r'[\x00-\x20<>"{}|^`\\\ud800-\udfff]')
"""The characters that Turtle and SPARQL allow in no IRI (their production IRIREF), and surrogates, which are none."""


class IRI(str):
    """An absolute IRI, without the angle brackets. Raises ValueError for a text that no IRI can be.

    >>> IRI("https://example.org/my-home#clock")
    <https://example.org/my-home#clock>
    >>> IRI("https://example.org/my-home#clock").short
    'clock'
    >>> IRI("https://example.org/my home")
    Traceback (most recent call last):
    ValueError: 'https://example.org/my home' is no IRI: it has ' ', which is written as %20
    """

    __slots__ = ()

    def __new__(cls, text: str) -> Self:
        if not isinstance(text, str):
            raise TypeError(f"an IRI is made of text, not of {type(text).__name__}")
        wrong = _NOT_IN_AN_IRI.search(text)
        if wrong is not None:
            instead = f"written as %{ord(wrong[0]):02X}" if wrong[0].isascii() else "no character"
            raise ValueError(f"{text!r} is no IRI: it has {wrong[0]!r}, which is {instead}")
        if not text:
            raise ValueError("'' is no IRI: a text that is not empty is needed, as 'https://example.org/my-home#clock'")
        return cls.unchecked(text)

    @classmethod
    def unchecked(cls, text: str) -> Self:
        """A text as an IRI, whatever it is, in a third of the time: what a parser, a message or a record has said.

        The empty text may stand for no IRI.
        """
        return str.__new__(cls, text)

    def __reduce__(self) -> tuple[Callable[[str], Self], tuple[str]]:
        """Copies and pickles are made of what is an IRI already."""
        return self.unchecked, (str(self),)

    def __repr__(self) -> str:
        return f"<{self}>"

    @property
    def short(self) -> str:
        """The last segment, for people: `MotorDrive` of `https://w3id.org/selfconf/robotics#MotorDrive`."""
        tail = self.rstrip("/#").replace("#", "/").replace(":", "/").rsplit("/", 1)[-1]
        return tail or str(self)


class BlankNode(str):
    """A blank node; its label, which starts with `_:` so that it never equals an IRI, holds inside one document."""

    __slots__ = ()


STRING = IRI(XSD_NAMESPACE + "string")
_BARE = {
    XSD_NAMESPACE + "integer": re.compile(r"[+-]?[0-9]+"),
    XSD_NAMESPACE + "decimal": re.compile(r"[+-]?[0-9]*\.[0-9]+"),
    XSD_NAMESPACE + "double": re.compile(r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)[eE][+-]?[0-9]+"),
    XSD_NAMESPACE + "boolean": re.compile("true|false"),
}
"""What Turtle takes for a literal of a datatype as it stands."""


@immutable
class Literal:
    """A literal: lexical form, datatype and, for `rdf:langString`, a language tag.

    >>> str(Literal("1.5", IRI("http://www.w3.org/2001/XMLSchema#decimal")))
    '1.5'
    """

    lexical: str
    datatype: IRI = STRING
    language: str | None = None

    def __str__(self) -> str:
        return self.lexical

    def turtle(self, name: Callable[[IRI], str]) -> str:
        """As Turtle writes it: a number or truth value as such, else in quotes; `name` is for the datatype."""
        if self.datatype in _BARE and _BARE[self.datatype].fullmatch(self.lexical):
            return self.lexical
        quoted = json.dumps(self.lexical, ensure_ascii=False)  # its escapes are Turtle's too
        if self.language:
            return f"{quoted}@{self.language}"
        return quoted if self.datatype == STRING else f"{quoted}^^{name(self.datatype)}"


Term = IRI | BlankNode | Literal


def sort_key(term: Term) -> tuple[int, str, str, str]:
    """A total order on terms: IRIs, then blank nodes, then literals by lexical form, datatype and language."""
    if isinstance(term, Literal):
        return 2, term.lexical, term.datatype, term.language or ""
    return int(isinstance(term, BlankNode)), str(term), "", ""
