"""Regular expressions inside pySHACL and rdflib, at a cost that the texts of strangers cannot choose.

pySHACL (`sh:pattern`) and rdflib (REGEX and REPLACE of SPARQL) ask `re`, which can take years. Within `linear_patterns`
their modules see another `re`, which answers the same by `selfconf.rdf.shacl.pattern`, but for what an expression of
SPARQL means otherwise (`sparql_expression`).
"""

from __future__ import annotations

import re
from contextlib import AbstractContextManager
from types import ModuleType
from typing import Any

from pyshacl.constraints.core import string_based_constraints
from pyshacl.constraints.core.string_based_constraints import PatternConstraintComponent
from rdflib.plugins.sparql import operators

from selfconf.rdf.pyshacl_corrections.library_patches import replaced
from selfconf.rdf.shacl import Pattern, pattern, shacl_pattern, sparql_expression


class _Expression:
    """What pySHACL takes for a compiled regular expression; it asks whether there is a match, never which."""

    def __init__(self, expression: Pattern) -> None:
        self._pattern = expression

    def search(self, text: str) -> bool:
        return self._pattern.finds(text)

    match = search  # pySHACL asks for either


class _LinearRe(ModuleType):
    """What pySHACL and rdflib use of `re`."""

    def __getattr__(self, name: str) -> Any:
        return getattr(re, name)

    def compile(self, expression: str, flags: int = 0) -> None:
        """Nothing: `_with_all_flags` compiles what pySHACL would, with flags by which it may be no expression to it."""

    def search(self, expression: str, text: str, flags: int = 0) -> bool:
        return pattern(sparql_expression(expression, int(flags)), int(flags)).finds(text)

    def sub(self, expression: str, replacement: str, text: str, flags: int = 0) -> str:
        """What `re.sub` returns; rdflib hands it the flags of REPLACE where it takes a count."""
        expression = sparql_expression(expression, int(flags))
        if not pattern(expression, int(flags)).finds(text):
            return text
        return re.sub(expression, replacement, text, flags=flags)


_initialised = vars(PatternConstraintComponent)["__init__"]


def _with_all_flags(component: Any, shape: Any) -> None:
    """What pySHACL makes of a `sh:pattern`, with the flags s, x and q as well, which it passes over."""
    _initialised(component, shape)
    flags = "" if component.flags is None else str(component.flags)
    component.compiled_cache = {rule: _Expression(shacl_pattern(str(rule), flags)) for rule in component.string_rules}


_LINEAR = _LinearRe("re")
_INSTEAD: tuple[tuple[object, str, object], ...] = (
    (string_based_constraints, "re", _LINEAR),
    (PatternConstraintComponent, "__init__", _with_all_flags),
    (operators, "re", _LINEAR),
)


def linear_patterns() -> AbstractContextManager[None]:
    """In the block, pySHACL and rdflib match patterns in linear time."""
    return replaced(_INSTEAD)
