"""The configuration diagram: components as boxes with their ports, links between them, laid out by Graphviz.

The configurator lies below everything, and a dashed line leads to it from every component's FAIL.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from xml.etree.ElementTree import Element

from pygraphviz import AGraph

from sim.pictures.colours import BLUE, FAIL, INK, MIST, ORANGE, PAPER, SLATE, mix
from sim.pictures.svg import Attributes, Point, Style, add, badge, document, points, printable, shortened, width, write
from sim.pictures.wiring import Part, Wiring

TITLE, NAME, ROLE, PORT = Style(19, bold=True), Style(14.5, bold=True), Style(11, "#5b6372"), Style(12)
MARGIN, HEAD, TOP, ROW, PAD = 34.0, 66.0, 50.0, 22.0, 14.0
"""Space beside and above the boxes, the height of a box above its first port and of a port, and a box's padding."""
WIDEST, WIDEST_PORT = 250.0, 130.0
"""No name of a component, and no name of a port, is set wider than this, in pixels."""
BADGE = 62.0
"""Room beside a role for the badge of a component that failed or is new."""
LANE = 11.0
"""Space between the dashed lines that pass boxes on their left."""


@dataclass(eq=False)
class Box:
    """A component's place in the diagram, in pixels from the upper left corner."""

    part: Part
    width: float
    height: float
    x: float = 0.0
    y: float = 0.0


def draw_wiring(wiring: Wiring) -> Element:
    """Return the diagram of a configuration as an SVG document; it is as large as it needs to be."""
    boxes, curves = arrange(wiring)
    columns = [list(column) for _, column in groupby(sorted(boxes, key=lambda box: (box.x, box.y)), lambda box: box.x)]
    paths = [point for curve in curves for point in curve]
    right = max([box.x + box.width for box in boxes] + [x for x, _ in paths], default=300.0)
    bar = max([box.y + box.height for box in boxes] + [y for _, y in paths], default=HEAD + 40.0) + 50.0
    title = shortened(wiring.title, TITLE, max(right, 600.0) - MARGIN)
    wide = math.ceil(max(right + MARGIN, 2 * MARGIN + width(title, TITLE)))
    root = document(wide, math.ceil(bar + 68.0), wiring.title)
    add(root, "rect", width="100%", height="100%", fill=PAPER)
    for curve in curves:
        _link(root, curve)
    for column in columns:
        _alarms(root, column, bar)
    for box in boxes:
        _box(root, box)
    add(root, "rect", x=MARGIN - 14, y=bar, width=wide - 2 * MARGIN + 28, height=40, rx=10, fill=SLATE)
    write(root, MARGIN + 4, bar + 25, "configurator", replace(NAME, colour=PAPER))
    write(root, wide - MARGIN - 4, bar + 25, "listens to every FAIL", Style(12, MIST), "end")
    write(root, MARGIN, 38.0, title, TITLE)
    return root


def arrange(wiring: Wiring) -> tuple[list[Box], list[list[Point]]]:
    """Return the boxes of a configuration, and its links as the points of Bezier curves, each with its end last."""
    boxes = [_sized(part) for part in wiring.parts]
    _laid_out(wiring, boxes)
    _widen_columns(boxes)
    graph = _laid_out(wiring, boxes)
    curves = []
    for edge in graph.edges():
        end, *rest = edge.attr["pos"].removeprefix("e,").split(" ")
        curves.append([_point(place) for place in (*rest, end)])
    corners = [(box.x, box.y) for box in boxes] + [point for curve in curves for point in curve]
    left, top = min((x for x, _ in corners), default=0.0), min((y for _, y in corners), default=0.0)
    right = MARGIN + LANE * sum(box.x == left for box in boxes[1:]) - left
    for box in boxes:
        box.x, box.y = box.x + right, box.y + HEAD - top
    return boxes, [[(x + right, y + HEAD - top) for x, y in curve] for curve in curves]


def _widen_columns(boxes: Sequence[Box]) -> None:
    """Make the boxes of each column as wide as the widest of them."""
    for _, column in groupby(sorted(boxes, key=_middle), _middle):
        members = list(column)
        widest = max(member.width for member in members)
        for box in members:
            box.width = widest


def _middle(box: Box) -> float:
    return box.x + box.width / 2


def _sized(part: Part) -> Box:
    ports = [
        max((min(width(port, PORT), WIDEST_PORT) for port in side), default=0.0) for side in (part.inputs, part.outputs)
    ]
    role = min(width(part.role, ROLE), WIDEST) + (BADGE if part.failed or part.fresh else 0.0)
    wide = max(min(width(part.name, NAME), WIDEST), role, sum(ports) + 26.0, 96.0) + 2 * PAD
    return Box(part, 2 * math.ceil(wide / 2), TOP + ROW * max(len(part.inputs), len(part.outputs)) + 10.0)


