"""The measurement of the page: it runs through, with few failures and a small crowd, and says what it has measured."""

from __future__ import annotations

import sys

import pytest

from tests.harness.effort import thorough
from tests.serve.chromium import CHROMIUM

pytest.importorskip("starlette", reason="the extra `serve` is not installed")
pytestmark = [
    pytest.mark.process,
    pytest.mark.slow,
    thorough,
    pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium; SELFCONF_CHROMIUM names one"),
]


def test_a_failure_and_a_crowd_are_measured(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from benchmarks.page import main

    monkeypatch.setattr(sys, "argv", ["page", "--failures", "1", "--components", "50"])
    main()
    said = capsys.readouterr().out
    assert "50 components" in said
    for name in ("diagram", "reason", "picture", "change"):
        assert f"| {name}" in said
