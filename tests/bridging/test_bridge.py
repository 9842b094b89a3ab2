"""A bridge: it advertises by files, and lives as what is advertised, whatever the world on the other side is."""

from __future__ import annotations

import threading
from pathlib import Path

import pytest

from selfconf.bridging import Bridge
from selfconf.bus.zenoh import client
from selfconf.errors import NetworkError
from selfconf.importing import ImportedComponent, ImportedDocument, ImportedPort
from selfconf.model.term import IRI
from selfconf.sdk import Component
from tests.sdk.living import LivingStage, until

LAMP, LIGHT = IRI("urn:c:lamp"), IRI("urn:c:Light")


class World:
    """A world with nothing in it but what the test says."""

    def __init__(self) -> None:
        self.steps: list[str] = []

    def open(self, bridge: Bridge) -> World:
        self.steps.append("open")
        return self

    def close(self) -> None:
        self.steps.append("close")


class Lamp(Component):
    """A lamp that writes down when it is on."""

    def __init__(self, steps: list[str]) -> None:
        self.steps = steps

    def started(self) -> None:
        self.steps.append("on")

    def stopped(self) -> None:
        self.steps.append("off")


def document(*kinds: IRI) -> ImportedDocument:
    component = ImportedComponent(LAMP, kinds, outputs=(ImportedPort("light", (LIGHT,)),))
    return ImportedDocument("", "a\nb", (component.described(),), {})


def test_what_is_foreign_lives_while_it_is_there(living: LivingStage, tmp_path: Path) -> None:
    world, complaints = World(), list[str]()
    bridge = Bridge(tmp_path, complaints.append)
    with bridge.living(world.open, living.ecology, living.node):
        bridge.advertise(LAMP, document(IRI("urn:c:Lamp")))
        (path,) = tmp_path.iterdir()
        assert path.read_text().startswith("# Bridged from 'a\\nb'.\n\n@prefix sc:")
        lamp = Lamp(world.steps)
        assert bridge.begin_life(LAMP, lamp).result() is None
        answers = living.apply(LAMP)
        assert until(lambda: answers and answers[0].active)
        bridge.end_life(LAMP, Lamp([]))  # another one: nothing happens
        bridge.withdraw(LAMP)
        assert until(lambda: not bridge.lives(LAMP) and "off" in world.steps)
        assert list(tmp_path.iterdir()) == []
    assert world.steps == ["open", "on", "off", "close"]
    assert complaints == []


def test_components_come_to_rest_before_their_world_ends(living: LivingStage, tmp_path: Path) -> None:
    world = World()
    bridge = Bridge(tmp_path, lambda words: None)
    with bridge.living(world.open, living.ecology, living.node):
        bridge.advertise(LAMP, document(IRI("urn:c:Lamp")))
        assert bridge.begin_life(LAMP, Lamp(world.steps)).result() is None
        answers = living.apply(LAMP)
        assert until(lambda: answers)
    assert world.steps == ["open", "on", "off", "close"]


def test_what_is_advertised_anew_lives_no_more_by_what_was_said_before(living: LivingStage, tmp_path: Path) -> None:
    bridge = Bridge(tmp_path, lambda words: None)
    with bridge.living(World().open, living.ecology, living.node):
        bridge.advertise(LAMP, document(IRI("urn:c:Lamp")))
        assert bridge.begin_life(LAMP, Lamp([])).result() is None
        bridge.advertise(LAMP, document(IRI("urn:c:Lantern")))
        assert until(lambda: not bridge.lives(LAMP))
        (path,) = tmp_path.iterdir()
        assert "Lantern" in path.read_text()


def test_what_cannot_live_says_why(living: LivingStage, tmp_path: Path) -> None:
    bridge = Bridge(tmp_path, lambda words: None)
    with bridge.living(World().open, living.ecology, living.node):
        bridge.advertise(LAMP, document())
        reason = bridge.begin_life(LAMP, Lamp([])).result()
    assert reason is not None
    assert "a type of its own" in reason


def test_what_is_withdrawn_before_it_lives_is_said_to_have_gone(living: LivingStage, tmp_path: Path) -> None:
    bridge = Bridge(tmp_path, lambda words: None)
    with bridge.living(World().open, living.ecology, living.node):
        bridge.advertise(LAMP, document(IRI("urn:c:Lamp")))
        bridge.withdraw(LAMP)
        assert bridge.begin_life(LAMP, Lamp([])).result() == "it has gone before it could live here"
        bridge.advertise(LAMP, document(IRI("urn:c:Lamp")))
        assert bridge.begin_life(LAMP, Lamp([])).result() is None


@pytest.mark.slow
def test_a_component_that_has_to_leave_leaves_alone(living: LivingStage, tmp_path: Path) -> None:
    complaints: list[str] = []
    bridge = Bridge(tmp_path, complaints.append)
    with bridge.living(World().open, living.ecology, living.node):
        bridge.advertise(LAMP, document(IRI("urn:c:Lamp")))
        assert bridge.begin_life(LAMP, Lamp([])).result() is None
        other = living.node()
        other.announce(living.keys.life(LAMP, "0"))  # the smaller life, which stays
        assert until(lambda: not bridge.lives(LAMP))
        assert "is alive already, in the life 0" in complaints[0]
        other.close()
        assert until(lambda: bridge.begin_life(LAMP, Lamp([])).result() is None)


@pytest.mark.slow
def test_a_network_that_is_not_there_is_said_to_be_missing(tmp_path: Path) -> None:
    world = World()
    with (
        pytest.raises(NetworkError),
        Bridge(tmp_path, print).living(world.open, "lab", lambda: client(["tcp/127.0.0.1:1"])),
    ):
        pass
    assert world.steps == []


class Occupied(Component):
    """Code that keeps the thread of all components busy until the test lets it go on."""

    def __init__(self) -> None:
        self.busy, self.go_on = threading.Event(), threading.Event()

    def started(self) -> None:
        self.busy.set()
        self.go_on.wait()  # for as long as the test takes: else what waits for this thread goes on too early


def test_what_is_advertised_anew_before_it_lives_lives_by_the_new_code_alone(
    living: LivingStage, tmp_path: Path
) -> None:
    other = IRI("urn:c:other")
    bridge = Bridge(tmp_path, lambda words: None)
    with bridge.living(World().open, living.ecology, living.node):
        occupied = Occupied()
        component = ImportedComponent(other, (IRI("urn:c:Other"),), outputs=(ImportedPort("light", (LIGHT,)),))
        bridge.advertise(other, ImportedDocument("", "other", (component.described(),), {}))
        assert bridge.begin_life(other, occupied).result() is None
        answers = living.apply(other)
        try:
            assert until(occupied.busy.is_set)
            before, after, never = list[str](), list[str](), list[str]()
            bridge.advertise(LAMP, document(IRI("urn:c:Lamp")))
            begun = bridge.begin_life(LAMP, Lamp(before))
            cancelled = bridge.begin_life(LAMP, Lamp(never))
            assert cancelled.cancel()
            bridge.advertise(LAMP, document(IRI("urn:c:Lantern")))
            begun_anew = bridge.begin_life(LAMP, Lamp(after))
        finally:
            occupied.go_on.set()
        assert (begun.result(), begun_anew.result()) == (None, None)
        assert until(lambda: answers)
        answers = living.apply(LAMP)
        assert until(lambda: answers and after == ["on"]), answers
        assert (before, never) == ([], [])
