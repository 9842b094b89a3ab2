"""The extension of a solution: a candidate that fits is added, however late it comes to fit."""

from __future__ import annotations

from dataclasses import replace
from heapq import heappop

import pytest

from selfconf.model.configuration import Configuration
from selfconf.model.profile import Ports
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


def test_who_is_left_out_of_one_role_may_still_play_another() -> None:
    given_ = problem(
        {"extra": [component("a")], "control": [component("cap")], "alone": [component("a")]},
        "extra>control",
        {"extra": (0, 1), "alone": (0, 1)},
    )
    answer = first.search(given_)
    assert isinstance(answer, Configuration)
    assert [[one.short for one in role.components] for role in answer.assignments] == [[], ["cap"], ["a"]]
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


def test_a_further_candidate_joins_only_if_it_feeds_or_is_fed() -> None:
    # The first of the extras is connected to nobody, and leaves its place to one that is.
    extras = [component("idle", outputs="b:Bump"), component("useful", outputs="p:Pose")]
    cap = component("cap", "p:Pose")
    eased = replace(cap, ports=Ports((cap.inputs[0]._replace(optional=True),)))
    given_ = problem(
        {"extra": extras, "control": [eased], "alone": [component("a"), component("b")]},
        "extra>control",
        {"extra": (0, 1), "alone": (1, 2)},
    )
    answer = first.search(given_)
    assert isinstance(answer, Configuration)
    played = [[one.short for one in role.components] for role in answer.assignments]
    assert played == [["useful"], ["cap"], ["a", "b"]]  # of a role in no interaction that is not asked
    assert answer == World(given_.task, given_.partition, given_.hierarchy).first()


def test_what_was_connected_to_nobody_joins_once_another_has_joined_that_it_feeds() -> None:
    # The first of the users takes the only place and is of no use, as then the second source is; both are left out.
    sources = [component("given", outputs="s:S"), component("more", outputs="s:S")]
    given_ = problem(
        {"user": [component("idle"), component("user", "s:S")], "source": sources},
        "source>user",
        {"user": (0, 1), "source": (1, 2)},
    )
    answer = first.search(given_)
    assert isinstance(answer, Configuration)
    assert [[one.short for one in role.components] for role in answer.assignments] == [["user"], ["given", "more"]]
    assert answer == World(given_.task, given_.partition, given_.hierarchy).first()


def test_what_was_left_out_while_another_took_a_place_joins_when_that_is_gone() -> None:
    """In the first turn `plain` is of no use as a camera, in the second as a view, in whose turn `back` feeds none."""
    plain, front, back = component("plain"), component("front", outputs="p:Pose"), component("back", outputs="p:Pose")
    given = problem(
        {"camera": [front, plain, back], "view": [plain, component("screen", "p:Pose")]},
        "camera>view",
        counts={"camera": (1, 2), "view": (0, 1)},
    )
    found = first.search(given)
    assert isinstance(found, Configuration)
    assert [[one.short for one in a.components] for a in found.assignments] == [["front", "back"], ["screen"]]
    assert found == World(given.task, given.partition, given.hierarchy).first()


def test_once_all_roles_are_full_no_further_candidate_is_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    # Each extra that joins is of no use, and leaves its place to the next: only the last one feeds the cap.
    extras = [*(component(f"idle{k:03}", outputs="b:Bump") for k in range(200)), component("useful", outputs="p:Pose")]
    cap = component("cap", "p:Pose")
    eased = replace(cap, ports=Ports((cap.inputs[0]._replace(optional=True),)))
    given_ = problem({"extra": extras, "control": [eased]}, "extra>control", {"extra": (0, 1)})
    looked_at = []
    monkeypatch.setattr("selfconf.search.extension.heappop", lambda heap: looked_at.append(0) or heappop(heap))
    answer = first.search(given_)
    assert isinstance(answer, Configuration)
    assert [one.short for one in answer.assignments[0].components] == ["useful"]
    assert len(looked_at) <= 2 * len(extras)
