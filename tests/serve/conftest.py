"""A server without a network: a board with the ecology of the tests, and a dataset; nothing without the extra."""

from __future__ import annotations

import importlib.util
import os
from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest

from tests.lab import ADVERTISEMENTS

if TYPE_CHECKING:
    from selfconf.query import StandingDataset
    from selfconf.serve.board import Board

MISSING = [name for name in ("starlette", "uvicorn") if importlib.util.find_spec(name) is None]
collect_ignore_glob = ["test_*.py"] if MISSING else []
"""The tests that import what the extra `serve` brings."""


def pytest_report_header() -> list[str]:
    """Say why tests, or what they would check, are left out."""
    left_out = [f"tests/serve is left out: {', '.join(MISSING)} is not installed"] if MISSING else []
    unchecked = (
        [] if os.environ.get("AXE_CORE") else ["the page is not checked by axe-core: AXE_CORE names no axe.min.js"]
    )
    return left_out + unchecked


@pytest.fixture
def board() -> Board:
    from selfconf.serve.board import Board
    from selfconf.serve.metrics import Metrics
    from tests.serve.shown import advertised

    board = Board("lab", Metrics())
    board.apply(advertised(*ADVERTISEMENTS))
    return board


@pytest.fixture(scope="module")
def dataset() -> Iterator[StandingDataset]:
    from selfconf.query import StandingDataset
    from tests.serve.shown import advertised

    dataset = StandingDataset()
    for graph, triples in advertised(*ADVERTISEMENTS).graphs.items():
        dataset.replace(graph, triples)
    yield dataset
    dataset.close()
