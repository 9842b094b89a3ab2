"""What the terms of a Thing Description stand for, and of what type or language their values are, by JSON-LD 1.1.

A term is expanded by the contexts in the document itself and by the W3C's, which ships with selfconf. Other contexts
are on the web and are not fetched, so terms of theirs stay unknown; nothing is guessed from a prefix that looks known.
That `@vocab` of the W3C's context would make `td:Lamp` of a bare "Lamp", which is no term of the W3C: such terms are
unknown too, unless the document has an `@vocab` of its own.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from importlib.resources import files
from typing import Any

from selfconf.importing.naming import absolute
from selfconf.model.term import IRI, STRING, Literal
from selfconf.rdf.turtle import ox_term
from selfconf.rdf.vocabulary import RDF

W3C_CONTEXTS = frozenset(
    f"http{secure}://www.w3.org/{path}"
    for secure in ("", "s")
    for path in ("2019/wot/td/v1", "2019/wot/td", "2022/wot/td/v1.1", "2022/wot/td", "ns/td", "ns/wot-next/td")
)
"""The contexts of versions 1.0 and 1.1, which agree about the terms that both have, and their earlier names."""
_SCHEMES = frozenset(("http", "https", "urn", "did", "tag", "info", "file", "ftp", "coap", "coaps", "uuid", "oid"))
"""What before a colon is taken for the scheme of an IRI, if no context says that it is a prefix."""

DEEPEST_TERM = 50
"""How many definitions may lead from a term to its IRI; more are a circle, or as good as one."""


class TermMeanings:
    """The terms that the contexts of one document define."""

    def __init__(self, context: Any) -> None:
        self.remote: list[str] = []
        """The contexts that would have to be fetched."""
        self.prefixes: dict[str, str] = {}
        """What the document itself gives names to."""
        self.language: str | None = None
        self._defined: dict[str, str] = {}
        self._coercions: dict[str, dict[str, Any]] = {}
        """What the document defines of a term besides its IRI, such as the type of its values."""
        self._vocabulary: str | None = None
        for each in context if isinstance(context, list) else [context]:
            self._add(each)

    def _add(self, context: Any) -> None:
        if isinstance(context, str):
            if context.rstrip("/#") in W3C_CONTEXTS:
                self._defined.update(_w3c())
                self._coercions = {term: each for term, each in self._coercions.items() if term not in _w3c()}
            else:
                self.remote.append(context)
        elif isinstance(context, dict):
            for term, meaning in context.items():
                if term == "@vocab" and isinstance(meaning, str):
                    self._vocabulary = meaning
                elif term == "@language":
                    self.language = meaning if isinstance(meaning, str) else None
                elif not term.startswith("@"):
                    self._define(term, meaning)

    def _define(self, term: str, meaning: Any) -> None:
        """Take the definition of a term by a context of the document, in place of any before."""
        self._coercions[term] = meaning if isinstance(meaning, dict) else {}
        iri = self._coercions[term].get("@id") if isinstance(meaning, dict) else meaning
        if isinstance(iri, str):
            self._defined[term] = iri
            if absolute(iri) and iri.endswith(("#", "/", ":", "_")):
                self.prefixes[term] = iri

    def coerced(self, term: str, keyword: str, otherwise: Any = None) -> Any:
        """What the definition of a term says by a keyword, such as `@type`, of its values."""
        return self._coercions.get(term, {}).get(keyword, otherwise)

    def expanded(self, term: str, depth: int = 0) -> IRI | None:
        """The IRI that a term stands for, or None if that is not known here."""
        if depth > DEEPEST_TERM:
            return None
        if term in self._defined:
            return self.expanded(self._defined[term], depth + 1) if self._defined[term] != term else absolute(term)
        prefix, colon, local = term.partition(":")
        if not colon:
            return absolute(self._vocabulary + term) if self._vocabulary else None
        if prefix in self._defined and not local.startswith("//"):
            base = self.expanded(prefix, depth + 1)
            return None if base is None else absolute(base + local)
        return absolute(term) if prefix.lower() in _SCHEMES else None

    def reference(self, text: str) -> IRI | None:
        """The IRI of an `@id`, which may have a prefix and is no term; None for one that is not absolute."""
        prefix, _, local = text.partition(":")
        return self.expanded(text) if prefix in self._defined and not local.startswith("//") else absolute(text)

    def family(self, term: str) -> str:
        """What terms such as an unknown one are called together."""
        prefix, colon, _ = term.partition(":")
        return f"terms with the prefix {prefix}:" if colon else "terms without a prefix"

    def unknown(self) -> str:
        """Why a term is unknown."""
        if not self.remote:
            return "its contexts do not define them"
        return f"they may be defined by contexts on the web, which are not fetched: {', '.join(sorted(self.remote))}"


def spoken(words: str, language: object) -> Literal:
    """Words in a language, if that is said by a tag that can be one: Turtle has no other."""
    if language and isinstance(language, str):
        said = Literal(words, RDF.langString, language)
        with suppress(ValueError):
            ox_term(said)
            return said
    return Literal(words, STRING)


@cache
def _w3c() -> dict[str, str]:
    """The prefixes and classes of the W3C's context."""
    text = (files("selfconf.importing.wot") / "td-context-1.1.json").read_text("utf-8")
    return dict(_terms(json.loads(text)["@context"]))


def _terms(context: dict[str, Any]) -> Iterator[tuple[str, str]]:
    for term, meaning in context.items():
        iri = meaning.get("@id") if isinstance(meaning, dict) else meaning
        if isinstance(iri, str) and not iri.startswith("@") and not term.startswith("@"):
            yield term, iri
