"""The configuration diagram: components as boxes with their ports, links with the type of what flows.

The configurator lies below everything, and a dashed link leads to it from every component's FAIL.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from sim.pictures.arrays import Point
from sim.pictures.ink import Curve, Drawing, Mark, Patch, Plate, Stroke, Words
from sim.pictures.layout import LANE, MARGIN, NAME, PAD, PORT, ROLE, SIGNAL, WIDEST_PORT, Box, Layout, arrange
from sim.pictures.lettering import Style, shortened, width
from sim.pictures.palette import BLUE, FAIL, INK, MIST, ORANGE, PAPER, mix
from sim.pictures.wiring import Link, Wiring

TITLE = Style(19, INK, weight=1.0, tracking=0.006)
BADGE = Style(10.5, PAPER, weight=0.8, tracking=0.02)
BAR = "#2d3442"


def draw_wiring(wiring: Wiring) -> Drawing:
    """Return the diagram of a configuration; it is as large as it needs to be."""
    layout = arrange(wiring)
    lanes = _Lanes(layout.bottom + 16.0)
    marks: list[Mark] = []
    for link, way in layout.ways:
        marks += _link(link, way, layout.straight)
    for link in layout.backward:
        marks += _back(link, layout, lanes)
    bar = lanes.y + 34.0
    for layer in layout.layers:
        marks += _alarms(layer, bar)
    for box in layout.boxes.values():
        marks += _box(box)
    title = shortened(wiring.title, TITLE, max(layout.right, 600.0) - MARGIN)
    wide = max(layout.right + MARGIN, 2 * MARGIN + width(title, TITLE))
    marks += [*_signals(wiring, layout), *_configurator(bar, wide), Words(MARGIN, 38.0, title, TITLE)]
    return Drawing(round(wide), round(bar + 68.0), wiring.title, marks)


def _box(box: Box) -> list[Mark]:
    part = box.part
    if part is None:
        return []
    tone = FAIL if part.failed else ORANGE
    marked = part.failed or part.fresh
    line, heavy = (tone, 1.9) if marked else (mix(INK, PAPER, 0.45), 1.2)
    fill = mix(tone, PAPER, 0.935) if marked else "#fbfcfd"
    whole = f"{part.name} ({part.role})" if part.role else part.name
    name = replace(NAME, colour=FAIL) if part.failed else NAME
    room = box.width - 2 * PAD
    marks: list[Mark] = [
        Plate(box.x + 1.5, box.y + 2.5, box.width, box.height, 9, mix(MIST, PAPER, 0.55)),
        Plate(box.x, box.y, box.width, box.height, 8, fill, line, heavy, whole),
        Words(box.x + PAD, box.y + 18, shortened(part.role, ROLE, room), ROLE),
        Words(box.x + PAD, box.y + 37, shortened(part.name, NAME, room), name),
    ]
    if marked:
        marks += _badge(box, "FAIL" if part.failed else "new", tone, PAPER if part.failed else INK)
    for port in part.inputs:
        x, y = box.port(port.name, output=False)
        marks += [_dot(x, y, line), Words(x + PAD, y + 4, shortened(port.name, PORT, WIDEST_PORT), PORT)]
    for port in part.outputs:
        x, y = box.port(port.name, output=True)
        marks += [_dot(x, y, line), Words(x - PAD, y + 4, shortened(port.name, PORT, WIDEST_PORT), PORT, "right")]
    return marks


def _badge(box: Box, text: str, colour: str, ink: str) -> list[Mark]:
    style = replace(BADGE, colour=ink)
    wide = width(text, style) + 14
    left = box.x + box.width - wide - 9
    return [
        Plate(left, box.y + 7, wide, 16, 8, colour),
        Words(left + wide / 2, box.y + 18.6, text, style, "middle"),
    ]


def _dot(x: float, y: float, colour: str) -> Plate:
    return Plate(x - 3.5, y - 3.5, 7, 7, 3.5, PAPER, colour, 1.4)


def _signals(wiring: Wiring, layout: Layout) -> list[Mark]:
    """Return the types of the signals, each once beside the output that it leaves by."""
    linked = {(link.source, link.output) for link in wiring.links}
    marks: list[Mark] = []
    for part in wiring.parts:
        for port in part.outputs:
            if (part.name, port.name) in linked:
                x, y = layout.boxes[part.name].port(port.name, output=True)
                marks.append(Words(x + 11, y - 5, shortened(port.signal, SIGNAL, WIDEST_PORT), SIGNAL))
    return marks


def _link(link: Link, way: Sequence[Box], straight: Sequence[float]) -> list[Mark]:
    """Return a link: straight out of its output, under the words, then curved to its input."""
    x, y = way[0].port(link.output, output=True)
    at = (x + straight[way[0].layer], y)
    pieces: list[Point | Curve] = [at]
    for box in way[1:]:
        end = box.port(link.input, output=False)
        pieces.append(_bend(at, (end[0] - 9.0, end[1]) if box is way[-1] else end))
        if box is not way[-1]:
            at = (box.x + box.width + straight[box.layer], end[1])
            pieces.append(at)
    return [Stroke((x + 4, y), tuple(pieces), BLUE, 1.7), _head(*way[-1].port(link.input, output=False))]


def _bend(start: Point, end: Point) -> Curve:
    half = (end[0] - start[0]) * 0.55
    return (start[0] + half, start[1]), (end[0] - half, end[1]), end


def _head(x: float, y: float) -> Patch:
    """Return the arrow head of a link that ends in the input at a point."""
    return Patch(((x - 3.5, y), (x - 12, y - 4.6), (x - 12, y + 4.6)), BLUE)


@dataclass
class _Lanes:
    """Free heights below the boxes, one for each link that runs backwards."""

    y: float

    def take(self) -> float:
        """Return the next free height."""
        self.y += 14.0
        return self.y - 14.0


def _back(link: Link, layout: Layout, lanes: _Lanes) -> list[Mark]:
    """Return a link that runs backwards: down, along a lane of its own below all boxes, and up."""
    x0, y0 = layout.boxes[link.source].port(link.output, output=True)
    x1, y1 = layout.boxes[link.sink].port(link.input, output=False)
    lane, right, left, r = lanes.take(), x0 + 14.0, x1 - 22.0, 10.0
    pieces: tuple[Point | Curve, ...] = (
        _corner((right, y0), (right, y0 + r)),
        (right, lane - r),
        _corner((right, lane), (right - r, lane)),
        (left + r, lane),
        _corner((left, lane), (left, lane - r)),
        (left, y1 + r),
        _corner((left, y1), (left + r, y1)),
        (x1 - 9, y1),
    )
    return [Stroke((x0 + 4, y0), pieces, BLUE, 1.7), _head(x1, y1)]


def _corner(corner: Point, end: Point) -> Curve:
    return corner, corner, end


def _alarms(layer: Sequence[Box], bar: float) -> list[Mark]:
    """Return the dashed links from each FAIL to the configurator, beside the boxes that are in between."""
    boxes = [box for box in layer if box.part is not None]
    marks: list[Mark] = []
    for k, box in enumerate(boxes):
        failed = box.part is not None and box.part.failed
        colour, heavy = (FAIL, 2.6) if failed else (mix(FAIL, PAPER, 0.25), 1.2)
        pieces: tuple[Point | Curve, ...]
        if box is boxes[-1] and box is layer[-1]:
            x, start = box.x + 22.0, (box.x + 22.0, box.y + box.height + 3)
            pieces = ((x, bar - 8),)
        else:
            x, y = box.x - LANE * (len(boxes) - 1 - k) - 6.0, box.y + box.height - 12.0
            start = (box.x - 3, y)
            pieces = ((x + 8, y), _corner((x, y), (x, y + 8)), (x, bar - 8))
        marks.append(Stroke(start, pieces, colour, heavy, (4.0, 4.0)))
        marks.append(Patch(((x, bar - 2), (x - 4, bar - 9), (x + 4, bar - 9)), FAIL))
    return marks


def _configurator(y: float, wide: float) -> list[Mark]:
    name, remark = Style(14.5, PAPER, weight=1.0, tracking=0.01), Style(12, MIST)
    return [
        Plate(MARGIN - 14, y, wide - 2 * MARGIN + 28, 40, 10, BAR),
        Words(MARGIN + 4, y + 25, "configurator", name),
        Words(wide - MARGIN - 4, y + 25, "listens to every FAIL", remark, "right"),
    ]
