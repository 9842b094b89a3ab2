"""The pages tell the truth about the tree: their links lead somewhere, and the tests that they name exist."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = [*sorted(ROOT.glob("*.md")), *sorted((ROOT / "docs").rglob("*.md"))]
LINK = re.compile(r"\]\(([^)\s#]+)(?:#[^)\s]*)?\)")
TEST = re.compile(r"\[`(test_\w+)`\]\(([^)\s]+)\)")


def name(page: Path) -> str:
    """A page by its path from the root."""
    return page.relative_to(ROOT).as_posix()


@cache
def named_in(folder: Path) -> frozenset[str]:
    """The names of the tests in the modules of a folder and below."""
    return frozenset(
        found for path in folder.rglob("test_*.py") for found in re.findall(r"^def (test_\w+)", path.read_text(), re.M)
    )


@pytest.mark.parametrize("page", PAGES, ids=name)
def test_every_link_to_a_file_leads_to_one(page: Path) -> None:
    targets = [target for target in LINK.findall(page.read_text()) if "://" not in target]
    assert [target for target in targets if not (page.parent / target).exists()] == []


@pytest.mark.parametrize("page", PAGES, ids=name)
def test_every_test_that_a_page_names_exists(page: Path) -> None:
    claims = TEST.findall(page.read_text())
    assert [test for test, folder in claims if test not in named_in((page.parent / folder).resolve())] == []


def test_each_part_of_the_semantics_names_the_tests_that_hold_it() -> None:
    parts = (ROOT / "docs" / "semantics.md").read_text().split("\n## ")[1:]
    without = [part.partition("\n")[0] for part in parts if not TEST.search(part)]
    assert without == []
