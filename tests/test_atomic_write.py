"""A file is written as a whole, and stays as it was where that cannot be."""

from __future__ import annotations

import os
import stat
from pathlib import Path

import pytest

from selfconf.atomic_write import PRIVATE, READABLE, write_atomically


@pytest.mark.parametrize("mode", [PRIVATE, READABLE])
def test_what_is_written_takes_the_place_of_what_was_there_and_leaves_nothing_beside_it(
    mode: int, tmp_path: Path
) -> None:
    path = tmp_path / "key"
    for said in (b"one", b"two"):
        write_atomically(path, said, mode)
        assert path.read_bytes() == said
    assert stat.S_IMODE(path.stat().st_mode) == mode
    assert list(tmp_path.iterdir()) == [path]


def test_it_is_on_the_disk_before_it_has_its_name_and_the_name_before_it_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    done: list[str] = []
    replace, fsync = Path.replace, os.fsync

    def noted_replace(path: Path, target: Path) -> Path:
        done.append("replace")
        return replace(path, target)

    def noted_fsync(opened: int) -> None:
        there = Path(f"/proc/self/fd/{opened}").readlink()
        done.append("synchronize the folder" if there == tmp_path else f"synchronize {there.read_bytes()!r}")
        fsync(opened)

    monkeypatch.setattr(Path, "replace", noted_replace)
    monkeypatch.setattr(os, "fsync", noted_fsync)
    write_atomically(tmp_path / "key", b"secret")
    assert done == ["synchronize b'secret'", "replace", "synchronize the folder"]


def test_a_disk_that_is_full_leaves_what_was_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "key"
    write_atomically(path, b"one")

    def full(opened: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="No space left"):
        write_atomically(path, b"two")
    assert path.read_bytes() == b"one"
    assert list(tmp_path.iterdir()) == [path]


def test_a_folder_that_cannot_be_synchronized_has_the_file_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fsync = os.fsync

    def files_alone(opened: int) -> None:
        if stat.S_ISDIR(os.fstat(opened).st_mode):
            raise OSError(22, "Invalid argument")
        fsync(opened)

    monkeypatch.setattr(os, "fsync", files_alone)
    write_atomically(tmp_path / "key", b"one")
    assert (tmp_path / "key").read_bytes() == b"one"
