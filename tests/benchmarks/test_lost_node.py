"""The benchmark of lost nodes: its table tells the ratio; at night it runs with nodes by hiroz."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.lost_node import LostSource, measure, ratio, report
from tests.foreign import built_crate
from tests.harness.effort import at_night

JUDGE = Path(__file__).parents[1] / "bridging" / "ros2" / "judge"
MOST = 3.0
"""How many times as long a repair may take, on a busy machine, when a node is lost: it is about one."""


def test_the_table_tells_the_ratio() -> None:
    found = {"nodes": [LostSource(0.002, 0.009)] * 3, "components": [LostSource(0.003, 0.006)] * 3}
    assert "| nodes, repaired | 9.00 | 9.00 |" in report(found)
    assert "nodes / components, repaired: 1.50 (medians)" in report(found)


@at_night
@pytest.mark.process
def test_a_native_node_that_is_killed_is_replaced_as_a_component_is() -> None:
    pytest.importorskip("rosbags", reason="the extra `ros2` is not installed")
    found = measure(str(built_crate(JUDGE)), 5)
    assert ratio(found) < MOST, report(found)
