"""The lit scene: solids, a floor with a picture on it, one sun and a sky, rendered by Mitsuba and denoised by OIDN.

Mitsuba traces a few light paths for each pixel, with light that goes from wall to wall; Open Image Denoise makes of
that what hundreds of paths would show. The ground outside is white paper: exposure is chosen so that it is exactly
white where nothing keeps the light away. The robot is the only thing that moves: it is a group of its own, and all else
is another, so that nothing but where the groups stand is sorted anew when it does.
"""

from __future__ import annotations

import math
import tempfile
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import mitsuba
import mitsuba_oidn
import numpy as np

from sim.pictures.colours import linear
from sim.pictures.mesh import Array, Material, Solid, Vector
from sim.pictures.record import Sample
from sim.pictures.viewpoint import Viewpoint, Window

mitsuba.set_variant("scalar_rgb")

SLAB = 0.12
"""How far the floor lies above the ground outside, in metres."""
SUN_FROM: Vector = (-0.50, 0.42, 0.84)
SUN_RADIUS = 0.035
"""Half the angle of the sun's disc in radians: seven times the real one, for shadows that soften within a room."""
SUN, SKY = np.array([1.0, 0.93, 0.82]) * 0.76, np.array([0.90, 0.96, 1.04]) * 0.42
"""The share of the light on level ground that comes from the sun, and from the sky."""
GROUND = 0.9
Palettes = Mapping[float, tuple[str, ...]]
"""Colours "#rrggbb" by the gloss of what has them."""
_TILE = 512
_PLY = b"""ply
format binary_little_endian 1.0
element vertex %d
property float x
property float y
property float z
property float nx
property float ny
property float nz
property float u
property float v
element face %d
property list uchar int vertex_indices
end_header
"""
_GRAINS = {"wood": (34.0, 900.0, 0.075), "cloth": (900.0, 900.0, 0.05)}
"""For each grain, how many pixels of noise a metre has along it and across, and how strong the noise is."""


class Scene:
    """A lit scene; floor pictures are linear colours (h, w, 3) from north to south of an extent in metres."""

    def __init__(
        self, solids: Sequence[Solid], robot: Sequence[Solid], extent: tuple[float, float, float, float], floor: Array
    ) -> None:
        west, south, east, north = extent
        middle = [(west + east) / 2, (south + north) / 2, 0.0]
        towards = np.asarray(SUN_FROM) / math.hypot(*SUN_FROM)
        # Far and small, and of such a radiance that the sun's share falls on level ground.
        disc = _transform().look_at(origin=(middle + 60.0 * towards).tolist(), target=middle, up=[0, 0, 1])
        radiance = SUN / (SUN_RADIUS**2 * towards[2])
        outside, inside = _transform().translate([*middle[:2], -SLAB]), _transform().translate([*middle[:2], 0.001])
        palettes = _palettes([*solids, *robot])
        scene: dict[str, Any] = {
            "type": "scene",
            "sun": {
                "type": "disk",
                "to_world": disc.scale(60.0 * SUN_RADIUS),
                "emitter": {"type": "area", "radiance": _rgb(radiance)},
            },
            "sky": {"type": "constant", "radiance": _rgb(SKY)},
            "ground": {
                "type": "rectangle",
                "to_world": outside.scale(40.0),
                "bsdf": {"type": "diffuse", "reflectance": _rgb(np.full(3, GROUND))},
            },
            "floor": {
                "type": "rectangle",
                "to_world": inside.scale([(east - west) / 2, (north - south) / 2, 1.0]),
                "bsdf": {"type": "diffuse", "reflectance": _bitmap(floor[::-1])},
            },
            "still": {"type": "shapegroup", **_shapes(solids, palettes)},
            "house": {"type": "instance", "shapegroup": {"type": "ref", "id": "still"}},
            "moving": {"type": "shapegroup", **_shapes(robot, palettes)},
            "robot": {"type": "instance", "shapegroup": {"type": "ref", "id": "moving"}, "to_world": _standing(None)},
        }
        self.scene = mitsuba.load_dict(scene)
        self.integrator = mitsuba.load_dict({"type": "path", "max_depth": 4})
        self.parameters = mitsuba.traverse(self.scene)

    def change(self, at: Sample | None, floor: Array | None = None) -> None:
        """Put the robot somewhere, or (None) far below the ground; give the floor another picture of its size."""
        self.parameters["robot.to_world"] = _standing(at)
        if floor is not None:
            pixels = np.ascontiguousarray(floor[::-1], np.float32)
            self.parameters["floor.bsdf.reflectance.data"] = mitsuba.TensorXf(pixels)
        self.parameters.update()

    def picture(self, view: Viewpoint, samples: int, window: Window | None = None) -> Array:
        """Return the intensities (h, w, 3) of a window of a view (all of it if None), from `samples` paths a pixel."""
        left, top, right, bottom = window or (0, 0, *view.size)
        sensor = {
            "type": "perspective",
            "fov": 2.0 * math.degrees(math.atan(view.size[0] / 2.0 / view.zoom)),
            "fov_axis": "x",
            "near_clip": 0.1,
            "far_clip": 2000.0,
            "principal_point_offset_x": 0.5 - view.middle[0] / view.size[0],
            "principal_point_offset_y": 0.5 - view.middle[1] / view.size[1],
            "to_world": _transform().look_at(
                origin=view.eye.tolist(), target=(view.eye + view.axes[0]).tolist(), up=view.axes[2].tolist()
            ),
            "sampler": {"type": "multijitter", "sample_count": samples},
            "film": {
                "type": "hdrfilm",
                "width": view.size[0],
                "height": view.size[1],
                "crop_offset_x": left,
                "crop_offset_y": top,
                "crop_width": right - left,
                "crop_height": bottom - top,
                "pixel_format": "rgb",
                "component_format": "float32",
                "rfilter": {"type": "box"},
            },
        }
        light = mitsuba.render(self.scene, sensor=mitsuba.load_dict(sensor), integrator=self.integrator, spp=samples)
        return _exposed(mitsuba_oidn.denoise(np.array(light, np.float32), hdr=True))


