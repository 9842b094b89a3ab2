"""`demo --gui`: PyBullet's window opens where there is a display, and where there is none a sentence says so."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from selfconf.cli.main import main

pytest.importorskip("pybullet", reason="the window is PyBullet's")
pytestmark = pytest.mark.sim
ROOT = Path(__file__).parents[2]
PATIENCE = 60.0
LOOK = """
import pybullet
from sim.home.apartment import read_apartment
from sim.physics.world import World

world = World(read_apartment(), 1, gui=True)
assert pybullet.getConnectionInfo(0)["connectionMethod"] == pybullet.GUI
for _ in range(4):
    world.step()
world.close()
print("seen")
"""


@pytest.mark.skipif(shutil.which("xvfb-run") is None, reason="Xvfb, a display without a screen, is not installed")
def test_the_world_opens_in_a_window() -> None:
    command = ["xvfb-run", "-a", sys.executable, "-c", LOOK]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=PATIENCE, check=False)
    assert done.stdout.splitlines()[-1:] == ["seen"], done.stderr


@pytest.mark.parametrize("display", ["", ":9876", "127.0.0.1:-5991", "nonsense", ":x"])
def test_without_a_display_the_command_says_so(
    display: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("DISPLAY", display)
    assert main(["demo", "--gui", "--out", str(tmp_path / "out")]) == 2
    said = capsys.readouterr()
    assert (said.out, said.err.count("\n")) == ("", 1)
    assert "there is no display" in said.err
    assert not (tmp_path / "out").exists()
