"""One path is not taken for its letters, and a word that is no option is answered with those that are."""

from __future__ import annotations

from enum import Enum
from pathlib import Path

import pytest

from selfconf.api.arguments import listed_paths, option
from selfconf.errors import ProgrammerError


class Colour(Enum):
    """A choice."""

    RED = "red"
    BLUE = "blue"


def test_one_path_is_a_list_of_one() -> None:
    assert listed_paths("examples") == ["examples"]
    assert listed_paths(Path("examples")) == [Path("examples")]
    assert listed_paths(path for path in ("a", Path("b"))) == ["a", Path("b")]


def test_a_word_is_an_option_or_is_answered_with_the_options() -> None:
    assert option(Colour, "colour", "red") is Colour.RED
    with pytest.raises(ProgrammerError) as error:
        option(Colour, "colour", "green")
    assert str(error.value) == "there is no colour 'green'; choose one of 'red', 'blue'"
