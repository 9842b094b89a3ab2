"""What the parts of a running task's configurator are given."""

from __future__ import annotations

from selfconf.configurator import Phase
from tests.lab import Lab, iri


def test_every_part_sees_the_state_as_it_is_now_and_not_as_it_was_when_the_task_began(lab: Lab) -> None:
    agent = lab.agent()
    assert agent._components.liveness._state().phase is not Phase.RUNNING
    assert lab.running(agent)
    for part in (
        agent._components.liveness,
        agent._components.audits,
        agent._components.reachability,
        agent._components.calls,
        agent._search,
        agent._retries_while_refused,
        agent._retries_while_running,
        agent._discovery,
    ):
        assert part._state() is agent.state


def test_a_call_claims_the_rank_that_the_task_has_now(lab: Lab) -> None:
    agent = lab.agent()
    assert lab.running(agent)
    agent.rank(3, 12.0)
    claim = agent._components.calls._calling.claim(iri("person-tracker"), 1)
    assert (claim["priority"], claim["beginning"]) == (3, 12.0)
