"""The project file: where it is found, what it may say, and where it says what is wrong."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from selfconf.composition import Strategy
from selfconf.errors import AuthorError
from selfconf.model.codes import CODES, Code
from selfconf.model.hierarchy import Reasoning
from selfconf.project import PROJECT_FILE, REASONING, STRATEGIES, project_path, project_problems, read_project

WHOLE = """\
# A robot of ours.
ecology = "home"
connect = ["tcp/10.0.0.2:7447"]
ads = [
    "ads",       # with a comment
    "more.ttl",
]
ontology = "ontology"
reasoning = "subclass"
strategy = "best"
steps = 1000
seconds = 2.5

[bind.navigate]
robot = ":Astrid"
speed = 0.5
"""


def problems(text: str, folder: Path) -> list[tuple[int, int, str, str]]:
    found = project_problems(PROJECT_FILE, text.encode(), folder)
    return [(one.line, one.column, one.code, one.message) for one in found]


def test_the_choices_are_those_of_the_library() -> None:
    assert set(STRATEGIES) == {strategy.value for strategy in Strategy}
    assert set(REASONING) == {mode.value for mode in Reasoning}


def test_every_key_has_its_value_with_paths_as_seen_from_the_current_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / PROJECT_FILE).write_text(WHOLE)
    (tmp_path / "sub").mkdir()
    monkeypatch.chdir(tmp_path / "sub")
    project = read_project(tmp_path / PROJECT_FILE)
    assert project.values == {
        "ecology": "home",
        "connect": ["tcp/10.0.0.2:7447"],
        "ads": [Path("../ads"), Path("../more.ttl")],
        "ontology": [Path("../ontology")],
        "reasoning": "subclass",
        "strategy": "best",
        "steps": 1000,
        "seconds": 2.5,
    }
    assert project.bindings("https://example.org/x#navigate", "navigate") == (
        "navigate",
        {"robot": ":Astrid", "speed": 0.5},
    )
    assert project.bindings("other") == ("", {})
    assert [project.place("ads"), project.place("bind", "navigate", "speed")] == [
        "../selfconf.toml:4",
        "../selfconf.toml:16",
    ]


def test_a_key_may_be_called_as_the_library_calls_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    path = tmp_path / PROJECT_FILE
    path.write_text('ecology = "home"\nontologies = ["a.ttl"]\nendpoints = "tcp/10.0.0.2:7447"\n')
    project = read_project(path)
    assert project.values == {"ecology": "home", "ontology": [Path("a.ttl")], "connect": ["tcp/10.0.0.2:7447"]}
    assert project.place("ontology") == f"{PROJECT_FILE}:2"
    ((line, _, code, said),) = problems('ontology = "."\nontologies = "."\n', tmp_path)
    assert (line, code) == (2, "SC-P02")
    assert said == "The key 'ontologies' is another word for 'ontology'; give one of them."
    ((line, _, code, said),) = problems("endpoints = []\n", tmp_path)
    assert (line, code) == (1, "SC-P03")
    assert said == "The key 'endpoints' takes a text in quotes, or a list of them."


def test_a_byte_that_is_no_utf_8_is_named_where_it_stands(tmp_path: Path) -> None:
    octets = '\ufeffsteps = 1\necology = "café"\n'.encode().replace("é".encode(), b"\xe9")
    (problem,) = project_problems("p", octets, tmp_path)
    assert (problem.line, problem.column, problem.code) == (2, 15, "SC-P01")
    assert problem.message == "Not TOML: this is not UTF-8: the byte 0xE9 cannot stand here."


def test_the_nearest_file_upward_counts(tmp_path: Path) -> None:
    below = tmp_path / "a" / "b"
    below.mkdir(parents=True)
    (tmp_path / PROJECT_FILE).touch()
    assert project_path(below) == tmp_path / PROJECT_FILE
    (tmp_path / "a" / PROJECT_FILE).touch()
    assert project_path(below) == tmp_path / "a" / PROJECT_FILE
    (below / PROJECT_FILE).mkdir()  # a folder of that name is none
    assert project_path(below) == tmp_path / "a" / PROJECT_FILE


def test_a_stranger_s_file_in_a_folder_of_another_owner_is_passed_over_and_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / PROJECT_FILE).touch()
    own = Path.stat(tmp_path / PROJECT_FILE)
    strange = os.stat_result((*own[:4], own.st_uid + 1, *own[5:10]))
    real = Path.stat

    def stat(path: Path, **given: bool) -> os.stat_result:
        return strange if path.name == PROJECT_FILE else real(path, **given)

    # No test that is not root can give a file away, so what the system says of its owner is changed.
    monkeypatch.setattr(Path, "stat", stat)
    said: list[str] = []
    assert project_path(tmp_path, said.append) is None
    assert said[0].endswith("belongs to neither you nor the owner of its folder")


@pytest.mark.parametrize(
    ("text", "place", "words"),
    [
        ("ecology = home", "1:11 SC-P01", "Not TOML: Invalid value. Text stands in quotes."),
        ("\necology = [", "2:12 SC-P01", "Not TOML"),
        ("x = " + "[" * 100_000, "1:1 SC-P01", ""),
        ('ecology = "home"\nfoo = 3', "2:1 SC-P02", "no key 'foo'; the keys are ecology"),
        ("# one\u2028line\n  foo = 3", "2:3 SC-P02", "no key 'foo'"),
        ("[budget]\nsteps = 3", "1:1 SC-P02", "no key 'budget'"),
        ('ecology = "two words"', "1:1 SC-P03", "'ecology' takes a name"),
        ("ecology = 3", "1:1 SC-P03", "takes a text in quotes"),
        ('connect = "bogus"', "1:1 SC-P03", "takes an endpoint like 'tcp/127.0.0.1:7447', not 'bogus'"),
        ('connect = ["tcp/10.0.0.2:7447", "tcp/home"]', "1:1 SC-P03", "not 'tcp/home'"),
        ("connect = []", "1:1 SC-P03", "or a list of them"),
        ('endpoint = "bogus"', "1:1 SC-P03", "takes an http or https URL, not 'bogus'"),
        ('endpoint = "http://"', "1:1 SC-P03", "takes an http or https URL"),
        ('endpoint = "http://[::1/x"', "1:1 SC-P03", "takes an http or https URL"),
        ("ads = []", "1:1 SC-P03", "or a list of them"),
        ("ads = [3]", "1:1 SC-P03", "or a list of them"),
        ('\n\n  reasoning = "much"', "3:3 SC-P03", "'syntactic', 'subclass', 'owl-rl'"),
        ("steps = true", "1:1 SC-P03", "a whole number above zero"),
        ("seconds = nan", "1:1 SC-P03", "takes a number of seconds above zero and at most 1,000,000"),
        ("seconds = 2e6", "1:1 SC-P03", "above zero and at most 1,000,000"),
        ("seconds = true", "1:1 SC-P03", "a number of seconds"),
        ("bind = 3", "1:1 SC-P03", "a table for each template"),
        ('[bind]\ngoal = "x"', "2:1 SC-P03", "[bind.TEMPLATE] is one"),
        ("bind.navigate = 3", "1:1 SC-P03", "'navigate' of bind is no table"),
        ("[bind.a]\nx = 1\ny = [1]", "3:1 SC-P03", "the parameter 'y'"),
        ('ads = "."\nendpoint = "https://example.org"', "2:1 SC-P04", "two ecologies"),
        ('ads = [\n  ".",\n  "gone"]', "1:1 SC-P05", "no file or folder gone"),
        (f'ads = "{300 * "a"}"', "1:1 SC-P05", "aaa cannot be read: File name too long."),
    ],
)
def test_what_is_wrong_is_found_with_its_place(text: str, place: str, words: str, tmp_path: Path) -> None:
    [(line, column, code, message)] = problems(text, tmp_path)
    assert f"{line}:{column} {code}" == place
    assert words.lower() in message.lower()


def test_all_problems_are_reported_in_the_order_of_the_lines_and_a_reader_hears_of_the_first(tmp_path: Path) -> None:
    text = 'steps = "a"\nfoo = 1\nsteps2 = 1\n'
    assert [one[0] for one in problems(text, tmp_path)] == [1, 2, 3]
    (tmp_path / PROJECT_FILE).write_text(text)
    with pytest.raises(AuthorError, match=r"selfconf\.toml:1:1: The key 'steps' takes"):
        read_project(tmp_path / PROJECT_FILE)


def test_what_is_no_text_or_too_long_is_one_problem(tmp_path: Path) -> None:
    assert [one.code for one in project_problems(PROJECT_FILE, b"\xff", tmp_path)] == ["SC-P01"]
    assert [one.code for one in project_problems(PROJECT_FILE, b"#" * (1 << 19), tmp_path)] == ["SC-P01"]


def test_a_key_in_a_string_of_several_lines_is_no_key(tmp_path: Path) -> None:
    (tmp_path / PROJECT_FILE).write_text('[bind.a]\nx = """\nads = 3\n"""\ny = 1\n')
    project = read_project(tmp_path / PROJECT_FILE)
    assert project.place("bind", "a", "y").endswith(":5")
    assert ("ads",) not in project.lines


@pytest.mark.parametrize("code", [code for code in CODES if code.language == "toml"], ids=lambda code: code.code)
def test_the_bad_example_of_a_code_earns_it_and_the_good_one_nothing(code: Code, tmp_path: Path) -> None:
    assert {one[2] for one in problems(code.bad, tmp_path)} == {code.code}
    assert problems(code.good, tmp_path) == []
