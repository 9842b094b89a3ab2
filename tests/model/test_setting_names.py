"""Messages name keywords to a program, and options to a user of a command."""

from __future__ import annotations

import pytest

from selfconf.model.refusal import Undecided
from selfconf.model.setting_names import binding, in_command, options_named, setting


@pytest.mark.parametrize(
    ("option", "value", "keyword", "typed"),
    [
        ("seconds", "", "seconds", "--seconds"),
        ("reasoning", "subclass", "reasoning='subclass'", "--reasoning subclass"),
        ("ontology", "", "ontologies", "--ontology"),
        ("template", "", "name", "--template"),
    ],
)
def test_a_setting_is_a_keyword_or_an_option(option: str, value: str, keyword: str, typed: str) -> None:
    assert setting(option, value) == keyword
    with options_named():
        assert setting(option, value) == typed


def test_a_parameter_is_bound_by_a_call_or_by_an_option_in_the_quotes_of_a_shell() -> None:
    assert (binding("goal"), binding("goal", '"AT x"')) == ("bind(goal=...)", "bind(goal='\"AT x\"')")
    with options_named():
        assert (binding("goal"), binding("goal", '"AT x"')) == ("--bind goal=...", "--bind goal='\"AT x\"'")


def test_names_are_as_before_when_a_command_has_ended_even_by_an_error() -> None:
    @options_named()
    def command() -> None:
        assert in_command()
        with options_named(False):
            assert not in_command()
        assert in_command()
        raise ValueError

    for _ in range(2):
        with pytest.raises(ValueError, match=r"^$"):
            command()
        assert not in_command()


def test_a_value_is_worded_for_the_reader_of_its_text() -> None:
    undecided = Undecided(7)
    assert str(undecided) == "not decided within 7 steps; allow more by steps"
    with options_named():
        assert str(undecided) == "not decided within 7 steps; allow more by --steps"
