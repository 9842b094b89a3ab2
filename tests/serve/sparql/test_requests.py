"""What is a query by SPARQL 1.1 Protocol, and with which status anything else is refused."""

from __future__ import annotations

import pytest

from selfconf.serve.sparql.requests import DIRECT, FORM, QueryRequest, RequestRefusedError, query_request


def test_a_query_comes_in_three_ways() -> None:
    wanted = QueryRequest("ASK {}", ("urn:a",), ("urn:b", "urn:c"))
    graphs = "default-graph-uri=urn:a&named-graph-uri=urn:b&named-graph-uri=urn:c"
    assert query_request("GET", f"query=ASK+%7B%7D&{graphs}", "", b"") == wanted
    assert query_request("POST", "", FORM, f"query=ASK+%7B%7D&{graphs}".encode()) == wanted
    assert query_request("POST", graphs, f"{DIRECT}; charset=UTF-8", b"ASK {}") == wanted
    assert query_request("GET", "", "", b"") is None
    for parameters, number in (("qery=ASK", "no"), ("query=ASK&query=ASK", "more than one")):
        with pytest.raises(RequestRefusedError) as refused:
            query_request("GET", parameters, "", b"")
        assert refused.value.detail == f"the request has {number} parameter 'query'; give exactly one"


@pytest.mark.parametrize(
    ("method", "parameters", "kind", "body", "status"),
    [
        ("GET", "query=ASK+%7B%7D&query=ASK+%7B%7D", "", b"", 400),
        ("GET", "qery=ASK", "", b"", 400),
        ("GET", "query=%FF", "", b"", 400),
        ("GET", "query=ASK&default-graph-uri=nothing", "", b"", 400),
        ("GET", "update=CLEAR+ALL", "", b"", 403),
        ("POST", "", FORM, b"update=CLEAR+ALL", 403),
        ("POST", "", "application/sparql-update", b"CLEAR ALL", 403),
        ("POST", "", "text/plain", b"ASK {}", 415),
        ("POST", "", "", b"ASK {}", 415),
        ("POST", "", f"{DIRECT}; charset=UTF-16", b"ASK {}", 415),
        ("POST", "", DIRECT, b"\xff", 400),
    ],
)
def test_anything_else_is_refused(method: str, parameters: str, kind: str, body: bytes, status: int) -> None:
    with pytest.raises(RequestRefusedError) as refused:
        query_request(method, parameters, kind, body)
    assert refused.value.status == status
