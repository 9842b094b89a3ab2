"""The benchmark of the bridge: its short run works, and its table tells the ratio."""

from __future__ import annotations

import pytest

from benchmarks.bridge import LOADS, Relayed, report
from tests.benchmarks.short_run import short_run
from tests.harness.effort import thorough

pytest.importorskip("rosbags", reason="the extra `ros2` is not installed")


@thorough
@pytest.mark.process
def test_the_short_run_runs() -> None:
    assert "| sensor_msgs/msg/LaserScan | 2,936 | 40 |" in short_run("benchmarks.bridge")


def test_the_table_tells_the_ratio() -> None:
    table = report([Relayed(LOADS[0], 1000, 40.0, 38.0, [0.001] * 199 + [0.1]), Relayed(LOADS[2], 10, 0.0, 0.0, [])])
    assert "| 1,000 | 40 | 40.0 | 38.0 | 0.95 | 1.00 | 1.00 |" in table
    assert "| 10 | 1000 | 0.0 | 0.0 | - | - | - |" in table
