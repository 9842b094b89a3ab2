"""A site with keys: refused where they are not its own, met by another host, handed on when its relay is gone."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from pathlib import Path

import pytest

from selfconf.access import Authority, Principal, PrincipalKind
from selfconf.api.sites.local_site import SiteProcess
from selfconf.api.sites.secured_site import SecuredSite
from selfconf.errors import AuthorError
from tests.cli.processes import Home, component_of, dormant

pytestmark = pytest.mark.process
DOORBELL = Path(__file__).parents[3] / "examples/doorbell"


def test_the_keys_of_somebody_else_are_refused(tmp_path: Path) -> None:
    authority = Authority.init(tmp_path / "keys")
    authority.issue(Principal(PrincipalKind.SITE, "attic"), tmp_path / "attic")
    authority.issue(Principal(PrincipalKind.READER, "alice"), tmp_path / "alice")
    with pytest.raises(AuthorError, match="is for the site attic, not for cellar"):
        SecuredSite(tmp_path / "attic", "cellar")
    with pytest.raises(AuthorError, match=r"speaks for read.alice; this takes a certificate of site.NAME"):
        SecuredSite(tmp_path / "alice", None)


def test_a_site_of_any_name_takes_the_keys_of_an_authority(tmp_path: Path) -> None:
    authority = Authority.init(tmp_path / "keys")
    authority.issue(Principal(PrincipalKind.CONFIGURATOR, "alice"), tmp_path / "alice")
    SiteProcess([tmp_path], keys=tmp_path / "keys")
    with pytest.raises(AuthorError, match=r"not the folder of an authority.*start one with `selfconf site`"):
        SiteProcess([tmp_path], keys=tmp_path / "alice")


@pytest.fixture
def home(tmp_path: Path) -> Iterator[Home]:
    """An ecology with keys."""
    (tmp_path / "home").mkdir()
    home = Home(tmp_path / "home", keys=True)
    yield home
    home.close()


def _discovered(home: Home) -> str:
    """What `discover` prints."""
    found = home.selfconf("discover", "--ecology", home.ecology, "--format", "json")
    told = found.rest()
    found.ended()
    return told


def test_two_hosts_are_one_ecology(home: Home, tmp_path: Path) -> None:
    assert home.authority is not None
    (tmp_path / "attic").mkdir()
    attic = Home(tmp_path / "attic", keys=False)
    attic.ecology, attic.keys = home.ecology, home.keys
    try:
        for name in ("sonar", "encoder", "tracker", "control", "drive"):
            dormant(home, name)
            (attic.folder / f"ads/{name}.ttl").unlink()
        dormant(attic, "odometry")
        (attic.folder / "ads/pippi.ttl").unlink()
        (home.folder / "ads/odometry.ttl").unlink()
        home.authority.issue(Principal(PrincipalKind.SITE, "attic"), attic.folder / "keys", ["127.0.0.2"])
        attic.environment["SELFCONF_KEYS"] = str(attic.folder / "keys")
        home.site("home", "ads")
        attic.site("attic", "ads", connect=(home.endpoint("home"),), options=("--listen", "tls/127.0.0.2:0"))
        # The site of the other host is there before the task looks for who may take over.
        assert home.until(lambda: str(component_of("odometry")) in _discovered(home))
        task = home.run("--wait")
        task.act("running")
        (home.folder / "tracker.fail").touch()
        task.act("lost")
        roles = {one["role"]: one["components"] for one in task.act("running")["configuration"]["roles"]}
        assert roles["https://example.org/peis-home#position"] == [component_of("odometry")]
        assert task.end(signal.SIGINT) == 0
    finally:
        attic.close()


def test_two_sites_of_a_host_have_keys_of_their_own(home: Home) -> None:
    """The second one is a client of the hub of the first, which believes the components of both."""
    assert home.authority is not None
    for name in ("sonar", "encoder", "control", "drive", "tracker"):
        dormant(home, name)
    for name, *served in (("first", "pippi", "sonar", "encoder", "control", "drive"), ("second", "tracker")):
        home.authority.issue(Principal(PrincipalKind.SITE, name), home.folder / f"{name}-keys")
        home.site(name, *(f"ads/{one}.ttl" for one in served), options=("--keys", str(home.folder / f"{name}-keys")))
    task = home.run("--wait")
    task.act("running")  # of one site alone the template would not be filled
    assert task.end(signal.SIGINT) == 0


def test_another_site_of_the_host_relays_when_the_first_is_gone(home: Home) -> None:
    dormant(home, "tracker")
    first = home.site("first", "ads/drive.ttl")
    home.site("second", "ads/tracker.ttl")
    first.end(signal.SIGKILL)
    home._meeting("first").unlink(missing_ok=True)

    def seen() -> bool:
        found = home.selfconf("discover", "--ecology", home.ecology, "--format", "json")
        return found.ended() == 0

    assert home.until(seen)


def test_beyond_loopback_keys_are_needed(tmp_path: Path) -> None:
    bare = Home(tmp_path, keys=False)
    try:
        refused = bare.selfconf("site", "ads", "--ecology", bare.ecology, "--listen", "tcp/0.0.0.0:0")
        assert refused.ended() == 2
        assert "without keys by everybody there: give --keys DIR" in refused.complaints
    finally:
        bare.close()


def test_an_operation_is_called_on_another_host(home: Home, tmp_path: Path) -> None:
    """Hubs let a site ask for operations in the name of the components that it advertises."""
    assert home.authority is not None
    (tmp_path / "attic").mkdir()
    attic = Home(tmp_path / "attic", keys=False)
    attic.ecology = home.ecology
    try:
        home.authority.issue(Principal(PrincipalKind.SITE, "attic"), attic.folder / "keys", ["127.0.0.2"])
        attic.environment["SELFCONF_KEYS"] = str(attic.folder / "keys")
        home.site("home", str(DOORBELL / "doorbell.ttl"))
        attic.site(
            "attic",
            str(DOORBELL / "cameras.ttl"),
            connect=(home.endpoint("home"),),
            options=("--listen", "tls/127.0.0.2:0"),
        )
        run = home.selfconf("run", str(DOORBELL / "answer-the-door.ttl"), "--ecology", home.ecology, "--wait")
        printed = home.runtime / f"log/{home.ecology}@home.log"
        # By the camera that the task is configured with: it may have healed with the other one.
        answered = "-camera: the postman"
        assert home.until(lambda: printed.is_file() and answered in printed.read_text()), run.complaints
        assert run.end(signal.SIGINT) == 0
    finally:
        attic.close()
