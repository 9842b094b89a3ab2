"""The partition as a table: who is eligible for each role, in order, and what keeps the others out."""

from __future__ import annotations

import pytest

import selfconf as sc
from selfconf.model.obstacle import WrongType


def short(components: tuple[sc.IRI, ...]) -> list[str]:
    """The local names of components."""
    return [component.short for component in components]


def test_roles_are_found_by_local_name_curie_and_iri(task: sc.TaskSpecification, home: sc.Ecology) -> None:
    found = sc.partition(task, home)
    assert list(found) == ["sonar", "encoder", "position", "control", "drive"]
    for name in ("position", ":position", "https://w3id.org/selfconf/peis-home#position"):
        assert short(found[name].eligible) == ["person-tracker", "absolute-odometry"]
    with pytest.raises(KeyError, match="the roles are sonar"):
        found["pilot"]
    assert found.sufficient


def test_each_excluded_component_has_its_obstacles(task: sc.TaskSpecification, home: sc.Ecology) -> None:
    drive = sc.partition(task, home)["drive"]
    assert len(drive.eligible) + len(drive.excluded) == len(home)
    sonar = next(one for one in home.components if one.short == "sonar-array")
    (obstacle,) = drive.obstacles(sonar)
    assert isinstance(obstacle, WrongType)
    assert str(obstacle) == "is no MotorDrive"
    assert drive.obstacles(drive.eligible[0]) == ()
    with pytest.raises(KeyError, match="no component"):
        drive.obstacles(sc.IRI("x:nowhere"))


def test_a_partition_prints_as_a_table_and_so_does_a_role(clock: sc.TaskSpecification) -> None:
    found = sc.partition(clock.bind(room=":cellar"), sc.read("examples/clock"))
    assert not found.sufficient
    assert [line.split() for line in repr(found).splitlines()[2:]] == [
        [":source", "1", ":clock"],
        [":screen", "no", "component"],
    ]
    assert "place is kitchen, not cellar" in repr(found["screen"]._repr_html_())
    assert repr(found["screen"]) == "<role screen: no component>"
    assert found._repr_html_().count("<tr>") == 3
    assert found["source"]._repr_html_().count("<tr>") == 3
