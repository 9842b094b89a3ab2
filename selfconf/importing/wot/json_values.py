"""The values of a member of a thing as terms: what JSON-LD 1.1 makes of plain, typed and spoken values and of IRIs.

A value has the type or language that it states itself (a value object), else that of the definition of its member in
the context of the document (JSON-LD 1.1 API, section 5.3). What is nested deeper is no value of an advertisement.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from selfconf.importing.wot.contexts import TermMeanings, spoken
from selfconf.importing.wot.json_text import one_or_several
from selfconf.model.term import IRI, STRING, Literal, Term
from selfconf.rdf.vocabulary import RDF, XSD

Unkept = tuple[str, str]
"""What a value is that is no term of an advertisement, in words, and why not."""
NESTED: Unkept = "nested values of other vocabularies", "only plain values are kept"
_RELATIVE: Unkept = "references that are no absolute IRIs", "what they are relative to is not known"
_UNKNOWN_TYPE: Unkept = "values of datatypes that its contexts do not define", "without its type a value says less"
_PLAIN = str | bool | int | float


def terms_of(member: str, value: Any, meanings: TermMeanings) -> Iterator[Term | Unkept]:
    """Each value of a member as a term, or what it is instead."""
    container = meanings.coerced(member, "@container")
    if isinstance(value, dict) and set(value) == {"@set"}:
        value = value["@set"]
    if "@list" in one_or_several(container):
        yield NESTED
    elif isinstance(value, dict) and "@language" in one_or_several(container):
        for language, words in value.items():
            for each in one_or_several(words):
                yield spoken(each, language) if isinstance(each, str) else NESTED
    else:
        for each in value if isinstance(value, list) else [value]:
            if each is not None:  # which says nothing
                yield _term(member, each, meanings)


def _term(member: str, value: Any, meanings: TermMeanings) -> Term | Unkept:
    if isinstance(value, dict):
        return _stated(value, meanings)
    kind = meanings.coerced(member, "@type")
    if isinstance(value, str):
        if kind == "@id":
            return meanings.reference(value) or _RELATIVE
        if kind == "@vocab":
            return meanings.expanded(value) or meanings.reference(value) or _RELATIVE
        if kind in (None, "@none"):
            return spoken(value, meanings.coerced(member, "@language", meanings.language))
    return _literal(value, None if kind in ("@id", "@vocab", "@none") else kind, meanings)


def _stated(value: dict[str, Any], meanings: TermMeanings) -> Term | Unkept:
    """An object that is only an `@id`, or a value with its type or language."""
    if set(value) == {"@id"} and isinstance(value["@id"], str):
        return meanings.reference(value["@id"]) or _RELATIVE
    if "@value" not in value or not set(value) <= {"@value", "@type", "@language"}:
        return NESTED
    if "@language" in value and isinstance(value["@value"], str):
        return spoken(value["@value"], value["@language"] if isinstance(value["@language"], str) else None)
    return _literal(value["@value"], value.get("@type"), meanings)


def _literal(value: Any, kind: Any, meanings: TermMeanings) -> Literal | Unkept:
    """A plain value as a literal of a datatype, or of its own where none is stated."""
    if not isinstance(value, _PLAIN) or kind == "@json" or (isinstance(value, float) and not math.isfinite(value)):
        return NESTED
    lexical, own = _lexical(value)
    if kind is None:
        return Literal(lexical, own)
    datatype = meanings.expanded(kind) if isinstance(kind, str) else None
    return _UNKNOWN_TYPE if datatype is None or datatype == RDF.langString else Literal(lexical, datatype)


def _lexical(value: str | bool | int | float) -> tuple[str, IRI]:
    """How a plain value is written, and the datatype that it has by itself."""
    if isinstance(value, bool):
        return str(value).lower(), XSD.boolean
    if isinstance(value, str):
        return value, STRING
    return (str(value), XSD.integer) if isinstance(value, int) else (repr(value), XSD.double)
