"""Furniture as solids: what makes a sofa a sofa follows from its kind, what makes it this one from its Turtle.

Each builder is given a piece of furniture and yields solids in the piece's own frame: x along its width, y along its
depth, z up from its lowest point, the origin in the middle of its foot. A kind without a builder is drawn as a plain
block, so a new class in the ontology appears in the pictures before anybody has drawn it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from sim.home.floor_plan import Furniture
from sim.pictures.colours import mix, written
from sim.pictures.mesh import Array, Material, Solid, ball, box, cone, upright

Builder = Callable[[Furniture], Iterator[Solid]]

CHROME = Material("#c9ced6", gloss=0.6)
DARK = Material("#22252b", gloss=0.35)
LINEN = Material("#f6f3ec", grain="cloth")


def furnish(pieces: Sequence[Furniture]) -> list[Solid]:
    """Return the solids of all furniture that stands up from the floor; coverings are painted on it instead."""
    return [
        solid.moved(piece.x, piece.y, piece.z, piece.theta)
        for piece in pieces
        if piece.solid
        for solid in _BUILDERS.get(piece.kind, _block)(piece)
    ]


def _tint(
    piece: Furniture, towards: str = "#ffffff", share: float = 0.0, grain: str = "", gloss: float = 0.0
) -> Material:
    return Material(mix(written(piece.colour), towards, share), gloss, grain)


def _block(piece: Furniture) -> Iterator[Solid]:
    material = _tint(piece)
    if piece.round:
        yield cone(material, (0, 0, 0), piece.height, piece.width / 2, piece.width / 2)
    else:
        yield box(material, (0, 0, piece.height / 2), (piece.width, piece.depth, piece.height), 0.012)


def _sofa(piece: Furniture) -> Iterator[Solid]:
    w, d, h = piece.width, piece.depth, piece.height
    cloth, light = _tint(piece, grain="cloth"), _tint(piece, "#ffffff", 0.10, "cloth")
    arm, back, base = 0.11 * w, 0.24 * d, 0.30 * h
    for x in (-w / 2 + 0.08, w / 2 - 0.08):
        for y in (-d / 2 + 0.08, d / 2 - 0.08):
            yield cone(DARK, (x, y, 0), 0.06, 0.018, 0.024)
    yield box(cloth, (0, 0, 0.05 + base / 2), (w - 0.02, d - 0.02, base), 0.03)
    yield box(cloth, (0, d / 2 - back / 2, 0.05 + (h - 0.05) / 2), (w, back, h - 0.05), 0.05)
    for side in (-1, 1):
        yield box(cloth, (side * (w - arm) / 2, 0, 0.05 + 0.34 * h), (arm, d, 0.66 * h), 0.05)
        seat = (w - 2 * arm) / 2
        yield box(light, (side * seat / 2, -back / 2, 0.05 + base + 0.06), (seat - 0.012, d - back - 0.01, 0.15), 0.045)
        rest = _leaning(-0.20)
        yield box(light, (side * seat / 2, d / 2 - back - 0.06, 0.72 * h), (seat - 0.03, 0.13, 0.42 * h), 0.055, rest)
    for side, colour in ((-1, "#e3a72f"), (1, "#efe9dd")):
        turn = _leaning(-0.42) @ upright(side * -0.22)
        cushion = Material(colour, grain="cloth")
        yield box(cushion, (side * 0.29 * w, 0.02 * d, 0.05 + base + 0.28), (0.36, 0.12, 0.36), 0.058, turn)


def _leaning(angle: float) -> Array:
    """Return axes tilted backwards (towards +y at the top) by an angle about x."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, cosine, sine], [0.0, -sine, cosine]])


def _coffee_table(piece: Furniture) -> Iterator[Solid]:
    w, d, h = piece.width, piece.depth, piece.height
    wood, leg = _tint(piece, grain="wood", gloss=0.25), _tint(piece, "#000000", 0.25, "wood")
    yield box(wood, (0, 0, h - 0.02), (w, d, 0.04), 0.02)
    yield box(leg, (0, 0, h - 0.065), (w - 0.16, d - 0.16, 0.05))
    for x in (-w / 2 + 0.08, w / 2 - 0.08):
        for y in (-d / 2 + 0.08, d / 2 - 0.08):
            yield cone(leg, (x, y, 0), h - 0.04, 0.017, 0.028)
    for k, (colour, turn) in enumerate((("#2f5d8a", 0.25), ("#d5473c", 0.08))):
        yield box(
            Material(colour),
            (0.2 * w, 0.03, h + 0.012 + 0.024 * k),
            (0.26 - 0.02 * k, 0.19, 0.024),
            0.004,
            upright(turn),
        )
    yield cone(Material("#f4f1ea", gloss=0.3), (-0.26 * w, -0.08, h), 0.09, 0.034, 0.042)
    yield cone(Material("#4a2f1c", gloss=0.4), (-0.26 * w, -0.08, h + 0.0895), 0.001, 0.035, 0.035)


