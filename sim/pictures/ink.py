"""Ink: the few marks that a diagram is made of, and the two ways to put them on paper, as SVG and as an image."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from xml.etree import ElementTree

from PIL import Image, ImageDraw

from sim.pictures.arrays import Point
from sim.pictures.lettering import Style, printable, write
from sim.pictures.palette import PAPER

Curve = tuple[Point, Point, Point]
"""Two control points and the end of a cubic curve."""

FAMILY = "Aileron, 'Helvetica Neue', Helvetica, Arial, sans-serif"
_FINE = 4


@dataclass(frozen=True)
class Plate:
    """A rectangle with round corners; `line` is the colour of its border, "" for none. `title` is shown on hovering."""

    x: float
    y: float
    width: float
    height: float
    radius: float
    fill: str
    line: str = ""
    weight: float = 1.0
    title: str = ""


@dataclass(frozen=True)
class Stroke:
    """A line from a start through straight pieces (a point) and curves; `dash` is the length of dashes and gaps."""

    start: Point
    pieces: tuple[Point | Curve, ...]
    colour: str
    weight: float = 1.5
    dash: tuple[float, float] | None = None


@dataclass(frozen=True)
class Patch:
    """A filled polygon."""

    corners: tuple[Point, ...]
    fill: str


@dataclass(frozen=True)
class Words:
    """A line of text with its baseline at y; `anchor` is "left", "middle" or "right"."""

    x: float
    y: float
    text: str
    style: Style
    anchor: str = "left"


Mark = Plate | Stroke | Patch | Words


@dataclass(frozen=True)
class Drawing:
    """Marks on a paper of a size, drawn in order; `title` is its name for those who cannot see it."""

    width: float
    height: float
    title: str
    marks: Sequence[Mark] = field(default_factory=tuple)


def svg(drawing: Drawing) -> str:
    """Return a drawing as an SVG document; text is escaped, whatever it holds."""
    wide, high = f"{drawing.width:g}", f"{drawing.height:g}"
    root = ElementTree.Element(
        "svg",
        {
            "xmlns": "http://www.w3.org/2000/svg",
            "width": wide,
            "height": high,
            "viewBox": f"0 0 {wide} {high}",
            "role": "img",
        },
    )
    ElementTree.SubElement(root, "title").text = printable(drawing.title)
    ElementTree.SubElement(root, "rect", {"width": wide, "height": high, "fill": PAPER})
    for mark in drawing.marks:
        _element(root, mark)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode") + "\n"


def _element(root: ElementTree.Element, mark: Mark) -> None:
    def add(tag: str, **attributes: float | str) -> ElementTree.Element:
        given = {name.replace("_", "-"): _short(value) for name, value in attributes.items() if value != ""}
        return ElementTree.SubElement(root, tag, given)

    match mark:
        case Plate(x, y, width, height, radius, fill, line, weight, title):
            border = weight if line else ""
            plate = add(
                "rect", x=x, y=y, width=width, height=height, rx=radius, fill=fill, stroke=line, stroke_width=border
            )
            if title:
                ElementTree.SubElement(plate, "title").text = printable(title)
        case Stroke(start, pieces, colour, weight, dash):
            path = "M" + _at(start) + "".join(_piece(piece) for piece in pieces)
            stroke = add("path", d=path, fill="none", stroke=colour, stroke_width=weight, stroke_linecap="round")
            if dash is not None:
                stroke.set("stroke-dasharray", f"{dash[0]:g} {dash[1]:g}")
        case Patch(corners, fill):
            add("polygon", points=" ".join(_at(corner) for corner in corners), fill=fill)
        case Words(x, y, text, style, anchor):
            place = {"left": "", "middle": "middle", "right": "end"}[anchor]
            words = add("text", x=x, y=y, fill=style.colour, font_size=style.size, text_anchor=place)
            words.set("font-family", FAMILY)
            if style.weight > 0.5:
                words.set("font-weight", "600")
            words.text = printable(text)


def _short(value: float | str) -> str:
    return value if isinstance(value, str) else f"{value:.2f}".rstrip("0").rstrip(".")


def _at(point: Point) -> str:
    return f"{_short(point[0])},{_short(point[1])}"


def _piece(piece: Point | Curve) -> str:
    return "C" + " ".join(_at(point) for point in piece) if len(piece) == 3 else "L" + _at(piece)


def image(drawing: Drawing, scale: int = 2) -> Image.Image:
    """Return a drawing as an image with `scale` pixels for each of its units."""
    fine = scale * _FINE
    canvas = Image.new("RGB", (round(drawing.width * fine), round(drawing.height * fine)), PAPER)
    draw = ImageDraw.Draw(canvas)
    for mark in drawing.marks:
        match mark:
            case Plate(x, y, width, height, radius, fill, line, weight):
                half = weight / 2 if line else 0.0
                ends = (x - half, y - half, x + width + half, y + height + half)
                box = [end * fine for end in ends]
                draw.rounded_rectangle(box, (radius + half) * fine, fill, line or None, round(2 * half * fine))
            case Stroke():
                for line_ in _dashes(_flat(mark), mark.dash):
                    points = [(x * fine, y * fine) for x, y in line_]
                    draw.line(points, fill=mark.colour, width=round(mark.weight * fine), joint="curve")
            case Patch(corners, fill):
                draw.polygon([(x * fine, y * fine) for x, y in corners], fill=fill)
    page = canvas.resize((canvas.width // _FINE, canvas.height // _FINE), Image.Resampling.BOX)
    for mark in drawing.marks:
        if isinstance(mark, Words):
            style = replace(mark.style, size=mark.style.size * scale)
            write(page, mark.x * scale, mark.y * scale, mark.text, style, mark.anchor)
    return page


def _flat(stroke: Stroke) -> list[Point]:
    """Return a stroke as points a pixel or so apart."""
    points = [stroke.start]
    for piece in stroke.pieces:
        (x0, y0), curve = points[-1], piece if len(piece) == 3 else (points[-1], piece, piece)
        (x1, y1), (x2, y2), (x3, y3) = curve
        for k in range(1, 33):
            t, u = k / 32, 1 - k / 32
            a, b, c, d = u * u * u, 3 * u * u * t, 3 * u * t * t, t * t * t
            points.append((a * x0 + b * x1 + c * x2 + d * x3, a * y0 + b * y1 + c * y2 + d * y3))
    return points


def _dashes(points: Sequence[Point], dash: tuple[float, float] | None) -> list[list[Point]]:
    """Return a line cut into its dashes."""
    if dash is None:
        return [list(points)]
    found: list[list[Point]] = [[points[0]]]
    left, inked = dash[0], True
    for (x0, y0), (x1, y1) in itertools.pairwise(points):
        length = ((x1 - x0) ** 2 + (y1 - y0) ** 2) ** 0.5
        done = 0.0
        while length - done > left:
            done += left
            cut = (x0 + (x1 - x0) * done / length, y0 + (y1 - y0) * done / length)
            if inked:
                found[-1].append(cut)
            else:
                found.append([cut])
            inked = not inked
            left = dash[0] if inked else dash[1]
        left -= length - done
        if inked:
            found[-1].append((x1, y1))
    return [line for line in found if len(line) > 1]
