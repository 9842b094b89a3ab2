"""The file by which a site is found: written again where it is lost, and overruled by a site that relays instead."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from selfconf import this_machine
from selfconf.api.sites.announced_site import AnnouncedSite
from selfconf.errors import NetworkError
from selfconf.this_machine import LocalSite


def site() -> LocalSite:
    """A site of this process."""
    return LocalSite("lab", "home", "tcp/127.0.0.1:7447", os.getpid())


@pytest.fixture
def runtime(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The runtime folder of this test."""
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(tmp_path / "run"))
    return tmp_path / "run"


def announced() -> AnnouncedSite:
    """The site, once its file was written."""
    made = AnnouncedSite(site)
    assert (made.is_there, made.is_lost, made.is_overruled) == (False, False, False)
    made.write()
    return made


def test_a_site_is_found_by_its_file_until_that_is_taken_back(runtime: Path) -> None:
    made = announced()
    assert this_machine.local_sites("lab") == [site()]
    assert made.is_there
    made.remove()
    made.remove()
    assert this_machine.local_sites("lab") == []
    assert (made.is_there, made.is_lost, made.is_overruled) == (False, False, False)


def test_a_file_that_was_removed_is_lost_until_it_is_written_again(runtime: Path) -> None:
    made = announced()
    for file in runtime.glob("*.json"):
        file.unlink()
    assert made.is_lost
    made.write_again()
    assert not made.is_lost
    assert this_machine.local_sites("lab") == [site()]


def test_what_keeps_it_from_being_written_is_said_once_and_it_is_lost_until_it_can_be(
    runtime: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def full(_: LocalSite) -> Path:
        raise NetworkError("there is no room")

    with monkeypatch.context() as patch:
        patch.setattr(this_machine, "announce", full)
        made = AnnouncedSite(site)
        with pytest.raises(NetworkError, match="no room"):
            made.write()
        for _ in range(3):
            made.write_again()
    assert [record.getMessage() for record in caplog.records] == [
        "programs of this machine may not find this site: there is no room"
    ]
    assert made.is_lost
    made.write_again()
    assert not made.is_lost


def test_a_site_that_another_has_taken_the_place_of_is_overruled(runtime: Path) -> None:
    made = announced()
    assert not made.is_overruled
    this_machine.announce_no_relay(site())
    assert made.is_overruled
    made.write()
    assert not made.is_overruled
