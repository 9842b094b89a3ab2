"""What every test shares: a runtime folder of its own, names of ecologies that no other test uses, and the order."""

from __future__ import annotations

import gc
import os
import secrets
import sys
from collections.abc import Iterator
from itertools import count
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from selfconf.__main__ import COLLECTING
from tests.harness import forks, rewriting
from tests.harness.asked_here import ask_here
from tests.harness.effort import examples
from tests.harness.frozen import freeze_what_is_there

settings.register_profile(
    "selfconf",
    max_examples=examples(100),
    deadline=None,
    derandomize=True,
    print_blob=True,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("selfconf")
REWRITING = pytest.StashKey[list[int]]()
"""The processes that rewrite assertions while the tests are collected."""
gc.set_threshold(10 * COLLECTING[0], *COLLECTING[1:])  # of what tests make, little is garbage that waits to be found


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options of the tests."""
    forks.add_option(parser)


@pytest.hookimpl(tryfirst=True)
def pytest_runtestloop(session: pytest.Session) -> bool | None:
    """Run the tests in several processes, where these are asked for."""
    return forks.run(session)


@pytest.hookimpl(tryfirst=True)
def pytest_collection(session: pytest.Session) -> None:
    """Where tests run in several processes, use all processors while these are collected too."""
    config = session.config
    keeps = config.option.assertmode == "rewrite" and not sys.dont_write_bytecode
    config.stash[REWRITING] = (
        rewriting.begin(config, (os.cpu_count() or 1) - 1) if config.option.forks > 1 and keeps else []
    )


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Where tests run in several processes, put those that wait for programs first, and those that compute last."""
    if config.option.forks > 1:
        items.sort(key=_place)


def pytest_collection_finish(session: pytest.Session) -> None:
    """Have read what many tests need; neither at this nor at the tests has the collector of garbage to look again."""
    rewriting.end(session.config.stash[REWRITING])
    if session.config.option.forks > 1:
        from tests.harness.read_before import read_what_many_tests_need

        read_what_many_tests_need()
    freeze_what_is_there()


def _place(item: pytest.Item) -> int:
    if item.get_closest_marker("process"):
        return 0
    return 2 if item.get_closest_marker("slow") else 1


@pytest.fixture(scope="session")
def runtime_folders(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """Folders without end, one for each test, in a folder of their own: `mktemp` reads all names beside a new one."""
    return map(tmp_path_factory.mktemp("runtime").joinpath, map(str, count()))


@pytest.fixture(autouse=True)
def runtime_folder(runtime_folders: Iterator[Path], monkeypatch: pytest.MonkeyPatch) -> Path:
    """No test sees the sites that happen to run on this machine, and none is seen by them."""
    folder = next(runtime_folders)
    folder.mkdir(mode=0o700)
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(folder))
    for name in ("SELFCONF_ECOLOGY", "SELFCONF_CONNECT", "SELFCONF_PARENT", "SELFCONF_ROS_DEFINITIONS"):
        monkeypatch.delenv(name, raising=False)
    return folder


@pytest.fixture(scope="session", autouse=True)
def keys_of_all(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Every program of the tests has no keys, or, by `make test-keys`, those of one authority."""
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv("SELFCONF_KEYS", raising=False)
        if "SELFCONF_TEST_KEYS" in os.environ:
            from selfconf.access import Authority

            patch.setenv("SELFCONF_KEYS", str(Authority.init(tmp_path_factory.mktemp("authority") / "keys").path))
        yield


@pytest.fixture
def asked_here() -> Iterator[pytest.MonkeyPatch]:
    """Queries need no process of their own, until this is undone."""
    with pytest.MonkeyPatch.context() as patch:
        ask_here(patch)
        yield patch


@pytest.fixture
def ecology() -> str:
    """A name that no other ecology on this machine has."""
    return f"test-{secrets.token_hex(4)}"
