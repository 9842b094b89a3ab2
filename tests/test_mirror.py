"""Each module of the library and of its commands has a file of tests in the same place of the tree of tests."""

from __future__ import annotations

from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
ROOMS = ("api", "cli", "composition", "model", "query", "render", "testing")
FILES = ("certificate", "entailment", "files", "library", "rendezvous", "termination")
MODULES = [
    path.relative_to(ROOT / "selfconf")
    for room in ROOMS
    for path in sorted((ROOT / "selfconf" / room).rglob("*.py"))
    if not path.name.startswith("__")
] + [Path(f"{name}.py") for name in FILES]


@pytest.mark.parametrize("module", MODULES, ids=str)
def test_a_module_has_a_file_of_tests(module: Path) -> None:
    tests = ROOT / "tests" / module.parent / f"test_{module.name}"
    assert tests.is_file()
    assert "\ndef test_" in tests.read_text("utf-8")
