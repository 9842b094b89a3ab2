"""The service description says where the endpoint is and what it does."""

from __future__ import annotations

from selfconf.rdf.turtle import parse
from selfconf.serve.sparql.service_description import SD, service_description


def test_the_description_names_its_endpoint_and_its_formats() -> None:
    text = service_description("http://localhost:8000/sparql", "text/turtle")
    document = parse(text, "description")
    found = {(str(s), str(p)[len(SD) :], str(o)) for s, p, o in document.triples() if str(p).startswith(SD)}
    service = "http://localhost:8000/sparql"
    assert (service, "endpoint", service) in found
    assert (service, "supportedLanguage", SD + "SPARQL11Query") in found
    assert sum(p == "resultFormat" for _, p, _ in found) == 8
