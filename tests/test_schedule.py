"""Tests that share something costly share a process."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests import schedule

ROOT = Path(__file__).resolve().parents[1]


@pytest.mark.parametrize(
    ("test", "group"),
    [
        ("tests/cli/test_status.py::test_nothing_is_deployed", "inhabited"),
        ("tests/rdf/test_validation.py::test_a_bad_file_earns_what_its_first_line_says[x]", "bad files"),
        ("tests/recorded/test_recorded.py::test_sentences_are_as_recorded[bad]", f"{schedule.RECORDED}bad]"),
        ("tests/search/test_examples.py::test_a", "tests/search/test_examples.py::test_a"),
    ],
)
def test_a_test_is_in_one_group(test: str, group: str) -> None:
    assert schedule.group_of(test) == group


def test_the_groups_are_of_modules_and_tests_that_exist() -> None:
    assert [module for module in (*schedule.INHABITED, schedule.RECORDED) if not (ROOT / module).exists()] == []
    text = "\n".join(path.read_text() for path in (ROOT / "tests").rglob("test_*.py"))
    assert [name for name in schedule.BAD_FILES if f"\ndef {name}" not in text] == []


@pytest.mark.slow
def test_a_test_that_hangs_has_failed_and_the_others_go_on_and_errors_are_told(tmp_path: Path) -> None:
    (tmp_path / "conftest.py").write_text(
        "from tests.messages import keep_short\nfrom tests.schedule import scheduler\n"
        "def pytest_xdist_make_scheduler(config, log):\n    return scheduler(config, log)\n"
        "def pytest_collection_finish(session):\n    keep_short(session.config)\n"
    )
    (tmp_path / "test_some.py").write_text(
        "import threading, pytest\ndef test_hangs():\n    threading.Event().wait()\n"
        "@pytest.mark.parametrize('number', range(8))\ndef test_passes(number):\n    pass\n"
        "@pytest.fixture\ndef broken():\n    raise ValueError('before')\n"
        "@pytest.fixture\ndef breaking():\n    yield\n    raise ValueError('after')\n"
        "def test_is_never_begun(broken):\n    pass\ndef test_cannot_be_left(breaking):\n    pass\n"
    )
    bounded = "-o", "faulthandler_timeout=0.3", "-o", "faulthandler_exit_on_timeout=true"
    quiet = "-q", "-p", "no:cacheprovider", "-p", "no:hypothesispytest"
    ended = subprocess.run(
        [sys.executable, "-m", "pytest", *quiet, "-n2", *bounded, "-c", "/dev/null", "--rootdir", tmp_path, tmp_path],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert ended.returncode == 1, ended.stderr
    assert "1 failed, 9 passed, 2 errors" in ended.stdout
    assert "ValueError: before" in ended.stdout
    assert "ValueError: after" in ended.stdout
    assert "crashed while running 'test_some.py::test_hangs'" in ended.stdout
    assert "in test_hangs" in ended.stderr + ended.stdout, "it says where it was"
