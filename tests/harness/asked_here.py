"""Queries answered in the process of the tests, by the program that answers each in a process of its own.

A process costs a third of a second. That there is one, which can be ended, is tested in `tests/query/test_process.py`.
"""

from __future__ import annotations

import io
import subprocess
import sys
from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import pytest

from selfconf.module_command import module_command
from selfconf.query import process


def _answered(command: Sequence[str], input: bytes, **_: Any) -> subprocess.CompletedProcess[bytes]:
    """What the process would answer that reads these bytes."""
    assert list(command) == module_command("selfconf.query")
    streams = {name: io.TextIOWrapper(io.BytesIO(b"" if name != "stdin" else input)) for name in ("stdin", *SAID)}
    with pytest.MonkeyPatch.context() as patch:
        for name, stream in streams.items():
            patch.setattr(sys, name, stream)
        code = process.main()
    out, err = (streams[name].buffer.getvalue() for name in SAID)
    return subprocess.CompletedProcess(command, code, out, err)


SAID = ("stdout", "stderr")


def ask_here(patch: pytest.MonkeyPatch) -> None:
    """Answer queries here until `patch` is undone; only their memory and time are not limited."""
    patch.setattr(process, "subprocess", SimpleNamespace(run=_answered, TimeoutExpired=subprocess.TimeoutExpired))
    patch.setattr(process, "resource", SimpleNamespace(setrlimit=lambda *_: None, RLIMIT_CORE=0, RLIMIT_AS=0))
