"""A method: how a task is composed, named by the words of the command line."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.api.method import Method
from selfconf.composition import Strategy
from selfconf.errors import SelfconfError
from selfconf.model.hierarchy import Reasoning
from selfconf.model.term import IRI


def test_a_method_is_named_by_the_words_of_the_command_line(tmp_path: Path) -> None:
    path = tmp_path / "a.ttl"
    path.write_text("<urn:a> <urn:b> <urn:c> .")
    method = Method.of("best", "owl-rl", [path], 7, 0.5)
    text = path.read_bytes(), str(path), path.resolve().as_uri()
    assert method == Method(Strategy.BEST, Reasoning.OWL_RL, (text,), 7, 0.5)
    for words in (("worst",), ("first", "magic")):
        with pytest.raises((ValueError, SelfconfError), match=words[-1]):
            Method.of(*words)


def test_a_wider_hierarchy_is_tried_where_the_roles_saw_none() -> None:
    robotics = "https://w3id.org/selfconf/robotics#"
    wider = Method.of().wider()
    assert wider is not None
    assert wider.matches(IRI(robotics + "PersonTracker"), IRI(robotics + "PositionSensor"))
    assert Method.of(reasoning="subclass").wider() is None
