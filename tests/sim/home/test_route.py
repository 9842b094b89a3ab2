"""Ways through the apartment."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import pytest

from sim.home.apartment import Apartment
from sim.home.floor_plan import Furniture
from sim.home.route import RouteError, RouteMap

START, BEDROOM = (0.96, 1.75), (5.4, 1.2)


def points_of(way: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Points every centimetre or so along a way."""
    return [
        (ax + k / 200 * (bx - ax), ay + k / 200 * (by - ay)) for (ax, ay), (bx, by) in pairwise(way) for k in range(201)
    ]


def test_the_way_to_the_bedroom_leads_through_the_door(apartment: Apartment) -> None:
    door = apartment.doors[0]
    points = points_of(RouteMap(apartment, 0.38).way(START, BEDROOM))
    crossing = min(points, key=lambda point: abs(point[0] - door.x))
    assert abs(crossing[1] - door.y) < door.width / 2 - 0.35


def test_a_way_keeps_its_distance(apartment: Apartment) -> None:
    points = points_of(RouteMap(apartment, 0.38).way(START, BEDROOM))
    blocks = [panel for wall in apartment.walls for panel in wall.panels() if panel.z == 0.0]
    blocks += [piece for piece in apartment.furniture if piece.solid]
    assert min(block.distance(*point) for block in blocks for point in points) > 0.379


def test_a_way_leads_round_furniture(apartment: Apartment) -> None:
    ways = RouteMap(apartment, 0.38)
    west, east = (0.4, 2.5), (2.4, 2.5)
    way = ways.way(west, east)
    assert len(way) == 4
    table = next(piece for piece in apartment.furniture if piece.name == "coffee-table")
    assert min(table.distance(*point) for point in points_of(way)) > 0.379
    assert math.dist(west, east) < sum(math.dist(a, b) for a, b in pairwise(way)) < 3.5


def test_who_stands_too_close_to_something_may_leave_it(apartment: Apartment) -> None:
    beside_the_bench = (1.6, 0.7)
    assert RouteMap(apartment, 0.38).way(beside_the_bench, BEDROOM)[0] == beside_the_bench


def test_where_no_way_leads_it_says_so(apartment: Apartment) -> None:
    crate = Furniture("crate", 3.75, 0.99, 0.0, 0.0, 0.5, 0.8, 1.0, (0.5, 0.5, 0.5))
    blocked = replace(apartment, furniture=(*apartment.furniture, crate))
    with pytest.raises(RouteError, match=r"no way leads from \(0.96, 1.75\) to \(5.40, 1.20\)"):
        RouteMap(blocked, 0.38).way(START, BEDROOM)
