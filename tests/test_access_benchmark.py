"""The benchmark of what keys cost: its short run works, and its table says ratios."""

from __future__ import annotations

import pytest

from benchmarks.access import report
from tests.benchmark import short_run


@pytest.mark.process
def test_the_short_run_runs() -> None:
    printed = short_run("benchmarks.access")
    assert "| failover |" in printed
    assert "| signal of 300,000 bytes |" in printed


def test_the_table_tells_ratios() -> None:
    assert "| x | 2.00 | 3.00 | 1.50 |" in report({("x", False): [0.002] * 3, ("x", True): [0.003] * 3})
