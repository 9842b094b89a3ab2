"""The parameters of a template: their names and defaults, where they stand for a value, and which values they can have.

A parameter is a shape for its value.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping

from selfconf.model.immutable import replace
from selfconf.model.obstacle import NotJudged, ShapeViolated
from selfconf.model.property_fault import ConstraintFailed, NotAmong
from selfconf.model.template import Parameter, Role
from selfconf.model.term import IRI, STRING, BlankNode, Literal, Term, sort_key
from selfconf.model.wording import is_one_line
from selfconf.rdf.shacl import MatchTooCostly, ValueTest, compiled, component_parameters, passes_all
from selfconf.rdf.tasks.mistakes import DocumentReader, worded
from selfconf.rdf.tasks.roles import mentions
from selfconf.rdf.turtle import Document
from selfconf.rdf.vocabulary import SC, SH, TYPE

_WORD = re.compile(r"[^\s=]+")


def parameters_of(document: Document, template: IRI, roles: tuple[Role, ...]) -> tuple[Parameter, ...]:
    """The parameters of a template with some roles, sorted by name. Raises TemplateError."""
    return _ParameterReader(document).parameters(template, roles)


class _ParameterReader(DocumentReader):
    """Reads the parameters of a template; every method raises TemplateError with a sentence for the author."""

    def parameters(self, template: IRI, roles: tuple[Role, ...]) -> tuple[Parameter, ...]:
        listed = self.document.values(template, SC.parameter)
        iris = frozenset(value for value in listed if isinstance(value, IRI))
        in_shapes: set[IRI] = set()
        for role in roles:
            in_shapes |= mentions(self.document, role.iri, iris)
        is_set = {setting.value for role in roles for setting in role.settings}
        parameters: list[Parameter] = []
        named: set[str] = set()
        for value in listed:
            if not isinstance(value, IRI):
                raise self.mistake("a parameter of a template needs an IRI", template, SC.parameter, value)
            name = self.only(value, SC.name, f"the parameter {worded(value)} needs exactly one sc:name")
            if not isinstance(name, Literal) or name.datatype != STRING or not _is_word(name.lexical):
                what = "one word, a string without control characters or ="
                problem = f"the sc:name of the parameter {worded(value)} is {what}"
                raise self.mistake(problem, value, SC.name, name)
            if name.lexical in named:
                raise self.mistake(f"two parameters have the name {name.lexical!r}", value, SC.name, name)
            named.add(name.lexical)
            known = Parameter(value, name.lexical, in_shape=value in in_shapes, is_set=value in is_set)
            parameters.append(replace(known, default=self._default(known)))
        return tuple(sorted(parameters, key=lambda parameter: parameter.name))

    def _default(self, parameter: Parameter) -> Term | None:
        iri = parameter.iri
        defaults = self.document.values(iri, SH.defaultValue)
        if len(defaults) > 1:
            raise self.mistake(f"the parameter {worded(iri)} has several defaults", iri, SH.defaultValue, defaults[1])
        for default, reason in misfits(parameter, defaults, self.document).items():
            problem = f"the default of the parameter {worded(iri)} cannot stand for it: {reason.rstrip('.')}"
            raise self.mistake(problem, iri, SH.defaultValue, default)
        return defaults[0] if defaults else None


def _is_word(text: str) -> bool:
    """Whether a text can name a parameter, as in `--bind NAME=TERM`; messages hold no name with control characters."""
    return _WORD.fullmatch(text) is not None and is_one_line(text)


_PROBE = "urn:selfconf:probe"
"""The property by which pySHACL is asked about a value; a node of that name and a number has it."""


def misfits(parameter: Parameter, values: Collection[Term], document: Document) -> dict[Term, str]:
    """The values, among some, that cannot stand for a parameter, each with the reason.

    A parameter is a shape for its value (`sh:nodeKind`, `sh:datatype`, `sh:in` ...). Values that pass the compiled
    tests of all its constraints conform; the others are judged by pySHACL. The reason is worded as for a property of a
    component, where the constraint is one of those; else as pySHACL, or the author by `sh:message`, words it.
    """
    blank = [value for value in values if isinstance(value, BlankNode)]
    found = dict[Term, str].fromkeys(blank, "it is a blank node, which is another one in each file")
    return found | _misfits(parameter, [value for value in values if value not in found], document)


def _misfits(parameter: Parameter, values: Iterable[Term], document: Document) -> dict[Term, str]:
    """The values without blank nodes that do not conform to a parameter, each with the reason."""
    constraints = _constraints(parameter.iri, document)
    tests, covered = compiled(constraints)
    left = [value for value in values if covered != constraints.keys() or not passes_all(tests, value)]
    found = _judged(parameter, left, document) if constraints and left else {}
    if SH.message in constraints:
        return found
    return {value: _worded(value, tests, constraints, document) or found[value] for value in found}


def suitable(parameter: Parameter, values: frozenset[Term], document: Document) -> frozenset[Term]:
    """The values of a set that can stand for a parameter; pySHACL judges only what the compiled tests do not cover."""
    constraints = _constraints(parameter.iri, document)
    tests, covered = compiled(constraints)
    values = frozenset([value for value in values if not isinstance(value, BlankNode)])
    if covered == constraints.keys():
        return frozenset([value for value in values if passes_all(tests, value)])
    return values - _judged(parameter, values, document).keys()


def _worded(
    value: Term, tests: Iterable[ValueTest], constraints: Mapping[IRI, list[Term]], document: Document
) -> str | None:
    """What is wrong with a value by the first of the constraints that have words here."""
    values = frozenset((value,))
    try:
        for test in tests:
            if not test.passes(value):
                return ConstraintFailed(values, test.constraint, test.wanted).said("it")
    except MatchTooCostly:  # which has been found out already, and has words of its own
        return None
    allowed = [frozenset(document.items(head)) for head in constraints.get(SH["in"], ())]
    required = [frozenset((one,)) for one in constraints.get(SH.hasValue, ())]
    return next((NotAmong(values, one).said("it") for one in (*allowed, *required) if value not in one), None)


def _constraints(parameter: IRI, document: Document) -> dict[IRI, list[Term]]:
    """What a parameter asks of its value: the SHACL parameters that it states, each with its values.

    The kind of the value comes first, then the others by name: so the reason why one is wrong does not depend on the
    order of statements, of which a graph has none.
    """
    found: dict[IRI, list[Term]] = {}
    own = component_parameters(document)
    for predicate, value in document.statements.get(parameter, ()):
        if predicate in own or (predicate in SH and predicate != SH.defaultValue):
            found.setdefault(predicate, []).append(value)
    in_order = sorted(found, key=lambda predicate: (predicate not in (SH.nodeKind, SH.datatype), predicate))
    return {predicate: sorted(found[predicate], key=sort_key) for predicate in in_order}


def _judged(parameter: Parameter, values: Iterable[Term], document: Document) -> dict[Term, str]:
    """The values that pySHACL finds not to conform, each with its message."""
    # Loading rdflib and pySHACL takes longer than most configurations, and most values never get here.
    import rdflib

    from selfconf.rdf.conformance import violations
    from selfconf.rdf.rdflib_terms import rdflib_term, to_rdflib

    probes = {IRI.unchecked(f"{_PROBE}:{number}"): value for number, value in enumerate(values)}
    probe, probe_shape = IRI.unchecked(f"{_PROBE}#it"), IRI.unchecked(f"{_PROBE}-shape")  # whose name words say
    shapes = to_rdflib(document.triples())
    node, path = rdflib.URIRef(probe_shape), rdflib.BNode()
    shapes.add((node, rdflib.URIRef(TYPE), rdflib.URIRef(SH.NodeShape)))
    shapes.add((node, rdflib.URIRef(SH.property), path))
    shapes.add((path, rdflib.URIRef(SH.path), rdflib.URIRef(probe)))
    for predicate, constraints in _constraints(parameter.iri, document).items():
        for constraint in constraints:
            shapes.add((path, rdflib.URIRef(predicate), rdflib_term(constraint)))
    subjects = rdflib.Graph()
    for one, value in probes.items():
        subjects.add((rdflib.URIRef(one), rdflib.URIRef(probe), rdflib_term(value)))
    called = f"the parameter {parameter.name!r}"
    found = violations(subjects, shapes, probe_shape, list(probes), document.source, called)
    return {value: _reason(found[one][0]) for one, value in probes.items() if one in found}


def _reason(obstacle: ShapeViolated | NotJudged) -> str:
    return obstacle.message if isinstance(obstacle, ShapeViolated) else obstacle.reason
