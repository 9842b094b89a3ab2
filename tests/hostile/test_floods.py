"""Much of anything at every door: nothing hangs, memory stays bounded, and the paper's task runs on."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.bus.port import LARGEST_REPLIES, Replies, Request, Urgency
from selfconf.configurator.state import Phase
from selfconf.deployment import TaskRunner
from selfconf.discovery import Discovery, EcologyView
from selfconf.discovery.ecology_view import BETWEEN_DISCOVERIES, IN_A_ROW
from selfconf.discovery.inquiry import MOST_COMPLAINTS
from selfconf.protocol.activation import MOST_HOLDING
from selfconf.protocol.codec import LARGEST, MOST_ADVERTISED, encode
from selfconf.protocol.json_values import MOST_WIRES
from selfconf.protocol.messages import Apply, Cause, Fail, Page, Reserve, Stamp, Wire
from selfconf.sdk.inputs.signal_order import LATE
from selfconf.sdk.payloads import LARGEST_JSON
from selfconf.sdk.runtime.runtime import MOST_PENDING
from tests.harness.effort import thorough
from tests.hostile.bounded import bounded
from tests.lab import Lab, iri
from tests.sdk.inputs.test_handover import Change

DEEP = b"[" * 100_000
LARGE = b"x" * 50_000_000
WIDE = b"[" + b"[]," * (LARGEST_JSON // 2) + b"[]]"
"""JSON that would take a hundred times its size in memory."""


@pytest.fixture
def lab(tmp_path: Path) -> Lab:
    """The paper's ecology, in which nothing runs yet."""
    lab = Lab(tmp_path)
    lab.navigation()
    return lab


def running(lab: Lab) -> TaskRunner:
    """The paper's task, which runs."""
    agent = lab.agent()
    assert lab.running(agent)
    return agent


class Crowd:
    """A site that advertises very much, at an absurd revision."""

    def __init__(self, lab: Lab, number: int, size: int, total: int | None = None) -> None:
        self.lab, self.bus, self._number, self._size = lab, lab.network.node(), number, size
        self._total = number if total is None else total
        self.bus.serve(lab.keys.advertisements("crowd"), self._answer)
        self.bus.announce(lab.keys.site_life("crowd", "1"))

    def _answer(self, request: Request) -> None:
        for index in range(self._number):
            component = iri(f"crowd{index}")
            says = f'<urn:says> "{"y" * self._size}"'
            text = f"<{component}> a <https://w3id.org/selfconf#Component> , <urn:Crowd> ; {says} ."
            page = Page(index, self._total, 10**9, component, "\x1b[2J\ncrowd.ttl", life="1")
            request.reply(self.lab.keys.advertisement("crowd", component), text.encode(), encode(page))
        request.finish()

    def leave(self) -> None:
        """Be gone, with what a simulated network still holds of it."""
        self.bus.close()
        self.lab.let_pass(5.0)


def discovered(lab: Lab) -> Discovery:
    """What a discovery finds."""
    found: list[Discovery] = []
    EcologyView(lab.network.node(), "lab").discover(found.append)
    assert lab.until(lambda: bool(found))
    return found[0]


@pytest.mark.parametrize("payload", [LARGE, DEEP, WIDE], ids=["large", "deep", "wide"])
def test_no_payload_is_too_much_for_any_door(lab: Lab, payload: bytes) -> None:
    agent, stranger, keys = running(lab), lab.network.node(), lab.keys
    wheels, answered = iri("wheels"), list[Replies]()
    stamp = encode(Stamp(wheels, "x", 1, 1.0))
    calls = [keys.call(wheels, call) for call in ("reserve", "apply", "release", "state")]
    asked = [*calls, keys.wake("astrid"), keys.end("astrid"), keys.advertisements()]
    with bounded(20.0, peak=200.0):
        for key in (keys.fail(wheels), keys.free(wheels), keys.changed("x"), keys.output(wheels, "odometry")):
            publisher = stranger.publisher(key, Urgency.EVENT)
            publisher.put(payload, stamp)
            publisher.put(b"1", payload)
            publisher.undeclare()
            lab.let_pass(0.1)
        for key in asked:
            stranger.ask(key, payload, 1.0, answered.append)
            lab.let_pass(2.0)
    assert len(answered) == len(asked)
    assert agent.state.phase is Phase.RUNNING


