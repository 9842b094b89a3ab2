"""Lints about terms: misspelt ones, and classes and properties in the place of each other."""

from __future__ import annotations

import pytest

from selfconf.model.codes import PREAMBLE
from selfconf.model.diagnostic import Severity
from selfconf.rdf.validation.checking import SourceText, validate_texts
from tests.rdf.validation.lints.linted_text import COSTED, ONTOLOGIES, SHAPES, TEMPLATE, lints, only


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        (":a a sc:Compnent, sc:Component, rob:Tuner .", "sc:Component"),
        (":a a sc:Component, rob:Tuner ; sc:preferance 1 .", "sc:preference"),
        (":a a sc:Component, rob:Tuner ; sc:Preference 1 .", "sc:preference"),
        (TEMPLATE + ":r sh:property [ sh:path rob:place ; sh:minCnt 1 ] .", "sh:minCount"),
        (TEMPLATE + ":r sh:targetClas rob:Lamp .", "sh:targetClass"),
        (TEMPLATE + ":r sh:nodeKind sh:IR .", "sh:IRI"),
        (TEMPLATE + ":r sc:feedss :r .", "sc:feeds"),
        (TEMPLATE + ":r sh:clas rob:Lamp .", "sh:class"),
        (TEMPLATE + ":r sh:Class rob:Lamp .", "sh:class"),
        (TEMPLATE + ":r sh:orr ( [] ) .", "sh:or"),
    ],
)
def test_a_misspelt_term_of_selfconf_or_shacl_is_an_error(text: str, meant: str) -> None:
    found = [each for each in lints(text) if each.code == "SC-L01"]
    assert [each.hint for each in found] == [f"Did you mean {meant}?"]
    assert found[0].severity is Severity.ERROR


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        (":a a sc:Component, rob:Tunr .", "rob:Tuner"),
        (":a a sc:Component, rob:Tuner ; rob:plcae :x .", "rob:place"),
        (":a a sc:Component, rob:Tuner ; rdfs:lable 'x' .", "rdfs:label"),
        (":a a sc:Component, rob:Tuner ; :weight '5'^^xsd:integr .", "xsd:integer"),
        (TEMPLATE.replace("rob:Lamp", "rob:Lmap"), "rob:Lamp"),
        (TEMPLATE + ":r sh:property [ sh:path rob:palce ; sh:minCount 1 ] .", "rob:place"),
        (TEMPLATE + ":r sh:property [ sh:path rob:place ; sh:disjoint rob:palce ] .", "rob:place"),
        (":a a sc:Component, :A ; sc:hasOperation [ sc:name 'x' ; sc:request rob:Imge ] .", "rob:Image"),
        (":a a sc:Component, :A ; sc:hasOperation [ sc:name 'x' ; sc:response rob:Imge ] .", "rob:Image"),
        (":A a owl:Class ; rdfs:label 'a' ; owl:equivalentClass rob:Lmap .", "rob:Lamp"),
        (
            TEMPLATE + ":r sh:sparql [ sh:select 'PREFIX r: <https://w3id.org/selfconf/robotics#> "
            "SELECT $this { $this r:palce ?v }' ] .",
            "rob:place",
        ),
        (":A a owl:Class ; rdfs:label 'a' ; owl:equivalentClass [ owl:unionOf ( rob:Lmap ) ] .", "rob:Lamp"),
        (":A a owl:Class ; rdfs:label 'a' ; rdfs:subClassOf [ owl:onProperty rob:palce ] .", "rob:place"),
        (TEMPLATE + ":t sc:cost ( [ sc:term [ sc:property rob:palce ] ] ) .", "rob:place"),
        (TEMPLATE + ":r sh:property [ sh:path ( rob:suport rob:place ) ; sh:minCount 1 ] .", "rob:support"),
        (
            TEMPLATE + ":r sh:property [ sh:path [ sh:alternativePath ( rob:place rob:suport ) ] ; sh:minCount 1 ] .",
            "rob:support",
        ),
        (
            TEMPLATE + ":r sh:property [ sh:path [ sh:alternativePath ( rob:place ( rob:suport :in ) ) ] ] .",
            "rob:support",
        ),
        (TEMPLATE + ":r sh:closed true ; sh:ignoredProperties ( rdf:type rob:palce ) .", "rob:place"),
        (TEMPLATE + ":r sh:property [ sh:path rdf:type ; sh:hasValue rob:Lmap ] .", "rob:Lamp"),
        (TEMPLATE + ":r sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:in ( rob:Imge ) ] .", "rob:Image"),
    ],
)
def test_a_misspelt_term_of_a_loaded_ontology_is_a_warning(text: str, meant: str) -> None:
    found = only(text)
    assert (found.code, found.severity, found.hint) == ("SC-L02", Severity.WARNING, f"Did you mean {meant}?")


