"""Components, roles and values as users name them: by IRI, by CURIE, or by local name."""

from __future__ import annotations

from selfconf.model.curie import is_local_name, is_prefix
from selfconf.rdf.sparql import QUERY_PREFIXES


def iri_or_local_name(term: str) -> str:
    """The IRI or the local name that a term is, without brackets and prefix.

    A CURIE with a prefix by which tables shorten names, such as `home:astrid-drive`, is that IRI. Another prefix is one
    of some template or advertisement, which travel without their prefixes, and is left out. What begins with `urn:` is
    an IRI.
    """
    if term.startswith("<"):
        return term.removeprefix("<").removesuffix(">")
    prefix, colon, local = term.partition(":")
    if not colon or prefix == "urn" or not is_prefix(prefix) or not is_local_name(local):
        return term
    return QUERY_PREFIXES.get(prefix, "") + local
