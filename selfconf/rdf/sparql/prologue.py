"""The prologue of a SPARQL query: what stands before SELECT, ASK, CONSTRUCT or DESCRIBE."""

from __future__ import annotations

import re

from selfconf.rdf.sparql.read_only import without

PROLOGUE = re.compile(r"\A(?:\s*(?:prefix\s+[^\s:]*\s*:|base)\s*<[^<>\s]*>)*\s*", re.IGNORECASE)
"""The prologue, and the space around it, of a query without comments."""
_DECLARATION = re.compile(r"\bprefix\s+([^\s:]*)\s*:\s*<([^<>\s:]+:[^<>\s]*)>", re.IGNORECASE)


def declared_prefixes(text: str) -> dict[str, str]:
    """The prefixes that a query declares, with their namespaces; those with a relative IRI are left out."""
    prologue = PROLOGUE.match(without(text, "#"))
    return dict(_DECLARATION.findall(prologue[0])) if prologue else {}
