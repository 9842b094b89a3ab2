"""What a source is, a path or a URL, and which things it holds."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from selfconf.bridging.wot.thing_sources import host_of, is_url, places, things_in, unreadable_file
from selfconf.errors import AuthorError

LAMP = {"@context": "https://www.w3.org/2022/wot/td/v1.1", "id": "urn:thing:lamp", "title": "Lamp"}


def test_a_url_is_told_from_a_path() -> None:
    assert is_url("HTTP://192.0.2.7/")
    assert not is_url("http/lamp.json")


def test_a_url_has_a_host_in_lower_case_and_what_is_none_is_named() -> None:
    assert host_of("http://Lamp.example:8080/td") == "lamp.example"
    with pytest.raises(AuthorError, match="is no http or https URL"):
        host_of("http://")
    with pytest.raises(AuthorError, match=r"^the URL of lamp\.example has a user name or a password in it"):
        host_of("http://me:secret@lamp.example/td")


def test_a_file_comes_from_its_folders_and_a_url_from_itself_alone() -> None:
    assert places("things/lamp.json") == ["things/lamp.json", "things", "."]
    assert places("http://lamp.example/td") == ["http://lamp.example/td"]


def test_a_source_holds_things_beside_what_cannot_be_read_and_what_describes_no_thing(tmp_path: Path) -> None:
    (tmp_path / "lamp.json").write_text(json.dumps(LAMP))
    (tmp_path / "broken.json").write_text('{"title": ')
    (tmp_path / "other.json").write_text('{"a": 1}')
    found = things_in(str(tmp_path), [])
    assert [str(thing.component.iri) for thing in found.things] == ["urn:thing:lamp"]
    assert [Path(wrong.file or "").name for wrong in found.unreadable] == ["broken.json"]
    assert [Path(place).name for place in found.without_things] == ["other.json"]


def test_things_of_one_identifier_in_two_files_keep_it(tmp_path: Path) -> None:
    for name in ("a.json", "b.json"):
        (tmp_path / name).write_text(json.dumps(LAMP))
    assert [str(thing.component.iri) for thing in things_in(str(tmp_path), []).things] == ["urn:thing:lamp"] * 2


def test_only_of_a_file_it_is_said_why_it_describes_no_thing(tmp_path: Path) -> None:
    lamp, broken = tmp_path / "lamp.json", tmp_path / "broken.json"
    lamp.write_text(json.dumps(LAMP))
    broken.write_text('{"title": ')
    assert unreadable_file(str(lamp)) is None
    assert unreadable_file(str(tmp_path)) is None
    assert unreadable_file("http://lamp.example/td") is None
    assert "this is not JSON" in str(unreadable_file(str(broken)))
