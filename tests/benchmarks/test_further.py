"""The benchmark on further families: its short run works, and its summary counts what the goals speak of."""

from __future__ import annotations

import re
from functools import reduce
from operator import and_

import pytest

from benchmarks.search import first, further
from benchmarks.search.families import scaling, wiring
from benchmarks.search.families.arithmetic import Circuit, multiplied
from benchmarks.search.families.coverage import cover
from benchmarks.search.families.graphs import cycles, tree
from benchmarks.search.families.installations import bins, building
from benchmarks.search.families.puzzles import magic
from benchmarks.search.families.rosters import hours, workshop
from benchmarks.search.families.wiring import counted
from benchmarks.search.further import Asked
from benchmarks.search.measure import Measured
from benchmarks.search.report import Row
from selfconf.model.partition import Candidate
from tests.benchmarks.short_run import short_run
from tests.harness.effort import thorough


def test_engines_agree_where_roles_draw_on_one_pool_each_in_an_order_of_its_own() -> None:
    pool = [Candidate(wiring.profile(name)) for name in ("p0", "p1", "p2", "p3")]
    problem = counted([pool, pool[::-1]], [2, 2], ())
    found = first.selfconf(problem)
    assert isinstance(found, tuple)
    names = [one.rpartition(":")[2] for one in found]
    assert names == ["p0", "p1", "p3", "p2"]
    for engine in ("clingo, heuristic", "python-sat"):
        assert first.ENGINES[engine](problem) == found


def test_more_candidates_than_an_integer_has_bits_are_weighed_in_parts() -> None:
    pytest.importorskip("ortools", reason="CP-SAT is compared with where it is installed")
    problem = cover(40, 70, 8, 0.2, 1)
    found = first.selfconf(problem)
    assert found
    assert first.ENGINES["CP-SAT"](problem) == found


def test_a_circuit_has_the_bits_that_its_gates_make() -> None:
    built = Circuit()
    wires = [built.wire(), built.wire()]
    built.gate(lambda x, y: x & y, wires, 1)
    assert first.selfconf(built.problem()) == tuple(
        wiring.iri(name) for name in ("gate000.1", "gate001.1", "gate002.11")
    )


@pytest.mark.parametrize("known", range(1, 16))
def test_two_numbers_of_two_bits_are_found_for_each_product_that_there_is(known: int) -> None:
    found = first.selfconf(multiplied(2, known))
    if known in {a * b for a in range(4) for b in range(4)}:
        assert isinstance(found, tuple)
        low, high, other_low, other_high = (int(name[-1]) for name in found[:4])
        assert (low + 2 * high) * (other_low + 2 * other_high) == known
    else:
        assert found is False


def labels(found: first.First) -> list[list[int]]:
    """The numbers in the names of the components of a configuration."""
    assert isinstance(found, tuple)
    return [[int(number) for number in re.findall(r"\d+", name.rpartition(":")[2])] for name in found]


def test_the_numbers_of_a_magic_square_have_one_sum_in_each_line() -> None:
    cells = labels(first.selfconf(magic(6, 1)))[:16]
    square = {(x, y): number for x, y, number in cells}
    assert sorted(square.values()) == list(range(1, 17))
    lines = [[square[x, y] for y in range(4)] for x in range(4)] + [[square[x, y] for x in range(4)] for y in range(4)]
    lines += [[square[k, k] for k in range(4)], [square[k, 3 - k] for k in range(4)]]
    assert {sum(line) for line in lines} == {34}


def test_each_node_of_a_tree_hangs_one_level_below_another_at_a_socket_of_its_own() -> None:
    sockets = labels(first.selfconf(tree(12, 2, 8, 5, 1)))[1:]
    level = {0: 0} | {node: level for node, (_, _, level) in enumerate(sockets, 1)}
    assert all(level[node] == level[other] + 1 for node, (other, _, _) in enumerate(sockets, 1))
    assert len({(other, socket) for other, socket, _ in sockets}) == len(sockets)


def test_cycles_are_followed_both_ways_and_have_three_nodes_at_least() -> None:
    names = [number for _, number in labels(first.selfconf(cycles(8, 8, 2)))]
    after, before = names[:8], names[8:]
    assert all(before[other] == one and after[other] != one for one, other in enumerate(after))


def test_a_workshop_that_has_to_end_too_early_has_no_configuration() -> None:
    assert isinstance(first.selfconf(workshop(3, 2, 12, 1)), tuple)
    assert first.selfconf(workshop(3, 2, 6, 1)) is False


def test_each_item_is_in_the_bin_whose_load_has_it() -> None:
    found = first.selfconf(bins(10, 3, 2, 1, 1))
    assert isinstance(found, tuple)
    names = [name.rpartition(":")[2] for name in found]
    chosen = [int(name.partition(".")[2]) for name in names[:10]]
    loads = [[int(taken) for taken in name.partition(".")[2]] for name in names[10:]]
    assert sum(map(sum, loads)) == 10
    assert [chosen.count(one) for one in range(3)] == [*map(sum, loads)]


def test_workers_have_an_hour_of_each_project_in_common() -> None:
    problem = hours(5, 36, 8, 12, 2)
    found = first.selfconf(problem)
    assert isinstance(found, tuple)
    admits = {one.profile.component: one.admits for some in problem.candidates for one in some}
    assert len(set(found)) == 5
    assert all(reduce(and_, masks) for masks in zip(*[admits[name] for name in found], strict=True))


def test_sensors_of_a_hall_serve_rooms_of_their_floor_alone() -> None:
    found = first.selfconf(building(2, 4, 5, 3, 17))
    assert isinstance(found, tuple)
    names = [name.rpartition(":")[2] for name in found]
    assert len(names) == len(set(names)) == 27
    floors = [names[2:14], names[15:]]
    assert [[name for name in some if "hall" in name] for some in floors] == [[], ["hall01.01", "hall01.02"]]


@thorough
@pytest.mark.process
def test_the_short_run_asks_all_engines_both_questions() -> None:
    printed = short_run("benchmarks.search.further")
    for family in (
        "pigeonholes",
        "relay chain",
        "crossword",
        "teams",
        "timetable",
        "squads",
        "building",
        "magic square",
    ):
        assert f"| smoke | {family} | 1 |" in printed
    assert "## Any configuration" in printed


def row(mine: float | None, other: float | None) -> Row:
    """An instance with the seconds that selfconf and another engine take; None where it has no answer within 60 s."""
    instance = wiring.Instance("made up", "one", 1, lambda: scaling.navigation(1, 1))
    found = {
        engine: Measured(60.0, None) if seconds is None else Measured(seconds, False)
        for engine, seconds in (("selfconf", mine), ("CaDiCaL", other))
    }
    return Row(instance, found, False)


def test_an_engine_without_an_answer_counts_as_if_it_had_it_when_it_was_stopped() -> None:
    assert further.ratios([row(0.3, 0.1), row(6.0, None), row(None, 30.0), row(None, None), row(0.002, 0.001)]) == [
        pytest.approx(3.0),
        pytest.approx(0.1),
        pytest.approx(2.0),
    ]


def test_what_selfconf_leaves_undecided_misses_the_goal() -> None:
    good = Asked("unseen", row(0.05, 0.1), None)
    assert "is met" in "\n".join(further.verdict([good]))
    text = "\n".join(further.verdict([good, good, Asked("unseen", row(None, 50.0), None)]))
    assert "0.50 times the best other engine in the median, 1.20 at worst, 1 undecided" in text
    assert "is missed" in text
    assert "| unseen | **all** | 1 | 0.50 | 0.50 | 0 |" in further.summary([good])
