"""Constraint components whose validators are queries (SHACL, 6.2 and 6.3), where pySHACL departs from SHACL.

pySHACL asks a SELECT validator once for each value, to which it binds `value` beforehand. So a validator of a node that
selects `?value`, as SHACL's own do, finds nothing, and one that looks for a value that is missing is never asked. And
it binds no `value` for an ASK validator where the value is 0, "" or false.
"""

from __future__ import annotations

from contextlib import AbstractContextManager
from typing import Any

from pyshacl.constraints.sparql.sparql_based_constraint_components import SelectConstraintValidator
from pyshacl.helper.sparql_query_helper import SPARQLQueryHelper

from selfconf.rdf.library_patches import replaced

_selected, _bound = vars(SelectConstraintValidator)["validate"], vars(SPARQLQueryHelper)["pre_bind_variables"]


def _selected_once(validator: Any, executor: Any, focus: Any, values: object, *rest: Any, **others: Any) -> Any:
    """The solutions of a SELECT validator, which is asked about the focus node alone."""
    return _selected(validator, executor, focus, [None], *rest, **others)


def _with_any_value(
    helper: Any, focus: Any, valuenode: Any = None, extravars: Any = None
) -> tuple[dict[str, Any], str]:
    """What pySHACL binds before it asks a query, and the query, whatever the value is."""
    bindings, text = _bound(helper, focus, valuenode, extravars)
    return bindings if valuenode is None else {**bindings, "value": valuenode}, text


_INSTEAD: tuple[tuple[object, str, object], ...] = (
    (SelectConstraintValidator, "validate", _selected_once),
    (SPARQLQueryHelper, "pre_bind_variables", _with_any_value),
)


def query_validators() -> AbstractContextManager[None]:
    """In the block, pySHACL asks the validators of constraint components as SHACL has it."""
    return replaced(_INSTEAD)
