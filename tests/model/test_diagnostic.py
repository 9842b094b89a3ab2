"""Diagnostics and reports as values."""

from __future__ import annotations

from selfconf.model.diagnostic import Severity


def test_severities_are_words() -> None:
    assert [severity.value for severity in Severity] == ["error", "warning"]
