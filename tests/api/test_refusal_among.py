"""The refusal of a task that runs: it keeps among which advertisements it was found, whatever is added to it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import selfconf as sc
from selfconf.api.answer import ExplainedRefusal
from selfconf.api.refusal_among import RefusalAmong, outcome_among, searched_ecology
from selfconf.model.optimum import Optimum
from selfconf.model.refusal import Refusal, Undecided
from tests.lab import iri

ROOT = Path(__file__).resolve().parents[2]


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
