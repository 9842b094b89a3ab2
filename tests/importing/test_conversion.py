"""One import from beginning to end."""

from __future__ import annotations

import pytest

from selfconf import read, validate
from selfconf.cli.import_ import FORM_NAMES
from selfconf.errors import AuthorError
from selfconf.importing import IMPORT_FORMATS, FileState, import_descriptions
from tests.importing.imports import Workshop
from tests.importing.ros2.look_alikes import system

LAMP = '{ "title": "Lamp", "properties": { "on": {} } }'


def test_the_command_and_the_library_have_the_same_formats() -> None:
    assert tuple(IMPORT_FORMATS) == FORM_NAMES


def test_importing_again_changes_nothing_that_has_not_changed(workshop: Workshop) -> None:
    first = workshop.imported("wot", {"lamp.json": LAMP, "door.json": LAMP.replace("on", "open")})
    before = workshop.texts()
    assert [file.state for file in first.files] == [FileState.NEW] * 2
    again = workshop.imported("wot", {})
    assert [file.state for file in again.files] == [FileState.UNCHANGED] * 2
    assert workshop.texts() == before
    third = workshop.imported("wot", {"lamp.json": LAMP.replace('"on"', '"off"')})
    assert [file.state for file in third.files] == [FileState.UNCHANGED, FileState.CHANGED]


def test_other_files_in_the_folder_are_left_alone(workshop: Workshop) -> None:
    workshop.out.mkdir()
    (workshop.out / "mine.ttl").write_text("# mine\n")
    workshop.imported("wot", {"lamp.json": LAMP})
    assert workshop.texts()["mine.ttl"] == "# mine\n"


def test_what_cannot_be_read_is_in_the_report_and_the_rest_is_imported(workshop: Workshop) -> None:
    report = workshop.imported("wot", {"lamp.json": LAMP, "bad.json": '{\n "a": [1 :]}'})
    assert [file.path.name for file in report.files] == ["lamp.ttl"]
    (error,) = report.unreadable
    assert (error.file, error.line, error.column) == (str(workshop.sources / "bad.json"), 2, 10)


def test_two_sources_of_one_name_have_files_of_their_own(workshop: Workshop) -> None:
    workshop.imported("wot", {"lamp.json": LAMP, "lamp.jsonld": LAMP})
    assert list(workshop.texts()) == ["lamp-2.ttl", "lamp.ttl"]


def test_components_without_a_name_get_one_in_the_namespace(workshop: Workshop) -> None:
    workshop.imported("wot", {"hall/lamp.json": LAMP}, "https://example.org/home#")
    assert "<https://example.org/home#hall-lamp> a" in workshop.texts()["hall/lamp.ttl"]


@pytest.mark.parametrize("namespace", ["home", "https://example.org/home", "a b#"])
def test_what_cannot_be_a_namespace_is_refused(workshop: Workshop, namespace: str) -> None:
    with pytest.raises(AuthorError, match="cannot be a namespace"):
        import_descriptions("wot", [str(workshop.sources)], workshop.out, namespace)


THING = """{
  "@context": ["https://www.w3.org/2022/wot/td/v1.1", { "saref": "https://w3id.org/saref#" }],
  "id": "urn:dev:lamp", "title": "Lamp", "@type": "saref:LightSwitch",
  "properties": { "on": { "@type": ["saref:OnOffState", "saref:State"] }, "level": { "unit": "percent" } },
  "events": { "hot": { "data": { "@type": "saref:Temperature", "unit": "degree celsius" } } },
  "actions": { "toggle": {}, "fade": { "input": { "@type": "saref:Level" }, "output": { "@type": "saref:State" } } }
}"""


def test_what_is_written_is_accepted_by_validate_and_read_without_a_complaint(workshop: Workshop) -> None:
    workshop.imported("wot", {"lamp.json": THING, "bare.json": LAMP})
    workshop.imported("ros2", system(7).texts)
    report = validate([workshop.out])
    assert report.errors == 0, report
    assert len(report.files) > 5
    ecology = read(workshop.out)
    assert ecology.left_out == ()
    assert len(ecology) > 5
