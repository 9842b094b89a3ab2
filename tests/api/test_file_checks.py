"""What `validate` has found is remembered where that is asked for; more is tried in tests/cli/test_file_checks.py."""

from __future__ import annotations

from pathlib import Path

import pytest

import selfconf as sc


def test_a_remembered_report_is_the_same_and_is_kept_in_the_cache_of_the_user(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    first = sc.validate("tests/bad/bound-twice.ttl", cache=True)
    assert list(tmp_path.rglob("validate/*.json"))
    assert sc.validate("tests/bad/bound-twice.ttl", cache=True) == first == sc.validate("tests/bad/bound-twice.ttl")
