"""The terms of the last release, so that none is removed or redefined unnoticed: `ontology/released.json`.

`python -m docs.released` writes the file, and is run when a version is released. Until then a test compares: a term
may come, and may get more words; none may go, nor change its kind, its place in the hierarchy or its definition.
"""

from __future__ import annotations

import json
from pathlib import Path

from rdflib import OWL, RDF, RDFS, SKOS, BNode, Graph, URIRef

from docs.ontology import KINDS
from selfconf import library

RELEASED = Path(__file__).parent.parent / "ontology" / "released.json"
MEANING = {
    "kind": RDF.type,
    "below": RDFS.subClassOf,
    "subproperty of": RDFS.subPropertyOf,
    "domain": RDFS.domain,
    "range": RDFS.range,
    "disjoint with": OWL.disjointWith,
    "definition": SKOS.definition,
}
"""What a term may not change once it is released."""
Terms = dict[str, dict[str, list[str]]]


def terms() -> Terms:
    """Every term that an ontology of selfconf defines, with what gives it its meaning."""
    found: Terms = {}
    for path in library.ontologies():
        graph = Graph().parse(path)
        for term in sorted({term for kind in KINDS for term in graph.subjects(RDF.type, kind)}):
            if isinstance(term, URIRef):
                found[str(term)] = {
                    name: values
                    for name, predicate in MEANING.items()
                    if (values := sorted(str(o) for o in graph.objects(term, predicate) if not isinstance(o, BNode)))
                }
    return found


def changes(before: Terms, now: Terms) -> list[str]:
    """What has been removed or redefined, a sentence each."""
    found = []
    for term, meaning in before.items():
        if term not in now:
            found.append(f"{term} has been removed; keep it, with owl:deprecated true.")
            continue
        for name in MEANING:
            if meaning.get(name) != now[term].get(name):
                found.append(f"the {name} of {term} has changed from {meaning.get(name)} to {now[term].get(name)}.")
    return found


if __name__ == "__main__":
    RELEASED.write_text(json.dumps(terms(), indent=1, ensure_ascii=False, sort_keys=True) + "\n", encoding="utf-8")
