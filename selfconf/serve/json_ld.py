"""What an advertisement says as members of JSON-LD: properties of a component, and words in their languages."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

from selfconf.model.term import IRI, STRING, Literal, Term
from selfconf.rdf.sparql import QUERY_PREFIXES
from selfconf.rdf.turtle import SKOLEM
from selfconf.rdf.vocabulary import XSD
from selfconf.serve.watching.component_bodies import KNOWN_NAMES

CONTEXT = dict(QUERY_PREFIXES)
"""The prefixes by which members, types and datatypes are written, which are those of `KNOWN_NAMES`."""
_INTEGER = re.compile(r"-?[1-9][0-9]{0,14}|0")
"""The integers that JSON writes as they are, and every reader of it reads so; others keep their form in a string."""


def name_of(iri: IRI) -> str:
    """An IRI as a member or type: with a prefix of the context, or in full."""
    return KNOWN_NAMES(iri).strip("<>")


def members(properties: Iterable[tuple[IRI, Term]]) -> dict[str, Any]:
    """Properties as members; one without a name of its own (a blank node) is left out, as what it says is not there."""
    found: dict[str, list[Any]] = {}
    for predicate, value in properties:
        if isinstance(value, Literal) or (isinstance(value, IRI) and not value.startswith(SKOLEM)):
            found.setdefault(name_of(predicate), []).append(value_of(value))
    return {member: values[0] if len(values) == 1 else values for member, values in found.items()}


def value_of(term: IRI | Literal) -> Any:
    """A value: a reference, a plain value, or one with its datatype or language."""
    if isinstance(term, IRI):
        return {"@id": str(term)}
    if term.language:
        return {"@value": term.lexical, "@language": term.language}
    if term.datatype == STRING:
        return term.lexical
    if term.datatype == XSD.boolean and term.lexical in ("true", "false"):
        return term.lexical == "true"
    if term.datatype == XSD.integer and _INTEGER.fullmatch(term.lexical):
        return int(term.lexical)
    return {"@value": term.lexical, "@type": name_of(term.datatype)}


def in_languages(member: str, said: Iterable[Term]) -> tuple[dict[str, Any], list[Term]]:
    """A title or description, with its texts in other languages, and those words that have no room in it.

    A description has one text without a language, or else that of the first language, and one for each language.
    """
    literals = [one for one in said if isinstance(one, Literal)]
    several: dict[str, Literal] = {}
    for one in literals:
        if one.language:
            several.setdefault(one.language, one)
    kept = [*[one for one in literals if one.datatype == STRING][:1], *several.values()]
    rest = [one for one in said if one not in kept]
    if not kept:
        return {}, rest
    found: dict[str, Any] = {member: kept[0].lexical}
    if several:
        found[f"{member}s"] = {language: one.lexical for language, one in several.items()}
    return found, rest
