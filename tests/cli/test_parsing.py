"""The words of a command line: what they stand for, and one sentence where they stand for nothing."""

from __future__ import annotations

import pytest

from selfconf.cli.main import parser
from tests.cli.command import run


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
        (["run", "t.ttl", "--priority", "1_0"], "'1_0' is no priority"),
        (["query", "ASK {}", "--rows", "9" * 5000], "is no number of rows"),  # more digits than Python reads
        (["query", "ASK {}", "--rows", "9" * 30], "is no number of rows"),
        *(
            ([*command, option, text], f"{text!r} is no {what}")
            for text in ("1_0", "\N{ARABIC-INDIC DIGIT THREE}", " 3", "inf", "nan")
            for command, option, what in (
                (("query", "ASK {}"), "--rows", "number of rows"),
                (("query", "ASK {}"), "--seconds", "time"),
                (("configure", "t.ttl"), "--steps", "number of steps"),
                (("configure", "t.ttl"), "--seconds", "time"),
                (("run", "t.ttl"), "--settle", "time"),
                (("run", "t.ttl"), "--priority", "priority"),
                (("echo", "c", "p"), "--count", "number of signals"),
                (("log",), "--lines", "number of lines"),
                (("serve",), "--port", "port"),
                (("demo",), "--seed", "seed"),
                (("demo",), "--speed", "speed"),
                (("bridge", "ros2"), "--domain", "domain"),
                (("bridge", "wot", "x"), "--rate", "rate"),
                (("keys", "issue", "read.a"), "--days", "number of days"),
                (("top",), "--every", "time"),
            )
        ),
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
        (["stop", "a", "b"], "unrecognized arguments: b; see `selfconf stop --help`"),  # no option was given
    ],
)
def test_a_word_too_many_is_refused_where_a_command_takes_no_more(
    arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(capsys, *arguments).is_one_sentence(words)


@pytest.mark.parametrize("command", ["status", "tasks", "why x", "log", "access", "stop", "discover", "top"])
def test_what_is_said_of_a_living_ecology_is_for_people_or_json(command: str) -> None:
    words = command.split()
    assert parser(words[:1]).parse_args(words).format == ("table" if command in ("discover", "top") else "text")
    assert parser(words[:1]).parse_args([*words, "--format", "json"]).format == "json"
