"""The ontologies as a publication: what was released stays, alignments disturb nothing, the page has every term."""

from __future__ import annotations

import copy
import json
import re
from pathlib import Path

import pytest
from rdflib import DCTERMS, OWL, PROV, RDF, RDFS, SKOS, SOSA, SSN, Graph, URIRef
from rdflib.namespace import DefinedNamespace

from docs import ontology, released
from selfconf import library
from selfconf.entailment import entailed_hierarchy
from selfconf.model.hierarchy import Hierarchy, Reasoning
from selfconf.model.term import IRI
from selfconf.rdf.reasoning.closure import HIERARCHY, hierarchy
from selfconf.rdf.turtle import document as turtle
from tests.shipped import ontology_graphs

OURS = "https://w3id.org/selfconf"
GRAPHS = ontology_graphs()
APACHE = URIRef("https://www.apache.org/licenses/LICENSE-2.0")
PROCESS = {"Input", "Output", "Parameter", "CompositeProcess", "hasInput", "hasOutput", "parameterType"}
OWL_S = "http://www.daml.org/services/owl-s/"
THEIRS = {
    "http://www.w3.org/ns/sosa/": {"Sensor", "Actuator", "Platform", "isHostedBy"},
    "http://www.w3.org/ns/ssn/": {"System", "Input", "Output"},
    "http://www.w3.org/ns/prov#": {"Plan"},
    "https://www.w3.org/2019/wot/td#": {
        "Thing", "InteractionAffordance", "PropertyAffordance", "ActionAffordance", "EventAffordance", "name",
    },
    "http://purl.org/ieee1872-owl/cora-bare#": {"Robot"},
    **{
        f"{OWL_S}{version}/{file}.owl#": terms
        for version, process in (("1.1", PROCESS), ("1.2", PROCESS | {"Binding"}))
        for file, terms in {
            "Service": {"Service", "ServiceGrounding"},
            "Profile": {"hasInput", "hasOutput"},
            "Process": process,
        }.items()
    },
}  # fmt: skip
"""The terms of other vocabularies, copied by hand from the documents that define them."""
DISJOINT = [{PROV.Entity, PROV.Activity}, {PROV.Entity, PROV.InstantaneousEvent}, {PROV.Agent, PROV.InstantaneousEvent}]
"""What PROV-O says that nothing is both of, as far as it matters here; SOSA and SSN say no such thing."""


def test_no_released_term_is_removed_or_redefined() -> None:
    assert not released.changes(json.loads(released.RELEASED.read_text()), released.terms())


def test_a_removed_and_a_redefined_term_are_noticed() -> None:
    before, now = released.terms(), copy.deepcopy(released.terms())
    now.pop(f"{OURS}#Role")
    now[f"{OURS}#Component"]["definition"] = ["Anything."]
    now[f"{OURS}#New"] = {}
    removed, redefined = sorted(released.changes(before, now), key=lambda change: "removed" not in change)
    assert f"{OURS}#Role has been removed" in removed
    assert f"the definition of {OURS}#Component" in redefined


@pytest.mark.parametrize("stem", GRAPHS)
def test_every_ontology_has_a_version_a_creator_and_one_licence(stem: str) -> None:
    graph = GRAPHS[stem]
    (header,) = graph.subjects(RDF.type, OWL.Ontology)
    assert list(graph.objects(header, DCTERMS.license)) == [APACHE]
    for predicate in (OWL.versionIRI, OWL.versionInfo, DCTERMS.title, DCTERMS.creator):
        assert graph.value(header, predicate) is not None


def test_alignments_import_nothing_and_lead_from_our_terms_to_terms_there_are() -> None:
    graph = GRAPHS["alignments"]
    assert not list(graph.subject_objects(OWL.imports))
    declared = set(map(URIRef, released.terms()))
    for subject, predicate, value in graph:
        if (subject, RDF.type, OWL.Ontology) in graph:
            continue
        assert subject in declared, subject
        assert str(predicate) in (*HIERARCHY[::2], str(SKOS.closeMatch), str(SKOS.relatedMatch))
        base = str(value)[: max(str(value).rfind("#"), str(value).rfind("/")) + 1]
        assert str(value)[len(base) :] in THEIRS[base], value


@pytest.mark.parametrize("namespace", [SOSA, SSN, PROV])
def test_what_rdflib_knows_of_other_vocabularies_has_every_term(namespace: type[DefinedNamespace]) -> None:
    terms = THEIRS[str(namespace)]
    assert terms
    assert all(term in namespace for term in terms)
    assert "Nonsense" not in namespace


def test_no_class_of_ours_lies_below_two_that_share_nothing() -> None:
    known = sum(GRAPHS.values(), Graph()) + Graph().parse(data=f"<{PROV.Plan}> <{RDFS.subClassOf}> <{PROV.Entity}> .")
    for term in set(known.subjects(RDFS.subClassOf)):
        above = set(known.transitive_objects(term, RDFS.subClassOf))
        assert not [pair for pair in DISJOINT if pair <= above], term


@pytest.mark.parametrize("mode", [Reasoning.SUBCLASS, Reasoning.OWL_RL])
def test_alignments_change_nothing_among_our_own_terms(mode: Reasoning) -> None:
    documents = {path.stem: turtle.parse(path.read_bytes(), path.name, "urn:x:") for path in library.ontologies()}
    others = [document for stem, document in documents.items() if stem != "alignments"]
    within = hierarchy(list(documents.values()), mode, entailed_hierarchy)
    without = hierarchy(others, mode, entailed_hierarchy)

    def ours(given: Hierarchy, term: IRI) -> tuple[set[IRI], set[IRI]]:
        return (
            {above for above in given.superclasses(term) if above.startswith(OURS)},
            {above for above in given.superproperties(term) if above.startswith(OURS)},
        )

    terms = [IRI(term) for term in released.terms()]
    assert len(terms) > 100
    assert [ours(within, term) for term in terms] == [ours(without, term) for term in terms]
    assert within.matches(IRI(f"{OURS}/robotics#Thermometer"), IRI("http://www.w3.org/ns/sosa/Sensor"))


def test_the_page_has_an_anchor_for_every_term_and_no_link_leads_nowhere() -> None:
    page = ontology.page()
    anchors = re.findall(r'id="([^"]+)"', page)
    assert len(anchors) == len(set(anchors))
    assert {ontology.anchor_of(URIRef(term)) for term in released.terms()} <= set(anchors)
    assert set(re.findall(r'href="#([^"]+)"', page)) <= set(anchors)
    leading_away = {link for link in re.findall(r'href="([^#"]+#[^"]+)"', page) if link.startswith(OURS)}
    assert leading_away == set(), "a term that has its place on the page"
    root = Path(released.__file__).parents[1]
    assert all((root / link).exists() for link in re.findall(r'href="\.\./([^"]+)"', page))


def test_the_page_loads_nothing_from_elsewhere() -> None:
    assert not re.search(r"<(script|img|link|iframe)|@import|url\(", ontology.page())
