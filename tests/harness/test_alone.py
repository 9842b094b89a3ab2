"""Which tests are run again alone: those that a report names as failed, and nothing where it names none."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.harness import alone

REPORT = """<testsuites><testsuite>
<testcase classname="tests.bus.test_loop" name="test_a[x y]"><failure message="no"/></testcase>
<testcase classname="tests.bus.test_loop" name="test_b"/>
<testcase classname="tests.test_house" name="test_c"><error message="no"/></testcase>
</testsuite></testsuites>"""


def test_failures_and_errors_are_named_as_pytest_takes_them(tmp_path: Path) -> None:
    (tmp_path / "report.xml").write_text(REPORT)
    assert alone.failed(tmp_path / "report.xml") == [
        "tests/bus/test_loop.py::test_a[x y]",
        "tests/test_house.py::test_c",
    ]


UNREAD = '<testsuite><testcase classname="" name="tests.bus.test_loop"><error message="no"/></testcase></testsuite>'


@pytest.mark.parametrize(
    "text", [None, "", "<testsuites/>", UNREAD], ids=["nothing", "no XML", "no failure", "a file that cannot be read"]
)
def test_where_no_failure_is_named_nothing_is_run_again_and_that_is_a_failure(
    text: str | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if text is not None:
        (tmp_path / "report.xml").write_text(text)
    monkeypatch.setattr("sys.argv", ["alone", str(tmp_path / "report.xml")])
    monkeypatch.setattr(alone.subprocess, "run", None)
    assert alone.main() == 1


def test_many_failures_stand(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    case = '<testcase classname="tests.test_x" name="test_{}"><failure/></testcase>'
    (tmp_path / "report.xml").write_text(f"<testsuite>{''.join(map(case.format, range(alone.FEW + 1)))}</testsuite>")
    monkeypatch.setattr("sys.argv", ["alone", str(tmp_path / "report.xml")])
    monkeypatch.setattr(alone.subprocess, "run", None)
    assert alone.main() == 1
