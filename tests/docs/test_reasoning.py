"""`docs/reasoning.md` tells the truth: every cell of its table is tried."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from selfconf import entailment
from selfconf.composition.composer import Composer
from selfconf.composition.searches import Strategy
from selfconf.model.configuration import Configuration
from selfconf.model.hierarchy import Hierarchy, Reasoning
from selfconf.rdf.advertisements import reader as advertisements
from selfconf.rdf.reasoning.closure import hierarchy
from selfconf.rdf.tasks import bindings, templates
from selfconf.rdf.turtle import document as turtle

PAGE = (Path(__file__).parents[2] / "docs" / "reasoning.md").read_text()
PREFIXES = """\
@prefix : <https://example.org/home#> .
@prefix sc: <https://w3id.org/selfconf#> .
@prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
@prefix sh: <http://www.w3.org/ns/shacl#> .
"""
ONTOLOGY = """
:Sensor rdfs:subClassOf :Thing . :Thermometer rdfs:subClassOf :Sensor , :Device .
:Detector owl:equivalentClass :Sensor . :Lamp rdfs:subClassOf :Furniture .
:sensor rdfs:subPropertyOf :thing . :thermometer rdfs:subPropertyOf :sensor , :device .
:detector owl:equivalentProperty :sensor . :lamp rdfs:subPropertyOf :furniture .
:Measuring owl:unionOf ( :Thermometer :Sensor ) .
"""
OFFERED = {
    "exact": "Sensor",
    "equivalent": "Detector",
    "plug-in": "Thermometer",
    "subsumes": "Thing",
    "overlap": "Device",
    "disjoint": "Lamp",
}
ONE = ":t a sc:Template ; sc:roles ( :a ) . :a a sc:Role ; "
TWO = """:t a sc:Template ; sc:roles ( :a :b ) .
:b a sc:Role ; sh:class :Sink . :a a sc:Role ; sh:class :Source ; sc:feeds :b ."""
SITUATIONS = {
    "component type": (ONE + "sh:class :Sensor .", ":c a sc:Component, :{O} ."),
    "signal": (
        TWO,
        """:c a sc:Component, :Source ; sc:hasOutput [ sc:name "o" ; sc:signalType :{O} ] .
        :d a sc:Component, :Sink ; sc:hasInput [ sc:name "i" ; sc:signalType :Sensor ] .""",
    ),
    "property type": (
        ONE + "sh:class :Kind ; sh:property [ sh:path :sensor ; sh:in ( :x ) ; sh:minCount 1 ] .",
        ":c a sc:Component, :Kind ; :{o} :x .",
    ),
    "parameter type": (
        ONE + 'sh:class :Kind ; sc:sets [ sc:parameterType :{O} ; sc:value "x" ] .',
        ':c a sc:Component, :Kind ; sc:hasParameter [ sc:name "p" ; sc:parameterType :Sensor ] .',
    ),
}


def rows() -> list[tuple[str, Reasoning, str, bool]]:
    """Every cell of the table: situation, mode, relation, and whether it is accepted."""
    lines = [[cell.strip() for cell in line.strip("|").split("|")] for line in PAGE.splitlines() if line[:1] == "|"]
    head = next(line for line in lines if line[1:3] == ["exact", "equivalent"])
    found = []
    for line in lines:
        match = re.fullmatch(r"(.+), (syntactic|subclass|owl-rl)", line[0])
        if match:
            cells = zip(head[1:], line[1:], strict=True)
            found += [(match[1], Reasoning(match[2]), relation, cell == "yes") for relation, cell in cells]
    return found


@pytest.fixture(scope="module")
def hierarchies(tmp_path_factory: pytest.TempPathFactory) -> dict[Reasoning, Hierarchy]:
    document = turtle.parse(PREFIXES + ONTOLOGY, "o.ttl")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SELFCONF_CACHE_DIR", str(tmp_path_factory.mktemp("cache")))
        return {mode: hierarchy([document], mode, entailment.entailed_hierarchy) for mode in Reasoning}


def configured(template: str, ads: str, above: Hierarchy) -> bool:
    """Whether there is a configuration."""
    task = bindings.complete(templates.read_task(turtle.parse(PREFIXES + template, "t.ttl")))
    found, malformed = advertisements.read_document(turtle.parse(PREFIXES + ads, "a.ttl"))
    assert not malformed
    ecology = {one.component: one for one in found}
    outcome = Composer(task, above, Strategy.FIRST).compose(ecology, frozenset(), None)
    return isinstance(outcome, Configuration)


@pytest.mark.parametrize(("situation", "mode", "relation", "accepted"), rows())
def test_a_cell_of_the_table_is_true(
    situation: str, mode: Reasoning, relation: str, accepted: bool, hierarchies: dict[Reasoning, Hierarchy]
) -> None:
    offered = OFFERED[relation]
    template, ads = (
        text.replace("{O}", offered).replace("{o}", offered[0].lower() + offered[1:]) for text in SITUATIONS[situation]
    )
    assert configured(template, ads, hierarchies[mode]) is accepted


def test_the_table_covers_every_situation_mode_and_relation() -> None:
    cells = {(situation, mode, relation) for situation, mode, relation, _ in rows()}
    assert len(cells) == len(rows()) == len(SITUATIONS) * len(Reasoning) * len(OFFERED)


def test_owl_rl_finds_a_union_and_subclass_does_not(hierarchies: dict[Reasoning, Hierarchy]) -> None:
    template, ads = ONE + "sh:class :Measuring .", ":c a sc:Component, :Thermometer ."
    assert [configured(template, ads, hierarchies[mode]) for mode in Reasoning] == [False, False, True]


def test_the_page_names_the_examples_that_are_tried() -> None:
    for offered in OFFERED.values():
        assert f"`:{offered}`" in PAGE
