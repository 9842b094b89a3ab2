"""Near misses by their type, and by what the shape of a role asks of their ports."""

from __future__ import annotations

import pytest

from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.obstacle import NoAlternative, TypeRelation, WrongType
from selfconf.model.partition import NearMiss
from selfconf.rdf import advertisements
from selfconf.rdf.advertisements.advertisement import Advertisement
from selfconf.rdf.eligibility.advertisement_index import AdvertisementIndex
from selfconf.rdf.eligibility.near_types_and_ports import (
    kept_out_by_ports,
    near_misses_by_type,
    ports_asked,
    words_of_role,
)
from selfconf.rdf.eligibility.partitioner import Partitioner
from selfconf.rdf.tasks import read_task
from selfconf.rdf.turtle import parse
from selfconf.rdf.vocabulary import SC
from tests.lab import PREFIXES, iri
from tests.rdf.eligibility.test_partitioner import partitioner, read


def near(role: str, ads: str) -> list[NearMiss]:
    """The near misses by type of a role, in an ecology where nothing lies above anything."""
    text = f"{PREFIXES}:t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; {role} ."
    partitioner = Partitioner(read_task(parse(text, "t.ttl")))
    found, _ = advertisements.read_advertisements((PREFIXES + ads).encode(), "a.ttl")
    return [*near_misses_by_type(partitioner.roles[0], partitioner, AdvertisementIndex.of(found), NOTHING_ABOVE)]


def test_a_component_of_a_misspelt_type_is_a_near_miss_and_one_of_another_type_is_none() -> None:
    (miss,) = near("sh:class :Clock", ":a a sc:Component, :Clok . :b a sc:Component, :Lamp .")
    assert miss.component == iri("a")
    assert miss.obstacle == WrongType(iri("Clock"), iri("Clok"), TypeRelation.SIMILAR)


def test_a_component_that_lacks_one_class_of_several_is_a_near_miss_after_those_that_are_misspelt() -> None:
    ads = ":a a sc:Component, :Clock . :b a sc:Component, :Lamp . :c a sc:Component, :Clock, :Displey ."
    misses = near("sh:class :Clock , :Display", ads)
    assert [miss.component for miss in misses] == [iri("c"), iri("a")]
    assert misses[1].obstacle == WrongType(iri("Display"))
    asking_more = "sh:class :Clock , :Display ; sh:property [ sh:path :p ; sh:minCount 1 ]"
    assert near(asking_more, ads) == []


CLOK = ":a a sc:Component, :Clok ."


def test_a_component_of_a_misspelt_type_is_near_to_alternatives_of_classes_too() -> None:
    ads = ":a a sc:Component, :Clok . :b a sc:Component, :Lamp . :c a sc:Component, :Bell ."
    (miss,) = near("sh:or ( [ sh:class :Bel ] [ sh:class :Clock ] )", CLOK)
    assert miss.obstacle == NoAlternative(
        (WrongType(iri("Bel")), WrongType(iri("Clock"), iri("Clok"), TypeRelation.SIMILAR))
    )
    # Each alternative is written unlike every type; only that of another class that is asked for comes near.
    assert near("sh:or ( [ sh:class :Radar ] [ sh:class :Whistle ] )", ads) == []
    (miss,) = near("sh:class :Bell ; sh:or ( [ sh:class :Radar ] [ sh:class :Whistle ] )", ads)
    assert (miss.component, str(miss.obstacle)) == (iri("c"), "is no Radar and is no Whistle")


def test_alternatives_that_ask_for_more_than_classes_are_not_guessed_at() -> None:
    assert near("sh:or ( [ sh:class :Clock ] [ sh:property [ sh:path :p ; sh:minCount 1 ] ] )", CLOK) == []


