"""The ecologies of real processes, and the files to be validated, that the tests of the commands use."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.cli.desk import Desk
from tests.cli.diagnosed import write_diagnosed
from tests.cli.processes import Home
from tests.harness import schedule

_INHABITED = pytest.StashKey[Home]()
"""The paper's ecology, while it runs."""


@pytest.fixture
def home(tmp_path: Path) -> Iterator[Home]:
    """An ecology of a test's own, without any process yet."""
    home = Home(tmp_path)
    yield home
    home.close()


@pytest.fixture(scope="session")
def inhabited(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Home]:
    """The paper's ecology: one site, and all components in one process; whoever uses it leaves nothing deployed."""
    home = Home(tmp_path_factory.mktemp("inhabited"))
    home.site("peis-home", "ads")
    home.components("sonar", "encoder", "tracker", "odometry", "control", "drive", "pippi")
    request.session.stash[_INHABITED] = home
    yield home
    home.close()


@pytest.hookimpl(trylast=True)
def pytest_runtest_teardown(item: pytest.Item, nextitem: pytest.Item | None) -> None:
    """End the paper's ecology after the last of its tests: seven components that act take a tenth of a processor."""
    home = item.session.stash.get(_INHABITED, None)
    leaving = schedule.INHABITED not in getattr(nextitem, "fixturenames", ())
    # In one process its tests do not follow each other.
    if home is not None and leaving and item.config.option.forks > 1:
        del item.session.stash[_INHABITED]
        home.close()


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, with a file that conforms, two with a problem each, and one that is not Turtle."""
    monkeypatch.chdir(tmp_path)
    return write_diagnosed(tmp_path)


@pytest.fixture
def desk(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Desk:
    """The paper's files."""
    return Desk(tmp_path, capsys)
