"""When a composite begins a life, and when it ends one."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.bus.growing_pause import WELL_AGAIN
from selfconf.composites.lives_of_composite import LOOK_AT_REFUSED, NEXT_LIFE, OTHER_LIFE
from selfconf.configurator import Phase
from selfconf.deployment import TaskRunner
from selfconf.deployment.retries import TRY_AGAIN
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from tests.composites.eye import EYE, LOOK, advertised_in, eye, looking
from tests.lab import Lab, iri, write_advertisements
from tests.sdk.stage import US, reserve


@pytest.mark.parametrize("fails", [True, False])
def test_a_composite_that_acts_no_more_lives_no_more_if_its_inside_cannot_be_configured(
    tmp_path: Path, fails: bool
) -> None:
    lab = eye(tmp_path)
    low, advertised = looking(lab, "Low", 0), tmp_path / "home" / "lens.ttl"
    text = advertised.read_text()
    advertised.unlink()
    lab.let_pass(3.0)
    assert lab.complaints[-1].endswith("no component is eligible for the role lens")
    assert (low.state.phase, list(lab.composites["home"].living)) == (Phase.RUNNING, [iri("eye")])
    if fails:
        lab.crash("lens")
    else:
        low.stop()
    lab.let_pass(3.0)
    assert low.state.phase is (Phase.REFUSED if fails else Phase.STOPPED)
    assert not lab.composites["home"].living
    advertised.write_text(text)
    lab.component("lens")
    lab.let_pass(3.0)
    assert looking(lab, "Low", 0).state.phase is Phase.RUNNING


@pytest.mark.parametrize("comes_back", [True, False])
def test_a_composite_that_acts_lives_on_while_its_file_is_not_there(tmp_path: Path, comes_back: bool) -> None:
    lab = eye(tmp_path)
    low, advertised = looking(lab, "Low", 0), tmp_path / "home" / "eye.ttl"
    lens, text = list(lab.components["lens"].said), advertised.read_text()
    advertised.unlink()
    lab.let_pass(3.0)
    if comes_back:
        advertised.write_text(text)
        lab.let_pass(3.0)
    assert (low.state.phase, low.losses, lab.components["lens"].said) == (Phase.RUNNING, {}, lens)
    low.stop()
    lab.let_pass(3.0)
    assert low.state.phase is Phase.STOPPED
    assert list(lab.composites["home"].living) == [iri("eye")] * comes_back


@pytest.mark.parametrize("acts", [True, False])
def test_a_composite_that_is_another_by_now_begins_a_new_life_once_it_is_at_rest(tmp_path: Path, acts: bool) -> None:
    glass = EYE["lens"].replace("lens-1", "glass-1").replace(":Lens", ":Glass")
    lab = eye(tmp_path, EYE | {"glass": glass})
    low = looking(lab, "Low", 0) if acts else None
    advertised, lens = tmp_path / "home" / "eye.ttl", list(lab.components["lens"].said)
    advertised.write_text(advertised.read_text().replace("sh:class :Lens", "sh:class :Glass"))
    lab.let_pass(3.0)
    assert lab.components["lens"].said == lens
    if low is not None:
        assert low.state.phase is Phase.RUNNING
        low.stop()
        lab.let_pass(3.0)
    before = list(lab.components["lens"].said)
    assert looking(lab, "High", 0).state.phase is Phase.RUNNING
    assert (lab.components["lens"].said, lab.components["glass"].said) == (before, [("started",)])


def test_a_composite_begins_no_life_before_its_inside_has_come_to_rest(tmp_path: Path) -> None:
    lab = eye(tmp_path)
    low, composites = looking(lab, "Low", 0), lab.composites["home"]
    (before,) = composites.living.values()
    low.stop()
    assert lab.until(lambda: before.ending)
    composites.refresh(advertised_in(tmp_path / "home"))  # read anew, they are others
    lab.until(lambda: before.runner is None or before not in composites.living.values())
    assert before.runner is None
    lab.let_pass(3.0)
    assert before not in composites.living.values()
    assert looking(lab, "High", 0).state.phase is Phase.RUNNING


def test_a_composite_begins_its_next_life_when_the_last_is_seen_no_more(tmp_path: Path) -> None:
    lab = eye(tmp_path)
    composites, advertised = lab.composites["home"], advertised_in(tmp_path / "home")
    first = composites.living[iri("eye")].runtime.life
    composites.refresh({})
    composites.refresh(advertised)
    lab.let_pass(NEXT_LIFE / 2)
    assert not composites.living
    lab.let_pass(NEXT_LIFE)
    assert composites.living[iri("eye")].runtime.life != first


def test_a_composite_that_has_left_as_another_life_was_seen_lives_again_once_that_has_ended(tmp_path: Path) -> None:
    """As where a host was cut off, and begins anew before the others have seen its end."""
    lab = Lab(tmp_path, advertised=EYE)
    ended = lab.network.node().announce(lab.keys.life(iri("eye"), "0"))
    lab.site("home", *EYE)
    for name in sorted(EYE.keys() - {"eye"}):
        lab.component(name)
    lab.let_pass(3 * OTHER_LIFE)
    assert not lab.composites["home"].living
    ended()
    lab.let_pass(OTHER_LIFE + 2 * NEXT_LIFE)
    assert looking(lab, "Low", 0).state.phase is Phase.RUNNING


@pytest.mark.parametrize("how", ["free", "new life", "same life", "another", "recovered"])
def test_a_task_that_upgrades_returns_to_a_composite_once_its_inside_can_act_again(tmp_path: Path, how: str) -> None:
    lab = eye(tmp_path)
    task = LOOK.replace("SINK", "Low").replace("sh:class :Eye", "sh:or ( [ sh:class :Eye ] [ sh:class :Plain ] )")
    low = lab.agent(task, (), upgrade=1.0)
    assert lab.running(low)
    middle = None
    if how == "free":
        middle = looking(lab, "Middle", 1, "Lens")
    elif how == "same life":
        lab.network.pause(lab.node_of("lens"))
    else:
        lab.components["lens"].started = lambda: lab.runtimes["lens"].fail("it is dirty")  # type: ignore[method-assign]
        lab.runtimes["lens"].fail("it is dirty")
    lab.let_pass(60.0)
    assert (low.state.phase, played(low)) == (Phase.RUNNING, {iri("plain"), iri("low")})
    fails = [event for event in lab.acts("lost") if event.component == iri("eye")]
    assert len(fails) == (1 if how in ("free", "same life") else 3), "it is tried again at intervals that double"
    if middle is not None:
        middle.stop()
    elif how == "same life":
        lab.network.resume(lab.node_of("lens"))
    elif how == "new life":
        lab.crash("lens")
        lab.component("lens")
    elif how == "recovered":
        del lab.components["lens"].started
    else:
        lens = EYE["lens"].replace("lens-1", "lens-2")
        write_advertisements(tmp_path / "home", "other", advertisements={"other": lens})
        lab.advertised = {**EYE, "other": lens}
        lab.component("other")
    lab.let_pass(20.0)
    assert (low.state.phase, played(low)) == (Phase.RUNNING, {iri("eye"), iri("low")})
    assert [event for event in lab.acts("lost") if event.component == iri("eye")] == fails


def test_a_composite_whose_inside_lacks_what_its_own_task_holds_is_tried_again_at_growing_intervals(
    tmp_path: Path,
) -> None:
    lab = eye(tmp_path)
    task = LOOK.replace(":source :sink", ":source :lens :sink").replace("SINK", "Low")
    low = lab.agent(f"{task} :lens a sc:Role ; sh:class :Lens .", (), patient=True)
    tried, begun, lives = list[int](), list[int](), set[str]()
    lab.network.node().watch(lab.keys.lives(iri("eye")), lambda key, alive: lives.add(key))
    for _ in range(4):
        before = len(lab.acts("lost")), len(lives)
        lab.let_pass(300.0)
        tried.append(len(lab.acts("lost")) - before[0])
        begun.append(len(lives) - before[1])
    assert (low.state.phase, low.configuration) == (Phase.REFUSED, None)
    assert tried[0] < 300.0 / LOOK_AT_REFUSED
    assert begun[0] > 3
    assert max(begun[2:]) <= 1
    assert max(tried[2:]) <= 300.0 / TRY_AGAIN / 4, "the pause of the task doubles as well, while nothing begins anew"
    low.stop()
    lab.let_pass(3.0)
    assert looking(lab, "High", 0).state.phase is Phase.RUNNING
    lab.let_pass(WELL_AGAIN)
    lab.runtimes["lens"].fail("it is dirty")
    lab.let_pass(3.0)
    lab.crash("lens")
    lab.component("lens")
    refused = list(lab.composites["home"].living.values())
    lab.let_pass(2 * LOOK_AT_REFUSED)
    assert list(lab.composites["home"].living.values()) != refused, "it was well, so the pause is as short as the first"


def test_a_composite_that_is_reserved_by_now_begins_no_new_life(tmp_path: Path) -> None:
    lab = eye(tmp_path)
    middle, composites = looking(lab, "Middle", 1, "Lens"), lab.composites["home"]
    assert looking(lab, "Low", 0).state.phase is Phase.REFUSED
    middle.stop()
    lab.let_pass(3.0)
    before = list(composites.living.values())
    caller = lab.network.node()
    caller.announce(US)
    caller.ask(lab.keys.call(iri("eye"), "reserve"), encode(reserve()), 1.0, lambda replies: None)
    lab.let_pass(0.1)
    composites.refresh(lab.sites["home"].shelf.advertisements)
    lab.let_pass(3.0)
    assert list(composites.living.values()) == before


def test_a_composite_whose_inside_was_refused_once_lives_on_after_one_that_has_run(tmp_path: Path) -> None:
    lab = eye(tmp_path)
    middle = looking(lab, "Middle", 1, "Lens")
    assert looking(lab, "Low", 0).state.phase is Phase.REFUSED
    middle.stop()
    lab.let_pass(3.0)
    high = looking(lab, "High", 0)
    assert high.state.phase is Phase.RUNNING
    (composite,) = lab.composites["home"].living.values()
    high.stop()
    lab.let_pass(2 * LOOK_AT_REFUSED)
    assert list(lab.composites["home"].living.values()) == [composite]


def played(agent: TaskRunner) -> set[IRI]:
    """The components of what a task has deployed."""
    return set() if agent.configuration is None else set(agent.configuration.components)
