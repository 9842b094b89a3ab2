"""Blocks and walls."""

from __future__ import annotations

import math

import pytest

from sim.home.floor_plan import Block, Door, Wall

GREY = (0.5, 0.5, 0.5)


def test_the_distance_to_a_turned_box_is_that_to_its_side() -> None:
    box = Block("box", 1.0, 1.0, 0.0, math.pi / 2, 2.0, 0.4, 1.0, GREY)
    assert box.distance(1.7, 1.0) == pytest.approx(0.5)
    assert box.distance(1.0, 1.9) == 0.0


def test_the_distance_to_a_round_block_is_that_to_its_rim() -> None:
    pillar = Block("pillar", 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 2.0, GREY, round=True)
    assert pillar.distance(3.0, 4.0) == pytest.approx(4.5)
    assert pillar.distance(0.1, 0.1) == 0.0


def test_a_wall_is_open_where_its_door_is_and_closed_above_it() -> None:
    door = Door("iri", "door", 0.0, 2.5, math.pi / 2, 1.0, 2.0, ("a", "b"))
    wall = Wall("wall", 0.0, 2.0, 0.0, math.pi / 2, 4.0, 0.1, 2.5, GREY, doors=(door,))
    before, lintel, behind = wall.panels()
    assert (before.y, before.width, before.height) == pytest.approx((1.0, 2.0, 2.5))
    assert (behind.y, behind.width, behind.height) == pytest.approx((3.5, 1.0, 2.5))
    assert (lintel.y, lintel.width, lintel.z, lintel.height) == pytest.approx((2.5, 1.0, 2.0, 0.5))


def test_a_wall_without_doors_is_one_panel() -> None:
    (panel,) = Wall("wall", 1.0, 0.0, 0.0, 0.0, 4.0, 0.1, 2.5, GREY).panels()
    assert (panel.x, panel.width, panel.depth, panel.height) == (1.0, 4.0, 0.1, 2.5)
