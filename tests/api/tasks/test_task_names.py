"""A task has a name of its own as it begins, and as it is handed to the sites."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import replace

import pytest

from selfconf.api.synchronous_bus import ROLL_CALL
from selfconf.bus.port import Request
from selfconf.errors import NetworkError
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import checked_name
from selfconf.protocol.messages import Status
from tests.api.tasks.simulated_tasks import DRIVE, KEYS, PATROL, TIDY, Tasks


def test_a_task_is_handed_over_once(tasks: Tasks) -> None:
    tasks.site(TIDY)
    assert tasks.asked.detach(PATROL) == "patrol"
    assert tasks.kept == [PATROL]
    with pytest.raises(NetworkError, match="a task 'tidy' lives already"):
        tasks.asked.detach(replace(TIDY, task="tidy~3"))


def test_a_name_that_a_task_has_gets_the_first_number_that_is_free(tasks: Tasks) -> None:
    tasks.configurator("c1", "patrol~1")
    tasks.site(replace(TIDY, task="patrol-2~1"), TIDY)

    def claimed(wanted: str) -> str:
        with tasks.asked.claim(wanted, numbered=True) as claim:
            return claim.name

    assert list(map(claimed, ("watch", "tidy", "patrol"))) == ["watch", "tidy-2", "patrol-3"]
    tasks.configurator("c2", f"{'x' * 64}~1")
    assert checked_name(claimed("x" * 64), "a task").endswith("x-2")


def test_a_name_that_must_be_the_wanted_one_is_refused_where_a_task_has_it(tasks: Tasks) -> None:
    tasks.configurator("c1", "patrol~1")
    with tasks.asked.claim("watch") as claimed:
        assert claimed.name == "watch"
        for taken in ("patrol", "watch"):
            with pytest.raises(NetworkError, match=f"a task '{taken}' lives already"):
                tasks.asked.claim(taken)


def test_tasks_that_begin_before_they_see_each_other_have_names_of_their_own(tasks: Tasks) -> None:
    with ExitStack() as stack:
        claims = [stack.enter_context(tasks.asked.claim("patrol", numbered=True)) for _ in range(3)]
        assert [claim.name for claim in claims] == ["patrol", "patrol-2", "patrol-3"]
    with tasks.asked.claim("patrol") as claimed:
        assert claimed.name == "patrol"


def test_of_tasks_that_begin_with_one_name_on_several_hosts_the_first_goes_on(tasks: Tasks) -> None:
    """They claim the name before they see each other, and look once more before they run."""
    tasks.configurator("c1", "patrol~1", phase="idle", beginning=5.0)
    tasks.configurator("c2", "watch~2", beginning=7.0)
    tasks.configurator("c3", "inside~3", outside=DRIVE)
    for task, beginning in (("patrol~1", 5.0), ("patrol~4", 4.0), ("patrol~0", 5.0), ("inside~4", 9.0)):
        tasks.asked.check_alone(task, beginning)
    for task, beginning in (("patrol~4", 6.0), ("patrol~4", 5.0), ("watch~4", 4.0)):
        with pytest.raises(NetworkError, match="lives already"):
            tasks.asked.check_alone(task, beginning)


def test_a_name_that_was_claimed_on_one_machine_is_looked_for_in_the_whole_ecology(tasks: Tasks) -> None:
    tasks.configurator("c1", "watch~2")
    tasks.site(TIDY)
    with tasks.asked.claim_here("tidy"), tasks.asked.claim_here("watch"), tasks.asked.claim_here("patrol"):
        with pytest.raises(NetworkError, match="a task 'patrol' lives already"):
            tasks.asked.claim_here("patrol")
        for taken in ("tidy", "watch"):
            with pytest.raises(NetworkError, match=f"a task '{taken}' lives already"):
                tasks.asked.check_alone(f"{taken}~4", 9.0)
        tasks.asked.check_alone("patrol~4", 9.0)
    assert tasks.asked.statuses is not None
    assert [decode(sample.payload, Status).name for sample in tasks.asked.statuses.samples] == ["watch"]


@pytest.mark.parametrize("beginning", [4.0, 6.0])
def test_of_tasks_that_are_handed_over_with_one_name_on_several_hosts_the_first_is_kept(
    tasks: Tasks, beginning: float
) -> None:
    """They claim the name before the sites keep any of them."""
    tasks.site()
    other, node = replace(PATROL, task="patrol~9", beginning=beginning), tasks.network.node()

    def tell(request: Request) -> None:
        for record in (other, *tasks.kept) if tasks.kept else ():
            request.reply(KEYS.kept_tasks(), encode(record))
        request.finish()

    node.serve(KEYS.kept_tasks(), tell)
    if beginning > PATROL.beginning:
        assert tasks.asked.detach(PATROL) == "patrol"
        assert tasks.kept == [PATROL, replace(other, revision=2, ended=True)], "it may have looked before"
    else:
        with pytest.raises(NetworkError, match="a task 'patrol' lives already"):
            tasks.asked.detach(PATROL)
        assert tasks.kept == [PATROL, replace(PATROL, revision=2, ended=True)]


def test_a_task_that_no_site_can_keep_is_refused_and_called_off(tasks: Tasks) -> None:
    tasks.site(keeps=False)
    with pytest.raises(NetworkError, match="the disk is full"):
        tasks.asked.detach(PATROL)


def test_a_name_is_claimed_as_soon_as_each_has_had_the_time_of_one_question(tasks: Tasks) -> None:
    tasks.configurator("c1", "watch~3")
    for key in (KEYS.configurator_call("c2", "status"), KEYS.kept_tasks()):
        tasks.network.node().serve(key, lambda request: None)
    began = tasks.network.time
    with tasks.asked.claim("watch", numbered=True) as claimed:
        assert claimed.name == "watch-2"
    assert tasks.network.time - began < 1.5 * ROLL_CALL
