"""Places: file and line of what a refusal names, and which types are spelt alike."""

from __future__ import annotations

from pathlib import Path

import pytest
from rdflib import Graph

import selfconf as sc
from selfconf.api.places import LARGEST_REREAD, MOST_REREAD, Places, with_lines
from selfconf.api.reading import read
from selfconf.model.left_out import LeftOut
from selfconf.model.profile import Place
from selfconf.model.template import Role, Template
from selfconf.model.term import IRI
from selfconf.rdf import positions
from tests.cli.command import Outcome, run
from tests.lab import PREFIXES


def test_roles_and_components_have_file_and_line_and_others_have_no_place(clock: sc.TaskSpecification) -> None:
    places = Places(clock.document.template, sc.read("examples/clock").advertisements())
    home = "https://example.org/my-home#"
    assert str(places.of_role(sc.IRI(f"{home}screen"))) == "examples/clock/tell-the-time.ttl:15"
    assert str(places.of_component(sc.IRI(f"{home}display"))) == "examples/clock/display.ttl:5"
    assert places.of_role(sc.IRI(f"{home}kitchen")) is None
    assert places.of_component(sc.IRI(f"{home}kitchen")) is None


PARSE = positions.parse_with_positions


TIME = ":time a sc:Template ; sc:roles ( :source :sink ) .\n:source a sc:Role ; sh:class :Clok ; sc:feeds :sink .\n"


SINK = ":sink a sc:Role ; sh:class rob:Display ."


CLOCK = ':clock a sc:Component, :Clock ; sc:hasOutput [ sc:name "time" ; sc:signalType rob:Text ] .'


SCREEN = ':screen a sc:Component, rob:Display ; sc:hasInput [ sc:name "text" ; sc:signalType SIGNAL ] .'


@pytest.fixture
def home(tmp_path: Path) -> Path:
    """A template that asks for a clock, misspelt, and two advertisements."""
    (tmp_path / "ads").mkdir()
    write(tmp_path, TIME + SINK, CLOCK, SCREEN.replace("SIGNAL", "rob:Text"))
    return tmp_path


def write(home: Path, template: str, clock: str, screen: str) -> None:
    """The files, the template below two more lines."""
    (home / "time.ttl").write_text(PREFIXES + "\n# The time.\n" + template)
    (home / "ads" / "clock.ttl").write_text(PREFIXES + clock)
    (home / "ads" / "screen.ttl").write_text(PREFIXES + screen)


def test_what_was_left_out_has_a_line_where_its_file_can_be_read(tmp_path: Path) -> None:
    names = [f"{number:02}.ttl" for number in range(MOST_REREAD + 1)]
    for name in names:
        (tmp_path / name).write_text(PREFIXES + "# Malformed.\n:x a sc:Component .")
    expected = line(tmp_path / names[0], ":x a")
    elsewhere = LeftOut(Place("elsewhere.ttl"), IRI("urn:x"), "it has no type")
    found = [str(one.place) for one in (*read(tmp_path).left_out, *with_lines([elsewhere]))]
    assert found[:MOST_REREAD] == [expected.replace(names[0], name) for name in names[:-1]]
    assert found[MOST_REREAD:] == [str(tmp_path / names[-1]), "elsewhere.ttl"]


def test_what_a_text_or_an_answer_leaves_out_has_a_line_too(tmp_path: Path) -> None:
    text = PREFIXES + "# Malformed.\n:x a sc:Component ."
    (malformed,) = read(text).left_out
    assert malformed.place == Place("<text>", text.count("\n") + 1)
    path = "sh:property [ sh:path :p ; " * 20 + "sh:minCount 1" + " ]" * 20
    task = sc.template(PREFIXES + f":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; {path} .")
    (tmp_path / "deep.ttl").write_text(
        PREFIXES + "\n:z a :Z, sc:Component ; :p " + "[ :p " * 40 + "1" + " ]" * 40 + " ."
    )
    (not_judged,) = sc.configure(task, read(tmp_path)).left_out
    assert str(not_judged.place) == line(tmp_path / "deep.ttl", ":z a")


