"""Nothing here can be imported without the extra `wot`."""

from __future__ import annotations

import importlib.util

MISSING = importlib.util.find_spec("aiohttp") is None
collect_ignore_glob = ["test_*.py"] if MISSING else []


def pytest_report_header() -> str:
    """Say why tests are left out."""
    return "tests/bridging/wot is left out: aiohttp is not installed" if MISSING else ""
