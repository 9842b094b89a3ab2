"""Files are validated as the command does it; the report prints a line for each problem."""

from __future__ import annotations

from pathlib import Path

import pytest

import selfconf as sc
from selfconf.errors import AuthorError
from selfconf.model.diagnostic import Diagnostic, Report, Severity

BAD = Path("tests/bad/bound-twice.ttl")


def test_one_path_or_several_as_text_or_as_path_are_validated() -> None:
    for paths in (BAD, str(BAD), [BAD], (str(BAD),), iter([BAD])):
        report = sc.validate(paths)
        assert isinstance(report, Report)
        assert report.files == (str(BAD),)
        assert (report.errors, report.warnings, report.conforms) == (1, 1, False)


def test_each_diagnostic_has_its_place_code_and_message() -> None:
    (error,) = (one for one in sc.validate(BAD).diagnostics if one.severity is Severity.ERROR)
    assert isinstance(error, Diagnostic)
    assert (error.file, error.line, error.column, error.code) == (str(BAD), 7, 24, "SC-K03")
    assert error.message == "A task binds each parameter at most once."


def test_a_report_prints_its_counts_and_a_line_for_each_problem() -> None:
    report = sc.validate(BAD)
    said = repr(report).splitlines()
    assert said[0] == "<1 error and 1 warning in 1 file>"
    assert said[-1].split()[:4] == [str(BAD), "7", "error", "SC-K03"]
    assert "<td style='text-align:left'>SC-K03</td>" in report._repr_html_()
    good = sc.validate("examples/clock")
    assert repr(good) == "<0 errors and 0 warnings in 3 files>"
    assert good._repr_html_() == "<pre>&lt;0 errors and 0 warnings in 3 files&gt;</pre>"


def test_what_cannot_be_read_is_a_diagnostic_and_an_ontology_that_cannot_be_is_an_error() -> None:
    (found,) = sc.validate("no-such-file.ttl").diagnostics
    assert found.code == "SC-S03"
    with pytest.raises(AuthorError, match="ontology cannot be read"):
        sc.validate(BAD, ontologies="no-such-ontology.ttl")
