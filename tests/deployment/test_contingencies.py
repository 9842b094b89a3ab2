"""What is found out before a component is lost: the same answer as that of the search then, or none."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from selfconf.composition import Composer
from selfconf.configurator import Improvable, Phase, plan_of
from selfconf.deployment import Outside, RunRequest
from selfconf.deployment.contingencies import MOST_SECONDS, REST, Contingencies
from selfconf.errors import TemplateError
from selfconf.model.configuration import Configuration
from selfconf.model.refusal import Outcome
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement
from tests.deployment.tasks import DRIVEN, SPARE, TASK
from tests.lab import ADVERTISEMENTS, BOUND, NAVIGATE, Lab, iri, task_of

Question = tuple[Mapping[IRI, Advertisement], frozenset[IRI], "Configuration | None"]


class Asked:
    """A search that writes down what it is asked."""

    def __init__(self, compose: Callable[..., Outcome]) -> None:
        self._compose = compose
        self.lost: list[set[str]] = []
        """For each question the components that are lost, by their short names."""

    def __call__(self, found: Mapping[IRI, Advertisement], lost: frozenset[IRI], running: Configuration | None) -> Any:
        self.lost.append({component.short for component in lost})
        return self._compose(found, lost, running)


def at_once(work: Callable[[], None]) -> None:
    """There is always time."""
    work()


def prepared(lab: Lab, **wishes: Any) -> tuple[Any, Asked]:
    """A task that runs, with its contingencies found out; and its search."""
    agent = lab.agent(**{"at_leisure": at_once, **wishes})
    asked = Asked(agent.request.compose)
    request = replace(agent.request, compose=asked)
    agent._search._request = agent._search._contingencies._request = request
    assert lab.running(agent)
    lab.let_pass(1.0)
    return agent, asked


def test_the_loss_of_a_component_is_repaired_without_a_search(lab: Lab) -> None:
    agent, asked = prepared(lab)
    assert {frozenset(lost) for lost in asked.lost[1:]} == {frozenset({c.short}) for c in agent.state.target.components}
    before = len(asked.lost)
    lab.components["tracker"].fail("Astrid has left the picture")
    assert lab.running(agent)
    assert lab.active() == TASK | {"odometry"}
    searched, *_ = asked.lost[before:]
    assert len(searched) == 2, "what follows is what comes after the next loss"
    assert [event.outcome for event in lab.acts("composed")][-1] == agent.state.target


def test_a_component_of_which_a_task_cannot_do_without_is_searched_for_anew(lab: Lab) -> None:
    _, asked = prepared(lab)
    before = len(asked.lost)
    lab.components["control"].fail("no way")
    assert lab.until(lambda: bool(lab.ended))
    assert asked.lost[before] == {"thinking-cap"}
    assert lab.ended[0] is not None


def test_what_was_found_out_does_not_answer_once_a_component_that_was_lost_can_be_had_again(tmp_path: Path) -> None:
    advertised = SPARE | {"third": SPARE["right"].replace(":right", ":third").replace("1", "0")}
    lab = Lab(tmp_path, advertised=advertised)
    lab.site("shared", *advertised)
    for name in advertised:
        lab.component(name)
    agent = lab.agent(DRIVEN, (), at_leisure=at_once)
    assert lab.running(agent)
    lab.components["left"].fail("it is stuck")
    assert lab.running(agent)
    lab.let_pass(1.0)
    contingencies, found, running = agent._search._contingencies, agent.ecology.discovery.found, agent.state.target
    advertisements = {component: one.advertisement for component, one in found.items()}
    both = contingencies.answer(advertisements, frozenset({iri("left"), iri("right")}), running)
    assert both is not None
    assert both.configuration.components == (iri("third"),)
    assert contingencies.answer(advertisements, frozenset({iri("right")}), running) is None


def test_a_task_waits_for_all_that_may_help_and_not_only_for_what_was_found_beforehand(tmp_path: Path) -> None:
    """What was free when that was found out has come to be held by others since."""
    advertised = SPARE | {"third": SPARE["right"].replace(":right", ":third")}
    lab = Lab(tmp_path, advertised=advertised)
    lab.site("shared", *advertised)
    for name in advertised:
        lab.component(name)
    agent = lab.agent(DRIVEN, (), patient=True, at_leisure=at_once)
    assert lab.running(agent)
    lab.let_pass(1.0)
    for name in ("right", "third"):
        assert lab.running(lab.agent(DRIVEN, (), name=f"holds-{name}"))
    agent.reconsider()
    lab.components["left"].fail("jammed")
    assert lab.until(lambda: agent.state.phase is Phase.REFUSED)
    assert {component for component, loss in agent.state.lost.items() if loss.busy} == {iri("right"), iri("third")}


def test_two_losses_before_the_repair_are_searched_for(lab: Lab) -> None:
    _, asked = prepared(lab)
    before = len(asked.lost)
    lab.crash("tracker")
    lab.crash("odometry")
    assert lab.until(lambda: bool(lab.ended))
    assert {"person-tracker", "absolute-odometry"} in asked.lost[before:]


def test_nothing_is_known_about_an_ecology_that_has_changed(lab: Lab) -> None:
    task = task_of(NAVIGATE, BOUND)
    agent = lab.agent()
    assert lab.running(agent)
    running = agent.state.target
    assert running is not None
    found = {one: f.advertisement for one, f in agent.ecology.discovery.found.items()}
    request = replace(RunRequest.of(Composer(task)), at_leisure=at_once)
    contingencies = Contingencies(lab.network.node(), request, lambda: found)
    contingencies.prepare(frozenset(), running)
    lab.let_pass(0.1)
    lost = frozenset({iri("person-tracker")})
    known = contingencies.answer(dict(found), lost, running)
    assert known is not None
    assert known.configuration == Composer(task).compose(found, lost, running)
    fewer = {one: a for one, a in found.items() if one != iri("pippi-drive")}
    assert contingencies.answer(fewer, lost, running) is None
    assert contingencies.answer(found, lost | {iri("astrid-drive")}, running) is None
    assert contingencies.answer(found, frozenset({iri("pippi-drive")}), running) is None
    assert contingencies.answer(found, frozenset(), running) is None
    assert contingencies.answer(found, lost, None) is None


def test_what_is_known_is_what_the_search_answers(lab: Lab) -> None:
    """Asked at random, of ecologies at random."""
    task = task_of(NAVIGATE, BOUND)
    agent = lab.agent()
    assert lab.running(agent)
    everything = {one: f.advertisement for one, f in agent.ecology.discovery.found.items()}
    chance, hits = random.Random(20), 0
    for _ in range(60):
        found = {one: a for one, a in everything.items() if chance.random() < 0.9}
        before = frozenset(one for one in everything if chance.random() < 0.1)
        running = Composer(task).compose(found, before, None)
        if not isinstance(running, Configuration):
            continue
        composer = Composer(task)
        request = replace(RunRequest.of(composer), at_leisure=at_once)
        contingencies = Contingencies(lab.network.node(), request, lambda found=found: found)  # type: ignore[misc]
        contingencies.prepare(before, running)
        lab.let_pass(0.01)
        for component in everything:
            known = contingencies.answer(found, before | {component}, running)
            if known is not None:
                hits += 1
                assert known.configuration == Composer(task).compose(found, before | {component}, running)
                assert known.plan == plan_of(known.configuration)
    assert hits > 10


def test_what_was_interrupted_goes_on_with_the_next_component(lab: Lab) -> None:
    works = list[Callable[[], None]]()
    agent, asked = prepared(lab, at_leisure=works.append)
    before, whole = len(asked.lost), asked._compose

    def interrupted(*question: Any) -> Outcome:
        if len(asked.lost) == before + 3:
            raise KeyboardInterrupt
        return whole(*question)

    asked._compose = interrupted
    with pytest.raises(KeyboardInterrupt):
        works[0]()
    asked._compose = whole
    works[0]()
    alone = [{component.short} for component in agent.state.target.components]
    assert asked.lost[before:] == [*alone[:3], *alone[2:]]


def test_what_was_interrupted_after_it_has_taken_too_long_is_not_begun_again(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    works = list[Callable[[], None]]()
    agent, asked = prepared(lab, at_leisure=works.append)
    before, now, spent = len(asked.lost), agent.bus.now, [0.0]
    monkeypatch.setattr(agent.bus, "now", lambda: now() + spent[0])

    def interrupted(*_: object) -> Outcome:
        spent[0] += MOST_SECONDS + 0.1
        raise KeyboardInterrupt

    asked._compose, whole = interrupted, asked._compose
    with pytest.raises(KeyboardInterrupt):
        works[0]()
    works[0]()
    assert len(asked.lost) == before + 1
    asked._compose = whole
    lab.components["tracker"].fail("Astrid has left the picture")
    assert lab.running(agent)
    assert asked.lost[before + 1] == {"person-tracker"}, "it is searched for when it is needed"


def test_what_another_task_has_taken_meanwhile_counts_beforehand(tmp_path: Path) -> None:
    """As a task that changes for the better looks at what others hold from time to time."""
    advertised = SPARE | {"third": SPARE["right"].replace(":right", ":third")}
    lab = Lab(tmp_path, advertised=advertised)
    lab.site("shared", *advertised)
    for name in advertised:
        lab.component(name)
    agent = lab.agent(DRIVEN, (), upgrade=0.5, at_leisure=at_once)
    asked = Asked(agent.request.compose)
    agent._search._request = agent._search._contingencies._request = replace(agent.request, compose=asked)
    assert lab.running(agent)
    other = lab.agent(DRIVEN, (), name="other")
    assert lab.running(other)
    agent._step(Improvable())
    lab.let_pass(2.0)
    taken = {component.short for component in agent.state.taken}
    assert len(taken) == 1
    assert {"left", *taken} in asked.lost


def test_a_search_that_cannot_be_made_is_told_when_it_is_needed(lab: Lab) -> None:
    agent, asked = prepared(lab, at_leisure=lambda work: None)

    def broken(*_: object) -> Outcome:
        raise TemplateError("a shape that nobody can judge")

    asked._compose = broken
    agent._search._contingencies._request = replace(agent._search._request, at_leisure=at_once)
    agent._search._contingencies._supposed = None
    agent._search.prepare()
    lab.let_pass(1.0)
    assert lab.running(agent)
    lab.components["tracker"].fail("Astrid has left the picture")
    assert lab.until(lambda: bool(lab.ended))
    assert "nobody can judge" in str(agent.trouble)


def test_an_ecology_that_changes_all_the_time_takes_a_share_of_the_time(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    agent = lab.agent()
    assert lab.running(agent)
    running, node = agent.state.target, lab.network.node()
    assert running is not None
    found = {one: f.advertisement for one, f in agent.ecology.discovery.found.items()}
    rounds = list[float]()

    def slow(works: Callable[[], None]) -> None:
        rounds.append(lab.network.time)
        works()

    def compose(found: Mapping[IRI, Advertisement], lost: frozenset[IRI], running: Configuration | None) -> Outcome:
        spent[0] += 0.1
        return running  # type: ignore[return-value]

    spent = [0.0]
    now = node.now
    monkeypatch.setattr(node, "now", lambda: now() + spent[0])
    request = replace(RunRequest.of(agent.request.composer, compose), at_leisure=slow)
    contingencies = Contingencies(node, request, lambda: found)
    for lost in [*ADVERTISEMENTS] * 4:
        contingencies.prepare(frozenset({iri(lost)}), running)
        lab.let_pass(1.0)
    took = 0.1 * len(running.components)
    assert len(rounds) > 2
    assert min(b - a for a, b in pairwise(rounds)) >= REST * took - 0.001


def test_the_inside_of_a_composite_has_none(lab: Lab) -> None:
    agent, asked = prepared(lab, outside=Outside(iri("localisation")))
    before = len(asked.lost)
    agent._search.prepare()
    lab.let_pass(1.0)
    assert len(asked.lost) == before


@pytest.mark.parametrize("why", ["the last search took long", "the task runs no more"])
def test_nothing_is_searched_for_beforehand_that_would_take_long_or_that_nobody_asks(lab: Lab, why: str) -> None:
    agent = lab.agent()
    assert lab.running(agent)
    running = agent.state.target
    assert running is not None
    asked = Asked(agent.request.compose)
    request = replace(RunRequest.of(agent.request.composer, asked), at_leisure=at_once)
    contingencies = Contingencies(lab.network.node(), request, dict, lambda: why != "the task runs no more")
    contingencies.searched = MOST_SECONDS + 0.1 if why == "the last search took long" else 0.0
    contingencies.prepare(frozenset(), running)
    lab.let_pass(1.0)
    assert asked.lost == []
