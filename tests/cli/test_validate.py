"""`selfconf validate`, as it is called: what it prints where, and with which exit code it ends."""

from __future__ import annotations

import io
import os
import pty
import re
import subprocess
import sys
from pathlib import Path

import pytest

from selfconf.cli.main import main
from selfconf.cli.reports import RENDERERS
from selfconf.model.codes import CODES
from selfconf.model.diagnostic import report
from tests.cli.command import run
from tests.cli.diagnosed import WRONG

BAD = Path(__file__).parents[1] / "bad"


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (["good.ttl"], 0),
        (["strange.ttl"], 0),
        (["wrong.ttl"], 1),
        (["good.ttl", "wrong.ttl"], 1),
        (["broken.ttl"], 2),
        (["broken.ttl", "wrong.ttl"], 2),
        (["nowhere.ttl"], 2),
        (["nowhere.ttl", "wrong.ttl"], 2),
        (["."], 2),
        ([], 2),
        (["--explain", "SC-A01"], 0),
        (["--explain", "SC-X99"], 2),
        (["--explain", "SC-A01", "--format", "json"], 2),
        (["good.ttl", "--ontology", "nowhere.ttl"], 2),
        (["good.ttl", "--ontology", "broken.ttl"], 2),
        (["good.ttl", "--ontology", "strange.ttl"], 0),
    ],
)
def test_exit_codes(folder: Path, arguments: list[str], code: int) -> None:
    assert main(["validate", *arguments]) == code


