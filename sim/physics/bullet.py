"""The one door to PyBullet: a world of rigid bodies that are known by name, never by integer.

A body is called "sofa", a part of a robot "Astrid/left-wheel". The thread that made a `Bullet` owns it,
and any other is turned away: the order of its calls would be left to chance, and PyBullet holds the
interpreter lock in each of them anyway. Lengths are metres, angles radians, quaternions (x, y, z, w),
colours red, green, blue and alpha from 0 to 1.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np

from sim.physics.camera import Array, Camera
from sim.physics.quiet import quiet
from sim.physics.shapes import Box, Contact, Cylinder, Mesh, Picture, Quaternion, RayHits, Shape, Sphere, Vector

__all__ = [
    "Box",
    "Bullet",
    "Contact",
    "Cylinder",
    "Mesh",
    "Picture",
    "RayHits",
    "Shape",
    "Sphere",
    "heading",
    "upright",
]


try:
    with quiet():
        import pybullet
except ImportError as error:
    raise ImportError(
        "the simulated world needs PyBullet: pip install pybullet numpy (Linux x86_64, Python below 3.12)"
    ) from error

RAYS_PER_CALL = 16000


class Bullet:
    """One PyBullet world, headless unless `gui`; time step in seconds, gravity in m/s2 downwards."""

    def __init__(self, gui: bool = False, time_step: float = 1 / 240, gravity: float = 9.81) -> None:
        with quiet():
            self._connection: int = pybullet.connect(pybullet.GUI if gui else pybullet.DIRECT)
        self._owner = threading.get_ident()
        self.time_step, self._gravity = time_step, gravity
        self.reset()

    def __enter__(self) -> Bullet:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Give the world back; a second call does nothing."""
        if self._connection >= 0:
            with quiet():
                self._call(pybullet.disconnect)
            self._connection = -1

    def _call(self, function: Callable[..., Any], *arguments: object, **keywords: object) -> Any:
        if threading.get_ident() != self._owner:
            raise RuntimeError("a Bullet world may only be used by the thread that made it")
        return function(*arguments, physicsClientId=self._connection, **keywords)

    def reset(self) -> None:
        """Remove every body; what is built next runs as if in a new world."""
        self._call(pybullet.resetSimulation)
        self._bodies: dict[str, int] = {}
        self._names: dict[int, str] = {}
        self._joints: dict[str, dict[str, int]] = {}
        self._parts: dict[int, str] = {}
        self._textures: dict[Path, int] = {}
        self._call(pybullet.setGravity, 0, 0, -self._gravity)
        # Fixed pair order and iteration count: the same calls give the same trajectory, bit for bit.
        self._call(
            pybullet.setPhysicsEngineParameter,
            fixedTimeStep=self.time_step,
            numSolverIterations=50,
            deterministicOverlappingPairs=1,
        )

    def step(self) -> None:
        """Advance the physics by one time step."""
        self._call(pybullet.stepSimulation)

    # Bodies

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all bodies in the order in which they were added."""
        return tuple(self._bodies)

    def add(
        self,
        name: str,
        shape: Shape,
        position: Vector,
        orientation: Quaternion = (0.0, 0.0, 0.0, 1.0),
        colour: Sequence[float] = (0.8, 0.8, 0.8),
        *,
        mass: float = 0.0,
        solid: bool = True,
        visible: bool = True,
        texture: Path | None = None,
    ) -> None:
        """Add a body centred at `position`; mass 0 never moves, `solid=False` is only seen.

        A texture is an image file; on a mesh it lies as `texture_points` say; the colour multiplies it.
        """
        visual = self._visual(shape, colour) if visible else -1
        collision = self._collision(shape) if solid else -1
        index: int = self._call(pybullet.createMultiBody, mass, collision, visual, position, orientation)
        self._register(name, index)
        if texture is not None:
            self.paint(name, colour, texture)

    def add_urdf(self, name: str, path: Path, position: Vector, orientation: Quaternion = (0.0, 0.0, 0.0, 1.0)) -> None:
        """Add a robot from a URDF file; its links become parts `name/link`."""
        with quiet():
            index: int = self._call(pybullet.loadURDF, str(path), position, orientation)
        self._register(name, index)

    def _register(self, name: str, index: int) -> None:
        if name in self._bodies:
            self._call(pybullet.removeBody, index)
            raise ValueError(f"there is already a body named {name!r}")
        self._bodies[name], self._names[index] = index, name
        self._parts[index] = name
        self._joints[name] = {}
        for joint in range(self._call(pybullet.getNumJoints, index)):
            facts = self._call(pybullet.getJointInfo, index, joint)
            self._joints[name][facts[1].decode()] = joint
            self._parts[index + ((joint + 1) << 24)] = f"{name}/{facts[12].decode()}"

    def remove(self, name: str) -> None:
        """Take a body out of the world."""
        index = self._bodies.pop(name)
        self._call(pybullet.removeBody, index)
        del self._names[index], self._joints[name]
        self._parts = {label: part for label, part in self._parts.items() if label & 0xFFFFFF != index}

    def paint(self, name: str, colour: Sequence[float] = (1, 1, 1), texture: Path | None = None) -> None:
        """Give a body another colour, and a texture from an image file; the file is read once."""
        rgba = [*colour, 1.0][:4]
        if texture is None:
            self._call(pybullet.changeVisualShape, self._bodies[name], -1, rgbaColor=rgba)
            return
        if texture not in self._textures:
            self._textures[texture] = self._call(pybullet.loadTexture, str(texture))
        self._call(
            pybullet.changeVisualShape,
            self._bodies[name],
            -1,
            rgbaColor=rgba,
            textureUniqueId=self._textures[texture],
        )

    # Where things are and what they touch

    def pose(self, name: str) -> tuple[Vector, Quaternion]:
        """Return position and orientation of a body's (base link's) centre of mass."""
        position, orientation = self._call(pybullet.getBasePositionAndOrientation, self._bodies[name])
        return position, orientation

    def place(self, name: str, position: Vector, orientation: Quaternion = (0.0, 0.0, 0.0, 1.0)) -> None:
        """Put a body somewhere else, at rest."""
        self._call(pybullet.resetBasePositionAndOrientation, self._bodies[name], position, orientation)

    def contacts(self, name: str) -> list[Contact]:
        """Return what touched a body in the last step."""
        found = []
        for touch in self._call(pybullet.getContactPoints, self._bodies[name]):
            parts = self._part(touch[1], touch[3]), self._part(touch[2], touch[4])
            found.append(Contact(name, parts[0], self._names[touch[2]], parts[1], touch[5], -touch[8], touch[9]))
        return found

    def _part(self, body: int, link: int) -> str:
        return self._parts[body + ((link + 1) << 24)]

    def cast(self, starts: Array, ends: Array) -> RayHits:
        """Send n rays from `starts` to `ends`, both (n, 3), and return what each hits first."""
        rows = []
        for first in range(0, len(starts), RAYS_PER_CALL):
            batch = [points[first : first + RAYS_PER_CALL].tolist() for points in (starts, ends)]
            rows += self._call(pybullet.rayTestBatch, *batch)
        return RayHits(
            np.array([row[2] for row in rows], dtype=np.float64),
            np.array([row[4] for row in rows], dtype=np.float64).reshape(-1, 3),
            [self._names.get(row[0]) for row in rows],
        )

    # Joints

    def joint_angles(self, name: str, joints: Sequence[str]) -> tuple[float, ...]:
        """Return the angles of joints; a wheel's counts on past whole turns."""
        known = self._joints[name]
        states = self._call(pybullet.getJointStates, self._bodies[name], [known[joint] for joint in joints])
        return tuple(state[0] for state in states)

    def turn_joints(self, name: str, velocities: Mapping[str, float], torque: float) -> None:
        """Let motors turn joints at velocities in rad/s with at most `torque` newton metres each."""
        known = self._joints[name]
        self._call(
            pybullet.setJointMotorControlArray,
            self._bodies[name],
            [known[joint] for joint in velocities],
            pybullet.VELOCITY_CONTROL,
            targetVelocities=list(velocities.values()),
            forces=[torque] * len(velocities),
        )

    # Pictures

    def render(
        self,
        camera: Camera,
        *,
        shadow: bool = False,
        light: Vector = (0.4, -0.6, 1.0),
        ambient: float = 0.6,
        diffuse: float = 0.35,
    ) -> Picture:
        """Render what a camera sees in software; 320x240 takes 27 ms, twice as long with shadow.

        `light` is the direction towards the light. A parallel projection shows nothing: take a far
        telephoto.
        """
        _, _, colours, depth, labels = self._call(
            pybullet.getCameraImage,
            camera.width,
            camera.height,
            camera.view.T.ravel().tolist(),
            camera.projection.T.ravel().tolist(),
            lightDirection=light,
            shadow=int(shadow),
            lightAmbientCoeff=ambient,
            lightDiffuseCoeff=diffuse,
            lightSpecularCoeff=0.0,
            renderer=pybullet.ER_TINY_RENDERER,
            flags=pybullet.ER_SEGMENTATION_MASK_OBJECT_AND_LINKINDEX,
        )
        shape = camera.height, camera.width
        return Picture(
            np.array(colours, dtype=np.uint8).reshape(*shape, 4)[:, :, :3],
            np.array(depth, dtype=np.float32).reshape(shape),
            np.array(labels, dtype=np.int32).reshape(shape),
            dict(self._parts),
        )

    # Shapes

    def _visual(self, shape: Shape, colour: Sequence[float]) -> int:
        kind, fields = _form(shape, "length")
        rgba = [*colour, 1.0][:4]
        index: int = self._call(pybullet.createVisualShape, kind, rgbaColor=rgba, **fields)
        return index

    def _collision(self, shape: Shape) -> int:
        if isinstance(shape, Mesh):
            raise ValueError("a mesh can be seen but not touched: add it with solid=False")
        kind, fields = _form(shape, "height")
        index: int = self._call(pybullet.createCollisionShape, kind, **fields)
        return index


