"""The paper's template and advertisements on files, and `configure` over them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from selfconf.model.term import IRI
from tests.cli.command import Outcome, run
from tests.lab import NAVIGATE, PREFIXES, write_advertisements

BOUND = ("--bind", "robot=:Astrid", "--bind", "goal=(AT BEDROOM)")


class Desk:
    """A template and advertisements on files, and the command over them."""

    def __init__(self, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
        self.folder, self.capsys = folder, capsys
        self.ads = write_advertisements(folder / "ads")
        self.template = folder / "navigate.ttl"
        self.template.write_text(NAVIGATE)

    def configure(self, *arguments: str, ads: bool = True) -> Outcome:
        """Run `configure` with the template and the advertisements."""
        given = ("--ads", str(self.ads)) if ads else ()
        return run(self.capsys, "configure", str(self.template), *given, *arguments)

    def configured(self, *arguments: str) -> dict[str, Any]:
        """The configuration as JSON."""
        outcome = self.configure(*arguments, "--format", "json")
        assert outcome.code == 0, outcome
        body: dict[str, Any] = outcome.body
        assert body["status"] == "configured"
        return body

    def refused(self, *arguments: str) -> dict[str, Any]:
        """The refusal as JSON."""
        outcome = self.configure(*arguments, "--format", "json")
        assert outcome.code == 1, outcome
        body: dict[str, Any] = outcome.body
        assert body["status"] == "refused"
        return body

    def advertise(self, name: str, text: str) -> None:
        """Put one more advertisement there."""
        (self.ads / f"{name}.ttl").write_text(PREFIXES + text)


def players(body: dict[str, Any]) -> dict[str, list[str]]:
    """Who plays which role, by short names."""
    return {IRI(role["role"]).short: [IRI(c).short for c in role["components"]] for role in body["roles"]}


def with_template(desk: Desk, text: str) -> None:
    """Use another template."""
    desk.template.write_text(PREFIXES + text)
