"""The lints about shapes that nothing conforms to, or all alike: of roles, recruits, and what inputs accept."""

from __future__ import annotations

import re
from collections.abc import Iterator

from rdflib import RDF, SH, BNode, Literal, URIRef
from rdflib.term import Node

from selfconf.model.diagnostic import Diagnostic
from selfconf.rdf.sparql import hidden
from selfconf.rdf.validation.lints.contradictions import (
    ShapeContradiction,
    contradictions,
    excluded_values,
)
from selfconf.rdf.validation.lints.linted_file import LintedFile
from selfconf.rdf.validation.lints.normal_form import NormalForm
from selfconf.rdf.vocabulary import SC


def queries_about_nothing(file: LintedFile) -> Iterator[Diagnostic]:
    """Queries of constraints whose pattern does not ask about $this: they judge all components alike."""
    for constraint in set(file.graph.objects(None, SH.sparql)):
        for query in file.graph.objects(constraint, SH.select):
            pattern = hidden(str(query)).partition("{")[2]
            variables = {one[1:] for one in re.findall(r"[?$]\w+", pattern)}
            if "this" not in variables:
                alike = sorted(one for one in variables if one.lower() == "this")
                message = "The pattern of this query does not ask about $this, so it judges all components alike."
                hint = f"Write $this in place of ${alike[0]}." if alike else "In it $this is the component."
                offset = file.positions.triples[constraint, SH.select, query].object
                yield file.at(offset, "SC-L34", message, hint=hint)


def lone_alternatives(file: LintedFile) -> Iterator[Diagnostic]:
    """Several `sh:or`, or `sh:xone`, of one alternative each, of one shape: all of them have to hold."""
    for predicate in (SH["or"], SH.xone):
        for shape in set(file.graph.subjects(predicate)):
            heads = list(file.graph.objects(shape, predicate))
            if len(heads) > 1 and all(len(list(file.items(head))) == 1 for head in heads):
                word = file.short(str(predicate))
                message = f"Each {word} of this shape has one alternative, so all of them have to hold."
                offset = max(file.positions.triples[shape, predicate, head].object for head in heads)
                yield file.at(offset, "SC-L35", message, hint=f"Write {word} ( ... ) once, with all of them in it.")


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
