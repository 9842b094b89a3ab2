"""A site: the init-component of a host (section 2.1 of the paper).

It serves the advertisements of its host, dormant components included, watches their files, announces that it is
alive, and has the process of a dormant component started, and ended, when a configurator asks for it.
"""

from __future__ import annotations

import logging
import secrets
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import partial
from typing import NamedTuple

from selfconf.bus.answers import answering, own_answers
from selfconf.bus.port import Bus, Replies, Request, Urgency
from selfconf.errors import PeerError, SiteEndingError
from selfconf.model.immutable import replace
from selfconf.model.term import IRI
from selfconf.model.wording import sayable
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import Keys, checked_name
from selfconf.protocol.messages import CallAnswer, End, Known, LogQuestion, Page, StateOf, Wake
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.turtle import ntriples
from selfconf.site.kept_log import MOST_LOG_LINES, log_part
from selfconf.site.processes import (
    NONE_STARTED,
    ComponentProcesses,
    ProcessSettings,
    Started,
    cannot_start,
    programs_of,
    started_once,
)
from selfconf.site.shelf import Shelf

log = logging.getLogger(__name__)

FILE_CHECK = 1.0
"""How often, in seconds, the files are looked at for changes."""
FILE_CHECK_SHARE = 0.02
"""Which part of the time may be spent on that: where there are very many files, they are looked at less often."""
FILE_CHECK_PAUSE = 5.0
"""Seconds from one look to the next at most: to read many files that have changed takes longer than to look at them."""

SEEN_AT_REST = 0.3
"""Seconds that a component may take to say that it has let go of a task, before its process is ended for that."""

MOST_REASON = 1000
"""How many characters are sent of why a component cannot act."""


class _ServedAdvertisement(NamedTuple):
    """An advertisement as it is replied: on which key, in N-Triples, and what its page says of it."""

    key: str
    payload: bytes
    component: IRI
    source: str
    startable: bool
    advertisement: Advertisement


