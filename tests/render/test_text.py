"""Answers as text for people."""

from __future__ import annotations

from dataclasses import replace
from decimal import Decimal
from fractions import Fraction

import pytest

from selfconf.model.alternative import Alternative
from selfconf.model.configuration import Connection, ParameterSetting
from selfconf.model.holder import Holder
from selfconf.model.partition import NearMiss
from selfconf.model.refusal import Refusal, TooFewEligible, Undecided
from selfconf.model.term import Literal
from selfconf.render import (
    alternative_text,
    configuration_text,
    consequences_text,
    cost_text,
    disobedience_text,
    refusal_text,
    short,
    undecided_text,
)
from selfconf.render.text import MOST_LINES
from tests.render.answers import (
    CLOCK,
    CONFIGURATION,
    CONSEQUENCES,
    LAMP,
    MISS,
    NAMES,
    OPTIMUM,
    REASONS,
    REFUSAL,
    REPAIRS,
    SCREEN,
    SOURCE,
    TEMPLATE,
    term,
)


def test_a_configuration_says_who_plays_what_is_connected_bound_and_set() -> None:
    assert configuration_text(CONFIGURATION, NAMES).splitlines() == [
        "configured :tell",
        "  :source  :clock",
        "  :sink    :screen",
        "  :spare   (no component)",
        "connections",
        "  :clock time  ->  :screen text",
        "bindings",
        "  room = :kitchen",
        '  greeting = "say \\"hello\\""',
        "parameters",
        "  :screen size = 12",
    ]


def test_a_name_of_a_port_or_parameter_forges_no_line() -> None:
    forged = replace(
        CONFIGURATION,
        connections=(Connection(CLOCK, "time\n  :lamp time", SCREEN, "text\x1b[2J\u2028"),),
        settings=(ParameterSetting(SCREEN, "size\r\nbindings", Literal("12")),),
        bindings={"room\n": term("kitchen")},
    )
    assert configuration_text(forged, NAMES).splitlines()[4:] == [
        "connections",
        r"  :clock time\n  :lamp time  ->  :screen text\x1b[2J\u2028",
        "bindings",
        r"  room\n = :kitchen",
        "parameters",
        r'  :screen size\r\nbindings = "12"',
    ]


def test_headings_without_anything_below_them_are_left_out() -> None:
    plain = replace(CONFIGURATION, connections=(), settings=(), bindings={})
    assert len(configuration_text(plain, NAMES).splitlines()) == 1 + len(CONFIGURATION.assignments)
    assert configuration_text(replace(plain, assignments=()), NAMES) == "configured :tell"


def test_a_single_point_of_failure_stands_out() -> None:
    lines = consequences_text(CONSEQUENCES, NAMES).splitlines()
    assert lines == [
        "if it failed",
        "  :clock   ->  NONE, a single point of failure",
        "  :screen  ->  :lamp, :clock as :spare, and :clock would stop",
    ]


def test_what_is_not_proved_without_the_solvers_names_their_extra() -> None:
    unaided = replace(OPTIMUM, unaided=True)
    line = "  not proved: there may be something better, which the extra `solvers` would tell"
    assert line in cost_text(unaided, (), NAMES).splitlines()
    assert "solvers" not in cost_text(replace(unaided, proved=True), (), NAMES)


def test_a_cost_says_its_levels_its_bound_and_what_has_no_number() -> None:
    assert cost_text(OPTIMUM, {term("error")}, NAMES).splitlines() == [
        "cost, compared level by level",
        "  level 1  0.5  (bound 0.25)",
        "  level 2  24  (bound 24)",
        "  not proved: there may be something better",
        "  2 terms are unknown, and left out of the sums (sc:otherwise would say what to count)",
        "    no component of the ecology has a number for :error",
        "    :clock has no number for :power",
    ]


def test_a_cost_that_is_proved_has_no_bound() -> None:
    proved = replace(OPTIMUM, cost=OPTIMUM.cost[:1], bound=OPTIMUM.cost[:1], missing=(), proved=True)
    assert cost_text(proved, (), NAMES).splitlines() == ["cost", "  level 1  0.5", "  proved: nothing costs less"]


def test_costs_that_differ_by_little_are_told_apart() -> None:
    near = replace(
        OPTIMUM, cost=(Fraction("1234568.25"), Fraction(10**310)), bound=(Fraction("1234567.5"), Fraction(0))
    )
    assert cost_text(near, (), NAMES).splitlines()[1:3] == [
        "  level 1  1234568.25  (bound 1234567.5)",
        "  level 2  1.797693135e+308  (bound 0)",
    ]


