"""The lints about literals: in the place of a thing or a term, and of another datatype than their property has."""

from __future__ import annotations

import re
from collections.abc import Iterator

from rdflib import OWL, RDF, RDFS, SH, XSD, Literal, URIRef
from rdflib.term import Node

from selfconf.model.curie import suggested_local_name
from selfconf.model.diagnostic import Diagnostic
from selfconf.model.literal_values import DATATYPES, MOST_CHARACTERS, TRUTH, number_of, of_range
from selfconf.rdf import vocabulary
from selfconf.rdf.validation.lints.linted_file import LintedFile

_SC = vocabulary.SC
EXAMPLES = {
    str(XSD[name]): f'"{text}"^^xsd:{name}'
    for name, text in {
        "dateTime": "2026-01-31T12:00:00",
        "dateTimeStamp": "2026-01-31T12:00:00Z",
        "date": "2026-01-31",
        "time": "12:00:00",
        "duration": "P1DT12H",
        "dayTimeDuration": "P1DT12H",
        "yearMonthDuration": "P1Y6M",
        "language": "en",
    }.items()
}
"""A literal of each datatype of short texts."""
_DECIMAL_COMMA = re.compile(r"(?<!,)([+-]?[0-9]+),([0-9]+)(?![\w.,:])")
"""Two whole numbers, where a number with a comma in it was meant; more of them are a list."""
_NAMING_TERMS = frozenset(
    (RDFS.domain, RDFS.range, OWL.inverseOf, OWL.disjointWith, OWL.onProperty, OWL.onClass, OWL.imports)
)
"""What leads to a term or an ontology, and is not read as a hierarchy; of that the shapes tell."""
VALUES = frozenset((SH.hasValue, SH.minInclusive, SH.minExclusive, SH.maxInclusive, SH.maxExclusive))
"""What shapes compare values with."""


def literals_for_iris(file: LintedFile) -> Iterator[Diagnostic]:
    """Literals where the property wants a thing, and parameters that stand for literals."""
    for predicate, value, offset in _values(file):
        # What selfconf's own properties want is a matter of the shapes.
        if predicate in _SC or predicate not in file.index.object_properties:
            continue
        if isinstance(value, Literal):
            message = f"The value of {file.short(predicate)} is a thing with an IRI, not a literal."
            hint = f"Write an IRI, such as :{suggested_local_name(value) or 'kitchen'}."
            yield file.at(offset, "SC-L07", message, hint=hint)
        elif value in file.source.parameters:
            short, typed = file.short(str(value)), (value, SH.datatype, None) in file.graph
            listed = [one for head in file.graph.objects(value, SH["in"]) for one in file.items(head)]
            if typed or any(isinstance(one, Literal) for one in listed):
                message = (
                    f"The value of {file.short(predicate)} is a thing with an IRI, and {short} stands for a literal."
                )
                instead = f"sh:nodeKind sh:IRI of {short} in place of its sh:datatype" if typed else "IRIs in its sh:in"
                yield file.at(offset, "SC-L07", message, hint=f"{'Say' if typed else 'List'} {instead}.")
    yield from _asked_for_literals(file)


def _asked_for_literals(file: LintedFile) -> Iterator[Diagnostic]:
    """Shapes that ask for a datatype where the property wants a thing."""
    for shape, datatype in file.graph.subject_objects(SH.datatype):
        for path in file.graph.objects(shape, SH.path):
            if str(path) in file.index.object_properties and str(path) not in _SC:
                message = f"The value of {file.short(str(path))} is a thing with an IRI, which has no datatype."
                offset = file.positions.triples[shape, SH.datatype, datatype].object
                yield file.at(offset, "SC-L07", message, hint="Write sh:nodeKind sh:IRI, or its class by sh:class.")


def literals_for_terms(file: LintedFile) -> Iterator[Diagnostic]:
    """Literals where RDFS and OWL name a term: a range in quotation marks is the range of nothing."""
    for (_, predicate, value), offsets in file.positions.triples.items():
        if isinstance(value, Literal) and predicate in _NAMING_TERMS:
            message = f"The value of {file.short(str(predicate))} is a term with an IRI, not a literal."
            yield file.at(offsets.object, "SC-L07", message, hint="Write it without quotation marks, with its prefix.")


def unfit_literals(file: LintedFile) -> Iterator[Diagnostic]:
    """Literals that are not of the datatype that their property has, or not written as that is."""
    for predicate, value, offset in _values(file):
        if isinstance(value, Literal) and file.index.unfit(predicate, str(value.datatype or XSD.string), str(value)):
            wanted = sorted(file.index.ranges[predicate])
            kinds = " or ".join(map(file.short, wanted))
            message = f"The value of {file.short(predicate)} is of the datatype {kinds}, and this is none."
            hint = f"Write {_written(str(value), wanted[0], file)}."
            yield file.at(offset, "SC-L26", message, hint=hint)
    numbers = file.positions.triples.values() if _DECIMAL_COMMA.search(file.positions.text) else ()
    for offset in sorted({one.object for one in numbers}):
        if (comma := _DECIMAL_COMMA.match(file.positions.text, offset)) is not None:
            message = f"{comma[0]} are two values, {comma[1]} and {comma[2]}."
            hint = f"Write {comma[1]}.{comma[2]} for one, and {comma[1]} , {comma[2]} for two."
            yield file.at(offset, "SC-L26", message, hint=hint)


def _values(file: LintedFile) -> Iterator[tuple[str, Node, int]]:
    """The values in a file, each with the property of which it is one, or is asked to be one by a shape."""
    listed = {cell: shape for shape, values in file.graph.subject_objects(SH["in"]) for cell in file.cells(values)}
    for (node, predicate, value), offsets in file.positions.triples.items():
        shape = listed.get(node) if predicate == RDF.first else node if predicate in VALUES else None
        of = predicate if shape is None else file.graph.value(shape, SH.path)
        if isinstance(of, URIRef):
            yield str(of), value, offsets.object


def _written(text: str, datatype: str, file: LintedFile) -> str:
    """A text as a literal of a datatype, if it is one; an example otherwise."""
    known = len(text) <= MOST_CHARACTERS and of_range(text, datatype, datatype)
    if datatype == str(XSD.string):
        return f'"{text}"' if known else "it in quotation marks"
    if datatype == str(XSD.boolean):
        return "true or false" if text not in TRUTH else "true" if TRUTH[text] else "false"
    if datatype in DATATYPES and (not known or number_of(text, datatype) is not None):
        example = next(one for one in ("1.5", "10", "-10") if of_range(one, datatype, datatype))
        whole = "" if "." in example else "whole "
        return text if known else f"a {whole}number, such as {example}"
    return f'"{text}"^^{file.short(datatype)}' if known else f"it as in {EXAMPLES[datatype]}"
