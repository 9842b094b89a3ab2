"""Files are validated as the command does it; the report prints a line for each problem."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import selfconf as sc
from selfconf.api.validation import check
from selfconf.errors import AuthorError, ProgrammerError
from selfconf.model.diagnostic import Diagnostic, Report, Severity
from tests.cli.diagnosed import GOOD, write_diagnosed

BAD = Path("tests/bad/bound-twice.ttl")


def test_one_path_or_several_as_text_or_as_path_are_validated() -> None:
    for paths in (BAD, str(BAD), [BAD], (str(BAD),), iter([BAD])):
        report = sc.validate(paths)
        assert isinstance(report, Report)
        assert report.files == (str(BAD),)
        assert (report.errors, report.warnings, report.conforms) == (1, 1, False)


def test_a_report_is_true_if_all_conforms_and_has_its_problems() -> None:
    good, bad, strange = sc.validate("examples/clock"), sc.validate(BAD), sc.validate("tests/supply")
    assert (bool(good), len(good), list(good)) == (True, 0, [])
    assert (bool(bad), len(bad), tuple(bad)) == (False, 2, bad.diagnostics)
    assert (bad[0], bad[-1:]) == (bad.diagnostics[0], bad.diagnostics[-1:])
    assert (bad.index(bad.diagnostics[1]), *reversed(bad)) == (1, *reversed(bad.diagnostics))
    assert (bool(strange), [one.code for one in strange]) == (True, ["SC-S04"])


def test_each_diagnostic_has_its_place_code_and_message() -> None:
    (error,) = (one for one in sc.validate(BAD).diagnostics if one.severity is Severity.ERROR)
    assert isinstance(error, Diagnostic)
    assert (error.file, error.line, error.column, error.code) == (str(BAD), 7, 24, "SC-K03")
    assert error.message == "A task binds each parameter at most once."


def test_a_report_prints_its_counts_and_a_line_for_each_problem() -> None:
    report = sc.validate(BAD)
    said = repr(report).splitlines()
    assert said[0] == "<1 error and 1 warning in 1 file>"
    assert str(report).splitlines() == [str(found) for found in report]
    assert str(report).startswith(f"{BAD}:")
    assert said[-1].split()[:4] == [str(BAD), "7", "error", "SC-K03"]
    assert "<td style='text-align:left'>SC-K03</td>" in report._repr_html_()
    good = sc.validate("examples/clock")
    assert repr(good) == str(good) == "<0 errors and 0 warnings in 3 files>"
    assert good._repr_html_() == "<pre>&lt;0 errors and 0 warnings in 3 files&gt;</pre>"


def test_what_cannot_be_read_is_a_diagnostic_and_an_ontology_that_cannot_be_is_an_error() -> None:
    (found,) = sc.validate("no-such-file.ttl").diagnostics
    assert found.code == "SC-S03"
    with pytest.raises(AuthorError, match="ontology cannot be read"):
        sc.validate(BAD, ontologies="no-such-ontology.ttl")


def test_a_folder_that_cannot_be_read_keeps_no_other_from_being_checked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "closed").mkdir()
    (tmp_path / "bad.ttl").write_bytes(Path(BAD).read_bytes())
    scandir = os.scandir

    def guarded(path: str) -> Iterator[os.DirEntry[str]]:
        if str(path).endswith("closed"):
            raise PermissionError(13, "Permission denied")
        return scandir(path)

    monkeypatch.setattr(os, "scandir", guarded)
    found = {(one.file, one.code): one.message for one in sc.validate(tmp_path).diagnostics}
    assert (str(tmp_path / "bad.ttl"), "SC-K03") in found
    closed = f"cannot read the folder {tmp_path / 'closed'}: Permission denied"
    assert found[str(tmp_path), "SC-S03"] == f"Not all in this folder is checked: {closed}."


def test_an_empty_text_is_not_the_current_folder() -> None:
    for paths, ontologies in (("", ()), ([BAD, ""], ()), (BAD, [""])):
        with pytest.raises(AuthorError, match=r"^an empty text is no path; the current folder is '\.'$"):
            sc.validate(paths, ontologies=ontologies)
    with pytest.raises(AuthorError, match="a path holds no null character"):
        sc.validate("\0")


def test_the_memory_is_used_or_not() -> None:
    with pytest.raises(ProgrammerError, match=r"^cache is True or False, not 'x'$"):
        sc.validate(BAD, cache="x")  # type: ignore[arg-type]  # that is what is tested


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
