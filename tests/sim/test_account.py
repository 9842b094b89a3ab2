"""What a demo tells of itself: the loss that the experiment is about, among others."""

from __future__ import annotations

import json
from typing import Any

from sim.account import Account
from sim.crew import Line

HOME = "https://w3id.org/selfconf/peis-home#"


def account(*facts: dict[str, Any]) -> Account:
    taken = Account(0.0)
    for fact in facts:
        taken.take(Line("any", json.dumps({"message": "", **fact})))
    return taken


def running(time: float, position: str) -> dict[str, Any]:
    players = {"position": position, "control": "thinking-cap"}
    roles = [{"role": HOME + role, "components": [HOME + player]} for role, player in players.items()]
    return {"act": "running", "time": time, "configuration": {"roles": roles, "connections": []}}


def lost(time: float, component: str) -> dict[str, Any]:
    return {"act": "lost", "time": time, "component": HOME + component, "cause": "fail", "detail": f"no {component}"}


def composed(time: float, seconds: float) -> dict[str, Any]:
    return {"act": "composed", "time": time, "seconds": seconds}


def first_pose(time: float, source: str) -> dict[str, Any]:
    return {"event": "first pose", "real": time, "source": HOME + source}


def test_a_navigator_that_was_ended_meanwhile_is_not_the_loss_that_is_told() -> None:
    told = account(
        composed(1.0, 0.5),
        running(2.0, "person-tracker"),
        first_pose(2.5, "person-tracker"),
        lost(3.0, "thinking-cap"),
        composed(3.25, 0.125),
        first_pose(4.0, "person-tracker"),
        running(4.0, "person-tracker"),
        lost(5.0, "person-tracker"),
        composed(5.125, 0.0625),
        first_pose(5.25, "absolute-odometry"),
        running(5.5, "absolute-odometry"),
    )
    assert told.loss is not None
    assert told.loss["detail"] == "no person-tracker"
    assert (told.gap(), told.search()) == (0.25, 0.0625)
    assert told.around_loss() == told.configurations[1:]


def test_a_run_in_which_no_source_was_lost_has_one_configuration_to_show() -> None:
    told = account(composed(1.0, 0.5), running(2.0, "person-tracker"), lost(3.0, "thinking-cap"), first_pose(4.0, "x"))
    assert (told.loss, told.gap(), told.search()) == (None, None, None)
    assert told.around_loss() == told.configurations


def test_a_source_that_no_other_has_replaced_leaves_the_configuration_that_it_was_lost_from() -> None:
    told = account(composed(1.0, 0.5), running(2.0, "person-tracker"), lost(3.0, "person-tracker"))
    assert (told.gap(), told.search()) == (None, None)
    assert told.around_loss() == told.configurations
