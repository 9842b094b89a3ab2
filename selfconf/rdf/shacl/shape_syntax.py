"""What may stand as the value of SHACL's own properties (SHACL, appendix C), as far as readers of templates must know.

Validation (`selfconf.rdf.validation.well_formedness`) asks the shape of shapes, and pySHACL in a trial run, and knows
the place of what is wrong. Here one pass over the statements of a role finds most of it, without a graph; a test over
files that are wrong holds the two together.

Constraint components that a document brings along (section 6) are predicates of its own that constrain.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from selfconf.model.literal_values import in_lexical_space, natural_number
from selfconf.model.term import IRI, Literal, Term
from selfconf.rdf.permitted_fields import LISTS_OF_SHAPES, SHAPE_VALUED
from selfconf.rdf.shacl.patterns import pattern_fault
from selfconf.rdf.shacl.shape_queries import refused_queries
from selfconf.rdf.turtle import Document, Node, Triple
from selfconf.rdf.vocabulary import FIRST, NIL, RDFS, SH, XSD


def _terms(*names: str) -> frozenset[IRI]:
    return frozenset(SH[name] for name in names)


COUNTS = _terms("minCount", "maxCount", "minLength", "maxLength", "qualifiedMinCount", "qualifiedMaxCount")
SWITCHES = _terms("closed", "deactivated", "uniqueLang", "qualifiedValueShapesDisjoint")
LISTS = _terms("in", "languageIn", "and", "or", "xone", "ignoredProperties")
NAMES = _terms("class", "datatype", "equals", "disjoint", "lessThan", "lessThanOrEquals")
LIMITS = _terms("minInclusive", "maxInclusive", "minExclusive", "maxExclusive")
LITERAL = COUNTS | SWITCHES | LIMITS | _terms("pattern", "flags")
"""What has a literal as its value."""
NODES = _terms("node", "not", "property", "qualifiedValueShape", "sparql")
NODE_KINDS = _terms("IRI", "BlankNode", "Literal", "BlankNodeOrIRI", "BlankNodeOrLiteral", "IRIOrLiteral")
ONLY_WITH_A_PATH = _terms("minCount", "maxCount", "uniqueLang", "lessThan", "lessThanOrEquals", "qualifiedValueShape")
BESIDES: dict[IRI, tuple[IRI, ...]] = {
    SH.qualifiedValueShape: (SH.qualifiedMinCount, SH.qualifiedMaxCount),
    SH.qualifiedMinCount: (SH.qualifiedValueShape,),
    SH.qualifiedMaxCount: (SH.qualifiedValueShape,),
    SH.qualifiedValueShapesDisjoint: (SH.qualifiedValueShape,),
    SH.ignoredProperties: (SH.closed,),
}
"""What says nothing without one of others; pySHACL judges no shape with it."""
STATED_ONCE = (
    COUNTS
    | SWITCHES
    | LIMITS
    | _terms("in", "languageIn", "ignoredProperties", "datatype", "nodeKind", "pattern", "flags", "severity")
    | _terms("qualifiedValueShape")
)
"""What a shape says once, if it does (SHACL, appendix C): of some that are said twice, pySHACL judges no shape."""
VALIDATORS = (SH.validator, SH.nodeValidator, SH.propertyValidator)
"""How a constraint component has what says whether a constraint of it holds (SHACL, 6.2.3)."""
PATH_FORMS = _terms("inversePath", "zeroOrMorePath", "oneOrMorePath", "zeroOrOnePath")
"""What leads from a path in brackets to the path that it is made of; an alternative leads to a list of paths."""
DEEPEST_PATH = 50
"""How deep paths within paths are looked at: one that leads back to itself is none."""

ILL_FORMED = "This is not a well-formed shape."
"""What is said of a shape where no more is known."""
DESCRIBED = frozenset((SH.property, SH.sparql))
"""What has a node as its value that is described in the shape, and so no parameter."""
WANTED: dict[IRI, str] = {
    **dict.fromkeys(COUNTS, "a whole number"),
    **dict.fromkeys(SWITCHES, "true or false"),
    **dict.fromkeys(LISTS, "a list in parentheses"),
    **dict.fromkeys(LISTS_OF_SHAPES, "a list in parentheses, of one shape at least"),
    SH.languageIn: 'a list in parentheses, of language tags such as "en" or "de-AT"',
    SH.ignoredProperties: "a list in parentheses, of properties",
    **dict.fromkeys(NAMES, "an IRI"),
    **dict.fromkeys(LIMITS, "a literal"),
    **dict.fromkeys(NODES, "a shape, not a literal"),
    SH.node: "a shape without sh:path, not a literal; one with a sh:path stands behind sh:property",
    SH.nodeKind: f"one of {', '.join(sorted(f'sh:{kind.short}' for kind in NODE_KINDS))}",
    SH.property: "a property shape, which has one sh:path",
    SH.pattern: "a regular expression",
    SH.path: "a property or a path of properties, of which two at least stand in parentheses",
    SH.sparql: "a constraint with one sh:select; sh:ask belongs to the validators of constraint components",
}
"""What the value of each property has to be, in words."""


def unfit(predicate: IRI) -> str:
    """A sentence about a value that cannot stand where it does."""
    wanted = WANTED.get(predicate)
    return f"The value of sh:{predicate.short} has to be {wanted}." if wanted else ILL_FORMED


def misfit(document: Document, triples: Iterable[Triple], variables: frozenset[Term]) -> tuple[Triple, str] | None:
    """The first statement whose value cannot stand where it does, and a sentence.

    A variable may stand wherever no list and no constraint has to be: its value is an IRI or a literal.
    """
    holding = _validators(document)
    for triple in triples:
        shape, predicate, value = triple
        for constraint in [value] if predicate == SH.sparql else holding.get(predicate, ()):
            for statement, sentence in () if isinstance(constraint, Literal) else refused_queries(document, constraint):
                return statement, sentence.rstrip(".")
        if value in variables and predicate not in LISTS | DESCRIBED:
            continue
        if predicate in WANTED and not _fits(document, triple, variables):
            fault = _fault_of_pattern(document, shape, value) if predicate == SH.pattern else None
            return triple, no_pattern(fault) if fault else unfit(predicate).rstrip(".")
        lacking = _lacking(document, shape, predicate)
        if lacking is not None:
            return triple, lacking
        if predicate in STATED_ONCE and value != document.value(shape, predicate):
            return triple, said_twice(predicate)
    return None


def no_pattern(fault: str) -> str:
    """A sentence, without its full stop, about a value of `sh:pattern` with a fault (`pattern_fault`)."""
    return f"This is no regular expression: {fault}"


def _fault_of_pattern(document: Document, shape: Node, value: Term) -> str | None:
    """Why a text, with the flags that its shape states, is no regular expression; None if it is one, or no text."""
    if not isinstance(value, Literal) or value.datatype != XSD.string:
        return None
    return pattern_fault(value.lexical, str(document.value(shape, SH.flags) or ""))


def of_values(predicate: IRI) -> str:
    """A sentence, without its full stop, about a property of SHACL in a shape that has no path."""
    word = predicate.short
    return f"sh:{word} is asked of the values of a property: write sh:property [ sh:path ... ; sh:{word} ... ]"


def said_twice(predicate: IRI) -> str:
    """A sentence, without its full stop, about a property of SHACL of which a shape has several values."""
    return f"A shape has one sh:{predicate.short} at most"


def said_alone(predicate: IRI) -> str:
    """A sentence, without its full stop, about a property of SHACL that says nothing without another."""
    return f"Beside sh:{predicate.short} stands {' or '.join(f'sh:{one.short}' for one in BESIDES[predicate])}"


def _lacking(document: Document, shape: Node, predicate: IRI) -> str | None:
    """What a shape does not say that it has to say beside one of SHACL's properties."""
    if predicate in ONLY_WITH_A_PATH and not document.values(shape, SH.path):
        return of_values(predicate)
    beside = BESIDES.get(predicate, ())
    if beside and not any(document.values(shape, one) for one in beside):
        return said_alone(predicate)
    return None


