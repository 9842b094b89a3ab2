"""The example of ROS 2: a talker is replaced by another when it dies, judged by nodes that others have written."""

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
        reason="zenoh-ros2-sdk, whose nodes the example plays, is not installed",
    ),
]
pytest.importorskip("rosbags", reason="the extra `ros2` is not installed")
ROOT = Path(__file__).parents[2]


def test_the_scene_is_played_to_its_end(tmp_path: Path) -> None:
    environment = {**os.environ, "SELFCONF_RUNTIME_DIR": str(tmp_path), "PYTHONPATH": str(ROOT)}
    played = subprocess.run(
        [sys.executable, "-m", "examples.ros2"], cwd=ROOT, env=environment, capture_output=True, text=True, timeout=240
    )
    assert played.returncode == 0, played.stdout + played.stderr
    lines = played.stdout.splitlines()
    killed = next(index for index, line in enumerate(lines) if line.endswith(" is killed"))
    _, one, *_ = lines[killed].split()
    before = {line.split()[1] for line in lines[:killed] if line.startswith("heard ")}
    assert before == {one}
    assert {line.split()[1] for line in lines if line.startswith("heard ")} == {"talker_one", "talker_two"}
    assert sum(line.endswith("     running") for line in lines) == 2
