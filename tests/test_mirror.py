"""Each module of the library and of its commands has a file of tests in the same place of the tree of tests."""

from __future__ import annotations

from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
ROOMS = (
    "api",
    "bus",
    "cli",
    "composition",
    "configurator",
    "deployment",
    "model",
    "protocol",
    "query",
    "render",
    "sdk",
    "search",
    "site",
    "testing",
)
FILES = ("certificate", "discovery", "entailment", "errors", "files", "library", "rendezvous", "termination")
LEFT_OUT = {
    "bus/port.py": "a protocol and its values; the contract of the bus tests both buses by it",
    "configurator/effects.py": "a list of values; the tests of the machine look at each",
    "configurator/events.py": "a list of values; the tests of the machine send each",
    "deployment/run_request.py": "a list of values with defaults; the lab gives each to every runner of the tests",
    "protocol/messages.py": "a list of values; the tests of the codec write and read each",
    "search/engines/rival_process.py": "the program of a process; the tests of `rival` start it",
}
"""Modules without a file of tests, and why."""
MODULES = [
    path.relative_to(ROOT / "selfconf")
    for room in ROOMS
    for path in sorted((ROOT / "selfconf" / room).rglob("*.py"))
    if not path.name.startswith("__") and path.relative_to(ROOT / "selfconf").as_posix() not in LEFT_OUT
] + [Path(f"{name}.py") for name in FILES]


@pytest.mark.parametrize("module", MODULES, ids=str)
def test_a_module_has_a_file_of_tests(module: Path) -> None:
    tests = ROOT / "tests" / module.parent / f"test_{module.name}"
    assert tests.is_file()
    assert "\ndef test_" in tests.read_text("utf-8")


@pytest.mark.parametrize("module", LEFT_OUT)
def test_a_module_that_is_left_out_is_there_and_has_no_file_of_tests(module: str) -> None:
    path = Path(module)
    assert (ROOT / "selfconf" / path).is_file()
    assert not (ROOT / "tests" / path.parent / f"test_{path.name}").exists()
