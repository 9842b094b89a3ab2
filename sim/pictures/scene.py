"""The lit scene: solids, a floor with a picture on it, one sun and a sky, rendered by Mitsuba and denoised by OIDN.

Mitsuba traces a few light paths for each pixel, with light that goes from wall to wall; Open Image Denoise makes of
that what hundreds of paths would show. The ground outside is white paper: exposure is chosen so that it is exactly
white where nothing keeps the light away. The robot is the only thing that moves; so it is a group of its own.
"""

from __future__ import annotations

import math
import tempfile
from collections import defaultdict
from collections.abc import Sequence
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
_TILE = 512
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
            "group": {"type": "shapegroup", **_shapes(robot)},
            "robot": {"type": "instance", "shapegroup": {"type": "ref", "id": "group"}},
        }
        self.scene = mitsuba.load_dict(scene | _shapes(solids))
        self.integrator = mitsuba.load_dict({"type": "path", "max_depth": 4})
        self.parameters = mitsuba.traverse(self.scene)
        self.change(None)

    def change(self, at: Sample | None, floor: Array | None = None) -> None:
        """Put the robot somewhere, or (None) far below the ground; give the floor another picture of its size."""
        place = [at.x, at.y, 0.0] if at else [0.0, 0.0, -9.0]
        turn = _transform().rotate([0, 0, 1], math.degrees(at.theta) if at else 0.0)
        self.parameters["robot.to_world"] = _transform().translate(place) @ turn
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


def _exposed(light: Array) -> Array:
    """Return intensities in which open ground is 1, with the brightest pressed together, as film does."""
    knee = 0.7

    def shoulder(value: Array) -> Array:
        return np.where(value > knee, knee + (1.0 - knee) * (1.0 - np.exp((knee - value) / (1.0 - knee))), value)

    return np.asarray(shoulder(light) / shoulder(GROUND * (SUN + SKY)), np.float32)


def _shapes(solids: Sequence[Solid]) -> dict[str, Any]:
    """Return solids as shapes for Mitsuba, one for each material."""
    groups: dict[Material, list[Solid]] = defaultdict(list)
    for solid in solids:
        groups[solid.material].append(solid)
    return {f"shape{k}": _mesh(material, members) for k, (material, members) in enumerate(groups.items())}


def _mesh(material: Material, solids: Sequence[Solid]) -> Any:
    starts = np.cumsum([0, *(len(solid.points) for solid in solids)])
    faces = np.concatenate([solid.faces + start for solid, start in zip(solids, starts, strict=False)])
    mesh = mitsuba.Mesh("solids", int(starts[-1]), len(faces), has_vertex_normals=True, has_vertex_texcoords=True)
    parameters = mitsuba.traverse(mesh)
    parameters["vertex_positions"] = np.concatenate([solid.points for solid in solids]).astype(np.float32).ravel()
    parameters["vertex_normals"] = np.concatenate([solid.normals for solid in solids]).astype(np.float32).ravel()
    parameters["vertex_texcoords"] = np.concatenate([solid.texture for solid in solids]).astype(np.float32).ravel()
    parameters["faces"] = faces.astype(np.uint32).ravel()
    parameters.update()
    # A mesh that Python made calls back into Python for every ray; one that was read from a file does not.
    with tempfile.TemporaryDirectory() as folder:
        path = str(Path(folder) / "mesh.ply")
        mesh.write_ply(path)
        return mitsuba.load_dict({"type": "ply", "filename": path, "bsdf": _surface(material)})


@lru_cache(maxsize=256)
def _surface(material: Material) -> Any:
    """Return how a material scatters light; Mitsuba tabulates a glossy one for 30 ms, so scenes share it."""
    return mitsuba.load_dict({"type": "twosided", "one": _bsdf(material)})


def _bsdf(material: Material) -> dict[str, Any]:
    colour = linear(material.colour)
    texture = _rgb(colour)
    if material.grain:
        along, across, strength = _GRAINS[material.grain]
        to_uv = _transform().scale([along / _TILE, across / _TILE, 1.0])
        texture = _bitmap(colour * (1.0 + strength * tile()[..., None])) | {"to_uv": to_uv}
    if not material.gloss:
        return {"type": "diffuse", "reflectance": texture}
    return {
        "type": "roughplastic",
        "diffuse_reflectance": texture,
        "alpha": 0.42 - 0.35 * material.gloss,
        "int_ior": 1.3,
    }


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
