"""The acts of `selfconf run` over the clock of the examples, with real processes, ended by SIGINT once it runs."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tests.recorded.answers import Answer
from tests.recorded.cases import CLOCK, ROOT

MILESTONES = frozenset(("query", "discovered", "composed", "running", "stopped"))
"""The acts that can have only one place among the others."""
PATIENCE = 60.0
"""Seconds that it may take on a busy machine."""


def acts(here: Path) -> Iterator[tuple[str, Answer]]:
    """The names of the acts, each with the names of its members.

    Two components are activated beside each other, and either may be quicker, so what happens between two of the
    `MILESTONES` is put in the order of its name.
    """
    environment = {name: value for name, value in os.environ.items() if not name.startswith("SELFCONF_")}
    environment |= {"SELFCONF_RUNTIME_DIR": str(here), "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-m", "selfconf", "run", *CLOCK, "--format", "json"]
    told: list[dict[str, Any]] = []
    with subprocess.Popen(
        command, cwd=ROOT, env=environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ) as process:
        alarm = threading.Timer(PATIENCE, process.kill)
        alarm.start()
        for line in process.stdout or ():
            told.append(json.loads(line))
            if told[-1]["act"] == "running":
                process.send_signal(signal.SIGINT)
        code = process.wait(PATIENCE)
        alarm.cancel()
    named = [{"act": account["act"], "members": sorted(account)} for account in told]
    yield "run", Answer({"exit": code, "acts": list(_ordered(named))}, {})


def _ordered(acts: list[dict[str, Any]]) -> Iterator[dict[str, Any]]:
    between: list[dict[str, Any]] = []
    for act in acts:
        if act["act"] in MILESTONES:
            yield from sorted(between, key=lambda each: each["act"])
            between.clear()
            yield act
        else:
            between.append(act)
    yield from sorted(between, key=lambda each: each["act"])
