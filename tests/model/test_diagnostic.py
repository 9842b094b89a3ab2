"""Diagnostics and reports as values."""

from __future__ import annotations

from selfconf.model.diagnostic import Diagnostic, Severity, report


def test_severities_are_words() -> None:
    assert [severity.value for severity in Severity] == ["error", "warning"]


def test_a_report_has_each_problem_once_in_the_order_of_files_and_places() -> None:
    late, early = Diagnostic("b.ttl", 1, 1, "SC-A01", "x"), Diagnostic("a.ttl", 2, 9, "SC-A02", "y")
    first = Diagnostic("a.ttl", 2, 3, "SC-L02", "z", Severity.WARNING)
    found = report(["a.ttl", "b.ttl"], [late, early, first, late])
    assert found.diagnostics == (first, early, late)
    assert (found.errors, found.warnings, found.conforms) == (2, 1, False)
    assert found.unreadable == frozenset()


def test_warnings_alone_conform() -> None:
    assert report(["a.ttl"], [Diagnostic("a.ttl", 1, 1, "SC-L02", "z", Severity.WARNING)]).conforms
    assert report([], []).conforms


def test_a_file_that_cannot_be_read_is_named() -> None:
    found = report(
        ["a.ttl", "b.ttl"], [Diagnostic("a.ttl", 1, 1, "SC-S01", "x"), Diagnostic("b.ttl", 1, 1, "SC-A01", "x")]
    )
    assert found.unreadable == {"a.ttl"}


def test_the_text_of_the_line_makes_it_no_other_problem() -> None:
    plain = Diagnostic("a.ttl", 1, 1, "SC-A01", "x")
    assert report([], [plain, Diagnostic("a.ttl", 1, 1, "SC-A01", "x", source="text")]).diagnostics == (plain,)


def test_a_diagnostic_prints_as_compilers_do() -> None:
    one = Diagnostic("a.ttl", 12, 3, "SC-A01", "No\nmore.", hint="Try.")
    assert str(one) == "a.ttl:12:3: error[SC-A01]: No more. Try."
    assert (one.where, one.kind, one.words) == ("a.ttl:12:3", "error[SC-A01]", "No more. Try.")
