"""The ten lines by which the library is introduced, as they stand in the design, in the checkout and in an ecology."""

from __future__ import annotations

from pathlib import Path

import pytest

import selfconf as sc
from selfconf.model.run_event import TaskRunning
from tests.cli.processes import Home


def test_the_lines_over_files_do_what_they_say() -> None:
    home = sc.read("examples/peis-home")
    task = sc.template("examples/navigate.ttl").bind(robot=":Astrid", goal="(AT BEDROOM)")
    answer = sc.configure(task, home, strategy="best", reasoning="subclass", seconds=5)
    if answer:
        said = answer["position"], answer.connections, answer.to_turtle(), answer.to_mermaid()
    else:
        pytest.fail(f"{answer.reasons}, {answer.near_misses}, {answer.repairs}")
    assert [component.short for component in said[0]] == ["person-tracker"]
    assert len(said[1]) == 4
    assert "a sc:Configuration" in said[2]
    assert said[3].startswith("flowchart LR")
    eligible = sc.partition(task, home)["position"].eligible
    assert [component.short for component in eligible] == ["person-tracker", "absolute-odometry"]
    assert sc.validate(["examples"]).conforms
    solutions = home.query("SELECT ?c WHERE { ?c a rob:PositionSensor } ORDER BY ?c")
    assert [one["c"].short for one in solutions] == ["absolute-odometry", "person-tracker"]


def test_the_lines_for_a_refusal_name_reasons_near_misses_and_repairs_with_file_and_line() -> None:
    home = sc.read("examples/peis-home")
    answer = sc.configure(sc.template("examples/navigate.ttl").bind(robot=":Pippi", goal="(AT BEDROOM)"), home)
    assert not answer
    assert isinstance(answer, sc.Refusal)
    facts = (*answer.reasons, *answer.near_misses, *answer.repairs)
    assert {fact.code for fact in answer.reasons} <= {"too-few-eligible", "conflict"}
    assert answer.near_misses
    assert answer.repairs
    for fact in facts:
        assert fact.place is not None
        assert Path(fact.place.source).is_file()
        assert fact.place.line


@pytest.mark.process
def test_the_lines_for_the_living_ecology_do_what_they_say(served: Home, clock: sc.TaskSpecification) -> None:
    with sc.join(served.ecology) as living:
        assert [component.short for component in living.components] == ["clock", "display"]
        assert living.tasks == ()
        assert living.query("ASK { ?c a rob:Display }") is True
        assert living.configure(clock)
        with living.run(clock) as run:
            for event in run.events():
                if isinstance(event, TaskRunning):
                    break
        assert isinstance(event, TaskRunning)
        assert living.tasks == ()
