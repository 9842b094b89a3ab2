"""The calls of a configurator: in which order components act and rest, what they follow, and who does not obey."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from selfconf.configurator.state import Phase
from selfconf.deployment.components.calling import CALL
from selfconf.deployment.components.reachability import SETTLING
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Release
from selfconf.sdk.runtime.applying import LIFE_ENDS
from selfconf.sdk.runtime.supervision import GRACE
from tests.composites.composite_house import NAVIGATOR, SERVICE, House, lost
from tests.composites.composite_house import TASK as TASK_OF_HOUSE
from tests.deployment.simulated import home, living_room, slow_code
from tests.deployment.tasks import TASK
from tests.lab import NAVIGATE, Lab, Recorder, iri


def test_nothing_acts_before_everything_is_reserved(lab: Lab) -> None:
    """The sonar array cannot be reserved: what comes before it is held, nothing else is, and nothing acts."""
    runtime = lab.runtimes["sonar"]
    runtime.calls.close()
    agent = lab.agent()
    assert lab.until(lambda: agent.state.phase is Phase.RESERVING)
    lab.let_pass(1.0)
    assert lab.active() == set()
    reserved = {name for name in TASK | {"tracker"} if lab.runtimes[name].activation.holds}
    assert reserved == {"drive", "tracker"}  # in the order of the IRIs: astrid-drive, person-tracker, sonar-array


def test_components_start_after_those_that_feed_them_and_actuators_last_and_rest_the_other_way(lab: Lab) -> None:
    order: list[tuple[str, str]] = []
    for name in (*TASK, "tracker"):
        recorder = lab.components[name]
        recorder.started = lambda name=name: order.append(("on", name))  # type: ignore[method-assign,misc]  # it notes
        recorder.stopped = lambda name=name: order.append(("off", name))  # type: ignore[method-assign,misc]  # the order
    agent = lab.agent()
    lab.running(agent)
    on = [name for _, name in order]
    assert (set(on[:3]), on[3:]) == ({"sonar", "encoder", "tracker"}, ["control", "drive"])
    order.clear()
    agent.stop()
    assert lab.until(lambda: bool(lab.ended))
    off = [name for _, name in order]
    assert (off[:2], set(off[2:])) == (["drive", "control"], {"sonar", "encoder", "tracker"})


def test_a_task_waits_for_a_component_whose_life_is_ending_and_has_its_site_start_it_again(tmp_path: Path) -> None:
    """Its code is in `started` for another task; its process is told to end meanwhile, and ends as that returns."""
    lab = home(tmp_path)
    lab.component("tracker")
    thread = slow_code(lab, "tracker")
    runtime = lab.runtimes["tracker"]
    living_room(lab, "1", lambda _: lab.runtimes["tracker"] is runtime and lab.component("tracker"))
    runtime.code.stop(runtime.at_rest)
    thread.spend(1.5)
    agent = lab.agent()
    runtime.bus.later(1.5, runtime.close)
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING, 5.0)
    assert lab.runtimes["tracker"] is not runtime
    assert lab.active() == TASK | {"tracker"}
    assert {event.cause for event in lab.acts("lost")} == {"crash"}
    assert lab.acts("lost")[0].detail == LIFE_ENDS


def test_connections_that_are_made_again_are_reported_again(lab: Lab) -> None:
    agent = lab.agent(patient=True)
    lab.running(agent)
    made = len(lab.acts("connecting"))
    lab.crash("drive")
    lab.let_pass(1.0)
    assert lab.active() == set()
    lab.component("drive")
    lab.running(agent)
    assert len(lab.acts("connecting")) == 2 * made
    lab.isolate(agent)
    lab.let_pass(GRACE + 0.5)
    lab.rejoin(agent)
    lab.let_pass(SETTLING + 1.0)
    assert lab.active() == TASK | {"tracker"}
    assert len(lab.acts("connecting")) == 3 * made


def test_a_connection_that_is_kept_is_reported_once(lab: Lab) -> None:
    lab.running(lab.agent())
    made = len(lab.acts("connecting"))
    lab.components["tracker"].fail("lost")
    lab.let_pass(1.0)
    (new,) = lab.acts("connecting")[made:]
    assert (new.source, new.sink) == (iri("absolute-odometry"), iri("thinking-cap"))


def test_an_input_follows_every_output_that_feeds_it(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    lab.navigation()
    both = NAVIGATE.replace(
        "sh:class rob:PositionSensor ;", "sh:class rob:PositionSensor ; sc:minCount 2 ; sc:maxCount 2 ;"
    )
    assert lab.running(lab.agent(both))
    lab.components["tracker"].emit("pose", 1)
    lab.components["odometry"].emit("pose", 2)
    lab.let_pass(0.1)
    values: list[Any] = [said[1] for said in lab.components["control"].said if said[0] == "position"]
    assert sorted(values) == [1, 2]


class Emitting(Recorder):
    """A source of positions that emits ten a second, or none at all."""

    def __init__(self, *, mute: bool = False) -> None:
        super().__init__()
        self.mute = mute

    def started(self) -> None:
        super().started()
        if not self.mute:
            self.every(0.1, lambda: self.emit("pose", {"x": 0}))


@pytest.mark.parametrize("mute", [True, False])
def test_what_runs_is_changed_only_to_a_source_that_delivers(lab: Lab, mute: bool) -> None:
    for name in ("tracker", "odometry"):
        lab.crash(name)
    lab.component("odometry", Emitting())
    agent = lab.agent(upgrade=0.5)
    assert lab.running(agent)
    lab.component("tracker", Emitting(mute=mute))
    lab.let_pass(10.0)
    assert agent.state.phase is Phase.RUNNING
    assert lab.active() == TASK | {"odometry" if mute else "tracker"}
    assert ("silence" in [event.cause for event in lab.acts("lost")]) == mute
    assert lab.components["odometry"].said == [("started",)] + ([] if mute else [("stopped",)])
    assert lab.components["tracker"].said == [("started",)] + ([("stopped",)] if mute else [])
    assert lab.components["drive"].said.count(("stopped",)) == 0


def test_a_task_waits_where_another_configurator_of_it_has_run_it_by_a_clock_that_was_ahead(lab: Lab) -> None:
    """Each component orders the calls of a task by their epochs, and remembers the newest that it has obeyed."""
    other = lab.agent()
    assert lab.running(other)
    agent = lab.agent(patient=True)
    before = lab.keys.configurator_life("before", "1")
    released = encode(Release(agent.state.epoch + 300_000, before, agent.identity.task))
    for name in ("thinking-cap", "astrid-drive"):
        lab.network.node().ask(lab.keys.call(iri(name), "release"), released, CALL, lambda replies: None)
    assert lab.until(lambda: agent.state.phase is Phase.REFUSED)
    lab.let_pass(1.0)
    for name in ("control", "drive"):
        assert [claim.task for claim in lab.runtimes[name].activation.queue.claims] == [agent.identity.task]
    other.stop()
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING, 1.0)


def test_a_component_that_a_composite_feeds_is_shared_before_it_was_heard_what_is_inside() -> None:
    """It comes first in the order of the IRIs, so that it is reserved before the composite."""
    house = House(navigator=NAVIGATOR.replace(":Nav ;", ":Nav ; sc:shareable true ;"))
    service = SERVICE.replace(":Positions ;", ":Positions ; sc:shareable true ;")
    first, second = house.run(service), house.run(task=TASK_OF_HOUSE.replace(":task ", ":other-task "))
    assert (first.running, second.running) == (True, True)
    (navigating,) = second.configuration["navigator"]
    assert navigating in first.configuration.components
    assert lost(first) == lost(second) == []
    house.crash("t1")
    assert (first.running, second.running) == (True, True)
    assert house.navigator.source == "t2"
