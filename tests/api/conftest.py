"""What the tests of the library share: the checkout as the current folder, and a site of a test's own."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

import selfconf as sc
from tests.cli.processes import Home

ROOT = Path(__file__).resolve().parents[2]
CLOCK = "examples/clock/tell-the-time.ttl"


@pytest.fixture(autouse=True)
def in_checkout(monkeypatch: pytest.MonkeyPatch) -> None:
    """The examples are named from the root of the checkout."""
    monkeypatch.chdir(ROOT)


@pytest.fixture
def home() -> sc.Ecology:
    """The ecology of the paper."""
    return sc.read("examples/peis-home")


@pytest.fixture
def task() -> sc.TaskSpecification:
    """The task of the paper, bound."""
    return sc.template("examples/navigate.ttl").bind(robot=":Astrid", goal="(AT BEDROOM)")


@pytest.fixture
def clock() -> sc.TaskSpecification:
    """Show the time on a display."""
    return sc.template(CLOCK)


@pytest.fixture
def served(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Home]:
    """An ecology with a site that can start a clock and a display, found as the only one of this machine."""
    served = Home(tmp_path)
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(served.runtime))
    served.site("home", str(ROOT / "examples" / "clock"))
    yield served
    served.close()
