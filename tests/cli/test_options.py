"""Options that several commands share: what they take, how often, and what they say to anything else."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.cli import options, query, validate
from selfconf.cli.reports import RENDERERS
from selfconf.composition import Strategy
from selfconf.model.hierarchy import Reasoning
from selfconf.query import ANSWER_SECONDS, MOST_ROWS, RESULT_FORMATS
from tests.cli.command import Outcome, run
from tests.lab import ADVERTISEMENTS, NAVIGATE, write_advertisements

BOUND = ("--bind", "robot=:Astrid", "--bind", "goal=(AT BEDROOM)")


def configure(capsys: pytest.CaptureFixture[str], *arguments: object) -> Outcome:
    """Run `configure`."""
    return run(capsys, "configure", *map(str, arguments))


@pytest.fixture
def template(tmp_path: Path) -> Path:
    """The paper's template, and each half of its advertisements in a folder beside it."""
    names = list(ADVERTISEMENTS)
    write_advertisements(tmp_path / "a", *names[:3])
    write_advertisements(tmp_path / "b", *names[3:])
    (tmp_path / "navigate.ttl").write_text(NAVIGATE)
    return tmp_path / "navigate.ttl"


# Choices are written down twice, so that arguments are parsed before the library is loaded.


def test_the_choices_are_those_of_the_library() -> None:
    assert set(options.STRATEGIES) == {strategy.value for strategy in Strategy}
    assert set(options.REASONING) == {mode.value for mode in Reasoning}
    assert query.ANSWER_FORMATS == RESULT_FORMATS
    assert (query.SECONDS, query.ROWS) == (ANSWER_SECONDS, MOST_ROWS)
    assert tuple(RENDERERS) == validate.REPORT_FORMATS


def test_the_first_choice_is_the_default_of_the_library() -> None:
    assert options.STRATEGIES[0] == Strategy.FIRST.value
    assert options.REASONING[0] == Reasoning.SYNTACTIC.value


@pytest.mark.parametrize("option", ["--strategy", "--reasoning", "--format"])
def test_a_choice_that_there_is_not_is_one_sentence_with_those_that_there_are(
    option: str, template: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert configure(capsys, template, option, "worst").is_one_sentence(f"{option}: invalid choice: 'worst'")


# An ecology that is not there.


@pytest.mark.parametrize("command", ["configure", "partition", "run"])
def test_where_no_site_is_there_at_all_the_option_for_files_is_named(
    command: str, template: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(tmp_path / "runtime"))
    refused = run(capsys, command, str(template), *BOUND)
    assert refused.is_one_sentence("no site runs on this machine", "--connect ENDPOINT, or --ads PATH")
    refused = run(capsys, command, str(template), *BOUND, "--ecology", "other")
    assert "no site of the ecology 'other' runs" in refused.err
    assert "--ads" not in refused.err


# Options that may be given again.


@pytest.mark.parametrize("first", [False, True])
def test_folders_of_advertisements_are_given_one_by_one_before_or_after_the_template(
    first: bool, template: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    given = ("--ads", template.parent / "a", "--ads", template.parent / "b")
    words = (*given, template) if first else (template, *given)
    assert configure(capsys, *words, *BOUND).code == 0
    half = words[2:] if first else words[:3]
    assert configure(capsys, *half, *BOUND).code == 1


@pytest.mark.parametrize("option", ["--ads", "--ontology"])
@pytest.mark.parametrize("command", ["configure", "partition", "run"])
def test_an_option_with_a_path_takes_one_and_the_next_word_is_the_template(
    command: str, option: str, template: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    a, b = str(template.parent / "a"), str(template.parent / "b")
    outcome = run(capsys, command, option, a, b, str(template))
    assert outcome.is_one_sentence(f"unrecognized arguments: {template}")


def test_an_option_takes_one_ontology_and_the_next_word_is_a_file_to_validate(
    template: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    a, b = str(template.parent / "a"), str(template.parent / "b")
    outcome = run(capsys, "validate", "--ontology", a, b, "--format", "json")
    assert (outcome.code, outcome.body["files"]) == (0, len(ADVERTISEMENTS) - 3)


@pytest.mark.parametrize("option", ["--ads", "--ontology", "--bind", "--template", "--steps", "--seconds"])
def test_an_option_without_its_value_is_one_sentence(
    option: str, template: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert configure(capsys, template, option).is_one_sentence(f"{option}: expected one argument")


# Limits.


@pytest.mark.parametrize(
    "wrong",
    [
        ("--steps", "0"),
        ("--steps", "few"),
        ("--steps", "1.5"),
        ("--steps", "-1"),
        ("--steps", ""),
        ("--seconds", "-1"),
        ("--seconds", "0"),
        ("--seconds", "nan"),
        ("--seconds", "inf"),
        ("--seconds", "1e7"),
        ("--seconds", "soon"),
    ],
)
def test_a_budget_that_is_none_is_misuse(
    capsys: pytest.CaptureFixture[str], template: Path, wrong: tuple[str, str]
) -> None:
    option, value = wrong
    outcome = configure(capsys, template, "--ads", template.parent / "a", f"{option}={value}")
    assert outcome.is_one_sentence(option, repr(value), "above zero")


# What cannot be together.


def test_standard_input_is_one_thing(capsys: pytest.CaptureFixture[str]) -> None:
    for words in (("-", "--ads", "-"), ("-", "--ontology", "-"), ("x.ttl", "--ads", "-", "--ontology", "-")):
        assert configure(capsys, *words).is_one_sentence("- is standard input")


@pytest.mark.parametrize("command", ["configure", "partition"])
def test_two_ecologies_are_one_too_many(command: str, template: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given = ("--ads", str(template.parent / "a"), "--endpoint", "http://127.0.0.1:9/query")
    assert run(capsys, command, str(template), *BOUND, *given).is_one_sentence("give one of them")


@pytest.mark.parametrize("living", [("--ecology", "home"), ("--connect", "tcp/127.0.0.1:9"), ("--keys", "keys")])
@pytest.mark.parametrize("given", [("--ads", "."), ("--endpoint", "http://127.0.0.1:9/query")])
def test_a_living_ecology_is_not_passed_over_for_another(
    given: tuple[str, str], living: tuple[str, str], template: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for command in ("configure", "partition"):
        outcome = run(capsys, command, str(template), *BOUND, *given, *living)
        assert outcome.is_one_sentence(given[0], living[0], "give one of them")
    assert run(capsys, "query", "SELECT * {}", *given, *living).is_one_sentence(given[0], living[0])


def test_a_folder_without_advertisements_is_named(template: Path, capsys: pytest.CaptureFixture[str]) -> None:
    empty = template.parent / "empty"
    empty.mkdir()
    outcome = configure(capsys, template, *BOUND, "--ads", empty)
    assert (outcome.code, outcome.err) == (1, f"there is no advertisement in {empty}\n")


def test_a_folder_of_which_all_is_left_out_is_not_said_to_have_no_advertisement(
    template: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bare = template.parent / "bare.ttl"
    bare.write_text("<urn:lamp> a <https://w3id.org/selfconf#Component> .")
    outcome = configure(capsys, template, *BOUND, "--ads", bare)
    assert outcome.code == 1
    assert [line.partition(":1: ")[2].partition(":")[0] for line in outcome.err.splitlines()] == ["left out urn"]


def test_the_strategy_best_without_a_cost_says_what_it_does(template: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given = ("--ads", template.parent / "a", "--ads", template.parent / "b")
    outcome = configure(capsys, template, *given, *BOUND, "--strategy", "best")
    assert outcome.code == 0
    assert "states no sc:cost" in outcome.err
