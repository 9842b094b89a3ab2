"""What reads well and is probably not what was meant: misspelt terms, confused namespaces, unused roles.

SHACL checks what it finds and passes over what it does not know: `sh:minCnt` asks for nothing, and a
component whose prefix has https where http belongs is no component at all. Each lint is a function from
one file to what it finds there. Only terms of sc: and sh: are errors, since there no one else can have
declared them; all else warns.

A cycle of sc:feeds is no lint: closed loops are what control is about.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from rdflib import OWL, RDF, RDFS, SH, XSD, BNode, Graph, Literal, URIRef
from rdflib.namespace import DefinedNamespace
from rdflib.term import Node

from selfconf.model.diagnostic import Diagnostic, Severity
from selfconf.rdf import vocabulary
from selfconf.rdf.familiar import Familiar, namespace
from selfconf.rdf.findings import at
from selfconf.rdf.positions import Positions
from selfconf.rdf.screening import TERM_POSITIONS

_STANDARD: dict[str, type[DefinedNamespace]] = {str(words._NS): words for words in (RDF, RDFS, OWL, XSD, SH)}
_SC, _SH = vocabulary.SC, vocabulary.SH
_MEMBERSHIP = re.compile(re.escape(vocabulary.RDF.base) + r"_\d+")


@dataclass(frozen=True, slots=True)
class File:
    """What a lint looks at."""

    graph: Graph
    positions: Positions
    familiar: Familiar
    elsewhere: Mapping[str, str]
    """Components of this file that another file, which is named, describes as well."""

    def short(self, iri: str) -> str:
        """An IRI as the file would write it."""
        home = namespace(iri)
        for prefix, known, _ in self.positions.prefixes:
            if known == home:
                return f"{prefix}:{iri[len(home) :]}"
        return f"<{iri}>"


def lint(file: File, conforms: bool) -> list[Diagnostic]:
    """Everything that the lints find in a file; about the make-up of a template only if it `conforms`."""
    checks = (*WORDS, *TEMPLATES) if conforms else WORDS
    return [found for check in checks for found in check(file)]


def unknown_terms(file: File) -> Iterator[Diagnostic]:
    """Terms of a known namespace that nobody declares."""
    for (_, predicate, value), offsets in file.positions.triples.items():
        used: list[tuple[Node | None, int]] = [(predicate, offsets.predicate)]
        if isinstance(value, Literal):
            used.append((value.datatype, offsets.object))
        elif str(predicate) in TERM_POSITIONS or str(value) in _SC or str(value) in _SH:
            used.append((value, offsets.object))
        for term, offset in used:
            if isinstance(term, URIRef) and not _known(str(term), file.familiar):
                yield _unknown(file, str(term), offset)


def _known(iri: str, familiar: Familiar) -> bool:
    if not familiar.strange(iri):
        return True
    words = _STANDARD.get(namespace(iri))
    return words is not None and (URIRef(iri) in words or bool(_MEMBERSHIP.fullmatch(iri)))


def _unknown(file: File, iri: str, offset: int) -> Diagnostic:
    home = namespace(iri)
    words = _STANDARD.get(home)
    known = [str(term) for term in dir(words)] if words else sorted(file.familiar.terms)
    meant = _closest(iri[len(home) :], [term[len(home) :] for term in known if term.startswith(home)])
    hint = f"Did you mean {file.short(home + meant)}?" if meant else None
    short = file.short(iri)
    fixed = home in _STANDARD or home == _SC.base
    message = f"There is no term {short}." if fixed else f"No loaded ontology declares {short}."
    return at(file.positions, offset, "SC-L01" if home in (_SC.base, _SH.base) else "SC-L02", message, hint=hint)


def _closest(word: str, known: list[str]) -> str | None:
    """The known word that is most like a word, of equals the one that is a class or property as the word is."""
    close = difflib.get_close_matches(word.lower(), [term.lower() for term in known], n=1)
    alike = sorted(
        (term for term in known if [term.lower()] == close),
        key=lambda term: term[:1].isupper() != word[:1].isupper(),
    )
    return alike[0] if alike else None


def undeclared_signals(file: File) -> Iterator[Diagnostic]:
    """Signal types in a namespace that no loaded ontology covers."""
    for (_, predicate, value), offsets in file.positions.triples.items():
        signal = str(value)
        if str(predicate) != _SC.signalType or not isinstance(value, URIRef):
            continue
        if file.familiar.undeclared(signal) and _known(signal, file.familiar):
            message = f"No loaded ontology declares the signal type {file.short(signal)}."
            hint = "Give the ontology that declares it with --ontology FILE."
            yield at(file.positions, offsets.object, "SC-L03", message, hint=hint)


def described_twice(file: File) -> Iterator[Diagnostic]:
    """Components that another file describes as well."""
    for component, other in file.elsewhere.items():
        offset = file.positions.offset(URIRef(component)) or 0
        message = f"The component {file.short(component)} is described in {other} as well."
        yield at(file.positions, offset, "SC-L04", message)


def prefixes(file: File) -> Iterator[Diagnostic]:
    """Prefixes with two meanings, and namespaces that are nearly, but not quite, known ones."""
    first: dict[str, str] = {}
    for prefix, iri, offset in file.positions.prefixes:
        if first.setdefault(prefix, iri) != iri:
            message = f"The prefix {prefix}: has been bound to <{first[prefix]}> before, and is now <{iri}>."
            yield at(file.positions, offset, "SC-L05", message)
        meant = file.familiar.confused(iri)
        if meant is not None:
            severity = Severity.ERROR if meant in (_SC.base, _SH.base) else Severity.WARNING
            message = f"The namespace <{iri}> is not <{meant}>."
            yield at(file.positions, offset, "SC-L06", message, severity, f"Did you mean <{meant}>?")


def literals_for_iris(file: File) -> Iterator[Diagnostic]:
    """Literals where the property wants a thing."""
    for (_, predicate, value), offsets in file.positions.triples.items():
        ours = str(predicate) in _SC  # what selfconf's own properties want is a matter of the shapes
        if isinstance(value, Literal) and not ours and str(predicate) in file.familiar.object_properties:
            message = f"The value of {file.short(str(predicate))} is a thing with an IRI, not a literal."
            yield at(file.positions, offsets.object, "SC-L07", message)


def local_components(file: File) -> Iterator[Diagnostic]:
    """Components whose IRI depends on where the file lies."""
    kinds = file.graph.subjects(RDF.type, URIRef(_SC.Component))
    for component in kinds:
        if isinstance(component, URIRef) and component.startswith("file:"):
            message = "The IRI of this component is relative, so it changes with the place of the file."
            hint = "Declare a prefix, or a @base that starts with https:."
            yield at(file.positions, file.positions.offset(component) or 0, "SC-L08", message, hint=hint)


def unlisted_roles(file: File) -> Iterator[Diagnostic]:
    """Roles that stand in no list of roles."""
    listed = {role for roles in file.graph.objects(None, URIRef(_SC.roles)) for role in _items(file.graph, roles)}
    for role in set(file.graph.subjects(RDF.type, URIRef(_SC.Role))) - listed:
        message = "This role stands in the list of roles of no template, so nobody will play it."
        yield at(file.positions, file.positions.offset(role) or 0, "SC-L09", message)


def unused_parameters(file: File) -> Iterator[Diagnostic]:
    """Parameters that no role mentions."""
    graph = file.graph
    for parameter in graph.objects(None, URIRef(_SC.parameter)):
        uses = [predicate for _, predicate in graph.subject_predicates(parameter)]
        owners = [owner for owner in graph.subjects(URIRef(_SC.parameter), parameter) if not isinstance(owner, BNode)]
        if owners and all(str(predicate) == _SC.parameter for predicate in uses):
            offset = min(file.positions.triples[owner, URIRef(_SC.parameter), parameter].object for owner in owners)
            message = f"No role mentions the parameter {file.short(str(parameter))}."
            yield at(file.positions, offset, "SC-L10", message)


def impossible_roles(file: File) -> Iterator[Diagnostic]:
    """Property shapes that ask for more values than they allow, or for one that they do not allow."""
    graph = file.graph
    for shape in {*graph.subjects(SH.path, None)}:
        least, most = _count(graph, shape, SH.minCount), _count(graph, shape, SH.maxCount)
        allowed = graph.value(shape, SH["in"])
        values = set(_items(graph, allowed)) if allowed is not None else None
        wanted = set(graph.objects(shape, SH.hasValue))
        offset = file.positions.offset(shape) or 0
        if least is not None and most is not None and least > most:
            message = f"This asks for at least {least} and at most {most} values: nobody can play the role."
            yield at(file.positions, offset, "SC-L11", message)
        elif values is not None and least and len(values) < least:
            message = f"This asks for {least} values at least and allows {len(values)}: nobody can play the role."
            yield at(file.positions, offset, "SC-L11", message)
        elif values is not None and wanted - values:
            message = "This asks for a value that is not in its sh:in: nobody can play the role."
            yield at(file.positions, offset, "SC-L11", message)


def _count(graph: Graph, shape: Node, predicate: Node) -> int | None:
    value = graph.value(shape, predicate)
    return value.value if isinstance(value, Literal) and isinstance(value.value, int) else None


def _items(graph: Graph, head: Node) -> Iterator[Node]:
    """The members of a list, as far as it is one."""
    seen: set[Node] = set()
    cell: Node | None = head
    while cell is not None and cell not in seen:
        seen.add(cell)
        yield from graph.objects(cell, RDF.first)
        cell = graph.value(cell, RDF.rest)


WORDS: tuple[Callable[[File], Iterator[Diagnostic]], ...] = (
    unknown_terms,
    undeclared_signals,
    described_twice,
    prefixes,
    literals_for_iris,
    local_components,
)
TEMPLATES = (unlisted_roles, unused_parameters, impossible_roles)
