"""The rules of the house that a machine can keep; what does not keep to one yet is excused in `tests/house`."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path

import pytest

from tests.house import survey

pytest.importorskip("radon", reason="radon, which counts branches, is not installed")


@cache
def found_by(rule: str) -> dict[str, str]:
    """What does not keep to a rule."""
    return survey.RULES[rule]()


@pytest.mark.parametrize("rule", survey.RULES)
def test_the_code_keeps_to_the_rule_or_is_excused(rule: str) -> None:
    found, excused = found_by(rule), survey.excuses(rule)
    broken = [f"{subject}: {why}" for subject, why in found.items() if subject not in excused]
    sought = (survey.RULES[rule].__doc__ or "").partition("\n")[0]
    assert not broken, "\n".join((f"{sought} CONTRIBUTING.md has the rule.", *broken))


@pytest.mark.parametrize("rule", survey.RULES)
def test_nothing_is_excused_that_keeps_to_the_rule(rule: str) -> None:
    unneeded = survey.excuses(rule).keys() - found_by(rule).keys()
    assert not unneeded, "type `python -m tests.house.survey`, which deletes these lines"


@pytest.mark.parametrize("rule", survey.RULES)
def test_every_excuse_has_a_reason_and_they_are_sorted(rule: str) -> None:
    excused = survey.excuses(rule)
    assert list(excused) == sorted(excused)
    assert all(excused.values())


def test_a_function_with_many_branches_needs_a_comment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    branches = "".join(f"    if x == {number}:\n        return {number}\n" for number in range(16))
    function = f"@cache\ndef {{}}(x: int) -> int:\n{branches}    return x\n"
    (tmp_path / "selfconf").mkdir()
    why = "# complexity: a table would hide the order\n"
    (tmp_path / "selfconf" / "a.py").write_text(function.format("bare") + why + function.format("explained"))
    monkeypatch.setattr(survey, "ROOT", tmp_path)
    assert survey.complex_functions() == {"selfconf/a.py::bare": "17"}


def test_a_component_is_not_spoken_of_as_a_person(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "selfconf").mkdir()
    (tmp_path / "selfconf" / "a.py").write_text(
        '"""No component, and a person.\n\nWhoever is told\nso."""\nx = 1  # nobody\n'
    )
    (tmp_path / "selfconf" / "b.js").write_text("// The task that holds it.\n")
    monkeypatch.setattr(survey, "ROOT", tmp_path)
    assert survey.persons_for_parts() == {
        "selfconf/a.py::whoever": "line 3",
        "selfconf/a.py::is told": "line 3",
        "selfconf/a.py::nobody": "line 5",
    }


def test_an_option_is_named_by_the_command_line_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "selfconf" / "cli").mkdir(parents=True)
    (tmp_path / "selfconf" / "cli" / "a.py").write_text("words = 'give --seconds'\n")
    lines = [
        '"""Has --debug."""',
        'x = f"{1}; give it\\nwith --seconds"',
        'y = ["--keys"]',
        'z = "`selfconf run --detach`"',
    ]
    (tmp_path / "selfconf" / "b.py").write_text("\n".join(lines) + "\n")
    monkeypatch.setattr(survey, "ROOT", tmp_path)
    assert survey.options_in_messages() == {"selfconf/b.py::--seconds": "line 2"}


def test_classes_functions_and_constants_are_names_and_imports_are_not() -> None:
    text = "from x import y\nA = 1\nB: int = 2\nclass C: ...\ndef d(): ...\n_e = 3\nif A:\n    f = 1\n"
    assert list(survey.public_names(ast.parse(text))) == ["A", "B", "C", "d"]
