"""A bridge: it advertises what is foreign, and lives as it for as long as it is there.

A file in the folder of the bridge is an advertisement; the site of the bridge serves the folder, and sees within a
second what has come or gone. A life begins and ends on the thread of the components' code, in the order in which it was
asked for; that thread does no work for the other side, which has a thread of its own, so that no foreign component
waits for another.
"""

from __future__ import annotations

import itertools
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Protocol

from selfconf.bus.port import Bus
from selfconf.errors import NetworkError, SelfconfError
from selfconf.importing import ImportedDocument, described_text, slug
from selfconf.model.term import IRI
from selfconf.sdk import Component, Host


class ForeignWorld(Protocol):
    """The other side of a bridge; from its beginning it looks for what lives there, and tells the bridge."""

    def close(self) -> None:
        """Look no more, and end all that is under way; every component has come to rest before."""
        ...


class Bridge:
    """The components of this side that stand for what lives on the other one."""

    def __init__(self, folder: Path, complain: Callable[[str], None], ontologies: Sequence[Path] = ()) -> None:
        """`folder` is where the advertisements go; `complain` hears, on any thread, what cannot be bridged, and why.

        What the components issue is checked against the fields that `ontologies` state, besides those of selfconf.
        """
        self.complain = complain
        self._folder, self._ontologies = folder, ontologies
        self._paths: dict[IRI, Path] = {}
        self._numbers = itertools.count(1)
        self._living: dict[IRI, Component] = {}
        self._host: Host | None = None
        self._ended = False

    def advertise(self, component: IRI, document: ImportedDocument) -> None:
        """Say what a component is, from now on; by what was said of it before it lives no more.

        Raises OSError where that cannot be written.
        """
        self._end(component, None)
        path = self._paths.get(component)
        if path is None:
            name = slug(component.rpartition("/")[2].rpartition("#")[2] or component)[:80]
            path = self._paths[component] = self._folder / f"{name}-{next(self._numbers)}.ttl"
        written = path.with_suffix(".new")
        written.write_text(f"# Bridged from {document.source!r}.\n\n{described_text(document)}", "utf-8")
        written.replace(path)

    def withdraw(self, component: IRI) -> None:
        """Advertise a component no more, and end its life."""
        self._end(component, None)
        path = self._paths.pop(component, None)
        if path is not None:
            path.unlink(missing_ok=True)

    def begin_life(self, component: IRI, code: Component) -> Future[str | None]:
        """Let a component that is advertised live, by its code; the result says what keeps it from that.

        May be called from any thread, which may wait for the result, or cancel it as long as it has not begun.
        """
        outcome: Future[str | None] = Future()

        def begin() -> None:
            host = self._running_host()
            if not outcome.set_running_or_notify_cancel():
                return
            path = self._paths.get(component)
            if path is None:
                outcome.set_result("it has gone before it could live here")
                return
            try:
                host.add(code, advertisement=path)
            except SelfconfError as error:
                outcome.set_result(str(error))
            else:
                self._living[component] = code
                outcome.set_result(None)

        self._running_host().code.call(begin)
        return outcome

    def end_life(self, component: IRI, code: Component) -> None:
        """Let a component live no more by this code; nothing happens if it does not, or lives by another one.

        May be called from any thread.
        """
        self._end(component, code)

    def _end(self, component: IRI, code: Component | None) -> None:
        """End the life of a component by some code, or by whichever it has when its turn comes."""

        def end() -> None:
            living = self._living.get(component)
            if living is not None and code in (None, living):
                del self._living[component]
                self._running_host().remove(living)

        self._running_host().code.call(end)

    def lives(self, component: IRI) -> bool:
        """Whether a component lives here; it may have had to leave, where another process is the same one."""
        return component in self._living

    @contextmanager
    def living(
        self, open_world: Callable[[Bridge], ForeignWorld], ecology: str, session: Callable[[], Bus]
    ) -> Iterator[None]:
        """Bridge a world to an ecology inside the `with` block; world and session are opened for it.

        Raises NetworkError where the ecology or the world cannot be reached.
        """
        self._host = Host(session(), ecology, self.complain, self._ontologies)
        thread = threading.Thread(target=self._run, args=(self._host,), name="code of foreign components")
        thread.start()
        with ExitStack() as worlds:
            try:
                worlds.callback(open_world(self).close)
                yield
            finally:  # the components first: at rest they ask nothing of their world any more
                self._ended = True
                self._host.code.wake_up()
                thread.join()

    def _run(self, host: Host) -> None:
        """Run the code of the components until the bridge ends; one that has to leave leaves alone."""
        while not self._ended:
            try:
                host.run(lambda: self._ended)
            except NetworkError as error:
                self.complain(str(error))
                host.trouble = None
                left = [runtime.component for runtime in host.runtimes if runtime.closed]
                for component in [one for one, code in self._living.items() if code in left]:
                    host.remove(self._living.pop(component))
        host.close()

    def _running_host(self) -> Host:
        assert self._host is not None, "a bridge has components only while it lives"
        return self._host
