"""How alike texts are by their words."""

from __future__ import annotations

import math

import pytest

from selfconf.model.text_likeness import LONGEST_COMPARED, TextLikeness, words


def test_words_are_cut_out_of_names_and_sentences() -> None:
    assert words("PlanarPose2D of the robot_arms") == ["planar", "pose", "2d", "robot", "arm"]
    assert words("HTTPServer car_price-service") == ["http", "server", "car", "price", "service"]
    assert words("the glass of a bus, 5") == ["glass", "bus"]
    assert words("Müllabfuhr") == ["müllabfuhr"]


def test_a_text_is_looked_at_as_far_as_is_reasonable() -> None:
    assert words(" " * LONGEST_COMPARED + "late") == []


def test_a_rare_word_weighs_more_than_one_that_all_have() -> None:
    texts = [["camera", "service"], ["sonar", "service"], ["drive", "service"]]
    alike = TextLikeness(["sonar", "service"], texts)
    assert alike.of(1) > alike.of(0) == alike.of(2) > 0


def test_equal_texts_are_alike_and_texts_without_a_common_word_are_not() -> None:
    alike = TextLikeness(["red", "lamp"], [["red", "lamp"], ["green"], []])
    assert [alike.of(number) for number in range(3)] == [pytest.approx(1), 0, 0]


def test_the_measure_is_the_cosine_of_weights() -> None:
    texts = [["a1", "a1", "b1"], ["b1"]]
    rare, common = math.log(1 + 2 / 1), math.log(1 + 2 / 2)
    question, text = (rare, common), ((1 + math.log(2)) * rare, common)
    product = question[0] * text[0] + question[1] * text[1]
    expected = product / math.hypot(*question) / math.hypot(*text)
    assert TextLikeness(["a1", "b1", "unknown"], texts).of(0) == pytest.approx(expected)
