"""The ontologies as one page of HTML, `docs/ontology.html`, with an anchor for every term."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from html import escape

from rdflib import DCTERMS, OWL, RDF, RDFS, SKOS, BNode, Graph, Literal, Namespace, URIRef
from rdflib.collection import Collection
from rdflib.term import Node

from selfconf import library

VANN = Namespace("http://purl.org/vocab/vann/")
ROB = Namespace("https://w3id.org/selfconf/robotics#")
KINDS = {
    OWL.Class: "Classes",
    OWL.ObjectProperty: "Object properties",
    OWL.DatatypeProperty: "Datatype properties",
    RDF.Property: "Other properties",
}
RELATIONS = {
    RDFS.subClassOf: "below",
    RDFS.subPropertyOf: "below",
    OWL.disjointWith: "disjoint with",
    RDFS.domain: "of",
    RDFS.range: "takes",
    SKOS.closeMatch: "close to",
    SKOS.relatedMatch: "related to",
}
PREFIXES = {
    "sc": "https://w3id.org/selfconf#",
    "rob": str(ROB),
    "home": "https://w3id.org/selfconf/peis-home#",
    "ros2": "https://w3id.org/selfconf/ros2#",
    "sosa": "http://www.w3.org/ns/sosa/",
    "ssn": "http://www.w3.org/ns/ssn/",
    "prov": "http://www.w3.org/ns/prov#",
    "td": "https://www.w3.org/2019/wot/td#",
    "cora": "http://purl.org/ieee1872-owl/cora-bare#",
    "service11": "http://www.daml.org/services/owl-s/1.1/Service.owl#",
    "service12": "http://www.daml.org/services/owl-s/1.2/Service.owl#",
    "profile11": "http://www.daml.org/services/owl-s/1.1/Profile.owl#",
    "profile12": "http://www.daml.org/services/owl-s/1.2/Profile.owl#",
    "process11": "http://www.daml.org/services/owl-s/1.1/Process.owl#",
    "process12": "http://www.daml.org/services/owl-s/1.2/Process.owl#",
    "sh": "http://www.w3.org/ns/shacl#",
    "rdf": str(RDF),
    "rdfs": str(RDFS),
    "xsd": "http://www.w3.org/2001/XMLSchema#",
    "unit": "http://qudt.org/vocab/unit/",
}
ON_THE_PAGE = tuple(f"{prefix}:" for prefix, base in PREFIXES.items() if base.startswith(PREFIXES["sc"][:-1]))
"""The prefixes of the terms that have an article on the page."""
STYLE = """
:root { color-scheme: light dark; --ink: #1c2430; --soft: #5b6675; --paper: #fbfaf7; --card: #fff; --line: #e2dfd8;
  --mark: #b4541a; --link: #1f5f99; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e3dc; --soft: #9aa3af; --paper: #14171c; --card: #1b2027;
  --line: #2d343e; --mark: #f0a35e; --link: #7db8ec; } }
* { box-sizing: border-box; }
html { scroll-behavior: smooth; scroll-padding-top: 1rem; }
body { margin: 0; background: var(--paper); color: var(--ink); font: 16px/1.55 system-ui, sans-serif; display: grid;
  grid-template-columns: 17rem minmax(0, 1fr); }
nav { position: sticky; top: 0; height: 100vh; overflow-y: auto; padding: 1.5rem; border-right: 1px solid var(--line);
  font-size: .86rem; }
nav h2 { margin: 1.4rem 0 .3rem; font-size: .92rem; } nav h2:first-child { margin-top: 0; }
nav h3 { margin: .7rem 0 .1rem; font-size: .72rem; letter-spacing: .06em; text-transform: uppercase;
  color: var(--soft); }
nav ul { list-style: none; margin: 0; padding: 0; }
main { padding: 2.5rem clamp(1rem, 5vw, 4rem) 6rem; max-width: 62rem; }
h1 { font-size: 2rem; line-height: 1.2; margin: 0 0 .5rem; }
section > h2 { margin: 4rem 0 .4rem; padding-top: 1rem; border-top: 3px solid var(--mark); font-size: 1.5rem; }
section > h3 { margin: 2.2rem 0 .6rem; font-size: .8rem; letter-spacing: .08em; text-transform: uppercase;
  color: var(--soft); }
a { color: var(--link); text-decoration: none; } a:hover { text-decoration: underline; }
code, pre { font: .86em/1.5 ui-monospace, "DejaVu Sans Mono", monospace; }
pre { margin: .6rem 0 0; padding: .6rem .8rem; overflow-x: auto; background: var(--paper); border-radius: 6px;
  border: 1px solid var(--line); }
article { margin: .7rem 0; padding: .9rem 1.1rem; background: var(--card); border: 1px solid var(--line);
  border-radius: 10px; }
article:target { border-color: var(--mark); box-shadow: 0 0 0 1px var(--mark); }
article h4 { margin: 0; font-size: 1.02rem; } article h4 a { color: inherit; }
article h4 small { font-weight: 400; color: var(--soft); margin-left: .5rem; }
article p { margin: .25rem 0 0; } article p.note { color: var(--soft); font-size: .92rem; }
dl { display: grid; grid-template-columns: 7rem 1fr; gap: .1rem .8rem; margin: .5rem 0 0; font-size: .9rem; }
dt { color: var(--soft); } dd { margin: 0; }
table { border-collapse: collapse; margin-top: .6rem; font-size: .9rem; }
td, th { text-align: left; padding: .15rem 1.2rem .15rem 0; border-bottom: 1px solid var(--line); font-weight: 400; }
th { color: var(--soft); } .meta { color: var(--soft); }
@media (max-width: 56rem) { body { display: block; } nav { position: static; height: auto; border: 0; } }
"""


def page() -> str:
    """The page."""
    everything = Graph()
    parts = []
    for path in library.ontologies():
        graph = Graph().parse(path)
        everything += graph
        ontology = next(iter(graph.subjects(RDF.type, OWL.Ontology)))
        if graph.value(ontology, VANN.preferredNamespacePrefix) is not None:
            parts.append((ontology, graph))
    parts.sort(key=lambda part: list(PREFIXES).index(str(part[1].value(part[0], VANN.preferredNamespacePrefix))))
    writer = _Writer(everything)
    menu = "\n".join(line for ontology, graph in parts for line in writer.menu(ontology, graph))
    body = "\n".join(line for ontology, graph in parts for line in writer.section(ontology, graph))
    return f"""<!DOCTYPE html>
<!-- Made by `python -m docs.generate`; edit the ontologies instead. -->
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>The selfconf ontologies</title>
<style>{STYLE}</style>
</head>
<body>
<nav>
{menu}
</nav>
<main>
<h1>The selfconf ontologies</h1>
<p class="meta">Every class and property, with its definition. The shapes that say what conforms are in
<a href="../shapes/"><code>shapes/</code></a>; relations to other vocabularies, which are in
<a href="../ontology/alignments.ttl"><code>alignments.ttl</code></a>, stand beside the terms.</p>
{body}
</main>
</body>
</html>
"""


class _Writer:
    """Writes terms; the graph of all ontologies tells what relates to what."""

    def __init__(self, graph: Graph) -> None:
        self.graph = graph

    def menu(self, ontology: Node, graph: Graph) -> Iterator[str]:
        prefix = graph.value(ontology, VANN.preferredNamespacePrefix)
        yield f'<h2><a href="#{prefix}">{prefix}:</a></h2>'
        for title, terms in self._groups(graph, str(prefix)):
            links = "".join(f"<li>{self.link(term)}</li>" for term in terms)
            yield f"<h3>{title}</h3><ul>{links}</ul>"

    def section(self, ontology: Node, graph: Graph) -> Iterator[str]:
        prefix = str(graph.value(ontology, VANN.preferredNamespacePrefix))
        title, version = graph.value(ontology, DCTERMS.title), graph.value(ontology, OWL.versionInfo)
        yield f'<section><h2 id="{prefix}">{escape(str(title))}</h2>'
        description = graph.value(ontology, DCTERMS.description)
        if description is not None:
            yield f"<p>{escape(' '.join(str(description).split()))}</p>"
        licence = escape(str(graph.value(ontology, DCTERMS.license)))
        yield f'<p class="meta">Version {version} · <a href="{licence}">Apache-2.0</a></p>'
        yield f"<pre>@prefix {prefix}: &lt;{escape(PREFIXES[prefix])}&gt; .</pre>"
        for name, terms in self._groups(graph, prefix):
            yield f"<h3>{name}</h3>"
            for term in terms:
                yield from self.article(term)
        yield "</section>"

    def _groups(self, graph: Graph, prefix: str) -> Iterator[tuple[str, list[URIRef]]]:
        for kind, title in KINDS.items():
            found = {term for term in graph.subjects(RDF.type, kind) if isinstance(term, URIRef)}
            terms = sorted(term for term in found if term.startswith(PREFIXES[prefix]))
            if terms:
                yield title, terms

    def article(self, term: URIRef) -> Iterator[str]:
        label = escape(str(self.graph.value(term, RDFS.label) or ""))
        anchor, name = anchor_of(term), short(term)
        yield f'<article id="{anchor}"><h4><a href="#{anchor}"><code>{name}</code></a><small>{label}</small></h4>'
        yield f"<p>{escape(' '.join(str(self.graph.value(term, SKOS.definition)).split()))}</p>"
        for note in sorted(self.graph.objects(term, SKOS.scopeNote)):
            yield f'<p class="note">{escape(str(note))}</p>'
        lines = [
            (word, self.links(self.graph.objects(term, relation)))
            for relation, word in RELATIONS.items()
            if any(True for _ in self.graph.objects(term, relation))
        ]
        for inverse, word in ((RDFS.subClassOf, "above"), (RDFS.subPropertyOf, "above"), (RDFS.domain, "has")):
            found = [other for other in self.graph.subjects(inverse, term) if isinstance(other, URIRef)]
            if found:
                lines.append((word, self.links(found)))
        if lines:
            yield "<dl>" + "".join(f"<dt>{word}</dt><dd>{links}</dd>" for word, links in lines) + "</dl>"
        fields = self.graph.value(term, ROB.field)
        if fields is not None:
            yield self.fields(fields)
        for example in sorted(self.graph.objects(term, SKOS.example)):
            yield f"<pre>{escape(str(example))}</pre>"
        yield "</article>"

    def links(self, terms: Iterable[Node]) -> str:
        return ", ".join(self.link(term) for term in sorted(term for term in terms if not isinstance(term, BNode)))

    def link(self, term: Node) -> str:
        if isinstance(term, Literal):
            return escape(str(term))
        target = f"#{anchor_of(term)}" if short(term).startswith(ON_THE_PAGE) else escape(str(term))
        return f'<a href="{target}"><code>{escape(short(term))}</code></a>'

    def fields(self, head: Node) -> str:
        rows = []
        for field in Collection(self.graph, head):
            name, kind, unit = (self.graph.value(field, ROB[word]) for word in ("fieldName", "datatype", "unit"))
            many = " (repeated)" if self.graph.value(field, ROB.repeated) is not None else ""
            unit_name = short(unit).removeprefix("unit:") if unit is not None else ""
            rows.append(f"<tr><td><code>{name}</code></td><td>{short(kind)}{many}</td><td>{unit_name}</td></tr>")
        return f"<table><tr><th>field</th><th>datatype</th><th>unit</th></tr>{''.join(rows)}</table>"


def short(term: Node | None) -> str:
    """A term by prefix and name."""
    text = str(term)
    for prefix, base in PREFIXES.items():
        if text.startswith(base) and re.fullmatch(r"[\w-]+", text[len(base) :]):
            return f"{prefix}:{text[len(base) :]}"
    return f"<{text}>"


def anchor_of(term: Node) -> str:
    """The anchor of one of our terms."""
    return short(term).replace(":", "-")
