"""The W3C test cases of SPARQL 1.1 Protocol and Service Description, replayed against the endpoint.

Each request of a case is sent as the manifest words it. Of a case that begins with a good update only
that is sent: this endpoint cannot be written, and the update has to be refused.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from rdflib import Graph, URIRef
from rdflib.collection import Collection
from starlette.types import ASGIApp

from selfconf.query import RESULT_TYPES, TRIPLE_TYPES, StandingDataset
from selfconf.rdf.turtle import parse
from selfconf.serve.board import Board
from selfconf.serve.sparql.service_description import SD
from tests.serve.asgi import Answer, ask, served

BESIDE = Path(__file__).parents[3] / "shared" / "data" / "w3c-sparql-protocol"
SUITE = Path(os.environ.get("SELFCONF_W3C_PROTOCOL", BESIDE))
pytestmark = [
    pytest.mark.w3c,
    pytest.mark.process,
    pytest.mark.skipif(
        not SUITE.is_dir(), reason="the W3C protocol tests are not here; SELFCONF_W3C_PROTOCOL names them"
    ),
]
MF = "http://www.w3.org/2001/sw/DataAccess/tests/test-manifest#"
HT = "http://www.w3.org/2011/http#"
CNT = "http://www.w3.org/2011/content#"
DATA = "http://kasei.us/2009/09/sparql/data/"
FORMATS = {"boolean": RESULT_TYPES, "tabular": RESULT_TYPES, "RDF": TRIPLE_TYPES}


def manifest() -> Graph:
    """The manifest of the protocol cases; empty where it is absent."""
    graph = Graph()
    return graph.parse(SUITE / "manifest.ttl") if SUITE.is_dir() else graph


MANIFEST = manifest()


def cases() -> Iterator[str]:
    """The name of each case."""
    for entries in MANIFEST.objects(None, URIRef(MF + "entries")):
        for case in Collection(MANIFEST, entries):
            yield str(case)


def value(node: Any, term: str) -> Any:
    """The one value of a property, as a string, or None."""
    return MANIFEST.value(node, URIRef(term))


def sent(app: ASGIApp, request: Any) -> Answer:
    """The answer to a request of the manifest."""
    path = str(value(request, HT + "absolutePath"))
    headers = {}
    listed = value(request, HT + "headers")
    for header in Collection(MANIFEST, listed) if listed is not None else ():
        headers[str(value(header, HT + "fieldName"))] = str(value(header, HT + "fieldValue"))
    content = value(request, HT + "body")
    body = b""
    if content is not None:
        body = str(value(content, CNT + "chars")).encode(str(value(content, CNT + "characterEncoding")))
    method = str(value(request, HT + "methodName"))
    return ask(app, path, method, body, **{name.replace("-", "_"): text for name, text in headers.items()})


@pytest.fixture(scope="module")
def store() -> Iterator[StandingDataset]:
    dataset = StandingDataset()
    for number in (1, 2, 3):
        dataset.replace(f"{DATA}data{number}.rdf", (SUITE / f"data{number}.nt").read_bytes())
    yield dataset
    dataset.close()


@pytest.fixture
def app(board: Board, store: StandingDataset) -> ASGIApp:
    return served(board, store, 10.0)


@pytest.mark.parametrize("case", list(cases()), ids=lambda case: case.partition("#")[2])
def test_a_case_is_answered_as_the_w3c_expects(app: ASGIApp, case: str) -> None:
    action = value(URIRef(case), MF + "action")
    requests = list(Collection(MANIFEST, value(action, HT + "requests")))
    if "#update_" in case:
        assert sent(app, requests[0]).status == 403
        return
    for request in requests:
        answer, expected = sent(app, request), value(request, HT + "resp")
        allowed = {str(status)[-3] for status in MANIFEST.objects(expected, URIRef(MF + "expectedStatus"))}
        assert str(answer.status)[0] in allowed, answer.body
        form, truth = value(expected, MF + "expectedFormat"), value(expected, MF + "expectedBoolean")
        if form is not None:
            assert answer.media in FORMATS[str(form)]
        if truth is not None:
            assert answer.json["boolean"] is truth.toPython()


def test_the_service_description_is_rdf_with_a_matching_endpoint(app: ASGIApp) -> None:
    answer = ask(app, "/sparql")
    assert answer.media == "text/turtle"
    document = parse(answer.body, "description")
    (service,) = (str(s) for s, p, o in document.triples() if str(o) == SD + "Service")
    assert service == "http://localhost:8000/sparql"
    assert [str(o) for s, p, o in document.triples() if str(p) == SD + "endpoint"] == [service]
