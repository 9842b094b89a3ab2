"""The lints about roles: such as stand in no list, and shapes of roles that do not ask for what was meant."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from rdflib import RDF, SH, BNode, Literal, URIRef
from rdflib.term import Node

from selfconf.model.diagnostic import Diagnostic
from selfconf.model.term import IRI
from selfconf.rdf import vocabulary
from selfconf.rdf.permitted_fields import (
    LINKED,
    LISTS_OF_SHAPES,
    OF_COMPONENT,
    OF_PARTS,
    PERMITTED_IN_SHAPES,
    SHAPE_VALUED,
)
from selfconf.rdf.validation.lints.contradictions import (
    entails,
)
from selfconf.rdf.validation.lints.linted_file import LintedFile
from selfconf.rdf.validation.lints.normal_form import NormalForm
from selfconf.rdf.validation.term_index import OWN, STANDARD, namespace
from selfconf.rdf.vocabulary import ROB, SC

_READ_IN_SHAPES = PERMITTED_IN_SHAPES.union(
    vocabulary.SH[name]
    for name in ("sparql", "prefixes", "declare", "targetNode", "targetClass", "targetSubjectsOf", "targetObjectsOf")
)
_OF_PARTS_ALONE: Mapping[IRI, IRI] = {
    said: link
    for said in (*OF_PARTS, SC.signalType, SC.parameterType)
    for link in (SC.grounding, SC.hasOperation, SC.hasParameter, SC.hasInput, SC.hasOutput)
    if said in LINKED[link].predicates and LINKED[link][said].most != 0
}
"""What ports, parameters and the like say, and no component, each with what leads to such a part."""
_INSTEAD_OF_WORDS: Mapping[str, str] = {
    **dict.fromkeys((vocabulary.SH.value, SC.value), "Did you mean sh:hasValue?"),
    SC.signalType: "Write [ sh:path ( sc:hasOutput sc:signalType ) ; sh:hasValue ... ].",
    SC.name: "Write [ sh:path ( sc:hasOutput sc:name ) ; sh:hasValue ... ].",
    vocabulary.SH.resultMessage: "Did you mean sh:message?",
    vocabulary.SH.resultSeverity: "Did you mean sh:severity?",
    **dict.fromkeys((vocabulary.SH.select, vocabulary.SH.ask), "Write sh:sparql [ sh:select ... ]."),
}
"""What an author meant who wrote a word that says nothing in a shape."""


def unlisted_roles(file: LintedFile) -> Iterator[Diagnostic]:
    """Roles that stand in no list of roles."""
    listed = {role for roles in file.graph.objects(None, URIRef(SC.roles)) for role in file.items(roles)}
    for role in set(file.graph.subjects(RDF.type, URIRef(SC.Role))) - listed:
        message = "This role stands in the list of roles of no template, so no component plays it."
        yield file.at(file.offset(role), "SC-L09", message)


def unjoined_optional_roles(file: LintedFile) -> Iterator[Diagnostic]:
    """Roles that may stay unplayed (`sc:minCount 0`), and that nothing joins to another, or to what is outside."""
    graph = file.graph
    outside = set(graph.objects(None, URIRef(SC.of)))
    feeding = {*graph.subjects(URIRef(SC.feeds)), *graph.objects(None, URIRef(SC["from"]))}
    fed = {*graph.objects(None, URIRef(SC.feeds)), *graph.objects(None, URIRef(SC.to))}
    for role in set(graph.subjects(RDF.type, URIRef(SC.Role))) - feeding - fed - outside:
        for least in graph.objects(role, URIRef(SC.minCount)):
            if isinstance(least, Literal) and least.value == 0:
                message = "This role may stay unplayed, and what plays it feeds no role and is fed by none."
                hint = "Say which role it feeds (sc:feeds), unless its components act by themselves."
                offset = file.positions.triples[role, URIRef(SC.minCount), least].predicate
                yield file.at(offset, "SC-L20", message, hint=hint)


def typed_roles(file: LintedFile) -> Iterator[Diagnostic]:
    """Roles that say by their own type, or by a target alone, of which class their component should be.

    Where all else that a component says is there as well, a role and a component have one name.
    """
    both = _roles_and_components(file)
    for one in both:
        message = f"{file.short(str(one))} is a component and a role as well."
        offset = file.positions.triples[one, RDF.type, URIRef(SC.Role)].object
        yield file.at(offset, "SC-L14", message, hint="Give one of the two another IRI.")
    for role, said, kind in _told_otherwise(file):
        if role in both:
            continue
        name = file.short(kind)
        message = (
            f"This says that the {_kind(file, role)} is a component of the type {name}; it asks for none."
            if said == RDF.type
            else f"A target asks nothing of a component, so one that is no {name} may play this role."
        )
        offset = file.positions.triples[role, said, kind].object
        yield file.at(offset, "SC-L14", message, hint=f"Write sh:class {name}.")


def _kind(file: LintedFile, shape: Node) -> str:
    return "role" if (shape, RDF.type, URIRef(SC.Role)) in file.graph else "shape"


def undescribed_shapes(file: LintedFile) -> Iterator[Diagnostic]:
    """Classes, and what is not described at all, where roles name a shape: everything meets what asks for nothing."""
    roles = set(file.graph.subjects(RDF.type, URIRef(SC.Role)))
    for statement in {one for role in roles for one in said_for(file, role)}:
        for shape in _shapes_named(file, [statement]):
            if str(statement[1]) == SC.recruits or not isinstance(shape, URIRef) or _is_shape(file, shape):
                continue
            short = file.short(str(shape))
            message = f"{short} is no shape that is described in this file, so everything meets it."
            hint = f"For the instances of a class write [ sh:class {short} ] in its place."
            if statement in file.positions.triples:
                yield file.at(file.positions.triples[statement].object, "SC-L14", message, hint=hint)


def _is_shape(file: LintedFile, shape: Node) -> bool:
    """Whether anything is said of a shape as such, or it is a parameter, which stands for one."""
    if shape in file.source.parameters:
        return True
    types = set(file.graph.objects(shape, RDF.type))
    return not types.isdisjoint((SH.NodeShape, SH.PropertyShape, URIRef(SC.Role))) or any(
        str(predicate) in vocabulary.SH for predicate in file.graph.predicates(shape)
    )


def paths_from_components(file: LintedFile) -> Iterator[Diagnostic]:
    """Paths from a component that begin with what only its ports and parameters say."""
    for role in set(file.graph.subjects(RDF.type, URIRef(SC.Role))):
        for path, values in NormalForm(file.source, (role,)).values.items():
            step = IRI.unchecked(str(next((one for one in path if one != RDF.first), "")))
            for shape in values.shapes if step in _OF_PARTS_ALONE else ():
                for said in file.graph.objects(shape, SH.path):
                    short = file.short(step)
                    message = f"{short} is said of a part of a component, so no component has one."
                    hint = (
                        f"Begin the path with what leads to the part: ( {file.short(_OF_PARTS_ALONE[step])} {short} )."
                    )
                    offset = file.positions.triples[shape, SH.path, said].object
                    yield file.at(offset, "SC-L25", message, hint=hint)


def _roles_and_components(file: LintedFile) -> set[Node]:
    """The roles that are declared components, and say of themselves what components alone say."""
    declared = set(file.graph.subjects(RDF.type, URIRef(SC.Role))).intersection(
        file.graph.subjects(RDF.type, URIRef(SC.Component))
    )
    return {one for one in declared if not OF_COMPONENT.isdisjoint(map(str, file.graph.predicates(one)))}


def _told_otherwise(file: LintedFile) -> Iterator[tuple[Node, URIRef, URIRef]]:
    """Each role, or shape in one, with a class of components that it names but for `sh:class`, and by what."""
    roles = set(file.graph.subjects(RDF.type, URIRef(SC.Role)))
    said_of_roles = [one for role in roles for one in said_for(file, role)]
    for role in roles | _shapes_named(file, said_of_roles):
        asked = role not in roles or (role, SH["class"], None) in file.graph
        for said, ignored in ((RDF.type, False), (SH.targetClass, asked)):
            for kind in () if ignored else file.graph.objects(role, said):
                if isinstance(kind, URIRef) and (said == SH.targetClass or _of_components(file, kind, asked)):
                    yield role, said, kind


def _of_components(file: LintedFile, kind: URIRef, asked: bool) -> bool:
    """Whether the type of a role, or of a shape in one, is a class of components.

    Of a role that asks for none it is also one that is declared as a class, and known as nothing else.
    """
    if asked or str(kind) not in file.index.classes or namespace(kind).startswith((*STANDARD, OWN)):
        return file.index.serves(str(kind), SC.Component)
    return not any(file.index.serves(str(kind), other) for other in (SC.Role, ROB.Signal))


def unselective_roles(file: LintedFile) -> Iterator[Diagnostic]:
    """Roles whose shape every component meets, and of which nothing else asks for a port or a parameter either."""
    graph, component = file.graph, URIRef(SC.Component)
    every = NormalForm(file.source, file.source.applied(SH.targetClass, component))
    every.own.append((component, SH["class"], component))
    joined = {
        role
        for end, port in ((SC["from"], SC.output), (SC.to, SC.input))
        for interaction in graph.subjects(URIRef(port))
        for role in graph.objects(interaction, URIRef(end))
    }
    asked = {*graph.subjects(URIRef(SC.sets)), *graph.objects(None, URIRef(SC.of)), *joined}
    told = {role for role, _, _ in _told_otherwise(file)}  # SC-L14 says what is meant
    for role in set(graph.subjects(RDF.type, URIRef(SC.Role))) - asked - told:
        if entails(every, NormalForm(file.source, (role,))):
            message = f"Every component meets the shape of the role {file.short(str(role))}, so any may play it."
            hint = "Say of which class its component is, by sh:class."
            yield file.at(file.offset(role), "SC-L27", message, hint=hint)


def signals_for_components(file: LintedFile) -> Iterator[Diagnostic]:
    """Classes of signals where a role asks for the class of its component, or of what it recruits."""
    roles = set(file.graph.subjects(RDF.type, URIRef(SC.Role)))
    recruited = {shape for role in roles for shape in file.graph.objects(role, URIRef(SC.recruits))}
    for shape in roles | recruited:
        for statement in NormalForm(file.source, (shape,)).own:
            kind = str(statement[2])
            if statement[1] != SH["class"] or statement not in file.positions.triples:
                continue
            if file.index.classes_signals(kind):
                short = file.short(kind)
                message = f"{short} is a kind of signals, so no component is one, and none can "
                message += "play this role." if shape in roles else "be recruited."
                path = f"sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:hasValue {short} ]"
                hint = f"Name a class of components; for one that issues such signals, write {path}."
                yield file.at(file.positions.triples[statement].object, "SC-L28", message, hint=hint)


def said_for(file: LintedFile, role: Node) -> Iterator[tuple[Node, Node, Node]]:
    """The statements that make up what a role asks for, sets and recruits, also in shapes with names."""
    seen, waiting = {role}, [role]
    while waiting:
        subject = waiting.pop()
        for predicate, value in file.graph.predicate_objects(subject):
            yield subject, predicate, value
            inside = isinstance(value, BNode) or str(predicate) in vocabulary.SH
            if inside and value not in seen:
                seen.add(value)
                waiting.append(value)


def properties_of_roles(file: LintedFile) -> Iterator[Diagnostic]:
    """Properties of components that are said of a role, which by that asks for nothing.

    These are the properties of selfconf's own ontologies, and what shapes of the file ask for.
    """
    asked = set(file.graph.objects(None, SH.path)) - file.source.constraints
    for role in set(file.graph.subjects(RDF.type, URIRef(SC.Role))) - _roles_and_components(file):
        for predicate, value in file.graph.predicate_objects(role):
            property_, home = str(predicate), namespace(str(predicate))
            ours = home.startswith(OWN) and property_ in file.index.properties
            if (ours or predicate in asked) and property_ not in SC and home not in STANDARD:
                statement = (role, predicate, value)
                message = f"{file.short(property_)} is said of the role, which asks no component for it by that."
                hint = f"Write sh:property [ sh:path {file.short(property_)} ; sh:hasValue ... ]."
                yield file.at(file.positions.triples[statement].predicate, "SC-L25", message, hint=hint)


def idle_words(file: LintedFile) -> Iterator[Diagnostic]:
    """Words in the shape of a role that are read of other things alone, as `sh:value` is of results.

    In shapes that are no roles this goes for all words of selfconf as well.
    """
    roles = set(file.graph.subjects(RDF.type, URIRef(SC.Role)))
    said = {one for role in roles for one in said_for(file, role)}
    shapes = roles | _shapes_named(file, said)
    for shape, predicate, value in said:
        word = str(predicate)
        if isinstance(predicate, URIRef) and predicate in SH:
            idle = word not in _READ_IN_SHAPES
        else:
            idle = word in SC and word in file.index.terms and shape not in roles | file.source.parameters
        if shape in shapes and idle and (offsets := file.positions.triples.get((shape, predicate, value))):
            message = f"{file.short(word)} says nothing in a shape, so this is passed over."
            yield file.at(offsets.predicate, "SC-L25", message, hint=_INSTEAD_OF_WORDS.get(word))


def _shapes_named(file: LintedFile, said: Iterable[tuple[Node, Node, Node]]) -> set[Node]:
    """The shapes that some statements name or hold."""
    leading = {(str(predicate), value) for _, predicate, value in said}
    named = {value for predicate, value in leading if predicate in (SC.recruits, *SHAPE_VALUED)}
    return named | {shape for predicate, head in leading if predicate in LISTS_OF_SHAPES for shape in file.items(head)}
