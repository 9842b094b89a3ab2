"""Tests that share something costly share a process."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.harness import schedule

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize(
    ("test", "group"),
    [
        ("tests/rdf/test_validation.py::test_a_bad_file_earns_what_its_first_line_says[x]", "bad files"),
        ("tests/recorded/test_recorded.py::test_sentences_are_as_recorded[bad]", f"{schedule.RECORDED}bad]"),
        ("tests/search/test_examples.py::test_a", "tests/search/test_examples.py::test_a"),
    ],
)
def test_a_test_is_in_one_group(test: str, group: str) -> None:
    assert schedule.group_of(test) == group


def test_what_uses_the_ecology_that_is_started_once_is_in_one_group_wherever_it_is() -> None:
    groups = {
        schedule.group_of(test, ["home", schedule.INHABITED]) for test in ("tests/a.py::test_a", "tests/b.py::test_b")
    }
    assert groups == {schedule.INHABITED}


def test_the_groups_are_of_modules_and_tests_that_exist() -> None:
    assert [module for module in (*schedule.WHOLE, schedule.RECORDED) if not (ROOT / module).exists()] == []
    text = "\n".join(path.read_text() for path in (ROOT / "tests").rglob("test_*.py"))
    assert [name for name in schedule.BAD_FILES if f"\ndef {name}" not in text] == []


def test_one_process_in_three_computes_while_the_others_wait() -> None:
    assert [schedule.computes(process) for process in range(6)] == [False, False, True, False, False, True]
