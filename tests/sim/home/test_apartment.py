"""Reading the apartment: what the Turtle says, and what it is told when it says too little."""

from __future__ import annotations

from pathlib import Path

import pytest
from rdflib import RDF, SKOS, BNode, Graph, Literal, URIRef

from sim.home.apartment import HOME, Apartment, ApartmentError, read_apartment


def test_the_experiment_has_what_it_needs(apartment: Apartment) -> None:
    assert [room.name for room in apartment.rooms] == ["bedroom", "living-room"]
    assert [door.rooms for door in apartment.doors] == [("bedroom", "living-room")]
    assert [robot.name for robot in apartment.robots] == ["Astrid"]
    assert [camera.name for camera in apartment.cameras] == ["stereo-camera"]
    assert {"BEDROOM", "KITCHEN", "LIVING-ROOM"} <= {place.notation for place in apartment.places}


def test_the_robot_starts_in_the_room_that_the_camera_hangs_in(apartment: Apartment) -> None:
    start, (x, y, _) = apartment.robots[0].start, apartment.cameras[0].position
    assert apartment.room_at(start.x, start.y) == apartment.room_at(x, y)


def test_a_point_on_the_threshold_is_in_no_room(apartment: Apartment) -> None:
    door = apartment.doors[0]
    assert apartment.room_at(door.x, door.y) is None


def test_furniture_that_is_moved_in_turtle_is_moved(plan: Graph) -> None:
    plan.set((HOME.sofa, HOME.x, Literal("2.0")))
    sofa = next(piece for piece in read_apartment(plan).furniture if piece.name == "sofa")
    assert sofa.x == 2.0


def test_furniture_knows_its_kind_and_a_floor_covering_is_not_solid(apartment: Apartment) -> None:
    pieces = {piece.name: piece for piece in apartment.furniture}
    assert (pieces["sofa"].kind, pieces["sofa"].solid) == ("Sofa", True)
    assert (pieces["rug"].kind, pieces["rug"].solid) == ("FloorCovering", False)
    assert pieces["plant"].round


MISSING = [
    ("sofa", "x"),
    ("sofa", "width"),
    ("plant", "height"),
    ("bedroom", "depth"),
    ("south-wall", "height"),
    ("bedroom-door", "width"),
    ("stereo-camera", "lookAt"),
    ("stereo-camera", "fieldOfView"),
    ("Astrid", "startPose"),
    ("sofa", "isIn"),
]


@pytest.mark.parametrize(("subject", "property"), MISSING, ids=" ".join)
def test_what_is_missing_is_named(plan: Graph, subject: str, property: str) -> None:
    plan.remove((HOME[subject], HOME[property], None))
    with pytest.raises(ApartmentError) as caught:
        read_apartment(plan)
    assert str(caught.value) == f"home:{subject}: home:{property} is missing"
    assert (caught.value.subject, caught.value.property) == (f"home:{subject}", f"home:{property}")


def test_what_is_missing_in_a_blank_node_is_named_by_its_owner(plan: Graph) -> None:
    pose = plan.value(HOME.Astrid, HOME.startPose)
    plan.remove((pose, HOME.y, None))
    with pytest.raises(ApartmentError, match=r"^home:Astrid home:startPose: home:y is missing$"):
        read_apartment(plan)


WRONG = [
    ("sofa", "x", Literal("east"), "home:sofa: home:x must be a number"),
    ("sofa", "x", Literal("NaN"), "home:sofa: home:x must be a number"),
    ("sofa", "x", BNode("somewhere"), "home:sofa: home:x must be a number"),
    ("sofa", "width", Literal(-1.0), "home:sofa: home:width must be greater than 0"),
    ("sofa", "colour", Literal("blue"), "home:sofa: home:colour must be like"),
    ("sofa", "isIn", HOME.bedroom, "home:sofa: home:isIn says bedroom, but the centre lies outside it"),
    ("sofa", "isIn", HOME.cellar, "home:sofa: home:isIn names cellar, which is no room"),
    ("bedroom-door", "connects", HOME.cellar, "home:bedroom-door: home:connects must name two rooms"),
    ("bedroom-door", "x", Literal(1.0), "home:bedroom-door: home:x and home:y lie outside home:partition"),
]


@pytest.mark.parametrize(("subject", "property", "value", "message"), WRONG)
def test_what_is_wrong_is_named(
    plan: Graph, subject: str, property: str, value: Literal | URIRef, message: str
) -> None:
    plan.set((HOME[subject], HOME[property], value))
    with pytest.raises(ApartmentError) as caught:
        read_apartment(plan)
    assert str(caught.value).startswith(message)


def test_two_values_where_one_belongs_are_refused(plan: Graph) -> None:
    plan.add((HOME.sofa, HOME.x, Literal("2.0")))
    with pytest.raises(ApartmentError, match="home:sofa: home:x is given more than once"):
        read_apartment(plan)


def test_a_place_that_goals_may_name_needs_a_standing_point(plan: Graph) -> None:
    plan.add((HOME["tuner-spot"], SKOS.notation, Literal("TUNER")))
    with pytest.raises(ApartmentError, match="home:tuner-spot: home:standingPoint is missing"):
        read_apartment(plan)


@pytest.mark.parametrize(
    ("octets", "reason"),
    [
        (b"@prefix : <urn:x#> .\n:a :b [ .", "at line 2"),
        (b"<urn:a> <urn:b> 'x", "Quote expected"),
        (b"<urn:a> <urn:b> 'K\xfcche' .", "'utf-8' codec"),
        (None, "No such file or directory"),
    ],
)
def test_a_file_that_cannot_be_read_is_named(octets: bytes | None, reason: str, tmp_path: Path) -> None:
    path = tmp_path / "home.ttl"
    if octets is not None:
        path.write_bytes(octets)
    with pytest.raises(ApartmentError) as caught:
        read_apartment(path)
    assert str(caught.value).startswith(f"{path}: the file cannot be read: ")
    assert reason in str(caught.value)


def test_a_graph_without_an_apartment_is_refused() -> None:
    with pytest.raises(ApartmentError, match="home:Apartment must have one instance, not 0"):
        read_apartment(Graph())


def test_a_second_apartment_is_refused(plan: Graph) -> None:
    plan.add((HOME.neighbours, RDF.type, HOME.Apartment))
    with pytest.raises(ApartmentError, match="home:Apartment must have one instance, not 2"):
        read_apartment(plan)


def test_a_thing_is_found_by_name_or_named_as_missing(apartment: Apartment) -> None:
    assert apartment.robot("Astrid").iri == str(HOME.Astrid)
    assert apartment.camera("stereo-camera").width == 320
    assert apartment.place("bedroom").room == "bedroom"
    with pytest.raises(ApartmentError, match=r"^home:Emil: rdf:type rob:Robot is missing$"):
        apartment.robot("Emil")
