"""A certificate that expires: spoken of ahead, shown again when it is renewed; a task goes on over it."""

from __future__ import annotations

import json
import os
import shutil
import signal
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import replace
from datetime import datetime, timedelta, timezone
from pathlib import Path

import pytest

import selfconf as sc
from selfconf.access import Authority, CertificateWatch, KeysFolder, Principal, PrincipalKind, is_in_time
from selfconf.access.certificates import Certificate
from selfconf.access.expiry import CERTIFICATE_CHECK
from selfconf.api.sites.hub_wait import REACHED
from selfconf.bus.memory import Network
from selfconf.bus.port import Request
from selfconf.bus.presented_certificate import presented
from selfconf.bus.zenoh import GREETING, client, with_port
from selfconf.bus.zenoh.session import Security, open_session
from selfconf.errors import AuthorError, NetworkError
from selfconf.protocol.codec import decode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Introduction
from tests.cli.processes import Home, Program, component_of, dormant
from tests.harness.effort import of_keys

ALICE = Principal(PrincipalKind.CONFIGURATOR, "alice")
BOB = Principal(PrincipalKind.CONFIGURATOR, "bob")
SECOND = 1 / 86_400
"""A second in days."""


class Watched:
    """A program with a certificate, the sites that it shows it to, and a clock turned by hand."""

    def __init__(self, folder: Path, keys: KeysFolder) -> None:
        credentials = keys.credentials((PrincipalKind.CONFIGURATOR,))
        self.path, self.said, self.shown = folder, list[str](), list[str]()
        self.is_trusted = True
        self.now = Certificate.read(credentials.certificate.read_bytes()).issued
        network = Network(1)
        network.node().serve(Keys("lab").introduce("home"), self._hear)
        self._bus = network.node()
        CertificateWatch(self._bus, "lab", credentials, self.said.append, lambda: self.now, self._distrust)

    def _distrust(self) -> None:
        self.is_trusted = False

    def _hear(self, request: Request) -> None:
        self.shown.append(decode(request.payload, Introduction).certificate)
        request.finish()

    def pass_days(self, days: float) -> None:
        """Let days pass; to the bus it is a few seconds."""
        self.now += timedelta(days=days)
        until = self._bus.now() + 5.0
        self._bus.run(lambda: self._bus.now() >= until)


def test_a_certificate_is_spoken_of_before_it_expires_and_shown_again_when_it_is_renewed(tmp_path: Path) -> None:
    authority = Authority.init(tmp_path / "keys")
    authority.issue(ALICE, tmp_path / "alice", days=8.0)
    watched = Watched(tmp_path, KeysFolder(tmp_path / "alice"))
    watched.pass_days(5.9)
    assert watched.said == []
    watched.pass_days(0.2)
    (ahead,) = watched.said
    assert "the certificate of conf.alice expires at " in ahead
    assert ahead.endswith(f"; renew it: selfconf keys renew {tmp_path / 'alice'}")
    watched.pass_days(2.0)
    assert "the certificate of conf.alice has expired at " in watched.said[1]
    assert watched.shown == []
    renewed = authority.renew(tmp_path / "alice", days=30.0)
    watched.pass_days(0.0)
    assert "is good until" in watched.said[2]
    assert watched.shown == [renewed.pem.decode()]
    watched.pass_days(1.0)
    assert len(watched.said) == 3, "each is said once"


def test_a_certificate_that_is_revoked_is_told_of_once(tmp_path: Path) -> None:
    authority = Authority.init(tmp_path / "keys")
    authority.issue(ALICE, tmp_path / "alice")
    watched = Watched(tmp_path, KeysFolder(tmp_path / "alice"))
    watched.pass_days(0.0)
    assert watched.said == []
    assert watched.is_trusted
    authority.revoke(ALICE)
    watched.pass_days(0.0)
    watched.pass_days(0.1)
    assert not watched.is_trusted
    (said,) = watched.said
    assert said.startswith("the certificate of conf.alice was revoked: it is not trusted any more")


@pytest.mark.parametrize("revoked", [True, False], ids=["revoked", "expired"])
def test_a_certificate_that_is_not_good_is_withheld_until_it_is(tmp_path: Path, revoked: bool) -> None:
    """Each link that is tried with it in vain would keep others out of the hub for a while."""
    authority = Authority.init(tmp_path / "keys")
    authority.issue(ALICE, tmp_path / "alice", days=8.0)
    watched = Watched(tmp_path, KeysFolder(tmp_path / "alice"))
    shown = presented(tmp_path / "alice" / "certificate.pem")
    watched.pass_days(7.9)
    assert shown.exists()
    if revoked:
        authority.revoke(ALICE)
    watched.pass_days(0.0 if revoked else 0.2)
    assert not shown.exists()
    if not revoked:
        authority.renew(tmp_path / "alice", days=30.0)
        watched.pass_days(0.0)
        assert shown.exists()