class Site:
    """Serves a shelf on the bus."""

    def __init__(
        self,
        bus: Bus,
        ecology: str,
        name: str,
        shelf: Shelf,
        settings: ProcessSettings = NONE_STARTED,
        life: str = "",
        insecure: bool = False,
        changed: Callable[[Mapping[IRI, Advertisement]], None] = lambda advertisements: None,
    ) -> None:
        """`insecure` is in the answer to each question: the site listens beyond its host without keys.

        `changed` hears what is on the shelf, now and when that is another.
        """
        self.bus, self.keys, self.name, self.shelf = bus, Keys(ecology), checked_name(name, "a site"), shelf
        self.processes = ComponentProcesses(bus, self.keys, settings)
        self._log_path, self._insecure = settings.log_path, insecure
        self.life = life or secrets.token_hex(4)
        """Which life of the site this is: another site may have its name."""
        self.programs: dict[IRI, IRI] = {}
        """The components of this site, each with the one that stands for its process, which has the certificate."""
        self._sharing: dict[Started, list[IRI]] = {}
        """The components that share a command in a folder, by that."""
        self._unable: dict[IRI, str] = {}
        self._revision = 1
        self._changed = changed
        shelf.refresh()
        self._served: list[_ServedAdvertisement] = []
        self._served = self._read_shelf()
        self._notify = bus.publisher(self.keys.changed(name), Urgency.EVENT)
        bus.serve(self.keys.advertisements(name), self._answer)
        bus.serve(self.keys.wake(name), self._wake)
        bus.serve(self.keys.end(name), self._end)
        bus.serve(self.keys.log(name), self._tell_log)
        bus.announce(self.keys.site_life(name, self.life))  # last: from now on it is asked
        self._changed(shelf.advertisements)
        self._look()

    def close(self) -> None:
        """End the processes this site has started, and leave the ecology."""
        self.processes.close()
        self.bus.close()

    def start(self, component: IRI, after: str = "") -> None:
        """Start the process of a dormant component, unless it runs. Raises PeerError if that cannot be done.

        `after` is the life that a task has lost, if that is why it is started.
        """
        advertisement = self.shelf.advertisements.get(component)
        if advertisement is None:
            raise cannot_start(component)
        started = started_once(advertisement.profile)
        sharing = () if started is None else self._sharing[started]
        self.processes.start(advertisement.profile, [self.shelf.advertisements[one].profile for one in sharing], after)

    def tell_unable(self, why: Mapping[IRI, str]) -> None:
        """Say from now on with each advertisement why its component cannot act now, if that is so."""
        self._unable = {component: sayable(reason)[:MOST_REASON] for component, reason in why.items()}
        self._tell_changed()

    def _tell_changed(self) -> None:
        """Tell the ecology that something else is advertised than before."""
        self._revision += 1
        self._notify.put(encode(Page(0, len(self._served), self._revision)))

    def _read_shelf(self) -> list[_ServedAdvertisement]:
        """What is replied, made once for all questions and, where an advertisement has stayed, not even again."""
        self.programs = programs_of(one.profile for one in self.shelf.advertisements.values())
        self._sharing = {}
        for component, advertisement in self.shelf.advertisements.items():
            started = started_once(advertisement.profile)
            if started is not None:
                self._sharing.setdefault(started, []).append(component)
        before = {id(one.advertisement): one for one in self._served}
        return [
            before.get(id(advertisement)) or self._made_ready(component, advertisement)
            for component, advertisement in sorted(self.shelf.advertisements.items())
        ]

    def _made_ready(self, component: IRI, advertisement: Advertisement) -> _ServedAdvertisement:
        return _ServedAdvertisement(
            self.keys.advertisement(self.name, component),
            ntriples(advertisement.triples),
            component,
            sayable(advertisement.profile.place or ""),
            advertisement.profile.command is not None,
            advertisement,
        )

    def _look(self) -> None:
        """Look at the files, now and from time to time, and tell the ecology if the advertisements have changed."""
        began, before = self.bus.now(), self.shelf.advertisements
        try:
            changed = self.shelf.refresh()
        finally:  # whatever breaks: else the files would never be looked at again
            self.bus.later(pause_after(self.bus.now() - began), self._look)
        if changed:
            self._served = self._read_shelf()
            self._tell_changed()
            self._changed(self.shelf.advertisements)
            log.info("%d advertisements", len(self._served))
            self._tell_of_other_ports(before)

    def _tell_of_other_ports(self, before: Mapping[IRI, Advertisement]) -> None:
        """Say which components have other ports by now than their processes know, which have read the files once."""
        for component, program in self.processes.by_component.items():
            was, is_now = before.get(component), self.shelf.advertisements.get(component)
            if program.running and was is not None and is_now is not None and was is not is_now:
                then, now = was.profile, is_now.profile
                if (then.ports, then.parameters) != (now.ports, now.parameters):
                    self.shelf.complain(
                        f"{component} is advertised with other ports, and its process runs on with those from before:"
                        f" `selfconf site restart {component.short}` starts it anew"
                    )

    def _answer(self, request: Request) -> None:
        """Reply the advertisements, each with its page: the asker counts them, n of n."""
        with answering(request):
            total = len(self._served)
            if total == 0 or self._is_known(request.payload):
                page = Page(0, total, self._revision, life=self.life, insecure=self._insecure)
                request.reply(self.keys.no_advertisements(self.name), b"", encode(page))
                return
            for index, one in enumerate(self._served):
                page = Page(
                    index,
                    total,
                    self._revision,
                    one.component,
                    one.source,
                    one.startable,
                    self.life,
                    self._insecure,
                    self._unable.get(one.component, ""),
                )
                request.reply(one.key, one.payload, encode(page))

    def _is_known(self, payload: bytes) -> bool:
        """Whether the asker knows the present advertisements; one of before says nothing about it."""
        try:
            return decode(payload, Known).revisions.get(f"{self.name}/{self.life}") == self._revision
        except PeerError:
            return False

    def _end(self, request: Request) -> None:
        """End the process of a component, and reply once it is gone.

        For a task whose release it has not obeyed it is not ended where the task alone could not reach it: where it has
        let go of the task since, or acts for others as well.
        """
        try:
            end = decode(request.payload, End)
        except PeerError as error:
            request.refuse(str(error))
            request.finish()
            return
        if end.task:
            state, question = self.keys.call(end.component, "state"), encode(StateOf(end.task))
            self.bus.ask(state, question, SEEN_AT_REST, partial(self._end_for_task, request, end))
        else:
            self._end_process(request, end)

    def _end_for_task(self, request: Request, end: End, replies: Replies) -> None:
        """End the process of a component that does not obey a task, unless what it says of itself is otherwise."""
        told = own_answers(replies.samples, CallAnswer, lambda one: self.keys.call(one.component, "state"))[0]
        own = next((one for one in told if one.life == end.life and not one.stopping), None)
        if own is None or (own.task == end.task and not own.shared):
            self._end_process(request, end)
            return
        if own.task == end.task:
            request.refuse(f"{end.component} acts for other tasks as well")
        else:
            request.reply(self.keys.end(self.name), b"let go")
        request.finish()

    def _end_process(self, request: Request, end: End) -> None:
        def ended() -> None:
            request.reply(self.keys.end(self.name), b"ended")
            request.finish()

        try:
            self.processes.end(end.component, end.life, ended)
        except PeerError as error:
            request.refuse(str(error))
            request.finish()

    def _tell_log(self, request: Request) -> None:
        """Reply a part of what the components of this site have printed."""
        with answering(request):
            question = decode(request.payload, LogQuestion)
            if self._log_path is None:
                raise PeerError(f"the site {self.name} keeps no log")
            part = log_part(self._log_path, replace(question, lines=min(question.lines, MOST_LOG_LINES)))
            request.reply(self.keys.log(self.name), encode(part))

    def _wake(self, request: Request) -> None:
        """Start a component; while the site ends say nothing, as one that has ended: perhaps it begins anew."""
        with answering(request), suppress(SiteEndingError):
            wake = decode(request.payload, Wake)
            self.start(wake.component, wake.after)
            request.reply(self.keys.wake(self.name), b"started")


def pause_after(seconds: float) -> float:
    """How long the files are not looked at after a look that took so many seconds."""
    return max(FILE_CHECK, min(seconds / FILE_CHECK_SHARE, FILE_CHECK_PAUSE))
