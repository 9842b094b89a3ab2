"""What pySHACL finds violated, in the words in which the compiled tests say it (`selfconf.model.property_fault`).

What the author of a shape says goes before (`sh:message`). Of constraints over other shapes pySHACL's own list of them
is kept, with names in place of IRIs: it shows what is asked for.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from rdflib import RDF, SH, Graph, URIRef
from rdflib.term import Node

from selfconf.model.property_fault import ConstraintFailed, NotAmong
from selfconf.model.term import IRI, Term, sort_key
from selfconf.model.wording import in_english, in_words, listed, term_in_words
from selfconf.rdf.rdflib_terms import from_rdflib

ViolationResult = Mapping[Node, Sequence[tuple[Graph, Node]]]
"""One result of a validation: its properties, each with its values and the graphs that describe these."""
_ENDING = "ConstraintComponent"
_OF_IRIS = frozenset(("class", "datatype", "nodeKind", "lessThan", "lessThanOrEquals"))
_OF_LITERALS = frozenset(
    ("pattern", "minLength", "maxLength", "minInclusive", "maxInclusive", "minExclusive", "maxExclusive")
)
"""Constraints of each value that say an IRI, and those that say a literal."""
_COUNTED = {
    "minCount": "there are fewer than {} of {}",
    "maxCount": "there are more than {} of {}",
    "qualifiedMinCount": "fewer than {} of {} are as asked for",
    "qualifiedMaxCount": "more than {} of {} are as asked for",
}
"""Constraints of how many values there are; each sentence has the number and the path."""
_STEPS: Mapping[Node, str] = {
    SH.inversePath: "^{}",
    SH.zeroOrMorePath: "{}*",
    SH.oneOrMorePath: "{}+",
    SH.zeroOrOnePath: "{}?",
}
"""How a path with one of SHACL's forms is written in SPARQL."""
_LOGICAL = frozenset(("and", "or", "not", "xone"))
"""Constraints over other shapes; pySHACL's message lists these behind what it calls the node."""
_LITERAL = re.compile(r'Literal\("(.*?)"(?: = .*?)?(?:, (?:datatype|lang)=([^)]*))?\)')
_IRI = re.compile(r"<([^<>\s]+)>")
_BARE = frozenset(("integer", "decimal", "double", "boolean"))
"""The datatypes that Turtle writes without quotation marks."""


def violation_words(result: ViolationResult, details: Sequence[ViolationResult], asked: Node) -> str:
    """A clause about a result, of the node that was asked about; `details` are the results that led to it."""
    return _clause(result, details, asked, "")


def _clause(result: ViolationResult, details: Sequence[ViolationResult], asked: Node, outer: str) -> str:
    """A clause about a result, of a node to which an outer path leads."""
    said, kind = _message(result), _kind(result)
    if not kind:
        return said
    name = "/".join(filter(None, (outer, _name(result))))
    if kind == "node" and details:
        return " and ".join(sorted({_clause(one, (), one[SH.focusNode][0][1], name) for one in details}))
    focus = result[SH.focusNode][0][1]
    whose = f" of {term_in_words(from_rdflib(focus))}" if name and focus != asked else ""
    return _worded(kind, f"{name}{whose}", result) or _plain(said, kind, f"{name}{whose}", result)


def _message(result: ViolationResult) -> str:
    """What pySHACL says of a result, or the author of the shape."""
    messages = [text for _, text in result.get(SH.resultMessage, ())]  # pySHACL hands them on in no order
    said = in_english((getattr(one, "language", None) or "", str(one)) for one in messages)
    return said or _without_message(result)


def _without_message(result: ViolationResult) -> str:
    """What can be said of a result that has no message, as that of a query whose author states none."""
    if result[SH.sourceConstraintComponent][0][1] != SH.SPARQLConstraintComponent:
        return "does not conform"
    focus = result[SH.focusNode][0][1]
    found = [from_rdflib(value) for _, value in result.get(SH.value, ()) if value != focus]
    return f"the query of the shape finds {in_words(found) if found else 'it'}, and no sh:message says what is wrong"


