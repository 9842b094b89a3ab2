"""The benchmark of `validate`: its short run works, and it notices verdicts that differ."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks import validate
from tests.harness.effort import thorough


@thorough
@pytest.mark.process
def test_the_short_run_runs(capsys: pytest.CaptureFixture[str]) -> None:
    assert validate.main(["--smoke"]) == 0
    printed = capsys.readouterr().out
    assert printed.count("\n| 10 |") == 4
    assert "20 SC-L02" in printed
    assert "| a literal of 17 MiB | 1 SC-S05 | 2 |" in printed


@pytest.mark.process
def test_verdicts_that_differ_are_noticed(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    real = validate.run
    monkeypatch.setattr(validate, "SAMPLE", 2)
    monkeypatch.setattr(
        validate,
        "run",
        lambda words, cache: validate.Finished(0, "", 1.0, 1) if "pyshacl" in words else real(words, cache),
    )
    with pytest.raises(AssertionError):
        validate.measure(10, 1, tmp_path)
