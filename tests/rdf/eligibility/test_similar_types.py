"""Near misses by type: misspelt, or above or below the class that is asked for."""

from __future__ import annotations

from selfconf.model.hierarchy import NOTHING_ABOVE
from selfconf.model.obstacle import TypeRelation, WrongType
from selfconf.model.partition import NearMiss
from selfconf.rdf import advertisements
from selfconf.rdf.eligibility import AdvertisementIndex
from selfconf.rdf.eligibility.partitioner import Partitioner
from selfconf.rdf.eligibility.similar_types import near_misses_by_type
from selfconf.rdf.tasks import read_task
from selfconf.rdf.turtle import parse
from tests.lab import PREFIXES, iri


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
