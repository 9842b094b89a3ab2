"""When what runs is looked at for something better."""

from __future__ import annotations

from pathlib import Path

from selfconf.configurator.state import Phase
from selfconf.deployment.improvement import LET_GO_OF, MOST_UNREST
from tests.deployment.tasks import TASK
from tests.faults.ecologies import CHOICE
from tests.lab import Lab, iri


def test_a_task_that_changes_for_the_better_takes_in_the_end_what_another_has_let_go_of(tmp_path: Path) -> None:
    lab = Lab(tmp_path, advertised=CHOICE.advertisements)
    for site, names in CHOICE.sites.items():
        lab.site(site, *names)
    for name in CHOICE.advertisements:
        lab.component(name)
    first = lab.agent()
    lab.running(first)
    second = lab.agent(upgrade=0.5)
    assert lab.running(second)
    others = TASK | {"tracker"}
    assert lab.active() == others | {"second-control", "second-drive"}
    lab.let_pass(LET_GO_OF)
    first.stop()
    assert lab.until(lambda: lab.active() == others, LET_GO_OF + 1.0)
    assert second.state.phase is Phase.RUNNING


def test_what_comes_and_goes_all_the_time_does_not_keep_a_task_from_changing_for_the_better(lab: Lab) -> None:
    lab.crash("tracker")
    agent = lab.agent(upgrade=5.0)
    assert lab.running(agent)
    lab.component("tracker")
    for number in range(MOST_UNREST * 5):
        leave = lab.network.node().announce(lab.keys.life(iri("stranger"), str(number)))
        lab.let_pass(1.0)
        leave()
    assert lab.until(lambda: lab.active() == TASK | {"tracker"}, 3.0)


def test_a_look_at_what_others_have_let_go_of_does_not_put_off_the_one_at_what_has_appeared(lab: Lab) -> None:
    lab.crash("tracker")
    agent = lab.agent(upgrade=3.0)
    assert lab.running(agent)
    lab.let_pass(4.0)
    agent._improvement.look_whether_free()
    lab.let_pass(LET_GO_OF - 2.0)
    lab.component("tracker")
    lab.let_pass(2.5)
    assert lab.active() == TASK | {"odometry"}
    lab.let_pass(0.7)
    assert "tracker" in lab.active()


def test_what_would_be_rather_had_is_not_changed_to_while_it_comes_and_goes(lab: Lab) -> None:
    lab.crash("tracker")
    agent = lab.agent(upgrade=5.0)
    assert lab.running(agent)
    for _ in range(4 * MOST_UNREST):
        lab.component("tracker")
        lab.let_pass(3.0)
        assert lab.active() == TASK | {"odometry"}
        lab.crash("tracker")
        lab.let_pass(0.7)
    lab.component("tracker")
    lab.let_pass(4.9)
    assert lab.active() == TASK | {"odometry"}
    assert lab.until(lambda: lab.active() == TASK | {"tracker"}, 5.0)
