"""Constraint components whose validators are queries (SHACL, 6.2 and 6.3), where pySHACL departs from SHACL.

pySHACL asks a SELECT validator once for each value, to which it binds `value` beforehand. So a validator of a node that
selects `?value`, as SHACL's own do, finds nothing, and one that looks for a value that is missing is never asked. It
binds no `value` for an ASK validator where the value is 0, "" or false. And of several values of a parameter, each of
which is a constraint, it takes one, which depends on the seed of Python's hashes.

Of the prefixes of a query it takes those that any ontology of the shapes declares, but not always those of an ontology
that another imports (SHACL, 5.2.1).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import AbstractContextManager
from itertools import product
from typing import Any

from pyshacl.constraints.sparql.sparql_based_constraint_components import (
    AskConstraintValidator,
    BoundShapeValidatorComponent,
    SelectConstraintValidator,
)
from pyshacl.errors import ConstraintLoadError
from pyshacl.helper.sparql_query_helper import SPARQLQueryHelper
from rdflib import OWL, SH, Literal, URIRef
from rdflib.term import Node

from selfconf.model.term import IRI
from selfconf.rdf.pyshacl_corrections.library_patches import replaced

_asked, _selected = vars(AskConstraintValidator)["validate"], vars(SelectConstraintValidator)["validate"]
_bound = vars(SPARQLQueryHelper)["pre_bind_variables"]


def _asked_each(validator: Any, executor: Any, focus: Any, values: Any, graph: Any, helper: Any) -> Iterator[Any]:
    """What an ASK validator finds wrong with the values."""
    for arguments in _arguments(helper):
        helper.param_bind_map = arguments  # by which pySHACL also words the message of what is yielded next
        yield from _asked(validator, executor, focus, values, graph, helper)


def _selected_each(validator: Any, executor: Any, focus: Any, values: Any, graph: Any, helper: Any) -> Iterator[Any]:
    """What a SELECT validator finds, which is asked about the focus node alone."""
    for arguments in _arguments(helper):
        helper.param_bind_map = arguments
        yield from ((focus, found) for _, found in _selected(validator, executor, focus, [None], graph, helper))


def _arguments(helper: Any) -> Iterable[dict[str, Node]]:
    """The values of the parameters that a shape states, one of each, in every combination."""
    stated = {one.localname: sorted(helper.shape.objects(one.path()), key=str) for one in helper.parameters}
    names = [name for name, values in stated.items() if values]
    return [dict(zip(names, values, strict=True)) for values in product(*(stated[name] for name in names))]


def _with_any_value(
    helper: Any, focus: Any, valuenode: Any = None, extravars: Any = None
) -> tuple[dict[str, Any], str]:
    """What pySHACL binds before it asks a query, and the query, whatever the value is."""
    bindings, text = _bound(helper, focus, valuenode, extravars)
    return bindings if valuenode is None else {**bindings, "value": valuenode}, text


def _collected(helper: Any) -> None:
    """Take the prefixes of a query: those of `sh:prefixes/owl:imports*/sh:declare`."""
    graph = helper.shape.sg.graph
    for owner in {
        one for first in graph.objects(helper.node, SH.prefixes) for one in graph.transitive_objects(first, OWL.imports)
    }:
        for declaration in graph.objects(owner, SH.declare):
            prefix, namespace = (graph.value(declaration, said) for said in (SH.prefix, SH.namespace))
            if not isinstance(prefix, Literal) or not isinstance(namespace, Literal):
                message = "sh:declare leads to no sh:prefix and sh:namespace"
                raise ConstraintLoadError(message, str(SH.declare))  # type: ignore[no-untyped-call]
            helper.prefixes[str(prefix)] = URIRef(namespace)


def _named(component: Any, *_: object) -> list[Literal]:
    """The message of a component that has none."""
    arguments = (f"{name} {_short(value)}" for name, value in component.query_helper.param_bind_map.items())
    return [Literal(f"{_short(component.constraint.node)}, with {' and '.join(arguments)}")]


def _short(node: Node) -> str:
    return IRI.unchecked(str(node)).short if isinstance(node, URIRef) else str(node)


_INSTEAD: tuple[tuple[object, str, object], ...] = (
    (AskConstraintValidator, "validate", _asked_each),
    (SelectConstraintValidator, "validate", _selected_each),
    (SPARQLQueryHelper, "collect_prefixes", _collected),
    (SPARQLQueryHelper, "pre_bind_variables", _with_any_value),
    (BoundShapeValidatorComponent, "make_generic_messages", _named),
)


def query_validators() -> AbstractContextManager[None]:
    """In the block, pySHACL asks the validators of constraint components as SHACL has it."""
    return replaced(_INSTEAD)
