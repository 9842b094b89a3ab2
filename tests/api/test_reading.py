"""An ecology is read from whatever holds Turtle."""

from __future__ import annotations

import gc
import io
import sys
import weakref
from pathlib import Path

import pytest
import rdflib

import selfconf as sc
from selfconf.errors import AuthorError, TurtleError

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


@pytest.mark.parametrize("source", ["no-such-folder", Path("no-such-file.ttl"), "", None, 7, b"@prefix", {"a": 1}])
def test_what_is_no_source_is_refused_in_a_sentence(source: object) -> None:
    with pytest.raises(AuthorError):
        sc.read(source)  # type: ignore[arg-type]  # that is what is tested


def test_broken_turtle_is_refused_with_its_line() -> None:
    with pytest.raises(TurtleError, match=r"<text>:2:\d+: not Turtle"):
        sc.read("@prefix : <x:> .\n:a b\n")


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
    assert gc.get_freeze_count() == before
    assert gc.isenabled()