def test_a_revocation_is_heard_of_though_its_list_is_older_than_the_certificate(tmp_path: Path) -> None:
    authority = Authority.init(tmp_path / "keys")
    authority.issue(ALICE, tmp_path / "alice")
    shutil.copytree(tmp_path / "alice", tmp_path / "elsewhere")
    watched = Watched(tmp_path, KeysFolder(tmp_path / "elsewhere"))
    watched.pass_days(0.0)
    authority.revoke(ALICE)
    listed = tmp_path / "elsewhere" / "revoked.pem"
    shutil.copy(tmp_path / "keys" / "revoked.pem", listed)
    an_hour_ago = time.time() - 3600.0  # as by `scp -p` from a host whose clock is behind
    os.utime(listed, (an_hour_ago, an_hour_ago))
    watched.pass_days(0.0)
    assert not watched.is_trusted


def test_a_revocation_is_heard_of_once_the_folder_of_keys_can_be_read_again(tmp_path: Path) -> None:
    authority = Authority.init(tmp_path / "keys")
    authority.issue(ALICE, tmp_path / "alice")
    watched = Watched(tmp_path, KeysFolder(tmp_path / "alice"))
    key = tmp_path / "alice" / "certificate.key"
    key.chmod(0o644)
    authority.revoke(ALICE)
    watched.pass_days(0.0)
    assert "others may read" in watched.said[0]
    key.chmod(0o600)
    watched.pass_days(0.0)
    assert not watched.is_trusted
    assert watched.said[1].startswith("the certificate of conf.alice was revoked")


def test_a_certificate_is_in_time_from_its_beginning_to_its_end(tmp_path: Path) -> None:
    authority = Authority.init(tmp_path / "keys")
    authority.issue(ALICE, tmp_path / "alice", days=1.0)
    authority.issue(BOB, tmp_path / "bob", days=SECOND / 1000)
    alice, bob = (KeysFolder(tmp_path / name) for name in ("alice", "bob"))
    shown = alice.credentials((PrincipalKind.CONFIGURATOR,))
    assert is_in_time(shown)
    assert not is_in_time(replace(shown, certificate=bob.path / "certificate.pem"))
    assert not is_in_time(replace(shown, certificate=tmp_path / "none.pem"))


def test_what_is_wrong_with_the_files_of_a_certificate_is_told_of_once(tmp_path: Path) -> None:
    authority = Authority.init(tmp_path / "keys")
    for holder, name in ((ALICE, "alice"), (BOB, "bob"), (ALICE, "again")):
        authority.issue(holder, tmp_path / name)
    watched = Watched(tmp_path, KeysFolder(tmp_path / "alice"))
    certificate, key = (tmp_path / f"alice/certificate.{ending}" for ending in ("pem", "key"))
    good, mine = certificate.read_bytes(), key.read_bytes()

    def said() -> str:
        before = len(watched.said)
        watched.pass_days(0.0)
        (sentence,) = watched.said[before:]
        return sentence.replace(f"{tmp_path}/", "")

    cannot = "the certificate of conf.alice cannot be renewed: "
    certificate.write_text("nonsense")
    assert said() == cannot + "alice/certificate.pem: that is no certificate in PEM"
    certificate.unlink()
    assert said() == cannot + "alice/certificate.pem: No such file or directory"
    certificate.write_bytes((tmp_path / "again/certificate.pem").read_bytes())
    assert said() == cannot + "alice/certificate.key is not the key of certificate.pem beside it"
    certificate.write_bytes((tmp_path / "bob/certificate.pem").read_bytes())
    key.write_bytes((tmp_path / "bob/certificate.key").read_bytes())
    assert said() == cannot + "alice/certificate.pem is that of conf.bob now"
    certificate.write_bytes(good)
    key.write_bytes(mine)
    assert "the certificate of conf.alice is good until " in said()
    key.chmod(0o644)
    assert said().startswith(cannot + "others may read alice/certificate.key, so it is no secret; ")
    key.chmod(0o600)
    assert "the certificate of conf.alice is good until " in said()
    watched.now -= timedelta(days=2)
    assert "the certificate of conf.alice is not valid before " in said()


