"""The door to PyBullet."""

from __future__ import annotations

import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

pytest.importorskip("pybullet", reason="PyBullet is not installed: install the extra sim on Python 3.10 or 3.11")
pytest.importorskip("PIL", reason="Pillow is not installed: install the extra sim")

import numpy as np
from PIL import Image

from sim.physics.bullet import Box, Bullet, Cylinder, Mesh, Sphere, heading, upright
from sim.physics.camera import Camera, look_at, perspective
from sim.robot.astrid import URDF

pytestmark = pytest.mark.sim

ABOVE = Camera(80, 60, look_at((0, 0, 4), (0, 0, 0), up=(0, 1, 0)), perspective(0.6, 80 / 60))
SQUARE = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]


@pytest.fixture
def bullet() -> Iterator[Bullet]:
    with Bullet() as world:
        yield world


def test_a_ball_falls_onto_the_floor_and_touches_it_by_name(bullet: Bullet) -> None:
    bullet.add("floor", Box((4, 4, 0.2)), (0, 0, -0.1))
    bullet.add("ball", Sphere(0.1), (0, 0, 0.3), mass=1.0)
    assert bullet.contacts("ball") == []
    for _ in range(240):
        bullet.step()
    assert bullet.pose("ball")[0][2] == pytest.approx(0.1, abs=0.01)
    assert {touch.other for touch in bullet.contacts("ball")} == {"floor"}
    assert sum(touch.force for touch in bullet.contacts("ball")) == pytest.approx(9.81, rel=0.1)


def test_what_is_not_solid_is_fallen_through(bullet: Bullet) -> None:
    bullet.add("mist", Box((4, 4, 0.2)), (0, 0, 0), solid=False)
    bullet.add("ball", Sphere(0.1), (0, 0, 0.3), mass=1.0)
    for _ in range(240):
        bullet.step()
    assert bullet.pose("ball")[0][2] < -1.0


def test_rays_say_what_they_hit_where_and_from_which_side(bullet: Bullet) -> None:
    bullet.add("pillar", Cylinder(0.5, 2.0), (2, 0, 0))
    hits = bullet.cast(np.array([[0.0, 0, 0], [0, 0, 0]]), np.array([[3.0, 0, 0], [0, 3, 0]]))
    assert hits.bodies == ["pillar", None]
    assert hits.fraction == pytest.approx([0.5, 1.0], abs=1e-3)
    assert hits.normals[0] == pytest.approx([-1.0, 0.0, 0.0], abs=0.02)


def test_more_rays_than_one_call_takes_are_cast_in_batches(bullet: Bullet) -> None:
    bullet.add("wall", Box((0.1, 4, 4)), (1, 0, 0))
    hits = bullet.cast(np.zeros((20000, 3)), np.tile([2.0, 0, 0], (20000, 1)))
    assert hits.bodies == ["wall"] * 20000


def test_a_picture_names_what_it_shows(bullet: Bullet) -> None:
    bullet.add("cube", Box((0.4, 0.4, 0.4)), (0, 0, 0.2), colour=(1, 0, 0))
    picture = bullet.render(ABOVE)
    assert picture.rgb.shape == (60, 80, 3)
    assert picture.mask("cube")[30, 40]
    assert not picture.mask("cube")[0, 0]
    red, green, _ = picture.rgb[30, 40]
    assert red > 3 * green
    assert ABOVE.distance(picture.depth)[30, 40] == pytest.approx(3.6, abs=0.01)


def test_a_robot_shows_its_parts_by_name_and_turns_its_joints(bullet: Bullet) -> None:
    bullet.add("floor", Box((4, 4, 0.2)), (0, 0, -0.1))
    bullet.add_urdf("Astrid", URDF, (0, 0, 0), upright(0.3))
    assert heading(bullet.pose("Astrid")[1]) == pytest.approx(0.3)
    picture = bullet.render(ABOVE)
    assert picture.mask("Astrid/plate-front").any()
    assert picture.mask("Astrid").sum() > picture.mask("Astrid/plate-front").sum()
    for _ in range(240):
        bullet.turn_joints("Astrid", {"left-axle": 2.0, "right-axle": 2.0}, 6.0)
        bullet.step()
    assert bullet.joint_angles("Astrid", ["left-axle", "right-axle"]) == pytest.approx((2.0, 2.0), abs=0.05)


def test_a_texture_lies_on_a_mesh_as_its_points_say(bullet: Bullet, tmp_path: Path) -> None:
    halves = np.zeros((8, 8, 3), dtype=np.uint8)
    halves[:, :4, 0], halves[:, 4:, 1] = 255, 255
    Image.fromarray(halves).save(tmp_path / "halves.png")
    corners = [[0, 0], [1, 0], [1, 1], [0, 1]]
    carpet = Mesh(SQUARE, [0, 1, 2, 0, 2, 3], [[0, 0, 1]] * 4, corners)
    bullet.add("carpet", carpet, (0, 0, 0), colour=(1, 1, 1), solid=False, texture=tmp_path / "halves.png")
    picture = bullet.render(ABOVE)
    left, right = picture.rgb[30, 30], picture.rgb[30, 50]
    assert left[0] > 100 > left[1]
    assert right[1] > 100 > right[0]


def test_a_body_can_be_moved_painted_and_removed(bullet: Bullet) -> None:
    bullet.add("cube", Box((0.4, 0.4, 0.4)), (0, 0, 0.2))
    bullet.paint("cube", (0, 0, 1))
    assert bullet.render(ABOVE).rgb[30, 40][2] > 100
    bullet.place("cube", (3, 0, 0.2))
    assert not bullet.render(ABOVE).mask("cube").any()
    bullet.remove("cube")
    assert bullet.names == ()
    bullet.add("cube", Sphere(0.1), (0, 0, 0))


def test_a_name_can_be_given_once(bullet: Bullet) -> None:
    bullet.add("cube", Box((1, 1, 1)), (0, 0, 0))
    with pytest.raises(ValueError, match="already a body named 'cube'"):
        bullet.add("cube", Box((1, 1, 1)), (0, 0, 0))


def test_a_mesh_cannot_be_solid(bullet: Bullet) -> None:
    with pytest.raises(ValueError, match="solid=False"):
        bullet.add("sheet", Mesh(SQUARE, [0, 1, 2, 0, 2, 3]), (0, 0, 0))


def test_two_worlds_do_not_share_bodies(bullet: Bullet) -> None:
    bullet.add("cube", Box((1, 1, 1)), (0, 0, 0))
    with Bullet() as other:
        assert other.names == ()
        other.add("cube", Sphere(0.1), (0, 0, 5))
        assert other.pose("cube")[0][2] == 5.0
    assert bullet.pose("cube")[0][2] == 0.0


def test_another_thread_is_turned_away(bullet: Bullet) -> None:
    caught: list[RuntimeError] = []

    def trespass() -> None:
        try:
            bullet.step()
        except RuntimeError as error:
            caught.append(error)

    stranger = threading.Thread(target=trespass)
    stranger.start()
    stranger.join(10.0)
    assert "only be used by the thread that made it" in str(caught[0])


def test_pybullet_prints_nothing() -> None:
    program = (
        "from sim.physics.bullet import Bullet; from sim.robot.astrid import URDF\n"
        "with Bullet() as world: world.add_urdf('Astrid', URDF, (0, 0, 0))"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=True)
    assert (done.stdout, done.stderr) == ("", "")
