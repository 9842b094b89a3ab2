"""Components that only their ports keep out of a role."""

from __future__ import annotations

from selfconf.rdf.advertisements.advertisement import Advertisement
from selfconf.rdf.eligibility.advertisement_index import AdvertisementIndex
from selfconf.rdf.eligibility.unlike_ports import kept_out_by_ports, ports_asked, words_of_role
from tests.rdf.eligibility.test_partitioner import partitioner, read

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
