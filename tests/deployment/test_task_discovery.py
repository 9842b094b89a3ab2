"""What a task has found out about the other tasks of its ecology."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.render.run_events import event_body
from tests.deployment.tasks import DRIVEN, SPARE, contended
from tests.lab import iri


@pytest.mark.parametrize(("patient", "act"), [(False, "refused"), (True, "waiting")])
def test_a_refusal_says_of_all_that_is_held_by_whom_and_since_when(tmp_path: Path, patient: bool, act: str) -> None:
    lab, holding = contended(tmp_path)
    lab.agent(DRIVEN, (), patient=patient, name="third")
    lab.let_pass(1.0)
    (event,) = lab.acts(act)
    assert [str(reason) for reason in event.refusal.reasons] == [
        "no component that is free is eligible for the role drive"
    ]
    held = {component: (holder.name, holder.beginning) for component, holder in event.refusal.held}
    assert held == {
        iri(name): (f"holds-{name}", one.identity.beginning) for name, one in zip(SPARE, holding, strict=True)
    }
    assert [one["task"] for one in event_body(event)["refusal"]["held"]] == ["holds-left", "holds-right"]
