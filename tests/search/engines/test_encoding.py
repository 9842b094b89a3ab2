"""A reduced problem as clauses and bounds: their models, found by trying all, are the solutions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product

import pytest

from benchmarks.search.families.puzzles import pigeonholes
from selfconf.search.engines.encoding import Encoding
from selfconf.search.engines.formula import AtMost, Implied
from selfconf.search.problem import Problem
from selfconf.search.reduction import Constraint, Distinct, Fed, Played, pruned, reduced
from tests.search.oracle import World
from tests.search.worlds import component, problem

EYES = [component(name, outputs="o:Image") for name in ("left", "right")]
MIND = component("mind", "i:Image")
BOTH = component("both", outputs="o:Image")
SEEING = problem({"eye": [*EYES, component("deaf")], "mind": [MIND]}, "eye>mind")
SHARED = problem({"eye": [BOTH, EYES[0]], "mind": [BOTH, MIND]}, "eye>mind")
TWINS = problem({"one": EYES, "other": EYES, "third": [*EYES, component("third")]})
HOURS = ("nine", "ten", "eleven", "noon", "one")
ALIKE = problem(
    {"eye": EYES, "mind": [MIND]},
    "eye>mind",
    values={"eye": {"left": 0b00011, "right": 0b11100}, "mind": {"mind": 0b11100}},
    domain=HOURS,
)
CROWDED = problem(
    {
        "sky": [component("day", outputs="o:Sun"), component("night", outputs="o:Stars")],
        "one": [component("here"), component("there", "i:Sun", "o:Image"), component("elsewhere", "i:Stars")],
        "two": [component("near"), component("far", "i:Stars")],
        "mind": [MIND, component("dream", "i:Stars")],
    },
    "sky>one sky>two sky>mind one>mind",
    values={"one": {"here": 0b01, "there": 0b01}, "two": {"near": 0b10}},
    domain=("first", "second"),
)
"""One place, which the first role may take in two ways, and the second in one."""
WIRES = problem(
    {
        "wires": [
            component(f"{one}{two}", outputs=f"o:{one} p:{two}") for one in ("No", "Yes") for two in ("Low", "High")
        ],
        "nothing": [component("nothing")],
        "gate": [
            component("denies", "i:No"),
            component("denies-low", "i:No j:Low"),
            component("affirms", "i:Yes"),
            component("affirms-high", "i:Yes j:High"),
        ],
    },
    "wires>gate nothing>gate",
)
PROBLEMS = {
    "a need": SEEING,
    "two slots of one role": problem({"eye": [*EYES, component("third")]}, counts={"eye": (2, 2)}),
    "too few candidates": problem({"eye": EYES}, counts={"eye": (3, 3)}),
    "no candidates": problem({"eye": EYES, "mind": []}),
    "one component in two roles": SHARED,
    "a common value": problem(
        {"eye": EYES, "mind": [MIND]},
        "eye>mind",
        values={"eye": {"left": 0b01, "right": 0b10}, "mind": {"mind": 0b10}},
        domain=("kitchen", "hall"),
    ),
    "values that no option tells apart": ALIKE,
    "values that an option excludes": problem(
        {"eye": EYES, "mind": [MIND, component("dream")]},
        values={"eye": {"left": 0b1111, "right": ~0b0011}, "mind": {"mind": 0b0011}},
        domain=HOURS,
    ),
    "more roles than components": TWINS,
    "a role that issues one of two signals, and one of two others": WIRES,
    "a place that roles may take in several ways": CROWDED,
    "a need of two candidates": problem(
        {
            "eye": [BOTH, component("deaf")],
            "mind": [MIND, component("thought", "i:Image", "o:Thought"), component("calm")],
        },
        "eye>mind",
    ),
    "a need that several of two roles support": problem(
        {"eye": [*EYES, component("deaf")], "lens": [BOTH, component("dark")], "mind": [MIND]}, "eye>mind lens>mind"
    ),
}


def models(encoding: Encoding, assumed: Sequence[int] = ()) -> Iterator[set[int]]:
    """Every assignment of some literals that keeps to the clauses and the bounds, by trying all."""
    for signs in product((1, -1), repeat=encoding.top):
        model = {sign * literal for literal, sign in enumerate(signs, 1)}
        if not model.issuperset(assumed) or not all(model.intersection(clause) for clause in encoding.clauses()):
            continue
        if all(model.intersection(b.force) or len(model.intersection(b.literals)) <= b.most for b in encoding.bounds):
            yield model


def played(encoding: Encoding, assumed: Sequence[int] = ()) -> set[tuple[tuple[str, ...], ...]]:
    """For each model, the components that play each role."""
    return {
        tuple(
            tuple(
                option.component.rpartition(":")[2] for option, literal in zip(*role, strict=True) if literal in model
            )
            for role in zip(encoding.reduced.options, encoding.plays, strict=True)
        )
        for model in models(encoding, assumed)
    }


def solutions(problem: Problem) -> set[tuple[tuple[str, ...], ...]]:
    """For each solution by enumeration, the components that play each role; none with a dominated candidate."""
    world = World(problem.task, problem.partition, problem.hierarchy)
    kept = [set(components) for components in reduced(problem).components()]
    found = [[[c.profile.component for c in some] for some in players] for players in world.solutions()]
    return {
        tuple(tuple(component.rpartition(":")[2] for component in some) for some in players)
        for players in found
        if all(options.issuperset(some) for options, some in zip(kept, players, strict=True))
    }


def guarded(problem: Problem, *dropped: Constraint) -> set[tuple[tuple[str, ...], ...]]:
    """What plays if all constraints but some are in force."""
    encoding = Encoding(reduced(problem), guarded=True)
    return played(encoding, [guard for constraint, guard in encoding.guards.items() if constraint not in dropped])


@pytest.mark.parametrize("given", PROBLEMS.values(), ids=PROBLEMS)
def test_the_models_are_the_solutions(given: Problem) -> None:
    assert played(Encoding(reduced(given))) == solutions(given)


@pytest.mark.parametrize("given", PROBLEMS.values(), ids=PROBLEMS)
def test_with_all_guards_assumed_the_models_are_the_solutions(given: Problem) -> None:
    assert guarded(given) == solutions(given)


def test_without_the_guard_of_a_role_it_may_be_left_unplayed() -> None:
    assert ((), ("both",)) not in guarded(SHARED)
    assert ((), ("both",)) in guarded(SHARED, Played(0))
    assert (("left",), ()) in guarded(SHARED, Played(1))


def test_without_the_guard_of_a_need_nothing_has_to_feed_it() -> None:
    assert (("deaf",), ("mind",)) not in guarded(SEEING)
    assert (("deaf",), ("mind",)) in guarded(SEEING, Fed(0))


def test_without_the_guard_of_distinctness_a_component_may_play_two_roles() -> None:
    assert (("both",), ("both",)) not in guarded(SHARED)
    assert (("both",), ("both",)) in guarded(SHARED, Distinct())


def test_where_order_is_asked_for_interchangeable_roles_are_played_in_it() -> None:
    ordered = played(Encoding(reduced(TWINS), ordered=True))
    assert ordered == {(("left",), ("right",), ("third",))}
    assert len(solutions(TWINS)) == 2


def test_of_two_options_for_one_slot_one_is_the_negation_of_the_other() -> None:
    (first, second), _ = Encoding(reduced(SHARED)).plays
    assert first == -second


def test_where_a_role_issues_one_of_two_signals_one_is_the_negation_of_the_other() -> None:
    encoding = Encoding(reduced(WIRES))
    assert encoding.top == sum(map(len, encoding.plays)) + len(["No, or not", "Low, or not"])


def test_values_that_no_option_tells_apart_have_one_literal() -> None:
    (eye, _), (mind,) = Encoding(reduced(ALIKE)).plays
    assert Encoding(reduced(ALIKE)).top == len([eye, mind]) + len(["nine or ten", "eleven, noon or one"])


def test_where_one_value_suits_all_options_there_are_no_literals_for_values() -> None:
    values = {"eye": {"left": 0b00011, "right": 0b00001}}
    encoding = Encoding(reduced(problem({"eye": EYES, "mind": [MIND]}, "eye>mind", values=values, domain=HOURS)))
    assert encoding.top == max(abs(literal) for literals in encoding.plays for literal in literals)


def test_each_new_literal_is_one_higher_than_all_before() -> None:
    encoding = Encoding(reduced(SEEING))
    before = encoding.top
    assert [encoding.literal(), encoding.literal(), encoding.top] == [before + 1, before + 2, before + 2]


def test_what_was_not_counted_at_first_can_be_added() -> None:
    given = pruned(reduced(pigeonholes(16, 16, 0, 0.5)))
    whole, part = Encoding(given), Encoding(given, patience=0)
    added = part.count()
    assert added
    assert sorted(part.clauses()) == sorted(whole.clauses())
    assert part.count() == whole.count() == []


def test_options_with_a_need_that_one_option_supports_are_written_as_one() -> None:
    minds = [component(f"mind{number}", "i:Image", f"o:Thought{number}") for number in range(3)]
    encoding = Encoding(reduced(problem({"eye": [EYES[0], component("deaf")], "mind": minds}, "eye>mind")))
    (seen,) = [one for one in encoding.statements if isinstance(one, Implied)]
    assert (seen.literal, list(seen.literals), seen.alone) == (encoding.plays[0][0], list(encoding.plays[1]), False)
    assert [[-mind, seen.literal] for mind in seen.literals] == [one for one in encoding.clauses() if len(one) == 2]


@pytest.mark.parametrize("given", PROBLEMS.values(), ids=PROBLEMS)
def test_where_options_of_groups_are_gathered_the_models_are_the_solutions(given: Problem) -> None:
    encoding = Encoding(reduced(given))
    encoding.gather()
    assert played(encoding) == solutions(given)


def test_the_options_of_a_role_in_a_group_are_bounded_by_one_literal_once_they_are_gathered() -> None:
    encoding = Encoding(reduced(CROWDED))
    _, (here, there, _), (near, _), _ = encoding.plays
    place = [sorted(bound.literals) for bound in encoding.bounds].index(sorted([here, there, near]))
    top = encoding.top
    encoding.gather()
    assert encoding.bounds[place] == AtMost([top + 1, near], 1)
