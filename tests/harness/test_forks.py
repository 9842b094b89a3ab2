"""Tests that run in forked processes are told of as in one: what passes, fails, warns, hangs and dies."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

pytestmark = pytest.mark.slow
ROOT = Path(__file__).resolve().parents[2]
CONFTEST = """
from tests.harness import forks

def pytest_addoption(parser):
    forks.add_option(parser)

def pytest_runtestloop(session):
    return forks.run(session)
"""
TROUBLE = """
import os, threading, warnings
import pytest

def test_hangs():
    threading.Event().wait()

def test_dies():
    os._exit(0)

@pytest.mark.parametrize("number", range(8))
def test_passes(number):
    pass

def test_warns():
    warnings.warn("look out")

@pytest.fixture
def broken():
    raise ValueError("before")

@pytest.fixture
def breaking():
    yield
    raise ValueError("after")

def test_is_never_begun(broken):
    pass

def test_cannot_be_left(breaking):
    pass
"""
SHARED = """
import os
import pytest

@pytest.fixture(scope="session", autouse=True)
def noted(tmp_path_factory):
    yield
    print("ended")
    (tmp_path_factory.getbasetemp() / "ended").write_text("yes")

@pytest.mark.parametrize("number", range(40))
def test_writes(number, tmp_path, capfd):
    os.system(f"echo {number}")
    assert capfd.readouterr().out == f"{number}\\n"
"""
INTERRUPTED = """
import threading
import pytest

@pytest.fixture
def begun(tmp_path):
    (tmp_path.parent.parent / "begun").touch()
    yield
    (tmp_path / "left").touch()

def test_fails(tmp_path):
    while not (tmp_path.parent.parent / "begun").exists():
        threading.Event().wait(0.01)
    assert False

@pytest.mark.parametrize("number", range(6))
def test_lasts(begun, number):
    threading.Event().wait(30.0)
"""


def outcome(folder: Path, text: str, *options: str) -> subprocess.CompletedProcess[str]:
    """Run such tests in two processes."""
    (folder / "conftest.py").write_text(CONFTEST)
    (folder / "test_some.py").write_text(text)
    quiet = "-q", "-p", "no:cacheprovider", "-c", "/dev/null", "--rootdir", str(folder)
    return subprocess.run(
        [sys.executable, "-m", "pytest", *quiet, "--forks=2", *options, str(folder)],
        cwd=ROOT,
        env={**os.environ, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"},  # to import them takes as long as all else
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


def test_a_test_that_hangs_or_dies_has_failed_and_the_others_go_on_and_errors_are_told(tmp_path: Path) -> None:
    bounded = "-o", "faulthandler_timeout=1", "-o", "faulthandler_exit_on_timeout=true"
    ended = outcome(tmp_path, TROUBLE, *bounded, "--junitxml", str(tmp_path / "report.xml"))
    assert ended.returncode == 1, ended.stderr
    assert "2 failed, 10 passed, 1 warning, 2 errors" in ended.stdout
    assert "ValueError: before" in ended.stdout
    assert "ValueError: after" in ended.stdout
    assert "look out" in ended.stdout
    assert "crashed while running 'test_some.py::test_hangs'" in ended.stdout
    assert "crashed while running 'test_some.py::test_dies'" in ended.stdout
    assert "in test_hangs" in ended.stderr + ended.stdout, "it says where it was"
    cases = ElementTree.parse(tmp_path / "report.xml").iter("testcase")
    assert {case.get("name") for case in cases if len(case)} == {
        *("test_hangs", "test_dies", "test_is_never_begun", "test_cannot_be_left")
    }


def test_each_process_has_its_output_and_folder_and_leaves_its_fixtures(tmp_path: Path) -> None:
    ended = outcome(tmp_path, SHARED, "--basetemp", str(tmp_path / "temporary"))
    assert ended.returncode == 0, ended.stdout
    assert "40 passed" in ended.stdout
    assert len([*(tmp_path / "temporary").glob("*/ended")]) == 2


def test_no_further_test_is_begun_after_as_many_failures_as_are_allowed(tmp_path: Path) -> None:
    text = "import pytest\n@pytest.mark.parametrize('number', range(40))\ndef test_fails(number):\n    assert False\n"
    ended = outcome(tmp_path, text, "-x")
    assert ended.returncode == 1
    assert "1 failed" in ended.stdout
    assert "stopping after 1 failures" in ended.stdout


def test_what_runs_when_no_further_test_is_begun_leaves_its_fixtures(tmp_path: Path) -> None:
    """It may have begun programs, which else would run forever."""
    ended = outcome(tmp_path, INTERRUPTED, "-x", "--basetemp", str(tmp_path / "temporary"))
    assert "1 failed" in ended.stdout
    assert [*(tmp_path / "temporary").rglob("left")]
    assert "Traceback" not in ended.stderr
