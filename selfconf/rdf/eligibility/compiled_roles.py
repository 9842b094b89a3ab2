"""The shape of a role, or of its suppliers, as tests, and what of it is left to pySHACL.

Of a shape that is compiled in part the tests are the prefilter, and pySHACL judges the survivors by the whole shape,
but for property shapes that are compiled and have free parameters to themselves: those need not be judged for each
value. That both ways give one partition is a property test.
"""

from __future__ import annotations

from collections.abc import Container, Mapping

from selfconf.errors import TemplateError
from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.immutable import replace
from selfconf.model.term import IRI, BlankNode, Literal, Term
from selfconf.rdf.eligibility.role_tests import CompiledRole, ParameterTest
from selfconf.rdf.eligibility.shape_compiler import SILENT, TARGETS, ShapeCompiler
from selfconf.rdf.permitted_fields import LISTS_OF_SHAPES
from selfconf.rdf.shacl import component_parameters, shapes_behind
from selfconf.rdf.tasks import ROLE_STRUCTURE, mentions, substituted
from selfconf.rdf.turtle import Document, Node, Triple
from selfconf.rdf.vocabulary import SC, SH, TYPE

_SUPPLIERS = "urn:selfconf:suppliers:"
"""What the names of the shapes of suppliers begin with that have none in the template."""
_OF_A_VALUE = LISTS_OF_SHAPES | SILENT | frozenset(
    SH[name]
    for name in (
        "not", "node", "property",
        "in", "hasValue", "nodeKind", "datatype", "pattern", "flags", "minLength", "maxLength", "languageIn",
        "uniqueLang", "minCount", "maxCount", "minInclusive", "maxInclusive", "minExclusive", "maxExclusive",
    )
)  # fmt: skip
"""What a shape that is asked about a value may say if it looks at the value alone."""
_OF_A_PROPERTY = _OF_A_VALUE | {SH.equals, SH.disjoint, SH.lessThan, SH.lessThanOrEquals}
"""What a shape of the values of one property may say if it looks at these, and at those of other properties."""
_OF_THE_COMPONENT = _OF_A_PROPERTY | {SH["class"], SH.closed, SH.ignoredProperties}
"""What a shape without a path may say if it looks at the statements about the component alone."""


def compile_role(
    document: Document,
    role: IRI,
    settings: tuple[IRI, ...],
    free: frozenset[IRI],
    hierarchy: Hierarchy = NOTHING_ABOVE,
) -> CompiledRole:
    """Compile the shape of a role, in which parameters stand that are `free`; `settings` are the types that it sets.

    The tests hold under that hierarchy.

    Raises TemplateError for shapes within shapes without end, or nearly so.
    """
    compiler = ShapeCompiler(document, free, hierarchy)
    try:
        tests = (*compiler.shape(role), *map(ParameterTest, settings))
        settled = _settled(document, role, free, hierarchy) if compiler.rest and free else frozenset[Term]()
        return CompiledRole(role, tests, not compiler.rest, local(document, role), settled)
    except RecursionError:
        raise TemplateError(f"the shape of the role {role!r} nests too deeply", file=document.source) from None


def _settled(document: Document, role: IRI, free: frozenset[IRI], hierarchy: Hierarchy) -> frozenset[Term]:
    """The property shapes of a role that tests say all of, with free parameters that stand nowhere else in its shape.

    None of shapes that are disjoint, which look at the other property shapes of the role.
    """
    settled = {
        shape: parameters
        for shape in document.values(role, SH.property)
        if (parameters := mentions(document, shape, free))
        and document.value(shape, SH.qualifiedValueShape) is None
        and _compiled_in_full(document, shape, free, hierarchy)
    }
    while settled:
        elsewhere = mentions(_without(document, role, settled), role, free)
        shared = [shape for shape, parameters in settled.items() if parameters & elsewhere]
        if not shared:
            break
        for shape in shared:
            del settled[shape]
    return frozenset(settled)


def _compiled_in_full(document: Document, shape: Term, free: frozenset[IRI], hierarchy: Hierarchy) -> bool:
    """Whether tests say all that a shape says."""
    compiler = ShapeCompiler(document, free, hierarchy)
    for _ in compiler.shape(shape):
        pass
    return not compiler.rest


