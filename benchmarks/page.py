"""How soon the page of `selfconf serve` shows what happens, in a real browser.

    python -m benchmarks.page [--failures 10] [--components 1000]

A tracker raises FAIL in an ecology of real processes, again and again; the page is asked on each frame what it shows.

    diagram    from the call that makes it fail until the diagram shows the one that has taken over, in ms
    reason     ... until the time line says what was lost and why
    picture    from the address until the page shows a crowd of so many components
    change     from the end of one of these lives, or the beginning of one, until the page shows it

It needs Chromium, as the tests of the page do.
"""

from __future__ import annotations

import argparse
import re
import tempfile
import threading
import time
from contextlib import closing
from pathlib import Path

from benchmarks.machine import described, quantile, table
from selfconf.errors import NetworkError
from selfconf.model.term import IRI
from tests.cli.processes import Home
from tests.serve.chromium import CHROMIUM, Chromium

Times = dict[str, list[float]]
"""Seconds by what was measured."""
CROWD = "@prefix sc: <https://w3id.org/selfconf#> . @prefix rob: <https://w3id.org/selfconf/robotics#> .\n"
MEMBER = """<urn:crowd:sensor-{n}> a sc:Component, rob:PositionSensor ; rob:place <urn:crowd:room-{room}> ;
    sc:hasOutput [ sc:name "pose" ; sc:signalType rob:PlanarPose2D ] ."""
TRACKS, REPLACED = "person-tracker", "absolute-odometry"
PLAYER = "[...document.querySelectorAll('.box .name')].some((name) => name.textContent === {!r})"
REASON = f"document.querySelector('.events').textContent.includes('{TRACKS} failed: told to')"


def failures(browser: Chromium, folder: Path, number: int) -> Times:
    """The times until failures are shown, each of another run."""
    found: Times = {"diagram": [], "reason": []}
    home = Home(folder)
    with closing(home):
        home.site("peis-home", "ads")
        home.components("sonar", "encoder", "tracker", "odometry", "control", "drive")
        address = _address(home)
        for _ in range(number):
            run = home.run()
            run.act("running")
            page = browser.page(address)
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


def crowd(browser: Chromium, folder: Path, components: int, number: int) -> Times:
    """The times until a crowd and its changes are shown; a site advertises it, and this process lives for all of it."""
    found: Times = {"picture": [], "change": []}
    home = Home(folder)
    (folder / "crowd.ttl").write_text(CROWD + "\n".join(MEMBER.format(n=n, room=n % 30) for n in range(components)))
    tally = "document.querySelector('#tally').textContent.startsWith('{} of {} ')"
    with closing(home):
        home.site("crowd", "crowd.ttl")
        address = _address(home)
        with closing(home.node()) as bus:
            keys = [home.keys.life(IRI(f"urn:crowd:sensor-{n}"), "life") for n in range(components)]
            ends = [bus.announce(key) for key in keys]
            page = browser.page(address)
            page.until(tally.format(components, components))
            page.close()
            for _ in range(number):
                began = time.monotonic()
                page = browser.page(address)
                page.until(f"document.querySelector('.site') && {tally.format(components, components)}")
                found["picture"].append(time.monotonic() - began)
                began = time.monotonic()
                ends[7]()
                page.until(tally.format(components - 1, components))
                found["change"].append(time.monotonic() - began)
                began = time.monotonic()
                ends[7] = bus.announce(keys[7])
                page.until(tally.format(components, components))
                found["change"].append(time.monotonic() - began)
                page.close()
    return found


def _address(home: Home) -> str:
    """Where a server shows an ecology, once it does."""
    address = re.search(r"http://\S+/", home.selfconf("serve", "--ecology", home.ecology, "--port", "0").line())
    assert address is not None
    return address[0]


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
        (Path(folder) / "crowd").mkdir()
        times |= crowd(browser, Path(folder) / "crowd", given.components, given.failures)
    print(f"{described('uvicorn')}, {given.components} components\n\n{report(times)}")


if __name__ == "__main__":
    main()
