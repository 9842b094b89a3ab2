"""Layout of a configuration diagram: from the wiring alone to boxes in layers, sensors left, actuators right.

It is Sugiyama's, in small. Links that run backwards are set aside; each component stands one layer after the
last of its feeders; layers are ordered by the mean place of their neighbours, and the order with the fewest
crossings is kept; heights are pulled towards straight links. A link that passes over a layer gets a place of
its own there, as if it were a component, so that it runs between boxes and not over them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from sim.pictures.arrays import Point
from sim.pictures.lettering import Style, width
from sim.pictures.palette import BLUE, GREY, INK
from sim.pictures.wiring import Link, Part, Wiring

NAME = Style(14.5, INK, weight=1.0, tracking=0.008)
ROLE = Style(11, GREY)
PORT = Style(12, INK)
SIGNAL = Style(11, BLUE)

MARGIN, HEAD, ROW, PAD = 34.0, 66.0, 22.0, 14.0
TOP = 50.0
"""Height of a box above its first port, where its role and its name stand."""
WIDEST, WIDEST_PORT = 250.0, 130.0
"""No name of a component, and no name of a port or type of a signal, is set wider than this, in pixels."""
BADGE = 62.0
"""Room beside a role for the badge of a component that failed or is new."""
BETWEEN = 30.0
"""Space between two boxes of a layer."""
LANE = 11.0
"""Space between the dashed links that pass boxes on their left."""
CURVE = 84.0
"""Space that links need to curve between two layers, besides the words on them."""


@dataclass(eq=False)
class Box:
    """A place in a layer: a component, or (without a part) the place of a link that passes through."""

    part: Part | None
    layer: int
    width: float = 0.0
    height: float = 8.0
    x: float = 0.0
    y: float = 0.0
    before: list[Hop] = field(default_factory=list)
    after: list[Hop] = field(default_factory=list)

    def depth_of(self, name: str, output: bool) -> float:
        """Return how far below its upper edge a port lies."""
        if self.part is None:
            return self.height / 2.0
        ports = self.part.outputs if output else self.part.inputs
        return TOP + ROW * ([port.name for port in ports].index(name) + 0.5)

    def port(self, name: str, output: bool) -> Point:
        """Return where a port is: inputs are on the left, outputs on the right."""
        return (self.x + self.width if output else self.x), self.y + self.depth_of(name, output)


@dataclass(eq=False)
class Hop:
    """A piece of a link, between boxes of neighbouring layers, and how deep in each box it ends."""

    source: Box
    output: float
    sink: Box
    input: float


@dataclass(eq=False)
class Layout:
    """Where everything is: the layers of boxes from left to right, each from top to bottom.

    `ways` are the links with the boxes that each visits, `backward` the links that close a circle,
    `straight` says for each layer how far links run straight from it, to carry the words on them.
    """

    boxes: dict[str, Box]
    layers: list[list[Box]]
    ways: list[tuple[Link, list[Box]]]
    backward: list[Link]
    straight: list[float]

    @property
    def right(self) -> float:
        """Right end of the last box."""
        return max((box.x + box.width for layer in self.layers for box in layer), default=300.0)

    @property
    def bottom(self) -> float:
        """Lower end of the lowest box."""
        return max((box.y + box.height for layer in self.layers for box in layer), default=HEAD + 40.0)


def arrange(wiring: Wiring) -> Layout:
    """Return the layout of a configuration, in pixels from the upper left corner."""
    boxes = {part.name: _sized(part) for part in wiring.parts}
    forward, backward = _sorted_links(wiring)
    layers, ways = _layered(boxes, forward)
    _order(layers)
    straight = _columns(layers, wiring)
    _heights(layers)
    return Layout(boxes, layers, ways, backward, straight)


def _sized(part: Part) -> Box:
    left = max((min(width(port.name, PORT), WIDEST_PORT) for port in part.inputs), default=0.0)
    right = max((min(width(port.name, PORT), WIDEST_PORT) for port in part.outputs), default=0.0)
    name, role = min(width(part.name, NAME), WIDEST), min(width(part.role, ROLE), WIDEST)
    badge = BADGE if part.failed or part.fresh else 0.0
    wide = max(name, role + badge, left + right + 26.0, 96.0) + 2 * PAD
    high = TOP + ROW * max(len(part.inputs), len(part.outputs)) + 10.0
    return Box(part, 0, math.ceil(wide) + 1, math.ceil(high))


def _sorted_links(wiring: Wiring) -> tuple[list[Link], list[Link]]:
    """Return the links without those that close a circle, and those."""
    feeds: dict[str, list[Link]] = {part.name: [] for part in wiring.parts}
    for link in wiring.links:
        feeds[link.source].append(link)
    backward: list[Link] = []
    done: set[str] = set()
    for root in feeds:
        # Depth first, with a stack of its own: a chain of components may be longer than Python's stack.
        path: list[tuple[str, int]] = [(root, 0)] if root not in done else []
        active = {root}
        while path:
            name, k = path.pop()
            if k == len(feeds[name]):
                active.discard(name)
                done.add(name)
                continue
            path.append((name, k + 1))
            link = feeds[name][k]
            if link.sink in active:
                backward.append(link)
            elif link.sink not in done:
                active.add(link.sink)
                path.append((link.sink, 0))
    return [link for link in wiring.links if link not in backward], backward


def _layered(boxes: dict[str, Box], links: Sequence[Link]) -> tuple[list[list[Box]], list[tuple[Link, list[Box]]]]:
    """Put every box one layer after the last of its feeders; return layers, and the boxes of each link."""
    waiting = {name: sum(link.sink == name for link in links) for name in boxes}
    ready = [name for name, count in waiting.items() if count == 0]
    while ready:
        name = ready.pop()
        for link in links:
            if link.source == name:
                boxes[link.sink].layer = max(boxes[link.sink].layer, boxes[name].layer + 1)
                waiting[link.sink] -= 1
                if waiting[link.sink] == 0:
                    ready.append(link.sink)
    layers: list[list[Box]] = [[] for _ in range(max((box.layer for box in boxes.values()), default=-1) + 1)]
    for box in boxes.values():
        layers[box.layer].append(box)
    ways: list[tuple[Link, list[Box]]] = []
    for link in links:
        source, sink = boxes[link.source], boxes[link.sink]
        way = [source, *(Box(None, layer) for layer in range(source.layer + 1, sink.layer)), sink]
        for box in way[1:-1]:
            layers[box.layer].append(box)
        for first, second in pairwise(way):
            hop = Hop(first, first.depth_of(link.output, True), second, second.depth_of(link.input, False))
            first.after.append(hop)
            second.before.append(hop)
        ways.append((link, way))
    return layers, ways


def _order(layers: list[list[Box]]) -> None:
    """Order each layer by the mean place of the ports it is linked to, to and fro; keep the best order."""
    best, fewest = [list(layer) for layer in layers], _crossings(layers)
    for sweep in range(8):
        rightward = sweep % 2 == 0
        for layer in layers[1:] if rightward else layers[-2::-1]:
            place = _places(layers)
            mean = {box: _mean_place(box, place, rightward) for box in layer}
            layer.sort(key=mean.__getitem__)
        crossings = _crossings(layers)
        if crossings < fewest:
            best, fewest = [list(layer) for layer in layers], crossings
    layers[:] = best


def _places(layers: list[list[Box]]) -> dict[Box, int]:
    return {box: k for layer in layers for k, box in enumerate(layer)}


def _mean_place(box: Box, place: dict[Box, int], rightward: bool) -> float:
    """Return the mean place of the ports that a box is linked to in the layer before it, or after it."""
    if rightward:
        near = [place[hop.source] + hop.output / (hop.source.height + 1.0) for hop in box.before]
    else:
        near = [place[hop.sink] + hop.input / (hop.sink.height + 1.0) for hop in box.after]
    return sum(near) / len(near) if near else float(place[box])


def _crossings(layers: list[list[Box]]) -> int:
    """Return how many pairs of links cross."""
    place = _places(layers)
    found = 0
    for layer in layers:
        hops = [hop for box in layer for hop in box.after]
        ends = sorted(((place[h.source], h.output), (place[h.sink], h.input)) for h in hops)
        for k, one in enumerate(ends):
            found += sum(one[0] < other[0] and one[1] > other[1] for other in ends[k + 1 :])
    return found


def _columns(layers: list[list[Box]], wiring: Wiring) -> list[float]:
    """Set x and width of all boxes; return for each layer how far its links run straight."""
    signals = {(part.name, port.name): port.signal for part in wiring.parts for port in part.outputs}
    straight: list[float] = []
    x = MARGIN + LANE * max((len(layer) - 1 for layer in layers[:1]), default=0)
    for layer in layers:
        wide = max(box.width for box in layer)
        for box in layer:
            box.width, box.x = wide, x
        names = {box.part.name for box in layer if box.part is not None}
        leaving = [link for link in wiring.links if link.source in names]
        words = [min(width(signals[link.source, link.output], SIGNAL), WIDEST_PORT) for link in leaving]
        straight.append(max(words, default=0.0) + 16.0)
        x += wide + straight[-1] + CURVE + LANE * max(len(layer) - 2, 0)
    return straight


def _heights(layers: list[list[Box]]) -> None:
    """Stack each layer, then pull boxes to where their links would be straight, as far as there is room."""
    for layer in layers:
        y = -(sum(box.height for box in layer) + BETWEEN * (len(layer) - 1)) / 2.0
        for box in layer:
            box.y = y
            y += box.height + BETWEEN
    for sweep in range(12):
        for layer in layers if sweep % 2 == 0 else layers[::-1]:
            for box in layer:
                rises = [hop.source.y + hop.output - box.y - hop.input for hop in box.before]
                rises += [hop.sink.y + hop.input - box.y - hop.output for hop in box.after]
                box.y += sum(rises) / len(rises) if rises else 0.0
            _spread(layer)
    top = min((box.y for layer in layers for box in layer), default=HEAD)
    for layer in layers:
        for box in layer:
            box.y = round(box.y + HEAD - top)


def _spread(layer: list[Box]) -> None:
    """Move boxes of a layer apart where they would overlap, as much up as down."""
    for _ in range(20):
        for upper, lower in pairwise(layer):
            lack = upper.y + upper.height + BETWEEN - lower.y
            if lack > 0.0:
                upper.y -= lack / 2.0
                lower.y += lack / 2.0
    for upper, lower in pairwise(layer):
        lower.y = max(lower.y, upper.y + upper.height + BETWEEN)
