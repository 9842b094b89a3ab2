"""Property paths over the statements of an advertisement, held against rdflib's, which pySHACL walks."""

from __future__ import annotations

import rdflib
from hypothesis import given, settings
from hypothesis import strategies as st
from pyshacl.shape import Shape
from pyshacl.shapes_graph import ShapesGraph

from selfconf.model.term import IRI
from selfconf.rdf.eligibility.node_paths import WalkedStatements
from selfconf.rdf.rdflib_terms import from_rdflib, to_rdflib
from selfconf.rdf.turtle import parse
from selfconf.rdf.vocabulary import SH
from tests.harness.effort import examples

PREFIXES = "@prefix sh: <http://www.w3.org/ns/shacl#> . @prefix : <urn:t:> .\n"
NODES, LINKS = [f":n{k}" for k in range(4)], [":p", ":q"]
PATHS = st.recursive(
    st.sampled_from(LINKS),
    lambda inner: st.one_of(
        inner.map("[ sh:inversePath {} ]".format),
        inner.map("[ sh:zeroOrMorePath {} ]".format),
        inner.map("[ sh:oneOrMorePath {} ]".format),
        inner.map("[ sh:zeroOrOnePath {} ]".format),
        st.lists(inner, min_size=2, max_size=3).map(lambda some: f"( {' '.join(some)} )"),
        st.lists(inner, min_size=2, max_size=3).map(lambda some: f"[ sh:alternativePath ( {' '.join(some)} ) ]"),
    ),
    max_leaves=5,
)


@settings(max_examples=examples(300), deadline=None)
@given(st.lists(st.tuples(*map(st.sampled_from, (NODES, LINKS, NODES))), max_size=8), PATHS)
def test_a_path_leads_where_pyshacl_says_that_it_leads(triples: list[tuple[str, str, str]], path: str) -> None:
    data = parse(PREFIXES + "".join(f"{' '.join(triple)} .\n" for triple in triples), "data")
    shape = parse(f"{PREFIXES}:shape a sh:PropertyShape ; sh:path {path} .", "shape")
    found = WalkedStatements(data.triples()).walked(shape, shape.values(IRI("urn:t:shape"), SH.path)[0], start())
    shapes = ShapesGraph(to_rdflib(shape.triples()))
    judged = Shape(shapes, rdflib.URIRef("urn:t:shape"), p=True, path=path_of(shapes))
    values = judged.value_nodes(to_rdflib(data.triples()), [rdflib.URIRef(start())])[rdflib.URIRef(start())]
    assert set(found) == set(map(from_rdflib, values))
    assert len(found) == len(set(found))


def start() -> IRI:
    """The node where each path begins."""
    return IRI("urn:t:n0")


def path_of(shapes: ShapesGraph) -> rdflib.term.Node:
    """The path of the only shape."""
    return shapes.graph.value(rdflib.URIRef("urn:t:shape"), rdflib.URIRef(SH.path))
