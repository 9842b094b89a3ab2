"""The folder that an import writes to."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.errors import AuthorError
from selfconf.importing.folder import FileState, write_folder
from selfconf.importing.turtle_text import MARK

TEXT = f"{MARK} wot`.\n"


def test_a_file_is_new_then_unchanged_then_changed(tmp_path: Path) -> None:
    states = [write_folder(tmp_path, {"a/lamp.ttl": text})["a/lamp.ttl"] for text in (TEXT, TEXT, TEXT + "#\n")]
    assert states == [FileState.NEW, FileState.UNCHANGED, FileState.CHANGED]
    assert (tmp_path / "a" / "lamp.ttl").read_text() == TEXT + "#\n"
    assert len(list(tmp_path.rglob("*"))) == 2


def test_what_stays_the_same_is_not_touched(tmp_path: Path) -> None:
    write_folder(tmp_path, {"lamp.ttl": TEXT})
    before = (tmp_path / "lamp.ttl").stat().st_mtime_ns
    write_folder(tmp_path, {"lamp.ttl": TEXT})
    assert (tmp_path / "lamp.ttl").stat().st_mtime_ns == before


def test_a_file_of_somebody_else_is_not_overwritten_and_nothing_is_written(tmp_path: Path) -> None:
    (tmp_path / "lamp.ttl").write_text("# mine\n")
    with pytest.raises(AuthorError, match="is not from an import, and is not overwritten"):
        write_folder(tmp_path, {"a.ttl": TEXT, "lamp.ttl": TEXT})
    assert (tmp_path / "lamp.ttl").read_text() == "# mine\n"
    assert not (tmp_path / "a.ttl").exists()


@pytest.mark.parametrize("name", ["x.ttl", "x.ttl/y.ttl"])
def test_what_cannot_be_written_is_a_sentence(tmp_path: Path, name: str) -> None:
    (tmp_path / "x.ttl").write_text(TEXT)
    (tmp_path / "out").write_text("")
    with pytest.raises(AuthorError, match="give another folder with out"):
        write_folder(tmp_path / "out" if name == "x.ttl" else tmp_path, {name: TEXT})
