"""Which components the other tasks hold, by what their configurators say."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from selfconf.bus.memory import Network
from selfconf.bus.port import Replies, Request, Sample
from selfconf.deployment.holders import STATUS, ask_holders, holders_in
from selfconf.model.configuration import Wants
from selfconf.model.holder import Holder
from selfconf.model.term import IRI, Literal
from selfconf.protocol.codec import encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Status
from tests.deployment.tasks import TASK
from tests.lab import Lab, iri

KEYS = Keys("lab")
LAMP, CAMERA = IRI("urn:c:lamp"), IRI("urn:c:camera")


def said(name: str, *components: IRI, priority: int = 0, beginning: float = 0.0, key: str = "", **more: Any) -> Sample:
    """What a configurator says of itself."""
    status = Status(name, "running", IRI("urn:t"), 1, 0.0, "", 0, components, {}, f"{name}~1", priority, beginning)
    status = replace(status, **more)
    return Sample(key or KEYS.configurator_call(name, "status"), encode(status))


def test_each_component_has_the_holder_that_says_so() -> None:
    found = holders_in(Replies((said("a", LAMP, priority=2, beginning=3.0), said("b", CAMERA))), KEYS)
    assert found == {LAMP: Holder("a~1", 2, 3.0, "a"), CAMERA: Holder("b~1", 0, 0.0, "b")}


def test_of_several_holders_the_highest_priority_counts_then_the_earlier_beginning() -> None:
    late, early = said("late", LAMP, beginning=9.0), said("early", LAMP, beginning=1.0)
    high = said("high", LAMP, priority=1, beginning=10.0)
    for samples in ((late, early), (early, late)):
        assert holders_in(Replies(samples), KEYS)[LAMP].configurator == "early"
    for samples in ((late, high, early), (high, early, late)):
        assert holders_in(Replies(samples), KEYS)[LAMP].configurator == "high"


def test_a_holder_is_known_with_what_it_wants_of_the_component() -> None:
    wants = Wants(frozenset({("in", CAMERA, "picture")}), frozenset({("goal", Literal("x"))}))
    found = holders_in(Replies((said("a", LAMP, CAMERA, wants={LAMP: wants}),)), KEYS)
    assert (found[LAMP].wants, found[CAMERA].wants) == (wants, Wants())


def test_what_is_no_status_is_passed_over() -> None:
    samples = (
        Sample(KEYS.configurator_call("b", "status"), b"hello"),
        said("c", LAMP, key=KEYS.configurator_call("d", "status")),
    )
    assert holders_in(Replies(samples), KEYS) == {}


def test_what_the_configurator_that_asks_holds_itself_is_passed_over() -> None:
    network, heard = Network(), list[Mapping[IRI, Holder]]()
    node = network.node()

    def answer(request: Request) -> None:
        for name, component in (("me", LAMP), ("b", CAMERA)):
            request.reply(KEYS.configurator_call(name, "status"), said(name, component).payload)
        request.finish()

    node.serve(KEYS.configurator_call("*"), answer)
    ask_holders(network.node(), KEYS, "me", heard.append)
    network.run(lambda: bool(heard), 10.0)
    assert heard == [{CAMERA: Holder("b~1", 0, 0.0, "b")}]


def test_a_configurator_that_does_not_answer_is_waited_for_a_moment_only() -> None:
    network, heard = Network(), list[Mapping[IRI, Holder]]()
    mute, node = network.node(), network.node()

    def answer(request: Request) -> None:
        request.reply(KEYS.configurator_call("b", "status"), said("b", LAMP).payload)
        request.finish()

    mute.serve(KEYS.configurator_call("a"), lambda _: None)
    node.serve(KEYS.configurator_call("b"), answer)
    ask_holders(network.node(), KEYS, "me", heard.append)
    network.run(lambda: bool(heard), 10.0)
    assert network.time <= STATUS + 0.1
    assert heard == [{LAMP: Holder("b~1", 0, 0.0, "b")}]


def test_a_task_that_runs_is_seen_as_the_holder_of_its_components(lab: Lab) -> None:
    agent = lab.agent(priority=3)
    lab.running(agent)
    heard: list[Mapping[IRI, Holder]] = []
    ask_holders(lab.network.node(), lab.keys, "me", heard.append)
    assert lab.until(lambda: bool(heard))
    assert len(heard[0]) == len(TASK) + 1
    identity = agent.identity
    assert heard[0][iri("astrid-drive")] == Holder(identity.task, 3, identity.beginning, agent.name)
