"""Mangled advertisements, certificates and folders of keys: each is read, or refused with a sentence."""

from __future__ import annotations

import base64
import shutil
from contextlib import suppress
from functools import cache
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory, mkdtemp

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from selfconf.errors import PeerError, SelfconfError, TurtleError
from selfconf.rdf.advertisements import read_advertisements
from tests.harness.effort import examples
from tests.hostile.bounded import bounded
from tests.hostile.mangling import TOKENS, in_time, mangled, some_mangled
from tests.lab import ADVERTISEMENTS, PREFIXES

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
TURTLE = (
    *((PREFIXES + text).encode() for text in ADVERTISEMENTS.values()),
    *(path.read_bytes() for path in sorted(EXAMPLES.glob("*/*.ttl"))),
)


def read_turtle(text: bytes) -> None:
    """Read an advertisement; what is wrong with it has a place."""
    with suppress(TurtleError):
        for one in read_advertisements(text, "stranger.ttl")[1]:
            assert one.problems


@settings(max_examples=examples(500))
@given(st.sampled_from(TURTLE), st.randoms(use_true_random=False))
def test_a_mangled_advertisement_is_read_or_refused(text: bytes, random: Random) -> None:
    with in_time():
        read_turtle(mangled(text, random))


def test_nothing_stays_of_mangled_advertisements() -> None:
    for text in some_mangled(TURTLE, 300, seed=1):
        read_turtle(text)
    with bounded(60.0, peak=30.0, left=1.0):
        for text in some_mangled(TURTLE, 300, seed=2):
            read_turtle(text)


@cache
def keys() -> Path:
    """The folder of an authority that has issued certificates; made once, and never changed."""
    from selfconf.access import Authority, HostAuthority, Principal, PrincipalKind, open_keys

    folder = Path(mkdtemp(prefix="selfconf-mangled-"))
    authority = Authority.init(folder / "authority")
    authority.issue(Principal(PrincipalKind.SITE, "home"), folder / "site")
    authority.revoke(Principal(PrincipalKind.READER, "main"))
    HostAuthority(open_keys(folder / "site")).hub_authorities()
    return folder


@pytest.fixture(scope="module", autouse=True)
def _removed() -> object:
    yield
    if keys.cache_info().currsize:
        shutil.rmtree(keys())


def mangled_pem(pem: bytes, random: Random) -> bytes:
    """PEM that is mangled as text or, mostly, in the DER that it holds."""
    if random.random() < 0.3 or pem.count(b"BEGIN") != 1:
        return mangled(pem, random)
    first, *lines, last = pem.splitlines()
    der = bytearray(base64.b64decode(b"".join(lines)))
    for _ in range(random.randint(1, 6)):
        der[random.randrange(len(der))] = random.choice((0, 1, 0x30, 0x7F, 0x80, 0xFF, random.randrange(256)))
    return b"\n".join((first, base64.encodebytes(bytes(der)).strip(), last, b""))


@settings(max_examples=examples(500))
@given(st.randoms(use_true_random=False))
def test_a_mangled_certificate_is_none_or_says_what_is_wrong_with_it(random: Random) -> None:
    pytest.importorskip("cryptography")
    from selfconf.access import Authority, Certificate

    site, authority = keys() / "site", Authority(keys() / "authority")
    good = (site / "certificate.pem").read_bytes()
    pem = mangled_pem(good, random)
    with in_time():
        try:
            certificate = Certificate.read(pem)
        except PeerError:
            return
        said = certificate.common_name, certificate.serial, certificate.hosts
        fault = certificate.fault((authority.authority,))
        assert fault or certificate == Certificate.read(good)
        assert isinstance(certificate.half_over(), bool)
        assert all(isinstance(one, str | int | tuple) for one in said)
        if fault:
            with pytest.raises(PeerError):
                authority.admit("lab", pem)


@settings(max_examples=examples(200))
@given(st.randoms(use_true_random=False))
def test_a_folder_of_keys_with_a_mangled_file_is_refused_with_a_sentence(random: Random) -> None:
    pytest.importorskip("cryptography")
    from selfconf.access import Authority, HostAuthority, PrincipalKind, open_keys

    with TemporaryDirectory() as place, in_time():
        folder = Path(place) / "keys"
        shutil.copytree(keys() / random.choice(("site", "authority")), folder)
        path = random.choice(sorted(path for path in folder.rglob("*") if path.is_file()))
        path.write_bytes(
            random.choice((mangled_pem, mangled))(path.read_bytes(), random)
            if path.suffix != ".json"
            else random.choice(TOKENS)
        )
        for use in (
            lambda: open_keys(folder).credentials((PrincipalKind.SITE,), "home"),
            lambda: HostAuthority(open_keys(folder)).hub_authorities(),
            lambda: open_keys(folder).admitted("lab"),
            lambda: open_keys(folder).revoked(),
            lambda: Authority(folder).issued(),
            lambda: open_keys(keys() / "authority").authority.fault(open_keys(folder).believed_authorities()),
        ):
            with suppress(SelfconfError):
                use()
