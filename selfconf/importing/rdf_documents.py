"""Advertisements in any format of RDF that Oxigraph reads: Turtle, N-Triples, N-Quads, TriG, RDF/XML and JSON-LD.

Everything that a document with components says is kept, so it may hold templates and ontologies too; a component that
does not conform is left out, because a file with it would not validate. Blank nodes are written where they are used, if
that is once.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Container, Iterable, Iterator

from selfconf.errors import AuthorError, TurtleError
from selfconf.importing.imported import DescribedValue, Description, ImportedDocument, NestedNode, TermList, grouped
from selfconf.importing.ledger import ImportLedger
from selfconf.importing.naming import stem
from selfconf.importing.sources import SourceDocument
from selfconf.importing.turtle_text import turtle
from selfconf.model.term import IRI, BlankNode, Term
from selfconf.rdf.advertisements import read_advertisements
from selfconf.rdf.turtle import Document, Node, read_ontology
from selfconf.rdf.vocabulary import FIRST, NIL, REST, SC, TYPE

DEEPEST_NODE = 20
"""How deep nodes are written into each other; what lies deeper gets a label, and is written beside them."""


def import_rdf(sources: Iterable[SourceDocument], ledger: ImportLedger) -> Iterator[ImportedDocument]:
    """The documents of RDF that advertise components."""
    seen: set[Node] = set()
    for source, document in rdf_documents(sources, ledger):
        components = document.instances(SC.Component)
        if not components:
            ledger.leave_out("documents without components", "there is nothing to advertise in them", source)
            continue
        refused = _refused(document, source, ledger)
        for component in components:
            if component in seen and component not in refused:
                ledger.leave_out("components", "an earlier source advertises them already", source)
                refused.add(component)
        seen.update(component for component in components if component not in refused)
        descriptions = tuple(each for each in described(document, refused) if each.subject not in refused)
        if any(SC.Component in each.values(TYPE) for each in descriptions):
            yield ImportedDocument(stem(source), source.name, descriptions, document.prefixes)


def rdf_documents(sources: Iterable[SourceDocument], ledger: ImportLedger) -> Iterator[tuple[SourceDocument, Document]]:
    """The documents of RDF that can be read, with their sources; the others are noted.

    Relative IRIs count from the name of a document in the namespace, wherever it lies.
    """
    for source in sources:
        try:
            document = _read(source, ledger)
        except AuthorError as error:
            ledger.unreadable(error)
        else:
            yield source, document


def _read(source: SourceDocument, ledger: ImportLedger) -> Document:
    namespace = ledger.namespace.removesuffix("#") + "/" * ledger.namespace.endswith("#")  # a base has no fragment
    try:
        return read_ontology(source.octets, source.shown, namespace + stem(source))
    except TurtleError as error:  # which quotes the source, line breaks and all
        message = " ".join(error.message.split())
        raise AuthorError(message, file=error.file, line=error.line, column=error.column) from None


def _refused(document: Document, source: SourceDocument, ledger: ImportLedger) -> set[Node]:
    """The components that do not conform, noted; they are judged as they would be written."""
    text = turtle(ImportedDocument("", "", tuple(described(document)), document.prefixes), "rdf")
    _, malformed = read_advertisements(text.encode(), source.shown)
    refused: set[Node] = {each for each in document.instances(SC.Component) if isinstance(each, BlankNode)}
    if refused:  # a blank node is called otherwise in the text
        ledger.leave_out("components that do not conform", "a component has an IRI", source, len(refused))
    for each in malformed:
        if isinstance(each.component, IRI):
            refused.add(each.component)
            ledger.leave_out("components that do not conform", each.problems[0], source)
    return refused


def described(document: Document, left_out: Container[Node] = ()) -> Iterator[Description]:
    """What a document says, subject by subject, in its order; of a blank node that is left out it says nothing.

    A subject with an IRI, or that several statements lead to, is described all the same.
    """
    uses = Counter(value for _, _, value in document.triples() if isinstance(value, BlankNode))
    inlined: set[Node] = set()

    def value(term: Term, depth: int) -> DescribedValue:
        if isinstance(term, BlankNode) and uses[term] == 1 and depth < DEEPEST_NODE and term not in inlined:
            members = _members(document, term, uses)
            if members is not None:
                inlined.update(cell for cell, _ in members)
                return TermList(tuple(value(member, depth + 1) for _, member in members))
            inlined.add(term)
            said = grouped((p, value(o, depth + 1)) for p, o in document.about(term))
            return NestedNode(() if term in left_out else said)
        return term

    named = dict.fromkeys(each for each in document.statements if isinstance(each, IRI) or uses[each] != 1)
    for subject in named:
        yield Description(subject, grouped((p, value(o, 0)) for p, o in document.about(subject)))
    for subject in document.statements:  # what is in a circle, or too deep to be written where it is used
        if subject not in named and subject not in inlined:
            inlined.add(subject)
            yield Description(subject, grouped((p, value(o, 0)) for p, o in document.about(subject)))


def _members(document: Document, head: BlankNode, uses: Counter[BlankNode]) -> list[tuple[Node, Term]] | None:
    """The cells and members of a list that nothing else leads into, or None if it is no such list."""
    found: list[tuple[Node, Term]] = []
    seen: set[Term] = set()
    cell: Term = head
    while cell != NIL:
        said = dict(document.about(cell))
        if not isinstance(cell, BlankNode) or set(said) != {FIRST, REST} or len(document.about(cell)) != 2:
            return None
        if cell in seen or uses[cell] != 1:
            return None
        seen.add(cell)
        found.append((cell, said[FIRST]))
        cell = said[REST]
    return found