def test_a_program_that_has_the_folder_of_an_authority_renews_its_certificate_by_itself(tmp_path: Path) -> None:
    authority = Authority.init(tmp_path / "keys")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("selfconf.access.authority.DAYS", 10 * SECOND)
        (authority.path / "own/conf.main/certificate.pem").unlink()
        watched = Watched(tmp_path, authority)
    watched.pass_days(0.0)
    assert watched.shown == []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Certificate, "half_over", lambda self, now=None: self.ends < watched.now + timedelta(days=1))
        watched.pass_days(0.0)
    assert len(watched.shown) == 1
    assert Certificate.read(watched.shown[0].encode()).ends > watched.now + timedelta(days=6)


@pytest.fixture
def home(tmp_path: Path) -> Iterator[Home]:
    """An ecology with keys."""
    home = Home(tmp_path, keys=True)
    yield home
    home.close()


@of_keys
@pytest.mark.process
def test_a_task_goes_on_over_the_expiry_of_every_certificate_in_it(home: Home) -> None:
    """Those of the site, of its components and of the configurator; then nobody renews them."""
    assert home.authority is not None
    kitchen, alice = home.folder / "kitchen", home.folder / "alice"
    home.authority.issue(Principal(PrincipalKind.SITE, "kitchen"), kitchen)
    home.authority.issue(ALICE, alice)
    names = ("sonar", "encoder", "tracker", "control", "drive")
    for name in (*names, "odometry"):
        dormant(home, name)
    site = home.site("kitchen", "ads", options=("--keys", str(kitchen)))
    task = home.run("--keys", str(alice))
    task.act("running")
    lives = {name: home.state(component_of(name)) for name in names}

    def renewed(days: float) -> None:
        """Renew both at once: on a busy machine the second command might come when its certificate has expired."""
        assert home.authority is not None
        for folder in (alice, kitchen):
            home.authority.renew(folder, days)

    def say(words: str, *programs: Program) -> bool:
        return home.until(lambda: all(words in one.complaints for one in programs))

    renewed(12 * SECOND)
    assert say("expires at ", site, task)
    expired = [KeysFolder(folder).own() for folder in (alice, kitchen)]
    expired += [KeysFolder(folder).own() for folder in (kitchen / "components").iterdir()]
    renewed(1.0)
    assert say("is good until ", site, task)
    assert home.until(lambda: all(one.ends < datetime.now(timezone.utc) for one in expired))
    for name in names:
        assert home.until(lambda name=name: bool(home.active(name)))
        before, after = lives[name], home.state(component_of(name))
        assert before is not None
        assert after is not None
        assert after.life == before.life, "no component was started again"
    (home.folder / "tracker.fail").touch()
    assert task.act("lost")["component"] == component_of("tracker"), "nothing was lost before"

    renewed(5 * SECOND)
    assert say("has expired at ", site, task)
    assert "renew it: selfconf keys renew" in site.complaints
    assert task.end(signal.SIGKILL)


def attempts_at(listening: socket.socket) -> int:
    """How many connections have come since the last look, each closed at once."""
    number = 0
    with suppress(BlockingIOError):
        while True:
            listening.accept()[0].close()
            number += 1
    return number


@of_keys
@pytest.mark.process
def test_a_program_whose_certificate_has_expired_tries_no_link_until_it_is_renewed(tmp_path: Path) -> None:
    """A hub lets nobody in for a tenth of a second after each link that it refuses."""
    authority, pause = Authority.init(tmp_path / "keys"), threading.Event()
    authority.issue(ALICE, tmp_path / "alice", days=5 * SECOND)
    mine, said = KeysFolder(tmp_path / "alice").credentials((PrincipalKind.CONFIGURATOR,)), list[str]()

    def until(condition: Callable[[], bool]) -> bool:
        deadline = time.monotonic() + 20.0
        while not condition() and time.monotonic() < deadline:
            pause.wait(0.05)
        return condition()

    with socket.create_server(("127.0.0.1", 0)) as other:
        other.setblocking(False)
        endpoint, second = with_port("tls/127.0.0.1:0"), f"tls/127.0.0.1:{other.getsockname()[1]}"
        hub = open_session("router", listen=[endpoint], security=Security(authority.credentials((PrincipalKind.SITE,))))
        bus = client([endpoint, second], credentials=mine)
        try:
            CertificateWatch(bus, "lab", mine, said.append)
            bus.run_aside()
            assert until(lambda: not bus.link and any("has expired at" in one for one in said))
            pause.wait(CERTIFICATE_CHECK)
            attempts_at(other)
            pause.wait(2.0)  # in which it would try some ten times
            assert attempts_at(other) == 0
            authority.renew(tmp_path / "alice")
            assert until(lambda: bool(bus.link))
        finally:
            bus.close()
            hub.close()


