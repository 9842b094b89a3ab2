"""What a refusal tells beyond its reasons: near misses by type, what would mend it, the reasoning that would."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.command import Outcome, run
from tests.lab import PREFIXES

ROLES = 7


CROWD = "\n".join(f":c{k} a sc:Component, :Worker ." for k in range(ROLES - 1))
"""One worker too few: Algorithm 1 tries them all in every order, which takes longer than anyone waits."""


TEAM = f":team a sc:Template ; sc:roles ( {' '.join(f':r{k}' for k in range(ROLES))} ) .\n" + "\n".join(
    f":r{k} a sc:Role ; sh:class :Worker ." for k in range(ROLES)
)


@pytest.fixture
def team(tmp_path: Path) -> Path:
    """A template and a folder of advertisements beside it."""
    (tmp_path / "ads").mkdir()
    (tmp_path / "ads" / "crowd.ttl").write_text(PREFIXES + CROWD)
    (tmp_path / "team.ttl").write_text(PREFIXES + TEAM)
    return tmp_path


def configure(capsys: pytest.CaptureFixture[str], team: Path, *arguments: str) -> Outcome:
    """Run `configure` for the team."""
    return run(capsys, "configure", str(team / "team.ttl"), "--ads", str(team / "ads"), *arguments)


def test_steps_limit_what_is_tried_to_mend_a_refusal_too(capsys: pytest.CaptureFixture[str], team: Path) -> None:
    assert configure(capsys, team, "--format", "json").body["repairs"]
    assert not configure(capsys, team, "--format", "json", "--steps", "40").body["repairs"]
