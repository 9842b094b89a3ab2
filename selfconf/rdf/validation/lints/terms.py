"""The lints about words: misspelt and misplaced terms, confused namespaces, ports that no component has.

SHACL checks what it finds and passes over what it does not know: `sh:minCnt` asks for nothing, and a
component whose prefix has https where http belongs is no component at all. Only terms of sc: and sh: are errors, since
there no one else can have declared them; all else warns.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterator, Mapping

from rdflib import OWL, RDF, RDFS, SH, XSD, Literal, URIRef
from rdflib.namespace import DefinedNamespace
from rdflib.term import Node

from selfconf.model.curie import suggested_local_name
from selfconf.model.diagnostic import Diagnostic, Severity
from selfconf.model.literal_values import DATATYPES, MOST_CHARACTERS, TRUTH, number_of, of_range
from selfconf.model.term import IRI
from selfconf.rdf import vocabulary
from selfconf.rdf.permitted_fields import COMPONENT, LINKED, OF_PARTS, foreign_terms
from selfconf.rdf.validation.lints.linted_file import LintedFile
from selfconf.rdf.validation.prefilter import TERM_POSITIONS
from selfconf.rdf.validation.term_index import OWN, STANDARD, TermIndex, namespace

_STANDARD: dict[str, type[DefinedNamespace]] = {str(words._NS): words for words in (RDF, RDFS, OWL, XSD, SH)}
_SC, _SH = vocabulary.SC, vocabulary.SH
LIKE = 0.7
"""How alike two words have to be for one to be a misspelling of the other; 1 is equal."""
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
_LISTS_OF_TERMS = (
    *(SH.path, SH.alternativePath, SH.ignoredProperties),
    *(OWL.unionOf, OWL.intersectionOf, OWL.disjointUnionOf, OWL.propertyChainAxiom),
)
"""What has a list of terms, or a path, which may be one."""
_NAMING_TERMS = frozenset(
    (RDFS.domain, RDFS.range, OWL.inverseOf, OWL.disjointWith, OWL.onProperty, OWL.onClass, OWL.imports)
)
"""What leads to a term or an ontology, and is not read as a hierarchy; of that the shapes tell."""
VALUES = frozenset((SH.hasValue, SH.minInclusive, SH.minExclusive, SH.maxInclusive, SH.maxExclusive))
"""What shapes compare values with."""
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
_MEMBERSHIP = re.compile(re.escape(vocabulary.RDF.base) + r"_\d+")


def unknown_terms(file: LintedFile) -> Iterator[Diagnostic]:
    """Terms of a known namespace that no ontology declares."""
    meant: dict[str, str | None] = {}  # a term that is misspelt once is often misspelt everywhere
    for iri, offset in _used_terms(file):
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


def _used_terms(file: LintedFile) -> Iterator[tuple[str, int]]:
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


def imported_ontologies(file: LintedFile) -> Iterator[Diagnostic]:
    """Imports of ontologies that are not loaded: nothing is fetched, so what they declare is not known."""
    for ontology, imported in file.graph.subject_objects(OWL.imports):
        names = {f"{str(imported).rstrip('#/')}{end}" for end in ("", "#", "/")}
        here = any((URIRef(name), None, None) in file.graph for name in names)
        if isinstance(imported, URIRef) and not here and names.isdisjoint(file.index.terms):
            statement = file.positions.triples[ontology, OWL.imports, imported]
            message = f"The ontology <{imported}> is not loaded, as imports are not followed."
            yield file.at(statement.object, "SC-L33", message, hint="Give its file as an ontology, too.")


def repeated_descriptions(file: LintedFile) -> Iterator[Diagnostic]:
    """Components that another file describes as well, and templates that another describes otherwise."""
    for thing, other in file.elsewhere.items():
        offset, short = file.offset(URIRef(thing)), file.short(thing)
        if (URIRef(thing), RDF.type, URIRef(_SC.Component)) in file.graph:
            yield file.at(offset, "SC-L04", f"The component {short} is described in {other} as well.")
        else:
            message = f"The template {short} is described in {other} as well, and not as it is here."
            hint = "Give one of the two another IRI, or describe both alike."
            yield file.at(offset, "SC-L31", message, hint=hint)


def prefixes(file: LintedFile) -> Iterator[Diagnostic]:
    """Prefixes with two meanings, and namespaces that are nearly, but not quite, known ones."""
    first: dict[str, str] = {}
    for prefix, iri, offset in file.positions.prefixes:
        if first.setdefault(prefix, iri) != iri:
            message = f"The prefix {prefix}: has been bound to <{first[prefix]}> before, and is now <{iri}>."
            yield file.at(offset, "SC-L05", message)
        if (meant := file.index.confused(iri)) is not None:
            yield _confused(file, iri, meant, offset)


def prefixes_of_queries(file: LintedFile) -> Iterator[Diagnostic]:
    """Prefixes that are declared for queries (`sh:declare`) with another namespace than a known one, or the file's."""
    own = {prefix: iri for prefix, iri, _ in file.positions.prefixes}
    for node, declared in file.graph.subject_objects(SH.namespace):
        statement = file.positions.triples.get((node, SH.namespace, declared))
        iri, prefix = str(declared), str(file.graph.value(node, SH.prefix))
        if statement is None or not isinstance(declared, Literal):
            continue
        if (meant := file.index.confused(iri)) is not None:
            yield _confused(file, iri, meant, statement.object)
        elif own.get(prefix, iri) != iri:
            message = f"The prefix {prefix}: is bound to <{own[prefix]}> in this file, and to <{iri}> in its queries."
            yield file.at(statement.object, "SC-L05", message)


