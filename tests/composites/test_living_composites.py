"""When a composite lives, for which tasks it acts, and when what is inside of it rests."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from selfconf import files
from selfconf.api.reading import described_in
from selfconf.bus.memory import Faults
from selfconf.composites import Composites
from selfconf.composites.living_composites import LOOK_AT_REFUSED, NEXT_LIFE, OTHER_LIFE
from selfconf.configurator import Call, Phase
from selfconf.deployment import TaskRunner
from selfconf.deployment.components.calling import CALL
from selfconf.deployment.retries import TRY_AGAIN
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.rdf.advertisements import Advertisement
from tests.deployment.simulated import slow_code
from tests.lab import PREFIXES as LAB_PREFIXES
from tests.lab import Lab, iri, write_advertisements
from tests.sdk.stage import US, reserve

EYE = {
    "eye": """:eye a sc:Component, :Eye ; sc:hasOutput [ sc:name "seen" ; sc:signalType rob:Text ] ;
        sc:grounding [ sc:template :seeing ] .
        :seeing a sc:Template ; sc:roles ( :lens ) ;
            sc:hasOutput [ sc:name "seen" ; sc:signalType rob:Text ; sc:of :lens ] .
        :lens a sc:Role ; sh:class :Lens .""",
    "lens": """:lens-1 a sc:Component, :Lens ; sc:shareable false ;
        sc:hasOutput [ sc:name "seen" ; sc:signalType rob:Text ] .""",
    "plain": """:plain a sc:Component, :Plain ; sc:preference -1 ;
        sc:hasOutput [ sc:name "seen" ; sc:signalType rob:Text ] .""",
} | {
    name: f""":{name} a sc:Component, :{name.title()} ;
        sc:hasInput [ sc:name "seen" ; sc:signalType rob:Text ] ."""
    for name in ("low", "middle", "high")
}  # fmt: skip
"""A composite that tasks share, with one component inside that they do not, and for each task what follows them."""
LOOK = f"""{LAB_PREFIXES}
:look a sc:Template ; sc:roles ( :source :sink ) .
:source a sc:Role ; sh:class :Eye ; sc:feeds :sink . :sink a sc:Role ; sh:class :SINK ."""


def eye(folder: Path, advertised: Mapping[str, str] = EYE) -> Lab:
    """A site with the composite, and with all that lives."""
    lab = Lab(folder, advertised=advertised)
    lab.site("home", *advertised)
    for name in sorted(advertised.keys() - {"eye", "outer"}):
        lab.component(name)
    lab.let_pass(3.0)
    return lab


def looking(lab: Lab, sink: str, priority: int, source: str = "Eye") -> TaskRunner:
    """A task that begins, and gets as far as it does."""
    agent = lab.agent(LOOK.replace("SINK", sink).replace(":Eye", f":{source}"), (), priority=priority)
    lab.running(agent)
    lab.let_pass(3.0)
    return agent


def rank_inside(lab: Lab) -> tuple[int, float]:
    """The rank of the task inside of the composite, as the component inside knows it."""
    (hold,) = lab.runtimes["lens"].activation.holds
    return hold.claim.priority, hold.claim.beginning


@pytest.mark.parametrize("priorities", [(0, 3), (3, 0)])
def test_the_inside_of_a_composite_has_the_rank_of_the_first_of_those_that_share_it(
    tmp_path: Path, priorities: tuple[int, int]
) -> None:
    lab = eye(tmp_path)
    first, second = (looking(lab, sink, of) for sink, of in zip(("Low", "High"), priorities, strict=True))
    low, high = sorted((first, second), key=lambda one: one.identity.priority)
    assert rank_inside(lab) == (3, high.identity.beginning)
    (inside,) = lab.composites["home"].living.values()
    assert inside.runner is not None
    assert inside.runner.status().priority == 3
    middle = looking(lab, "Middle", 1, "Lens")
    assert (low.state.phase, high.state.phase) == (Phase.RUNNING, Phase.RUNNING)
    assert middle.state.phase is Phase.REFUSED
    assert lab.components["lens"].said == [("started",)]
    high.stop()
    lab.let_pass(3.0)
    assert rank_inside(lab) == (0, low.identity.beginning)
    assert lab.components["lens"].said == [("started",)]
    middle = looking(lab, "Middle", 1, "Lens")
    assert middle.state.phase is Phase.RUNNING
    assert low.state.phase is Phase.REFUSED


def test_the_rank_of_what_is_inside_of_composites_that_nest_follows_the_tasks_outside(tmp_path: Path) -> None:
    outer = EYE["eye"].replace("lens", "part").replace("Lens", "Eye").replace("seeing", "wrapping")
    outer = outer.replace(":eye a sc:Component, :Eye", ":outer a sc:Component, :Outer")
    lab = eye(tmp_path, EYE | {"outer": outer})
    low, high = looking(lab, "Low", 0, "Outer"), looking(lab, "High", 3, "Outer")
    assert rank_inside(lab) == (3, high.identity.beginning)
    middle = looking(lab, "Middle", 1, "Eye")
    assert rank_inside(lab) == (3, high.identity.beginning)
    for ended, first in ((high, middle), (middle, low)):
        ended.stop()
        lab.let_pass(3.0)
        assert rank_inside(lab) == (first.identity.priority, first.identity.beginning)
    assert lab.components["lens"].said == [("started",)]


def test_a_task_that_is_refused_as_another_holds_what_is_inside_says_which_one(tmp_path: Path) -> None:
    lab = eye(tmp_path)
    looking(lab, "Middle", 1, "Lens")
    low = looking(lab, "Low", 0)
    assert low.state.phase is Phase.REFUSED
    (lost,) = low.losses.values()
    assert "; lens-1: the task look (priority 1, configurator " in lost


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
    advertised = _advertised(write_advertisements(tmp_path / "home", advertisements=EYE))
    composites, lives = Composites(lab.network.node(), "lab", described_in, lab.complaints.append), list[str]()
    lab.network.node().watch(lab.keys.lives(iri("eye")), lambda key, alive: lives.append(key))
    for _ in range(2):
        composites.refresh(advertised)
    lab.let_pass(5.0)
    assert len(lives) == 1


def test_why_a_composite_does_not_live_is_said_once(tmp_path: Path) -> None:
    lab = eye(tmp_path, {name: text for name, text in EYE.items() if name != "lens"})
    assert len(lab.complaints) == 1
    lab.composites["home"].refresh(_advertised(tmp_path / "home"))
    lab.let_pass(3.0)
    assert len(lab.complaints) == 1


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
    composites.refresh(_advertised(tmp_path / "home"))  # read anew, they are others
    lab.until(lambda: before.runner is None or before not in composites.living.values())
    assert before.runner is None
    lab.let_pass(3.0)
    assert before not in composites.living.values()
    assert looking(lab, "High", 0).state.phase is Phase.RUNNING


def test_a_composite_begins_its_next_life_when_the_last_is_seen_no_more(tmp_path: Path) -> None:
    lab = eye(tmp_path)
    composites, advertised = lab.composites["home"], _advertised(tmp_path / "home")
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


def _advertised(folder: Path) -> dict[IRI, Advertisement]:
    return {one.component: one for path in folder.iterdir() for one in files.advertisements(path)[0]}


@pytest.mark.parametrize("how", ["free", "new life", "same life", "another"])
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
        lab.runtimes["lens"].fail("it is dirty")
    lab.let_pass(60.0)
    assert (low.state.phase, played(low)) == (Phase.RUNNING, {iri("plain"), iri("low")})
    fails = [event for event in lab.acts("lost") if event.component == iri("eye")]
    assert len(fails) == 1
    if middle is not None:
        middle.stop()
    elif how == "same life":
        lab.network.resume(lab.node_of("lens"))
    elif how == "new life":
        lab.crash("lens")
        lab.component("lens")
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
    lab.runtimes["lens"].fail("it is dirty")
    lab.let_pass(3.0)
    lab.crash("lens")
    lab.component("lens")
    refused = list(lab.composites["home"].living.values())
    lab.let_pass(2 * LOOK_AT_REFUSED)
    assert list(lab.composites["home"].living.values()) != refused, "it has run, so the pause is as short as the first"


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
    composites.refresh(composites._advertisements)
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


HINTED = {
    "eye": """:eye a sc:Component, :Eye ; sc:hasOutput [ sc:name "seen" ; sc:signalType rob:Text ] ;
        sc:hasInput [ sc:name "hint" ; sc:signalType :Hint ; sc:optional true ] ; sc:grounding [ sc:template :seeing ] .
        :seeing a sc:Template ; sc:roles ( :lens ) ;
            sc:hasInput [ sc:name "hint" ; sc:signalType :Hint ; sc:of :lens ] ;
            sc:hasOutput [ sc:name "seen" ; sc:signalType rob:Text ; sc:of :lens ] .
        :lens a sc:Role ; sh:class :Lens .""",
    "lens": """:lens-1 a sc:Component, :Lens ; sc:hasInput [ sc:name "hint" ; sc:signalType :Hint ] ;
        sc:hasOutput [ sc:name "seen" ; sc:signalType rob:Text ] .""",
    "high": EYE["high"],
} | {
    f"hinter{number}": f""":hinter{number} a sc:Component, :Hinter ; sc:preference -{number} ;
        sc:hasOutput [ sc:name "hint" ; sc:signalType :Hint ] ."""
    for number in range(2)
}  # fmt: skip
"""A composite that can be fed or not, with a component inside that has to be fed."""


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


BASE = {
    "base": """:base a sc:Component, :Base ; sc:hasInput [ sc:name "go" ; sc:signalType :Go ] ;
        sc:grounding [ sc:template :driving ] .
        :driving a sc:Template ; sc:roles ( :motor ) ;
            sc:hasInput [ sc:name "go" ; sc:signalType :Go ; sc:of :motor ] .
        :motor a sc:Role ; sh:class :Motor .""",
    "motor": ':motor-1 a sc:Component, :Motor ; sc:hasInput [ sc:name "go" ; sc:signalType :Go ] .',
    "control": ':control a sc:Component, :Control ; sc:hasInput [ sc:name "hint" ; sc:signalType :Hint ] ;'
    ' sc:hasOutput [ sc:name "go" ; sc:signalType :Go ] .',
} | {name: HINTED[name] for name in ("hinter0", "hinter1")}
"""An actuator inside of a composite, and what drives it."""
DRIVE_BASE = f"""{LAB_PREFIXES}
:drive a sc:Template ; sc:roles ( :hints :control-role :base-role ) .
:hints a sc:Role ; sh:class :Hinter ; sc:feeds :control-role .
:control-role a sc:Role ; sh:class :Control ; sc:feeds :base-role . :base-role a sc:Role ; sh:class :Base ."""


PILOTED = BASE | {
    "base": """:base a sc:Component, :Base ; sc:hasInput [ sc:name "go" ; sc:signalType :Go ] ;
        sc:grounding [ sc:template :driving ] .
        :driving a sc:Template ; sc:roles ( :pilot :motor ) ;
            sc:hasInput [ sc:name "go" ; sc:signalType :Go ; sc:of :pilot ] .
        :pilot a sc:Role ; sh:class :Pilot ; sc:feeds :motor .
        :motor a sc:Role ; sh:class :Motor .""",
    "pilot": ':pilot-1 a sc:Component, :Pilot ; sc:hasInput [ sc:name "go" ; sc:signalType :Go ] ;'
    ' sc:hasOutput [ sc:name "turn" ; sc:signalType :Turn ] .',
    "motor": ':motor-1 a sc:Component, :Motor ; sc:hasInput [ sc:name "turn" ; sc:signalType :Turn ] .',
}
"""An actuator inside of a composite that is driven by another component inside, and not from outside."""
SECOND = {"second-pilot": PILOTED["pilot"].replace(":pilot-1 a", ":pilot-2 sc:preference -1 ; a")}
"""Another component that may drive it."""


@pytest.mark.parametrize(
    ("advertised", "driver", "output"),
    [(BASE, "control", "go"), (PILOTED, "pilot", "turn"), (PILOTED | SECOND, "pilot", "turn")],
    ids=["from outside", "from inside", "from inside, where two may"],
)
def test_an_actuator_inside_rests_as_soon_as_one_outside_would(
    advertised: dict[str, str], driver: str, output: str, tmp_path: Path
) -> None:
    lab = Lab(tmp_path, advertised=advertised)
    lab.site("home", *advertised)
    for name in sorted(advertised.keys() - {"base"}):
        lab.component(name)
    lab.let_pass(3.0)
    slow_code(lab, "hinter1")
    lab.components["hinter1"].slow = 4.0
    agent = lab.agent(DRIVE_BASE, ())
    assert lab.running(agent)
    lab.components["hinter0"].fail("it has no idea")
    turns = dict[float, list[str]]()
    for tenth in range(60):
        lab.components[driver].emit(output, tenth)
        lab.let_pass(0.1)
        turns[tenth / 10] = [said[0] for said in lab.components["motor"].said if said[0] != output]
    assert (turns[0.8], turns[1.3]) == (["started"], ["started", "stopped"])
    assert agent.state.phase is Phase.RUNNING
    assert turns[5.9] == ["started", "stopped", "started"]


SEEN = {
    "sight": """:sight a sc:Component, :Sight ; sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ] ;
        sc:grounding [ sc:template :seeing ] .
        :seeing a sc:Template ; sc:roles ( :eye :tracker-role ) ;
            sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ; sc:of :tracker-role ] .
        :eye a sc:Role ; sh:class :Camera ; sc:feeds :tracker-role .
        :tracker-role a sc:Role ; sh:class :Tracker .""",
    "tracker": ':tracker a sc:Component, :Tracker ; sc:hasInput [ sc:name "image" ; sc:signalType :Image ] ;'
    ' sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ] .',
    "motor": ':motor-1 a sc:Component, :Motor ; sc:hasInput [ sc:name "pose" ; sc:signalType :Pose ] .',
} | {
    f"camera{number}": f":camera{number} sc:preference {-number} ; a sc:Component, :Camera ;"
    ' sc:hasOutput [ sc:name "image" ; sc:signalType :Image ] .'
    for number in (0, 1)
}
"""A composite that finds positions by a camera, and an actuator outside of it that follows these."""


def test_an_actuator_outside_rests_while_what_feeds_it_inside_of_a_composite_lacks_a_part(tmp_path: Path) -> None:
    lab = Lab(tmp_path, advertised=SEEN)
    lab.site("home", *SEEN)
    for name in sorted(SEEN.keys() - {"sight"}):
        lab.component(name)
    lab.let_pass(3.0)
    slow_code(lab, "camera1")
    lab.components["camera1"].slow = 4.0
    agent = lab.agent(
        f"""{LAB_PREFIXES}
        :drive a sc:Template ; sc:roles ( :sight-role :motor-role ) .
        :sight-role a sc:Role ; sh:class :Sight ; sc:feeds :motor-role . :motor-role a sc:Role ; sh:class :Motor .""",
        (),
    )
    assert lab.running(agent)
    lab.components["tracker"].emit("pose", 0)
    lab.components["camera0"].fail("a cloth covers the lens")
    turns = dict[float, list[str]]()
    for tenth in range(70):
        lab.let_pass(0.1)
        turns[tenth / 10] = [said[0] for said in lab.components["motor"].said if said[0] != "pose"]
    assert (turns[0.9], turns[1.8]) == (["started"], ["started", "stopped"])
    assert turns[6.9] == ["started", "stopped", "started"]
    assert agent.state.phase is Phase.RUNNING
