"""The example of the Web of Things: a lamp and a switch that never heard of each other."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = [pytest.mark.process, pytest.mark.slow]
pytest.importorskip("aiohttp", reason="the extra `wot` is not installed")
ROOT = Path(__file__).parents[2]


def test_the_scene_is_played_to_its_end(tmp_path: Path) -> None:
    environment = {**os.environ, "SELFCONF_RUNTIME_DIR": str(tmp_path), "PYTHONPATH": str(ROOT)}
    played = subprocess.run(
        [sys.executable, "-m", "examples.wot"], cwd=ROOT, env=environment, capture_output=True, text=True, timeout=240
    )
    assert played.returncode == 0, played.stdout + played.stderr
    lines = played.stdout.splitlines()
    pulled = lines.index("* the plug of the lamp that shines is pulled")
    assert sum("lamp" in line and line.endswith(" is on") for line in lines[:pulled]) == 1
    assert sum(line.endswith("     running") for line in lines) == 2
    over = lines[lines.index("* that was all") :]  # among what the bridge says of the plug, whenever it asks
    assert sum(line.endswith("taken down") for line in over) == 1
