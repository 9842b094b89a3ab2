"""A history that goes wrong is played again by the command that its test prints."""

from __future__ import annotations

import re
from itertools import product
from pathlib import Path

import pytest

from tests.faults import test_histories
from tests.faults.ecologies import ECOLOGIES, PAPER
from tests.faults.replay import PROGRAM, command, main, options, played, recipe_of
from tests.faults.script import Recipe

LIFE = re.compile(r"\b[0-9a-f]{8}\b")
"""The lives of configurators, which are others each time."""
RECIPES = [Recipe(7, *more) for more in product(ECOLOGIES.values(), *2 * [(False, True)])]


@pytest.mark.parametrize("recipe", RECIPES, ids=command)
def test_a_command_names_all_that_a_history_is_made_of(recipe: Recipe) -> None:
    assert command(recipe).startswith(f"{PROGRAM} ")
    assert recipe_of(options().parse_args(command(recipe).removeprefix(PROGRAM).split())) == recipe
    assert [one for one in RECIPES if one.script == recipe.script] == [recipe]


def lines(text: str) -> set[str]:
    """The lines of an account, without the lives of configurators; pytest indents those of a message."""
    return {line.strip() for line in LIFE.sub("", text).splitlines()}


@pytest.mark.slow
def test_the_command_that_a_test_prints_as_it_fails_plays_its_history(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A component that is deaf to the end of its supervisor acts for nobody."""
    monkeypatch.setattr("selfconf.sdk.runtime.supervision.GRACE", 1e9)
    recipes = (Recipe(seed, busy=True, large=True) for seed in range(100))
    recipe = next(one for one in recipes if played(one.script, tmp_path / PAPER.name).broken)
    with pytest.raises(AssertionError) as failure:
        test_histories.play_well(recipe, tmp_path)
    printed, _, happened = str(failure.value).partition("\n")
    assert re.fullmatch(r"python -m tests\.faults\.replay \d+ --ecology paper --busy --large --shrink", printed)
    arguments = printed.removeprefix(PROGRAM).split()
    assert main(arguments[:-1]) == 1
    once = lines(capsys.readouterr().out)
    assert "nobody acts for nobody" in "".join(once)
    assert once <= lines(happened)  # pytest adds why that is so
    assert main(arguments) == 1
    assert "nobody acts for nobody" in capsys.readouterr().out


def test_a_history_in_which_nothing_is_wrong_says_so(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["7"]) == 0
    assert capsys.readouterr().out.endswith("\nnothing was wrong\n")
