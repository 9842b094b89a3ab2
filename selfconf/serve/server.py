"""The server as a program: one thread listens to the ecology, one serves HTTP, and one hands changes over."""

from __future__ import annotations

import asyncio
import logging
import os
import signal
import socket
import time
from collections.abc import Callable, Collection, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from types import FrameType

import uvicorn

from selfconf.api.membership import Membership
from selfconf.api.sites.site_program import is_beyond_loopback
from selfconf.bus.credentials import Credentials
from selfconf.bus.port import Bus
from selfconf.errors import AuthorError, NetworkError
from selfconf.model.setting_names import setting
from selfconf.query import StandingDataset
from selfconf.serve.application import LOOPBACK, application
from selfconf.serve.board import Board
from selfconf.serve.connections import BoundedConnection, LoopFaults, config_of
from selfconf.serve.explained_refusals import ExplainedRefusals
from selfconf.serve.fits import Fits
from selfconf.serve.look_endpoint import Onlookers
from selfconf.serve.metrics import Metrics
from selfconf.serve.sparql.endpoint import SparqlEndpoint
from selfconf.serve.watching.change import EcologyChange
from selfconf.serve.watching.history import CANNOT_WRITE, History
from selfconf.serve.watching.watcher import EcologyWatcher
from selfconf.termination import PARENT_CHECK, ending_signals, orphaned, started_by_another

log = logging.getLogger(__name__)

SETTLED = 15.0
"""Seconds after which every configurator that lives has said what it has deployed."""
FIRST_LOOK = 3
"""Seconds after which the server is said to listen, also if it has not heard the whole ecology yet."""
LAST_ANSWERS = 2
"""Seconds that answers which are under way may take when the server is ended."""
AFTER_THEM = 2
"""Seconds for what served a connection to end with it, before uvicorn cancels it and logs where it was."""


@dataclass(frozen=True)
class ServerOptions:
    """Where a server listens, and what it allows."""

    host: str
    port: int
    seconds: float
    """How long a query may take."""
    folder: Path | None = None
    """Where the history is kept, if it is."""
    origins: Collection[str] = ()
    """Whose pages may ask besides its own, as browsers write an origin."""


def refuse_exposure(host: str, credentials: Credentials | None) -> None:
    """Raise AuthorError where other hosts can reach a server with keys: by HTTP it asks no client for any."""
    if credentials is not None and is_beyond_loopback(host):
        raise AuthorError(
            f"{host} can be reached from other hosts, and any program that asks by HTTP sees what"
            f" {credentials.name} may see, without keys: listen on 127.0.0.1, behind a server that asks who it is, or"
            f" give {setting('insecure')} if that is what you want"
        )


def names_at(host: str) -> Collection[str]:
    """The names under which a server at an address may be asked; empty, for any, where other hosts can reach it."""
    return () if is_beyond_loopback(host) else LOOPBACK | {host}


def serve_ecology(membership: Membership, options: ServerOptions, listening: Callable[[str], None]) -> None:
    """Serve an ecology over HTTP until SIGINT, SIGTERM or SIGHUP; `listening` receives the URL.

    Raises NetworkError where the port is taken or the ecology cannot be reached, and AuthorError for a folder that
    cannot be used.
    """
    with bound(options.host, options.port) as place:
        record = Record(options.folder)
        try:
            bus = membership.connect()
            try:
                asyncio.run(_serve(bus, membership, record, place, options, listening))
            finally:
                bus.close()
        finally:
            record.close()


class Record:
    """The dataset that is asked, and the history on disk that is part of it; used on one thread."""

    def __init__(self, folder: Path | None) -> None:
        self.dataset = StandingDataset()
        self.dataset.start()
        self.hands = ThreadPoolExecutor(1, "changes")
        """Where changes are noted: it takes time that neither the bus nor the server has."""
        self._history = None if folder is None else History(folder)
        if self._history is not None:
            self._replace(self._history.past())

    def note(self, change: EcologyChange) -> None:
        """Note a change; where the disk is full it is missing in the history, and can be asked for all the same."""
        self._replace({**change.graphs, **change.deployed})
        if self._history is None:
            return
        try:
            past = self._history.note(change.deployed, change.events)
        except CANNOT_WRITE as error:
            log.error("a change is missing in the history: %s", error)
        else:
            self._replace(past)

    def settle(self) -> None:
        """Take what the last server has left running, and does not run any more, for the past."""
        if self._history is not None:
            self._replace(self._history.settle())

    def _replace(self, graphs: Mapping[str, bytes]) -> None:
        for graph, triples in graphs.items():
            self.dataset.replace(graph, triples)

    def close(self) -> None:
        """Note what is left to be noted, and end."""
        self.hands.shutdown()
        if self._history is not None:
            self._history.close()
        self.dataset.close()


