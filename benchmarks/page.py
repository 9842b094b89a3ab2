"""How soon the page of `selfconf serve` shows what happens, in a real browser.

    python -m benchmarks.page [--failures 10] [--components 1000]

A tracker raises FAIL in an ecology of real processes, again and again; the page is asked on each frame what it shows.

    diagram    from the call that makes it fail until the diagram shows the one that has taken over, in ms
    reason     ... until the time line says what was lost and why
    picture    from the address until the page shows a crowd of so many components
    change     from the moment when the server hears that one of them is gone until the page shows it

It needs Chromium, as the tests of the page do.
"""

from __future__ import annotations

import argparse
import re
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import replace
from pathlib import Path

import uvicorn

from benchmarks.machine import described, quantile, table
from selfconf.errors import NetworkError
from selfconf.serve.board import Board
from selfconf.serve.change import EcologyChange
from selfconf.serve.metrics import Metrics
from selfconf.serve.server import bound
from tests.cli.processes import Home
from tests.serve.asgi import served
from tests.serve.chromium import CHROMIUM, Chromium
from tests.serve.shown import advertised

Times = dict[str, list[float]]
"""Seconds by what was measured."""
TRACKS, REPLACED = "person-tracker", "absolute-odometry"
PLAYER = "[...document.querySelectorAll('.box .name')].some((name) => name.textContent === {!r})"
REASON = f"document.querySelector('.events').textContent.includes('{TRACKS} is lost: it failed: told to')"


def failures(browser: Chromium, folder: Path, number: int) -> Times:
    """The times until failures are shown, each of another run."""
    found: Times = {"diagram": [], "reason": []}
    home = Home(folder)
    with closing(home):
        home.site("peis-home", "ads")
        home.components("sonar", "encoder", "tracker", "odometry", "control", "drive")
        address = re.search(r"http://\S+/", home.selfconf("serve", "--ecology", home.ecology, "--port", "0").line())
        assert address is not None
        for _ in range(number):
            run = home.run()
            run.act("running")
            page = browser.page(address[0])
            page.until(PLAYER.format(TRACKS))
            order = home.folder / "tracker.fail"
            order.touch()
            while order.exists():  # the component looks at it every 50 ms, which is no time of ours
                threading.Event().wait(0.001)
            began = time.monotonic()
            page.until(PLAYER.format(REPLACED))
            found["diagram"].append(time.monotonic() - began)
            page.until(REASON)
            found["reason"].append(time.monotonic() - began)
            page.close()
            run.end()
    return found


@contextmanager
def _address(board: Board) -> Iterator[str]:
    config = uvicorn.Config(served(board), log_level="warning", access_log=False, lifespan="off", ws="none")
    server = uvicorn.Server(config)
    with bound("127.0.0.1", 0) as place:
        thread = threading.Thread(target=server.run, args=([place],))
        thread.start()
        try:
            yield f"http://127.0.0.1:{place.getsockname()[1]}/"
        finally:
            board.stream.close()
            server.should_exit = True
            thread.join()


def crowd(browser: Chromium, components: int, number: int) -> Times:
    """The times until a crowd and its changes are shown."""
    found: Times = {"picture": [], "change": []}
    board, one = Board("crowd", Metrics()), advertised("tracker")
    body = next(iter(one.components.values()))
    assert body is not None
    bodies = {
        f"urn:c:{n}": {**body, "name": f"sensor-{n}", "places": [f"room-{n % 30}"], "site": f"host-{n % 10}"}
        for n in range(components)
    }
    board.apply(replace(one, components=bodies, sites={f"host-{n}": {"missing": False} for n in range(10)}))
    tally = "document.querySelector('#tally').textContent.startsWith('{} of {} ')"
    with _address(board) as address:
        for _ in range(number):
            began = time.monotonic()
            page = browser.page(address)
            page.until(f"document.querySelector('.site') && {tally.format(components, components)}")
            found["picture"].append(time.monotonic() - began)
            for state, alive in (("absent", components - 1), ("alive", components)):
                began = time.monotonic()
                board.apply(EcologyChange(components={"urn:c:7": {**bodies["urn:c:7"], "state": state}}))
                page.until(tally.format(alive, components))
                found["change"].append(time.monotonic() - began)
            page.close()
    return found


def report(times: Times) -> str:
    """A table of what was measured, in milliseconds."""
    rows = [
        [name, str(len(seconds)), f"{1e3 * quantile(seconds, 0.5):.0f}", f"{1e3 * max(seconds):.0f}"]
        for name, seconds in times.items()
    ]
    return table(["until it is shown, in ms", "times", "median", "worst"], rows)


def main() -> None:
    """Measure, and print a table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--failures", type=int, default=10)
    parser.add_argument("--components", type=int, default=1000)
    given = parser.parse_args()
    if CHROMIUM is None:
        raise NetworkError("there is no Chromium; SELFCONF_CHROMIUM names one")
    with tempfile.TemporaryDirectory() as folder, closing(Chromium(Path(folder) / "browser")) as browser:
        (Path(folder) / "home").mkdir()
        times = failures(browser, Path(folder) / "home", given.failures)
        times |= crowd(browser, given.components, given.failures)
    print(f"{described('uvicorn')}, {given.components} components\n\n{report(times)}")


if __name__ == "__main__":
    main()
