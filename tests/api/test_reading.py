"""An ecology is read from whatever holds Turtle."""

from __future__ import annotations

import gc
import io
import os
import sys
import weakref
from io import StringIO
from pathlib import Path

import pytest
import rdflib

import selfconf as sc
from selfconf import read
from selfconf.api.reading import is_endpoint
from selfconf.errors import AuthorError, ProgrammerError, TurtleError
from selfconf.model.profile import Place
from tests.lab import ADVERTISEMENTS, PREFIXES, iri, write_advertisements

CLOCK_TURTLE = Path(__file__).resolve().parents[2] / "examples" / "clock" / "clock.ttl"


def names(ecology: sc.Ecology) -> list[str]:
    """The local names of the components."""
    return sorted(component.short for component in ecology.components)


def graph(*paths: str) -> rdflib.Graph:
    """Files as a graph of rdflib."""
    found = rdflib.Graph()
    for path in paths:
        found.parse(path)
    return found


def test_paths_as_text_or_as_path_alone_or_several_or_in_a_list_are_read() -> None:
    clock, display, both = "examples/clock/clock.ttl", Path("examples/clock/display.ttl"), "examples/clock"
    for sources in ([clock, display], [[clock, display]], [(clock,), display], [both], [clock, clock, display]):
        assert names(sc.read(*sources)) == ["clock", "display"]


def test_half_of_a_character_in_a_text_is_a_mistake_with_its_place() -> None:
    """As of a file in another encoding that was read with `errors="surrogateescape"`."""
    with pytest.raises(TurtleError, match=r"^<text>:2:8: not Turtle: '\\udcff' is no character"):
        read("@prefix : <x:> .\n:a :b '\udcff' .")


@pytest.mark.parametrize(
    "text",
    [
        CLOCK_TURTLE.read_text(),
        f"# a remark\n{CLOCK_TURTLE.read_text()}",
        "<x:clock> a <https://w3id.org/selfconf#Component>, <x:Clock> .",
        "@prefix : <x:> . :clock a <https://w3id.org/selfconf#Component>, :Clock .",
        "PREFIX : <x:> :clock a <https://w3id.org/selfconf#Component>, :Clock .",
        "@base <x:> . <clock> a <https://w3id.org/selfconf#Component>, <Clock> .",
    ],
)
def test_turtle_text_is_read_on_one_line_or_several(text: str) -> None:
    assert names(sc.read(text)) == ["clock"]


def test_a_graph_is_read_and_so_is_every_graph_of_a_dataset() -> None:
    assert names(sc.read(graph("examples/clock/clock.ttl", "examples/clock/display.ttl"))) == ["clock", "display"]
    dataset = rdflib.Dataset()
    for name in ("clock", "display"):
        for triple in graph(f"examples/clock/{name}.ttl"):
            dataset.graph(rdflib.URIRef(f"x:{name}")).add(triple)
    assert names(sc.read(dataset)) == ["clock", "display"]
    assert repr(sc.read(dataset)) == "<ecology of 2 components from <graph>>"


def test_several_sources_may_come_from_anything_that_gives_them() -> None:
    found = sc.read(path for path in (Path("examples/clock"), "examples/watch"))
    assert sorted(found.components) == sorted(sc.read("examples/clock", "examples/watch").components)
    assert len(sc.read({Path("examples/clock")}).components) == 2


def test_standard_input_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(CLOCK_TURTLE.read_bytes())))
    assert names(sc.read("-")) == ["clock"]


def test_what_is_left_out_is_named_with_its_reason() -> None:
    twice = sc.read("examples/clock/clock.ttl", CLOCK_TURTLE.read_text())
    (left_out,) = twice.left_out
    assert left_out.component.short == "clock"
    assert "already" in left_out.reason
    (malformed,) = sc.read("<x:a> a <https://w3id.org/selfconf#Component> .").left_out
    assert malformed.component == "x:a"


@pytest.mark.parametrize(
    "source", ["no-such-folder", Path("no-such-file.ttl"), "", None, 7, b"@prefix", {"a": 1}, StringIO("a.ttl")]
)
def test_what_is_no_source_is_refused_in_a_sentence(source: object) -> None:
    with pytest.raises(AuthorError if isinstance(source, str | Path) else ProgrammerError):
        sc.read(source)  # type: ignore[arg-type]  # that is what is tested


def test_broken_turtle_is_refused_with_its_line() -> None:
    with pytest.raises(TurtleError, match=r"<text>:2:\d+: not Turtle"):
        sc.read("@prefix : <x:> .\n:a b\n")


def test_an_endpoint_with_a_password_is_refused_before_it_is_shown() -> None:
    with pytest.raises(AuthorError) as error:
        sc.read("http://me:secret@127.0.0.1:1/query")
    assert "secret" not in str(error.value)


def test_an_endpoint_is_an_ecology_by_itself_and_is_not_asked_before_it_has_to_be() -> None:
    endpoint = sc.read("http://127.0.0.1:1/query")
    assert repr(endpoint) == "<ecology at http://127.0.0.1:1/query>"
    assert bool(endpoint)
    with pytest.raises(AuthorError, match="by itself"):
        sc.read("http://127.0.0.1:1/query", "examples/clock")
    with pytest.raises(sc.SelfconfError, match="query"):
        _ = endpoint.components
    with pytest.raises(sc.SelfconfError, match="is the server running"):
        endpoint.query("ASK {}")


