"""What pySHACL has said is remembered as long as it holds, and no longer."""

from __future__ import annotations

from dataclasses import replace

import pytest

from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.obstacle import NotJudged, ShapeViolated
from selfconf.rdf.eligibility.advertisement_index import AdvertisementIndex
from selfconf.rdf.eligibility.judgements import Judgements, Violations
from tests.lab import iri
from tests.rdf.eligibility.test_partitioner import names, partitioner, read

TASK = ":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class :Lamp ; "
LAMPS = ":one a sc:Component, :Lamp ; :near :two . :two a sc:Component, :Lamp ; :lit {} ."
NEAR_A_LIT_ONE = "sh:property [ sh:path ( :near [ sh:oneOrMorePath :lit ] ) ; sh:minCount 1 ] ."
WRONG: Violations = (ShapeViolated("is dark"),)
SLOW: Violations = (NotJudged("takes too long"),)
(ROLE,) = partitioner(TASK + NEAR_A_LIT_ONE).roles


def ecology(text: str) -> AdvertisementIndex:
    """The ecology that a text describes."""
    return AdvertisementIndex.of(read([text]))


@pytest.mark.parametrize("local", [True, False])
@pytest.mark.parametrize("said", [(), WRONG, SLOW], ids=["conforms", "violates", "slow"])
def test_a_judgement_outlives_its_ecology_where_it_depends_on_nothing_else(local: bool, said: Violations) -> None:
    judgements, role, here = Judgements(), replace(ROLE, local=local), ecology(LAMPS.format(1))
    lamp = here[iri("one")]
    judgements.look_at(here)
    assert judgements.known(role, lamp, {}, here) is None
    judgements.keep(role, lamp, {}, here, said)
    assert judgements.known(role, lamp, {}, here) == said
    there = AdvertisementIndex({iri("one"): lamp})
    judgements.look_at(there)
    assert judgements.known(role, lamp, {}, there) == (said if local or said is SLOW else None)


def test_what_is_advertised_in_other_words_is_judged_anew() -> None:
    judgements, role, here = Judgements(), replace(ROLE, local=True), ecology(LAMPS.format(1))
    judgements.look_at(here)
    judgements.keep(role, here[iri("two")], {}, here, SLOW)
    there = ecology(LAMPS.format(2))
    judgements.look_at(there)
    assert judgements.known(role, there[iri("two")], {}, there) is None
    judgements.look_at(here)
    assert judgements.known(role, here[iri("two")], {}, here) is None  # forgotten


def test_a_judgement_holds_for_the_values_of_parameters_with_which_it_was_made_and_slowness_for_all() -> None:
    judgements, role, here = Judgements(), replace(ROLE, local=True), ecology(LAMPS.format(1))
    judgements.look_at(here)
    one, two = here[iri("one")], here[iri("two")]
    judgements.keep(role, one, {iri("room"): iri("hall")}, here, WRONG)
    judgements.keep(role, two, {iri("room"): iri("hall")}, here, SLOW)
    assert judgements.known(role, one, {iri("room"): iri("attic")}, here) is None
    assert judgements.known(role, two, {iri("room"): iri("attic")}, here) == SLOW


def test_who_is_eligible_follows_what_others_say() -> None:
    near = partitioner(TASK + NEAR_A_LIT_ONE)
    assert not near.roles[0].local
    assert names(near.partition(read([LAMPS.format(":bright")]))) == [["one"]]
    assert names(near.partition(read([LAMPS.replace(":lit {}", ":dark 1")]))) == [[]]
    assert names(near.partition(read([LAMPS.format(":bright")]))) == [["one"]]


@pytest.mark.parametrize(
    "steps", ["rdfs:subClassOf", "rdfs:subClassOf rdfs:subClassOf", "[ sh:zeroOrMorePath rdfs:subClassOf ]"]
)
def test_a_path_of_subclasses_goes_on_from_the_value_of_any_property(steps: str) -> None:
    task = TASK + f"sh:property [ sh:path ( :carries {steps} ) ; sh:hasValue :Bulb ] ."
    lamp = ":one a sc:Component, :Lamp ; :carries :Halogen ."
    above = Hierarchy([(iri("Halogen"), iri("Hot")), (iri("Hot"), iri("Bulb"))])
    assert names(partitioner(task, above).partition(read([lamp]))) == [["one"]]
    assert names(partitioner(task, NOTHING_ABOVE).partition(read([lamp]))) == [[]]
