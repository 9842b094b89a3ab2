"""The command line as a whole: a command loads what it needs, and help tells of all."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from selfconf.cli.main import COMMANDS, command, main, parser
from tests.cli.command import run

ROOT = Path(__file__).resolve().parents[2]
ACTIONS = ("keys init", "keys issue", "keys renew", "keys show", "keys revoke", "bridge wot", "bridge ros2")
LOADED = """
import sys
from selfconf.cli.main import main
code = main(sys.argv[1:])
print(*sorted(sys.modules), file=sys.stderr)
sys.exit(code)
"""


def test_validating_what_is_right_loads_neither_the_network_nor_a_reasoner(tmp_path: Path) -> None:
    (tmp_path / "a.ttl").write_text("<urn:a> a <https://w3id.org/selfconf#Component> , <urn:Kind> .")
    command = [sys.executable, "-c", LOADED, "validate", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    loaded = set(done.stderr.split())
    assert "selfconf.cli.validate" in loaded
    assert loaded.isdisjoint(("zenoh", "rdflib", "pyshacl", "owlrl", "selfconf.cli.run", "selfconf.cli.configure"))


def test_help_lists_every_command(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["--help"])
    assert ended.value.code == 0
    said = capsys.readouterr().out
    assert all(f"\n    {name}" in said for name in COMMANDS)


@pytest.mark.parametrize("name", [*COMMANDS, *ACTIONS])
def test_every_command_has_help_with_an_example(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main([*name.split(), "--help"])
    assert ended.value.code == 0
    assert "example:\n" in capsys.readouterr().out


@pytest.mark.parametrize("name", COMMANDS)
def test_the_files_of_an_example_are_there(name: str) -> None:
    lines = command(name).EXAMPLE.splitlines()
    assert all(line.startswith("  ") for line in lines)
    if name != "new":
        words = [
            word for line in lines for word in line.split() if word.endswith(".ttl") or word.startswith("examples")
        ]
        assert [word for word in words if not (ROOT / word).exists()] == []


def test_a_command_that_there_is_not_is_misuse(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["validat"])
    assert ended.value.code == 2
    assert "validate" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["validat"], "'validate'"),
        ([], "COMMAND"),
        (["validate", "--formt"], "see `selfconf validate --help`"),
        (["--debug", "validate", "t.ttl"], "the first word is the command, and options stand after it"),
        (["--ads", "t.ttl", "validate"], "the first word is the command, and options stand after it"),
        (["configure", "t.ttl", "--strategy", "worst"], "'worst'"),
        (["run", "t.ttl", "--priority", "9" * 23], "a whole number from -1000000 to 1000000"),
        (["run", "t.ttl", "--priority", "high"], "'high' is no priority"),
        (["configure", ""], "TEMPLATE: an empty text is no path; the current folder is '.'"),
        (["configure", "t.ttl", "--ads", ""], "--ads: an empty text is no path"),
    ],
)
def test_misuse_is_one_sentence_that_points_to_the_help(
    arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(capsys, *arguments).is_one_sentence(words, "--help`")


@pytest.mark.parametrize(
    ("arguments", "dest", "values"),
    [
        (["import", "wot", "--out", "o", "a", "b"], "sources", ["a", "b"]),
        (["import", "wot", "a", "--out", "o", "b"], "sources", ["a", "b"]),
        (["import", "--out", "o", "wot", "a"], "sources", ["a"]),
        (["import", "ros2", "--out", "o"], "sources", []),
        (["validate", "a", "--ontology", "o", "b", "--cache", "-"], "paths", ["a", "b", "-"]),
        (["site", "restart", "--ecology", "home", "tracker"], "paths", ["restart", "tracker"]),
        (["bridge", "wot", "a", "--rate", "2", "b"], "sources", ["a", "b"]),
        (["bridge", "wot", "--rate", "2", "a", "b"], "sources", ["a", "b"]),
    ],
)
def test_of_what_a_command_takes_several_some_may_stand_after_its_options(
    arguments: list[str], dest: str, values: list[str]
) -> None:
    assert getattr(parser(arguments[:1]).parse_args(arguments), dest) == values


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["validate", "a", "--cache", "b", "--formt", "json"], "unrecognized arguments: b --formt json;"),
        (["bridge", "wot", "--rate", "2"], "required: SOURCE"),
        (["configure", "--ads", "A", "B", "--ontology", "O", "T"], "repeat it for each: --ads A --ads B"),
    ],
)
def test_a_word_too_many_is_refused_where_a_command_takes_no_more(
    arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(capsys, *arguments).is_one_sentence(words)
