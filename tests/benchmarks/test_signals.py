"""The benchmark of signals: its short run works, and its page says what was measured."""

from __future__ import annotations

import pytest

from benchmarks.signals.__main__ import Effort, Found, Measured, report
from tests.benchmarks.short_run import short_run
from tests.harness.effort import thorough


@thorough
@pytest.mark.process
def test_the_short_run_runs() -> None:
    printed = short_run("benchmarks.signals")
    assert "| JSON | 1,000 |" in printed
    assert "A slow consumer" in printed


def test_the_page_tells_the_ratios() -> None:
    measured = {
        "bare": Measured([1000.0], [0.001] * 10, [0]),
        "least": Measured([980.0], [0.0011] * 10, [0]),
        "selfconf": Measured([950.0], [0.0012] * 10, [1]),
    }
    page = report(Found({("bytes", 100): measured}, {"bare": 1.0, "selfconf": 64.0}, Effort(1, 1, 10, 9)))
    row = "| bytes | 100 | 1,000 | 980 | 950 | 0.95 | 0.98 | 1.00 | 1.10 | 1.20 | 1.20 | 1.10 | 1.00 | 1.10 | 1.20 |"
    assert f"{row} 0 / 0 / 1 |" in page
    assert "selfconf 64 MB" in page
