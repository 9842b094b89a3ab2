"""In which order components start and come to rest: sources first, loops by their roles, actuators last."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from itertools import chain

import pytest
from hypothesis import given
from hypothesis import strategies as st

from selfconf.configurator.starting_order import (
    Caller,
    callers,
    parameter_values,
    resting_waves,
    starting_order,
    wiring,
)
from selfconf.model.configuration import Assignment, Configuration, Connection, ParameterSetting
from selfconf.model.term import IRI
from selfconf.protocol.messages import Wire
from tests.configurator.builders import CONTROL, DRIVE, GOAL, TEMPLATE, TRACKER, navigation


def name(short: str) -> IRI:
    """The IRI of a component of these tests."""
    return IRI(f"urn:c:{short}")


def configuration(components: str, *edges: str) -> Configuration:
    """A configuration by the letters of its components, in the order of their roles, and who feeds whom."""
    return Configuration(
        TEMPLATE,
        tuple(Assignment(name(f"role-{one}"), (name(one),)) for one in components),
        tuple(Connection(name(edge[0]), "out", name(edge[1]), f"from-{edge[0]}") for edge in edges),
    )


def waves(components: str, *edges: str) -> list[str]:
    """Who comes to rest together, in order."""
    together = resting_waves(wiring(configuration(components, *edges)), map(name, components))
    return ["".join(one.rpartition(":")[2] for one in wave) for wave in together]


def test_the_wiring_names_all_the_outputs_that_an_input_follows() -> None:
    both = navigation()
    both = Configuration(
        both.template,
        both.assignments,
        (*both.connections, Connection(TRACKER, "quality", CONTROL, "position")),
    )
    assert wiring(both) == {
        TRACKER: {},
        CONTROL: {"position": (Wire(TRACKER, "pose"), Wire(TRACKER, "quality"))},
        DRIVE: {"velocity": (Wire(CONTROL, "set"),)},
    }


def test_who_may_call_an_operation_is_whom_it_is_connected_to() -> None:
    calls = [Connection(name("a"), "look()", name(one), "see()") for one in "bc"]
    plain = configuration("abc", "ab")
    whole = replace(plain, connections=(*plain.connections, *calls))
    both = Caller(name("b"), "see()"), Caller(name("c"), "see()")
    assert callers(whole) == {name("a"): {"look()": both}, name("b"): {}, name("c"): {}}
    assert wiring(whole)[name("c")] == {"see()": (Wire(name("a"), "look()"),)}


def test_every_component_has_its_values_perhaps_none() -> None:
    assert parameter_values(navigation()) == {TRACKER: {}, CONTROL: {"goal": GOAL}, DRIVE: {}}
    twice = navigation()
    settings = (*twice.settings, ParameterSetting(CONTROL, "speed", GOAL))
    twice = Configuration(twice.template, twice.assignments, twice.connections, settings)
    assert parameter_values(twice)[CONTROL] == {"goal": GOAL, "speed": GOAL}


def test_what_feeds_is_started_before_what_it_feeds() -> None:
    order = starting_order(navigation())
    assert order.before == {TRACKER: set(), CONTROL: {TRACKER}, DRIVE: {CONTROL}}
    assert order.after == {TRACKER: (CONTROL,), CONTROL: (DRIVE,), DRIVE: ()}
    assert order.actuators == {DRIVE}


def test_the_order_of_the_roles_does_not_matter_but_in_a_loop() -> None:
    assert starting_order(configuration("cba", "ab", "bc")).before[name("c")] == {name("b")}
    loop = ("ab", "bc", "ca", "cd")
    assert starting_order(configuration("abcd", *loop)).before[name("a")] == set()
    assert starting_order(configuration("bcad", *loop)).before[name("b")] == set()
    assert starting_order(configuration("bcad", *loop)).before[name("a")] == {name("c")}


def test_a_loop_is_started_in_the_order_of_its_roles_whatever_feeds_what_in_it() -> None:
    order = starting_order(configuration("dbcas", "ba", "ac", "cb", "ad", "sc"))
    assert order.before == {
        name("s"): set(),
        name("b"): set(),
        name("c"): {name("b"), name("s")},
        name("a"): {name("c")},
        name("d"): {name("a")},
    }
    assert order.after[name("b")] == (name("c"),)


def test_a_component_that_feeds_only_itself_waits_for_nobody_and_counts_as_an_actuator() -> None:
    order = starting_order(configuration("a", "aa"))
    assert (order.before, order.after) == ({name("a"): set()}, {name("a"): ()})
    assert order.actuators == {name("a")}


def test_two_connections_between_two_components_count_once() -> None:
    order = starting_order(configuration("ab", "ab", "ab"))
    assert order.after[name("a")] == (name("b"),)


@pytest.mark.parametrize(
    ("components", "edges", "expected"),
    [
        ("", (), []),
        ("ab", (), ["ab"]),
        ("abc", ("ab", "bc"), ["c", "b", "a"]),
        ("abcd", ("ab", "ac", "bd", "cd"), ["d", "bc", "a"]),
        ("a", ("aa",), ["a"]),
        ("sab", ("sa", "ab", "ba"), ["ba", "s"]),
        ("sabd", ("sa", "ab", "ba", "bd"), ["d", "ba", "s"]),
        ("abcd", ("ab", "ba", "bc", "cd", "dc"), ["dc", "ba"]),
        ("bca", ("ba", "ac", "cb"), ["acb"]),
    ],
)
def test_what_feeds_nothing_any_more_comes_to_rest_first(
    components: str, edges: tuple[str, ...], expected: list[str]
) -> None:
    assert waves(components, *edges) == expected


def test_only_those_that_still_act_count_for_who_is_next() -> None:
    wires = wiring(navigation())
    assert resting_waves(wires, (TRACKER, CONTROL)) == ((CONTROL,), (TRACKER,))
    assert resting_waves({}, (TRACKER, CONTROL)) == ((TRACKER, CONTROL),)


graphs = st.integers(0, 6).flatmap(
    lambda size: st.tuples(
        st.permutations("abcdef"[:size]).map("".join),
        st.lists(st.tuples(*[st.sampled_from("abcdef"[:size])] * 2).map("".join), max_size=12) if size else st.just([]),
    )
)


def reached(start: IRI, fed: Mapping[IRI, Iterable[IRI]]) -> set[IRI]:
    """What a component feeds, directly or not."""
    found: set[IRI] = set()
    new = list(fed[start])
    while new:
        one = new.pop()
        if one not in found:
            found.add(one)
            new += fed[one]
    return found


@given(graphs)
def test_the_starting_order_is_one_and_leaves_out_only_what_closes_a_loop(graph: tuple[str, list[str]]) -> None:
    target = configuration(graph[0], *graph[1])
    order = starting_order(target)
    fed = {one: {c.sink for c in target.connections if c.source == one} for one in target.components}
    started: set[IRI] = set()
    while ready := [one for one in target.components if one not in started and order.before[one] <= started]:
        started.update(ready)
    assert started == set(target.components)
    for connection in target.connections:
        if connection.source not in order.before[connection.sink]:
            assert connection.source in {connection.sink, *reached(connection.sink, fed)}
    assert {(one, other) for other, sources in order.before.items() for one in sources} == {
        (one, other) for one, sinks in order.after.items() for other in sinks
    }
    assert order.actuators == {one for one, sinks in fed.items() if not sinks - {one}}


@given(graphs)
def test_coming_to_rest_nobody_feeds_a_component_that_acts_on_but_in_a_loop(graph: tuple[str, list[str]]) -> None:
    target = configuration(graph[0], *graph[1])
    wires, left = wiring(target), target.components
    fed = {one: {c.sink for c in target.connections if c.source == one} for one in target.components}
    together = resting_waves(wires, left)
    assert sorted(chain(*together)) == sorted(left)
    for wave in together:
        assert wave
        left = tuple(one for one in left if one not in wave)
        assert not any(fed[one] & set(left) for one in wave)
