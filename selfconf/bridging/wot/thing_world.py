"""The world of the things that some sources describe: files, folders, URLs, and directories of things.

Sources are read again at intervals, so that the things of a directory come and go. Each thing is looked for at
intervals too (`thing_watch`).

Nothing is requested but what the user has named: the sources, and what the descriptions in files lead to. A description
that was fetched leads to the host that it came from, to the hosts of the other sources, and to those named in addition.
"""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Coroutine, Sequence
from typing import Any, TypeVar

from selfconf.bridging.bridge import Bridge
from selfconf.bridging.wot.forms import ThingForm, ThingForms
from selfconf.bridging.wot.interactions import ThingInteractions, interactions
from selfconf.bridging.wot.thing_client import ThingClient, ThingError, ThingLimits
from selfconf.bridging.wot.thing_sources import host_of, is_url, places, things_in
from selfconf.bridging.wot.thing_watch import ThingSettings, ThingWatch
from selfconf.errors import AuthorError
from selfconf.importing import (
    ACCEPTED,
    FETCH_SECONDS,
    DescribedThing,
    Pages,
    SourceDocument,
    document_at,
)
from selfconf.model.term import IRI

_T = TypeVar("_T")
MOST_THINGS = 2000
"""How many things one bridge stands for."""
LAST_REQUESTS = 5.0
"""Seconds that the requests that are under way may take to end with the bridge."""


class ThingWorld:
    """The other side of a bridge to things."""

    def __init__(self, sources: Sequence[str], settings: ThingSettings, bridge: Bridge) -> None:
        """Begin to read the sources, and to look for the things in them.

        Raises AuthorError for a source that is to be fetched and is no URL.
        """
        self._sources, self._settings, self._bridge = sources, settings, bridge
        of_sources = {host_of(source) for source in sources if is_url(source)}
        self._hosts = of_sources.union(host.lower() for host in settings.hosts)  # as `urlsplit` has those of forms
        self._told: set[str] = set()
        self._outages: dict[str, set[str]] = {}
        """The complaints about each source since it was fetched last."""
        self._watches: dict[IRI, ThingWatch] = {}
        self._found: dict[str, list[DescribedThing]] = {}
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, name="things")
        self._thread.start()
        self._client = self._call(_opened_client(settings.limits))
        self._readings = self._call(self._begin())

    def close(self) -> None:
        """End every request and every look."""
        self._call(self._close())
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()

    def _call(self, work: Coroutine[Any, Any, _T]) -> _T:
        return asyncio.run_coroutine_threadsafe(work, self._loop).result()

    # On the loop.

    async def _begin(self) -> list[asyncio.Task[None]]:
        return [asyncio.create_task(self._follow(source)) for source in self._sources]

    async def _close(self) -> None:
        tasks = asyncio.all_tasks() - {asyncio.current_task()}
        for task in tasks:
            task.cancel()
        if tasks:
            await asyncio.wait(tasks, timeout=LAST_REQUESTS)
        await self._client.close()

    async def _follow(self, source: str) -> None:
        """Read a source again and again; what was in it stays where it cannot be read."""
        while True:
            found = await self._read(source)
            if found is not None:
                self._found[source] = found
                self._compare()
            await asyncio.sleep(self._settings.reread)

    async def _read(self, source: str) -> list[DescribedThing] | None:
        """The things of a source, those of before where it cannot be read now; None if it cannot be fetched."""
        fetched: list[SourceDocument] = []
        if is_url(source):
            try:
                fetched = await self._fetched(source)
            except ThingError as error:
                sentence = f"cannot fetch a description: {error}"
                self._tell(sentence)
                self._outages.setdefault(source, set()).add(sentence)
                return None
            self._told -= self._outages.pop(source, set())  # the next time is news
        found = await asyncio.to_thread(things_in, source, fetched)  # it may take long, but never waits
        for wrong in found.unreadable:
            self._tell(str(wrong))
        for place in found.without_things:
            self._tell(f"{place} holds what describes no thing: it has neither a title nor an affordance")
        spoiled = {wrong.file for wrong in found.unreadable}
        before = self._found.get(source, ())
        return [*found.things, *(thing for thing in before if spoiled.intersection(places(thing.source.shown)))]

    async def _fetched(self, source: str) -> list[SourceDocument]:
        """What a URL answers, page by page. Raises ThingError."""
        pages = Pages(source)
        found: list[SourceDocument] = []
        while pages.url is not None:
            octets, links = await self._client.fetch(ThingForm(pages.url, "GET", ACCEPTED), FETCH_SECONDS)
            found.append(document_at(pages.url, octets, pages.number))
            try:
                pages.go_on(links, octets)
            except AuthorError as error:  # what was read counts all the same
                self._tell(str(error))
        return found

    def _compare(self) -> None:
        """Let the things come that are new or described anew, and go that are described no more."""
        here: dict[IRI, DescribedThing] = {}
        for source in self._sources:
            for thing in self._found.get(source, ()):
                iri = thing.component.iri
                if iri in here:
                    self._tell(f"{thing.source.shown}: {iri} is described twice; the first description counts")
                elif len(here) == MOST_THINGS:
                    self._tell(f"there are more than {MOST_THINGS} things; a bridge stands for so many")
                here.setdefault(iri, thing)
        for iri in self._watches.keys() - here.keys():
            gone = self._watches.pop(iri)
            gone.end(f"{gone.thing.source.shown} describes it no more")
            self._bridge.withdraw(iri)
        for iri, thing in list(here.items())[:MOST_THINGS]:
            watch = self._watches.get(iri)
            if watch is None or watch.has_ended or watch.thing != thing:
                self._watch(iri, thing, watch)

    def _watch(self, iri: IRI, thing: DescribedThing, before: ThingWatch | None) -> None:
        """Look for a thing that is new or described anew; not anew where a bridge does with it what it did before.

        A directory may say with each answer when it was asked (`registration`). What a task holds and is described with
        more, or in other words, goes on as long as it is held.
        """
        found = self._interactions(thing)
        if before is not None and before.found == found and not before.has_ended:
            before.thing = thing
            return
        if before is not None and before.is_held and found.offers(before.found):
            return  # it is advertised anew at a reading after it was released
        if before is not None:
            before.end(f"{thing.source.shown} describes it anew")
        try:
            self._watches[iri] = ThingWatch(thing, found, self._bridge, self._client, self._settings)
        except OSError as error:  # it is tried again at the next reading
            self._tell(f"{iri.short} cannot be advertised: {error.strerror}")

    def _interactions(self, thing: DescribedThing) -> ThingInteractions:
        shown = thing.source.shown
        fetched = is_url(shown)

        def reachable(host: str) -> bool:
            return not fetched or host in self._hosts

        forms = ThingForms(thing.description, shown if fetched else "", self._settings.credentials, reachable)
        found = interactions(thing, forms, self._settings.rate, self._settings.ontologies)
        for problem in found.problems:
            self._tell(f"{shown}: {thing.component.iri.short}: {problem}")
        return found

    def _tell(self, sentence: str) -> None:
        """Complain of what was not complained of before: sources are read again and again."""
        if sentence not in self._told and len(self._told) < MOST_THINGS:
            self._told.add(sentence)
            self._bridge.complain(sentence)


async def _opened_client(limits: ThingLimits) -> ThingClient:
    return ThingClient(limits)  # its sessions belong to the loop that runs
