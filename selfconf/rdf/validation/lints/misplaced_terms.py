"""The lints about terms that are said of the wrong thing: each is known, says nothing there, and is passed over."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from rdflib import RDF, URIRef
from rdflib.term import Node

from selfconf.model.diagnostic import Diagnostic
from selfconf.model.term import IRI
from selfconf.rdf import vocabulary
from selfconf.rdf.permitted_fields import COMPONENT, LINKED, OF_PARTS, foreign_terms
from selfconf.rdf.validation.lints.linted_file import LintedFile

_SC = vocabulary.SC
_OF_PARTS_OF_TEMPLATES: Mapping[IRI, tuple[IRI, ...]] = {
    _SC.parameter: (_SC.Template,),
    **dict.fromkeys((_SC.output, _SC.input), (_SC.Interaction,)),
}
_OF_OTHERS: Mapping[IRI, tuple[IRI, ...]] = {
    **dict.fromkeys((_SC.signalType, _SC.of), (_SC.Input, _SC.Output)),
    _SC.parameterType: (_SC.OperationalParameter, _SC.Setting),
    **dict.fromkeys((_SC.role, _SC.component), (_SC.Assignment,)),
    _SC.task: (_SC.Configuration,),
}
"""What parts of templates do not say, with the classes of what does; of ports it is another lint that tells."""
_SAID_OF: Mapping[IRI, tuple[IRI, ...]] = {
    **OF_PARTS,
    **_OF_PARTS_OF_TEMPLATES,
    **_OF_OTHERS,
    _SC.template: (_SC.Grounding, _SC.Task),
    _SC.value: (),
}
"""What is passed over elsewhere than at an instance of some classes, with these; a value is that of what has none."""
_OF_TEMPLATES = (_SC.Template, _SC.Interaction, _SC.Task, _SC.Role, _SC.Parameter)
"""Templates and tasks, and what they are made of."""
_WITH_VALUES = "a rate or a duration, of what a role sets, and of a binding"
_INSTEAD: Mapping[tuple[str, IRI], str] = {
    (_SC.Role, _SC.optional): "A role that may stay unplayed has sc:minCount 0.",
    (_SC.Component, _SC.parameter): "What is set of a component is its sc:hasParameter.",
    (_SC.Task, _SC.parameter): "A task has sc:binding [ sc:parameter ... ; sc:value ... ].",
    (_SC.Parameter, _SC.value): "The default of a parameter is sh:defaultValue.",
    (_SC.Parameter, _SC.parameterType): "A role says by sc:sets of which type the parameter is that it sets.",
    (_SC.Template, _SC.role): "The list of all roles of a template is its sc:roles.",
    (_SC.Role, _SC.signalType): "Write sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:hasValue ... ].",
    (
        _SC.Role,
        _SC.parameterType,
    ): "Write sh:property [ sh:path ( sc:hasParameter sc:parameterType ) ; sh:hasValue ... ].",
    (_SC.Interaction, _SC.signalType): "An interaction names ports, by sc:output and sc:input.",
    (_SC.grounding, _SC.task): "The inside of a composite is its sc:template.",
    **dict.fromkeys(((_SC.term, _SC.role), (_SC.term, _SC.of)), "The role that a term counts is its sc:ofRole."),
}
"""What is written in place of a term that says nothing of an instance of a class, or of what a property leads to."""


def misplaced_terms(file: LintedFile) -> Iterator[Diagnostic]:
    """What is said of a component or a part of one, or of a template or a part, and is read of others alone."""
    foreign: dict[Node, frozenset[IRI]] = {}
    for kind in _OF_TEMPLATES:
        others = frozenset(said for said, owners in _SAID_OF.items() if kind not in owners)
        foreign |= dict.fromkeys(file.graph.subjects(RDF.type, URIRef(kind)), others)
    components = file.graph.subjects(RDF.type, URIRef(_SC.Component))
    foreign |= dict.fromkeys(components, foreign_terms(COMPONENT).union(_OF_PARTS_OF_TEMPLATES))
    for link, subject in LINKED.items():
        foreign |= dict.fromkeys(file.graph.objects(None, URIRef(link)), foreign_terms(subject))
    foreign |= dict.fromkeys(file.graph.objects(None, URIRef(_SC.term)), frozenset((_SC.role, _SC.of)))
    for grounding in set(file.graph.objects(None, URIRef(_SC.grounding))):
        foreign[grounding] = foreign.get(grounding, frozenset()).union((_SC.task,))
    for (node, predicate, _), offsets in file.positions.triples.items():
        said = IRI.unchecked(str(predicate))
        if said in foreign.get(node, ()):
            owners = " or ".join(f"a {file.short(owner)}" for owner in _SAID_OF[said]) or _WITH_VALUES
            kinds = (*file.graph.objects(node, RDF.type), *file.graph.predicates(None, node))
            instead = (_INSTEAD[str(kind), said] for kind in kinds if (str(kind), said) in _INSTEAD)
            hint = next(instead, f"It is said of {owners}.")
            message = f"{file.short(said)} says nothing here, so this is passed over."
            yield file.at(offsets.predicate, "SC-L25", message, hint=hint)


def templates_as_groundings(file: LintedFile) -> Iterator[Diagnostic]:
    """Templates that are the grounding of a component, not its inside: the component is no composite by that."""
    for component, grounding in file.graph.subject_objects(URIRef(_SC.grounding)):
        if (grounding, RDF.type, URIRef(_SC.Template)) in file.graph:
            short = file.short(str(grounding))
            offset = file.positions.triples[component, URIRef(_SC.grounding), grounding].object
            message = f"{short} is a template, and what a grounding has inside is its sc:template."
            yield file.at(offset, "SC-L25", message, hint=f"Write sc:grounding [ sc:template {short} ].")
