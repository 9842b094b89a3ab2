"""A query as SPARQL 1.1 Protocol sends it: by GET, by a form, or directly, with the graphs that are its dataset.

Only what section 2.1 calls the query operation is there: an update is refused, with the status that says why.
"""

from __future__ import annotations

from collections.abc import Sequence
from urllib.parse import parse_qsl

from selfconf.model.immutable import immutable

FORM, DIRECT, UPDATE = "application/x-www-form-urlencoded", "application/sparql-query", "application/sparql-update"
LARGEST_REQUEST = 1 << 20
"""A request with a body of more bytes than this is refused."""
_DEFAULT, _NAMED = "default-graph-uri", "named-graph-uri"


@immutable
class QueryRequest:
    """A query and its dataset; without graphs it is asked of all."""

    text: str
    default_graphs: tuple[str, ...] = ()
    named_graphs: tuple[str, ...] = ()


class RequestRefusedError(Exception):
    """A request that is no query, with the HTTP status that tells why."""

    def __init__(self, status: int, detail: str) -> None:
        super().__init__(detail)
        self.status, self.detail = status, detail


def query_request(method: str, parameters: str, content_type: str, body: bytes) -> QueryRequest | None:
    """The query of a request; None for a GET without any, which asks for the service description.

    `parameters` is what stands behind the question mark of the URL. Raises RequestRefusedError.
    """
    given = _pairs(parameters)
    if method == "GET":
        if not given:
            return None
        return _request(given)
    media, charset = _media(content_type)
    if media == UPDATE:
        raise RequestRefusedError(
            403, "this endpoint only answers queries; nothing in the ecology is changed by SPARQL"
        )
    if media not in (FORM, DIRECT):
        known = f"{DIRECT} or {FORM}"
        raise RequestRefusedError(415, f"a query is sent as {known}, not as {media or 'a body without Content-Type'}")
    if charset not in ("", "utf-8", "utf8"):
        raise RequestRefusedError(415, f"a query is sent in UTF-8, not in {charset}")
    try:
        text = body.decode()
    except UnicodeDecodeError:
        raise RequestRefusedError(400, "the body is not UTF-8") from None
    return _request(given + _pairs(text)) if media == FORM else _request([*given, ("query", text)])


def _request(given: Sequence[tuple[str, str]]) -> QueryRequest:
    queries = [value for name, value in given if name == "query"]
    if any(name in ("update", "using-graph-uri", "using-named-graph-uri") for name, _ in given):
        raise RequestRefusedError(
            403, "this endpoint only answers queries; nothing in the ecology is changed by SPARQL"
        )
    if len(queries) != 1:
        number = "no" if not queries else "more than one"
        raise RequestRefusedError(400, f"the request has {number} parameter 'query'; give exactly one")
    graphs = {wanted: tuple(value for name, value in given if name == wanted) for wanted in (_DEFAULT, _NAMED)}
    for graph in (*graphs[_DEFAULT], *graphs[_NAMED]):
        if ":" not in graph or any(mark in graph for mark in '<>"{}|^`\\ \n'):
            raise RequestRefusedError(400, f"{graph!r} is no IRI of a graph")
    return QueryRequest(queries[0], graphs[_DEFAULT], graphs[_NAMED])


def _pairs(text: str) -> list[tuple[str, str]]:
    try:
        return parse_qsl(text, keep_blank_values=True, errors="strict", max_num_fields=1000)
    except ValueError:
        raise RequestRefusedError(400, "the parameters are not UTF-8, or too many") from None


def _media(content_type: str) -> tuple[str, str]:
    media, *parameters = (part.strip().lower() for part in content_type.split(";"))
    charset = next((one.partition("=")[2].strip('"') for one in parameters if one.startswith("charset=")), "")
    return media, charset
