"""An import of what lives by the command: what it needs, and what it does not take."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.command import run

ELSEWHERE = ("--connect", "tcp/127.0.0.1:1")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (("ros2",), "name at least one SOURCE to import"),
        (("wot", *ELSEWHERE), "it goes with ros2 and no SOURCE"),
        (("ros2", "models", *ELSEWHERE), "it goes with ros2 and no SOURCE"),
        (("ros2", *ELSEWHERE), "no router of ROS 2 answers at tcp/127.0.0.1:1;"),
        (("ros2", *ELSEWHERE, "--namespace", "here"), "cannot be a namespace"),
        (("ros2", *ELSEWHERE, "--domain", "233"), "a number from 0 to 232"),
    ],
)
def test_what_cannot_be_imported_is_a_sentence(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, arguments: tuple[str, ...], sentence: str
) -> None:
    outcome = run(capsys, "import", *arguments, "--out", str(tmp_path))
    assert outcome.code == 2
    assert sentence in outcome.err
