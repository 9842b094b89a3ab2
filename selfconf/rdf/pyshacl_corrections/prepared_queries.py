"""Queries inside pySHACL and rdflib, each of which is read once.

pySHACL hands rdflib the text of a query anew for each component, and to parse it takes longer than most answers. Within
`prepared_queries` rdflib parses each text once. In it `"x"` and `"x"^^xsd:string` are one string, as in RDF 1.1.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import AbstractContextManager
from functools import lru_cache
from typing import Any

from rdflib import XSD, Literal
from rdflib.plugins.sparql import algebra, processor

from selfconf.rdf.pyshacl_corrections.library_patches import replaced

_parse, _translate = vars(processor)["parseQuery"], vars(processor)["translateQuery"]


@lru_cache(maxsize=64)
def _prepared(text: str, base: str | None, namespaces: tuple[tuple[str, Any], ...]) -> Any:
    """A query ready to be evaluated, as often as it is asked."""
    return _translate(_parse(text), base, dict(namespaces))


def _recalled(text: str, base: str | None = None, namespaces: Mapping[str, Any] | None = None) -> Any:
    return _prepared(text, base, tuple(sorted((namespaces or {}).items())))


_named = vars(algebra)["translatePName"]


def _plainly_named(part: Any, prologue: Any) -> Any:
    """What a name or a literal of a query stands for; a string has no datatype, as in graphs (`rdflib_terms`)."""
    found = _named(part, prologue)
    return Literal(str(found)) if isinstance(found, Literal) and found.datatype == XSD.string else found


_INSTEAD: tuple[tuple[object, str, object], ...] = (
    (processor, "parseQuery", str),  # parsed by `_recalled`, where it has not been
    (processor, "translateQuery", _recalled),
    (algebra, "translatePName", _plainly_named),
)


def prepared_queries() -> AbstractContextManager[None]:
    """In the block, rdflib parses the text of a query once, however often it is asked."""
    return replaced(_INSTEAD)
