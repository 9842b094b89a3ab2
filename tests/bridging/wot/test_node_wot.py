"""Things by node-wot, which nobody here wrote: described, read, followed, written, called, lost, come back."""

from __future__ import annotations

import socket
import subprocess
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from selfconf.model.term import IRI
from selfconf.protocol.messages import Wire
from tests.bridging.wot.bridged import active, bridging, button
from tests.foreign import node_command, npm_packages
from tests.harness.effort import at_night
from tests.sdk.living import LivingStage, until

pytestmark = [at_night, pytest.mark.process]
LAMP = Path(__file__).parent / "lamp.js"


@pytest.fixture(scope="session")
def packages() -> Path:
    """The packages of node-wot."""
    return npm_packages("@node-wot/core@0.9.2", "@node-wot/binding-http@0.9.2")


@contextmanager
def lamp(packages: Path, port: int) -> Iterator[Callable[[], None]]:
    """A lamp that is exposed; the value kills it."""
    command, environment = node_command(packages, LAMP, str(port))
    process = subprocess.Popen(command, env=environment, stdout=subprocess.PIPE)

    def kill() -> None:
        process.kill()
        process.wait()

    try:
        assert process.stdout is not None
        assert any(b"exposed" in line for line in process.stdout)
        yield kill
    finally:
        kill()
        if process.stdout is not None:
            process.stdout.close()


def test_a_lamp_by_node_wot_plays(living: LivingStage, tmp_path: Path, packages: Path) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        port = taken.getsockname()[1]
    with lamp(packages, port) as kill, bridging(living, tmp_path / "ads", f"http://127.0.0.1:{port}/lamp") as found:
        source = button(living)
        wire = (Wire(IRI("urn:c:button"), "on"),)
        names = ("on", "turns", "blinks", "flicker")
        on, turns, blinks, flicker = (found.heard("lamp", name) for name in names)
        active(found, on=wire, blink=wire)
        assert until(lambda: len(turns) > 2 and len(flicker) > 2 and blinks)  # by long polls, and by reading
        source.emit("on", {"on": True})
        assert until(lambda: on[-1:] == [{"on": True}] and blinks[-1] == 1), (on, blinks)
        assert found.causes() == []
        kill()
        assert until(lambda: found.causes() and not found.lives("lamp"))
        with lamp(packages, port):
            assert until(lambda: found.lives("lamp"))
            before = len(turns)
            active(found)
            assert until(lambda: len(turns) > before + 2)
