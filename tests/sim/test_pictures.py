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

import numpy as np
from PIL import Image
from rdflib import Graph, Literal, URIRef

from sim.apartment import HOME, Apartment, read_apartment
from sim.astrid import PLATE_HEIGHT
from sim.pictures import (
    Failure,
    Link,
    Part,
    Port,
    Quality,
    RunRecord,
    Sample,
    Sight,
    Supply,
    Wiring,
    draw,
    film,
    still,
)
from sim.pictures.diagram import draw_wiring
from sim.pictures.floor import lay
from sim.pictures.house import extent, house
from sim.pictures.ink import image, svg
from sim.pictures.layout import arrange
from sim.pictures.lettering import Style, shortened, width
from sim.pictures.matter import Matter
from sim.pictures.palette import BLUE, FAIL, ORANGE, linear, rgb, to_linear, to_screen
from sim.pictures.sight import view_area
from sim.pictures.solids import ball, box, cone, look, upright
from sim.pictures.strip import chosen, plate, strip
from sim.pictures.view import View

TINY = Quality(
    (420, 300), exposures=1, skies=2, density=60, map_step=0.05, film_size=(220, 130), film_exposures=1, frames=4
)
GREY = Matter("#808080")
HOSTILE = "<script>&\"'\x00]]> ]\ud800 \u202e漢字\n" + "long " * 60


def wiring(*names: str, failed: str = "") -> Wiring:
    """A chain of components, each of which feeds the next."""
    parts = [
        Part(name, "a role", (Port("in", "Signal"),) if k else (), (Port("out", "Signal"),), failed=name == failed)
        for k, name in enumerate(names)
    ]
    links = [Link(one, "out", other, "in") for one, other in pairwise(names)]
    return Wiring("A chain", tuple(parts), tuple(links))


def camera_image(spot: tuple[int, int] | None) -> Sight:
    """An image of a room with the plate at a spot, or nowhere."""
    picture = np.full((120, 160, 3), (120, 110, 90), np.uint8)
    if spot is not None:
        x, y = spot
        picture[y : y + 12, x : x + 10], picture[y : y + 12, x + 10 : x + 20] = (0, 220, 220), (220, 0, 220)
    return Sight(picture, 1.0, "x 1.0 m", lost=spot is None)


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
def album(run: RunRecord, apartment: Apartment, tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    return draw(run, apartment, tmp_path_factory.mktemp("album") / "new", TINY)


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


def test_pictures_stay_below_their_limits(album: list[Path]) -> None:
    assert all(path.stat().st_size < (900_000 if path.suffix == ".webp" else 600_000) for path in album)


def test_stills_have_the_size_that_was_asked_for(album: list[Path]) -> None:
    for path in album[:2]:
        with Image.open(path) as picture:
            assert picture.size == TINY.size


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


def test_the_path_is_blue_by_the_tracker_and_orange_by_odometry(
    run: RunRecord, apartment: Apartment, album: list[Path]
) -> None:
    frame = (0.035 * 420, 84 + 6, 0.965 * 420, 300 - 62 - 14)
    view = still.plan(house(apartment), TINY.size, frame)
    with Image.open(album[1]) as picture:
        for k, colour in ((4, BLUE), (15, ORANGE)):
            at = np.array([[run.samples[k].x], [run.samples[k].y], [0.0]])
            column, row, _ = view.project(at)
            shown = np.array(picture.convert("RGB").getpixel((int(column[0]), int(row[0]))), float)
            wanted = np.array(rgb(colour), float)
            # Shade dims a colour; which of its parts is the largest stays.
            cosine = shown @ wanted / np.linalg.norm(shown) / np.linalg.norm(wanted)
            assert cosine > 0.95, (colour, shown)


def test_what_is_painted_on_the_floor_is_not_there_before_its_time(run: RunRecord, apartment: Apartment) -> None:
    floor = lay(extent(apartment), apartment.rooms, (), (), run, 100.0)
    for k, colour in ((4, BLUE), (15, ORANGE), (10, FAIL)):
        at = floor.pixels(np.array([[run.samples[k].x], [run.samples[k].y]], np.float32))[0]
        assert floor.painted.reshape(-1, 3)[at] == pytest.approx(linear(colour), abs=0.02)
        assert floor.moment.ravel()[at] == pytest.approx(run.samples[k].time, abs=0.51)
    nowhere = floor.pixels(np.array([[1.0], [3.0]], np.float32))[0]
    assert math.isinf(floor.moment.ravel()[nowhere])


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
    paths = draw(RunRecord(samples), apartment, tmp_path, TINY)
    assert [path.name for path in paths] == ["run-perspective.png", "run-plan.png", "run.webp"]
    assert all(path.stat().st_size > 0 for path in paths)


def test_a_run_that_leaves_the_apartment_is_drawn_as_well(apartment: Apartment, tmp_path: Path) -> None:
    samples = (Sample(0.0, 1.0, 1.4), Sample(9.0, 40.0, -30.0))
    failure = Failure(8.0, 40.0, -30.0)
    assert len(draw(RunRecord(samples, failures=(failure,), goal=(-9.0, 9.0)), apartment, tmp_path, TINY)) == 3


def test_progress_rises_from_nothing_to_all(apartment: Apartment, tmp_path: Path) -> None:
    heard: list[float] = []
    draw(RunRecord((Sample(0.0, 1.0, 1.4),)), apartment, tmp_path, TINY, lambda what, share: heard.append(share))
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


def test_the_film_shows_a_failure_for_some_frames_at_its_time(run: RunRecord) -> None:
    moments = film.moments(run, 10)
    flashes = [moment for moment in moments if moment.failure is not None]
    assert len(flashes) == film.FLASH
    assert {moment.time for moment in flashes} == {5.0}
    assert [moment.time for moment in moments] == sorted(moment.time for moment in moments)


# The scene


def test_rays_meet_the_outsides_of_solids_at_the_right_depth() -> None:
    solids = [
        box(GREY, (0, 0, 1), (2, 2, 2)),
        ball(GREY, (4, 0, 1), (1, 1, 1)),
        cone(GREY, (8, 0, 0), 2, 1, 0.5),
    ]
    points = np.array([[-2.0, -2.0, 0.0], [10.0, 2.0, 2.0]])
    for number, solid in enumerate(solids):
        view = View.parallel((0.0, 0.0, -1.0), points, 0.05)
        seen = look([solid], view)
        top = np.array([[solid.centre[0] + 0.01], [0.01], [2.0]])
        column, row, depth = view.project(top)
        assert seen.depth[int(row[0]), int(column[0])] == pytest.approx(depth[0], abs=1e-3), number


def test_normals_point_outwards_whichever_way_a_solid_is_turned() -> None:
    solid = box(GREY, (1, 2, 3), (2, 1, 1), turn=upright(0.7))
    ahead = np.array([[math.cos(0.7)], [math.sin(0.7)], [0.0]])
    surface = (np.array([[1.0], [2.0], [3.0]]) + ahead).astype(np.float32)
    assert solid.normal(solid.local(surface)) == pytest.approx(ahead, abs=1e-3)


def test_a_window_of_a_view_sees_what_the_whole_view_sees_there(apartment: Apartment) -> None:
    solids = house(apartment)
    view = still.perspective(solids, (200, 120), (5, 5, 195, 115))
    window = (slice(30, 70), slice(50, 120))
    whole, part = look(solids, view), look(solids, view.cropped(window))
    assert (part.which == whole.which[window]).mean() > 0.995


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
        {tuple(round(part, 3) for part in solid.centre) for solid in house(home)} for home in (apartment, moved)
    )
    shifted = {(round(x + 1.11, 3), y, z) for x, y, z in before - after}
    assert shifted == after - before


