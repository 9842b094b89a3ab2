"""The lints about parameters of templates: such as no template has, or no role mentions, or a query cannot have."""

from __future__ import annotations

from collections.abc import Iterator

from rdflib import RDF, SH, URIRef
from rdflib.term import Node

from selfconf.model.diagnostic import Diagnostic
from selfconf.rdf.validation.lints.linted_file import LintedFile
from selfconf.rdf.validation.lints.roles import said_for
from selfconf.rdf.vocabulary import SC


def unlisted_parameters(file: LintedFile) -> Iterator[Diagnostic]:
    """Parameters that no template has."""
    listed = set(file.graph.objects(None, URIRef(SC.parameter)))
    for parameter in set(file.graph.subjects(RDF.type, URIRef(SC.Parameter))) - listed:
        message = "No template has this parameter, so it stands for itself and never for a value."
        hint = f"Say sc:parameter {file.short(str(parameter))} of its template."
        yield file.at(file.offset(parameter), "SC-L15", message, hint=hint)


def borrowed_parameters(file: LintedFile) -> Iterator[Diagnostic]:
    """Parameters of one template that a role of another mentions, which has not listed them."""
    graph = file.graph
    owners: dict[Node, set[Node]] = {}
    for template, parameter in graph.subject_objects(URIRef(SC.parameter)):
        owners.setdefault(parameter, set()).add(template)
    for template, head in graph.subject_objects(URIRef(SC.roles)) if owners else ():
        for mention in {one for role in file.items(head) for one in said_for(file, role)}:
            if template not in owners.get(mention[2], {template}) and mention in file.positions.triples:
                short, of = file.short(str(mention[2])), file.short(str(template))
                message = f"{of} has no parameter {short}, so for it this stands for itself and never for a value."
                hint = f"Say sc:parameter {short} of {of} as well."
                yield file.at(file.positions.triples[mention].object, "SC-L15", message, hint=hint)


def unused_parameters(file: LintedFile) -> Iterator[Diagnostic]:
    """Parameters that no role mentions."""
    graph = file.graph
    for parameter in graph.objects(None, URIRef(SC.parameter)):
        uses = [predicate for _, predicate in graph.subject_predicates(parameter)]
        having = graph.subjects(URIRef(SC.parameter), parameter)  # a binding names it, too
        owners = [owner for owner in having if (owner, RDF.type, URIRef(SC.Template)) in graph]
        if owners and all(str(predicate) == SC.parameter for predicate in uses):
            offset = min(file.positions.triples[owner, URIRef(SC.parameter), parameter].object for owner in owners)
            message = f"No role mentions the parameter {file.short(str(parameter))}."
            yield file.at(offset, "SC-L10", message)


def queried_parameters(file: LintedFile) -> Iterator[Diagnostic]:
    """Parameters in the text of a query, which is taken as it stands."""
    parameters = {str(one) for one in file.graph.objects(None, URIRef(SC.parameter)) if isinstance(one, URIRef)}
    for predicate in (SH.select, SH.ask) if parameters else ():
        for subject, query in file.graph.subject_objects(predicate):
            for parameter in sorted(parameters & file.named_in_query(str(query))):
                short = file.short(parameter)
                message = f"The parameter {short} stands for itself in a query, and never for a value."
                hint = f"Ask for its value beside the query, as by sh:in ( {short} )."
                offset = file.positions.triples[subject, predicate, query].object
                yield file.at(offset, "SC-L16", message, hint=hint)