def test_reading_leaves_the_garbage_of_the_program_to_the_collector() -> None:
    class Loop:
        """An object that refers to itself."""

    loop = Loop()
    loop.itself = loop  # type: ignore[attr-defined]  # any attribute would do
    gone = weakref.ref(loop)
    del loop
    before = gc.get_freeze_count()
    sc.read("examples/clock")
    gc.collect()
    assert gone() is None
    assert gc.get_freeze_count() <= before
    assert gc.isenabled()


LAMP = PREFIXES + ":lamp a sc:Component, :Lamp .\n"


OVEN = PREFIXES + ":oven a sc:Component, :Oven .\n"


BAD = PREFIXES + ':bell a sc:Component, :Bell ; sc:preference "loud" .\n'


@pytest.fixture
def ads(tmp_path: Path) -> Path:
    """A folder with the advertisements of the paper, one of them deeper, and a file that is no Turtle by its name."""
    folder = write_advertisements(tmp_path / "ads")
    (folder / "deep").mkdir()
    (folder / "drive.ttl").rename(folder / "deep" / "drive.ttl")
    (folder / "notes.txt").write_text("not Turtle")
    return folder


def test_a_folder_stands_for_all_turtle_below_it(ads: Path) -> None:
    assert len(read(ads)) == len(ADVERTISEMENTS)
    assert iri("astrid-drive") in read(str(ads)).components


def test_files_and_folders_may_overlap_and_each_file_is_read_once(ads: Path) -> None:
    ecology = read(ads, ads / "deep", ads / "deep" / "drive.ttl")
    assert (len(ecology), ecology.left_out) == (len(ADVERTISEMENTS), ())


def test_a_graph_of_rdflib_is_read_too() -> None:
    graph = rdflib.Graph().parse(data=PREFIXES + ADVERTISEMENTS["tracker"], format="turtle")
    by_graph, by_text = read(graph).components, read(PREFIXES + ADVERTISEMENTS["tracker"]).components
    assert dict(by_graph) == dict(by_text)
    assert len(by_graph[iri("person-tracker")].outputs) == 1


def test_sources_of_several_kinds_are_one_ecology(ads: Path) -> None:
    graph = rdflib.Graph().parse(data=OVEN, format="turtle")
    assert len(read(ads, LAMP, graph)) == len(ADVERTISEMENTS) + 2


def test_nothing_at_all_is_an_empty_ecology() -> None:
    assert len(read()) == 0
    assert read()


@pytest.mark.parametrize(
    ("source", "endpoint"),
    [
        ("http://127.0.0.1:7878/query", True),
        ("https://example.org/sparql?a=b", True),
        ("http://127.0.0.1 x", False),
        ("ftp://example.org/", False),
        ("http.ttl", False),
        (Path("http://example.org"), False),
    ],
)
def test_a_url_is_an_endpoint(source: object, endpoint: bool) -> None:
    assert is_endpoint(source) is endpoint


def test_standard_input_can_be_read(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(b"\xef\xbb\xbf" + LAMP.encode())))
    assert list(read("-").components) == [iri("lamp")]


def test_of_two_advertisements_of_a_component_the_first_by_path_counts_and_the_other_is_named(tmp_path: Path) -> None:
    for name, kind in (("b", ":Oven"), ("a", ":Lamp")):
        (tmp_path / f"{name}.ttl").write_text(PREFIXES + f":x a sc:Component, {kind} .")
    ecology = read(tmp_path / "b.ttl", tmp_path / "a.ttl")
    assert iri("Lamp") in ecology.components[iri("x")].types
    (left_out,) = ecology.left_out
    assert (left_out.place, left_out.component) == (Place(str(tmp_path / "b.ttl"), PREFIXES.count("\n") + 1), iri("x"))
    assert left_out.reason == f"it is advertised in {tmp_path / 'a.ttl'} already"


def test_a_file_that_is_given_by_two_paths_advertises_its_components_once(tmp_path: Path) -> None:
    (tmp_path / "a.ttl").write_text(PREFIXES + ":x a sc:Component, :Lamp .")
    (tmp_path / "link.ttl").symlink_to("a.ttl")
    relative = os.path.relpath(tmp_path / "a.ttl")
    ecology = read(tmp_path, relative)
    assert (list(ecology.components), ecology.left_out) == ([iri("x")], ())
    assert [one.component for one in read(LAMP, LAMP).left_out] == [iri("lamp")]


def test_an_advertisement_that_does_not_conform_is_left_out_and_the_rest_of_its_file_is_not() -> None:
    ecology = read(BAD + ":lamp a sc:Component, :Lamp .")
    assert list(ecology.components) == [iri("lamp")]
    (left_out,) = ecology.left_out
    assert left_out.component == iri("bell")
    assert "sc:preference" in left_out.reason


def test_what_is_not_there_or_not_turtle_is_named_with_its_place(tmp_path: Path) -> None:
    with pytest.raises(AuthorError, match=f"no file or folder {tmp_path / 'nowhere'}"):
        read(tmp_path / "nowhere")
    broken = tmp_path / "broken.ttl"
    broken.write_text(PREFIXES + ":lamp a .\n")
    with pytest.raises(TurtleError) as wrong:
        read(broken)
    assert (wrong.value.file, wrong.value.line) == (str(broken), PREFIXES.count("\n") + 1)
    broken.write_bytes(b"\0\0")
    with pytest.raises(TurtleError, match="binary"):
        read(broken)
    with pytest.raises(TurtleError, match="<text>"):
        read(PREFIXES + ":lamp a .\n")


def test_reading_leaves_the_collector_as_it_was() -> None:
    for collecting in (False, True):
        (gc.enable if collecting else gc.disable)()
        read(LAMP)
        assert gc.isenabled() is collecting
    with pytest.raises(TurtleError):
        read(PREFIXES + ":lamp a .\n")
    assert gc.isenabled()
