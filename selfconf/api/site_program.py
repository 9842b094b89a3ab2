"""A site as a program: it listens, announces itself on this machine, and serves until it is asked to end."""

from __future__ import annotations

import ipaddress
import logging
import os
import platform
import re
import secrets
import socket
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from selfconf import files, rendezvous
from selfconf.api.arguments import option
from selfconf.api.joining import Joining
from selfconf.api.ontologies import hierarchy_of, ontology_texts
from selfconf.api.reading import described_in
from selfconf.api.unknown_terms import unknown_in_ecology
from selfconf.api.work_queue import WorkQueue
from selfconf.bus.port import Bus
from selfconf.bus.zenoh_bus import client
from selfconf.deployment import Keeper, TaskFolder
from selfconf.discovery import Beliefs
from selfconf.errors import AuthorError, NetworkError
from selfconf.model.hierarchy import Reasoning
from selfconf.model.setting_names import setting
from selfconf.model.term import IRI
from selfconf.protocol.endpoints import endpoint_host
from selfconf.protocol.keys import checked_name, life_of
from selfconf.protocol.messages import TaskRecord
from selfconf.rdf.advertisements import Advertisement
from selfconf.render import count
from selfconf.site import Shelf, Site, forget_oldest
from selfconf.termination import Termination

if TYPE_CHECKING:
    from selfconf.api.secured_site import SecuredSite
    from selfconf.composites import Composites
    from selfconf.deployment import RunRequest

log = logging.getLogger(__name__)

Beside = Callable[[str, Callable[[], Bus]], AbstractContextManager[None]]
"""Something that lives with a site: it is entered with the ecology, and with what opens a session there as the site."""
WORK_CHECK = 1.0
"""How often, in seconds, a site looks whether it is to end; it hears at once, but for a signal at a bad moment."""


def serve(
    paths: Sequence[Path],
    ecology: str | None,
    name: str | None,
    listen: str | None,
    connect: Sequence[str],
    complain: Callable[[str], None],
    state: Path | None = None,
    log: Path | None = None,
    keys: Path | None = None,
    insecure: bool = False,
    beside: Beside = lambda ecology, session: nullcontext(),
    ontologies: Sequence[Path] = (),
    reasoning: str = Reasoning.SYNTACTIC.value,
) -> None:
    """Serve the advertisements in some files and folders to an ecology until SIGINT, SIGTERM or SIGHUP.

    Without a name it gets one of its own; without an endpoint it listens where a site of the ecology usually does.
    `complain` hears what is left out, and where it listens. In the folder `state` are the tasks that it keeps, in the
    folder `log` what the components print that it starts; by default both are folders of the runtime folder. With the
    folder `keys` only holders of certificates of its authority are let in; without it the site listens beyond loopback
    only if it may be `insecure`. `beside` is what lives with the site, from when it listens to when it ends. By
    `ontologies`, files and folders, the components that it starts check what they emit, and in the mode `reasoning` the
    insides of its composites see them. Raises AuthorError and NetworkError.
    """
    _check_readable(paths, ontologies)
    hierarchy = hierarchy_of(option(Reasoning, "reasoning", reasoning), ontology_texts(ontologies))
    ecology, connect = rendezvous.asked_for(ecology, connect)
    if ecology is None:
        which = f"{setting('ecology', 'NAME')}, or set {rendezvous.ECOLOGY_VARIABLE}"
        raise AuthorError(f"a site is part of an ecology; give {which}")
    checked_name(ecology, "an ecology")
    secured, name = _named(rendezvous.keys_folder(keys), name)
    beyond = secured is None and _beyond_loopback(listen)
    if beyond and not insecure:
        raise AuthorError(
            f"{listen} can be reached from other hosts, and without keys by everybody there: give"
            f" {setting('keys', 'DIR')} (see `selfconf keys --help`), or {setting('insecure')} if that is what you want"
        )
    shelf = Shelf(paths, complain)
    # One site at a time looks which others there are and announces itself, or two would miss each other.
    with rendezvous.turn():
        security = None if secured is None else secured.first(ecology, name, shelf)
        shown = None if security is None else security.credentials
        joining = Joining(ecology, name, listen, connect, security)
        bus = joining.bus
        if secured is not None and not bus.endpoint:
            secured.introduce(bus, ecology)  # the hub of another site has to know this one
        _refuse_taken(name, ecology, joining)
        life = f"{secrets.token_hex(4)}.{os.getpid()}.{_HOST}"
        work = WorkQueue()
        ended = Termination(bus, told=work.abandon)
        records = TaskFolder((state or rendezvous.runtime_folder() / "tasks") / f"{ecology}@{name}")
        environment = rendezvous.environment(ecology, " ".join(joining.endpoints), ontologies)
        log_path = _log_path(log, ecology, name).absolute()
        joining.log = str(log_path)
        keys_of, believed = (None, None) if secured is None else (secured.keys_of, secured.believed)

        def composites_of_site() -> Composites:
            from selfconf.composites import Composites  # loads all that configures their insides and runs them

            return Composites(
                bus,
                ecology,
                described_in,
                complain,
                work.work,
                believed,
                hierarchy,
                lambda why: site.tell_unable(why),  # it is made below, and refreshes the composites
            )

        composites = _CompositesOnceThereAre(composites_of_site)
        site = Site(bus, ecology, name, shelf, environment, log_path, life, keys_of, beyond, changed=composites.refresh)
        if secured is not None:
            secured.keep_door(site, joining, complain)
        keeper = Keeper(bus, ecology, name, records, partial(_request_of, work, believed))
        joining.announce()
        bus.watch(site.keys.site_life(name, "*"), partial(_met, complain, site))
    for unknown in unknown_in_ecology(site.shelf.advertisements):
        complain(unknown)
    served = count(len(site.shelf.advertisements), "advertisement")
    how = " without keys, open to everybody who reaches it" if beyond else ""
    complain(f"site {name} of ecology {ecology} serves {served} on {joining.endpoint}{how}")
    bus.run_aside()  # what takes long, such as a search for a task that this site keeps, is done here
    try:
        with beside(ecology, lambda: client(joining.endpoints, shared_memory=True, credentials=shown)):
            while not ended():
                _do_next(work)
    finally:
        joining.leave()
        bus.wake_up(composites.close)
        bus.wake_up(keeper.close)
        site.close()


