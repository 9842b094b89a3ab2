"""Which task a configurator runs, as others see it."""

from __future__ import annotations

from selfconf.composition import Composer
from selfconf.deployment.run_request import RunRequest, TaskIdentity
from selfconf.model.refusal import Undecided
from selfconf.protocol.keys import task_identity
from tests.lab import BOUND, NAVIGATE, Lab, task_of


def test_the_name_of_a_task_is_the_part_that_its_user_knows() -> None:
    assert TaskIdentity(task_identity("navigate", "c1"), 3, 12.0).name == "navigate"


def test_two_tasks_of_one_template_have_one_name_and_different_identities(lab: Lab) -> None:
    first, second = lab.agent().identity, lab.agent().identity
    assert first.name == second.name == "navigate"
    assert first.task != second.task


def test_a_task_begins_when_its_configurator_does(lab: Lab) -> None:
    lab.let_pass(7.0)
    agent = lab.agent(priority=2)
    assert (agent.identity.priority, agent.identity.beginning) == (2, lab.network.time)


def test_a_request_asks_the_composer_of_its_task_everything_but_what_is_given_in_its_place() -> None:
    composer = Composer(task_of(NAVIGATE, BOUND))
    request, other = RunRequest.of(composer), RunRequest.of(composer, lambda found, lost, running: Undecided())
    assert request.task is composer.task.task
    assert (request.composer, request.compose) == (composer, composer.compose)
    assert other.compose({}, frozenset(), None) == Undecided()
    assert (other.task, other.composer) == (request.task, request.composer)