def test_a_refusal_has_every_reason_near_miss_and_repair_with_its_place() -> None:
    lines = refusal_text(REFUSAL, NAMES).splitlines()
    assert lines[0] == "no configuration for :tell"
    assert lines[1 : 1 + len(REASONS)] == [
        f"  because {reason}" + (f"  [{reason.place}]" if reason.place else "") for reason in REASONS
    ]
    assert "near misses" in lines
    assert "  source: :lamp would fit, but it is no Clock  [lamp.ttl:4]" in lines
    mended = lines.index("what would mend it")
    assert [line.split("  [")[0].strip() for line in lines[mended + 1 : -2]] == [str(repair) for repair in REPAIRS]
    assert lines[-2:] == [
        "  with --reasoning subclass there is a configuration",
        "the site cellar did not answer in full",
    ]


def test_a_refusal_fits_on_a_screen_however_many_reasons_it_has() -> None:
    reasons = tuple(TooFewEligible(term(f"r{number}"), 1, 0) for number in range(100))
    misses = tuple(NearMiss(SOURCE, term(f"c{number}"), MISS.obstacle) for number in range(100))
    held = tuple((term(f"c{number}"), Holder("go~1")) for number in range(100))
    lines = refusal_text(Refusal(TEMPLATE, reasons, misses, held=held), NAMES).splitlines()
    assert f"  and {100 - MOST_LINES} more that are held" in lines
    assert f"  and {100 - MOST_LINES} more reasons" in lines
    assert f"  and {100 - MOST_LINES} more" in lines
    assert len(lines) < 4 * MOST_LINES


def test_what_is_left_out_of_a_refusal_is_counted() -> None:
    reasons = tuple(TooFewEligible(term(f"r{number}"), 1, 0) for number in range(MOST_LINES + 1))
    sites = tuple(f"s{number}" for number in range(MOST_LINES + 1))
    misses = tuple(NearMiss(SOURCE, term(f"c{number}"), MISS.obstacle) for number in range(MOST_LINES))
    text = refusal_text(Refusal(TEMPLATE, reasons, misses, missing_sites=sites), NAMES)
    assert "  and 1 more reason\n" in text
    assert text.endswith("and 1 other site did not either")
    assert text.count("more") == 1
    assert "what would mend it" not in text


def test_a_refusal_without_reasons_says_that_there_was_no_time() -> None:
    assert refusal_text(Refusal(TEMPLATE, ()), NAMES).splitlines() == [
        "no configuration for :tell",
        "  no time was left to find out why; allow more",
    ]


def test_what_is_not_decided_is_one_sentence() -> None:
    assert undecided_text(Undecided(1), TEMPLATE, NAMES) == ":tell is not decided within 1 step; allow more by steps"
    assert "install the extra `solvers`" in undecided_text(Undecided(9, unaided=True), TEMPLATE, NAMES)


def test_names_are_as_they_are_asked_for() -> None:
    assert "configured tell" in configuration_text(CONFIGURATION, short)
    assert CLOCK not in configuration_text(CONFIGURATION, short)
    assert LAMP not in refusal_text(REFUSAL, short)


@pytest.mark.parametrize(
    ("some_held", "said"), [(False, "no configuration has it"), (True, "no configuration of what is free has it")]
)
def test_what_cannot_be_is_told_with_regard_to_what_others_hold(some_held: bool, said: str) -> None:
    one = Alternative(CLOCK, Decimal(0), (), 0, False, "impossible")
    assert alternative_text(one, None, some_held) == f"no preference; {said}"


def test_a_refusal_says_that_the_search_for_relaxations_stopped() -> None:
    stopped = replace(REFUSAL, repairs_stopped=True)
    assert "the search for other repairs stopped before all was tried" in refusal_text(stopped, NAMES).splitlines()
    bare = Refusal(TEMPLATE, REASONS, repairs_stopped=True)
    assert refusal_text(bare, NAMES).splitlines()[-1] == "the search for repairs stopped before all was tried"


def test_a_component_that_does_not_obey_is_named_with_how_it_is_where_that_is_known() -> None:
    assert disobedience_text({LAMP: "", SCREEN: "it hangs"}, NAMES) == [
        "out of control: :lamp was turned off and has not obeyed",
        "out of control: :screen was turned off and has not obeyed: it hangs",
    ]


@pytest.mark.parametrize(
    ("proved", "said"),
    [
        (True, "with it all in all 2, 1 less, but with more of the optional roles"),
        (False, "with it all in all 2, 1 less"),
    ],
)
def test_what_would_cost_less_than_the_best_has_more_of_the_optional_roles(proved: bool, said: str) -> None:
    best, one = (
        Alternative(CLOCK, Decimal(0), (), 0, chosen, "possible", (Fraction(total),), 0, proved or not chosen)
        for chosen, total in ((True, 3), (False, 2))
    )
    assert alternative_text(one, best, False) == f"no preference; {said}"
