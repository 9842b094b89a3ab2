"""A patient task that is refused waits until the ecology has what it needs."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from selfconf.composition.composer import Composer
from selfconf.configurator.state import Phase
from selfconf.model.configuration import Configuration
from selfconf.model.partition import Barred
from selfconf.model.refusal import Outcome, Undecided
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement
from tests.deployment.tasks import TASK
from tests.lab import ADVERTISEMENTS, BOUND, NAVIGATE, PREFIXES, Lab, task_of


def test_patience_waits_until_the_ecology_has_what_it_needs(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    lab.site("astrid", "sonar", "encoder", "control", "drive")
    for name in TASK:
        lab.component(name)
    agent = lab.agent(patient=True)
    lab.let_pass(5.0)
    assert agent.state.phase is Phase.REFUSED
    assert lab.ended == []
    lab.component("tracker")
    lab.site("living-room", "tracker")
    assert lab.running(agent)
    assert lab.active() == TASK | {"tracker"}


def test_patience_notices_an_advertisement_that_is_added_to_a_site(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    site = lab.site("astrid", "sonar", "encoder", "control", "drive")
    for name in TASK | {"odometry"}:
        lab.component(name)
    agent = lab.agent(patient=True)
    lab.let_pass(5.0)
    assert agent.state.phase is Phase.REFUSED
    (tmp_path / "astrid" / "odometry.ttl").write_text(PREFIXES + ADVERTISEMENTS["odometry"])
    assert lab.running(agent)
    assert site.name == "astrid"


def test_patience_searches_again_where_a_search_was_ended_by_its_time(lab: Lab) -> None:
    searched, composer = list[float](), Composer(task_of(NAVIGATE, BOUND))

    def compose(
        found: Mapping[IRI, Advertisement], left_out: frozenset[Barred], running: Configuration | None
    ) -> Outcome:
        searched.append(lab.network.time)
        return composer.compose(found, left_out, running) if len(searched) > 2 else Undecided(seconds=1.0)

    agent = lab.agent(patient=True, compose=compose)
    assert lab.running(agent)
    first, second, third = searched
    assert 5.0 < second - first < 6.0 < third - second < 11.0


def test_patience_recovers_when_a_lost_component_lives_again(lab: Lab) -> None:
    agent = lab.agent(patient=True)
    lab.running(agent)
    lab.crash("drive")
    lab.let_pass(1.0)
    assert (agent.state.phase, lab.active()) == (Phase.REFUSED, set())
    lab.component("drive")
    assert lab.running(agent)
    agent.stop()
    assert lab.until(lambda: lab.ended == [None])
    assert lab.active() == set()