def _without(document: Document, role: IRI, shapes: Container[Term]) -> Document:
    """A template in which a role lacks some of its property shapes, but for their paths, which `sh:closed` asks for."""
    said, paths = list[tuple[IRI, Term]](), dict[Node, list[tuple[IRI, Term]]]()
    for predicate, value in document.about(role):
        if predicate == SH.property and value in shapes:
            node = BlankNode(f"_:path{len(paths)}")
            paths[node] = [(SH.path, path) for path in document.values(value, SH.path)]
            said.append((predicate, node))
        else:
            said.append((predicate, value))
    return replace(document, statements=document.statements | paths | {role: said})


def left_to_judge(document: Document, role: CompiledRole) -> Document:
    """A template in which the shape of a role says what pySHACL has to be asked, if it has to."""
    return _without(document, role.iri, role.settled) if role.settled else document


def bound_shape(document: Document, values: Mapping[IRI, Term]) -> list[Triple]:
    """The triples of a template for pySHACL: parameters replaced, roles typed as node shapes without targets."""
    triples: list[Triple] = []
    roles = set(document.instances(SC.Role))
    for subject, predicate, value in substituted(document, values).triples():
        if subject in roles and (predicate in TARGETS or (predicate in ROLE_STRUCTURE and predicate != TYPE)):
            continue
        triples.append((subject, predicate, value))
    triples.extend((role, TYPE, SH.NodeShape) for role in roles)
    return triples


def local(document: Document, shape: Term, at_value: bool = False, above: frozenset[Term] = frozenset()) -> bool:
    """Whether a shape looks at nothing but statements about the component; `at_value` if it is asked about a value."""
    if shape in above:
        return True
    paths = document.values(shape, SH.path)
    if paths and (at_value or not all(isinstance(path, IRI) for path in paths)):
        return False
    if _says_more(document, shape, _OF_A_PROPERTY if paths else _OF_A_VALUE if at_value else _OF_THE_COMPONENT):
        return False
    inner = (one for predicate, value in document.about(shape) for one in shapes_behind(document, predicate, value))
    return all(local(document, one, at_value or bool(paths), above | {shape}) for one in inner)


def _says_more(document: Document, shape: Term, known: Container[IRI]) -> bool:
    """Whether a shape constrains by other predicates than those that are known: SHACL's, or its document's own."""
    own = component_parameters(document)
    return any(said not in known and (said in SH or said in own) for said, _ in document.about(shape))


def with_named_suppliers(document: Document) -> Document:
    """A template in which the shapes of suppliers have names: pySHACL is asked about a shape by its IRI."""
    names = {
        value: IRI.unchecked(f"{_SUPPLIERS}{subject}")
        for subject, said in document.statements.items()
        for predicate, value in said
        if predicate == SC.recruits and isinstance(value, BlankNode)
    }
    if not names:
        return document
    statements: dict[Node, list[tuple[IRI, Term]]] = {}
    for subject, said in document.statements.items():
        about = names.get(subject, subject) if isinstance(subject, BlankNode) else subject
        statements[about] = [(p, names.get(o, o) if isinstance(o, BlankNode) else o) for p, o in said]
    return replace(document, statements=statements)


def called(shape: IRI) -> str:
    """What a message calls the shape of a role or of suppliers, of which one without a name is called by its role."""
    role = shape.removeprefix(_SUPPLIERS)
    return f"the shape {shape!r}" if role == shape else f"the shape of what the role <{role}> recruits"


def suppliers_of(document: Document, role: IRI, hierarchy: Hierarchy) -> CompiledRole:
    """The tests that a supplier has to pass under a hierarchy; none where a role recruits any component.

    The parameters in its shape have values, by which they are replaced. Raises TemplateError where it is no shape.
    """
    shape = document.value(role, SC.recruits)
    if shape is None or isinstance(shape, Literal) or not isinstance(shape, IRI):
        return CompiledRole(role, (), complete=True)
    return compile_role(document, shape, (), frozenset(), hierarchy)
