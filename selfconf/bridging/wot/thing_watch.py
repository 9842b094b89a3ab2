"""One thing that a bridge looks for: it lives on this side while it answers.

One that does not do what its description says is lost at once, and lives again when it answers; each time sooner lost
again, it waits longer for that.
"""

from __future__ import annotations

import asyncio
from dataclasses import field
from pathlib import Path

from selfconf.bridging.bridge import Bridge
from selfconf.bridging.wot.credentials import ThingCredentials
from selfconf.bridging.wot.interactions import ThingInteractions
from selfconf.bridging.wot.thing_client import NO_ANSWER, ThingClient, ThingError, ThingLimits
from selfconf.bridging.wot.thing_component import ThingComponent
from selfconf.importing import DescribedThing, ImportedDocument
from selfconf.model.immutable import immutable

LETTING_GO = 0.5
"""Seconds from FAIL to the end of a life, in which a configurator can still release the component in good order."""


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


def _kind(trouble: str) -> str:
    """What a complaint is compared by: without what follows its first colon, which may be other words each time.

    Why there is no connection, such as a certificate that is not trusted, is said in few words, and counts.
    """
    kind = trouble.partition(": ")[0]
    return trouble if kind.endswith(NO_ANSWER) else kind
