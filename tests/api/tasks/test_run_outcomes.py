"""The outcomes of a run: as answers, and refusals that keep the advertisements among which they were found."""

from __future__ import annotations

import pickle
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import selfconf as sc
from selfconf import values
from selfconf.api.answer import Answer, ExplainedRefusal
from selfconf.api.tasks.run_outcomes import (
    RefusalAmong,
    answered,
    answered_event,
    composing,
    outcome_among,
    searched_ecology,
)
from selfconf.composition import Composer
from selfconf.model.optimum import Optimum
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.run_event import EcologyAsked, SearchEnded, TaskRefused, TaskRunning, TaskWaiting
from tests.lab import iri


@pytest.fixture
def answer(clock: sc.TaskSpecification) -> Answer:
    """The configuration of the clock, as the library answers with it."""
    found = sc.configure(clock, sc.read("examples/clock"))
    assert isinstance(found, Answer)
    return found


def test_a_configuration_in_an_event_is_an_answer(answer: Answer) -> None:
    for event, name, kind in (
        (TaskRunning(answer.plain, 1, time=7.0), "configuration", values.TaskRunning),
        (SearchEnded(answer.plain, 0.5, time=7.0), "outcome", values.SearchEnded),
    ):
        handed_out = answered_event(event, answer.task)
        assert isinstance(handed_out, kind)
        assert handed_out.time == 7.0
        assert str(handed_out) == str(event)
        assert pickle.loads(pickle.dumps(handed_out)) == handed_out
        found: Any = getattr(handed_out, name)
        assert found == answer
        assert found["screen"] == answer["screen"]
        assert found.to_turtle() == answer.to_turtle()
        assert found.to_mermaid() == answer.to_mermaid()
        assert found._repr_html_() == answer._repr_html_()
        assert repr(found) == repr(answer)
        assert pickle.loads(pickle.dumps(found)) == found
        with pytest.raises(TypeError):
            found.bindings["room"] = 1


def test_a_refusal_in_an_event_prints_as_that_of_configure(clock: sc.TaskSpecification) -> None:
    refusal = sc.configure(clock.bind(room=":cellar"), sc.read("examples/clock"))
    assert isinstance(refusal, ExplainedRefusal)
    plain = Refusal(refusal.template, refusal.reasons)
    for event, name in (
        (SearchEnded(plain, 0.5), "outcome"),
        (TaskWaiting(plain), "refusal"),
        (TaskRefused(plain), "refusal"),
    ):
        found = getattr(answered_event(event, refusal.task), name)
        assert repr(found).splitlines()[0] == repr(refusal).splitlines()[0]
        assert found.reasons == refusal.reasons


def test_what_is_an_answer_already_stays_and_what_has_none_too(answer: Answer) -> None:
    undecided, asked, waiting = sc.Undecided(1), EcologyAsked(), TaskWaiting(None)
    refusal = ExplainedRefusal.of(Refusal(answer.template, ()), answer.task)
    assert answered(answer, answer.task) is answer
    assert answered(refusal, answer.task) is refusal
    assert answered(undecided, answer.task) is undecided
    assert answered(None, answer.task) is None
    assert answered_event(asked, answer.task) is asked
    assert answered_event(waiting, answer.task) is waiting


ROOT = Path(__file__).resolve().parents[3]


def test_a_refusal_keeps_the_ecology_without_the_lost_components_whatever_is_added() -> None:
    found = sc.read(ROOT / "examples" / "clock").advertisements()
    lost, *others = sorted(found)
    refusal = outcome_among(Refusal(iri("t"), ()), found, {lost})
    assert isinstance(refusal, RefusalAmong)
    added = replace(refusal.told_of_held({}), missing_sites=("attic",))
    assert sorted(searched_ecology(added)) == others
    assert added.missing_sites == ("attic",)
    assert searched_ecology(Refusal(iri("t"), ())) == {}


def test_it_is_not_kept_in_what_users_are_given() -> None:
    home = sc.read(ROOT / "examples" / "clock")
    task = sc.template(ROOT / "examples" / "clock" / "tell-the-time.ttl").bind(room=":kitchen")
    refusal = outcome_among(Refusal(task.iri, ()), home.advertisements(), ())
    assert isinstance(refusal, Refusal)
    assert searched_ecology(ExplainedRefusal.of(refusal, task.document)) == {}


def test_what_is_no_refusal_stays_as_it_is() -> None:
    home = sc.read(ROOT / "examples" / "clock")
    task = sc.template(ROOT / "examples" / "clock" / "tell-the-time.ttl").bind(room=":kitchen")
    answer = sc.configure(task, home)
    assert isinstance(answer, sc.Configuration)
    assert outcome_among(answer, {}, ()) is answer
    assert outcome_among(Optimum(answer, (), (), (), proved=True), {}, ()) is answer
    undecided = Undecided()
    assert outcome_among(undecided, {}, ()) is undecided


def test_what_a_run_composes_keeps_the_ecology_of_a_refusal_and_ends_with_its_time() -> None:
    home = sc.read(ROOT / "examples" / "clock").advertisements()
    task = sc.template(ROOT / "examples" / "clock" / "tell-the-time.ttl").bind(room=":kitchen")
    composer, (lost, *others) = Composer(task.document), sorted(home)
    refusal = composing(composer)(home, frozenset({lost}), None)
    assert isinstance(refusal, RefusalAmong)
    assert sorted(searched_ecology(refusal)) == others
    assert composing(composer, seconds=0.0)(home, frozenset(), None) == Undecided(seconds=0.0)
