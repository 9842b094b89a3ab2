"""The benchmark of signals: its short run works, and its page says what was measured."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.signals.__main__ import Effort, Found, Measured, report

ROOT = Path(__file__).resolve().parents[1]


@pytest.mark.process
def test_the_short_run_runs() -> None:
    command = [sys.executable, "-m", "benchmarks.signals", "--smoke"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert "| JSON | 1,000 |" in done.stdout
    assert "A slow consumer" in done.stdout


def test_the_page_tells_the_ratios() -> None:
    bare, ours = Measured([1000.0], [0.001] * 10, [0]), Measured([950.0], [0.0012] * 10, [1])
    page = report(
        Found({("bytes", 100): {"bare": bare, "selfconf": ours}}, {"bare": 1.0, "selfconf": 64.0}, Effort(1, 1, 10, 9))
    )
    assert "| bytes | 100 | 1,000 | 950 | 0.95 | 1.00 | 1.20 | 1.20 | 1.00 | 1.20 | 0 / 1 |" in page
    assert "selfconf 64 MB" in page
