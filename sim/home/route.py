"""The shortest way through the apartment for a robot that keeps its distance from walls and furniture.

Among straight-sided obstacles a shortest way bends only at their corners. So the graph has a node at
every corner of every wall panel and every piece of furniture, set off by the robot's clearance; nodes
that see each other are joined, and Dijkstra does the rest. A doorway needs no rule of its own: it is
where the grown panels of a wall leave a gap, and the corners beside it lead squarely through.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Iterator

from sim.geometry import Pose
from sim.home.apartment import Apartment
from sim.home.floor_plan import Block

Spot = tuple[float, float]


class RouteError(Exception):
    """There is no way from `start` to `goal`, both (x, y) in metres."""

    def __init__(self, start: Spot, goal: Spot) -> None:
        super().__init__(start, goal)
        self.start, self.goal = start, goal

    def __str__(self) -> str:
        (x, y), (u, v) = self.start, self.goal
        return f"no way leads from ({x:.2f}, {y:.2f}) to ({u:.2f}, {v:.2f}): is something standing between them?"


class RouteMap:
    """The ways through an apartment that stay `clearance` metres away from everything solid."""

    def __init__(self, apartment: Apartment, clearance: float) -> None:
        self._clearance = clearance
        panels = [panel for wall in apartment.walls for panel in wall.panels() if panel.z == 0.0]
        blocks: list[Block] = [*panels, *(piece for piece in apartment.furniture if piece.solid)]
        self._obstacles = [_Obstacle(block) for block in blocks]
        corners = [spot for block in blocks for spot in _corners(block, clearance + 0.01)]
        self._nodes = [spot for spot in corners if apartment.room_at(*spot) and self._is_clear(spot)]
        self._seen = {spot: [other for other in self._nodes if self._sees(spot, other)] for spot in self._nodes}

    def way(self, start: Spot, goal: Spot) -> list[Spot]:
        """Return the corners of the shortest way from start to goal, both included; or raise RouteError."""
        best, before = {start: 0.0}, dict[Spot, Spot]()
        queue = [(0.0, start)]
        while queue:
            cost, here = heapq.heappop(queue)
            if here == goal:
                return _trace(before, goal)
            if cost > best[here]:
                continue
            known = self._seen.get(here)
            ahead = known if known is not None else [spot for spot in self._nodes if self._sees(here, spot)]
            for there in [*ahead, goal] if self._sees(here, goal) else ahead:
                longer = cost + math.dist(here, there)
                if longer < best.get(there, math.inf):
                    best[there], before[there] = longer, here
                    heapq.heappush(queue, (longer, there))
        raise RouteError(start, goal)

    def _is_clear(self, spot: Spot) -> bool:
        return all(one.gap(one.local(spot)) >= self._clearance for one in self._obstacles)

    def _sees(self, a: Spot, b: Spot) -> bool:
        for obstacle in self._obstacles:
            here, there = obstacle.local(a), obstacle.local(b)
            # A robot closer to something than the clearance may leave it, but not come closer.
            margin = min(self._clearance, obstacle.gap(here), obstacle.gap(there)) - 1e-6
            if obstacle.meets(here, there, margin):
                return False
        return True


class _Obstacle:
    """A block in a frame of its own, in which its sides lie along the axes."""

    def __init__(self, block: Block) -> None:
        frame = Pose(block.x, block.y, block.theta).inverse()
        self._x, self._y = frame.x, frame.y
        self._cosine, self._sine = math.cos(frame.theta), math.sin(frame.theta)
        self._halves = block.width / 2, block.depth / 2

    def local(self, spot: Spot) -> Spot:
        """Return a spot as the block sees it."""
        x, y = spot
        return self._x + self._cosine * x - self._sine * y, self._y + self._sine * x + self._cosine * y

    def gap(self, spot: Spot) -> float:
        """Return by how much the sides may be moved outwards before they reach a local spot; negative inside."""
        (x, y), (width, depth) = spot, self._halves
        return max(abs(x) - width, abs(y) - depth)

    def meets(self, a: Spot, b: Spot, margin: float) -> bool:
        """Say whether the segment between two local spots meets the block, its sides moved outwards (slab method)."""
        enter, leave = 0.0, 1.0
        for start, end, side in zip(a, b, self._halves, strict=True):
            half, way = side + margin, end - start
            if abs(way) < 1e-12:
                if abs(start) >= half:
                    return False
                continue
            first, second = sorted(((-half - start) / way, (half - start) / way))
            enter, leave = max(enter, first), min(leave, second)
        return enter < leave


def _corners(block: Block, margin: float) -> Iterator[Spot]:
    frame = Pose(block.x, block.y, block.theta)
    for x in (-1, 1):
        for y in (-1, 1):
            corner = frame.compose(Pose(x * (block.width / 2 + margin), y * (block.depth / 2 + margin)))
            yield corner.x, corner.y


def _trace(before: dict[Spot, Spot], goal: Spot) -> list[Spot]:
    way = [goal]
    while way[-1] in before:
        way.append(before[way[-1]])
    return way[::-1]
