"""A role spelt out: as the SHACL shape and as the SPARQL query that it stands for.

Both are complete by themselves. The shape goes to any SHACL engine, with the advertisements as its data graph and the
components as its focus nodes; the query to any SPARQL engine that holds the advertisements. What a reasoning mode
adds stands in the query in full, as the classes and properties that serve. For people and for other tools: selfconf
itself asks neither, as no spelling of "has no other value" is fast on all engines.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import rdflib

from selfconf.errors import AuthorError
from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.setting_names import setting
from selfconf.model.term import IRI, BlankNode, Literal, Term
from selfconf.model.wording import listed
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.eligibility import (
    ClassTest,
    CompiledRole,
    Count,
    ParameterTest,
    PropertyTest,
    RoleTest,
    SelfTest,
    bound_shape,
)
from selfconf.rdf.rdflib_terms import to_rdflib
from selfconf.rdf.shacl import ValueTest
from selfconf.rdf.tasks import TaskDocument, free_parameters, mentions
from selfconf.rdf.turtle import Triple, ox_term
from selfconf.rdf.vocabulary import RDF, SC, SH, TYPE, XSD

_COMPARED = {SH.minInclusive: ">=", SH.maxInclusive: "<=", SH.minExclusive: ">", SH.maxExclusive: "<"}
_LESS = {SH.lessThan: "<", SH.lessThanOrEquals: "<="}
_KIND_OF_NODE = {
    SH.IRI: "isIRI({})",
    SH.Literal: "isLiteral({})",
    SH.BlankNode: "isBlank({})",
    SH.BlankNodeOrIRI: "!isLiteral({})",
    SH.BlankNodeOrLiteral: "!isIRI({})",
    SH.IRIOrLiteral: "!isBlank({})",
}
_CAST = frozenset((XSD.integer, XSD.decimal, XSD.double, XSD.float, XSD.boolean, XSD.dateTime))


def shape(given: TaskDocument, role: CompiledRole, hierarchy: Hierarchy) -> str:
    """The shape of a role in Turtle, with parameters bound and what the role sets as one more constraint.

    Raises AuthorError where a parameter in it is free: that any one value will do is not for a shape to say.
    """
    loose = mentions(given.document, role.iri, free_parameters(given.template, given.task.bindings))
    if loose:
        names = sorted(p.name for p in given.template.parameters if p.iri in loose)
        parameters = f"the free parameter{'s' * (len(names) > 1)} {listed(names)}"
        one = "it" if len(names) == 1 else "them"
        raise AuthorError(f"the role {role.iri!r} mentions {parameters}; bind {one} to see the shape")
    triples = list(_reached(bound_shape(given.document, given.task.bindings), role.iri))
    for number, test in enumerate(test for test in role.tests if isinstance(test, ParameterTest)):
        triples += _parameter_shape(role.iri, test, hierarchy, number)
    graph = to_rdflib(triple for triple in triples if triple[1:] != (TYPE, SC.Role))
    for prefix, namespace in {**given.document.prefixes, "sh": SH.base, "sc": SC.base}.items():
        graph.bind(prefix, rdflib.Namespace(namespace), replace=True)
    return graph.serialize(format="turtle").rstrip()


def _reached(triples: Iterable[Triple], start: Term) -> Iterator[Triple]:
    """The statements of a shape and of the shapes and lists that it mentions."""
    about: dict[Term, list[Triple]] = {}
    for triple in triples:
        about.setdefault(triple[0], []).append(triple)
    waiting, seen = [start], {start}
    while waiting:
        for triple in dict.fromkeys(about.get(waiting.pop(), ())):
            yield triple
            if triple[1] != TYPE and triple[2] not in seen:
                seen.add(triple[2])
                waiting.append(triple[2])


def _parameter_shape(role: IRI, test: ParameterTest, hierarchy: Hierarchy, number: int) -> Iterator[Triple]:
    """`[ sh:path ( sc:hasParameter sc:parameterType ) ; ... ]`: one of the types that serve is there."""
    node, inner, value = (BlankNode(f"_:set{number}{part}") for part in ("", "shape", "path"))
    yield role, SH.property, node
    yield from _list(value, (SC.hasParameter, SC.parameterType))
    yield node, SH.path, value
    yield node, SH.qualifiedMinCount, Literal("1", XSD.integer)
    yield node, SH.qualifiedValueShape, inner
    members = BlankNode(f"_:set{number}members")
    yield inner, SH["in"], members
    yield from _list(members, sorted(hierarchy.superclasses(test.type)))


def _list(head: BlankNode, members: Sequence[Term]) -> Iterator[Triple]:
    for number, member in enumerate(members):
        cell = head if number == 0 else BlankNode(f"{head}{number}")
        rest: Term = RDF.nil if number == len(members) - 1 else BlankNode(f"{head}{number + 1}")
        yield cell, RDF.first, member
        yield cell, RDF.rest, rest


def query(role: CompiledRole, hierarchy: Hierarchy, ecology: Iterable[Advertisement]) -> str:
    """The query whose answer is the role's candidates in their order. Raises AuthorError where SPARQL cannot say it.

    Of the classes and properties below those that the role names, the query lists what the ecology uses.
    """
    if not role.complete:
        seen = setting("show", "shape")
        raise AuthorError(f"the role {role.iri!r} says what a SPARQL query cannot; see its shape by {seen}")
    return _Speller(hierarchy, list(ecology)).query(role)


class _Speller:
    def __init__(self, hierarchy: Hierarchy, ecology: Sequence[Advertisement]) -> None:
        self.hierarchy = hierarchy
        used = () if hierarchy is NOTHING_ABOVE else ecology
        self.kinds = {kind for advertisement in used for kind in advertisement.types}
        self.predicates = {predicate for advertisement in used for predicate, _ in advertisement.profile.properties}

    def query(self, role: CompiledRole) -> str:
        """The whole query."""
        free = [p for t in _flat(role.tests) for p in (*(p for p, _ in t.free_in), *t.free_required)]
        if len(free) > len(set(free)):
            raise AuthorError(f"the role {role.iri!r} mentions a free parameter twice; bind it to see the query")
        conditions = "\n".join(f"  FILTER ( {self.condition(test)} )" for test in role.tests)
        return (
            "SELECT DISTINCT ?component WHERE {\n"
            f"  ?component a {_term(SC.Component)} .\n"
            f"  OPTIONAL {{ ?component {_term(SC.preference)} ?preference }}\n"
            f"{conditions}\n"
            "}\nORDER BY DESC(COALESCE(?preference, 0)) STR(?component)"
        )

    def condition(self, test: RoleTest) -> str:
        """A test as a condition on ?component."""
        if isinstance(test, ClassTest):
            below = {test.kind} | {kind for kind in self.kinds if self.hierarchy.matches(kind, test.kind)}
            return _any(f"EXISTS {{ ?component a {_term(kind)} }}" for kind in sorted(below))
        if isinstance(test, SelfTest):
            return f"?component IN ( {' , '.join(sorted(map(_term, test.members)))} )"
        if isinstance(test, ParameterTest):
            served = sorted(self.hierarchy.superclasses(test.type))
            path = f"{_term(SC.hasParameter)}/{_term(SC.parameterType)}"
            return _any(f"EXISTS {{ ?component {path} {_term(kind)} }}" for kind in served)
        if isinstance(test, Count):
            return self._count(test)
        return " && ".join(self._property(test)) or "true"

    def _count(self, test: Count) -> str:
        passed = [" && ".join(f"( {self.condition(one)} )" for one in group) or "true" for group in test.groups]
        if test.maximum is None and test.minimum == 1:
            return _any(f"( {one} )" for one in passed)
        total = " + ".join(f"IF( {one} , 1 , 0 )" for one in passed)
        most = "" if test.maximum is None else f" && ( {total} ) <= {test.maximum}"
        return f"( {total} ) >= {test.minimum}{most}"

    def _property(self, test: PropertyTest) -> Iterator[str]:
        path = self._path(test.path)
        if test.minimum:
            yield f"EXISTS {{ {_several(path, test.minimum)} }}"
        if test.maximum is not None:
            yield f"NOT EXISTS {{ {_several(path, test.maximum + 1)} }}"
        for members in test.allowed:
            yield f"NOT EXISTS {{ ?component {path} ?v FILTER ( {_none('?v', members)} ) }}"
        for value in test.required:
            yield f"EXISTS {{ ?component {path} {_term(value)} }}"
        for one in test.each:
            yield f"NOT EXISTS {{ ?component {path} ?v FILTER ( !{_passes('?v', one)} ) }}"
        for part in test.qualified:
            if part.minimum:
                yield f"EXISTS {{ {_several(path, part.minimum, part.value)} }}"
            if part.maximum is not None:
                yield f"NOT EXISTS {{ {_several(path, part.maximum + 1, part.value)} }}"
        for pair in test.compared:
            less = f"COALESCE( ?v {_LESS[pair.constraint]} ?w , false )"
            yield f"NOT EXISTS {{ ?component {path} ?v ; {self._path(pair.other)} ?w FILTER ( !{less} ) }}"
        for _, members in test.free_in:
            others = " && ".join(_none(name, members) for name in ("?v0", "?v1"))
            yield f"NOT EXISTS {{ {_several(path, 2)} FILTER ( {others} ) }}"
        if test.free_required:
            yield f"EXISTS {{ ?component {path} ?v }}"

    def _path(self, path: IRI) -> str:
        below = {path} | {p for p in self.predicates if path in self.hierarchy.superproperties(p)}
        return f"({'|'.join(map(_term, sorted(below)))})"


def _flat(tests: Iterable[RoleTest]) -> Iterator[PropertyTest]:
    return (test for test in tests if isinstance(test, PropertyTest))


def _any(conditions: Iterable[str]) -> str:
    return " || ".join(conditions)


def _several(path: str, number: int, value: PropertyTest | None = None) -> str:
    """A pattern that so many different values match, each of which conforms to what is asked of a single value."""
    names = [f"?v{k}" for k in range(number)]
    pattern = " ".join(f"?component {path} {name} ." for name in names)
    conditions = [f"!sameTerm({a}, {b})" for k, a in enumerate(names) for b in names[k + 1 :]]
    if value is not None:
        conditions += [condition for name in names for condition in _conforms(name, value)]
    return f"{pattern} FILTER ( {' && '.join(conditions)} )" if conditions else pattern


def _conforms(name: str, test: PropertyTest) -> Iterator[str]:
    """What a test asks of a single value, as conditions on a variable."""
    yield from (f"!( {_none(name, members)} )" for members in test.allowed)
    yield from (f"sameTerm({name}, {_term(value)})" for value in test.required)
    yield from (_passes(name, one) for one in test.each)


def _passes(name: str, test: ValueTest) -> str:
    """A test of one value as a condition on a variable, false where SPARQL has an error."""
    return f"COALESCE( {_on_value(name, test)} , false )"


def _none(name: str, members: Iterable[Term]) -> str:
    """The condition that a value is none of some terms, as terms: 1 is not 1.0."""
    return " && ".join(f"!sameTerm({name}, {_term(member)})" for member in sorted(members, key=_term)) or "true"


def _on_value(name: str, test: ValueTest) -> str:
    """A test of one value as a condition on a variable."""
    wanted = test.wanted
    if test.constraint == SH.nodeKind and isinstance(wanted, IRI):
        return _KIND_OF_NODE[wanted].format(name)
    if test.constraint == SH.datatype and isinstance(wanted, IRI):
        same = f"DATATYPE({name}) = {_term(wanted)}"
        return f"{same} && BOUND({name}) && ({_term(wanted)}(STR({name})) = {name})" if wanted in _CAST else same
    if test.constraint in _COMPARED:
        return f"{name} {_COMPARED[test.constraint]} {_term(wanted)}"
    if test.constraint == SH.pattern:
        flags = f", {_term(Literal(test.flags))}" if test.flags else ""
        return f"!isBlank({name}) && REGEX(STR({name}), {_term(wanted)}{flags})"
    order = ">=" if test.constraint == SH.minLength else "<="
    return f"!isBlank({name}) && STRLEN(STR({name})) {order} {wanted}"


def _term(value: Term) -> str:
    return str(ox_term(value))