def _do_next(work: WorkQueue) -> None:
    """Do what waits: the outermost loop of a site, whose components do not end with what one task has asked for."""
    try:
        work.next(WORK_CHECK)
    except Exception:
        log.exception("a work broke; going on")


def _check_readable(paths: Sequence[Path], ontologies: Sequence[Path]) -> None:
    """Raise AuthorError for paths that are not there, or are no files, and for ontologies that cannot be read."""
    for path in (*paths, *ontologies):
        files.check_kind(files.existing(path))
    files.signal_fields(files.ontology_files(ontologies), ())


def _beyond_loopback(listen: str | None) -> bool:
    """Whether an endpoint can be reached from other hosts."""
    if listen is None:
        return False
    return is_beyond_loopback(endpoint_host(listen))


def is_beyond_loopback(host: str) -> bool:
    """Whether other hosts can reach what listens at an address, or at a name, of this one."""
    try:
        found = {str(place[4][0]) for place in socket.getaddrinfo(host or None, None)}
    except (OSError, UnicodeError):
        return False  # nothing can listen there
    return not all(ipaddress.ip_address(address.partition("%")[0]).is_loopback for address in found)


def _named(keys: Path | None, name: str | None) -> tuple[SecuredSite | None, str]:
    """The keys of a site, if it has any, and its name: one of its own if none is given. Raises AuthorError."""
    if name is not None:
        checked_name(name, "a site")
    if keys is None:
        return None, name or f"s{secrets.token_hex(3)}"
    from selfconf.api.secured_site import SecuredSite  # what it needs is an extra

    secured = SecuredSite(keys, name)
    return secured, secured.name


_HOST = re.sub(r"[^A-Za-z0-9-]", "-", platform.node())[:32] or "unknown"
"""This host, as a part of the life of a site: so others can say who has a name."""


def _refuse_taken(name: str, ecology: str, joining: Joining) -> None:
    """Raise NetworkError if another site of this name lives in the ecology: commands would take one for the other."""
    try:
        life = joining.namesake()
        if life:
            raise NetworkError(
                f"a site {name!r} of ecology {ecology!r} lives already, {_whose(life)}; choose another name"
            )
    except BaseException:
        joining.bus.close()
        raise


def _met(complain: Callable[[str], None], site: Site, key: str, alive: bool) -> None:
    """Say that another site of the same name has come: the two have met only now."""
    life = life_of(key)
    if alive and life != site.life:
        complain(f"another site is called {site.name} as well, {_whose(life)}; give one of them another name")


def _whose(life: str) -> str:
    """Whose life it is, in words."""
    parts = life.split(".", 2)
    return f"process {parts[1]} on host {parts[2]}" if len(parts) == 3 else f"life {life}"


def _log_path(folder: Path | None, ecology: str, name: str) -> Path:
    """The log of a site. In the folder of all sites of this user, those of sites that have ended become fewer."""
    if folder is None:
        folder = rendezvous.log_folder()
        forget_oldest(folder, {f"{site.ecology}@{site.site}.log" for site in rendezvous.local_sites()})
    return folder / f"{ecology}@{name}.log"


def _request_of(work: WorkQueue, believed: Beliefs | None, record: TaskRecord) -> RunRequest:
    """The request to run a task that the site keeps; what reads it is loaded with the first one."""
    from selfconf.api.detached import request_of

    at_leisure = partial(work.at_leisure, owner=record.task)
    request = request_of(record, partial(work.work, owner=record.task), believed, at_leisure)
    return replace(request, abandon=partial(work.abandon, record.task))


class _CompositesOnceThereAre:
    """The composites of a site, made when the first one is advertised: most sites have none, and start sooner."""

    def __init__(self, make: Callable[[], Composites]) -> None:
        self._make = make
        self._made: Composites | None = None

    def refresh(self, advertisements: Mapping[IRI, Advertisement]) -> None:
        """Let those live whose inside can be configured from these advertisements, and no others."""
        if self._made is None and any(one.profile.inside is not None for one in advertisements.values()):
            self._made = self._make()
        if self._made is not None:
            self._made.refresh(advertisements)

    def close(self) -> None:
        """Let none live."""
        if self._made is not None:
            self._made.close()