def _fits(document: Document, triple: Triple, variables: frozenset[Term]) -> bool:
    """Whether the value of a statement may be that of its property, one of SHACL's."""
    shape, predicate, value = triple
    literal = value if isinstance(value, Literal) else None
    if predicate in COUNTS:
        return natural_number(value) is not None
    if predicate in SWITCHES:
        return literal is not None and literal.datatype == XSD.boolean
    if predicate in LISTS:
        return _is_list(document, predicate, value, variables)
    if predicate in NAMES:
        return isinstance(value, IRI)
    if predicate in LIMITS:
        return literal is not None
    if predicate == SH.nodeKind:
        return value in NODE_KINDS
    if predicate == SH.pattern:
        text = literal is not None and literal.datatype == XSD.string
        return text and _fault_of_pattern(document, shape, value) is None
    return literal is None and _fitting_node(document, predicate, value)


def _is_list(document: Document, predicate: IRI, value: Term, variables: frozenset[Term]) -> bool:
    """Whether a term is a list that may be the value of one of SHACL's properties."""
    if value == NIL:
        return predicate not in LISTS_OF_SHAPES
    members = [member for member in document.items(value) if member not in variables]
    if predicate == SH.languageIn:
        fit = all(isinstance(member, Literal) and _is_language_range(member) for member in members)
    else:
        fit = predicate != SH.ignoredProperties or all(isinstance(member, IRI) for member in members)
    return document.list_fault(value) is None and fit


