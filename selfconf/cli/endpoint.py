"""Advertisements from a SPARQL 1.1 endpoint, over HTTP: an Oxigraph server, a Fuseki, whatever holds the ecology."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from urllib.error import HTTPError, URLError
from urllib.parse import urlsplit
from urllib.request import Request, urlopen

from selfconf.cli.inputs import collector_at_rest, complain
from selfconf.errors import AuthorError, NetworkError, TurtleError
from selfconf.model.hierarchy import Hierarchy
from selfconf.model.term import IRI
from selfconf.rdf import advertisements, remote, turtle
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.eligibility import CompiledRole

PATIENCE = 120.0
"""Seconds without a word from the endpoint after which it is given up."""


def add_endpoint_argument(parser: argparse.ArgumentParser) -> None:
    """The option for an ecology behind a SPARQL endpoint."""
    parser.add_argument(
        "--endpoint",
        metavar="URL",
        help="a SPARQL 1.1 endpoint that holds the advertisements, in its default graph or in named ones",
    )


def read_endpoint(url: str, roles: Sequence[CompiledRole], hierarchy: Hierarchy) -> dict[IRI, Advertisement]:
    """The advertisements there of components that some role may want. One that does not conform is named on stderr.

    Raises NetworkError, and AuthorError for what is no URL.
    """
    answer = json.loads(ask(url, remote.TYPES, "application/sparql-results+json"))
    types = [IRI(row["type"]["value"]) for row in answer["results"]["bindings"] if row["type"]["type"] == "uri"]
    wanted = remote.wanted(types, roles, hierarchy)
    if not wanted:
        return {}
    found = ask(url, remote.statements(wanted), "application/n-triples")
    with collector_at_rest():
        try:
            good, bad = advertisements.read(turtle.parse(found, url))
        except TurtleError as error:
            raise NetworkError(f"{url} does not answer in N-Triples: {error.message}") from None
    for malformed in bad:
        complain(f"{url}: left out {malformed.component}: {malformed.problems[0]}")
    return {advertisement.component: advertisement for advertisement in good}


def ask(url: str, query: str, form: str) -> bytes:
    """The answer of an endpoint (SPARQL 1.1 Protocol, section 2.1.3). Raises AuthorError or NetworkError."""
    if urlsplit(url).scheme not in ("http", "https"):
        raise AuthorError(f"--endpoint takes an http or https URL, not {url!r}")
    request = Request(url, query.encode(), {"Content-Type": "application/sparql-query", "Accept": form})
    try:
        with urlopen(request, timeout=PATIENCE) as reply:
            answer: bytes = reply.read()
            return answer
    except HTTPError as error:
        with error:
            detail = " ".join(error.read(300).decode(errors="replace").split())
        raise NetworkError(f"{url} answers {error.code}: {detail or error.reason}") from None
    except (URLError, OSError) as error:
        reason = getattr(error, "reason", error)
        raise NetworkError(f"cannot ask {url}: {reason}; is the server running, and is this its query URL?") from None
