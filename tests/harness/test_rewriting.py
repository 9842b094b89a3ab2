"""Assertions that are rewritten beside the collection are as those that pytest rewrites, and it has to rewrite none."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow
ROOT = Path(__file__).resolve().parents[2]
CONFTEST = """
from tests.harness import rewriting

def pytest_collection(session):
    rewriting.end(rewriting.begin(session.config, {processes}))
    print("kept", sorted(path.name.partition(".")[0] for path in session.config.rootpath.rglob("test_*.pyc")))
"""


def outcome(folder: Path, processes: int) -> str:
    """What pytest says of a folder of tests whose assertions so many processes rewrite before they are collected."""
    (folder / "conftest.py").write_text(CONFTEST.format(processes=processes))
    quiet = "-q", "-s", "-rN", "-p", "no:cacheprovider", "-c", "/dev/null", "--rootdir", str(folder)
    environment = {**os.environ, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
    for asked_of_the_outer_run in ("PYTHONDONTWRITEBYTECODE", "PYTEST_ADDOPTS"):
        environment.pop(asked_of_the_outer_run, None)
    return subprocess.run(
        [sys.executable, "-m", "pytest", *quiet, str(folder)],
        cwd=ROOT,
        env=environment,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    ).stdout


@pytest.mark.parametrize("processes", [1, 2])
def test_each_module_is_rewritten_before_it_is_collected_and_tells_why_it_fails(tmp_path: Path, processes: int) -> None:
    modules = [f"test_{letter}" for letter in "abc"]
    for module in modules:
        (tmp_path / f"{module}.py").write_text("def test_fails():\n    some = [1, 2]\n    assert some == [1, 3]\n")
    said = outcome(tmp_path, processes)
    assert f"kept {modules}" in said
    assert said.count("At index 1 diff: 2 != 3") == len(modules)


def test_what_comes_before_a_module_that_is_rewritten_is_left_to_the_process_that_collects(tmp_path: Path) -> None:
    for letter in "ab":
        (tmp_path / f"test_{letter}.py").write_text("def test_passes():\n    assert True\n")
    outcome(tmp_path, 1)
    for kept in tmp_path.rglob("test_a.*.pyc"):
        kept.unlink()
    (tmp_path / "test_c.py").write_text("def test_cannot_be_read(:\n")
    (tmp_path / "test_d.py").write_text("def test_passes():\n    assert True\n")
    said = outcome(tmp_path, 1)
    assert "kept ['test_b', 'test_d']" in said
    assert "SyntaxError" in said
