"""Profiles of components: ports, properties, places."""

from __future__ import annotations

import pickle

import pytest

from selfconf.model.profile import (
    LONGEST_PORT_NAME,
    Input,
    Operation,
    OperationalParameter,
    Output,
    Place,
    Ports,
    Profile,
    is_port_name,
    needed_operation,
    offered_operation,
    shared_ports,
)
from selfconf.model.term import IRI, Literal

PLACE, TEXT = IRI("urn:Place"), IRI("urn:Text")


def test_a_place_is_shown_as_editors_know_it() -> None:
    assert str(Place("ads.ttl", 7)) == "ads.ttl:7"
    assert str(Place("ads.ttl")) == "ads.ttl"


def test_ports_are_found_by_name_and_inputs_are_no_outputs() -> None:
    pose = Output("pose", (IRI("urn:Pose"),), 5.0)
    profile = Profile(IRI("urn:c"), ports=Ports((Input("where", (IRI("urn:Pose"),)),), (pose,)))
    assert profile.output("pose") is pose
    assert profile.output("where") is None
    assert [port.name for port in profile.inputs] == ["where"]


@pytest.mark.parametrize(
    ("name", "may_be"),
    [("pose", True), ("set.velocity", True), (" /ö *😀", True), ("a()b", True), ("", False), ("f()", False)]
    + [("ö" * LONGEST_PORT_NAME, True), ("ö" * (LONGEST_PORT_NAME + 1), False)]
    + [(f"a{control}b", False) for control in "\n\t\x00\x9f\u2028\u202e"],
)
def test_a_port_has_a_name_that_messages_can_hold(name: str, may_be: bool) -> None:
    assert is_port_name(name) is may_be


def test_operations_are_ports_that_are_told_apart_by_their_names() -> None:
    needed, photo = needed_operation("look", PLACE, TEXT), offered_operation("photo", None, TEXT)
    pose, view = Input("pose", (IRI("urn:Pose"),)), Output("view", ())
    profile = Profile(IRI("urn:c"), ports=Ports((needed, pose), (photo, view)))
    assert (profile.needed_operations, profile.signal_inputs) == ((needed,), (pose,))
    assert (profile.operations, profile.signal_outputs) == ((photo,), (view,))
    assert (needed.name, photo.name) == ("look()", "photo()")
    assert (needed.request, needed.response, photo.request, photo.response) == (PLACE, TEXT, None, TEXT)
    assert (pose.request, pose.response, view.request, view.response) == (None, None, None, None)


def test_the_type_of_an_operation_is_told_from_that_of_a_signal_wherever_it_goes() -> None:
    kind = pickle.loads(pickle.dumps(Operation.of(TEXT)))
    assert isinstance(kind, Operation)
    assert (kind, kind.response, kind.short) == (Operation.of(TEXT), TEXT, "-> Text")
    assert kind != TEXT
    assert (Operation.of(None).response, Operation.of(None).short) == (None, "-> nothing")


@pytest.mark.parametrize(
    ("sent", "taken", "above", "meets"),
    [
        (None, None, (), True),
        (None, PLACE, (), False),
        (PLACE, None, (), False),
        (PLACE, PLACE, (), True),
        (PLACE, TEXT, (), False),
        (PLACE, TEXT, (TEXT,), True),
    ],
)
def test_what_is_sent_along_is_taken_by_what_takes_it_or_what_lies_above(
    sent: IRI | None, taken: IRI | None, above: tuple[IRI, ...], meets: bool
) -> None:
    condition = needed_operation("look", sent, TEXT).condition
    assert condition is not None
    assert condition.sent is not None
    raised = condition._replace(sent=condition.sent._replace(kinds=condition.sent.kinds.union(above)))
    assert raised.met_by(offered_operation("describe", taken, TEXT)) is meets
    assert raised.met_by(Output("untyped()", ()))


@pytest.mark.parametrize(
    ("request_", "response", "words"),
    [
        (PLACE, TEXT, "operation Place -> Text"),
        (None, TEXT, "operation -> Text"),
        (PLACE, None, "operation Place -> nothing"),
    ],
)
def test_an_operation_is_told_by_its_types(request_: IRI | None, response: IRI | None, words: str) -> None:
    wanted = needed_operation("look", request_, response).wanted
    assert (str(wanted), wanted.issued) == (words, f"offers an {words}")
    assert str(offered_operation("describe", request_, response)) == str(wanted.output("x")) == f"an {words}"


@pytest.mark.parametrize("said", [None, True, False])
@pytest.mark.parametrize(
    ("ports", "parameters", "otherwise"),
    [
        (Ports(outputs=(Output("pose", (IRI("urn:Pose"),)),)), (), True),
        (Ports(outputs=(offered_operation("photo", None, TEXT),)), (), True),
        (Ports(outputs=(offered_operation("grasp", PLACE, None),)), (), False),
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
