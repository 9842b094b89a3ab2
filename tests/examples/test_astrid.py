"""The example of both bridges: a node that others have written, a Thing, and components of the SDK in one task."""

from __future__ import annotations

import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

pytestmark = [
    pytest.mark.process,
    pytest.mark.slow,
    pytest.mark.skipif(
        find_spec("zenoh_ros2_sdk") is None,
        reason="zenoh-ros2-sdk, whose node the example plays, is not installed",
    ),
]
pytest.importorskip("rosbags", reason="the extra `ros2` is not installed")
pytest.importorskip("aiohttp", reason="the extra `wot` is not installed")
ROOT = Path(__file__).parents[2]


def test_astrid_reaches_the_bedroom_though_her_tracker_sees_her_no_more(tmp_path: Path) -> None:
    environment = {**os.environ, "SELFCONF_RUNTIME_DIR": str(tmp_path), "PYTHONPATH": str(ROOT)}
    played = subprocess.run(
        [sys.executable, "-m", "examples.astrid"],
        cwd=ROOT,
        env=environment,
        capture_output=True,
        text=True,
        timeout=240,
    )
    assert played.returncode == 0, played.stdout + played.stderr
    lines = played.stdout.splitlines()
    light = ["it is dark", "there is light"]
    way = [
        "my position comes from tracker",
        "my position comes from odometry",
        "Astrid is in the bedroom",
        "* that was all",
    ]
    for told in (light, way):
        assert [line for line in dict.fromkeys(lines) if line in told] == told
    assert "the lamp is on" in lines
    assert any("silence" in line and "tracker" in line for line in lines)
