"""Regular expressions without backtracking: they find what `re` finds."""

from __future__ import annotations

import re
import warnings

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from selfconf.rdf.shacl.automaton import Automaton, NotRegular

ATOMS = (
    "a",
    "b",
    r"\w",
    r"\s",
    r"\W",
    ".",
    "[ab]",
    "[^a]",
    "[À-ÿ]",
    r"\b",
    r"\B",
    "^",
    "$",
    r"\A",
    r"\Z",
    "(?i:B)",
)
ATOMS += ("(?s:.)", r"(?a:\w)", "ß", "(?m:^)", "(?m:$)", "\n")
REPEATS = ("*", "+", "?", "*?", "+?", "??", "{2}", "{1,3}", "{0,2}?", "{2,}")
EXPRESSIONS = st.recursive(
    st.sampled_from(ATOMS),
    lambda inner: st.one_of(
        st.tuples(inner, inner).map("".join),
        st.tuples(inner, inner).map("(?:{0[0]}|{0[1]})".format),
        st.tuples(inner, st.sampled_from(REPEATS)).map("({0[0]}){0[1]}".format),
    ),
    max_leaves=6,
)
FLAGS = st.sampled_from((0, int(re.IGNORECASE), int(re.MULTILINE), int(re.IGNORECASE | re.MULTILINE)))


@given(EXPRESSIONS, FLAGS, st.text("ab A_\n1é!ſK", max_size=8))
@example(r"\B", 0, "")
def test_it_finds_what_re_finds(expression: str, flags: int, text: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a repeated repeat may mean something else one day
        try:
            wanted = re.compile(expression, flags).search(text) is not None
            automaton = Automaton(expression, flags)
        except (re.error, NotRegular):
            return
    assert automaton.finds(text) == wanted


@given(EXPRESSIONS, FLAGS, st.lists(st.text("ab A_\n1é!]^-", min_size=1, max_size=2), min_size=1, max_size=4))
def test_it_finds_the_same_where_it_runs_over_what_keeps_its_state(
    expression: str, flags: int, parts: list[str]
) -> None:
    text = "".join(part * 4 for part in parts)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("selfconf.rdf.shacl.automaton.STRETCH", 1)
        test_it_finds_what_re_finds.hypothesis.inner_test(expression, flags, text)  # type: ignore[attr-defined]  # Hypothesis adds it


def test_there_are_few_sets_of_states_however_many_characters_there_are() -> None:
    automaton = Automaton(r"^(\w+\s?)*\b$", 0)
    assert not automaton.finds("".join(map(chr, range(0x4E00, 0x5E00))) + "!")
    assert len(automaton._sets) < 10


@pytest.mark.parametrize("expression", [r"(a)\1", "(?=a)", "(?!a)", "(?<=a)b", "(a{0,100}){0,100}"])
def test_what_is_not_regular_or_too_large_has_no_automaton(expression: str) -> None:
    with pytest.raises(NotRegular):
        Automaton(expression, 0)


def test_sets_of_states_are_forgotten_when_they_are_many(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("selfconf.rdf.shacl.automaton.MOST_SETS", 4)
    assert not Automaton("^(a|b)*a(a|b){6}$", 0).finds("ab" * 40 + "bbbbbbbb")
    assert Automaton("^(a|b)*a(a|b){6}$", 0).finds("ab" * 40 + "a")
