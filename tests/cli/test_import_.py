"""`selfconf import`."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path

import jsonschema
import pytest
from referencing import Registry, Resource

from selfconf import library
from selfconf.api.living import living_import
from selfconf.cli.main import main
from selfconf.importing import ImportReport
from tests.cli.command import run

SCHEMAS = {path.name: json.loads(path.read_text("utf-8")) for path in library.schemas()}
JUDGE = jsonschema.Draft202012Validator(
    SCHEMAS["import.schema.json"],
    registry=Registry().with_resources((s["$id"], Resource.from_contents(s)) for s in SCHEMAS.values()),
)
EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "imports"
LAMP = """{
  "@context": ["https://www.w3.org/2022/wot/td/v1.1", { "saref": "https://w3id.org/saref#" }],
  "id": "urn:dev:lamp", "title": "Lamp", "properties": { "on": { "@type": "saref:OnOffState", "forms": [{}] } }
}"""


@pytest.fixture
def things(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a lamp, in the current folder."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "things").mkdir()
    (tmp_path / "things" / "lamp.json").write_text(LAMP)
    return tmp_path / "things"


def test_what_is_imported_is_listed_and_what_is_left_out_is_named(
    things: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    outcome = run(capsys, "import", "wot", "things", "--out", "ads")
    assert outcome.code == 0
    assert outcome.out.splitlines()[2:] == ["ads/lamp.ttl  new  1", "1 component in 1 file"]
    why = "they say how a thing is reached, an advertisement says what it is"
    assert outcome.err == f"left out forms (1): {why}; in things/lamp.json\n"
    again = run(capsys, "import", "wot", "things", "--out", "ads")
    assert "ads/lamp.ttl  unchanged  1" in again.out


def test_misspelt_terms_that_are_copied_are_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sc, rob = "https://w3id.org/selfconf#", "https://w3id.org/selfconf/robotics#"
    said = f"<urn:lamp> a <{sc}Component>, <{rob}Tuner> ; <{rob}plcae> <urn:kitchen> ; <{sc}preferense> 5 ."
    (tmp_path / "lamp.trig").write_text(f"<urn:graph> {{ {said} }}")
    outcome = run(capsys, "import", "rdf", str(tmp_path), "--out", str(tmp_path / "ads"))
    assert outcome.code == 0
    assert "lamp.ttl: no ontology has the terms rob:plcae, sc:preferense, so they say nothing" in outcome.err


def test_the_summary_as_json_keeps_to_its_schema(things: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name, text in {"lamp2.json": LAMP, "bad.json": "{", "none.json": "5"}.items():
        (things / name).write_text(text)
    outcome = run(capsys, "import", "wot", "things", "--out", "ads", "--format", "json")
    assert outcome.code == 2
    JUDGE.validate(outcome.body)
    assert [file["components"][0]["outputs"] for file in outcome.body["files"]] == [1, 1]
    assert outcome.body["renamed"][0]["component"] == "urn:dev:lamp-lamp2"
    assert outcome.body["unreadable"][0] | {"message": ""} == {
        "message": "", "source": "things/bad.json", "line": 1, "column": 2,
    }  # fmt: skip


def test_the_example_of_the_schema_is_what_the_command_prints(things: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (example,) = SCHEMAS["import.schema.json"]["examples"]
    assert run(capsys, "import", "wot", "things", "--out", "ads", "--format", "json").body == example


def test_nothing_to_import_is_an_honest_no(things: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (things / "lamp.json").unlink()
    outcome = run(capsys, "import", "wot", "things", "--out", "ads")
    assert (outcome.code, outcome.out) == (1, "0 components in 0 files\n")
    said = "there is nothing of the format wot in things; of a folder the files that end in .json or .jsonld are read"
    assert outcome.err == f"selfconf import: {said}\n"
    peis = run(capsys, "import", "peis", "things", "--out", "ads")
    assert peis.err.endswith("of a folder the files that end in .cmp are read\n")


def test_where_all_is_left_out_it_is_not_said_that_there_is_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "a.nt").write_text("<urn:a> <urn:b> <urn:c> .\n")
    outcome = run(capsys, "import", "rdf", str(tmp_path), "--out", str(tmp_path / "ads"))
    assert outcome.code == 1
    assert "left out documents without components" in outcome.err
    assert "there is nothing of the format" not in outcome.err


def test_of_a_folder_with_nothing_but_what_was_imported_it_is_said_that_this_is_not_read(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    (tmp_path / "lamp.ttl").write_text("# Imported by `selfconf import wot` from lamp.json; ...\n")
    nothing = run(capsys, "import", "rdf", str(tmp_path), "--out", str(tmp_path / "ads"))
    assert nothing.code == 1
    assert ".trig or .jsonld are read, but for those that an import has written" in nothing.err


def test_a_document_that_cannot_be_read_is_named_with_its_place_and_the_rest_is_imported(
    things: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (things / "bad.json").write_text('{\n "a": ]')
    outcome = run(capsys, "import", "wot", "things", "nowhere", "--out", "ads")
    assert outcome.code == 2
    assert outcome.err.startswith("things/bad.json:2:7: this is not JSON")
    assert "there is no file or folder nowhere" in outcome.err
    assert (things.parent / "ads" / "lamp.ttl").is_file()


def test_the_exit_code_is_the_same_where_the_reader_of_the_table_has_gone(
    things: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ours, theirs = os.pipe()
    os.close(ours)
    with os.fdopen(theirs, "w", buffering=1) as pipe:  # each line at once, as with PYTHONUNBUFFERED in a container
        monkeypatch.setattr(sys, "stdout", pipe)
        assert main(["import", "wot", "things", "nowhere", "--out", "ads"]) == 2


def test_a_file_of_somebody_else_stops_the_import(things: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (things.parent / "ads").mkdir()
    (things.parent / "ads" / "lamp.ttl").write_text("# mine\n")
    outcome = run(capsys, "import", "wot", "things", "--out", "ads")
    assert outcome.is_one_sentence("ads/lamp.ttl is not from an import", "--out")


def test_the_examples_are_imported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for form, number in (("wot", 1), ("ros2", 5)):  # four nodes, and a part as a composite
        outcome = run(capsys, "import", form, str(EXAMPLES), "--out", str(tmp_path / form), "--format", "json")
        assert outcome.code == 0
        assert sum(len(file["components"]) for file in outcome.body["files"]) == number
    assert (tmp_path / "ros2" / "teleoperation.template.ttl").read_text().count("a sc:Interaction") == 3


def test_an_imported_system_is_configured(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run(capsys, "import", "ros2", str(EXAMPLES), "--out", str(tmp_path))
    template = str(tmp_path / "teleoperation.template.ttl")
    outcome = run(capsys, "configure", template, "--ads", str(tmp_path), "--format", "json")
    assert outcome.code == 0, outcome
    assert len(outcome.body["connections"]) == 3


def test_a_domain_in_which_no_node_lives_is_named(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(living_import, "import_living_nodes", lambda *_: ImportReport("ros2", (), (), ()))
    outcome = run(capsys, "import", "ros2", "--connect", "tcp/127.0.0.1:7447", "--domain", "5", "--out", str(tmp_path))
    assert (outcome.code, outcome.out) == (1, "0 components in 0 files\n")
    assert "no node of ROS 2 lives in the domain 5 at tcp/127.0.0.1:7447; --domain names another one" in outcome.err
