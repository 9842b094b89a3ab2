"""Sources as strangers write them: whatever they are, an import ends with a report, and what it writes is Turtle."""

from __future__ import annotations

import copy
import json
import tempfile
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from selfconf.importing import IMPORT_FORMATS, import_descriptions
from selfconf.rdf.turtle import parse
from tests.harness.effort import examples
from tests.importing.ros2.look_alikes import system
from tests.importing.ros2.test_nodl import TEXT as NODL
from tests.importing.test_owl_s import TURTLE, XML
from tests.importing.test_peis import DRIVE

THING: dict[str, Any] = {
    "@context": ["https://www.w3.org/2022/wot/td/v1.1", {"x": "urn:x:", "y": {"@id": "x:y"}, "@language": "en"}],
    "id": "urn:dev:lamp",
    "title": "Lamp",
    "titles": {"en": "Lamp"},
    "@type": ["x:Lamp", "Thing"],
    "links": [{"rel": "tm:extends", "href": "a.json"}],
    "x:p": [1, {"@id": "urn:x"}],
    "properties": {
        "a": {"@type": "x:A", "unit": "%", "forms": [{"op": ["readproperty"]}]},
        "b": {"tm:ref": "#/properties/a"},
    },
    "events": {"e": {"data": {"@type": "x:A", "unit": "lux"}}},
    "actions": {"c": {"input": {"@type": "x:A"}, "output": {}}},
}
ROBOT = {**system(2).texts, "n.nodl.xml": NODL}
SOURCES = {
    "ros2": ROBOT,
    "owl-s": {"a.owls": XML.format(version="1.1"), "b.ttl": TURTLE},
    "peis": {"a.cmp": DRIVE},
    "rdf": {
        "a.ttl": "@prefix sc: <https://w3id.org/selfconf#> . <#a> a sc:Component, <#b> ; sc:hasInput [ sc:name 'x' ] ."
    },
    "wot": {"a.json": json.dumps(THING), "b.json": json.dumps({**THING, "links": []})},
}


def imported(form: str, texts: dict[str, bytes]) -> None:
    """Import some texts, and read what comes of it."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in texts.items():
            Path(folder, name).write_bytes(text)
        report = import_descriptions(form, [folder], Path(folder, "out"), None)
        for file in report.files:
            assert parse(file.path.read_bytes(), file.path.name).statements
        for each in (*report.left_out, *report.renamed, *report.unreadable):
            assert "\n" not in str(each)


def test_every_format_is_tried() -> None:
    assert SOURCES.keys() == IMPORT_FORMATS.keys()


splices = st.lists(
    st.tuples(
        st.integers(0, 10_000),
        st.integers(0, 30),
        st.sampled_from(
            [b"", b'"', b"'", b"[", b"]", b"{", b":", b"-", b"\n", b"<", b">", b"(", b")", b"\\", b"\xff", b"#", b"a"]
        )
        | st.binary(max_size=4),
    ),
    min_size=1,
    max_size=4,
)


@pytest.mark.parametrize("form", SOURCES)
@settings(max_examples=examples(50), deadline=None)
@given(splices=splices)
def test_texts_with_pieces_cut_out_and_put_in(form: str, splices: list[tuple[int, int, bytes]]) -> None:
    texts = {name: text.encode() for name, text in SOURCES[form].items()}
    for position, length, piece in splices:
        name = sorted(texts)[position % len(texts)]
        start = position % (len(texts[name]) + 1)
        texts[name] = texts[name][:start] + piece + texts[name][start + length :]
    imported(form, texts)


def paths(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """The paths to all values in a JSON value."""
    inside = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [path, *(found for key, each in inside for found in paths(each, (*path, key)))]


PATHS = [path for path in paths(THING) if path]
odd = st.sampled_from(
    [None, True, 0, -1.5, "", "x", "x:y", "urn:%", "{{X}}", "#/properties/b", "a.json", [], {}, [[]], [None]]
)
odd |= st.dictionaries(st.sampled_from(["@type", "unit", "tm:ref", "@id", "", "data", "op"]), odd, max_size=3)


@settings(max_examples=examples(150), deadline=None)
@given(changes=st.lists(st.tuples(st.sampled_from(PATHS), odd), min_size=1, max_size=4))
def test_things_in_which_other_values_stand(changes: list[tuple[tuple[Any, ...], Any]]) -> None:
    thing = copy.deepcopy(THING)
    for path, value in changes:
        holder: Any = thing
        for step in path[:-1]:
            holder = holder[step] if isinstance(holder, dict | list) and _has(holder, step) else None
        if isinstance(holder, dict) or (isinstance(holder, list) and _has(holder, path[-1])):
            holder[path[-1]] = copy.deepcopy(value)
    imported("wot", {"a.json": json.dumps(thing).encode(), "b.json": json.dumps(THING).encode()})


def _has(holder: dict[str, Any] | list[Any], step: Any) -> bool:
    return step in holder if isinstance(holder, dict) else isinstance(step, int) and step < len(holder)