def _kind(result: ViolationResult) -> str:
    """The property of SHACL that is violated, without its prefix; empty where only the message tells."""
    shapes, shape = result[SH.sourceShape][0]
    constraint = str(result[SH.sourceConstraintComponent][0][1])
    if (shape, SH.message, None) in shapes or not (constraint.startswith(str(SH)) and constraint.endswith(_ENDING)):
        return ""
    kind = constraint.removeprefix(str(SH)).removesuffix(_ENDING)
    return f"{kind[:1].lower()}{kind[1:]}"


def _worded(kind: str, name: str, result: ViolationResult) -> str | None:
    """A clause about a constraint of a kind, where it has words here."""
    shapes, shape = result[SH.sourceShape][0]
    values = frozenset(from_rdflib(value) for _, value in result.get(SH.value, ()))
    wanted = [*shapes.objects(shape, URIRef(f"{SH}{kind}"))]
    terms = sorted(map(from_rdflib, wanted), key=sort_key)
    if kind == "closed" and name:
        return f"{name} may not be stated"
    if kind == "hasValue":
        return _lacking(name, terms)
    if len(wanted) != 1:
        return None
    if kind in _COUNTED and name:
        number = str(terms[0])
        return f"there is no {name}" if (kind, number) == ("minCount", "1") else _COUNTED[kind].format(number, name)
    if kind == "uniqueLang":
        return f"several of {name} have one language"
    return _of_values(kind, name or "it", values, terms[0], frozenset(map(from_rdflib, shapes.items(wanted[0]))))


def _lacking(name: str, wanted: Sequence[Term]) -> str:
    """A clause about values that have to be there."""
    if len(wanted) > 1:
        return f"not all of {listed(map(term_in_words, wanted))} are {name or 'it'}"
    return f"no {name} is {in_words(wanted)}" if name else f"it is not {in_words(wanted)}"


def _of_values(kind: str, name: str, values: frozenset[Term], wanted: Term, members: frozenset[Term]) -> str | None:
    """A clause about values of a path; what is wanted may be the head of a list of members."""
    if not values:
        return None
    if kind in (_OF_IRIS if isinstance(wanted, IRI) else _OF_LITERALS):
        return ConstraintFailed(values, IRI.unchecked(f"{SH}{kind}"), wanted).said(name)
    if kind == "in":
        return NotAmong(values, members).said(name)
    if kind == "languageIn":
        return f"{name} is {in_words(values)}, in none of the languages {in_words(members)}"
    if kind == "equals":
        return f"{name} and {term_in_words(wanted)} differ by {in_words(values)}"
    return f"{name} and {term_in_words(wanted)} are both {in_words(values)}" if kind == "disjoint" else None


def _name(result: ViolationResult) -> str:
    """The path of a result, in words; empty where it has none."""
    return next((_path(shapes, path) for shapes, path in result.get(SH.resultPath, ())), "")


def _path(shapes: Graph, path: Node) -> str:
    """A path as SPARQL has it, with names in place of IRIs."""
    if isinstance(path, URIRef):
        return IRI.unchecked(path).short
    if (path, RDF.first, None) in shapes:
        return "/".join(_path(shapes, one) for one in shapes.items(path))
    for form, inner in shapes.predicate_objects(path):
        if form == SH.alternativePath:
            return f"({'|'.join(_path(shapes, one) for one in shapes.items(inner))})"
        if form in _STEPS:
            return _STEPS[form].format(_path(shapes, inner))
    return "value"


def _plain(message: str, kind: str, name: str, result: ViolationResult) -> str:
    """A message of pySHACL with literals as they are in Turtle, and with names in place of IRIs.

    One of a constraint over other shapes begins with the name of the path.
    """
    said = _IRI.sub(lambda found: IRI.unchecked(found[1]).short, _LITERAL.sub(_literal, message))
    said = said.removesuffix(" See details for more information.").removesuffix(".")
    _, must, asked = said.partition(" must ")
    if kind not in _LOGICAL or not must:
        return said
    values = in_words(frozenset(from_rdflib(value) for _, value in result.get(SH.value, ())))
    return f"{name} is {values}, and must {asked}" if name else f"it must {asked}"


def _literal(found: re.Match[str]) -> str:
    """A literal of a message as it is in Turtle: numbers and truth values stand without quotation marks."""
    short = IRI.unchecked((found[2] or "").strip("<>")).short.removeprefix("xsd:")
    return found[1] if short in _BARE else f'"{found[1]}"'