async def _serve(
    bus: Bus,
    membership: Membership,
    record: Record,
    place: socket.socket,
    options: ServerOptions,
    listening: Callable[[str], None],
) -> None:
    loop, metrics = asyncio.get_running_loop(), Metrics(time.time())
    loop.set_exception_handler(LoopFaults())
    board = Board(membership.ecology, metrics)
    sparql = SparqlEndpoint(record.dataset, metrics, options.seconds)
    host, port = place.getsockname()[:2]
    onlookers = Onlookers(bus, board, may_hear=not membership.looks_on_only)
    fits, explained, hosts = Fits(board), ExplainedRefusals(board), names_at(host)
    app = application(board, metrics, sparql, onlookers, fits, explained, lambda: bus.link, hosts, options.origins)

    def take(change: EcologyChange) -> None:
        try:
            record.note(change)
        except Exception:  # an outermost loop: the page shows all the same what cannot be asked for
            log.exception("a change is missing in what is asked; going on")
        loop.call_soon_threadsafe(board.apply, change)  # last: a client that hears of it finds it by SPARQL

    def tell(change: EcologyChange) -> None:
        record.hands.submit(take, change)

    watcher = EcologyWatcher(bus, membership.ecology, tell, aside=record.hands.submit, believed=membership.beliefs())
    bus.run_aside()
    bus.wake_up(watcher.begin)
    loop.call_later(SETTLED, lambda: record.hands.submit(record.settle))
    config = config_of(app)
    url = f"http://{f'[{host}]' if ':' in host else host}:{port}/"
    server = _Server(config, board, onlookers, lambda: listening(url))
    config.timeout_graceful_shutdown = LAST_ANSWERS + AFTER_THEM
    await server.serve(sockets=[place])


class _Server(uvicorn.Server):
    """Says once that it listens, ends its streams when it is ended, and ends when the program that began it is gone."""

    def __init__(
        self, config: uvicorn.Config, board: Board, onlookers: Onlookers, listening: Callable[[], None]
    ) -> None:
        super().__init__(config)
        self._board, self._onlookers = board, onlookers
        self._listening: Callable[[], None] | None = listening
        self._parent, self._looked = os.getppid(), 0.0
        for number in ending_signals():
            signal.signal(number, self.handle_exit)  # uvicorn itself listens for SIGINT and SIGTERM alone

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        """End, by a signal."""
        self.should_exit = True

    async def on_tick(self, counter: int) -> bool:
        """Look, ten times a second, whether to end, and whether what is asked first would be answered."""
        if self._listening is not None and (self._board.link or counter >= FIRST_LOOK * 10):
            tell, self._listening = self._listening, None
            tell()
        if started_by_another() and counter % int(PARENT_CHECK * 10) == 0 and orphaned(self._parent):
            self.should_exit = True
        ending = bool(await super().on_tick(counter))
        if ending:
            self._board.stream.close()
            self._onlookers.close()
            asyncio.get_running_loop().call_later(LAST_ANSWERS, self._hang_up)
        return ending

    def _hang_up(self) -> None:
        for connection in list(self.server_state.connections):
            if isinstance(connection, BoundedConnection):
                connection.hang_up()


def bound(host: str, port: int) -> socket.socket:
    """A socket that is bound to an address. Raises NetworkError where it is taken, AuthorError for what is none."""
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
    except (OSError, OverflowError, UnicodeError):  # of a name such as `a..b`
        advice = f"try {setting('host', '127.0.0.1')}"
        raise AuthorError(f"{host!r} with port {port} is no address of this machine; {advice}") from None
    place = socket.socket(family, kind, protocol)
    place.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        place.bind(address)
        place.listen(128)
    except OSError as error:
        place.close()
        said = error.strerror or str(error)
        advice = f"give another one by {setting('port')}"
        raise NetworkError(f"cannot listen on port {port} of {host} ({said}); {advice}") from None
    return place
