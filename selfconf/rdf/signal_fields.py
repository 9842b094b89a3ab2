"""The fields of a kind of signal, from the ontologies that describe it and the kinds of signals above it.

`rob:field` gives a kind of signal the list of its fields. What is below it has these too, so that it can be sent
wherever the other is wanted; of two fields of one name the one nearer to the kind itself counts. Statements that are
not in order are passed over here: validation names them, and a component is not kept from its work by them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from selfconf.model.literal_values import truth
from selfconf.model.signal_fields import SignalField, SignalFields
from selfconf.model.term import IRI, Literal, Term
from selfconf.rdf.turtle import Document
from selfconf.rdf.vocabulary import FIRST, RDFS, REST, ROB

SAYING = (ROB.field, ROB.fieldName, ROB.datatype, ROB.repeated, ROB.optional, RDFS.subClassOf, FIRST, REST)
"""The predicates of the statements that are looked at; of others a document need not know."""


def fields_of(documents: Sequence[Document], signal: IRI) -> SignalFields | None:
    """The fields of a kind of signal; None if the documents say nothing of them, so that nothing can be checked."""
    fields: dict[str, SignalField] = {}
    for kind in _upwards(documents, signal):
        for document in documents:
            for head in document.values(kind, ROB.field):
                for node in document.items(head):
                    one = _field(document, node)
                    if one is not None:
                        fields.setdefault(one.name, one)
    return SignalFields(signal, tuple(fields.values())) if fields else None


def _upwards(documents: Sequence[Document], signal: IRI) -> Iterator[IRI]:
    """A kind of signal and all that lie above it, the nearer ones first."""
    waiting, seen = [signal], {signal}
    for kind in waiting:  # which grows
        yield kind
        above = (value for document in documents for value in document.values(kind, RDFS.subClassOf))
        for value in above:
            if isinstance(value, IRI) and value not in seen:
                seen.add(value)
                waiting.append(value)


def _field(document: Document, node: Term) -> SignalField | None:
    name, datatype = document.value(node, ROB.fieldName), document.value(node, ROB.datatype)
    if not isinstance(name, Literal) or not isinstance(datatype, IRI):
        return None
    optional, repeated = (truth(document.value(node, says)) is True for says in (ROB.optional, ROB.repeated))
    return SignalField(name.lexical, datatype, not optional, repeated)
