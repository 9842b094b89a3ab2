"""A site as a program refuses what it cannot serve before it opens anything."""

from __future__ import annotations

import signal
import socket
from collections.abc import Iterator
from pathlib import Path

import pytest

import selfconf as sc
from selfconf import rendezvous
from selfconf.api.sites.site_program import SiteOptions, serve
from selfconf.errors import SelfconfError
from tests.cli.command import run
from tests.cli.processes import Home


@pytest.mark.parametrize(
    ("path", "ecology", "name"),
    [("no-such-folder", "home", None), ("examples/clock", "no/name", None), ("examples/clock", "home", "no/name")],
)
def test_a_path_that_is_not_there_and_a_name_that_is_none_end_it(path: str, ecology: str, name: str | None) -> None:
    said: list[str] = []
    with pytest.raises(sc.SelfconfError):
        serve(SiteOptions((Path(path),), ecology, name), said.append)
    assert said == []
    assert sc.sites() == ()


@pytest.fixture
def home(tmp_path: Path) -> Iterator[Home]:
    """An ecology of a test's own, without any process yet."""
    home = Home(tmp_path)
    yield home
    home.close()


@pytest.mark.process
@pytest.mark.parametrize(
    ("ecology", "name", "listen", "connect", "words"),
    [
        ("a/b", None, None, (), "cannot name an ecology"),
        ("e", "a b", None, (), "cannot name a site"),
        ("e", "a", "here", (), "here"),
        ("e", "a", None, ("there",), "there"),
    ],
)
def test_a_site_that_cannot_be_announces_nothing(
    ecology: str,
    name: str | None,
    listen: str | None,
    connect: tuple[str, ...],
    words: str,
    tmp_path: Path,
    runtime_folder: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delenv("SELFCONF_KEYS", raising=False)  # a site with keys takes over what its process prints
    said: list[str] = []
    with pytest.raises(SelfconfError, match=words):
        serve(SiteOptions((tmp_path,), ecology, name, listen, connect), said.append)
    assert said == []
    assert list(runtime_folder.glob("*.json")) == []


@pytest.mark.parametrize("given", [["/dev/zero"], ["ads", "--ontology", "/dev/zero"]])
@pytest.mark.process
def test_a_site_does_not_begin_where_reading_would_not_end(home: Home, given: list[str]) -> None:
    site = home.selfconf("site", *given, "--ecology", home.ecology)
    assert site.ended() == 2
    assert "cannot read /dev/zero: it is a device and no file" in site.complaints


@pytest.mark.process
def test_a_site_says_where_nothing_answers_that_it_is_to_connect_to(home: Home) -> None:
    nobody = f"{'tls' if 'SELFCONF_KEYS' in home.environment else 'tcp'}/127.0.0.1:1"
    site = home.selfconf("site", "ads", "--ecology", home.ecology, "--connect", nobody)
    assert home.until(lambda: f"nothing answers at {nobody} yet; this site goes on trying" in site.complaints)
    assert site.end(signal.SIGINT) == 0


@pytest.mark.process
def test_a_site_without_a_name_gets_one_and_leaves_when_it_is_told_to(home: Home) -> None:
    site = home.selfconf("site", "ads", "--ecology", home.ecology)
    assert home.until(lambda: len(list(home.runtime.glob("*.json"))) == 1)
    (announced,) = home.runtime.glob("*.json")
    assert announced.name.startswith(f"{home.ecology}@s")
    assert site.end(signal.SIGTERM) == 0
    assert list(home.runtime.glob("*.json")) == []


@pytest.mark.process
def test_sites_that_start_at_the_same_moment_do_not_miss_each_other(
    home: Home, capsys: pytest.CaptureFixture[str]
) -> None:
    for name, path in (("a", "ads/tracker.ttl"), ("b", "ads/drive.ttl"), ("c", "ads/pippi.ttl")):
        home.selfconf("site", path, "--ecology", home.ecology, "--name", name)
    assert home.until(lambda: len(list(home.runtime.glob("*.json"))) == 3)

    def sites(name: str) -> list[str]:
        arguments = "--ecology", home.ecology, "--connect", home.endpoint(name)
        sites: list[str] = run(capsys, "discover", "--format", "json", *arguments).body["sites"]
        return sites

    assert home.until(lambda: all(sites(name) == ["a", "b", "c"] for name in "abc"), 5.0)


@pytest.mark.process
def test_where_the_usual_port_of_an_ecology_is_taken_any_other_will_do(
    home: Home, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(home.runtime))
    usual = rendezvous.usual_endpoints(home.ecology, secure=home.authority is not None)
    with socket.create_server(("127.0.0.1", int(usual[0].rpartition(":")[2]))):
        site = home.site("a", "ads")
        assert home.endpoint() == usual[1]
    assert site.end() == 0
    assert site.complaints.count("\n") == 1


@pytest.mark.process
def test_a_second_site_of_the_same_folder_says_which_site_serves_it_already(home: Home) -> None:
    first = home.site("a", "ads")
    home.site("c", "ads/tracker.ttl")
    second = home.site("b", "../" + home.folder.name + "/ads")
    said = f"site a, process {first.number}, serves {home.folder / 'ads'} already: end one of the two\n"
    assert home.until(lambda: said in second.complaints), second.complaints
    assert second.complaints.count("already") == 1


@pytest.mark.process
def test_a_second_site_of_a_name_does_not_start_and_says_who_has_it(home: Home, tmp_path: Path) -> None:
    first = home.site("a", "ads/tracker.ttl")
    elsewhere = {**home.environment, "SELFCONF_RUNTIME_DIR": str(tmp_path / "elsewhere")}  # as on another host
    home.environment, here = elsewhere, home.environment
    arguments = "--ecology", home.ecology, "--name", "a", "--connect", home.endpoint("a")
    second = home.selfconf("site", "ads/drive.ttl", *arguments)
    assert second.ended() == 2
    assert f"a site 'a' of ecology {home.ecology!r} lives already, process {first.number} on host" in second.complaints
    assert second.complaints.count("\n") == 1
    home.environment = here


@pytest.mark.process
def test_two_sites_of_a_name_that_meet_later_say_so(home: Home, tmp_path: Path) -> None:
    if home.authority is not None:
        pytest.skip("with keys a third site passes nothing on, so the two do not meet by it")
    first = home.site("a", "ads/tracker.ttl")
    home.environment, here = {**home.environment, "SELFCONF_RUNTIME_DIR": str(tmp_path / "elsewhere")}, home.environment
    second = home.selfconf("site", "ads/drive.ttl", "--ecology", home.ecology, "--name", "a")
    assert home.until(lambda: f" on {home.protocol}/" in second.complaints)
    there = second.complaints.rpartition(" on ")[2].strip()
    home.environment = here
    bridge = home.site("bridge", "ads/pippi.ttl", connect=(there,))
    assert home.until(lambda: f"as well, process {second.number} on host" in first.complaints)
    assert home.until(lambda: f"as well, process {first.number} on host" in second.complaints)
    assert not bridge.over
