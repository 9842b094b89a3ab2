"""The extension of a solution: a candidate that fits is added, however late it comes to fit."""

from __future__ import annotations

from selfconf.model.configuration import Configuration
from selfconf.search.strategies import first
from tests.search.oracle import World
from tests.search.worlds import component, problem

SENSORS = [component("gps", outputs="p:Pose"), component("skirt", outputs="b:Bump")]


def test_a_candidate_that_lacks_a_signal_is_added_once_a_source_of_it_is() -> None:
    given_ = problem(
        {"control": [component("first", "p:Pose"), component("second", "p:Pose b:Bump")], "sensor": SENSORS},
        "sensor>control",
        {"control": (1, None), "sensor": (1, None)},
    )
    answer = first.search(given_)
    assert isinstance(answer, Configuration)
    assert [[one.short for one in role.components] for role in answer.assignments] == [
        ["first", "second"],
        ["gps", "skirt"],
    ]
    assert answer == World(given_.task, given_.partition, given_.hierarchy).first()


def test_all_candidates_that_lack_the_same_signal_are_added_once_they_are_fed() -> None:
    waiting = [component(name, "p:Pose b:Bump") for name in ("second", "third")]
    given_ = problem(
        {"control": [component("first", "p:Pose"), *waiting], "sensor": SENSORS},
        "sensor>control",
        {"control": (1, None), "sensor": (1, None)},
    )
    answer = first.search(given_)
    assert isinstance(answer, Configuration)
    assert [one.short for one in answer.assignments[0].components] == ["first", "second", "third"]