@of_keys
@pytest.mark.process
def test_a_program_that_has_joined_and_asks_nothing_tries_no_link_by_a_certificate_that_has_expired(home: Home) -> None:
    assert home.authority is not None
    alice, pause = home.folder / "alice", threading.Event()
    home.authority.issue(ALICE, alice, days=8 * SECOND)
    home.site("kitchen", "ads")

    def found() -> bool:
        with suppress(NetworkError):
            return bool(living.components)
        return False

    with socket.create_server(("127.0.0.1", 0)) as other:
        other.setblocking(False)
        second = f"tls/127.0.0.1:{other.getsockname()[1]}"
        with sc.join(home.ecology, connect=(home.endpoint(), second), keys=alice) as living:
            assert living.components
            pause.wait(8.0 + 3 * CERTIFICATE_CHECK)  # nothing is asked until it has expired, and that was seen
            attempts_at(other)
            pause.wait(2.0)  # in which it would try some ten times
            assert attempts_at(other) == 0
            with pytest.raises(AuthorError, match=r"the certificate of conf.alice has expired at .*; renew it with"):
                _ = living.components
            home.authority.renew(alice)
            assert home.until(found)


@of_keys
@pytest.mark.process
def test_a_site_whose_certificate_has_expired_takes_the_place_of_no_hub(home: Home) -> None:
    """The hub does not let it in, as if it hung; others would not connect to one of its own."""
    assert home.authority is not None
    for name in ("kitchen", "attic"):
        home.authority.issue(Principal(PrincipalKind.SITE, name), home.folder / name)
    home.site("kitchen", "ads/tracker.ttl", options=("--keys", str(home.folder / "kitchen")))
    attic = home.site("attic", "ads/drive.ttl", options=("--keys", str(home.folder / "attic")))
    home.authority.renew(home.folder / "attic", days=5 * SECOND)
    assert home.until(lambda: "has expired at " in attic.complaints)
    files = [home.runtime / f"{home.ecology}@{name}.json" for name in ("kitchen", "attic")]
    relaying = [True, False]
    assert not home.until(
        lambda: [json.loads(one.read_text())["relays"] for one in files] != relaying, 2 * (GREETING + REACHED)
    )
    home.authority.renew(home.folder / "attic")
    assert home.until(lambda: "is good until " in attic.complaints)


@of_keys
@pytest.mark.process
@pytest.mark.parametrize("with_authority", [False, True], ids=["own folder", "folder of the authority"])
def test_a_site_that_is_revoked_ends_though_all_are_connected_to_its_hub(home: Home, with_authority: bool) -> None:
    assert home.authority is not None
    kitchen = Principal(PrincipalKind.SITE, "kitchen")
    keys = home.authority.path
    if not with_authority:
        keys = home.folder / "kitchen"
        home.authority.issue(kitchen, keys)
    for name in ("sonar", "encoder", "tracker", "control", "drive", "odometry"):
        dormant(home, name)
    served = [f"ads/{name}.ttl" for name in ("sonar", "encoder", "odometry", "control", "drive")]
    hub = home.site("kitchen", "ads/tracker.ttl", options=("--keys", str(keys)))
    attic = home.site("attic", *served)
    task = home.run()
    task.act("running")
    home.authority.revoke(kitchen)
    assert hub.ended() == 2
    assert "the site kitchen and its components have ended, as its certificate was revoked" in hub.complaints
    assert task.act("lost")["component"] == component_of("tracker"), "that is its own"
    task.act("running")
    assert not attic.over, attic.complaints
    again = home.selfconf(
        "site", "ads/tracker.ttl", "--ecology", home.ecology, "--name", "kitchen", "--keys", str(keys)
    )
    assert again.ended() == 2
    assert "revoked" in again.complaints


@of_keys
@pytest.mark.process
def test_a_run_that_is_revoked_ends_and_says_so(home: Home) -> None:
    assert home.authority is not None
    alice = home.folder / "alice"
    home.authority.issue(ALICE, alice)
    for name in ("sonar", "encoder", "tracker", "control", "drive"):
        dormant(home, name)
    home.site("kitchen", "ads")
    task = home.run("--keys", str(alice))
    task.act("running")
    home.authority.revoke(ALICE)
    assert task.act("stopped")["owed"] == []
    assert task.ended() == 2
    assert "has ended, as the certificate of this program was revoked" in task.complaints
    assert home.until(lambda: not home.active("sonar", "encoder", "tracker", "control", "drive"))
