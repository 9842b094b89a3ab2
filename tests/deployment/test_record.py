"""What a configurator says when it is asked: its status, and what is deployed, as RDF."""

from __future__ import annotations

from selfconf.bus.port import Replies
from selfconf.configurator.state import Phase
from selfconf.deployment.record import FAILURES_KEPT
from selfconf.protocol.codec import decode
from selfconf.protocol.messages import Status
from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.vocabulary import PROV, SC
from tests.lab import Lab, iri


def ask(lab: Lab, key: str) -> Replies:
    """Ask the ecology."""
    replies: list[Replies] = []
    lab.network.node().ask(key, b"", 1.0, replies.append)
    assert lab.until(lambda: bool(replies))
    return replies[0]


def test_its_status_says_what_it_has_deployed(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.components["tracker"].fail("lost")
    lab.let_pass(1.0)
    (sample,) = ask(lab, lab.keys.configurator_call("*", "status")).samples
    status = decode(sample.payload, Status)
    assert (status.configurator, status.phase) == (agent.name, "running")
    assert status.template == iri("navigate")
    assert set(status.components) == set(agent.configuration.components) if agent.configuration else False
    assert status.lost == {iri("person-tracker"): "fail"}


def test_any_node_may_stop_it(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    assert ask(lab, lab.keys.configurator_call(agent.name, "stop")).samples
    assert lab.until(lambda: lab.ended == [None])
    assert lab.active() == set()


def test_a_call_that_it_does_not_know_is_refused(lab: Lab) -> None:
    agent = lab.agent()
    replies = ask(lab, lab.keys.configurator_call(agent.name, "dance"))
    assert replies.errors == ("there is no call 'dance'",)


def test_what_is_deployed_is_rdf_with_what_it_revises_and_why(lab: Lab) -> None:
    agent = lab.agent()
    assert ask(lab, lab.keys.configuration()).samples == ()
    lab.running(agent)
    (sample,) = ask(lab, lab.keys.configuration()).samples
    first = turtle.parse(sample.payload, "first")
    (name,) = first.instances(SC.Configuration)
    assert first.values(name, SC.template) == [iri("navigate")]
    lab.components["tracker"].fail("lost")
    lab.let_pass(1.0)
    (sample,) = ask(lab, lab.keys.configuration()).samples
    second = turtle.parse(sample.payload, "second")
    (revision,) = second.instances(SC.Configuration)
    assert second.values(revision, PROV.wasRevisionOf) == [name]
    (failure,) = second.instances(SC.Failure)
    assert second.values(failure, SC.component) == [iri("person-tracker")]
    ((node, replaced),) = [
        (node, second.value(node, SC.replaces))
        for node in second.values(revision, SC.assignment)
        if second.values(node, SC.replaces)
    ]
    assert replaced == iri("person-tracker")
    assert second.value(node, SC.component) == iri("absolute-odometry")
    assert second.values(node, SC.passedOver) == [iri("person-tracker")]
    task = second.value(revision, SC.task)
    assert task is not None
    bound = {second.value(b, SC.parameter): second.value(b, SC.value) for b in second.values(task, SC.binding)}
    assert bound[iri("robot")] == iri("Astrid")


def test_what_was_taken_down_is_told_no_more_and_is_revised_by_what_comes_after_it(lab: Lab) -> None:
    agent = lab.agent(patient=True)
    lab.running(agent)
    (sample,) = ask(lab, lab.keys.configuration()).samples
    (name,) = turtle.parse(sample.payload, "first").instances(SC.Configuration)
    lab.crash("drive")
    assert lab.until(lambda: agent.state.phase is Phase.REFUSED)
    assert ask(lab, lab.keys.configuration()).samples == ()
    lab.component("drive")
    lab.running(agent)
    (sample,) = ask(lab, lab.keys.configuration()).samples
    again = turtle.parse(sample.payload, "again")
    (revision,) = again.instances(SC.Configuration)
    assert again.values(revision, PROV.wasRevisionOf) == [name]


def test_what_is_deployed_names_the_newest_failure_of_each_component_and_keeps_no_other(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    for number in range(10):
        for name in ("tracker", "odometry"):
            lab.components[name].fail(f"broken {number}")
            lab.let_pass(1.0)
            lab.crash(name)
            lab.component(name)
            lab.let_pass(1.0)
    record = turtle.parse(agent._record.turtle(), "record.ttl")
    failures = record.instances(SC.Failure)
    assert {record.value(failure, SC.component) for failure in failures} == {
        iri("person-tracker"),
        iri("absolute-odometry"),
    }
    assert [str(record.value(failure, SC.detail)) for failure in failures] == ["broken 9", "broken 9"]


def test_of_components_that_never_come_back_the_latest_failures_are_told(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    for number in range(FAILURES_KEPT + 2):
        agent._record.lost(iri(f"passer-by-{number}"), "crash", "", float(number))
    (sample,) = ask(lab, lab.keys.configuration()).samples
    told = turtle.parse(sample.payload, "told")
    gone = {told.value(failure, SC.component) for failure in told.instances(SC.Failure)}
    assert gone == {iri(f"passer-by-{number}") for number in range(2, FAILURES_KEPT + 2)}


def test_no_broad_question_changes_anything(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    said = {name: list(recorder.said) for name, recorder in lab.components.items()}
    for key in ("**", "selfconf/**", "selfconf/lab/**"):
        ask(lab, key)
    lab.let_pass(1.0)
    assert {name: recorder.said for name, recorder in lab.components.items()} == said
    assert agent.state.phase is Phase.RUNNING
