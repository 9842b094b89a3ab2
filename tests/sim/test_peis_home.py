"""The apartment's Turtle: every term is explained, and the rooms make the home of the paper. And its program."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from rdflib import OWL, RDF, RDFS, SKOS, Graph, URIRef

from selfconf.bus.memory import Network
from selfconf.sdk import Host
from sim.home.apartment import HOME, PEIS_HOME, Apartment
from sim.home.route import RouteMap

if TYPE_CHECKING:
    from sim.peis_home import PeisHome

TERMS = sorted({s for s in Graph().parse(PEIS_HOME).subjects() if str(s).startswith(str(HOME))})


@pytest.mark.parametrize("term", TERMS, ids=lambda term: term.split("#")[1])
def test_a_term_has_a_label_a_definition_and_a_home(plan: Graph, term: URIRef) -> None:
    assert plan.value(term, RDF.type) is not None
    assert plan.value(term, RDFS.label) is not None
    assert plan.value(term, SKOS.definition) is not None
    assert plan.value(term, RDFS.isDefinedBy) == URIRef("https://w3id.org/selfconf/peis-home")


def test_no_term_is_used_without_being_declared(plan: Graph) -> None:
    terms = {term for triple in plan for term in triple if isinstance(term, URIRef)}
    used = {term for term in terms if term.startswith(str(HOME))}
    assert used == set(TERMS)


def test_the_file_is_an_ontology_with_a_version(plan: Graph) -> None:
    ontology = URIRef("https://w3id.org/selfconf/peis-home")
    assert (ontology, RDF.type, OWL.Ontology) in plan
    assert plan.value(ontology, OWL.versionInfo) is not None


def test_the_apartment_has_about_25_square_metres(apartment: Apartment) -> None:
    assert sum(room.width * room.depth for room in apartment.rooms) == pytest.approx(25.0, abs=0.5)


def test_every_place_that_a_goal_may_name_can_be_reached_from_the_start(apartment: Apartment) -> None:
    ways = RouteMap(apartment, clearance=0.38)
    start = apartment.robots[0].start
    goals = [place.standing for place in apartment.places if place.standing is not None]
    assert len(goals) >= 3
    for goal in goals:
        assert ways.way((start.x, start.y), (goal.x, goal.y))


def test_furniture_does_not_stand_in_the_walls(apartment: Apartment) -> None:
    panels = [panel for wall in apartment.walls for panel in wall.panels()]
    for piece in apartment.furniture:
        assert all(panel.distance(piece.x, piece.y) >= min(piece.width, piece.depth) / 2 for panel in panels)


def test_there_are_spots_for_a_tuner_and_for_speakers_in_two_rooms(apartment: Apartment) -> None:
    rooms = {place.room for place in apartment.places if place.name.endswith("speaker-spot")}
    assert rooms == {"living-room", "bedroom"}
    assert any(place.name == "tuner-spot" for place in apartment.places)


def test_sparql_can_ask_which_furniture_is_in_the_apartment_and_in_which_room(plan: Graph) -> None:
    rows = plan.query(
        """SELECT ?piece ?room WHERE {
             ?piece a/rdfs:subClassOf* home:Furniture ; home:isIn ?room .
             ?room home:isIn home:peis-home }"""
    )
    assert (HOME.sofa, HOME["living-room"]) in {(row[0], row[1]) for row in rows}


@pytest.fixture
def playing(apartment: Apartment) -> Iterator[Callable[..., PeisHome]]:
    """Makes the program's world at a speed, perhaps with cameras of their own, in an ecology without configurator."""
    pytest.importorskip("pybullet", reason="PyBullet is not installed: install the extra sim on Python 3.10 or 3.11")
    from sim.peis_home import PeisHome

    made: list[PeisHome] = []

    def make(speed: float, eyes: bool = False) -> PeisHome:
        made.append(PeisHome(Host(Network(0).node(), "lab"), apartment, 1, speed, "bedroom", False, eyes))
        return made[-1]

    yield make
    for home in made:
        home.host.close()
        home.world.close()


@pytest.mark.sim
def test_the_world_ends_that_is_told_to_while_the_sensors_look(playing: Callable[..., PeisHome]) -> None:
    home = playing(1.0)
    answers = iter([False])
    home.told.heed_no_more()
    home.told = lambda: next(answers, True)  # type: ignore[assignment]
    assert home.run(1.0) == "told to end"


@pytest.mark.sim
def test_as_fast_as_it_goes_is_real_time_while_nothing_tells_poses(
    playing: Callable[..., PeisHome], monkeypatch: pytest.MonkeyPatch
) -> None:
    home = playing(float("inf"))
    home.told.heed_no_more()
    monkeypatch.setattr("sim.equipment.MotorDrive.active", True)
    home.odometry.told = home.drive.heard = 0.0  # the last pose of a source that is gone, and the answer to it
    began = time.monotonic()
    assert home.run(1.0) == "time is up"
    assert time.monotonic() - began >= 1.0


@pytest.mark.sim
@pytest.mark.parametrize("eyes", [False, True])
def test_images_are_kept_with_what_was_found_in_them_and_without_that_not_at_all(
    eyes: bool, playing: Callable[..., PeisHome], monkeypatch: pytest.MonkeyPatch
) -> None:
    home = playing(10.0, eyes)
    home.told.heed_no_more()
    monkeypatch.setattr(f"sim.{'eyes.StereoEye' if eyes else 'equipment.PersonTracker'}.active", True)
    home.run(0.5)
    assert [pose is not None for _, _, pose in home.logbook.sights] == ([] if eyes else [True])


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--seed", "-3"), "--seed is a whole number from zero on"),
        (("--speed", "0"), "--speed is more than zero"),
        (("--speed", "nan"), "--speed is more than zero"),
        (("--place", "nowhere"), "--place: home:nowhere"),
    ],
)
def test_what_the_world_cannot_be_is_one_sentence(
    options: tuple[str, str], words: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("pybullet", reason="PyBullet is not installed: install the extra sim on Python 3.10 or 3.11")
    monkeypatch.setattr("sys.argv", ["peis_home", *options])
    from sim.peis_home import main

    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 2
    assert words in capsys.readouterr().err


@pytest.mark.sim
@pytest.mark.usefixtures("handlers")
def test_a_record_that_cannot_be_written_is_one_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("pybullet", reason="PyBullet is not installed: install the extra sim on Python 3.10 or 3.11")
    record = tmp_path / "removed" / "run.npz"
    monkeypatch.setattr("sys.argv", ["peis_home", "--seconds", "0.1", "--speed", "inf", "--record", str(record)])
    monkeypatch.setattr("sim.peis_home.open_host", lambda *_: Host(Network(0).node(), "lab"))
    from sim.peis_home import main

    assert main() == 2
    assert (
        capsys.readouterr().out.splitlines()[-1] == f"the record {record} cannot be written: No such file or directory"
    )
