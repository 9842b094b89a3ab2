"""The random problems are worth testing with: most have solutions, and many of these have connections."""

from __future__ import annotations

import pytest
from hypothesis import given, settings

from selfconf.model.configuration import Configuration
from selfconf.search.problem import Problem
from tests.search.oracle import World
from tests.search.worlds import agreement, problems

WORLDS = settings(agreement(), max_examples=250, derandomize=True, database=None)


@pytest.mark.slow
def test_half_of_the_worlds_have_a_solution_and_two_in_five_of_these_have_connections() -> None:
    answers: list[Configuration | None] = []

    @given(problems())
    @WORLDS
    def look(problem: Problem) -> None:
        answers.append(World(problem.task, problem.partition, problem.hierarchy).first())

    look()
    solved = [answer for answer in answers if answer is not None]
    assert len(answers) >= 250
    assert 0.5 <= len(solved) / len(answers) <= 0.9
    assert sum(bool(answer.connections) for answer in solved) / len(solved) >= 0.4
    assert sum(len(answer.components) > 1 for answer in solved) / len(solved) >= 0.5
