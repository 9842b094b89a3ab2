"""Near misses by type: misspelt, or above or below the class that is asked for."""

from __future__ import annotations

from selfconf.model.hierarchy import NOTHING_ABOVE
from selfconf.model.obstacle import TypeRelation, WrongType
from selfconf.rdf import advertisements
from selfconf.rdf.eligibility import AdvertisementIndex
from selfconf.rdf.eligibility.partitioner import Partitioner
from selfconf.rdf.eligibility.similar_types import near_misses_by_type
from selfconf.rdf.tasks import read_task
from selfconf.rdf.turtle import parse
from tests.lab import PREFIXES, iri


def test_a_component_of_a_misspelt_type_is_a_near_miss_and_one_of_another_type_is_none() -> None:
    text = PREFIXES + ":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class :Clock ."
    partitioner = Partitioner(read_task(parse(text, "t.ttl")))
    found, _ = advertisements.read_advertisements(
        (PREFIXES + ":a a sc:Component, :Clok . :b a sc:Component, :Lamp .").encode(), "a.ttl"
    )
    ecology = AdvertisementIndex.of(found)
    (miss,) = near_misses_by_type(partitioner.roles[0], partitioner, ecology, NOTHING_ABOVE)
    assert miss.component == iri("a")
    assert miss.obstacle == WrongType(iri("Clock"), iri("Clok"), TypeRelation.SIMILAR)
