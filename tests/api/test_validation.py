"""`validate` of the library: which files it reads, and what it reports of them."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from selfconf.api.validation import check
from tests.cli.diagnosed import GOOD, write_diagnosed


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, with a file that conforms, two with a problem each, and one that is not Turtle."""
    monkeypatch.chdir(tmp_path)
    return write_diagnosed(tmp_path)


def test_a_folder_stands_for_all_turtle_below_it(folder: Path) -> None:
    (folder / "deep" / "er").mkdir(parents=True)
    (folder / "deep" / "er" / "x.ttl").write_text(GOOD.replace(":tuner", ":deep"))
    (folder / "deep" / "notes.txt").write_text("no Turtle")
    assert check(["deep"]).files == ("deep/er/x.ttl",)
    assert len(check([".", "good.ttl"]).files) == 5


def test_a_file_that_is_named_twice_is_read_once(folder: Path) -> None:
    assert not check(["good.ttl", "./good.ttl", str(folder / "good.ttl")]).diagnostics


def test_good_advertisements_pass_without_rdflib(folder: Path) -> None:
    program = (
        "import sys\nfrom selfconf.api.validation import check\n"
        "assert check(['good.ttl']).conforms\nassert 'rdflib' not in sys.modules"
    )
    environment = {"PYTHONPATH": str(Path(__file__).parents[2])}
    subprocess.run([sys.executable, "-c", program], check=True, env=environment)


def test_a_file_that_is_too_large_is_not_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("selfconf.api.validation.LARGEST_FILE", 10)
    (tmp_path / "a.ttl").write_text("# more than ten bytes")
    report = check([str(tmp_path)])
    assert [each.code for each in report.diagnostics] == ["SC-S05"]
    assert report.unreadable
