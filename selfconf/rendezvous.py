"""How a program finds its ecology: by its arguments, by its environment, or by the sites that run on this machine.

Across machines endpoints are given (`--connect`, or `SELFCONF_CONNECT`); on one machine none is needed, for each site
writes a small file into the user's runtime folder (`this_machine`).

One site of an ecology on a machine relays, on a port that follows from the ecology's name; all others are its clients
(`selfconf.api.sites.joining`). So a program that knows the name knows where to look for one that takes its place.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from selfconf.bus.credentials import Credentials
from selfconf.bus.zenoh import ZenohBus, client
from selfconf.errors import AuthorError, NetworkError, ProgrammerError
from selfconf.model.setting_names import setting
from selfconf.model.term import IRI
from selfconf.protocol.endpoints import LISTENING_PORTS
from selfconf.protocol.keys import any_ecology, checked_name, ecology_of
from selfconf.this_machine import local_sites, runtime_folder

ECOLOGY_VARIABLE = "SELFCONF_ECOLOGY"
"""The variable that names the ecology of a program to which none is given."""
CONNECT_VARIABLE = "SELFCONF_CONNECT"
"""The variable with the endpoints, apart by spaces, that a program connects to when none are given."""
KEYS_VARIABLE = "SELFCONF_KEYS"
"""The variable with the folder of keys of a program to which none is given."""
ONTOLOGY_VARIABLE = "SELFCONF_ONTOLOGY"
"""The variable with the ontologies of a site, each on a line of its own; its components are checked by them."""
LIFE_VARIABLE = "SELFCONF_LIFE"
"""The variable with the life that a site gives to the components of a program that it starts, so that it knows them."""
ECOLOGY_ANSWER = 3.0
"""Seconds that an endpoint may take to say which ecologies are there."""
PLACES = 4
"""How many usual ports an ecology has: the first that is free is taken, by the one site that relays."""


def usual_endpoints(ecology: str, secure: bool = False) -> list[str]:
    """Where the site that relays for an ecology on this machine listens: on the first that is free.

    They depend on the ecology and the runtime folder alone, so that a site that takes the place of another is where
    the clients of the one before look for it. With keys they are `secure`, and others than without.
    """
    named = os.fsencode(runtime_folder()) + f" {ecology}{' with keys' * secure}".encode()  # the same in each locale
    digest = hashlib.blake2s(named, digest_size=8).digest()
    first = int.from_bytes(digest, "big")
    protocol = "tls" if secure else "tcp"
    return [
        f"{protocol}/127.0.0.1:{LISTENING_PORTS[(first + number) % len(LISTENING_PORTS)]}" for number in range(PLACES)
    ]


def environment(ecology: str, endpoint: str, ontologies: Sequence[Path] = ()) -> dict[str, str]:
    """The variables by which a program that is started finds an ecology, and the ontologies of its parent."""
    found = {ECOLOGY_VARIABLE: ecology, CONNECT_VARIABLE: endpoint}
    return {**found, ONTOLOGY_VARIABLE: "\n".join(str(path.resolve()) for path in ontologies)}


def site_ontologies() -> list[Path]:
    """The ontologies that the environment names: those of the site that has started this program."""
    return [Path(path) for path in os.environ.get(ONTOLOGY_VARIABLE, "").split("\n") if path]


def asked_for(ecology: str | None, connect: Sequence[str]) -> tuple[str | None, list[str]]:
    """The ecology and the endpoints that are given, else those that the environment names, if it does."""
    if ecology is None:
        ecology = os.environ.get(ECOLOGY_VARIABLE) or None
    return ecology, list(connect) or os.environ.get(CONNECT_VARIABLE, "").split()


def keys_folder(keys: Path | None) -> Path | None:
    """The folder of keys that is given, else the one that the environment names, if it does."""
    named = os.environ.get(KEYS_VARIABLE)
    return keys or (Path(named) if named else None)


def credentials(keys: Path | None, *kinds: str, name: str = "main") -> Credentials | None:
    """What a program shows to others: from the folder of keys that is given, else named by the environment, if one is.

    `kinds` are those of the principals that may do what the program does (`selfconf.access.PrincipalKind`); with the
    folder of an authority the program gets a certificate of the first, of that name. Raises AuthorError.
    """
    folder = keys_folder(keys)
    if folder is None:
        return None
    from selfconf.access import PrincipalKind, open_keys  # what it needs is an extra

    return open_keys(folder).credentials([PrincipalKind(kind) for kind in kinds], name)


def component_credentials(keys: Path | None, components: Sequence[IRI]) -> Credentials | None:
    """What a process of components shows: by its own folder of keys, or by that of a site of this host.

    Raises AuthorError for keys that are none, or that do not speak for each of the components, and ProgrammerError
    where there are keys and no components.
    """
    folder = keys_folder(keys)
    if folder is None:
        return None
    if not components:
        raise ProgrammerError("with keys a process has to say which components it is, for it speaks for no others")
    from selfconf.access import HostAuthority, Principal, PrincipalKind, open_keys  # what it needs is an extra

    opened = open_keys(folder)
    if opened.serves_a_host:
        first, *others = map(Principal.component, components)
        opened = open_keys(HostAuthority(opened).component(first, others))
    shown = opened.credentials((PrincipalKind.COMPONENT,))
    speaks = opened.own().principals
    for component in components:
        if Principal.component(component) not in speaks:
            raise AuthorError(
                f"{folder} speaks for {speaks[0]}, not for {component} ({Principal.component(component)})"
            )
    return shown


def find(ecology: str | None, connect: Sequence[str], credentials: Credentials | None = None) -> tuple[str, list[str]]:
    """The ecology and the endpoints to connect to.

    Each is what is given, else what the environment says, else that of the sites on this machine: where their own host
    reaches them, then where others do, then where they will be if one that hangs has its place taken by another. Raises
    NetworkError, saying what to try, if there are none, and AuthorError for what cannot name an ecology.
    """
    ecology, endpoints = asked_for(ecology, connect)
    if ecology is not None:
        checked_name(ecology, "an ecology")
    if endpoints:
        return ecology or _ecology_at(endpoints, credentials), endpoints
    found = local_sites(ecology)
    names = sorted({site.ecology for site in found})
    if not names:
        which = "" if ecology is None else f"of the ecology {ecology!r} "
        raise NetworkError(
            f"no site {which}runs on this machine as this user; start one with `selfconf site`, or give"
            f" {setting('connect', 'ENDPOINT')}"
        )
    if len(names) > 1:
        which = f"{setting('ecology')}: {', '.join(names)}"
        raise NetworkError(f"several ecologies run on this machine; say which with {which}")
    usual = usual_endpoints(names[0], secure=credentials is not None)
    from_here = [site.from_here for site in found if site.from_here]
    return names[0], list(dict.fromkeys([*from_here, *(site.endpoint for site in found), *usual]))


def member_bus(
    ecology: str,
    endpoints: Sequence[str],
    credentials: Credentials | None,
    shared_memory: bool = False,
    distrusted: Callable[[], None] = lambda: None,
) -> ZenohBus:
    """A bus that is connected to a hub of an ecology which lets this program in. Raises NetworkError.

    `shared_memory` is for what issues large signals. `distrusted` is called on the thread of the bus, each second, once
    the certificate of this program was revoked.
    """
    with suspended_sites_named(endpoints):
        bus = client(endpoints, shared_memory=shared_memory, credentials=credentials)
    if credentials is not None:
        from selfconf.access import CertificateWatch, introduce  # what it needs is an extra

        try:
            introduce(bus, ecology, credentials)
            CertificateWatch(bus, ecology, credentials, distrusted=distrusted)
        except BaseException:
            bus.close()
            raise
    return bus


@contextmanager
def suspended_sites_named(endpoints: Sequence[str]) -> Iterator[None]:
    """Where no site answers at some endpoints, have the NetworkError name those of this machine that are suspended."""
    try:
        yield
    except NetworkError:
        suspended = [site for site in local_sites() if site.endpoint in endpoints and site.is_suspended()]
        if suspended:
            raise NetworkError("; ".join(site.suspension() for site in suspended)) from None
        raise


def _ecology_at(endpoints: list[str], credentials: Credentials | None) -> str:
    """The one ecology that has a site behind some endpoints. Raises NetworkError if there is none, or several."""
    with suspended_sites_named(endpoints):
        bus = client(endpoints, credentials=credentials)
    try:
        heard: list[tuple[str, ...]] = []
        bus.roll_call(any_ecology(), ECOLOGY_ANSWER, heard.append)
        deadline = bus.now() + ECOLOGY_ANSWER
        bus.run(lambda: bool(heard) or bus.now() > deadline)
    finally:
        bus.close()
    names = sorted({ecology_of(key) for keys in heard for key in keys})
    if len(names) == 1:
        return names[0]
    if names:
        raise NetworkError(f"several ecologies are there; say which with {setting('ecology')}: {', '.join(names)}")
    raise NetworkError(f"a router answers at {', '.join(endpoints)}, but no site of any ecology")