def undeclared_prefixes(file: LintedFile) -> Iterator[Diagnostic]:
    """Namespaces that are nearly known ones and have no prefix: told where the first of their terms stands."""
    told = {iri for _, iri, _ in file.positions.prefixes}
    for term, offset in _used_terms(file):
        home = namespace(term)
        meant = None if home in told else file.index.confused(home)
        told.add(home)
        if meant is not None:
            yield _confused(file, home, meant, offset)


def _confused(file: LintedFile, iri: str, meant: str, offset: int) -> Diagnostic:
    severity = Severity.ERROR if meant.startswith(OWN) or meant == _SH.base else Severity.WARNING
    message = f"The namespace <{iri}> is not <{meant}>."
    return file.at(offset, "SC-L06", message, severity, f"Did you mean <{meant}>?")


def ownerless_ports(file: LintedFile) -> Iterator[Diagnostic]:
    """Ports that no component has: with a signal type, and without anything that has them; and components with one."""
    for kind, link in ((_SC.signalType, "sc:hasInput or sc:hasOutput"), (_SC.parameterType, "sc:hasParameter")):
        part = "port" if kind == _SC.signalType else "parameter"
        for node in sorted(set(file.graph.subjects(URIRef(kind))), key=file.offset):
            if (node, RDF.type, URIRef(_SC.Component)) in file.graph:
                said = file.positions.triples[next(file.graph.triples((node, URIRef(kind), None)))].predicate
                message = f"{file.short(kind)} says nothing of a component, so this is passed over."
                yield file.at(said, "SC-L25", message, hint=f"Say it of a {part} in brackets, by {link}.")
            elif (None, None, node) not in file.graph and (node, RDF.type, URIRef(_SC.Interaction)) not in file.graph:
                message = "No component has this port." if part == "port" else "Nothing has this parameter."
                yield file.at(file.offset(node), "SC-L17", message, hint=f"Say whose it is, by {link}.")


def untyped_ports(file: LintedFile) -> Iterator[Diagnostic]:
    """Ports of components that have no signal type, which is allowed and seldom meant."""
    for link in (_SC.hasInput, _SC.hasOutput):
        for node in sorted(set(file.graph.objects(None, URIRef(link))), key=file.offset):
            said = (URIRef(_SC.signalType), RDF.first)  # a list is no port at all
            if isinstance(node, Literal) or any((node, one, None) in file.graph for one in said):
                continue
            name = file.graph.value(node, URIRef(_SC.name))
            called = "This port" if name is None else f"The port {str(name)!r}"
            hint = "Give it a sc:signalType, or name it in each sc:Interaction that is to pair it."
            yield file.at(file.offset(node), "SC-L18", f"{called} has no signal type.", hint=hint)


def typed_operations(file: LintedFile) -> Iterator[Diagnostic]:
    """Operations that have a signal type, by which nothing is paired with them."""
    signal = URIRef(_SC.signalType)
    for link in (_SC.hasOperation, _SC.needsOperation):
        for node in sorted(set(file.graph.objects(None, URIRef(link))), key=file.offset):
            for kind in file.graph.objects(node, signal):
                message = "An operation has no signal type, so this is passed over."
                hint = "Say what it takes by sc:request, and what it answers by sc:response."
                yield file.at(file.positions.triples[node, signal, kind].predicate, "SC-L24", message, hint=hint)


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
        elif value in file.source.parameters and (value, SH.datatype, None) in file.graph:
            short = file.short(str(value))
            message = f"The value of {file.short(predicate)} is a thing with an IRI, and {short} stands for a literal."
            yield file.at(
                offset,
                "SC-L07",
                message,
                hint=f"Say sh:nodeKind sh:IRI of {short} in place of its sh:datatype.",
            )


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
        example = next(one for one in ("10", "-10") if of_range(one, datatype, datatype))
        return text if known else f"a number, such as {example}"
    return f'"{text}"^^{file.short(datatype)}' if known else f"it as in {EXAMPLES[datatype]}"


def local_components(file: LintedFile) -> Iterator[Diagnostic]:
    """Components whose IRI depends on where the file lies."""
    kinds = file.graph.subjects(RDF.type, URIRef(_SC.Component))
    for component in kinds:
        if isinstance(component, URIRef) and component.startswith("file:"):
            message = "The IRI of this component is relative, so it changes with the place of the file."
            hint = "Declare a prefix, or a @base that starts with https:."
            yield file.at(file.offset(component), "SC-L08", message, hint=hint)
