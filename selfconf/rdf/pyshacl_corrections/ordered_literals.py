"""What pySHACL compares: literals that have an order, as SPARQL has it (`selfconf.rdf.literal_comparison`).

pySHACL also orders what has no order. It also lets a blank node, which has no length, pass `sh:minLength 0` (SHACL,
4.4.1).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from contextlib import AbstractContextManager
from typing import Any

import rdflib
from pyshacl.constraints.core import value_range_constraints
from pyshacl.constraints.core.property_pair_constraints import (
    LessThanConstraintComponent,
    LessThanOrEqualsConstraintComponent,
)
from pyshacl.constraints.core.string_based_constraints import MinLengthConstraintComponent

from selfconf.rdf.literal_comparison import compare_in_order, order_of
from selfconf.rdf.pyshacl_corrections.library_patches import replaced


def _less(component: Any, values: Iterable[Any], others: Iterable[Any], graph: Any, focus: Any) -> tuple[bool, Any]:
    return _compared(component, values, others, graph, focus, lambda order: order < 0)


def _less_or_equal(
    component: Any, values: Iterable[Any], others: Iterable[Any], graph: Any, focus: Any
) -> tuple[bool, Any]:
    return _compared(component, values, others, graph, focus, lambda order: order <= 0)


def _compared(
    component: Any, values: Iterable[Any], others: Iterable[Any], graph: Any, focus: Any, holds: Callable[[int], bool]
) -> tuple[bool, Any]:
    """What pySHACL wants to know of a constraint on two properties: whether it is violated, and the results."""
    orders = [(value, order_of(value, other)) for value in values for other in others]
    wrong = [value for value, order in orders if order is None or not holds(order)]
    return bool(wrong), [component.make_v_result(graph, focus, value_node=value) for value in wrong]


def _long_enough(component: Any, least: Any, graph: Any, nodes: Mapping[Any, Iterable[Any]]) -> tuple[bool, Any]:
    """What pySHACL wants to know of `sh:minLength`: whether it is violated, and the results."""
    wrong = [
        component.make_v_result(graph, focus, value_node=value)
        for focus, values in nodes.items()
        for value in values
        if isinstance(value, rdflib.BNode) or len(component.value_node_to_string(value)) < least.value
    ]
    return bool(wrong), wrong


_INSTEAD: tuple[tuple[object, str, object], ...] = (
    (value_range_constraints, "compare_literal", compare_in_order),
    (LessThanConstraintComponent, "_compare_lt", _less),
    (LessThanOrEqualsConstraintComponent, "_compare_ltoe", _less_or_equal),
    (MinLengthConstraintComponent, "_evaluate_string_rule", _long_enough),
)
"""What pySHACL compares by: where it is, its name, and what takes its place."""


def only_ordered() -> AbstractContextManager[None]:
    """In the block, pySHACL lets a value pass beside a limit, or another property, only if the two have an order."""
    return replaced(_INSTEAD)