def test_furniture_of_an_unknown_kind_is_drawn_as_a_block(apartment: Apartment) -> None:
    oddity = replace(apartment.furniture[0], kind="Harpsichord", height=1.3)
    home = replace(apartment, furniture=(oddity,))
    assert max(solid.centre[2] + solid.half[2] for solid in house(home)[1:-5]) <= 1.31


def test_the_view_area_is_what_the_camera_sees_of_the_living_room(apartment: Apartment) -> None:
    area = view_area(apartment.cameras[0], apartment.walls, apartment.rooms, PLATE_HEIGHT)
    assert 4 <= len(area) <= 12
    assert max(x for x, _ in area) == pytest.approx(3.7, abs=0.01)
    assert min(x for x, _ in area) == pytest.approx(0.0, abs=0.01)


# Diagrams


def test_the_svg_is_xml_and_names_every_component(album: list[Path], run: RunRecord) -> None:
    for path, wiring_ in zip((album[3], album[5]), run.wirings, strict=True):
        text = "\n".join(ElementTree.parse(path).getroot().itertext())
        for part in wiring_.parts:
            assert part.name in text


def test_hostile_names_are_escaped_and_cannot_break_the_drawing() -> None:
    part = Part(HOSTILE, HOSTILE, outputs=(Port(HOSTILE, HOSTILE),))
    sink = Part("sink", inputs=(Port(HOSTILE, HOSTILE),))
    drawing = draw_wiring(Wiring(HOSTILE, (part, sink), (Link(HOSTILE, HOSTILE, "sink", HOSTILE),)))
    text = svg(drawing)
    assert "<script" not in text
    root = ElementTree.fromstring(text.encode("utf-8", "strict"))
    assert "<script>&" in "".join(root.itertext())
    assert drawing.width < 1500
    assert image(drawing, 1).width == drawing.width


def test_components_stand_in_the_order_in_which_they_feed_each_other() -> None:
    layout = arrange(wiring("a", "b", "c", "d"))
    assert [layout.boxes[name].layer for name in "abcd"] == [0, 1, 2, 3]
    ends = [layout.boxes[name].x for name in "abcd"]
    assert ends == sorted(ends)


def test_boxes_of_a_diagram_never_overlap() -> None:
    parts = tuple(
        Part(f"p{k}", inputs=tuple(Port(f"i{j}") for j in range(k)), outputs=(Port("out", "T"),)) for k in range(7)
    )
    links = tuple(Link(f"p{j}", "out", f"p{k}", f"i{j}") for k in range(7) for j in range(k))
    boxes = [box_ for layer in arrange(Wiring("all to all", parts, links)).layers for box_ in layer]
    for k, one in enumerate(boxes):
        for other in boxes[k + 1 :]:
            apart = one.x + one.width < other.x or other.x + other.width < one.x
            assert apart or one.y + one.height <= other.y or other.y + other.height <= one.y


def test_a_configuration_that_feeds_itself_is_drawn_with_links_that_run_back() -> None:
    loop = wiring("a", "b")
    back = replace(
        loop,
        parts=(replace(loop.parts[0], inputs=(Port("in", "Signal"),)), loop.parts[1]),
        links=(*loop.links, Link("b", "out", "a", "in"), Link("b", "out", "b", "in")),
    )
    layout = arrange(back)
    assert [link.sink for link in layout.backward] == ["a", "b"]
    assert "<svg" in svg(draw_wiring(back))


def test_an_empty_configuration_has_a_diagram_too() -> None:
    assert "configurator" in svg(draw_wiring(Wiring("Nothing", ())))


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
