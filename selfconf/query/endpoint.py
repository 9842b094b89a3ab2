"""A SPARQL 1.1 endpoint, asked over HTTP: an Oxigraph server, a Fuseki, whatever holds the ecology.

No redirect is followed: a POST loses its query on the way, and no server chooses with what else this machine talks.
Whatever else goes wrong between here and there is a NetworkError, also an answer that breaks off or is none.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from http.client import HTTPException, HTTPResponse, InvalidURL
from urllib.error import HTTPError
from urllib.parse import urlsplit
from urllib.request import Request

import pyoxigraph as ox

from selfconf.errors import AuthorError, NetworkError, TurtleError
from selfconf.http_opener import http_opener
from selfconf.model.hierarchy import Hierarchy
from selfconf.model.left_out import LeftOut
from selfconf.model.profile import Place
from selfconf.model.setting_names import setting
from selfconf.model.term import IRI
from selfconf.rdf import advertisements
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.eligibility import TYPES, CompiledRole, statements, wanted
from selfconf.rdf.sparql import QueryAnswer

ENDPOINT_PATIENCE = 120.0
"""Seconds without a word from the endpoint after which it is given up."""
RESULTS, TRIPLES = "application/sparql-results+json", "application/n-triples"
"""What is asked for: the solutions of SELECT and ASK, the triples of CONSTRUCT and DESCRIBE."""


def read_endpoint(
    url: str, roles: Sequence[CompiledRole], hierarchy: Hierarchy
) -> tuple[dict[IRI, Advertisement], list[LeftOut]]:
    """The advertisements there of components that some role may want, and those that do not conform.

    Raises NetworkError, and AuthorError for what is no URL.
    """
    with asked(url, TYPES, RESULTS) as answer:
        if not isinstance(answer, ox.QuerySolutions) or ox.Variable("type") not in answer.variables:
            raise NetworkError(f"{url} does not answer a SELECT with its solutions; is this its query URL?")
        types = [IRI(kind.value) for kind in (row["type"] for row in answer) if isinstance(kind, ox.NamedNode)]
    relevant = wanted(types, roles, hierarchy)
    if not relevant:
        return {}, []
    with _reply(url, statements(relevant), TRIPLES, ENDPOINT_PATIENCE) as reply:
        found = reply.read()
    try:
        good, bad = advertisements.read_advertisements(found, url)
    except TurtleError as error:
        raise NetworkError(f"{url} does not answer in N-Triples: {_line(error.message)}") from None
    left_out = [LeftOut(Place(url), malformed.component, malformed.problems[0]) for malformed in bad]
    return {advertisement.component: advertisement for advertisement in good}, left_out


@contextmanager
def asked(
    url: str, query: str, form: str = f"{RESULTS}, {TRIPLES}", patience: float = ENDPOINT_PATIENCE
) -> Iterator[QueryAnswer | Iterator[ox.Triple]]:
    """What an endpoint answers, read from the network while it is looked at. Raises as `read_endpoint` does."""
    with _reply(url, query, form, patience) as reply:
        kind = reply.headers.get_content_type()
        results, triples = ox.QueryResultsFormat.from_media_type(kind), ox.RdfFormat.from_media_type(kind)
        try:
            if results in (ox.QueryResultsFormat.JSON, ox.QueryResultsFormat.XML):
                yield ox.parse_query_results(reply, format=results)
            elif triples is not None:
                yield (quad.triple for quad in ox.parse(reply, format=triples))
            else:
                raise NetworkError(f"{url} answers in {kind}, which was not asked for; is this its query URL?")
        except SyntaxError as error:
            what = f"breaks off, or is not the {kind} that it says"
            raise NetworkError(f"the answer of {url} {what}: {_line(error)}") from None
        if reply.isclosed() and reply.length:
            raise NetworkError(f"the answer of {url} breaks off {reply.length} bytes before its end")


@contextmanager
def _reply(url: str, query: str, form: str, patience: float) -> Iterator[HTTPResponse]:
    """The reply of an endpoint to a query sent by POST (SPARQL 1.1 Protocol, section 2.1.3)."""
    with _opened(url, query, form, patience) as reply:
        try:
            yield reply
        except (OSError, HTTPException) as error:
            raise NetworkError(f"the answer of {url} breaks off: {_line(error)}") from None


def _opened(url: str, query: str, form: str, patience: float) -> HTTPResponse:
    try:
        if urlsplit(url).scheme not in ("http", "https"):
            raise AuthorError(f"{setting('endpoint')} takes an http or https URL, not {url!r}")
        request = Request(url, query.encode(), {"Content-Type": "application/sparql-query", "Accept": form})
        reply: HTTPResponse = http_opener().open(request, timeout=patience)
    except HTTPError as error:
        raise NetworkError(f"{url} answers {error.code}: {_detail(error)}") from None
    except InvalidURL as error:
        raise AuthorError(f"{url!r} is no URL: {error}") from None
    except (OSError, HTTPException) as error:
        reason = getattr(error, "reason", None) or str(error) or type(error).__name__
        raise NetworkError(
            f"cannot ask {url}: {_line(reason)}; is the server running, and is this its query URL?"
        ) from None
    except ValueError as error:
        raise AuthorError(f"{url!r} is no URL: {error}") from None
    return reply


def _detail(error: HTTPError) -> str:
    """What a server says about its refusal."""
    with error:
        try:
            said = error.read(300).decode(errors="replace")
        except (OSError, HTTPException):
            said = ""
    if "Location" in error.headers:
        said = f"{error.reason}, go to {error.headers['Location']}; no redirect is followed, give the URL that is meant"
    return _line(said) or _line(error.reason)


def _line(said: object) -> str:
    """Words of a server on one line, without what would steer a terminal."""
    return "".join(letter for letter in " ".join(str(said).split()) if letter.isprintable())
