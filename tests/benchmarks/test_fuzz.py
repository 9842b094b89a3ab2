"""The fuzzer of `validate`: its short run works, and what it changes is changed where it says."""

from __future__ import annotations

import random

import pytest

from benchmarks import fuzz
from tests.harness.effort import thorough


@thorough
@pytest.mark.slow
def test_the_short_run_meets_its_goals(capsys: pytest.CaptureFixture[str]) -> None:
    assert fuzz.main(["--smoke"]) == 0
    printed = capsys.readouterr().out
    assert "100.0 % found" in printed
    assert " 0 false alarms" in printed
    assert f"| {len(fuzz.MISTAKES)} mistakes" in printed or f"{len(fuzz.MISTAKES)} mistakes:" in printed


def test_a_mistake_that_is_missed_is_counted(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(fuzz, "_problems", lambda text: [])
    assert fuzz.main(["--smoke"]) == 1
    assert " 0.0 % found" in capsys.readouterr().out


def test_a_change_tells_where_it_is() -> None:
    changed = fuzz.misspelt("a sc:Component", random.Random(1))
    assert changed is not None
    assert changed.offset == 2
    assert changed.text != "a sc:Component"
    assert sorted(changed.text) == sorted("a sc:Component")
