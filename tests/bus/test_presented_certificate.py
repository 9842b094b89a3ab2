"""A certificate that Zenoh finds, or not, by one path."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from selfconf.bus import presented_certificate
from selfconf.bus.presented_certificate import presented, withhold


def test_it_is_found_as_it_lies_in_its_file_unless_it_is_withheld(tmp_path: Path) -> None:
    own = tmp_path / "keys" / "certificate.pem"
    own.parent.mkdir()
    own.write_text("first")
    shown = presented(own)
    assert (shown.read_text(), presented(own)) == ("first", shown)
    withhold(own, True)
    assert not shown.exists()
    opened = len(list(Path("/proc/self/fd").iterdir()))
    for withheld in (True, False, True):
        withhold(own, withheld)
    assert len(list(Path("/proc/self/fd").iterdir())) == opened, "it is looked at each second"
    (tmp_path / "new").write_text("second")
    (tmp_path / "new").replace(own)
    withhold(own, False)
    assert shown.read_text() == "second"


def test_a_folder_that_was_replaced_is_found_again(tmp_path: Path) -> None:
    own = tmp_path / "keys" / "certificate.pem"
    own.parent.mkdir()
    own.write_text("first")
    shown = presented(own)
    shutil.rmtree(own.parent)
    with pytest.raises(FileNotFoundError):
        withhold(own, False)
    own.parent.mkdir()
    own.write_text("second")
    withhold(own, False)
    assert shown.read_text() == "second"


def test_where_a_process_does_not_see_its_descriptors_nothing_is_withheld(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(presented_certificate, "DESCRIPTORS", tmp_path / "proc")
    own = tmp_path / "certificate.pem"
    own.write_text("first")
    assert presented(own) == own
    withhold(own, True)
    assert own.read_text() == "first"


def test_a_folder_that_is_not_there_is_left_to_zenoh(tmp_path: Path) -> None:
    own = tmp_path / "keys" / "certificate.pem"
    assert presented(own) == own