def test_every_problem_is_one_line_with_file_line_and_column(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(["validate", "good.ttl", "wrong.ttl", "strange.ttl", "broken.ttl", "nowhere.ttl"])
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 5
    for line in lines:
        assert re.fullmatch(r"\w+\.ttl:\d+:\d+: (error|warning)\[SC-[A-Z]\d\d\]: \S.*[.?]", line), line
    assert lines[2].startswith("strange.ttl:10:23: warning[SC-L02]: ")


def test_a_summary_goes_to_stderr_and_a_clean_run_prints_nothing_else(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main(["validate", "good.ttl"])
    assert capsys.readouterr() == ("", "1 file conforms.\n")


def test_a_file_that_cannot_be_read_is_named_on_stderr(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(["validate", "nowhere.ttl"])
    assert "nowhere.ttl" in capsys.readouterr().err


def test_a_loop_of_links_is_a_file_that_cannot_be_read(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "loop.ttl").symlink_to("loop.ttl")
    outcome = run(capsys, "validate", "loop.ttl")
    assert (outcome.code, outcome.err.splitlines()[-1].count("cannot read loop.ttl")) == (2, 1)
    assert outcome.out.startswith("loop.ttl:1:1: error[SC-S03]: This file cannot be read: Too many levels")


def test_in_a_folder_that_is_gone_files_are_validated_by_their_whole_paths(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "gone").mkdir()
    monkeypatch.chdir(folder / "gone")
    (folder / "gone").rmdir()
    assert run(capsys, "validate", str(folder / "good.ttl")).code == 0


def test_an_empty_folder_is_said_to_be_empty(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "empty").mkdir()
    assert main(["validate", "empty"]) == 0
    assert "no Turtle file" in capsys.readouterr().out


def test_a_file_with_nothing_to_validate_is_said_to_hold_nothing(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "kitchen.ttl").write_text("<urn:kitchen> <urn:is> <urn:warm> .")
    assert main(["validate", "kitchen.ttl"]) == 0
    assert "warning[SC-S04]" in capsys.readouterr().out


def test_standard_input_can_be_validated(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(WRONG.encode())))
    assert main(["validate", "-"]) == 1
    assert capsys.readouterr().out.startswith("<stdin>:10:1: error[SC-A03]: ")


def test_standard_input_that_is_closed_is_one_sentence(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "stdin", None)
    assert run(capsys, "validate", "-").is_one_sentence("standard input is closed")


@pytest.mark.parametrize("name", RENDERERS)
def test_every_form_can_say_that_all_is_well(name: str) -> None:
    assert RENDERERS[name](report(["a.ttl"], [])).endswith("\n" if name in ("json", "sarif", "junit") else "")


@pytest.mark.parametrize("code", [code.code for code in CODES])
def test_every_code_is_explained(code: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["validate", "--explain", code.lower()]) == 0
    assert capsys.readouterr().out.startswith(code)


def test_an_unknown_code_is_answered_with_the_known_ones(capsys: pytest.CaptureFixture[str]) -> None:
    main(["validate", "--explain", "SC-X99"])
    assert "SC-A01" in capsys.readouterr().err


def test_the_manual_lists_every_code() -> None:
    page = (BAD.parents[1] / "docs/codes.md").read_text("utf-8")
    assert all(f"## {code.code}: " in page for code in CODES)


def test_help_has_an_example(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["validate", "--help"])
    assert ended.value.code == 0
    assert "\n  selfconf validate examples/" in capsys.readouterr().out


def test_an_unknown_format_is_misuse(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["validate", "--format", "xml", "."])
    assert ended.value.code == 2


@pytest.mark.parametrize("form", RENDERERS)
def test_a_file_name_that_is_not_utf8_is_escaped(folder: Path, form: str) -> None:
    (folder / "latin").mkdir()
    (folder / "latin" / os.fsdecode(b"\xff.ttl")).write_text("bad")
    for locale in ("C", "C.UTF-8"):
        command = (sys.executable, "-m", "selfconf", "validate", "latin", "--format", form)
        done = subprocess.run(command, capture_output=True, env={**os.environ, "LC_ALL": locale}, check=False)
        assert (done.returncode, b"Traceback" in done.stderr) == (2, False)
        shown = {"sarif": "%FF.ttl", "junit": "\N{REPLACEMENT CHARACTER}.ttl"}.get(form, "\\udcff.ttl")
        assert shown in done.stdout.decode("utf-8")


def test_a_warning_about_an_empty_folder_counts_no_file(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "empty").mkdir()
    main(["validate", "empty"])
    assert capsys.readouterr().err == "1 warning; 0 files conform.\n"
    main(["validate", "empty", "good.ttl"])
    assert capsys.readouterr().err == "1 warning; 1 file conforms.\n"


def test_the_option_remembers(folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SELFCONF_CACHE_DIR", str(tmp_path / "cache"))
    codes = {main(["validate", str(folder), "--cache"]) for _ in range(2)}
    assert codes == {2}
    assert len(list((tmp_path / "cache" / "validate").iterdir())) == 1


def test_warnings_count_where_they_are_to_be_errors(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "empty").mkdir()
    assert main(["validate", "good.ttl", "--warnings-as-errors"]) == 0
    assert main(["validate", "empty"]) == 0
    assert main(["validate", "empty", "--warnings-as-errors"]) == 1
    assert "warning[SC-S04]" in capsys.readouterr().out


FORKING = """
import os, sys
from selfconf.api import file_checks
from selfconf.cli.main import main
forked = []
os.register_at_fork(before=lambda: forked.append(1))
file_checks.WORTH = 1
os.cpu_count = lambda: 4
main(["validate", *sys.argv[1:]])
print(len(forked))
"""
"""Validates files, and says how often it has forked."""


@pytest.mark.process
@pytest.mark.slow
@pytest.mark.parametrize("options", [[], ["--cache"]])
def test_files_are_shared_among_processes_on_a_terminal_too(
    options: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SELFCONF_CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.setenv("TERM", "xterm")
    files = [str(path) for path in sorted(BAD.glob("*.ttl"))[:8]]
    screen, terminal = pty.openpty()
    try:
        ended = subprocess.run(
            [sys.executable, "-c", FORKING, *options, *files],
            stdout=subprocess.PIPE,
            stderr=terminal,
            text=True,
            timeout=60,
            check=True,
        )
    finally:
        os.close(terminal)
        os.close(screen)
    assert int(ended.stdout.splitlines()[-1]) == 4
