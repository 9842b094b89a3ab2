"""The short run of a benchmark, in a process of its own as users start it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def short_run(module: str, *options: str) -> str:
    """What `python -m MODULE --smoke` prints, with further options; it has to end with 0."""
    command = [sys.executable, "-m", module, "--smoke", *options]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return done.stdout
