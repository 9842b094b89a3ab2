"""The experiment of the paper without a network: tracker, failure, odometry, bedroom."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial

import pytest

pytest.importorskip("pybullet", reason="PyBullet is not installed: install the extra sim on Python 3.10 or 3.11")

from sim.home.apartment import Apartment
from sim.home.floor_plan import Block
from sim.rehearsal import Log, rehearse
from tests.harness.effort import NIGHTLY, at_night, thorough

pytestmark = [pytest.mark.sim, pytest.mark.slow]

ORANGE = (1.0, 0.5, 0.0)


@pytest.fixture(scope="module")
def logs(apartment: Apartment) -> Callable[[int], Log]:
    """The log of a seed, with a pause of two seconds; each seed is rehearsed once."""
    return cache(partial(rehearse, apartment, pause=2.0))


def bedroom_error(log: Log, apartment: Apartment) -> float:
    standing = apartment.place("bedroom").standing
    assert standing is not None
    return log.error(standing)


@pytest.mark.parametrize("seed", range(1, 11 if NIGHTLY else 2))
def test_the_tracker_loses_her_before_the_door_and_odometry_brings_her_to_the_bedroom(
    apartment: Apartment, logs: Callable[[int], Log], seed: int
) -> None:
    log = logs(seed)
    assert log.lost_at is not None
    assert 3.2 < log.poses[log.times.index(log.lost_at)].x < apartment.doors[0].x
    assert log.outcome is not None
    assert log.outcome.state == "arrived"
    assert bedroom_error(log, apartment) < 0.25
    assert log.touched == set()
    assert list(dict.fromkeys(log.sources)) == ["tracker", "none", "odometry"]


def test_she_stands_still_while_nobody_sends_poses(logs: Callable[[int], Log]) -> None:
    log = logs(1)
    waiting = [pose for pose, source in zip(log.poses, log.sources, strict=True) if source == "none"]
    assert waiting[-1].distance(waiting[-8]) < 0.005


@thorough
def test_an_obstacle_in_her_way_is_avoided(apartment: Apartment, logs: Callable[[int], Log]) -> None:
    crate = Block("crate", 2.2, 1.33, 0.0, 0.4, 0.3, 0.3, 0.6, ORANGE)
    log = rehearse(apartment, seed=1, obstacles=[crate])
    assert min(crate.distance(pose.x, pose.y) for pose in logs(1).poses) == 0.0
    assert min(crate.distance(pose.x, pose.y) for pose in log.poses) > 0.26
    assert log.touched == set()
    assert log.outcome is not None
    assert log.outcome.state == "arrived"
    assert bedroom_error(log, apartment) < 0.25


@at_night
def test_a_blocked_door_makes_her_give_up_and_say_why(apartment: Apartment) -> None:
    crate = Block("crate", 3.75, 0.99, 0.0, 0.0, 0.4, 0.8, 0.9, ORANGE)
    log = rehearse(apartment, seed=1, obstacles=[crate])
    assert log.outcome is not None
    assert log.outcome.state == "stuck"
    assert log.outcome.reason
    assert log.touched == set()


@at_night
def test_she_finds_her_way_round_furniture_that_was_moved(apartment: Apartment) -> None:
    moved = tuple(
        replace(piece, x=2.2, y=1.4) if piece.name == "coffee-table" else piece for piece in apartment.furniture
    )
    log = rehearse(replace(apartment, furniture=moved), seed=1)
    assert log.outcome is not None
    assert log.outcome.state == "arrived"
    assert log.touched == set()


@at_night
def test_a_rehearsal_can_be_repeated_exactly(apartment: Apartment) -> None:
    first, second = (rehearse(apartment, seed=4, patience=4.0) for _ in range(2))
    assert first.poses == second.poses
