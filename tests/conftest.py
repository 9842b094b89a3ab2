"""What every test shares: a runtime folder of its own, and names of ecologies that nobody else uses."""

from __future__ import annotations

import secrets
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

settings.register_profile("selfconf", deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("selfconf")


def pytest_addoption(parser: pytest.Parser) -> None:
    """The option by which a history is replayed."""
    parser.addoption("--seed", type=int, help="the seed of the first history of faults to run")


@pytest.fixture(autouse=True)
def runtime_folder(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Path:
    """No test sees the sites that happen to run on this machine, and none is seen by them."""
    folder = tmp_path_factory.mktemp("runtime")
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(folder))
    for name in ("SELFCONF_ECOLOGY", "SELFCONF_CONNECT", "SELFCONF_PARENT"):
        monkeypatch.delenv(name, raising=False)
    return folder


@pytest.fixture
def ecology() -> str:
    """A name that no other ecology on this machine has."""
    return f"test-{secrets.token_hex(4)}"