def test_only_what_is_named_by_a_relative_iri_is_read_by_the_parser_with_positions(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It takes long, and rdflib has to be loaded for it."""
    parsed: list[str] = []

    def parse(text: str, source: str, base: str) -> tuple[Graph, positions.Positions]:
        parsed.append(Path(source).name)
        return PARSE(text, source, base)

    monkeypatch.setattr(positions, "parse_with_positions", parse)
    absolute, relative = tmp_path / "absolute.ttl", tmp_path / "relative.ttl"
    absolute.write_text(PREFIXES + "\n:x a sc:Component .")
    relative.write_text(PREFIXES + "\n\n<#x> a sc:Component .")
    assert {str(one.place) for one in read(tmp_path).left_out} == {line(absolute, ":x a"), line(relative, "<#x> a")}
    assert parsed == ["relative.ttl"]


def configure(capsys: pytest.CaptureFixture[str], home: Path, *arguments: str) -> Outcome:
    """Run `configure` there."""
    return run(capsys, "configure", str(home / "time.ttl"), "--ads", str(home / "ads"), *arguments)


def line(path: Path, text: str) -> str:
    """Where a text begins a line of a file, as people write it."""
    return f"{path}:{[one.startswith(text) for one in path.read_text().splitlines()].index(True) + 1}"


def test_a_misspelt_type_is_a_near_miss_and_the_first_thing_to_read(
    capsys: pytest.CaptureFixture[str], home: Path
) -> None:
    body = configure(capsys, home, "--format", "json").body
    role, clock = line(home / "time.ttl", ":source a"), line(home / "ads" / "clock.ttl", ":clock a")
    assert [reason["place"] for reason in body["reasons"]] == [role]
    (miss,) = body["near_misses"]
    assert miss["place"] == clock
    assert miss["obstacle"] == "is no Clok but a Clock (is one of them misspelt?)"
    assert body["repairs"][0]["code"] == "accept-near-miss"
    assert body["repairs"][0]["place"] == clock
    text = configure(capsys, home).out
    assert f"  because no component is eligible for the role source  [{role}]\n" in text
    assert f"  source: :clock would fit, but it is no Clok but a Clock (is one of them misspelt?)  [{clock}]\n" in text
    assert len(text.splitlines()) < 24


def test_an_input_that_nobody_feeds_points_to_the_component_that_has_it(
    capsys: pytest.CaptureFixture[str], home: Path
) -> None:
    write(home, TIME.replace(":Clok", ":Clock") + SINK, CLOCK, SCREEN.replace("SIGNAL", "rob:Image"))
    (reason,) = configure(capsys, home, "--format", "json").body["reasons"]
    assert reason["code"] == "input-unfed"
    assert reason["place"] == line(home / "ads" / "screen.ttl", ":screen a")


@pytest.mark.parametrize(
    ("wanted", "offered", "words"),
    [
        ("rob:PositionSensor", "rob:PersonTracker", "which lies below it (see --reasoning subclass)"),
        ("rob:PersonTracker", "rob:PositionSensor", "which lies above it"),
        ("rob:Tuner", ":Tuner", "but a <https://example.org/peis-home#Tuner> (is one of them misspelt?)"),
    ],
)
def test_a_related_type_is_a_near_miss(
    capsys: pytest.CaptureFixture[str], home: Path, wanted: str, offered: str, words: str
) -> None:
    write(home, TIME.replace(":Clok", wanted) + SINK, CLOCK.replace(":Clock", offered), SCREEN)
    write(
        home,
        TIME.replace(":Clok", wanted) + SINK,
        CLOCK.replace(":Clock", offered),
        SCREEN.replace("SIGNAL", "rob:Text"),
    )
    (miss,) = configure(capsys, home, "--format", "json").body["near_misses"]
    assert words in miss["obstacle"]


def test_a_type_that_is_unlike_or_one_flaw_of_two_is_no_near_miss(
    capsys: pytest.CaptureFixture[str], home: Path
) -> None:
    write(home, TIME.replace(":Clok", ":Oven") + SINK, CLOCK, SCREEN.replace("SIGNAL", "rob:Text"))
    assert configure(capsys, home, "--format", "json").body["near_misses"] == []
    demanding = TIME.replace(":Clok ;", ":Clok ; sh:property [ sh:path rob:place ; sh:minCount 1 ] ;")
    write(home, demanding + SINK, CLOCK, SCREEN.replace("SIGNAL", "rob:Text"))
    assert configure(capsys, home, "--format", "json").body["near_misses"] == []


def test_a_component_with_the_iri_of_a_role_is_found_where_it_is_advertised(
    home: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write(home, TIME + SINK, CLOCK.replace(":clock a", ":source a"), SCREEN.replace("SIGNAL", "rob:Text"))
    (miss,) = configure(capsys, home, "--format", "json").body["near_misses"]
    assert miss["component"].endswith("#source")
    assert miss["place"] == line(home / "ads" / "clock.ttl", ":source a")


def test_what_comes_from_elsewhere_has_no_place_and_what_cannot_be_read_again_no_line(tmp_path: Path) -> None:
    role, component = IRI("urn:r"), IRI("urn:c")
    template = Template(IRI("urn:t"), (Role(role, place=Place("somewhere/else.ttl")),))
    assert Places(template, {}).of_role(role) is None
    assert Places(template, {}).of_component(component) is None
    file = tmp_path / "ads.ttl"
    text = PREFIXES + "<urn:c> a sc:Component, :T .\n"
    file.write_text(text)
    ecology = read(file).advertisements()
    assert Places(template, ecology).of_component(component) == Place(str(file), text.count("\n"))
    for later in (text + "#" * LARGEST_REREAD, "no Turtle"):
        file.write_text(later)
        assert Places(template, ecology).of_component(component) == Place(str(file))


def test_lines_of_text_that_is_in_no_file_are_told_too_and_of_a_graph_its_name() -> None:
    template = PREFIXES + "# A comment.\n" + TIME + SINK
    display = SCREEN.replace("SIGNAL", "rob:Text")
    refused = sc.configure(sc.template(template), sc.read(PREFIXES + display, PREFIXES + "\n\n" + CLOCK))
    assert isinstance(refused, sc.Refusal)
    role, clock = template.splitlines().index(TIME.splitlines()[1]) + 1, PREFIXES.count("\n") + 3
    assert [one.place for one in (*refused.reasons, *refused.near_misses)] == [
        Place("<text>", role),
        Place("<text>", clock),
    ]
    graph = Graph().parse(data=template)
    refused = sc.configure(sc.template(graph), sc.read(Graph().parse(data=PREFIXES + CLOCK)))
    assert {one.place for one in (*refused.reasons, *refused.near_misses, *refused.repairs)} == {Place("<graph>")}


def test_a_text_that_only_speaks_of_a_component_is_not_where_it_is_described() -> None:
    template = Template(IRI("urn:t"), (Role(IRI("urn:r"), place=Place("<text>")),))
    speaking, describing = "<urn:a> <urn:p> <urn:c> .", "\n<urn:c> a <urn:T> ."
    ecology = read(PREFIXES + "<urn:c> a sc:Component, :T .").advertisements()
    assert Places(template, ecology, (speaking, describing)).of_component(IRI("urn:c")) == Place("<text>", 2)
    assert Places(template, ecology, (speaking,)).of_component(IRI("urn:c")) == Place("<text>", 1)
    assert Places(template, ecology, ("no Turtle", describing + "#" * LARGEST_REREAD)).of_component(
        IRI("urn:c")
    ) == Place("<text>")