def test_a_thousand_fail_a_second_of_strangers_cost_little(lab: Lab) -> None:
    agent, stranger = running(lab), lab.network.node()
    publisher = stranger.publisher(lab.keys.fail(iri("stranger")), Urgency.EVENT)
    fail = encode(Fail(iri("stranger"), "", 1, Cause.FAIL, "x" * 1000))
    with bounded(10.0, peak=20.0):
        for _ in range(5):
            for _ in range(1000):
                publisher.put(fail)
            lab.let_pass(1.0)
    assert agent.state.phase is Phase.RUNNING
    assert not lab.acts("lost")


@pytest.mark.parametrize("refused", [False, True], ids=["running", "waiting"])
def test_five_hundred_changes_a_second_ask_nobody_oftener(tmp_path: Path, refused: bool) -> None:
    lab = Lab(tmp_path)
    if refused:
        lab.site("living-room", "tracker")
    else:
        lab.navigation()
    agent = lab.agent(patient=True)
    lab.let_pass(2.0)
    before = len(lab.acts("query"))
    changed = lab.network.node().publisher(lab.keys.changed("stranger"), Urgency.EVENT)
    with bounded(10.0, peak=20.0):
        for _ in range(1000):
            changed.put(b"")
            lab.let_pass(0.002)
    assert len(lab.acts("query")) - before <= IN_A_ROW + 2.0 / BETWEEN_DISCOVERIES + 2
    assert refused or agent.state.phase is Phase.RUNNING


@pytest.mark.slow
def test_lives_by_the_thousand_are_followed_and_forgotten(lab: Lab) -> None:
    agent, stranger, keys = running(lab), lab.network.node(), lab.keys
    with bounded(30.0, peak=60.0):
        for number in range(1000):
            stranger.announce(keys.life(iri(f"nobody{number}"), "1"))
            stranger.announce(keys.life(iri("nobody"), f"x{number}"))
        for number in range(200):
            stranger.announce(keys.site_life(f"nowhere{number}", "1"))
            stranger.announce(keys.configurator_life(f"nobody{number}", "1"))
        lab.let_pass(3.0)
        stranger.close()
        lab.let_pass(5.0)
    assert agent.state.phase is Phase.RUNNING
    assert sum(map(len, agent.ecology.lives.values())) == len(lab.components)


@thorough
@pytest.mark.slow
def test_ten_thousand_advertisements_of_one_site_are_read(lab: Lab) -> None:
    crowd = Crowd(lab, 10_000, 50)
    with bounded(60.0, peak=100.0, left=100.0):
        discovery = discovered(lab)
    assert len(discovery.found) == 10_000 + len(lab.components)
    crowd.leave()


@thorough
@pytest.mark.slow
@pytest.mark.parametrize(("number", "size"), [(MOST_ADVERTISED + 5000, 1), (2000, 100_000)], ids=["many", "large"])
def test_of_more_than_a_site_may_advertise_the_rest_is_left_out(lab: Lab, number: int, size: int) -> None:
    crowd = Crowd(lab, number, size)
    discovery = discovered(lab)
    assert len(lab.components) < len(discovery.found) < number
    assert discovery.missing == ()
    assert [one for one in discovery.complaints if "advertises more than" in one]
    crowd.leave()


def test_pages_that_never_come_hold_nobody_up(lab: Lab) -> None:
    Crowd(lab, 3, 10, total=10**9)
    began = lab.network.time
    agent = lab.agent()
    assert lab.running(agent)
    assert lab.network.time - began < 2.0
    assert agent.ecology.discovery.missing == ("crowd",)


def test_of_very_many_mistakes_of_a_site_a_few_are_told(lab: Lab) -> None:
    stranger = lab.network.node()

    def answer(request: Request) -> None:
        for index in range(1000):
            component = iri(f"bad{index}")
            page = encode(Page(index, 1000, 1, component, life="1"))
            request.reply(lab.keys.advertisement("bad", component), b"<", page)
            request.reply(lab.keys.advertisement("bad", component), b"", b"no page")
        request.finish()

    stranger.serve(lab.keys.advertisements("bad"), answer)
    stranger.announce(lab.keys.site_life("bad", "1"))
    complaints = discovered(lab).complaints
    assert len(complaints) == 2 * MOST_COMPLAINTS + 2
    assert "left out 980 further answers of site bad" in complaints


