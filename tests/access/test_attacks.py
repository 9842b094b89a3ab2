"""Outsiders are not let in; insiders do what their own name allows, and nothing else; and the site says who tried."""

from __future__ import annotations

import json
import ssl
from collections.abc import Callable, Iterator
from datetime import timedelta
from pathlib import Path

import pytest
import zenoh

from selfconf.access import Authority, HostAuthority, Principal, PrincipalKind, certificates, open_keys
from selfconf.access.certificate_files import read_pair
from selfconf.access.introduction import introduce
from selfconf.bus.credentials import Credentials
from selfconf.bus.zenoh import Security, ZenohBus, client, open_session
from selfconf.bus.zenoh import session as session_setup
from selfconf.errors import NetworkError
from tests.access.attacks import ATTACKS, Stage, refused
from tests.cli.command import run
from tests.cli.processes import Home, component_of, dormant

pytestmark = pytest.mark.process

SITE = "home"
READS = {
    "reads who may do what",
    "reads advertisements",
    "reads which components live",
    "reads a configuration",
    "asks for a task",
    "hears what becomes of tasks",
    "hears what configurators do",
}
HEARS = {"hears signals", "asks for the last signal", "hears FAIL", "reads which components live"}
CALLS = {
    "asks a component's state",
    "reserves a component",
    "releases a component",
    "wakes a component",
    "ends a component",
    "hands a task to the site",
    "stops a task",
    "reads what components have printed",
}
RELAYS = {
    "life of a configurator",
    "forges a status",
    "forges a configuration",
    "forges an event",
    "forges a task",
}
MAY: dict[str, set[str]] = {
    "comp": HEARS | {"asks for an operation as itself"},
    "read": READS,
    "conf": READS | HEARS | CALLS,
    "site": READS | HEARS | CALLS | RELAYS,
    "boss": set(),
    "router": HEARS,
}
"""What each kind of insider may do; what a site may do with configurators is what it does for those that connect to it.

`router` is a component whose session says that it is a router, as those of sites are: it learns of no operations.
"""
NOBODY_MAY = set(ATTACKS).difference(*MAY.values())


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Home]:
    """A site with keys, one of whose components lives, and another one is dormant."""
    home = Home(tmp_path_factory.mktemp("guarded"), keys=True)
    dormant(home, "tracker")
    dormant(home, "odometry")
    site = home.site(SITE, "ads")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SELFCONF_RUNTIME_DIR", str(home.runtime))
        wake(home)
        yield home
    assert not site.over, site.complaints
    home.close()


@pytest.fixture(autouse=True)
def its_keys(home: Home, monkeypatch: pytest.MonkeyPatch) -> None:
    """Commands of a test have the keys of the home."""
    monkeypatch.setenv("SELFCONF_KEYS", home.environment["SELFCONF_KEYS"])


def wake(home: Home) -> None:
    """Have the victim started by its site, with the certificate that the site makes for it."""
    from selfconf.protocol.codec import encode
    from selfconf.protocol.messages import Wake

    assert home.ask(home.keys.wake(SITE), encode(Wake(component_of("tracker")))).samples
    assert home.until(lambda: home.state(component_of("tracker")) is not None)


def shown(home: Home, kind: str, folder: Path) -> Credentials:
    """What an attacker of a kind shows: a good certificate of the home's authority."""
    assert home.authority is not None
    if kind in ("comp", "router"):
        keys = open_keys(HostAuthority(home.authority).component(Principal.component(component_of("sonar"))))
        return keys.credentials((PrincipalKind.COMPONENT,))
    if kind == "boss":
        return strange(home, folder, "boss")
    home.authority.issue(Principal(PrincipalKind(kind), "eve"), folder)
    return open_keys(folder).credentials((PrincipalKind(kind),))


def strange(home: Home, folder: Path, name: str) -> Credentials:
    """What somebody shows whom the authority has given a certificate with a name that means nothing here."""
    assert home.authority is not None
    authority, key = read_pair(home.authority.path / "authority")
    mine = certificates.new_key()
    principal = Principal(PrincipalKind.READER, "x")
    folder.mkdir()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Principal, "common_name", property(lambda self: name))
        certificate = certificates.issue(authority, key, principal, mine.public_key(), (), 1.0)
    return written(folder, home.authority.authority, certificate, mine)


def written(
    folder: Path, authority: certificates.Certificate, certificate: certificates.Certificate, key: certificates.Key
) -> Credentials:
    """Credentials in files of a folder."""
    (folder / "authority.pem").write_bytes(authority.pem)
    (folder / "certificate.pem").write_bytes(certificate.pem)
    (folder / "certificate.key").write_bytes(certificates.key_pem(key))
    own = folder / "certificate"
    return Credentials(
        certificate.common_name, own.with_suffix(".pem"), own.with_suffix(".key"), folder / "authority.pem", folder
    )


