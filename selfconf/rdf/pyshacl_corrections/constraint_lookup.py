"""The constraints that pySHACL knows, looked up by hash.

For each shape and node pySHACL asks of every predicate of the shape whether it is one of some forty constraint
parameters, and compares it with one after the other: a third of all that judging takes. It keeps them in a list that
its module has once it was needed, and here that list is given an index.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from pyshacl import shape
from pyshacl.constraints import ALL_CONSTRAINT_PARAMETERS, CONSTRAINT_PARAMETERS_MAP


class _IndexedList(list[Any]):
    """A list that knows its members by hash; it does not change, and its copies are lists as any other."""

    def __init__(self, members: list[Any]) -> None:
        super().__init__(members)
        self._members = frozenset(members)

    def __contains__(self, member: object) -> bool:
        return member in self._members


@cache
def index_constraints() -> None:
    """Let pySHACL look its constraint parameters up by hash, for good; it finds the same ones."""
    vars(shape)["CONSTRAINT_PARAMS"] = (_IndexedList(list(ALL_CONSTRAINT_PARAMETERS)), CONSTRAINT_PARAMETERS_MAP)
