"""What the endpoint offers, in RDF: SPARQL 1.1 Service Description."""

from __future__ import annotations

import pyoxigraph as ox

from selfconf.query import RESULT_TYPES, TRIPLE_TYPES

SD = "http://www.w3.org/ns/sparql-service-description#"
_FORMATS = "http://www.w3.org/ns/formats/"
_RESULT_NAMES = ("SPARQL_Results_JSON", "SPARQL_Results_XML", "SPARQL_Results_CSV", "SPARQL_Results_TSV")
_TRIPLE_NAMES = ("Turtle", "N-Triples", "RDF_XML", "JSON-LD")


def service_description(endpoint: str, media: str) -> bytes:
    """The description of the endpoint at a URL, in one of the media types of triples."""
    service, dataset, default = ox.NamedNode(endpoint), ox.BlankNode("dataset"), ox.BlankNode("default")
    kind = ox.NamedNode("http://www.w3.org/1999/02/22-rdf-syntax-ns#type")

    def sd(name: str) -> ox.NamedNode:
        return ox.NamedNode(SD + name)

    formats = dict(zip((*RESULT_TYPES, *TRIPLE_TYPES), (*_RESULT_NAMES, *_TRIPLE_NAMES), strict=True))
    triples = [
        ox.Triple(service, kind, sd("Service")),
        ox.Triple(service, sd("endpoint"), service),
        ox.Triple(service, sd("supportedLanguage"), sd("SPARQL11Query")),
        ox.Triple(service, sd("feature"), sd("UnionDefaultGraph")),
        ox.Triple(service, sd("defaultDataset"), dataset),
        ox.Triple(dataset, kind, sd("Dataset")),
        ox.Triple(dataset, sd("defaultGraph"), default),
        ox.Triple(default, kind, sd("Graph")),
        *(ox.Triple(service, sd("resultFormat"), ox.NamedNode(_FORMATS + name)) for name in formats.values()),
    ]
    return ox.serialize(triples, format=TRIPLE_TYPES[media], prefixes={"sd": SD}) or b""