TEMPLATE = """
:t a sc:Template ; sc:roles ( :r ) .
:r a sc:Role ; sh:class :Service ; rdfs:label "Prices of cars"@en ;
    sh:property [ sh:path :room ; sh:hasValue :hall ] ;
    sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:hasValue :Price ] .
"""
OUTPUT = 'sc:hasOutput [ sc:name "o" ; sc:signalType {} ]'
ADS = (
    f":good a sc:Component , :Service ; :room :hall ; {OUTPUT.format(':Price')} .",
    f":other a sc:Component , :Service ; :room :hall ; {OUTPUT.format(':Colour')} .",
    ":bare a sc:Component , :Service ; :room :hall .",
    f":elsewhere a sc:Component , :Service ; :room :cellar ; {OUTPUT.format(':Colour')} .",
    f":stranger a sc:Component , :Thing ; :room :hall ; {OUTPUT.format(':Price')} .",
)


def ecology() -> AdvertisementIndex:
    found: list[Advertisement] = list(read(ADS))
    return AdvertisementIndex.of(found)


def test_only_those_are_found_that_would_be_eligible_whatever_their_ports() -> None:
    asked = partitioner(TEMPLATE)
    ((good,),) = asked.eligible(ecology())
    assert good.profile.component.short == "good"
    role = asked.roles[0].iri
    found = kept_out_by_ports(asked, role, ecology(), {good.profile.component})
    assert sorted(one.profile.component.short for one in found) == ["bare", "other"]


def test_a_role_is_worded_by_its_name_its_label_and_its_signals() -> None:
    asked = partitioner(TEMPLATE)
    wanted = ports_asked(asked, asked.roles[0].iri)
    assert words_of_role(asked.document, asked.roles[0].iri, wanted) == ["price", "car", "price"]
    assert words_of_role(asked.document, asked.roles[0].iri, None) == ["price", "car"]


STAR = "[ sh:zeroOrMorePath rdfs:subClassOf ]"


@pytest.mark.parametrize(
    "hierarchy",
    [
        NOTHING_ABOVE,
        Hierarchy([(iri("Taxed"), iri("Price"))], [(iri("emits"), SC.hasOutput)]),
        Hierarchy([], [(iri("of"), SC.signalType)]),
    ],
)
@pytest.mark.parametrize("path", ["", "rdfs:subClassOf", STAR])
@pytest.mark.parametrize("more", ["", "; sh:deactivated true", "; sh:minCount 2"])
def test_what_is_not_shown_to_pyshacl_is_what_it_would_refuse(
    hierarchy: Hierarchy, path: str, more: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    shape = f"sh:property [ sh:path ( sc:hasOutput sc:signalType {path} ) ; sh:hasValue :Price {more} ]"
    text = f":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class :Service ; {shape} ."
    taxed = f":taxed a sc:Component , :Service ; {OUTPUT.format(':Taxed')} , [ sc:name 'p' ; sc:signalType :Colour ] ."
    below = ":below a sc:Component , :Service ; :emits [ sc:name 'o' ; sc:signalType :Price ] ."
    typed = ":typed a sc:Component , :Service ; sc:hasOutput [ sc:name 'o' ; :of :Price ] ."
    found = []
    for filtered in (True, False):
        asked = partitioner(text)
        asked = asked.under(hierarchy)
        if not filtered:
            monkeypatch.setattr(Partitioner, "_issuing", lambda self, role, passed: passed)
        (some,) = asked.eligible(AdvertisementIndex.of(read((*ADS, taxed, below, typed))))
        found.append(sorted(one.profile.component.short for one in some))
    assert found[0] == found[1]
    assert found[0] or "minCount" in more or path == "rdfs:subClassOf"


def test_a_free_parameter_is_no_type() -> None:
    text = """:t a sc:Template ; sc:parameter :kind ; sc:roles ( :r ) . :kind a sc:Parameter ; sc:name "kind" .
        :r a sc:Role ; sh:class :Service ;
            sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:hasValue :kind ] ."""
    (some,) = partitioner(text).eligible(ecology())
    assert sorted(one.profile.component.short for one in some) == ["elsewhere", "good", "other"]
