"""A reduced problem names its classes and components, and its options stand for candidates."""

from __future__ import annotations

from selfconf.search.reduction.dominance import reduced
from selfconf.search.reduction.reduced_problem import assigned
from tests.search.worlds import component, problem

EYES = [component(name, outputs="o:Image") for name in ("left", "right")]
PAIR = problem(
    {"eye": [*EYES, component("deaf")], "mind": [component("cap", "i:Image")]}, "eye>mind", counts={"eye": (2, 2)}
)


def test_candidates_with_equal_ports_are_of_one_interchangeability_class() -> None:
    kinds = reduced(PAIR).kinds()
    assert [(kind.role, kind.needs, kind.supports) for kind in kinds] == [(0, (), (0,)), (0, (), ()), (1, (0,), ())]


def test_a_role_with_fewer_options_than_slots_is_wiped_out() -> None:
    assert reduced(PAIR).wiped_out() is None
    assert reduced(problem({"eye": EYES, "mind": []}, counts={"eye": (3, 3)})).wiped_out() == 0


def test_options_stand_for_candidates_of_their_roles() -> None:
    given_ = reduced(PAIR)
    chosen = [given_.options[0][0], given_.options[0][1], given_.options[1][0]]
    assert assigned(PAIR, chosen) == [list(PAIR.candidates[0][:2]), list(PAIR.candidates[1])]
    assert [[one.rpartition(":")[2] for one in some] for some in given_.components()] == [
        ["left", "right", "deaf"],
        ["cap"],
    ]