@pytest.mark.parametrize(
    ("text", "code", "hint"),
    [
        (":a a sc:component, rob:Tuner .", "SC-L01", "Did you mean sc:Component?"),
        (TEMPLATE + ":r sh:class rob:place .", "SC-L02", "Did you mean rob:Place?"),
        (TEMPLATE + ":r sh:class rob:support .", "SC-L02", None),
    ],
)
def test_a_property_in_the_place_of_a_class_is_noticed(text: str, code: str, hint: str | None) -> None:
    found = only(text)
    assert (found.code, found.hint) == (code, hint)
    assert "is a property, where a class has to stand" in found.message


def test_a_value_that_a_role_asks_for_is_no_term_of_a_vocabulary() -> None:
    assert not lints(
        TEMPLATE + ":r sh:property [ sh:path rob:place ; sh:in ( rob:kitchen rob:hall ) ; sh:hasValue rob:hall ] ."
    )


def test_a_parameter_that_stands_for_a_class_is_no_misspelt_class() -> None:
    ontology = SourceText("home.ttl", (PREAMBLE + ":Home a owl:Class ; rdfs:label 'home' .").encode())
    text = TEMPLATE + ":t sc:parameter :kind . :kind a sc:Parameter ; sc:name 'kind' . :r sh:class :kind ."
    files = [SourceText("a.ttl", (PREAMBLE + text).encode())]
    assert not validate_texts(files, SHAPES, [*ONTOLOGIES, ontology]).diagnostics


@pytest.mark.parametrize("prefix", ["rdf", "rdfs", "owl", "xsd", "rob"])
def test_a_prefix_with_no_name_behind_it_is_no_term(prefix: str) -> None:
    found = only(f":a a sc:Component, :A ; {prefix}: 1 .")
    assert (found.code, found.hint) == ("SC-L02", None)
    assert found.message.endswith(f" {prefix}:.")


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        (":a a sc:Component, sc:Tuner .", "rob:Tuner"),
        (":a a sc:Component, rob:Tuner ; sc:label 'a' .", "rdfs:label"),
        (TEMPLATE + ":r sc:class rob:Lamp .", "sh:class"),
        (TEMPLATE + ":r rob:feeds :r .", "sc:feeds"),
    ],
)
def test_a_term_with_the_prefix_of_another_vocabulary_is_found_there(text: str, meant: str) -> None:
    assert only(text).hint == f"Did you mean {meant}?"


def test_nothing_is_suggested_where_nothing_is_alike() -> None:
    assert only(":a a sc:Component, rob:Tuner ; rob:location :x .").hint is None


def test_every_occurrence_of_a_misspelt_term_is_reported() -> None:
    assert [each.column for each in lints(":a a sc:Component, rob:Tuner ; sc:nme 1 ; sc:nme 2 .")] == [32, 43]


def test_terms_of_an_ontology_that_is_not_loaded_are_left_alone() -> None:
    assert not lints(":a a sc:Component, <https://example.org/x#Tunr> ; <https://example.org/x#y> 1 .")


def test_membership_properties_of_rdf_are_no_misspelling() -> None:
    rdf = "http://www.w3.org/1999/02/22-rdf-syntax-ns#"
    assert not lints(f":a a sc:Component, rob:Tuner ; :uses [ <{rdf}_1> 5 ] .")


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        (COSTED.replace("rob:latency ; {}", "rob:Camera"), COSTED.replace("rob:latency ; {}", "rob:power")),
        (COSTED.replace("rob:latency ; {}", "rob:place"), COSTED.replace("rob:latency ; {}", ":price")),
        (
            TEMPLATE + ":r sh:property [ sh:path rob:Place ; sh:minCount 1 ] .",
            TEMPLATE + ":r sh:property [ sh:path rob:place ; sh:minCount 1 ] .",
        ),
    ],
)
def test_what_is_no_property_or_counts_nothing_is_noticed_in_a_path_and_a_cost(wrong: str, right: str) -> None:
    assert only(wrong).code == "SC-L02"
    assert not lints(right)