def _laid_out(wiring: Wiring, boxes: Sequence[Box]) -> AGraph:
    """Have Graphviz place the boxes, as tables with a cell for each port; by number, as names may be hostile."""
    graph = AGraph(directed=True, strict=False, rankdir="LR", nodesep=0.45, ranksep=1.6)
    number = {box.part.name: k for k, box in enumerate(boxes)}
    for k, box in enumerate(boxes):
        rows = max(len(box.part.inputs), len(box.part.outputs))
        cells = "".join(
            f"<TR>{_cell(f'i{row}', box.width / 2, ROW)}{_cell(f'o{row}', box.width / 2, ROW)}</TR>"
            for row in range(rows)
        )
        above, below = (f"<TR>{_cell('', box.width, high, '2')}</TR>" for high in (TOP, 10.0))
        table = f'<<TABLE BORDER="0" CELLBORDER="0" CELLSPACING="0" CELLPADDING="0">{above}{cells}{below}</TABLE>>'
        graph.add_node(k, shape="plain", label=table)
    for link in wiring.links:
        source, sink = boxes[number[link.source]], boxes[number[link.sink]]
        tail, head = source.part.outputs.index(link.output), sink.part.inputs.index(link.input)
        ends = {"tailport": f"o{tail}:e", "headport": f"i{head}:w"}
        graph.add_edge(number[link.source], number[link.sink], arrowsize=0.9, **ends)
    graph.layout("dot")
    for k, box in enumerate(boxes):
        x, y = _point(graph.get_node(k).attr["pos"])
        box.x, box.y = x - box.width / 2, y - box.height / 2
    return graph


def _cell(port: str, wide: float, high: float, span: str = "1") -> str:
    return f'<TD PORT="{port}" COLSPAN="{span}" FIXEDSIZE="TRUE" WIDTH="{wide:g}" HEIGHT="{high:g}"></TD>'


def _point(place: str) -> Point:
    """Return a point of Graphviz, whose y axis points upwards, in pixels."""
    x, y = place.split(",")
    return float(x), -float(y)


def _box(root: Element, box: Box) -> None:
    part, room = box.part, box.width - 2 * PAD
    tone = FAIL if part.failed else ORANGE
    marked = part.failed or part.fresh
    line, weight = (tone, 1.9) if marked else (mix(INK, PAPER, 0.45), 1.2)
    fill = mix(tone, PAPER, 0.935) if marked else "#fbfcfd"
    size = {"x": box.x, "y": box.y, "width": box.width, "height": box.height, "rx": 8.0}
    add(root, "rect", **(size | {"x": box.x + 1.5, "y": box.y + 2.5}), fill=mix(MIST, PAPER, 0.55))
    plate = add(root, "rect", **size, fill=fill, stroke=line, stroke_width=weight)
    add(plate, "title").text = printable(f"{part.name} ({part.role})" if part.role else part.name)
    write(root, box.x + PAD, box.y + 18, shortened(part.role, ROLE, room), ROLE)
    name = replace(NAME, colour=FAIL if part.failed else INK)
    write(root, box.x + PAD, box.y + 37, shortened(part.name, NAME, room), name)
    if marked:
        word, ink = ("FAIL", PAPER) if part.failed else ("new", INK)
        badge(root, box.x + box.width - 9, box.y + 19, word, tone, Style(10.5, ink, bold=True), middle=True)
    sides = ((part.inputs, box.x, PAD, "start"), (part.outputs, box.x + box.width, -PAD, "end"))
    for ports, x, offset, anchor in sides:
        for k, port in enumerate(ports):
            y = box.y + TOP + ROW * (k + 0.5)
            add(root, "circle", cx=x, cy=y, r=3.5, fill=PAPER, stroke=line, stroke_width=1.4)
            write(root, x + offset, y + 4, shortened(port, PORT, WIDEST_PORT), PORT, anchor)


def _link(root: Element, curve: Sequence[Point]) -> None:
    """Draw a link: its curve up to the arrow head, and the head in front of the port's dot."""
    (x0, y0), (x, y) = curve[-2:]
    add(root, "path", d=f"M{points(curve[:1])} C{points(curve[1:-1])}", fill="none", stroke=BLUE, stroke_width=1.7)
    turn = f"rotate({math.degrees(math.atan2(y - y0, x - x0)):.1f} {x:.2f} {y:.2f})"
    add(root, "polygon", points=points([(x - 3.5, y), (x - 12, y - 4.6), (x - 12, y + 4.6)]), fill=BLUE, transform=turn)


def _alarms(root: Element, column: Sequence[Box], bar: float) -> None:
    """Draw the dashed lines from each FAIL of a column to the configurator, beside the boxes that are in between."""
    for k, box in enumerate(column):
        colour, weight = (FAIL, 2.6) if box.part.failed else (mix(FAIL, PAPER, 0.25), 1.2)
        x, start = box.x + 22.0, f"M{box.x + 22:g},{box.y + box.height + 3:g}"
        if box is not column[-1]:
            x, y = box.x - LANE * (len(column) - 1 - k) - 6.0, box.y + box.height - 12.0
            start = f"M{box.x - 3:g},{y:g} H{x + 8:g} Q{x:g},{y:g} {x:g},{y + 8:g}"
        line: Attributes = {"fill": "none", "stroke": colour, "stroke_width": weight, "stroke_dasharray": "4 4"}
        add(root, "path", d=f"{start} V{bar - 8:g}", stroke_linecap="round", **line)
        add(root, "polygon", points=points([(x, bar - 2), (x - 4, bar - 9), (x + 4, bar - 9)]), fill=FAIL)
