"""Which composites of a site live, and of several sites."""

from __future__ import annotations

from pathlib import Path

from selfconf.api.reading import described_in
from selfconf.bus.memory import Faults
from selfconf.composites import Composites
from selfconf.configurator import Call, Phase
from selfconf.deployment.components.calling import CALL
from tests.composites.eye import EYE, HINTED, LOOK, advertised_in, eye, looking
from tests.lab import Lab, iri, write_advertisements


def test_the_inside_of_a_composite_takes_only_what_its_own_site_advertises(tmp_path: Path) -> None:
    better = EYE["lens"].replace(":lens-1 a", ":lens-0 sc:preference 9 ; a")
    lab = Lab(tmp_path, advertised=EYE | {"better": better})
    lab.site("home", *EYE)
    lab.site("inn", "better")
    for name in ("lens", "better", "low"):
        lab.component(name)
    lab.let_pass(3.0)
    assert looking(lab, "Low", 0).state.phase is Phase.RUNNING
    assert lab.active() == {"lens", "low"}


def test_a_composite_lives_once_however_often_its_site_reads_the_same(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    advertised = advertised_in(write_advertisements(tmp_path / "home", advertisements=EYE))
    composites, lives = Composites(lab.network.node(), "lab", described_in, lab.complaints.append), list[str]()
    lab.network.node().watch(lab.keys.lives(iri("eye")), lambda key, alive: lives.append(key))
    for _ in range(2):
        composites.refresh(advertised)
    lab.let_pass(5.0)
    assert len(lives) == 1


def test_why_a_composite_does_not_live_is_said_once(tmp_path: Path) -> None:
    lab = eye(tmp_path, {name: text for name, text in EYE.items() if name != "lens"})
    assert len(lab.complaints) == 1
    lab.composites["home"].refresh(advertised_in(tmp_path / "home"))
    lab.let_pass(3.0)
    assert len(lab.complaints) == 1


def test_of_two_sites_that_advertise_a_composite_one_goes_on_when_the_other_has_ended(tmp_path: Path) -> None:
    lab = Lab(tmp_path, advertised=EYE)
    sites = {name: lab.site(name, "eye", "lens") for name in ("home", "inn")}
    lab.site("rest", *(EYE.keys() - {"eye", "lens"}))
    for name in sorted(EYE.keys() - {"eye"}):
        lab.component(name)
    lab.let_pass(5.0)
    (having,) = (name for name in sites if lab.composites[name].living)
    (first,) = lab.composites[having].living.values()
    low = looking(lab, "Low", 0)
    lab.let_pass(60.0)
    assert (low.state.phase, first.runtime.closed) == (Phase.RUNNING, False), "the other one does not begin beside it"
    low.stop()
    lab.let_pass(3.0)
    lab.crash(sites[having])
    lab.let_pass(10.0)
    assert looking(lab, "Low", 0).state.phase is Phase.RUNNING


def test_a_composite_that_lives_is_not_driven_out_by_one_that_comes_later(tmp_path: Path) -> None:
    lab = Lab(tmp_path, advertised=EYE)
    first = lab.site("home", *EYE)
    for name in sorted(EYE.keys() - {"eye"}):
        lab.component(name)
    lab.let_pass(3.0)
    low = looking(lab, "Low", 0)
    for number in range(6):  # of each two lives either may be the smaller one
        lab.site(f"inn-{number}", "eye", "lens")
    lab.let_pass(10.0)
    assert (low.state.phase, lab.acts("lost")) == (Phase.RUNNING, [])
    assert [name for name, composites in lab.composites.items() if composites.living] == [first.name]


def test_a_composite_that_a_call_has_not_reached_is_called_again(tmp_path: Path) -> None:
    """Its inside has not begun, so there is nothing that the caller would have to wait for."""
    lab = eye(tmp_path)
    low = lab.agent(LOOK.replace("SINK", "Low"), ())
    assert lab.until(lambda: low.state.phase is Phase.COMPOSING)
    lab.network.faults = Faults(loss=1.0)
    assert lab.until(lambda: (iri("eye"), Call.RESERVE) in low.state.pending)
    lab.network.faults = Faults()
    assert lab.until(lambda: low.state.phase is Phase.RUNNING, 2 * CALL)
    assert not lab.acts("lost")


def test_a_composite_does_not_fail_while_what_feeds_its_optional_input_is_replaced(tmp_path: Path) -> None:
    lab = eye(tmp_path, HINTED)
    node = lab.network.node()
    task = LOOK.replace(":source :sink", ":hints :source :sink").replace("SINK", "High")
    hints = ":hints a sc:Role ; sh:class :Hinter ; sc:feeds :source ."
    agent = lab.agent(task + hints, (), aside=lambda work: node.later(1.0, work))
    assert lab.running(agent)
    lab.components["hinter0"].fail("it has no idea")
    lab.let_pass(0.5)
    assert agent.state.phase is Phase.COMPOSING
    assert lab.runtimes["lens"].inputs.followed == set()
    assert lab.running(agent)
    lab.let_pass(0.1)
    assert [event.component for event in lab.acts("lost")] == [iri("hinter0")]
    ((_, wire),) = lab.runtimes["lens"].inputs.followed
    assert wire.component == iri("hinter1")
