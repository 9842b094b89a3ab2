"""Terms of selfconf and SHACL that there are not: `validate` calls them errors, and to a search they say nothing.

A misspelt `sc:feeds` or `sh:minCount` has no meaning, and so a role or an advertisement says less than its author
believes. A command that acts on it warns and goes on; `validate` says where, and what was meant. A query that asks for
such a term finds nothing, which looks like an answer.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from selfconf import library
from selfconf.model.term import IRI, Term
from selfconf.model.wording import as_typed
from selfconf.rdf import turtle
from selfconf.rdf.advertisements import Advertisement, LoadedAdvertisement
from selfconf.rdf.vocabulary import ROB, SC, SH, TYPE

if TYPE_CHECKING:
    from selfconf.api.task import TaskSpecification

MOST_LOOKED_AT = 1000
"""How many advertisements of an ecology are looked at: a hundred thousand take longer than a search among them."""
_USUAL = frozenset(
    f"{SH.base}{name}"
    for name in (
        *("class", "datatype", "defaultValue", "description", "hasValue", "in", "maxCount", "maxInclusive", "minCount"),
        *("minInclusive", "name", "nodeKind", "not", "or", "path", "property", "NodeShape", "PropertyShape"),
    )
)
"""Terms of SHACL that most templates use: rdflib, which knows all of them, need not be loaded for these."""
_PREFIXES = {SC.base: "sc:", SH.base: "sh:"}
_CURIES = re.compile(r"(?<![\w?$@:.-])([^\W\d_][\w.-]*)?:(\w+)")
_DECLARATIONS = re.compile(r"\bprefix\s+([^\s:]*)\s*:\s*<([^<>]*)>", re.IGNORECASE)
_NAMED = {base: re.compile(f"<({re.escape(base)}[^<>]*)>") for base in _PREFIXES}


def undeclared_terms(triples: Iterable[tuple[Term, IRI, Term]], prefixes: Mapping[str, str] = _PREFIXES) -> list[str]:
    """The predicates and types of `sc:` and `sh:`, or by other prefixes, that no ontology declares, as sorted CURIEs.

    `prefixes` has prefixes by their namespaces, of which `rob:` may be one.
    """
    found: set[str] = set()
    for _, predicate, value in triples:
        used = (predicate, value) if predicate == TYPE else (predicate,)
        for term in used:
            for base, prefix in prefixes.items():
                if isinstance(term, IRI) and term.startswith(base) and not _declared(term, base):
                    found.add(prefix + term[len(base) :])
    return sorted(found)


def unknown_in_task(task: TaskSpecification) -> Iterator[str]:
    """A sentence about the document of a template or task, if it uses terms that there are not."""
    document = task.document.document
    yield from _sentence(document.source, undeclared_terms(document.triples()))


def unknown_in_file(path: Path) -> Iterator[str]:
    """A sentence about a file of Turtle, if it uses terms that there are not, also of `rob:`."""
    triples = turtle.parse(path.read_bytes(), str(path)).triples()
    yield from _sentence(str(path), undeclared_terms(triples, _PREFIXES | {ROB.base: "rob:"}))


def unknown_in_query(text: str) -> Iterator[str]:
    """A sentence about each term of selfconf and SHACL in a SPARQL query that there is not, also of `rob:`."""
    from selfconf.rdf.sparql import QUERY_PREFIXES, without  # which a configuration does not need

    prefixes = QUERY_PREFIXES | dict(_DECLARATIONS.findall(without(text, "#", '"', "'")))
    for prefix, name in sorted(set(_CURIES.findall(without(text, "#", '"', "'", "<")))):
        base = prefixes.get(prefix, "")
        if base in (SC.base, SH.base, ROB.base) and not _declared(f"{base}{name}", base):
            yield f"no ontology of selfconf has the term {prefix}:{name}; is it misspelt?"


def unknown_in_ecology(advertisements: Mapping[IRI, Advertisement]) -> Iterator[str]:
    """A sentence about each file of advertisements with terms that there are not; of very many files about some."""
    found: dict[str, set[str]] = {}
    for _, advertisement in zip(range(MOST_LOOKED_AT), advertisements.values(), strict=False):
        terms = [] if _all_declared(advertisement) else undeclared_terms(advertisement.triples)
        if terms:
            place = advertisement.profile.place
            found.setdefault(place.source if place else advertisement.component, set()).update(terms)
    for source, unknown in sorted(found.items()):
        yield from _sentence(source, sorted(unknown))


def _all_declared(advertisement: Advertisement) -> bool:
    """Whether the text of an advertisement names no term that there is not: most are spared a closer look."""
    return isinstance(advertisement, LoadedAdvertisement) and all(
        _declared(term, base)
        for text in (statement.text for statement in advertisement.statements)
        for base, named in _NAMED.items()
        if base in text
        for term in named.findall(text)
    )


def _sentence(source: str, terms: list[str]) -> Iterator[str]:
    if terms:
        one = len(terms) == 1
        what = f"the term {terms[0]}" if one else f"the terms {', '.join(terms)}"
        yield (
            f"{source}: no ontology has {what}, so {'it says' if one else 'they say'} nothing;"
            f" `selfconf validate {as_typed(source)}` shows where"
        )


def _declared(term: str, base: str) -> bool:
    if base == SH.base:
        return term in _USUAL or _in_shacl(term)
    return term in _of_selfconf(base)


@cache
def _of_selfconf(base: str) -> frozenset[str]:
    """The terms of `sc:` or `rob:`."""
    stem = "selfconf" if base == SC.base else "robotics"
    (ontology,) = (path for path in library.ontologies() if path.stem == stem)
    return frozenset(
        subject
        for subject, _, _ in turtle.parse(ontology.read_bytes(), ontology.name).triples()
        if isinstance(subject, IRI) and subject.startswith(base)
    )


@cache
def _in_shacl(term: str) -> bool:
    """Whether `sh:` has a term, by the list of rdflib, which takes a moment to load."""
    from rdflib import SH as SHACL
    from rdflib import URIRef

    return URIRef(term) in SHACL