def _form(shape: Shape, height_field: str) -> tuple[int, dict[str, object]]:
    """Return PyBullet's number and fields for a shape; it calls a cylinder's height by two names."""
    match shape:
        case Box(size):
            return pybullet.GEOM_BOX, {"halfExtents": [extent / 2 for extent in size]}
        case Cylinder(radius, height):
            return pybullet.GEOM_CYLINDER, {"radius": radius, height_field: height}
        case Sphere(radius):
            return pybullet.GEOM_SPHERE, {"radius": radius}
        case Mesh(vertices, indices, normals, points):
            fields: dict[str, object] = {"vertices": _rows(vertices), "indices": [int(i) for i in indices]}
            if normals is not None:
                fields["normals"] = _rows(normals)
            if points is not None:
                fields["uvs"] = _rows(points)
            return pybullet.GEOM_MESH, fields


def _rows(points: Sequence[Sequence[float]]) -> list[list[float]]:
    return [[float(value) for value in point] for point in points]


def upright(theta: float) -> Quaternion:
    """Return the orientation of a body turned by `theta` about the vertical."""
    return 0.0, 0.0, float(np.sin(theta / 2)), float(np.cos(theta / 2))


def heading(orientation: Quaternion) -> float:
    """Return a body's angle about the vertical."""
    x, y, z, w = orientation
    return float(np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)))
