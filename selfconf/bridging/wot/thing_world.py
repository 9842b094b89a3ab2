"""The world of the things that some sources describe: files, folders, URLs, and directories of things.

Sources are read again at intervals, so that the things of a directory come and go. Each thing is looked for at
intervals too: it lives on this side while it answers. One that does not do what its description says is lost at once,
and lives again when it answers; each time sooner lost again, it waits longer for that.

Nothing is requested but what the user has named: the sources, and what the descriptions in files lead to. A description
that was fetched leads to the host that it came from, to the hosts of the other sources, and to those named in addition.
"""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Coroutine, Sequence
from dataclasses import field
from pathlib import Path
from typing import Any, NamedTuple, TypeVar
from urllib.parse import urlsplit

from selfconf.bridging.bridge import Bridge
from selfconf.bridging.wot.credentials import ThingCredentials
from selfconf.bridging.wot.forms import ThingForm, ThingForms
from selfconf.bridging.wot.interactions import ThingInteractions, interactions
from selfconf.bridging.wot.thing_client import NO_ANSWER, ThingClient, ThingError, ThingLimits
from selfconf.bridging.wot.thing_component import ThingComponent
from selfconf.errors import AuthorError
from selfconf.http_origin import http_origin
from selfconf.importing import (
    ACCEPTED,
    FETCH_SECONDS,
    NO_THINGS,
    DescribedThing,
    ImportedDocument,
    ImportLedger,
    Pages,
    SourceDocument,
    described_things,
    document_at,
    gather,
)
from selfconf.model.immutable import immutable, replace
from selfconf.model.term import IRI

DESCRIPTIONS = (".json", ".jsonld")
"""The endings of files in a folder that are descriptions."""
NAMESPACE = "urn:selfconf:wot:"
"""What the IRIs of things begin with to which their descriptions give none."""
_T = TypeVar("_T")
MOST_THINGS = 2000
"""How many things one bridge stands for."""
LETTING_GO = 0.5
"""Seconds from FAIL to the end of a life, in which a configurator can still release the component in good order."""
LAST_REQUESTS = 5.0
"""Seconds that the requests that are under way may take to end with the bridge."""


@immutable
class ThingSettings:
    """How a bridge treats things; times are in seconds."""

    rate: float = 1.0
    """How often a property is read that cannot be followed, in hertz."""
    credentials: ThingCredentials = field(default_factory=ThingCredentials)
    hosts: frozenset[str] = frozenset()
    """The hosts to which descriptions may lead that were fetched from another one."""
    ontologies: tuple[Path, ...] = ()
    """Files and folders of ontologies that say of which fields signals consist, besides those of selfconf."""
    look: float = 2.0
    """From one look whether a thing is there to the next."""
    reread: float = 5.0
    """From one reading of a source to the next."""
    longest_wait: float = 60.0
    """How long at most a thing that was lost again and again waits until it may live again."""
    limits: ThingLimits = field(default_factory=ThingLimits)


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
        found = await asyncio.to_thread(_things_in, source, fetched)  # it may take long, but never waits
        for wrong in found.unreadable:
            self._tell(str(wrong))
        for place in found.without_things:
            self._tell(f"{place} holds what describes no thing: it has neither a title nor an affordance")
        spoiled = {wrong.file for wrong in found.unreadable}
        before = self._found.get(source, ())
        return [*found.things, *(thing for thing in before if spoiled.intersection(_places(thing.source.shown)))]

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