def _standing(at: Sample | None) -> Any:
    """Return how the robot is put somewhere, or far below the ground."""
    turn = _transform().rotate([0, 0, 1], math.degrees(at.theta) if at else 0.0)
    return _transform().translate([at.x, at.y, 0.0] if at else [0.0, 0.0, -9.0]) @ turn


def _exposed(light: Array) -> Array:
    """Return intensities in which open ground is 1, with the brightest pressed together, as film does."""
    knee = 0.7

    def shoulder(value: Array) -> Array:
        return np.where(value > knee, knee + (1.0 - knee) * (1.0 - np.exp((knee - value) / (1.0 - knee))), value)

    return np.asarray(shoulder(light) / shoulder(GROUND * (SUN + SKY)), np.float32)


def _palettes(solids: Sequence[Solid]) -> Palettes:
    """Return the colours of the solids that have no grain, by their gloss."""
    colours: dict[float, set[str]] = defaultdict(set)
    for material in (solid.material for solid in solids if not solid.material.grain):
        colours[material.gloss].add(material.colour)
    return {gloss: tuple(sorted(some)) for gloss, some in colours.items()}


def _shapes(solids: Sequence[Solid], palettes: Palettes) -> dict[str, Any]:
    """Return solids as shapes for Mitsuba, one for each surface."""
    groups: dict[Any, list[Solid]] = defaultdict(list)
    for solid in solids:
        material = solid.material
        if material.grain:
            groups[_grained(material)].append(solid)
        else:
            palette = palettes[material.gloss]
            place = (palette.index(material.colour) + 0.5) / len(palette)
            coloured = replace(solid, texture=np.full_like(solid.texture, (place, 0.5)))
            groups[_plain(material.gloss, palette)].append(coloured)
    return {f"shape{k}": _mesh(surface, members) for k, (surface, members) in enumerate(groups.items())}


def _mesh(surface: Any, solids: Sequence[Solid]) -> Any:
    starts = np.cumsum([0, *(len(solid.points) for solid in solids)])
    corners = np.concatenate([np.hstack([solid.points, solid.normals, solid.texture]) for solid in solids])
    faces = np.empty(sum(len(solid.faces) for solid in solids), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"] = 3
    faces["corners"] = np.concatenate([solid.faces + start for solid, start in zip(solids, starts, strict=False)])
    # A mesh that Python made calls back into Python for every ray; one that was read from a file does not.
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "mesh.ply"
        path.write_bytes(_PLY % (len(corners), len(faces)) + corners.astype("<f4").tobytes() + faces.tobytes())
        return mitsuba.load_dict({"type": "ply", "filename": str(path), "bsdf": surface})


@lru_cache(maxsize=256)
def _grained(material: Material) -> Any:
    """Return how a material with a grain scatters light."""
    along, across, strength = _GRAINS[material.grain]
    to_uv = _transform().scale([along / _TILE, across / _TILE, 1.0])
    tones = _bitmap(linear(material.colour) * (1.0 + strength * tile()[..., None]))
    return _surface(material.gloss, tones | {"to_uv": to_uv})


@lru_cache(maxsize=256)
def _plain(gloss: float, palette: tuple[str, ...]) -> Any:
    """Return how all materials of one gloss and no grain scatter light; their colours lie side by side in a texture.

    Mitsuba tabulates a glossy surface for 50 ms, whatever its colour, so colours and scenes share it. What is of
    another gloss has to stay out: the mean of the texture says how many paths look for a reflection.
    """
    return _surface(gloss, _bitmap(np.array([[linear(colour) for colour in palette]])) | {"filter_type": "nearest"})


def _surface(gloss: float, texture: dict[str, Any]) -> Any:
    bsdf: dict[str, Any] = {"type": "diffuse", "reflectance": texture}
    if gloss:
        bsdf = {"type": "roughplastic", "diffuse_reflectance": texture, "alpha": 0.42 - 0.35 * gloss, "int_ior": 1.3}
    return mitsuba.load_dict({"type": "twosided", "one": bsdf})


def _rgb(colour: Array) -> dict[str, Any]:
    return {"type": "rgb", "value": np.asarray(colour, np.float64).tolist()}


def _bitmap(pixels: Array) -> dict[str, Any]:
    data = mitsuba.TensorXf(np.ascontiguousarray(np.clip(pixels, 0.0, 1.0), np.float32))
    return {"type": "bitmap", "data": data, "raw": True}


def _transform() -> Any:
    return mitsuba.ScalarTransform4f()


@lru_cache(maxsize=1)
def tile() -> Array:
    """Return a tile of noise about 0 with a deviation of 1 and no seam, smooth over some three pixels."""
    white = np.random.default_rng(8).standard_normal((_TILE, _TILE))
    frequency = np.hypot(np.fft.fftfreq(_TILE)[:, None], np.fft.fftfreq(_TILE)[None, :])
    smooth = np.fft.ifft2(np.fft.fft2(white) * np.exp(-np.square(frequency / 0.12))).real
    return np.asarray(smooth / smooth.std(), np.float32)
