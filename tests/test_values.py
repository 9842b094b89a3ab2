"""The types of what the library answers with can be imported from one place."""

from __future__ import annotations

from typing import get_args

import selfconf as sc
from selfconf import values
from selfconf.api.answer import Answer
from selfconf.model.run_event import AnyRunEvent


def test_every_name_is_a_type_of_the_library_and_no_second_one() -> None:
    assert values.Answer is Answer
    assert sorted(values.__all__) == values.__all__
    assert set(values.__all__).isdisjoint(sc.__all__)


def test_the_events_of_a_run_are_all_there() -> None:
    assert {event.__name__ for event in get_args(AnyRunEvent)} <= set(values.__all__)


def test_what_the_library_answers_with_is_of_these_types() -> None:
    task, home = sc.template("examples/clock/tell-the-time.ttl"), sc.read("examples/clock")
    refusal = sc.configure(task.bind(room=":cellar"), home)
    assert not refusal
    assert isinstance(sc.configure(task, home), values.Answer)
    assert isinstance(refusal.near_misses[0], values.NearMiss)
    assert isinstance(refusal.reasons[0], get_args(values.Reason))
    assert isinstance(sc.partition(task, home), values.PartitionTable)
    assert isinstance(sc.partition(task, home)["source"], values.RolePartition)
    assert isinstance(sc.partition(task, home)["source"].excluded[0], values.Exclusion)
    assert isinstance(home.query("SELECT ?c { ?c a rob:Display }"), values.Solutions)
    assert isinstance(sc.validate("examples/clock"), values.ValidationReport)
