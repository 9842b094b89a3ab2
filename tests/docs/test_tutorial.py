"""The tutorial tells the truth: its commands are run in order, and say what it shows."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.process

PAGE = (Path(__file__).parents[2] / "docs" / "tutorial.md").read_text()
PATIENCE = 40.0


def steps() -> list[tuple[str, list[str]]]:
    """Each command with the lines that are shown below it."""
    found: list[tuple[str, list[str]]] = []
    for block in re.findall(r"^```console\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL):
        for line in block.splitlines():
            if line.startswith("$ "):
                found.append((line.removeprefix("$ "), []))
            else:
                found[-1][1].append(line)
    return found


@pytest.fixture
def environment(tmp_path: Path) -> dict[str, str]:
    """One in which `selfconf` is this one."""
    program = tmp_path / "bin" / "selfconf"
    program.parent.mkdir()
    program.write_text(f'#!/bin/sh\nexec {shlex.quote(sys.executable)} -m selfconf "$@"\n')
    program.chmod(0o755)
    return {**os.environ, "PATH": f"{program.parent}:{os.environ['PATH']}"}


def test_the_commands_of_the_tutorial_say_what_it_shows(tmp_path: Path, environment: dict[str, str]) -> None:
    folder = tmp_path / "home"
    folder.mkdir()
    for command, shown in steps():
        done = subprocess.run(
            ["bash", "-c", command], cwd=folder, env=environment, capture_output=True, text=True, timeout=PATIENCE,
            check=False,
        )  # fmt: skip
        said = (done.stdout + done.stderr).splitlines()
        if "..." in shown:
            assert [line for line in said if line in shown] == [line for line in shown if line != "..."], (
                command,
                said,
            )
        else:
            assert said == shown, command


def test_the_test_of_the_tutorial_passes(tmp_path: Path, environment: dict[str, str]) -> None:
    (code,) = re.findall(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    (tmp_path / "test_fridge.py").write_text(code)
    write = "selfconf new component fridge && selfconf new template watch"
    for command in (write, f"{shlex.quote(sys.executable)} -m pytest -q -p no:cacheprovider test_fridge.py"):
        done = subprocess.run(
            ["bash", "-c", command], cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=PATIENCE,
            check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stdout + done.stderr
    assert "2 passed" in done.stdout


def test_the_tutorial_breaks_the_component_in_five_ways_and_mends_each() -> None:
    broken = [line for _, shown in steps() for line in shown if re.match(r"fridge\.ttl:\d+:\d+: ", line)]
    assert len({re.findall(r"\[(SC-\w+)\]", line)[0] for line in broken}) >= 5
    assert len(re.findall(r"^## \d\. ", PAGE, re.MULTILINE)) == 5
    assert sum(command.startswith("sed ") for command, _ in steps()) == 2 * len(broken)