class ThingWatch:
    """Looks whether one thing is there, and lets it live on this side while it is."""

    def __init__(
        self,
        thing: DescribedThing,
        found: ThingInteractions,
        bridge: Bridge,
        client: ThingClient,
        settings: ThingSettings,
    ) -> None:
        self.thing = thing
        self.found, self._bridge, self._client, self._settings = found, bridge, client, settings
        self._iri = found.component.iri
        self._code: ThingComponent | None = None
        self._since = 0.0
        """Since when it lives here, by the clock of the loop."""
        self._waits = self._not_before = 0.0
        self._trouble = ""
        """What it was last complained of, as `_kind` has it."""
        document = ImportedDocument("", thing.source.shown, (found.component.described(),), thing.prefixes)
        bridge.advertise(self._iri, document)
        self._looking = asyncio.ensure_future(self._look())

    @property
    def has_ended(self) -> bool:
        """Whether it looks no more: what has taken its place could not be advertised."""
        return self._looking.done()

    @property
    def is_held(self) -> bool:
        """Whether the thing acts for a task."""
        return self._code is not None and self._code.active

    def end(self, reason: str) -> None:
        """Look no more, and say why to the task that holds it: the thing is described no more, or otherwise."""
        self._looking.cancel()
        if self._code is not None and self._code.active:
            self._code.fail(reason)

    async def _look(self) -> None:
        loop = asyncio.get_running_loop()
        while True:
            trouble = await self._probe()
            if trouble is not None:
                self._lose(trouble)
            elif not self._bridge.lives(self._iri) and loop.time() >= self._not_before:
                await self._begin(loop)
            await asyncio.sleep(self._settings.look)

    async def _probe(self) -> str | None:
        """Why the thing is not there, in a sentence; None if it is."""
        probe = self.found.probe
        if probe is None:
            return "there is no form by which it could be reached"
        try:
            if self.found.readable:
                await self._client.read(probe)
            else:
                await self._client.reach(probe)
        except ThingError as error:
            return str(error)
        return None

    async def _begin(self, loop: asyncio.AbstractEventLoop) -> None:
        def lost(reason: str) -> None:
            if self._code is code:  # of many outputs that find the thing gone at once the first one says so
                self._lose(reason)

        code = ThingComponent(self.found, self._client, loop, self._settings.rate, lost, self._tell)
        self._code, self._since = code, loop.time()  # before it lives: it may be held, and lost, at once
        trouble = await asyncio.wrap_future(self._bridge.begin_life(self._iri, code))
        self._tell(trouble or "")
        if trouble is not None:
            self._code = None
        else:
            self._bridge.complain(f"{self._iri.short} is here, as {self.thing.source.shown} describes it")

    def _lose(self, reason: str) -> None:
        """The thing is not there, or does not do what its description says."""
        self._tell(reason)
        code, self._code = self._code, None
        if code is None:
            return
        now = asyncio.get_running_loop().time()
        again = now - self._since < self._settings.longest_wait
        self._waits = (
            min(2 * self._waits, self._settings.longest_wait) if again and self._waits else self._settings.look
        )
        self._not_before = now + self._waits
        if code.active:
            code.fail(reason)
        asyncio.get_running_loop().call_later(LETTING_GO, self._bridge.end_life, self._iri, code)

    def _tell(self, trouble: str) -> None:
        kind = _kind(trouble)
        if trouble and kind != self._trouble:
            self._bridge.complain(f"{self._iri.short}: {trouble}")
        self._trouble = kind


async def _opened_client(limits: ThingLimits) -> ThingClient:
    return ThingClient(limits)  # its sessions belong to the loop that runs


def _kind(trouble: str) -> str:
    """What a complaint is compared by: without what follows its first colon, which may be other words each time.

    Why there is no connection, such as a certificate that is not trusted, is said in few words, and counts.
    """
    kind = trouble.partition(": ")[0]
    return trouble if kind.endswith(NO_ANSWER) else kind


class _SourceThings(NamedTuple):
    """What a source holds: things, what cannot be read, and where something stands in place of a thing."""

    things: list[DescribedThing]
    unreadable: list[AuthorError]
    without_things: tuple[str, ...]


def _things_in(source: str, fetched: list[SourceDocument]) -> _SourceThings:
    """The things in what was fetched, else in a path."""
    unreadable: list[AuthorError] = []
    ledger = ImportLedger(NAMESPACE, unreadable.append)
    documents = fetched or gather([source], DESCRIPTIONS, unreadable.append)
    found = list(described_things(documents, ledger))
    # An import calls the second of two of one name otherwise, as each gets a file; here they are one thing, if they
    # say that name themselves: two files may be called alike but for letters that no name has.
    was = {one.component: one.was for one in ledger.names.renamed if not one.was.startswith(NAMESPACE)}
    names = [was.get(thing.component.iri, thing.component.iri) for thing in found]
    things = [
        replace(thing, component=replace(thing.component, iri=name)) for thing, name in zip(found, names, strict=True)
    ]
    without = [place for left_out in ledger.omissions() if left_out.what == NO_THINGS for place in left_out.sources]
    return _SourceThings(things, unreadable, tuple(without))


def _places(shown: str) -> list[str]:
    """Where a document comes from: its file, and the folders in which that lies; or its URL alone."""
    return [shown] if is_url(shown) else [shown, *map(str, Path(shown).parents)]


def unreadable_file(source: str) -> AuthorError | None:
    """Why no thing is described in a source that is one file; None for any other source, which may fill later."""
    if is_url(source) or not Path(source).is_file():
        return None
    found = _things_in(source, [])
    return None if found.things or not found.unreadable else found.unreadable[0]


def is_url(source: str) -> bool:
    """Whether a source is fetched, and no path."""
    return source.lower().startswith(("http://", "https://"))


def host_of(url: str) -> str:
    """The host to which a URL leads. Raises AuthorError for what is none."""
    try:
        http_origin(url)
    except ValueError:
        raise AuthorError(f"{url} is no http or https URL") from None
    return urlsplit(url).hostname or ""