@pytest.fixture(scope="module", params=sorted(MAY))
def insider(
    request: pytest.FixtureRequest, home: Home, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[tuple[str, Stage]]:
    """An insider of each kind at the hub of the site, with an observer that may do everything."""
    kind: str = request.param
    credentials = shown(home, kind, tmp_path_factory.mktemp(kind) / "keys")
    endpoint = [home.endpoint(SITE)]
    attacker = (
        ZenohBus(open_session("router", connect=endpoint, security=Security(credentials)))
        if kind == "router"
        else client(endpoint, credentials=credentials)
    )
    if kind == "boss":
        with pytest.raises(NetworkError, match="names no principal"):
            introduce(attacker, home.ecology, credentials)
    else:
        introduce(attacker, home.ecology, credentials)
    assert home.until(lambda: home.state(component_of("tracker")) is not None)  # its hub may be opened anew
    assert home.authority is not None
    observer = client(endpoint, credentials=home.authority.credentials((PrincipalKind.SITE,), SITE))
    victim, dormant = component_of("tracker"), component_of("odometry")
    yield kind, Stage(home.keys, SITE, victim, dormant, component_of("sonar"), attacker, observer)
    attacker.close()
    observer.close()


@pytest.mark.parametrize("attack", sorted(ATTACKS))
def test_an_insider_does_what_its_name_allows_and_nothing_else(insider: tuple[str, Stage], attack: str) -> None:
    kind, stage = insider
    assert ATTACKS[attack](stage) == (attack in MAY[kind])


def test_the_site_says_who_has_tried(
    insider: tuple[str, Stage], home: Home, capsys: pytest.CaptureFixture[str]
) -> None:
    kind, stage = insider
    name = name_of(kind)
    ATTACKS["life for another"](stage)

    def noted() -> bool:
        return any(one[:2] == (name, "Liveliness Token") and _chunk(stage) in one[2] for one in tried(home, capsys))

    assert home.until(noted)


def name_of(kind: str) -> str:
    """The common name of an attacker."""
    sonar = Principal.component(component_of("sonar")).common_name
    return {"boss": "boss", "comp": sonar, "router": sonar}.get(kind, f"{kind}.eve")


def test_a_key_that_is_worded_like_the_log_of_zenoh_blames_nobody_else(
    insider: tuple[str, Stage], home: Home, capsys: pytest.CaptureFixture[str]
) -> None:
    """What is refused is read from lines of a log, and a key may hold line breaks."""
    kind, stage = insider
    target = "zenoh::net::routing::interceptor"
    forged = [
        f"{start}2126-01-01T00:00:00.000000Z TRACE rx-0 ThreadId({number:02}) {target}{text}"
        for number in range(1, 40)
        for start in ("", "\x1b[2m")
        for text in (
            "::access_control: 00 on Interface(lo)+CertCommonName(conf.honest)+0 is unauthorized to Put (ingress) on a",
            ": Msg intercepted!",
        )
    ]
    key = stage.keys.life(stage.victim, f"forged-by-{kind}")
    assert not stage.live("\n".join((key, *forged)))
    assert home.until(lambda: any(one[0] == name_of(kind) and one[2] == key for one in tried(home, capsys)))
    assert not [one for one in tried(home, capsys) if one[0] == "conf.honest"]


def test_no_session_takes_the_place_of_another(free: Stage, home: Home, tmp_path: Path) -> None:
    """Zenoh knows sessions by numbers that others get to know, and that each chooses for itself."""
    security, session = Security(shown(home, "comp", tmp_path)), free.observer._session
    for number in (session.zid(), *session.info.routers_zid()):
        config = session_setup._config("client", [], [home.endpoint(SITE)], 0.3, False, security)
        config.insert_json5("id", json.dumps(str(number)))
        with pytest.raises(zenoh.ZError):
            zenoh.open(config)
    assert free.asked(free.observer, free.keys.access(SITE)).samples, "it has not lost its place"


def _chunk(stage: Stage) -> str:
    return Principal.component(stage.victim).name


def tried(home: Home, capsys: pytest.CaptureFixture[str]) -> list[tuple[str, str, str]]:
    """Who has tried what, as `access` tells."""
    return refused(run(capsys, "access", *home.arguments(), "--format", "json").out)


def test_who_does_what_it_may_is_not_complained_of(home: Home, capsys: pytest.CaptureFixture[str]) -> None:
    victim = Principal.component(component_of("tracker")).common_name
    assert not [attempt for attempt in tried(home, capsys) if attempt[0] in (victim, "conf.main", f"site.{SITE}")]


Outsider = Callable[[Home, Path], Credentials]


def of_another_authority(home: Home, folder: Path) -> Credentials:
    """A certificate with a good name, of an authority that nobody here knows."""
    other = Authority.init(folder.with_name("other"))
    assert home.authority is not None
    return Credentials(
        "conf.main",
        other.credentials((PrincipalKind.CONFIGURATOR,)).certificate,
        other.credentials((PrincipalKind.CONFIGURATOR,)).key,
        home.authority.path / "authority.pem",
        folder,
    )


def expired(home: Home, folder: Path) -> Credentials:
    """A certificate that was good a second ago."""
    assert home.authority is not None
    folder.mkdir()
    authority, key = read_pair(home.authority.path / "authority")
    mine = certificates.new_key()
    principal = Principal(PrincipalKind.CONFIGURATOR, "main")
    certificate = certificates.issue(authority, key, principal, mine.public_key(), (), -1 / 86400)
    return written(folder, authority, certificate, mine)


def not_yet(home: Home, folder: Path) -> Credentials:
    """A certificate that will be good tomorrow."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(certificates, "CLOCKS_DIFFER", -timedelta(days=1))
        assert home.authority is not None
        home.authority.issue(Principal(PrincipalKind.CONFIGURATOR, "early"), folder, days=2)
    own = folder / "certificate"
    return Credentials("conf.early", own.with_suffix(".pem"), own.with_suffix(".key"), folder / "authority.pem", folder)


@pytest.mark.parametrize(
    ("outsider", "words", "noted"),
    [
        (of_another_authority, "does not know the authority", "UnknownIssuer"),
        (expired, "has expired", "expired"),
        (not_yet, "refuses", "not valid"),
    ],
)
def test_an_outsider_is_not_let_in_and_hears_why(
    outsider: Outsider, words: str, noted: str, home: Home, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    credentials = outsider(home, tmp_path / "keys")
    with pytest.raises(NetworkError, match=words):
        client([home.endpoint(SITE)], seconds=0.5, credentials=credentials)
    assert home.until(lambda: any(not who and noted in attempt for who, attempt, _ in tried(home, capsys)))


def test_who_has_no_certificate_is_not_let_in(home: Home, capsys: pytest.CaptureFixture[str]) -> None:
    import socket

    host, port = home.endpoint(SITE).removeprefix("tls/").split(":")
    context = ssl.create_default_context(cafile=str(home.folder / "keys/authority.pem"))
    with (
        pytest.raises(ssl.SSLError, match="CERTIFICATE_REQUIRED"),
        socket.create_connection((host, int(port)), 5.0) as plain,
        context.wrap_socket(plain, server_hostname=host) as link,
    ):
        link.recv(1)
    assert home.until(lambda: any("no certificates" in attempt for _, attempt, _ in tried(home, capsys)))


def test_who_has_no_keys_is_told_so(home: Home, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("SELFCONF_KEYS", raising=False)
    with pytest.raises(NetworkError, match="with keys only"):
        client([home.endpoint(SITE)])
    with pytest.raises(NetworkError, match=r"no site answers|stays silent"):
        client([home.endpoint(SITE).replace("tls/", "tcp/")], seconds=0.5)


def test_who_is_revoked_is_out_at_once_and_stays_out(home: Home, tmp_path: Path) -> None:
    assert home.authority is not None
    principal = Principal(PrincipalKind.CONFIGURATOR, "mallory")
    home.authority.issue(principal, tmp_path / "keys")
    credentials = open_keys(tmp_path / "keys").credentials((PrincipalKind.CONFIGURATOR,))
    bus = client([home.endpoint(SITE)], credentials=credentials)
    introduce(bus, home.ecology, credentials)

    def answered() -> bool:
        replies: list[bool] = []
        bus.ask(home.keys.call(component_of("tracker"), "state"), b"", 1.0, lambda r: replies.append(bool(r.samples)))
        deadline = bus.now() + 3.0
        bus.run(lambda: bool(replies) or bus.now() > deadline)
        return replies == [True]

    try:
        assert home.until(answered)
        assert home.authority.revoke(principal) == 1
        assert home.until(lambda: not answered())
        with pytest.raises(NetworkError, match="was revoked"):
            introduce(bus, home.ecology, credentials)
        assert not answered()
    finally:
        bus.close()


def test_the_rules_that_are_shown_are_those_of_zenoh(home: Home, capsys: pytest.CaptureFixture[str]) -> None:
    (site,) = json.loads(run(capsys, "access", *home.arguments(), "--format", "json").out)["sites"]
    assert site["access_control"]["default_permission"] == "deny"
    subjects = {subject["id"] for subject in site["access_control"]["subjects"]}
    assert {"everybody", f"site.{SITE}", "conf.main", "read.main"} <= subjects
    assert {one["principal"] or "everybody" for one in site["access"]} == subjects


@pytest.fixture(scope="module")
def free(home: Home) -> Iterator[Stage]:
    """An attacker to whom nothing is refused: with the certificate of the site whose hub it is."""
    assert home.authority is not None
    shown = home.authority.credentials((PrincipalKind.SITE,), SITE)
    attacker, observer = (client([home.endpoint(SITE)], credentials=shown) for _ in range(2))
    names = map(component_of, ("tracker", "odometry", "sonar"))
    yield Stage(home.keys, SITE, *names, attacker, observer)
    attacker.close()
    observer.close()


@pytest.mark.parametrize("attack", sorted(NOBODY_MAY))
def test_what_nobody_may_would_come_to_something_if_it_were_not_refused(free: Stage, attack: str) -> None:
    """Last in this module: the component that is attacked does not outlive it."""
    assert ATTACKS[attack](free)
