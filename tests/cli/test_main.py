"""The command line as a whole: help with examples, exit codes, and never a traceback."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from selfconf.cli.main import COMMANDS, command
from tests.cli.command import run
from tests.lab import NAVIGATE


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_has_help_with_an_example(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    outcome = run(capsys, name, "--help")
    assert outcome.code == 0
    assert re.search(rf"^example:\n *selfconf {name}", outcome.out, re.MULTILINE)
    assert outcome.err == ""


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_is_a_module_that_keeps_the_same_form(name: str) -> None:
    module = command(name)
    assert name == module.NAME
    assert re.fullmatch(r"[a-z].*[^.]", module.HELP)
    assert callable(module.add_arguments)
    assert callable(module.run)
    assert module.run.__doc__


def test_the_help_names_every_command(capsys: pytest.CaptureFixture[str]) -> None:
    out = run(capsys, "--help").out
    assert all(re.search(rf"^ +{name}\s", out, re.MULTILINE) for name in COMMANDS)


@pytest.mark.parametrize(
    "arguments",
    [
        (),
        ("dance",),
        ("configure", "--no-such-option"),
        ("configure", "x.ttl", "--format", "pdf"),
        ("configure", "x.ttl", "--reasoning", "magic"),
        ("configure", "x.ttl", "--strategy", "luck"),
        ("run", "x.ttl", "--policy", "hope"),
        ("site",),
        ("site", "x"),
        ("query", "--format"),
        ("conf", "x.ttl"),
    ],
)
def test_misuse_is_exit_code_2(arguments: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> None:
    outcome = run(capsys, *arguments)
    assert (outcome.code, outcome.out) == (2, "")
    assert "Traceback" not in outcome.err


def test_a_missing_argument_is_one_sentence(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(capsys, "configure").is_one_sentence("TEMPLATE is missing", "--help")
    assert run(capsys, "query", "--ads", "x").is_one_sentence("SPARQL")


def test_the_version_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    outcome = run(capsys, "--version")
    assert outcome.code == 0
    assert outcome.out.startswith("selfconf ")


def test_debug_shows_where_the_error_comes_from(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "broken.ttl").write_text("no turtle")
    outcome = run(capsys, "configure", str(tmp_path / "broken.ttl"), "--ads", str(tmp_path), "--debug")
    assert outcome.code == 2
    assert "Traceback" in outcome.err


def test_the_template_may_stand_before_or_after_the_advertisements(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "navigate.ttl").write_text(NAVIGATE)
    (tmp_path / "ads").mkdir()
    template, ads = str(tmp_path / "navigate.ttl"), str(tmp_path / "ads")
    bound = ("--bind", "goal=x")
    for arguments in ((template, "--ads", ads, *bound), (*bound, "--ads", ads, template)):
        assert run(capsys, "configure", *arguments).code == 1


def test_ctrl_c_in_a_command_is_one_sentence(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("selfconf.cli.configure.read_task", interrupted)
    outcome = run(capsys, "configure", str(tmp_path))
    assert (outcome.code, outcome.err) == (130, "selfconf configure: interrupted\n")
