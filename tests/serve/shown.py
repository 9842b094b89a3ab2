"""The components of the lab as a server shows them, and a server that shows a board."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import uvicorn

from selfconf.discovery import FoundAdvertisement
from selfconf.rdf import advertisements, turtle
from selfconf.serve.board import Board
from selfconf.serve.server import bound
from selfconf.serve.watching.change import EcologyChange
from selfconf.serve.watching.component_bodies import component_body
from tests.lab import ADVERTISEMENTS, PREFIXES
from tests.serve.asgi import served


def found(name: str, more: str = "") -> FoundAdvertisement:
    """One of the advertisements of the lab, and what more it says, as a discovery finds it."""
    good, _ = advertisements.read_advertisements((PREFIXES + ADVERTISEMENTS[name] + more).encode(), name)
    return FoundAdvertisement(good[0], "astrid", f"{name}.ttl", startable=name == "control")


def advertised(*names: str) -> EcologyChange:
    """The change by which some components are there."""
    all_found = [found(name) for name in names]
    components = {one.advertisement.component: one for one in all_found}
    return EcologyChange(
        components,
        {str(c): component_body(one, "alive") for c, one in components.items()},
        {"astrid": {"missing": False}},
        graphs={str(c): turtle.ntriples(one.advertisement.triples) for c, one in components.items()},
        link="network",
    )


@contextmanager
def serving(board: Board) -> Iterator[tuple[str, Callable[[EcologyChange], object]]]:
    """Serve a board over HTTP on a thread: its address, and what changes the board, from any thread."""
    config = uvicorn.Config(served(board), log_level="warning", access_log=False, lifespan="off", ws="none")
    server, begun = uvicorn.Server(config), threading.Event()
    loops: list[asyncio.AbstractEventLoop] = []

    async def serve() -> None:
        loops.append(asyncio.get_running_loop())
        begun.set()
        await server.serve(sockets=[place])

    with bound("127.0.0.1", 0) as place:
        thread = threading.Thread(target=lambda: asyncio.run(serve()))
        thread.start()
        begun.wait()
        try:
            # A board is changed on the thread that serves it, which would otherwise sleep on.
            yield (
                f"http://127.0.0.1:{place.getsockname()[1]}/",
                lambda change: loops[0].call_soon_threadsafe(board.apply, change),
            )
        finally:
            loops[0].call_soon_threadsafe(board.stream.close)
            server.should_exit = True
            thread.join()
