"""Things by node-wot, which nobody here wrote: described, read, followed, written, called, lost, come back."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from selfconf.model.term import IRI
from selfconf.protocol.messages import Wire
from tests.bridging.wot.bridged import active, bridging, button
from tests.sdk.living import LivingStage, until

FOLDER = os.environ.get("NODE_WOT", "")
pytestmark = [
    pytest.mark.process,
    pytest.mark.skipif(shutil.which("node") is None, reason="node, which node-wot needs, is not installed"),
    pytest.mark.skipif(
        not Path(FOLDER, "node_modules", "@node-wot").is_dir() or not FOLDER,
        reason="type `npm install @node-wot/core@0.9.2 @node-wot/binding-http@0.9.2` in a folder, and say by NODE_WOT"
        " which one it is",
    ),
]
LAMP = Path(__file__).parent / "lamp.js"


@contextmanager
def lamp(port: int) -> Iterator[Callable[[], None]]:
    """A lamp that is exposed; the value kills it."""
    environment = {**os.environ, "NODE_PATH": str(Path(FOLDER).absolute() / "node_modules")}
    process = subprocess.Popen(["node", str(LAMP), str(port)], env=environment, stdout=subprocess.PIPE)

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


def test_a_lamp_by_node_wot_plays(living: LivingStage, tmp_path: Path) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        port = taken.getsockname()[1]
    with lamp(port) as kill, bridging(living, tmp_path / "ads", f"http://127.0.0.1:{port}/lamp") as found:
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
        with lamp(port):
            assert until(lambda: found.lives("lamp"))
            before = len(turns)
            active(found)
            assert until(lambda: len(turns) > before + 2)