def _television_bench(piece: Furniture) -> Iterator[Solid]:
    w, d, h = piece.width, piece.depth, piece.height
    wood, front = _tint(piece, grain="wood"), _tint(piece, "#ffffff", 0.10, "wood")
    yield box(DARK, (0, 0, 0.03), (w - 0.08, d - 0.06, 0.06))
    yield box(wood, (0, -0.005, 0.05 + (h - 0.05) / 2), (w, d - 0.01, h - 0.05), 0.008)
    third = (w - 0.04) / 3
    for k in (-1, 0, 1):
        yield box(front, (k * third, d / 2 - 0.008, 0.05 + (h - 0.05) / 2), (third - 0.012, 0.02, h - 0.09), 0.006)


def _television(piece: Furniture) -> Iterator[Solid]:
    w, d, h = piece.width, piece.depth, piece.height
    case, screen = _tint(piece, "#ffffff", 0.05, gloss=0.3), Material("#0b0e14", gloss=0.9)
    stand = 0.12 * h
    yield box(case, (0, 0, 0.008), (0.34 * w, d * 2.6, 0.016), 0.006)
    yield box(case, (0, 0, stand / 2), (0.08 * w, d * 0.6, stand + 0.02))
    yield box(case, (0, -0.1 * d, stand + (h - stand) / 2), (w, d * 0.6, h - stand), 0.008)
    yield box(screen, (0, 0.2 * d, stand + (h - stand) / 2), (w - 0.024, 0.012, h - stand - 0.024), 0.003)


def _plant(piece: Furniture) -> Iterator[Solid]:
    r, h = piece.width / 2, piece.height
    pot = 0.42 * h
    yield cone(Material("#b4623f"), (0, 0, 0), pot, 0.62 * r, 0.9 * r)
    yield cone(Material("#bf6c48"), (0, 0, pot - 0.05), 0.05, 0.96 * r, 0.98 * r)
    yield cone(Material("#3a2a20"), (0, 0, pot - 0.005), 0.006, 0.9 * r, 0.9 * r)
    greens = [_tint(piece, tone, share) for tone, share in (("#000000", 0.12), ("#a6d64a", 0.16), ("#ffffff", 0.06))]
    golden = math.pi * (3.0 - math.sqrt(5.0))
    leaves = 34
    for k in range(leaves):
        # A spiral of leaves, from flat and long below to short and steep at the top, as a rosette grows.
        share = k / (leaves - 1)
        turn, rise = golden * k, -0.25 + 1.25 * share
        length = r * (0.62 - 0.26 * share)
        reach = r * (1.02 - 0.86 * share)
        height = pot + 0.06 + (h - pot - 0.16) * share
        centre = (math.cos(turn) * reach, math.sin(turn) * reach, height)
        tilt = _raised(rise) @ upright(turn)
        yield ball(greens[k % 3], centre, (length, 0.42 * length, 0.018), tilt)
    yield cone(Material("#4c5b2a"), (0, 0, pot), (h - pot) * 0.8, 0.018, 0.008)


