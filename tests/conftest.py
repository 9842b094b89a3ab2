"""What every test shares: a runtime folder of its own, names of ecologies that no other test uses, and the order."""

from __future__ import annotations

import gc
import os
import secrets
from collections.abc import Iterator
from itertools import count
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, settings

from selfconf.__main__ import COLLECTING
from tests import messages, schedule, shares
from tests.asked_here import ask_here
from tests.effort import examples
from tests.frozen import freeze_what_is_there

settings.register_profile(
    "selfconf",
    max_examples=examples(100),
    deadline=None,
    derandomize=True,
    print_blob=True,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("selfconf")
gc.set_threshold(10 * COLLECTING[0], *COLLECTING[1:])  # of what tests make, little is garbage that waits to be found


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Spread the tests over processes so that those of a group share one."""
    return schedule.scheduler(config, log)


def pytest_collection(session: pytest.Session) -> None:
    """Where tests run in several processes, let each prepare a share of the modules for all."""
    if hasattr(session.config, "workerinput"):
        shares.prepare(session.config.args, session.config.workerinput)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Where tests run in several processes, put those that wait for programs first, and those that compute last."""
    for item in items:
        if "inhabited" in getattr(item, "fixturenames", ()) and schedule.group_of(item.nodeid) != "inhabited":
            raise pytest.UsageError(f"{item.nodeid} uses `inhabited`: add its module to INHABITED in tests/schedule.py")
    if hasattr(config, "workerinput"):
        items.sort(key=_place)


def pytest_collection_finish(session: pytest.Session) -> None:
    """The collector of garbage has no need to look at what the tests are made of again and again."""
    freeze_what_is_there()
    if hasattr(session.config, "workerinput"):
        messages.keep_short(session.config)


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
            from selfconf.access import KeysFolder

            patch.setenv("SELFCONF_KEYS", str(KeysFolder.init(tmp_path_factory.mktemp("authority") / "keys").path))
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
