"""The lints about shapes that nothing conforms to: of roles, of what they recruit, and of what inputs accept."""

from __future__ import annotations

from collections.abc import Iterator

from rdflib import RDF, SH, BNode, Literal, URIRef
from rdflib.term import Node

from selfconf.model.diagnostic import Diagnostic
from selfconf.rdf.validation.lints.contradictions import (
    ShapeContradiction,
    contradictions,
    excluded_values,
)
from selfconf.rdf.validation.lints.linted_file import LintedFile
from selfconf.rdf.validation.lints.normal_form import NormalForm
from selfconf.rdf.vocabulary import SC


def impossible_roles(file: LintedFile) -> Iterator[Diagnostic]:
    """Roles, or what they recruit, whose shapes contradict themselves or what holds of every advertisement."""
    always = list(file.source.applied(SH.targetClass, URIRef(SC.Component)))
    for role in set(file.graph.subjects(RDF.type, URIRef(SC.Role))):
        short = file.short(str(role))
        normal = NormalForm(file.source, (role, *always))
        for conflict in contradictions(normal):
            yield _contradiction(file, role, conflict, f"no component can play the role {short}", "SC-L11")
        for conflict in excluded_values(normal):
            if not file.positions.triples.keys().isdisjoint(conflict):
                effect = f"only a component without such a value can play the role {short}"
                yield _contradiction(file, role, conflict, effect, "SC-L11")
        for shape in file.graph.objects(role, URIRef(SC.recruits)):
            for conflict in (
                () if isinstance(shape, Literal) else contradictions(NormalForm(file.source, (shape, *always)))
            ):
                effect = f"no component can be recruited for the role {short}"
                yield _contradiction(file, shape, conflict, effect, "SC-L19")


def impossible_inputs(file: LintedFile) -> Iterator[Diagnostic]:
    """What inputs accept that contradicts itself, or what holds of every output."""
    always = list(file.source.applied(SH.targetObjectsOf, URIRef(SC.hasOutput)))
    for shape in set(file.graph.objects(None, URIRef(SC.accepts))):
        normal = NormalForm(file.source, (shape, *always))
        for conflict in contradictions(normal):
            yield _contradiction(file, shape, conflict, "no output can feed this input", "SC-L22")
        for conflict in excluded_values(normal):
            if not file.positions.triples.keys().isdisjoint(conflict):
                effect = "only an output without such a value can feed this input"
                yield _contradiction(file, shape, conflict, effect, "SC-L22")


def nameless_values(file: LintedFile) -> Iterator[Diagnostic]:
    """Lists and nodes in brackets as the value that a shape asks for: no component of another file has it."""
    for shape, value in file.graph.subject_objects(SH.hasValue):
        if isinstance(value, BNode):
            is_list = (value, RDF.first, None) in file.graph
            hint = "Of several values any one is sh:in ( ... )." if is_list else "Name it by an IRI."
            message = (
                f"This is a {'list' if is_list else 'node'} of this file alone, so no component has it as a value."
            )
            yield file.at(file.positions.triples[shape, SH.hasValue, value].object, "SC-L11", message, hint=hint)


def _contradiction(file: LintedFile, shape: Node, conflict: ShapeContradiction, effect: str, code: str) -> Diagnostic:
    """The later of two statements, with the place of the earlier; `effect` is what follows from both."""
    places = {one: file.positions.triples[one].predicate for one in conflict if one in file.positions.triples}
    later = max(places, key=lambda one: places[one], default=conflict.one)
    earlier = conflict.other if later == conflict.one else conflict.one
    offset = places.get(later, file.offset(shape))
    hint = None
    if later == earlier and isinstance(later[2], Literal):
        message = f"No value meets {file.said(later)}, so {effect}."
    elif later == earlier:
        what = "No alternative of this can hold" if later[1] in (SH["or"], SH.xone) else "This cannot hold"
        message = f"{what} beside what else is asked for, so {effect}."
    elif earlier in places:
        there, here = file.positions.place(places[earlier]), file.positions.place(offset)
        where = f"line {there.line}" if there.line != here.line else f"column {there.column}"
        message = f"{file.said(later)} and {file.said(earlier)} ({where}) exclude each other, so {effect}."
    else:
        always = next(iter(file.source.values(earlier[0], SH.message)), "All advertisements differ from this.")
        message = f"{file.said(later)} cannot hold of any advertisement, so {effect}. {always}"
    if SH.closed in (later[1], earlier[1]):
        hint = "List what else a component may say in sh:ignoredProperties, at least rdf:type."
    return file.at(offset, code, message, hint=hint)