def test_answers_without_end_are_cut(lab: Lab) -> None:
    stranger = lab.network.node()
    part = b"x" * (LARGEST_REPLIES // 10)

    def answer(request: Request) -> None:
        for _ in range(20):
            request.reply(request.key, part)
        request.finish()

    stranger.serve("selfconf/lab/task/x", answer)
    answered: list[Replies] = []
    lab.network.node().ask("selfconf/lab/task/x", b"", 1.0, answered.append)
    assert lab.until(lambda: bool(answered))
    assert len(answered[0].samples) == 10
    assert not answered[0].complete


def test_a_queryable_that_never_finishes_costs_a_time_out(lab: Lab) -> None:
    lab.network.node().serve("selfconf/**", lambda request: None)
    began = lab.network.time
    running(lab)
    assert lab.network.time - began < 5.0


@pytest.mark.parametrize("number", [1 << 60, (1 << 63) - 1])
def test_no_sequence_mutes_a_source(lab: Lab, number: int) -> None:
    running(lab)
    control, stranger = lab.components["control"], lab.network.node()
    life = lab.runtimes["encoder"].life
    forged = encode(Stamp(iri("wheels"), life, number, 1.0))
    stranger.publisher(lab.keys.output(iri("wheels"), "odometry"), Urgency.SIGNAL).put(b'"forged"', forged)
    lab.let_pass(0.1)
    assert ("localize", "forged") in control.said
    lab.components["encoder"].emit("odometry", "true")
    lab.let_pass(0.1)
    assert ("localize", "true") in control.said


def test_late_signals_are_passed_over(lab: Lab) -> None:
    running(lab)
    publisher = lab.network.node().publisher(lab.keys.output(iri("wheels"), "odometry"), Urgency.EVENT)
    for sequence in (LATE + 5, LATE + 5, LATE + 4, 6):
        publisher.put(str(sequence).encode(), encode(Stamp(iri("wheels"), "another life", sequence, 1.0)))
    lab.let_pass(0.1)
    assert [one for one in lab.components["control"].said if one[0] == "localize"] == [("localize", LATE + 5)]


def calls(lab: Lab, name: str, call: str, messages: list[bytes]) -> list[Replies]:
    """What a component answers to calls."""
    stranger, answered = lab.network.node(), list[Replies]()
    component = lab.profile(name).component
    for message in messages:
        stranger.ask(lab.keys.call(component, call), message, 1.0, answered.append)
    lab.let_pass(2.0)
    return answered


def held(lab: Lab, name: str) -> int:
    """How many tasks hold a component."""
    return len(lab.runtimes[name].activation.holds)


def test_few_tasks_can_share_a_component(lab: Lab) -> None:
    supervisor = lab.keys.configurator_life("stranger", "1")
    lab.network.node().announce(supervisor)
    tasks = [encode(Reserve(1, supervisor, f"task{number}~1")) for number in range(5 * MOST_HOLDING)]
    with bounded(20.0, peak=30.0):
        calls(lab, "tracker", "reserve", tasks)
    assert held(lab, "tracker") == MOST_HOLDING


def test_no_call_connects_more_than_an_input_can_follow(lab: Lab) -> None:
    wires = tuple(Wire(iri(f"x{number}"), "y") for number in range(MOST_WIRES + 1))
    apply = Apply(1, lab.keys.configurator_life("stranger", "1"), "t~1", inputs={"localize": wires})
    assert len(encode(apply)) < LARGEST
    (answer,) = calls(lab, "control", "apply", [encode(apply)])
    (error,) = answer.errors
    assert error.endswith(f": the inputs of a component follow {MOST_WIRES} outputs at most")


def test_calls_do_not_pile_up_before_code_that_hangs(lab: Lab) -> None:
    lab.runtimes["tracker"].code.stopping = True
    reserve = encode(Reserve(1, lab.keys.configurator_life("stranger", "1"), "t~1"))
    answered = calls(lab, "tracker", "reserve", [reserve] * (MOST_PENDING + 10))
    refused = f"{MOST_PENDING} calls wait for the code of person-tracker; try again later"
    assert [one.errors for one in answered if one.errors] == [(refused,)] * 10


def test_calls_do_not_pile_up_while_an_input_is_handed_over() -> None:
    """The new output issues nothing, and the configurator that hears so does nothing."""
    change = Change()
    for _ in range(MOST_PENDING + 9):
        change.ask()
    change.let_pass(1.0, change.tracker)
    refused = f"{MOST_PENDING} calls wait for the code of cap; try again later"
    assert [one.errors for one in change.answers] == [(refused,)] * 10
    change.let_pass(1.0, change.odometry)
    assert len(change.answers) == MOST_PENDING + 10
    change.answers.clear()
    change.ask()
    change.let_pass(0.2)
    assert [one.errors for one in change.answers] == [()]
