"""The lints about terms: misspelt ones, those of ontologies that are not loaded, classes and properties confused.

SHACL checks what it finds and passes over what it does not know: `sh:minCnt` asks for nothing. Only terms of sc: and
sh: are errors, since there no one else can have declared them; all else warns.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterator

from rdflib import OWL, RDF, RDFS, SH, XSD, Literal, URIRef
from rdflib.namespace import DefinedNamespace
from rdflib.term import Node

from selfconf.model.diagnostic import Diagnostic
from selfconf.rdf import vocabulary
from selfconf.rdf.validation.lints.linted_file import LintedFile
from selfconf.rdf.validation.prefilter import TERM_POSITIONS
from selfconf.rdf.validation.term_index import OWN, STANDARD, TermIndex, namespace

_STANDARD: dict[str, type[DefinedNamespace]] = {str(words._NS): words for words in (RDF, RDFS, OWL, XSD, SH)}
_SC, _SH = vocabulary.SC, vocabulary.SH
LIKE = 0.7
"""How alike two words have to be for one to be a misspelling of the other; 1 is equal."""
_LISTS_OF_TERMS = (
    *(SH.path, SH.alternativePath, SH.ignoredProperties),
    *(OWL.unionOf, OWL.intersectionOf, OWL.disjointUnionOf, OWL.propertyChainAxiom),
)
"""What has a list of terms, or a path, which may be one."""
_MEMBERSHIP = re.compile(re.escape(vocabulary.RDF.base) + r"_\d+")


def unknown_terms(file: LintedFile) -> Iterator[Diagnostic]:
    """Terms of a known namespace that no ontology declares."""
    meant: dict[str, str | None] = {}  # a term that is misspelt once is often misspelt everywhere
    for iri, offset in used_terms(file):
        if not _known(iri, file.index):
            if iri not in meant:
                meant[iri] = _meant(file, iri)
            yield _unknown(file, iri, offset, meant[iri])
    for iri, offset in _queried_terms(file):
        # A query does not tell terms from things, which no ontology need declare, unless it is near one that is.
        if not _known(iri, file.index) and (like := meant.get(iri) or _meant(file, iri)):
            yield _unknown(file, iri, offset, like)


def _queried_terms(file: LintedFile) -> Iterator[tuple[str, int]]:
    """What the queries of shapes name, each with the place of its query."""
    for predicate in (SH.select, SH.ask):
        for subject, query in file.graph.subject_objects(predicate):
            if statement := file.positions.triples.get((subject, predicate, query)):
                for iri in sorted(file.named_in_query(str(query))):
                    yield iri, statement.object


def used_terms(file: LintedFile) -> Iterator[tuple[str, int]]:
    """The terms of vocabularies that a file uses, each with its place; a parameter stands for one, and is none."""
    holders = _holders_of_terms(file)
    for (subject, predicate, value), offsets in file.positions.triples.items():
        yield str(predicate), offsets.predicate
        if isinstance(value, Literal):
            if value.datatype is not None:
                yield str(value.datatype), offsets.object
        elif (
            isinstance(value, URIRef)
            and value not in file.source.parameters
            and (
                str(predicate) in TERM_POSITIONS
                or str(value) in _SC
                or str(value) in _SH
                or (subject in holders and predicate in (RDF.first, SH.hasValue))
            )
        ):
            yield str(value), offsets.object


def _holders_of_terms(file: LintedFile) -> set[Node]:
    """The shapes whose values are terms, as those of `rdf:type` are, and the cells of lists whose members are."""
    graph = file.graph
    shapes = {shape for shape, path in graph.subject_objects(SH.path) if _last_step(file, path) in TERM_POSITIONS}
    waiting = [head for shape in shapes for head in graph.objects(shape, SH["in"])]
    waiting += [head for predicate in _LISTS_OF_TERMS for head in graph.objects(None, predicate)]
    cells: set[Node] = set()
    while waiting:
        for cell in file.cells(waiting.pop()):
            if cell in cells:
                break
            cells.add(cell)
            waiting += graph.objects(cell, RDF.first)  # a path may be a list in a list
    return shapes | cells


def _last_step(file: LintedFile, path: Node) -> str:
    """The property that a path ends with."""
    return str([path, *file.items(path)][-1])


def properties_as_classes(file: LintedFile) -> Iterator[Diagnostic]:
    """Properties of selfconf as types, and any where a role asks for a class: `sc:component` is no unknown term."""
    classes, properties = file.index.classes, file.index.properties
    for (_, predicate, value), offsets in file.positions.triples.items():
        iri = str(value)
        asked = predicate == SH["class"] or (predicate == RDF.type and iri in _SC)
        if asked and iri in properties and iri not in classes:
            meant = next((one for one in sorted(classes) if one.lower() == iri.lower()), None)
            hint = f"Did you mean {file.short(meant)}?" if meant else None
            message = f"{file.short(iri)} is a property, where a class has to stand."
            yield file.at(offsets.object, "SC-L01" if iri in _SC else "SC-L02", message, hint=hint)


def classes_as_properties(file: LintedFile) -> Iterator[Diagnostic]:
    """Classes where a path or a cost names a property, and costs of a property whose values are no numbers."""
    for (_, predicate, value), offsets in file.positions.triples.items():
        iri, short = str(value), file.short(str(value))
        if (predicate == SH.path or str(predicate) == _SC.property) and isinstance(value, URIRef):
            if iri in file.index.classes and iri not in file.index.properties:
                yield file.at(offsets.object, "SC-L02", f"{short} is a class, where a property has to stand.")
            elif str(predicate) == _SC.property and iri in file.index.object_properties:
                message = f"The values of {short} are things, and a cost counts numbers."
                yield file.at(offsets.object, "SC-L02", message)


def imported_ontologies(file: LintedFile) -> Iterator[Diagnostic]:
    """Imports of ontologies that are not loaded: nothing is fetched, so what they declare is not known."""
    for ontology, imported in file.graph.subject_objects(OWL.imports):
        names = {f"{str(imported).rstrip('#/')}{end}" for end in ("", "#", "/")}
        here = any((URIRef(name), None, None) in file.graph for name in names)
        if isinstance(imported, URIRef) and not here and names.isdisjoint(file.index.terms):
            statement = file.positions.triples[ontology, OWL.imports, imported]
            message = f"The ontology <{imported}> is not loaded, as imports are not followed."
            yield file.at(statement.object, "SC-L33", message, hint="Give its file as an ontology, too.")


def _known(iri: str, index: TermIndex) -> bool:
    if not index.strange(iri):
        return True
    home = namespace(iri)
    return _has_word(home, iri[len(home) :]) or bool(_MEMBERSHIP.fullmatch(iri))


def _has_word(home: str, name: str) -> bool:
    """Whether a standard namespace has a word; rdflib cannot say so of a prefix with no name behind it."""
    return name != "" and home in _STANDARD and URIRef(home + name) in _STANDARD[home]


def _meant(file: LintedFile, iri: str) -> str | None:
    """The known term for which an unknown one probably stands."""
    home = namespace(iri)
    words = _STANDARD.get(home)
    known = [*map(str, dir(words)), *_keywords(words)] if words else sorted(file.index.terms)
    by_case = next((term for term in known if term.lower() == iri.lower()), None)  # sh:Class is not rdfs:Class
    return (
        by_case or _elsewhere(iri, file) or _closest(iri[len(home) :], [one for one in known if one.startswith(home)])
    )


def _keywords(words: type[DefinedNamespace]) -> Iterator[str]:
    """Yield the terms that are no names in Python, which rdflib does not list: `sh:class`, `sh:in`, `sh:or`."""
    return (words._NS + name for name in words._extras if name.isidentifier())


def _unknown(file: LintedFile, iri: str, offset: int, meant: str | None) -> Diagnostic:
    home = namespace(iri)
    hint = f"Did you mean {file.short(meant)}?" if meant else None
    short = file.short(iri)
    fixed = home in _STANDARD or home == _SC.base
    message = f"There is no term {short}." if fixed else f"No loaded ontology declares {short}."
    return file.at(offset, "SC-L01" if home in (_SC.base, _SH.base) else "SC-L02", message, hint=hint)


def _elsewhere(iri: str, file: LintedFile) -> str | None:
    """The term with that very name in another known namespace, for which this one has the wrong prefix.

    Between vocabularies of others and the standard ones no prefixes are confused: `spec:class` is not `sh:class`.
    """
    home = namespace(iri)
    name = iri[len(home) :]
    fixed = (
        []
        if home not in STANDARD and not home.startswith(OWN)
        else [URIRef(base + name) for base in _STANDARD if _has_word(base, name)]
    )
    declared = [term for term in file.index.terms if term[len(namespace(term)) :] == name]
    return min((*map(str, fixed), *declared), default=None)


def _closest(word: str, known: list[str]) -> str | None:
    """The known term whose name is most like a word, of equals the one that is a class or property as the word is."""
    names = {term: term[len(namespace(term)) :] for term in known}
    close = difflib.get_close_matches(word.lower(), [name.lower() for name in names.values()], n=1, cutoff=LIKE)
    alike = sorted(
        (term for term, name in names.items() if [name.lower()] == close),
        key=lambda term: names[term][:1].isupper() != word[:1].isupper(),
    )
    return alike[0] if alike else None