def _raised(angle: float) -> Array:
    """Return axes whose x points upwards by an angle."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return np.array([[cosine, 0.0, sine], [0.0, 1.0, 0.0], [-sine, 0.0, cosine]])


def _kitchen_block(piece: Furniture) -> Iterator[Solid]:
    w, d, h = piece.width, piece.depth, piece.height
    body, front = _tint(piece), _tint(piece, "#ffffff", 0.28)
    top = Material("#6d5f55", gloss=0.25)
    yield box(DARK, (0.02, 0, 0.04), (w - 0.08, d - 0.06, 0.08))
    yield box(body, (0.01, 0, 0.08 + (h - 0.12) / 2), (w - 0.03, d - 0.01, h - 0.12))
    for k in (-1, 0, 1):
        third = d / 3
        yield box(front, (-w / 2 + 0.008, k * third, 0.08 + (h - 0.14) / 2), (0.022, third - 0.012, h - 0.16), 0.005)
        yield box(CHROME, (-w / 2 - 0.010, k * third, h - 0.15), (0.012, 0.6 * third, 0.012), 0.004)
    yield box(top, (0, 0, h - 0.02), (w, d, 0.04), 0.008)
    hob = 0.22 * d
    yield box(Material("#14161b", gloss=0.7), (0.01, hob, h + 0.003), (0.86 * w, 0.40 * d, 0.008), 0.003)
    for x in (-0.19 * w, 0.22 * w):
        for y, radius in ((hob - 0.1 * d, 0.085), (hob + 0.1 * d, 0.068)):
            yield cone(Material("#4b5059", gloss=0.3), (x, y, h + 0.006), 0.003, radius, radius)
            yield cone(Material("#1b1d22", gloss=0.5), (x, y, h + 0.0075), 0.003, radius - 0.012, radius - 0.012)
    sink = -0.20 * d
    yield box(CHROME, (0, sink, h + 0.002), (0.76 * w, 0.36 * d, 0.006), 0.003)
    yield box(Material("#8d949e", gloss=0.4), (-0.02, sink, h + 0.004), (0.58 * w, 0.28 * d, 0.006), 0.003)
    yield cone(CHROME, (0.30 * w, sink, h), 0.2, 0.014, 0.012)
    yield box(CHROME, (0.16 * w, sink, h + 0.2), (0.18, 0.022, 0.02), 0.008)


def _wardrobe(piece: Furniture) -> Iterator[Solid]:
    # Cut like the walls, or it would hide the room behind it: a doll's house is looked into from above.
    w, d, h = piece.width, piece.depth, min(piece.height, 1.35)
    wood, door = _tint(piece, grain="wood"), _tint(piece, "#ffffff", 0.10, "wood")
    yield box(DARK, (0, 0.02, 0.03), (w - 0.06, d - 0.08, 0.06))
    yield box(wood, (0, 0.01, 0.05 + (h - 0.05) / 2), (w, d - 0.02, h - 0.05), 0.008)
    for side in (-1, 1):
        yield box(door, (side * w / 4, -d / 2 + 0.012, 0.06 + (h - 0.1) / 2), (w / 2 - 0.012, 0.024, h - 0.12), 0.006)
        yield box(CHROME, (side * 0.035, -d / 2 - 0.006, 0.55 * h), (0.014, 0.014, 0.22), 0.005)
    yield box(door, (0, 0, h + 0.006), (w - 0.05, d - 0.07, 0.012), 0.005)


def _bed(piece: Furniture) -> Iterator[Solid]:
    w, d, h = piece.width, piece.depth, piece.height
    wood, cover = Material("#7a4e2c", grain="wood"), _tint(piece, grain="cloth")
    yield box(wood, (0, 0, 0.16), (w, d, 0.2), 0.012)
    yield box(wood, (w / 2 - 0.03, 0, 0.45), (0.06, d, 0.9), 0.02)
    for y in (-d / 2 + 0.06, d / 2 - 0.06):
        yield box(wood, (-w / 2 + 0.06, y, 0.05), (0.07, 0.07, 0.1))
    yield box(LINEN, (-0.03, 0, 0.24 + (h - 0.24) / 2), (w - 0.1, d - 0.06, h - 0.24), 0.06)
    quilt = 0.64 * w
    yield box(cover, (-w / 2 + quilt / 2 + 0.005, 0, h - 0.08), (quilt, d + 0.01, 0.24), 0.06)
    yield box(
        _tint(piece, "#ffffff", 0.55, "cloth"), (-w / 2 + quilt - 0.01, 0, h - 0.07), (0.2, d + 0.018, 0.24), 0.06
    )
    for side in (-1, 1):
        turn = _raised(0.30) @ upright(0.06 * side)
        yield box(LINEN, (w / 2 - 0.29, side * 0.24 * d, h + 0.07), (0.36, 0.38 * d, 0.15), 0.07, turn)


def _nightstand(piece: Furniture) -> Iterator[Solid]:
    w, d, h = piece.width, piece.depth, piece.height
    wood, front = _tint(piece, grain="wood"), _tint(piece, "#ffffff", 0.12, "wood")
    yield box(DARK, (0, 0, 0.025), (w - 0.05, d - 0.05, 0.05))
    yield box(wood, (0, 0, 0.04 + (h - 0.04) / 2), (w, d, h - 0.04), 0.01)
    for k in (0, 1):
        z = 0.07 + (h - 0.1) * (0.25 + 0.5 * k)
        yield box(front, (-w / 2, 0, z), (0.02, d - 0.05, (h - 0.1) / 2 - 0.015), 0.005)
        yield ball(CHROME, (-w / 2 - 0.018, 0, z), (0.014, 0.014, 0.014))


def _lamp(piece: Furniture) -> Iterator[Solid]:
    r, h = piece.width / 2, piece.height
    yield cone(Material("#5a4632", gloss=0.3), (0, 0, 0), 0.02, 0.6 * r, 0.5 * r)
    yield ball(Material("#5f7f8c", gloss=0.5), (0, 0, 0.24 * h), (0.48 * r, 0.48 * r, 0.22 * h))
    yield cone(CHROME, (0, 0, 0.4 * h), 0.2 * h, 0.012, 0.012)
    yield cone(Material(written(piece.colour)), (0, 0, 0.5 * h), 0.5 * h, r, 0.66 * r)


_BUILDERS: dict[str, Builder] = {
    "Bed": _bed,
    "CoffeeTable": _coffee_table,
    "KitchenBlock": _kitchen_block,
    "Lamp": _lamp,
    "Nightstand": _nightstand,
    "Plant": _plant,
    "Sofa": _sofa,
    "Television": _television,
    "TelevisionBench": _television_bench,
    "Wardrobe": _wardrobe,
}
