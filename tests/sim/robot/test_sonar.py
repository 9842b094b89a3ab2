"""The ring of sonars."""

from __future__ import annotations

import math

import pytest

pytest.importorskip("numpy", reason="the world needs numpy: install the extra sim")

import numpy as np

from sim.physics.noise import stream
from sim.robot import astrid
from sim.robot.sonar import Echoes, Sonar


@pytest.fixture
def sonar() -> Sonar:
    return Sonar(astrid.SONAR_ANGLES, astrid.SONAR_RING, astrid.SONAR_HEIGHT, stream(3, "sonar"))


def echoes(sonar: Sonar, distance: float, incidence: float = 0.0) -> Echoes:
    count = len(sonar.beams.starts)
    return Echoes(np.full(count, distance), np.full(count, incidence))


def test_beams_start_on_the_ring_and_fan_out_over_the_cone(sonar: Sonar) -> None:
    starts, directions = sonar.beams.starts, sonar.beams.directions
    assert np.hypot(starts[:, 0], starts[:, 1]) == pytest.approx(astrid.SONAR_RING)
    first = directions[: sonar.rays_per_cone]
    bearings = np.unwrap(np.arctan2(first[:, 1], first[:, 0]))
    assert bearings[-1] - bearings[0] == pytest.approx(sonar.cone)
    assert bearings.mean() == pytest.approx(sonar.angles[0])


def test_a_range_is_right_to_a_few_centimetres_and_counts_from_the_axis(sonar: Sonar) -> None:
    scans = [sonar.hear(echoes(sonar, 1.0)) for _ in range(50)]
    heard = [r for scan in scans for r in scan["ranges"] if r < scan["max_range"]]
    assert np.mean(heard) == pytest.approx(1.0 + astrid.SONAR_RING, abs=0.005)
    assert np.std(heard) == pytest.approx(0.02, abs=0.005)


def test_a_few_readings_drop_out(sonar: Sonar) -> None:
    scans = [sonar.hear(echoes(sonar, 1.0)) for _ in range(200)]
    lost = sum(r == scan["max_range"] for scan in scans for r in scan["ranges"])
    assert 0.003 < lost / (200 * 16) < 0.02


def test_each_sonar_hears_the_nearest_thing_in_its_cone(sonar: Sonar) -> None:
    mixed = echoes(sonar, 3.0)
    mixed.distance[2] = 0.5
    ranges = sonar.hear(mixed)["ranges"]
    assert ranges[0] == pytest.approx(0.5 + astrid.SONAR_RING, abs=0.06)
    assert min(ranges[1:]) > 2.5


def test_a_wall_hit_at_a_slant_is_not_heard(sonar: Sonar) -> None:
    scan = sonar.hear(echoes(sonar, 1.0, math.radians(70.0)))
    assert set(scan["ranges"]) == {scan["max_range"]}


def test_nothing_nearer_than_the_nearest_range_is_told_apart(sonar: Sonar) -> None:
    scan = sonar.hear(echoes(sonar, 0.01))
    heard = [r for r in scan["ranges"] if r < scan["max_range"]]
    assert heard == pytest.approx([sonar.nearest + astrid.SONAR_RING] * len(heard))


def test_a_scan_is_made_of_plain_numbers(sonar: Sonar) -> None:
    scan = sonar.hear(echoes(sonar, 1.0))
    assert len(scan["angles"]) == len(scan["ranges"]) == 16
    assert {type(value) for value in scan["angles"] + scan["ranges"]} == {float}
