"""Profiles of components: ports, properties, places."""

from __future__ import annotations

import pytest

from selfconf.model.profile import Input, OperationalParameter, Output, Place, Ports, Profile, shared_ports
from selfconf.model.term import IRI, Literal


def test_a_place_is_shown_as_editors_know_it() -> None:
    assert str(Place("ads.ttl", 7)) == "ads.ttl:7"
    assert str(Place("ads.ttl")) == "ads.ttl"


def test_ports_are_found_by_name_and_inputs_are_no_outputs() -> None:
    pose = Output("pose", (IRI("urn:Pose"),), 5.0)
    profile = Profile(IRI("urn:c"), ports=Ports((Input("where", (IRI("urn:Pose"),)),), (pose,)))
    assert profile.output("pose") is pose
    assert profile.output("where") is None
    assert [port.name for port in profile.inputs] == ["where"]


@pytest.mark.parametrize("said", [None, True, False])
@pytest.mark.parametrize(
    ("ports", "parameters", "otherwise"),
    [
        (Ports(outputs=(Output("pose", (IRI("urn:Pose"),)),)), (), True),
        (Ports(inputs=(Input("where", (IRI("urn:Pose"),)),)), (), False),
        (Ports(), (OperationalParameter("goal", IRI("urn:Goal")),), False),
    ],
)
def test_a_component_is_shareable_if_it_says_so_or_if_nobody_can_want_anything_of_it(
    ports: Ports, parameters: tuple[OperationalParameter, ...], otherwise: bool, said: bool | None
) -> None:
    profile = Profile(IRI("urn:c"), ports=ports, parameters=parameters, shareable=said)
    assert profile.is_shareable is (otherwise if said is None else said)


def test_the_values_of_a_property_are_all_of_them_in_order() -> None:
    place, other = IRI("urn:place"), IRI("urn:other")
    profile = Profile(IRI("urn:c"), properties=((place, Literal("a")), (place, Literal("b")), (other, Literal("c"))))
    assert profile.values(place) == (Literal("a"), Literal("b"))
    assert profile.values(IRI("urn:none")) == ()


def test_where_a_component_is_described_makes_it_no_other_component() -> None:
    assert Profile(IRI("urn:c"), place=Place("a.ttl")) == Profile(IRI("urn:c"), place=Place("b.ttl"))


def test_equal_ports_are_one_object() -> None:
    ports = (Input("where", (IRI("urn:Pose"),)),)
    assert shared_ports(ports, ()) is shared_ports((Input("where", (IRI("urn:Pose"),)),), ())
