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
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from selfconf import files, rendezvous, this_machine
from selfconf.api.arguments import checked_choice
from selfconf.api.ontologies import hierarchy_of, ontology_texts
from selfconf.api.reading import described_in
from selfconf.api.sites.joining import Joining
from selfconf.api.tasks.work_queue import WorkQueue
from selfconf.api.unknown_terms import unknown_in_ecology
from selfconf.bus.port import Bus
from selfconf.bus.zenoh import client
from selfconf.deployment import Keeper, TaskFolder
from selfconf.discovery import Beliefs
from selfconf.errors import AuthorError, NetworkError
from selfconf.model.hierarchy import Reasoning
from selfconf.model.immutable import immutable, replace
from selfconf.model.setting_names import setting
from selfconf.model.term import IRI
from selfconf.model.wording import counted
from selfconf.protocol.endpoints import endpoint_host
from selfconf.protocol.keys import checked_name, life_of
from selfconf.protocol.messages import TaskRecord
from selfconf.rdf.advertisements import Advertisement
from selfconf.site import ProcessSettings, Shelf, Site, forget_oldest
from selfconf.termination import Termination

if TYPE_CHECKING:
    from selfconf.api.sites.secured_site import SecuredSite
    from selfconf.composites import Composites
    from selfconf.deployment import RunRequest

log = logging.getLogger(__name__)

Beside = Callable[[str, Callable[[], Bus]], AbstractContextManager[None]]
"""Something that lives with a site: it is entered with the ecology, and with what opens a session there as the site."""
NOT_YET_ANSWERED = 5.0
"""Seconds after its beginning at which a site says of which other hosts nothing answers."""
WORK_CHECK = 3.0
"""How often, in seconds, a site looks whether it is to end. It hears at once, but for a signal that comes just as its
main thread begins to wait: Python handles that no sooner than the thread goes on."""


@immutable
class SiteOptions:
    """What a site begins with; what is None has a default of its own."""

    paths: tuple[Path, ...] = ()
    """The files and folders with the advertisements that it serves."""
    ecology: str | None = None
    name: str | None = None
    listen: str | None = None
    """The endpoint at which it listens; by default where a site of the ecology usually does."""
    connect: tuple[str, ...] = ()
    """The endpoints of other sites."""
    state: Path | None = None
    """The folder with the tasks that it keeps, by default one of the runtime folder."""
    log: Path | None = None
    """The folder for what the components print that it starts, by default one of the runtime folder."""
    keys: Path | None = None
    """The folder with its keys: only holders of certificates of the same authority are let in."""
    insecure: bool = False
    """Whether it may listen beyond loopback without keys."""
    ontologies: tuple[Path, ...] = ()
    """Files and folders by which the components that it starts check what they emit."""
    reasoning: str = Reasoning.SYNTACTIC.value
    """The mode in which the insides of its composites see the ontologies."""


def serve(
    options: SiteOptions,
    complain: Callable[[str], None],
    beside: Beside = lambda ecology, session: nullcontext(),
) -> None:
    """Serve the advertisements in some files and folders to an ecology until SIGINT, SIGTERM or SIGHUP.

    `complain` hears what is left out, and where the site listens. `beside` is what lives with the site, from when it
    listens to when it ends. Raises AuthorError and NetworkError.
    """
    checked = _CheckedOptions(options)
    with this_machine.turn():  # one site at a time looks which others there are, or two would miss each other
        program = _SiteProgram(checked, complain)
    program.tell_what_is_served()
    program.run(beside)


class _CheckedOptions:
    """What a site begins with, once it is known that there can be such a site."""

    def __init__(self, options: SiteOptions) -> None:
        """Raises AuthorError for options with which there can be no site."""
        self.given, ontologies = options, options.ontologies
        _check_readable(options.paths, ontologies)
        reasoning = checked_choice(Reasoning, "reasoning", options.reasoning)
        self.hierarchy = hierarchy_of(reasoning, ontology_texts(ontologies))
        ecology, self.connect = rendezvous.asked_for(options.ecology, options.connect)
        if ecology is None:
            which = f"{setting('ecology', 'NAME')}, or set {rendezvous.ECOLOGY_VARIABLE}"
            raise AuthorError(f"a site is part of an ecology; give {which}")
        checked_name(ecology, "an ecology")
        self.ecology = ecology
        self.secured, self.name = _named(rendezvous.keys_folder(options.keys), options.name)
        self.is_open_to_all = self.secured is None and _beyond_loopback(options.listen)
        if self.is_open_to_all and not options.insecure:
            raise AuthorError(
                f"{options.listen} can be reached from other hosts, and without keys by everybody there: give"
                f" {setting('keys', 'DIR')} (see `selfconf keys --help`), or {setting('insecure')} if that is what you"
                " want"
            )


