"""Reports as workflow commands of GitHub Actions."""

from __future__ import annotations

from pathlib import Path

from selfconf.api.validation import check
from selfconf.cli.reports import RENDERERS
from tests.cli.diagnosed import NASTY


def test_workflow_commands_are_escaped() -> None:
    assert RENDERERS["github"](NASTY) == (
        "::error file=a%2Cb%3Ac%25.ttl,line=3,endLine=3,col=7,endColumn=9,title=SC-A01::"
        "100 %25%0D%0Aof <this> & \x1b[31m that,: so Try.\n"
    )


def test_warnings_are_workflow_warnings(folder: Path) -> None:
    assert RENDERERS["github"](check(["strange.ttl"])).startswith(
        "::warning file=strange.ttl,line=10,endLine=10,col=23,"
    )
