"""A reduced problem names its classes and components, and its options stand for candidates."""

from __future__ import annotations

import pytest
from hypothesis import given

from selfconf.model.partition import ANY_VALUE
from selfconf.search.problem import Problem
from selfconf.search.reduction import dominance
from selfconf.search.reduction.dominance import reduced
from selfconf.search.reduction.reduced_problem import assigned
from tests.search.worlds import agreement, component, problem, problems

EYES = [component(name, outputs="o:Image") for name in ("left", "right")]
PAIR = problem(
    {"eye": [*EYES, component("deaf")], "mind": [component("cap", "i:Image")]}, "eye>mind", counts={"eye": (2, 2)}
)


def test_candidates_with_equal_ports_are_of_one_interchangeability_class() -> None:
    kinds = reduced(PAIR).kinds()
    assert [(kind.role, kind.needs, kind.supports) for kind in kinds] == [(0, (), (0,)), (0, (), ()), (1, (0,), ())]


@pytest.mark.parametrize("few", [0, 100])
@given(drawn=problems())
@agreement(0.2)
def test_classes_admit_what_their_candidates_do(few: int, drawn: Problem) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(dominance, "FEW_VARIABLES", few)
        given_ = reduced(drawn)
    for candidates, options in zip(drawn.candidates, given_.options, strict=True):
        for option in options:
            masks = candidates[option.number].admits
            assert [option.kind.admits.get(number, ANY_VALUE) for number in range(len(masks))] == list(masks)
            assert ANY_VALUE not in option.kind.admits.values()


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
