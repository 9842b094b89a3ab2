"""Pictures of a run: stills, film, diagrams and the tracker's view, small and quickly drawn."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree

import pytest

pytest.importorskip("numpy", reason="pictures need numpy: install the extra sim")
pytest.importorskip("PIL", reason="pictures need Pillow: install the extra sim")
pytest.importorskip("mitsuba", reason="pictures need Mitsuba: install the extra sim")

import numpy as np
from PIL import Image
from rdflib import Graph, Literal, URIRef

from sim.home.apartment import HOME, Apartment, read_apartment
from sim.pictures import (
    CameraImage,
    Failure,
    Link,
    Part,
    Quality,
    RunRecord,
    Sample,
    Supply,
    Wiring,
    draw,
    film,
    legend,
)
from sim.pictures.camera_strip import chosen, plate, strip
from sim.pictures.colours import BLUE, FAIL, ORANGE, linear, rgb, to_linear, to_screen
from sim.pictures.diagram import ROW, TOP, arrange, draw_wiring
from sim.pictures.floor import lay
from sim.pictures.house import extent, house
from sim.pictures.mesh import Material, Solid, ball, box, cone, upright
from sim.pictures.robot import robot
from sim.pictures.scene import Scene
from sim.pictures.svg import Style, image, shortened, source, width
from sim.pictures.view_area import view_area
from sim.pictures.viewpoint import perspective, plan
from sim.robot.astrid import PLATE_HEIGHT

TINY = Quality((420, 300), samples=1, density=60, film_size=(220, 130), film_samples=1, film_density=60, frames=4)
LEAST = Quality((240, 200), samples=1, density=20, film_size=(110, 65), film_samples=1, film_density=20, frames=2)
"""For what is drawn to see that it can be."""
GREY = Material("#808080")
HOSTILE = "<script>&\"'\x00]]> ]\ud800 \u202e漢字\n" + "long " * 60


def wiring(*names: str, failed: str = "") -> Wiring:
    """A chain of components, each of which feeds the next."""
    parts = [
        Part(name, "a role", ("in",) if k else (), ("out",), failed=name == failed) for k, name in enumerate(names)
    ]
    links = [Link(one, "out", other, "in") for one, other in pairwise(names)]
    return Wiring("A chain", tuple(parts), tuple(links))


def camera_image(spot: tuple[int, int] | None) -> CameraImage:
    """An image of a room with the plate at a spot, or nowhere."""
    picture = np.full((120, 160, 3), (120, 110, 90), np.uint8)
    if spot is not None:
        x, y = spot
        picture[y : y + 12, x : x + 10], picture[y : y + 12, x + 10 : x + 20] = (0, 220, 220), (220, 0, 220)
    return CameraImage(picture, 1.0, "x 1.0 m", lost=spot is None)


@pytest.fixture(scope="module")
def run() -> RunRecord:
    """A drive from the living room to the bedroom, in which the tracker fails half way."""
    samples = tuple(Sample(k * 0.5, 1.0 + 0.22 * k, 1.4 - 0.02 * k, 0.0) for k in range(21))
    return RunRecord(
        samples,
        (Supply("the person tracker", 0.0, 5.0), Supply("absolute odometry", 5.0, 10.0)),
        (Failure(5.0, samples[10].x, samples[10].y, "person-tracker", "out of view"),),
        goal=(5.4, 1.0),
        sights=(camera_image((40, 50)), camera_image((130, 60)), camera_image(None)),
        wirings=(wiring("sonar", "cap", "drive"), wiring("sonar", "cap & <drive>", failed="sonar")),
        title="Astrid goes to the bedroom",
        subtitle="The tracker fails and odometry takes over.",
    )


@pytest.fixture(scope="module")
def heard() -> list[float]:
    """The progress of the album, as it was told."""
    return []


@pytest.fixture(scope="module")
def album(
    run: RunRecord, apartment: Apartment, heard: list[float], tmp_path_factory: pytest.TempPathFactory
) -> list[Path]:
    folder = tmp_path_factory.mktemp("album") / "new"
    return draw(run, apartment, folder, TINY, lambda what, share: heard.append(share))


@pytest.mark.slow
def test_an_album_holds_every_picture_and_returns_their_paths(album: list[Path]) -> None:
    names = [path.name for path in album]
    assert names == [
        "run-perspective.png",
        "run-plan.png",
        "run.webp",
        "configuration-1.svg",
        "configuration-1.png",
        "configuration-2.svg",
        "configuration-2.png",
        "tracker-view.png",
    ]
    assert all(path.is_file() for path in album)


@pytest.mark.slow
def test_pictures_stay_below_their_limits(album: list[Path]) -> None:
    assert all(path.stat().st_size < (900_000 if path.suffix == ".webp" else 600_000) for path in album)


@pytest.mark.slow
def test_stills_have_the_size_that_was_asked_for(album: list[Path]) -> None:
    for path in album[:2]:
        with Image.open(path) as picture:
            assert picture.size == TINY.size


@pytest.mark.slow
def test_the_film_moves(album: list[Path]) -> None:
    with Image.open(album[2]) as picture:
        assert getattr(picture, "n_frames", 1) >= TINY.frames
        first = np.asarray(picture.convert("RGB"), np.int32)
        picture.seek(TINY.frames - 1)
        assert np.abs(np.asarray(picture.convert("RGB"), np.int32) - first).max() > 60


def test_a_picture_that_packs_badly_is_made_coarser_until_it_is_small_enough(
    run: RunRecord, apartment: Apartment, tmp_path: Path
) -> None:
    frames = [
        Image.fromarray(np.random.default_rng(seed).integers(0, 255, (90, 120, 3), np.uint8)) for seed in range(3)
    ]
    film.save(frames, tmp_path / "noise.webp", 10**9)
    easy = (tmp_path / "noise.webp").stat().st_size
    film.save(frames, tmp_path / "noise.webp", easy - 1)
    assert (tmp_path / "noise.webp").stat().st_size < easy


@pytest.mark.slow
def test_the_path_is_blue_by_the_tracker_and_orange_by_odometry(
    run: RunRecord, apartment: Apartment, album: list[Path]
) -> None:
    frame = (0.035 * 420, 84 + 6, 0.965 * 420, 300 - 62 - 14)
    view = plan(house(apartment), TINY.size, frame)
    with Image.open(album[1]) as picture:
        for k, colour in ((4, BLUE), (15, ORANGE)):
            column, row = view.project(np.array([[run.samples[k].x, run.samples[k].y, 0.0]]))[0]
            shown = np.array(picture.convert("RGB").getpixel((int(column), int(row))), float)
            wanted = np.array(rgb(colour), float)
            # Shade dims a colour; which of its parts is the largest stays.
            cosine = shown @ wanted / np.linalg.norm(shown) / np.linalg.norm(wanted)
            assert cosine > 0.95, (colour, shown)


def test_what_is_painted_on_the_floor_is_not_there_before_its_time(run: RunRecord, apartment: Apartment) -> None:
    floor = lay(extent(apartment), apartment.rooms, (), (), run, 100.0)
    for k, colour in ((4, BLUE), (15, ORANGE), (10, FAIL)):
        sample = run.samples[k]
        column, row = (int(part) for part in floor.place(sample.x, sample.y))
        assert floor.until(run, sample.time)[row, column] == pytest.approx(linear(colour), abs=0.1)
        before = floor.until(run, sample.time - 0.8)[row, column]
        assert (before == floor.bare[row, column]).all()
    column, row = (int(part) for part in floor.place(1.0, 3.0))
    assert (floor.painted[row, column] == floor.bare[row, column]).all()


@pytest.mark.slow
@pytest.mark.parametrize(
    "samples",
    [
        (Sample(0.0, 1.0, 1.4),),
        (Sample(3.0, 1.0, 1.4), Sample(3.1, 1.01, 1.4)),
        tuple(Sample(float(k), 1.0, 1.4, 0.5) for k in range(5)),
    ],
    ids=["one sample", "a tenth of a second", "never moved"],
)
def test_a_run_may_be_short_or_still_and_need_not_fail(
    samples: tuple[Sample, ...], apartment: Apartment, tmp_path: Path
) -> None:
    paths = draw(RunRecord(samples), apartment, tmp_path, LEAST)
    assert [path.name for path in paths] == ["run-perspective.png", "run-plan.png", "run.webp"]
    assert all(path.stat().st_size > 0 for path in paths)


@pytest.mark.slow
def test_a_run_that_leaves_the_apartment_is_drawn_as_well(apartment: Apartment, tmp_path: Path) -> None:
    samples = (Sample(0.0, 1.0, 1.4), Sample(9.0, 40.0, -30.0))
    failure = Failure(8.0, 40.0, -30.0)
    assert len(draw(RunRecord(samples, failures=(failure,), goal=(-9.0, 9.0)), apartment, tmp_path, LEAST)) == 3


@pytest.mark.slow
def test_progress_rises_from_nothing_to_all(album: list[Path], heard: list[float]) -> None:
    assert heard[0] == 0.0
    assert heard[-1] == 1.0
    assert heard == sorted(heard)


def test_a_run_without_samples_or_with_time_running_backwards_is_refused() -> None:
    with pytest.raises(ValueError, match="at least one sample"):
        RunRecord(())
    with pytest.raises(ValueError, match="order of time"):
        RunRecord((Sample(1.0, 0.0, 0.0), Sample(0.0, 0.0, 0.0)))


def test_between_samples_a_pose_lies_on_the_way_and_turns_the_short_way_round() -> None:
    record = RunRecord((Sample(0.0, 0.0, 0.0, 3.0), Sample(2.0, 1.0, 0.0, -3.0)))
    halfway = record.at(1.0)
    assert (halfway.x, abs(halfway.theta)) == pytest.approx((0.5, math.pi))
    assert record.at(-5.0) == record.samples[0]
    assert record.at(9.0) == record.samples[1]


def test_the_film_says_what_supplies_the_pose_or_what_is_done_while_nothing_does(run: RunRecord) -> None:
    tracker, odometry = run.supplies
    late = replace(run, supplies=(replace(tracker, start=1.0), replace(odometry, start=6.0)))
    assert [film.words(late, time) for time in (0.5, 2.0, 5.5, 7.0)] == [
        "configuring",
        "pose from the person tracker",
        "reconfiguring",
        "pose from absolute odometry",
    ]
    assert film.words(replace(run, supplies=(), failures=()), 2.0) == "on the way"


def test_the_film_shows_a_failure_for_some_frames_at_its_time(run: RunRecord) -> None:
    moments = film.moments(run, 10)
    flashes = [moment for moment in moments if moment.failure is not None]
    assert len(flashes) == film.FLASH
    assert {moment.time for moment in flashes} == {5.0}
    assert [moment.time for moment in moments] == sorted(moment.time for moment in moments)


# The scene


@pytest.mark.parametrize(
    ("solid", "volume"),
    [
        (box(GREY, (1, 2, 3), (2, 3, 4), turn=upright(0.7)), 24.0),
        (box(GREY, (1, 2, 3), (2, 3, 4), 0.0005), 24.0),
        (cone(GREY, (8, 0, 0), 2, 1, 0.5), math.pi * 2 / 3 * 1.75),
        (ball(GREY, (4, 0, 1), (1, 2, 3)), 8 * math.pi),
    ],
    ids=["turned box", "sharp box", "cone", "ball"],
)
def test_solids_are_closed_and_face_outwards(solid: Solid, volume: float) -> None:
    corners = solid.points[solid.faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    # The divergence theorem: only a closed surface whose faces all turn outwards has the volume.
    assert (across * corners[:, 0]).sum() / 6.0 == pytest.approx(volume, rel=0.03)
    outward = (across[:, None] * solid.normals[solid.faces]).sum(axis=2)
    assert (outward > -1e-9).all()
    assert np.linalg.norm(solid.normals, axis=1) == pytest.approx(1.0)


def test_a_picture_shows_things_where_the_view_projects_them() -> None:
    places = {"#ff0000": (-1.0, 0.5, 0.3), "#00ff00": (1.2, -0.6, 0.3), "#0000ff": (0.9, 0.9, 0.3)}
    solids = [ball(Material(colour), place, (0.2, 0.2, 0.2)) for colour, place in places.items()]
    scene = Scene(solids, robot(), (-2.0, -2.0, 2.0, 2.0), np.full((8, 8, 3), 0.5, np.float32))
    # A frame that lies off the middle, so that the picture's principal point does as well.
    view = perspective(solids, (240, 160), (90.0, 10.0, 230.0, 80.0))
    whole = scene.picture(view, 4)
    window = (80, 5, 240, 90)
    part = scene.picture(view, 4, window)
    for k, place in enumerate(places.values()):
        column, row = (int(pixel) for pixel in view.project(np.array([place]))[0])
        for shown in (whole[row, column], part[row - window[1], column - window[0]]):
            assert shown.argmax() == k
            assert shown[k] > 2 * np.delete(shown, k).max()


def test_the_robot_is_where_it_was_put_and_nowhere_before() -> None:
    solids = [box(GREY, (0, 0, 0.1), (4, 4, 0.02))]
    scene = Scene(solids, robot(), (-2.0, -2.0, 2.0, 2.0), np.full((8, 8, 3), 0.5, np.float32))
    view = plan(solids, (120, 120), (10, 10, 110, 110))
    column, row = (int(pixel) for pixel in view.project(np.array([[1.0, -0.5, PLATE_HEIGHT]]))[0])
    empty = scene.picture(view, 4)[row, column]
    scene.change(Sample(0.0, 1.0 - 0.085, -0.5))
    magenta = scene.picture(view, 4)[row, column]
    assert magenta[1] < 0.5 * min(magenta[0], magenta[2])
    assert np.ptp(empty) < 0.3 * empty.max()


def test_colours_survive_the_way_to_linear_light_and_back() -> None:
    levels = np.arange(256, dtype=np.float32) / 255
    assert (to_screen(to_linear(levels)) == np.arange(256)).all()
    with pytest.raises(ValueError, match="#rrggbb"):
        rgb("blue")


def test_moving_the_sofa_in_turtle_moves_it_in_the_picture(apartment: Apartment, plan: Graph) -> None:
    sofa = URIRef(f"{HOME}sofa")
    plan.set((sofa, HOME.x, Literal(2.4)))
    moved = read_apartment(plan)
    before, after = (
        {
            tuple(np.round(np.append(solid.points.min(axis=0), np.ptp(solid.points)), 3).tolist())
            for solid in house(home)
        }
        for home in (apartment, moved)
    )
    shifted = {(round(x + 1.11, 3), *rest) for x, *rest in before - after}
    assert shifted == after - before


def test_furniture_of_an_unknown_kind_is_drawn_as_a_block(apartment: Apartment) -> None:
    oddity = replace(apartment.furniture[0], kind="Harpsichord", height=1.3)
    walls = replace(apartment, furniture=(), cameras=())
    solids = house(replace(walls, furniture=(oddity,)))
    assert len(solids) == len(house(walls)) + 1
    assert max(solid.points[:, 2].max() for solid in solids) == pytest.approx(1.3)


def test_the_view_area_is_what_the_camera_sees_of_the_living_room(apartment: Apartment) -> None:
    area = view_area(apartment.cameras[0], apartment.walls, apartment.rooms, PLATE_HEIGHT)
    assert 4 <= len(area) <= 12
    assert max(x for x, _ in area) == pytest.approx(3.7, abs=0.01)
    assert min(x for x, _ in area) == pytest.approx(0.0, abs=0.01)


# Diagrams


@pytest.mark.slow
def test_the_svg_is_xml_and_names_every_component(album: list[Path], run: RunRecord) -> None:
    for path, wiring_ in zip((album[3], album[5]), run.wirings, strict=True):
        text = "\n".join(ElementTree.parse(path).getroot().itertext())
        for part in wiring_.parts:
            assert part.name in text


def test_hostile_names_are_escaped_and_cannot_break_the_drawing() -> None:
    part = Part(HOSTILE, HOSTILE, outputs=(HOSTILE,))
    sink = Part("sink", inputs=(HOSTILE,))
    drawing = draw_wiring(Wiring(HOSTILE, (part, sink), (Link(HOSTILE, HOSTILE, "sink", HOSTILE),)))
    text = source(drawing)
    assert "<script" not in text
    root = ElementTree.fromstring(text.encode("utf-8", "strict"))
    assert "<script>&" in "".join(root.itertext())
    assert int(drawing.get("width", "0")) < 1500
    assert image(drawing).width == int(drawing.get("width", "0"))


def test_components_stand_in_the_order_in_which_they_feed_each_other() -> None:
    boxes, curves = arrange(wiring("a", "b", "c", "d"))
    assert [box.part.name for box in sorted(boxes, key=lambda box: box.x)] == list("abcd")
    assert len(curves) == 3


def test_boxes_of_a_diagram_never_overlap_and_links_join_their_ports() -> None:
    parts = tuple(Part(f"p{k}", inputs=tuple(f"i{j}" for j in range(k)), outputs=("out",)) for k in range(7))
    links = tuple(Link(f"p{j}", "out", f"p{k}", f"i{j}") for k in range(7) for j in range(k))
    boxes, curves = arrange(Wiring("all to all", parts, links))
    for k, one in enumerate(boxes):
        for other in boxes[k + 1 :]:
            apart = one.x + one.width < other.x or other.x + other.width < one.x
            assert apart or one.y + one.height <= other.y or other.y + other.height <= one.y
    outputs = {(round(box.x + box.width), round(box.y + TOP + ROW / 2)) for box in boxes}
    inputs = {(round(b.x), round(b.y + TOP + ROW * (k + 0.5))) for b in boxes for k in range(len(b.part.inputs))}
    assert {(round(curve[0][0]), round(curve[0][1])) for curve in curves} <= outputs
    assert {(round(curve[-1][0]), round(curve[-1][1])) for curve in curves} == inputs


def test_a_configuration_that_feeds_itself_is_drawn_with_links_that_run_back() -> None:
    loop = wiring("a", "b")
    back = replace(
        loop,
        parts=(replace(loop.parts[0], inputs=("in",)), loop.parts[1]),
        links=(*loop.links, Link("b", "out", "a", "in"), Link("b", "out", "b", "in")),
    )
    _, curves = arrange(back)
    assert sum(curve[-1][0] < curve[0][0] for curve in curves) == 2
    assert min(y for curve in curves for _, y in curve) >= 60.0
    assert "<svg" in source(draw_wiring(back))


def test_an_empty_configuration_has_a_diagram_too() -> None:
    assert "configurator" in source(draw_wiring(Wiring("Nothing", ())))


def test_wirings_with_links_to_nowhere_or_double_names_are_refused() -> None:
    with pytest.raises(ValueError, match="do not have"):
        Wiring("w", (Part("a"),), (Link("a", "out", "a", "in"),))
    with pytest.raises(ValueError, match="named twice"):
        Wiring("w", (Part("a"), Part("a")))


def test_text_is_cut_where_there_is_no_room_for_it() -> None:
    style = Style(12)
    cut = shortened("a rather long name for a component", style, 80.0)
    assert cut.endswith("…")
    assert width(cut, style) <= 80.0
    assert shortened("short", style, 80.0) == "short"


# The tracker's view


def test_the_plate_is_outlined_where_it_is_seen() -> None:
    found = plate(camera_image((40, 50)).image)
    assert found is not None
    hull, back, front = found
    assert set(hull) == {(40.0, 50.0), (60.0, 50.0), (60.0, 62.0), (40.0, 62.0)}
    assert back[0] < front[0]
    assert plate(camera_image(None).image) is None


def test_the_strip_shows_tracking_the_last_sight_and_lost() -> None:
    sights = [replace(camera_image((20 + k, 40)), time=float(k)) for k in range(9)]
    sights.append(replace(camera_image(None), time=9.0))
    assert [(sight.time, stage) for sight, stage in chosen(sights)] == [
        (4.0, "tracking"),
        (8.0, "last sight"),
        (9.0, "lost"),
    ]
    assert strip(sights).width > 3 * 380
    assert [stage for _, stage in chosen(sights[:1])] == ["tracking"]
    with pytest.raises(ValueError, match="at least one image"):
        strip([])


def test_the_legend_of_a_narrow_picture_takes_two_rows_and_shows_every_entry() -> None:
    entries = [
        legend.Entry("line", "#0072b2", "pose from the person tracker"),
        legend.Entry("target", "#cc2233", "FAIL: Astrid has left the view of the stereo camera"),
        legend.Entry("line", "#e69f00", "pose from odometry"),
        legend.Entry("area", "#56b4e9", "view of the camera"),
        legend.Entry("ring", "#009e73", "goal"),
    ]
    assert legend.rows(entries, 1144.0) == [entries]
    assert legend.rows(entries, 544.0) == [entries[:2], entries[2:]]