class _SiteProgram:
    """A site as a program: its bus, what it serves, the tasks that it keeps, and the work that takes long."""

    def __init__(self, checked: _CheckedOptions, complain: Callable[[str], None]) -> None:
        """Joins the ecology, and begins to serve. Raises NetworkError."""
        options, ecology, name, secured = checked.given, checked.ecology, checked.name, checked.secured
        self._ecology, self._name, self._complain = ecology, name, complain
        self._hierarchy, self._is_open_to_all = checked.hierarchy, checked.is_open_to_all
        self._believed = None if secured is None else secured.believed
        self._was_revoked = False
        shelf = Shelf(options.paths, complain)
        security = None if secured is None else secured.first(ecology, name, shelf)
        self._credentials = None if security is None else security.credentials
        self._joining = Joining(ecology, name, options.listen, checked.connect, security)
        self._bus = self._joining.bus
        if secured is not None and not self._bus.endpoint:
            secured.introduce(self._bus, ecology)  # the hub of another site has to know this one
        _refuse_taken(name, ecology, self._joining)
        self._work = WorkQueue()
        self._ended = Termination(self._bus, told=self._work.abandon)
        log_path = _log_path(options.log, ecology, name).absolute()
        self._composites = _CompositesOnceThereAre(self._made_composites)
        self._site = Site(
            self._bus,
            ecology,
            name,
            shelf,
            ProcessSettings(
                rendezvous.environment(ecology, " ".join(self._joining.endpoints), options.ontologies),
                log_path,
                None if secured is None else secured.keys_of,
            ),
            f"{secrets.token_hex(4)}.{os.getpid()}.{_HOST}",
            self._is_open_to_all,
            changed=self._composites.refresh,
        )
        if secured is not None:
            secured.keep_door(self._site, self._joining, self._complain, self._distrusted)
        records = TaskFolder((options.state or this_machine.runtime_folder() / "tasks") / f"{ecology}@{name}")
        self._keeper = Keeper(self._bus, ecology, name, records, partial(_request_of, self._work, self._believed))
        self._joining.announce(log_path, options.paths)
        self._bus.watch(self._site.keys.site_life(name, "*"), partial(_met, self._complain, self._site))

    def _made_composites(self) -> Composites:
        from selfconf.composites import Composites  # loads all that configures their insides and runs them

        return Composites(
            self._bus,
            self._ecology,
            described_in,
            self._complain,
            self._work.add,
            self._believed,
            self._hierarchy,
            lambda why: self._site.tell_unable(why),  # it refreshes the composites while it is made
        )

    def tell_what_is_served(self) -> None:
        """Say what is served and where, which terms of it nothing declares, and which site serves the same files."""
        advertisements = self._site.shelf.advertisements
        for unknown in unknown_in_ecology(advertisements):
            self._complain(unknown)
        served = counted(len(advertisements), "advertisement") + " so far" * (not advertisements)  # as of a bridge
        how = " without keys, open to everybody who reaches it" if self._is_open_to_all else ""
        where = f"{self._joining.endpoint}{how}"
        self._complain(f"site {self._name} of ecology {self._ecology} serves {served} on {where}")
        for other in this_machine.local_sites(self._ecology):
            for path in sorted({*self._joining.served}.intersection(other.served)) if other.site != self._name else ():
                self._complain(f"site {other.site}, process {other.process}, serves {path} already: end one of the two")

        if self._joining.reaches_others:
            self._bus.later(NOT_YET_ANSWERED, self._tell_of_unanswered)

    def _tell_of_unanswered(self) -> None:
        """Have it said once at which endpoints of other hosts nothing answers: that host may only begin later."""

        def tell() -> None:
            for endpoint in self._joining.unanswered():
                self._complain(f"nothing answers at {endpoint} yet; this site goes on trying")

        self._work.add(tell)

    def _distrusted(self) -> None:
        """End, as the certificate of this site was revoked."""
        self._was_revoked = True
        self._ended.end()

    def run(self, beside: Beside) -> None:
        """Serve until the program is to end; then close. Raises NetworkError where its certificate was revoked."""
        self._bus.run_aside()  # what takes long, such as a search for a task that this site keeps, is done here
        try:
            with beside(self._ecology, self._session):
                while not self._ended():
                    _do_next(self._work)
        finally:
            self._joining.leave()
            self._bus.wake_up(self._composites.close)
            self._bus.wake_up(self._keeper.close)
            self._site.close()
        if self._was_revoked:
            raise NetworkError(f"the site {self._name} and its components have ended, as its certificate was revoked")

    def _session(self) -> Bus:
        """Another session in the ecology, as this site."""
        return client(self._joining.endpoints, shared_memory=True, credentials=self._credentials)


def _do_next(work: WorkQueue) -> None:
    """Do what waits: the outermost loop of a site, whose components do not end with what one task has asked for."""
    try:
        work.next(WORK_CHECK)
    except Exception:
        log.exception("a job broke; going on")


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
    from selfconf.api.sites.secured_site import SecuredSite  # what it needs is an extra

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
    """The words that say whose life it is."""
    parts = life.split(".", 2)
    return f"process {parts[1]} on host {parts[2]}" if len(parts) == 3 else f"life {life}"


def _log_path(folder: Path | None, ecology: str, name: str) -> Path:
    """The log of a site. In the folder of all sites of this user, those of sites that have ended become fewer."""
    if folder is None:
        folder = this_machine.log_folder()
        forget_oldest(folder, {f"{site.ecology}@{site.site}.log" for site in this_machine.local_sites()})
    return folder / f"{ecology}@{name}.log"


def _request_of(work: WorkQueue, believed: Beliefs | None, record: TaskRecord) -> RunRequest:
    """The request to run a task that the site keeps; what reads it is loaded with the first one."""
    from selfconf.api.tasks.detached import request_of

    at_leisure = partial(work.at_leisure, owner=record.task)
    request = request_of(record, partial(work.add, owner=record.task), believed, at_leisure)
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
