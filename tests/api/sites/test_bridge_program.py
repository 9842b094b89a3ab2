"""A bridge as a program refuses what it cannot bridge before it opens anything, and leaves no folder behind."""

from __future__ import annotations

import fcntl
import os
import tempfile
from pathlib import Path

import pytest

import selfconf as sc
from selfconf.api.sites import bridge_program
from selfconf.api.sites.bridge_program import serve_bridge, serve_things
from selfconf.api.sites.site_program import SiteOptions
from selfconf.bridging import Bridge, ForeignWorld


def unopened(bridge: Bridge) -> ForeignWorld:
    """A world that must not be opened."""
    raise AssertionError("nothing is to be opened")


@pytest.mark.parametrize(("ecology", "name"), [("no/name", None), ("home", "no/name"), (None, None)])
def test_a_name_that_is_none_ends_it(
    ecology: str | None, name: str | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    said: list[str] = []
    with pytest.raises(sc.SelfconfError):
        serve_bridge(unopened, SiteOptions(ecology=ecology, name=name), said.append)
    assert said == []
    assert list(tmp_path.iterdir()) == []


def test_its_folder_is_locked_so_that_it_is_not_removed_for_its_age(monkeypatch: pytest.MonkeyPatch) -> None:
    served: list[Path] = []

    def serve(options: SiteOptions, *_: object) -> None:
        (folder,) = options.paths
        descriptor = os.open(folder, os.O_RDONLY)
        with pytest.raises(BlockingIOError):
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        os.close(descriptor)
        served.append(folder)

    monkeypatch.setattr(bridge_program, "serve", serve)
    serve_bridge(unopened, SiteOptions(ecology="home"), print)
    assert not served[0].exists()


def test_sources_and_credentials_have_to_be_there(tmp_path: Path) -> None:
    pytest.importorskip("aiohttp", reason="the extra `wot` is not installed")
    for sources, credentials, words in (
        ([str(tmp_path / "none.json")], None, "no file or folder"),
        ([""], None, "an empty text is no path"),
        ([str(tmp_path)], tmp_path / "none.json", "cannot read the credentials"),
    ):
        with pytest.raises(sc.SelfconfError, match=words):
            serve_things(sources, 1.0, credentials, (), SiteOptions(ecology="home"), print)


def test_files_of_which_none_can_be_read_end_it_as_does_what_is_no_url_and_a_folder_may_fill_later(
    tmp_path: Path,
) -> None:
    pytest.importorskip("aiohttp", reason="the extra `wot` is not installed")
    bad, worse, lamp = (tmp_path / f"{name}.json" for name in ("bad", "worse", "lamp"))
    bad.write_text("lamp")
    worse.write_text('{"title": ')
    lamp.write_text('{"id": "urn:x:lamp", "title": "Lamp"}')
    (tmp_path / "things").mkdir()
    nowhere = SiteOptions()  # which is refused once the sources are accepted
    for sources, words in (
        ([bad], r"bad\.json:1:1: this is not JSON"),
        ([bad, worse], r"bad\.json:1:1: this is not JSON"),
        ([bad, lamp], "give ecology='NAME'"),
        ([bad, tmp_path / "things"], "give ecology='NAME'"),
        (["http://[::1/"], "is no http or https URL"),
        ([bad, "http://127.0.0.1:1/"], "give ecology='NAME'"),
    ):
        with pytest.raises(sc.SelfconfError, match=words):
            serve_things([str(source) for source in sources], 1.0, None, (), nowhere, print)
