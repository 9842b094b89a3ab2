"""Each module has a file of tests in the same place of the tree of tests, or a reason why it has none."""

from __future__ import annotations

from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
_MESSAGES = "a list of values; the tests of the codec write and read each"
LEFT_OUT = {
    "bus/port.py": "a protocol and its values; the contract of the bus tests both buses by it",
    "configurator/effects.py": "a list of values; the tests of the machine look at each",
    "configurator/events.py": "a list of values; the tests of the machine send each",
    "protocol/messages/access.py": _MESSAGES,
    "protocol/messages/calls.py": _MESSAGES,
    "protocol/messages/component_reports.py": _MESSAGES,
    "protocol/messages/signals.py": _MESSAGES,
    "protocol/messages/sites.py": _MESSAGES,
    "protocol/messages/tasks.py": _MESSAGES,
    "protocol/messages/texts.py": "names for types of fields; the tests of the codec read each",
    "search/engines/rival_process.py": "the program of a process; the tests of `rival` start it",
}
"""Modules without a file of tests, and why; `__init__` and `__main__` have none anywhere."""
MODULES = [
    module
    for module in (path.relative_to(ROOT / "selfconf") for path in sorted((ROOT / "selfconf").rglob("*.py")))
    if not module.name.startswith("__") and module.as_posix() not in LEFT_OUT
]


def file_of_tests(module: Path) -> Path:
    """The file of tests of a module."""
    return ROOT / "tests" / module.parent / f"test_{module.name}"


@pytest.mark.parametrize("module", MODULES, ids=str)
def test_a_module_has_a_file_of_tests(module: Path) -> None:
    tests = file_of_tests(module)
    assert tests.is_file(), f"write {tests.relative_to(ROOT)}, or say in LEFT_OUT why there is none"
    assert "\ndef test_" in tests.read_text("utf-8")


@pytest.mark.parametrize("module", [Path(module) for module in LEFT_OUT], ids=str)
def test_a_module_that_is_left_out_is_there_and_has_no_file_of_tests(module: Path) -> None:
    assert (ROOT / "selfconf" / module).is_file()
    assert not file_of_tests(module).exists()
