"""Which files a path stands for, and what is said of those that cannot be read."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from selfconf import files
from selfconf.errors import AuthorError
from selfconf.site import Shelf

CLOCK = "@prefix sc: <https://w3id.org/selfconf#> . @prefix : <urn:x:> . :clock a sc:Component, :Clock ."


@pytest.fixture
def ads(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with one in it that may not be read; root may read everything, so it is refused here."""
    for name in ("open", "closed", "open/folder.ttl"):
        (tmp_path / name).mkdir()
    for name in ("open/a.ttl", "open/notes.txt", "closed/b.ttl", "z.ttl"):
        (tmp_path / name).write_text(CLOCK)
    scandir = os.scandir

    def guarded(path: str) -> Iterator[os.DirEntry[str]]:
        if Path(path).name == "closed":
            raise PermissionError(13, "Permission denied", path)
        return scandir(path)

    monkeypatch.setattr(os, "scandir", guarded)
    return tmp_path


def test_a_folder_stands_for_the_turtle_files_below_it(ads: Path) -> None:
    assert files.within(ads / "open") == [ads / "open" / "a.ttl"]
    assert files.within(ads / "z.ttl") == [ads / "z.ttl"]


def test_a_folder_that_cannot_be_read_is_not_passed_over_in_silence(ads: Path) -> None:
    with pytest.raises(AuthorError, match=r"cannot read the folder .*closed: Permission denied"):
        files.within(ads)


def test_a_site_says_once_what_it_cannot_read_and_serves_the_rest(ads: Path) -> None:
    (ads / "z.ttl").unlink()
    said: list[str] = []
    shelf = Shelf([ads], said.append)
    assert shelf.refresh()
    assert not shelf.refresh()
    (sentence,) = said
    assert sentence.startswith("left out: cannot read the folder")
    assert list(shelf.advertisements) == ["urn:x:clock"]