def _is_language_range(member: Literal) -> bool:
    """Whether a literal may be in `sh:languageIn`: a tag such as en or de-AT, with hyphens, no underscores."""
    return member.datatype == XSD.string and in_lexical_space(member.lexical, XSD.language)


def _fitting_node(document: Document, predicate: IRI, value: Term) -> bool:
    """Whether a node may be the value of one of SHACL's properties that lead to nodes."""
    if predicate == SH.property:
        return len(document.values(value, SH.path)) == 1
    if predicate == SH.sparql:
        return len(document.values(value, SH.select)) == 1
    if predicate == SH.node:
        return not document.values(value, SH.path)
    return predicate != SH.path or is_path(document, value)


def shapes_behind(document: Document, predicate: IRI, value: Term) -> Sequence[Term]:
    """The shapes to which a statement of a shape leads: those of a list, or its value, or none."""
    if predicate in LISTS_OF_SHAPES:
        return document.items(value)
    return (value,) if predicate in SHAPE_VALUED else ()


def is_path(document: Document, path: Term, depth: int = 0) -> bool:
    """Whether a term is a property path (SHACL, 2.3.1): a property, or a blank node with one of the forms of a path."""
    if depth > DEEPEST_PATH or isinstance(path, Literal) or path == NIL:
        return False
    if isinstance(path, IRI):
        return True
    said = document.about(path)
    if document.value(path, FIRST) is not None:
        return _paths(document, path, depth)
    if len(said) != 1:
        return False
    ((form, inner),) = said
    if form == SH.alternativePath:
        return _paths(document, inner, depth)
    return form in PATH_FORMS and is_path(document, inner, depth + 1)


def _paths(document: Document, head: Term, depth: int) -> bool:
    """Whether a list has two members or more, each of them a path."""
    members = document.items(head)
    return (
        len(members) > 1
        and document.list_fault(head) is None
        and all(is_path(document, member, depth + 1) for member in members)
    )


def _validators(document: Document) -> dict[IRI, list[Term]]:
    """What holds the queries of the document's own SPARQL-based constraint components, by the predicates of these."""
    found: dict[IRI, list[Term]] = {}
    kinds = [SH.ConstraintComponent]
    for kind in kinds:  # which grows on the way: instances of a class below it count, too (SHACL, 6.2 and 1.1)
        below = (subject for subject, said in document.statements.items() if (RDFS.subClassOf, kind) in said)
        kinds += [one for one in below if isinstance(one, IRI) and one not in kinds]
    for component in (one for kind in kinds for one in document.instances(kind)):
        holding = [one for predicate in VALIDATORS for one in document.values(component, predicate)]
        for parameter in document.values(component, SH.parameter):
            for path in document.values(parameter, SH.path):
                if isinstance(path, IRI):
                    found.setdefault(path, []).extend(holding)
    return found


def component_parameters(document: Document) -> frozenset[IRI]:
    """Return the predicates by which a shape of the document uses one of its own SPARQL-based constraint components.

    Only pySHACL can judge what they say.
    """
    return frozenset(_validators(document))
