"""Regular expressions inside pySHACL and rdflib, at a cost that the texts of strangers cannot choose.

pySHACL (`sh:pattern`) and rdflib (REGEX and REPLACE of SPARQL) ask `re`, which can take years. Within `linear_patterns`
their modules see another `re`, which answers the same by `selfconf.rdf.shacl.pattern`. Queries are parsed once as
well, not once for each component: parsing takes longer than most answers. In them `"x"` and `"x"^^xsd:string` are one
string, as in RDF 1.1. And pySHACL does not write the terms of each result into the text of its report, which took a
quarter of the time and is not read.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from contextlib import AbstractContextManager
from functools import lru_cache
from types import ModuleType
from typing import Any

from pyshacl.constraints import constraint_component
from pyshacl.constraints.core import string_based_constraints
from pyshacl.constraints.core.string_based_constraints import PatternConstraintComponent
from rdflib import XSD, Literal
from rdflib.plugins.sparql import algebra, operators, processor

from selfconf.rdf.library_patches import replaced
from selfconf.rdf.shacl import Pattern, pattern, shacl_pattern


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
        return pattern(expression, int(flags)).finds(text)

    def sub(self, expression: str, replacement: str, text: str, count: int = 0, flags: int = 0) -> str:
        if not pattern(expression, int(flags)).finds(text):
            return text
        return re.sub(expression, replacement, text, count=count, flags=flags)


_initialised = vars(PatternConstraintComponent)["__init__"]


def _with_all_flags(component: Any, shape: Any) -> None:
    """What pySHACL makes of a `sh:pattern`, with the flags s, x and q as well, which it passes over."""
    _initialised(component, shape)
    flags = "" if component.flags is None else str(component.flags)
    component.compiled_cache = {rule: _Expression(shacl_pattern(str(rule), flags)) for rule in component.string_rules}


_parse, _translate = vars(processor)["parseQuery"], vars(processor)["translateQuery"]


@lru_cache(maxsize=64)
def _prepared(text: str, base: str | None, namespaces: tuple[tuple[str, Any], ...]) -> Any:
    """A query ready to be evaluated, as often as it is asked."""
    return _translate(_parse(text), base, dict(namespaces))


_named = vars(algebra)["translatePName"]


def _plainly_named(part: Any, prologue: Any) -> Any:
    """What a name or a literal of a query stands for; a string has no datatype, as in graphs (`rdflib_terms`)."""
    found = _named(part, prologue)
    return Literal(str(found)) if isinstance(found, Literal) and found.datatype == XSD.string else found


def _recalled(text: str, base: str | None = None, namespaces: Mapping[str, Any] | None = None) -> Any:
    return _prepared(text, base, tuple(sorted((namespaces or {}).items())))


def _unread(graph: object, node: object) -> str:
    """A term in the text of a report."""
    return ""


_LINEAR = _LinearRe("re")
_INSTEAD: tuple[tuple[object, str, object], ...] = (
    (string_based_constraints, "re", _LINEAR),
    (PatternConstraintComponent, "__init__", _with_all_flags),
    (operators, "re", _LINEAR),
    (processor, "parseQuery", str),  # parsed by `_recalled`, where it has not been
    (processor, "translateQuery", _recalled),
    (algebra, "translatePName", _plainly_named),
    (constraint_component, "stringify_node", _unread),
)


def linear_patterns() -> AbstractContextManager[None]:
    """In the block, pySHACL and rdflib match patterns in linear time."""
    return replaced(_INSTEAD)
