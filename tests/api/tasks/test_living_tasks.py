"""The tasks of an ecology, asked for over a simulated network: who answers, who is silent, and how they are ended."""

from __future__ import annotations

import os
from dataclasses import replace

import pytest

from selfconf.api.tasks.living_task import LivingTask
from selfconf.bus.memory import MemoryBus
from selfconf.errors import NetworkError
from selfconf.model.term import IRI
from selfconf.protocol.messages import CallAnswer
from selfconf.this_machine import LocalSite, announce
from tests.api.tasks.simulated_tasks import AT_REST, DRIVE, HERE, KEYS, PATROL, TIDY, Tasks
from tests.suspended_run import suspended_run


def test_tasks_that_run_and_tasks_that_are_kept_are_listed_once_each(tasks: Tasks) -> None:
    tasks.configurator("c1", PATROL.task)
    tasks.configurator("c2", "watch~3")
    tasks.site(PATROL, TIDY)
    found = tasks.asked.all(tasks.asked.running())
    assert [(task.name, task.configurator, task.detached) for task in found] == [
        ("patrol", "c1", True),
        ("tidy", "", True),
        ("watch", "c2", False),
    ]
    assert [task.lives_in for task in found] == ["sites", "sites", "command"]


def test_a_task_that_one_site_takes_over_from_another_is_listed_once_as_that_has_it(tasks: Tasks) -> None:
    tasks.configurator("c1", PATROL.task, phase="reserving", since=3.0)
    tasks.configurator("c2", PATROL.task, phase="refused", since=2.0)
    tasks.site(PATROL)
    assert [(task.name, task.configurator) for task in tasks.asked.all(tasks.asked.running())] == [("patrol", "c1")]


def test_a_task_of_which_the_record_names_no_template_is_listed_without_one(tasks: Tasks) -> None:
    tasks.site(replace(TIDY, wanted=""))
    (found,) = tasks.asked.all(tasks.asked.running())
    assert (found.template, found.body()["template"]) == (None, None)


def test_of_several_records_of_a_task_the_newest_counts_and_its_end_is_final(tasks: Tasks) -> None:
    tasks.site(replace(PATROL, revision=2, priority=7), replace(TIDY, revision=2, ended=True))
    tasks.site(PATROL, replace(TIDY, revision=9))
    assert tasks.asked.all(tasks.asked.running()) == (LivingTask.kept(replace(PATROL, revision=2, priority=7)),)


def test_a_task_of_the_sites_that_has_ended_is_listed_as_one_until_it_is_at_rest(tasks: Tasks) -> None:
    tasks.configurator("c1", PATROL.task, phase="dismantling")
    tasks.site(replace(PATROL, revision=2, ended=True))
    assert [(task.phase, task.lives_in) for task in tasks.asked.all(tasks.asked.running())] == [
        ("dismantling", "sites")
    ]


def test_who_lives_and_does_not_answer_is_named_and_who_speaks_for_another_is_left_out(tasks: Tasks) -> None:
    tasks.configurator("c1", "patrol~1", answers=False)
    tasks.configurator("c2", "tidy~2", speaks_of="c3")
    running = tasks.asked.running()
    assert (running.statuses, running.silent) == ((), ("c1", "c2"))
    assert "c2" in running.complaints[0]
    assert [text for text in running.complaints if "'c1' lives, but does not answer" in text]


def test_sites_of_one_name_are_named_with_their_lives_as_discovery_names_them(tasks: Tasks) -> None:
    for site, life in (("home", "1"), ("shed", "1"), ("home", "2")):
        tasks.network.node().announce(KEYS.site_life(site, life))
    running = tasks.asked.running()
    assert running.complaints == ("2 sites are called home: home (1), home (2)",)
    assert running.silent == ()


def test_a_task_is_stopped_by_its_name_or_by_that_of_its_configurator(tasks: Tasks) -> None:
    tasks.configurator("c1", "patrol~1")
    tasks.configurator("c2", "tidy~2")
    assert tasks.asked.stop("patrol")[0] == ("patrol",)
    assert [status.configurator for status in tasks.asked.running().statuses] == ["c2"]
    assert tasks.asked.stop("c2")[0] == ("tidy",)
    assert tasks.asked.running().statuses == ()


PATROL_COMPOSITE = IRI("urn:c#patrol")


def test_a_name_means_the_inside_of_a_composite_only_where_no_other_task_has_it(tasks: Tasks) -> None:
    tasks.configurator("c1", "patrol~1")
    tasks.configurator("c2", "patrol~2", outside=PATROL_COMPOSITE)
    assert tasks.asked.stop("patrol")[0] == ("patrol",)
    assert [status.configurator for status in tasks.asked.running().statuses] == ["c2"]
    assert tasks.asked.stop("patrol")[0] == ("patrol",)
    assert tasks.asked.running().statuses == ()


def test_of_several_insides_of_one_name_none_is_ended_by_it(tasks: Tasks) -> None:
    tasks.configurator("c2", "patrol~2", outside=PATROL_COMPOSITE)
    tasks.configurator("c3", "patrol~3", outside=IRI("urn:d#patrol"))
    with pytest.raises(NetworkError, match="'patrol'; name the configurator of one inside: c2 and c3"):
        tasks.asked.stop("patrol")
    assert tasks.asked.stop("c3")[0] == ("patrol",)
    assert [status.configurator for status in tasks.asked.running().statuses] == ["c2"]


def test_an_inside_goes_on_where_the_sites_keep_a_task_of_its_name_and_ends_by_its_configurator(tasks: Tasks) -> None:
    tasks.configurator("c2", "patrol~2", outside=PATROL_COMPOSITE)
    tasks.site(PATROL)
    names, running = tasks.asked.stop("patrol")
    assert names == ("patrol",)
    assert running.complaints == (), "it holds nothing any more"
    assert tasks.kept == [replace(PATROL, revision=2, ended=True)]
    assert [status.configurator for status in tasks.asked.running().statuses] == ["c2"]
    assert tasks.asked.stop("c2")[0] == ("patrol",)
    assert tasks.asked.running().statuses == ()


def test_what_the_sites_keep_is_ended_by_a_newer_record(tasks: Tasks) -> None:
    tasks.site(PATROL, TIDY)
    assert tasks.asked.stop("tidy")[0] == ("tidy",)
    assert tasks.kept == [replace(TIDY, revision=2, ended=True)]


@pytest.mark.parametrize("silent", [False, True])
def test_what_the_sites_keep_is_ended_by_the_name_of_its_configurator(tasks: Tasks, silent: bool) -> None:
    tasks.site(PATROL, TIDY)
    tasks.configurator("c1", TIDY.task)
    if silent:
        tasks.component(DRIVE, *[held_by("c2", PATROL.task)] * 3, AT_REST)
    else:
        tasks.configurator("c2", PATROL.task)
    assert tasks.asked.stop("c2")[0] == ("patrol",)
    assert tasks.kept == [replace(PATROL, revision=2, ended=True)]
    assert [status.configurator for status in tasks.asked.running().statuses] == ["c1"]


def test_nothing_is_stopped_by_a_name_that_is_nobodys(tasks: Tasks) -> None:
    tasks.configurator("c1", "patrol~1")
    with pytest.raises(NetworkError, match="no task or configurator 'tidy' answers"):
        tasks.asked.stop("tidy")
    assert len(tasks.asked.running().statuses) == 1


def test_of_all_tasks_those_that_answer_are_stopped_before_one_that_does_not_is_named(tasks: Tasks) -> None:
    tasks.configurator("c1", "patrol~1")
    tasks.configurator("c2", "tidy~2", answers=False)
    with pytest.raises(NetworkError, match="'c2' lives, but does not answer"):
        tasks.asked.stop()
    running = tasks.asked.running()
    assert (running.statuses, running.silent) == ((), ("c2",))


def test_a_component_may_take_its_time_to_come_to_rest(tasks: Tasks) -> None:
    tasks.configurator("c1", "patrol~1", DRIVE)
    acts = replace(AT_REST, active=True, task="patrol~1")
    tasks.component(DRIVE, acts, replace(AT_REST, stopping=True), AT_REST)
    assert tasks.asked.stop("patrol")[0] == ("patrol",)


def test_what_acts_for_another_task_or_is_gone_has_obeyed(tasks: Tasks) -> None:
    tasks.configurator("c1", "patrol~1", DRIVE, IRI("urn:c#gone"))
    tasks.component(DRIVE, replace(AT_REST, active=True, task="tidy~2"))
    assert tasks.asked.stop("patrol")[0] == ("patrol",)


@pytest.mark.parametrize(
    ("state", "how"),
    [
        (replace(AT_REST, active=True, task="patrol~1"), r"it acts on \(process 7 on lab\)"),
        (replace(AT_REST, stopping=True), r"its code has not come to rest \(process 7 on lab\)"),
        (None, "it lives, but does not answer"),
    ],
)
def test_a_component_that_does_not_obey_is_named_after_all_is_taken_down(
    tasks: Tasks, state: CallAnswer | None, how: str
) -> None:
    tasks.configurator("c1", "patrol~1", DRIVE)
    tasks.configurator("c2", "tidy~2")
    tasks.component(DRIVE, state or AT_REST, answers=state is not None)
    with pytest.raises(NetworkError, match=f"drive was turned off and has not obeyed: {how}"):
        tasks.asked.stop()
    assert tasks.asked.running().statuses == ()


def test_what_a_task_is_owed_at_its_end_is_named_where_it_is_not_seen_any_more(tasks: Tasks) -> None:
    """It may be frozen, as a process that is stopped (SIGSTOP) for longer than its lease."""
    tasks.configurator("c1", "patrol~1", owed=(DRIVE, IRI("urn:c#cap")))
    tasks.component(IRI("urn:c#cap"), replace(AT_REST, component=IRI("urn:c#cap")))  # it has obeyed since
    unseen = "drive was turned off and has not obeyed: it is not seen any more, and may only be frozen or cut off"
    with pytest.raises(NetworkError, match=f"^{unseen}; it is out of control until it is gone$"):
        tasks.asked.stop()


def held_by(configurator: str, task: str) -> CallAnswer:
    """How the drive is that acts for a task."""
    return replace(AT_REST, active=True, task=task, supervisor=KEYS.configurator_life(configurator, "1"))


def test_a_configurator_that_is_known_by_what_it_holds_alone_is_silent(tasks: Tasks) -> None:
    tasks.configurator("c1", TIDY.task, IRI("urn:c#cap"))
    tasks.component(IRI("urn:c#cap"), replace(held_by("c1", TIDY.task), component=IRI("urn:c#cap")))
    tasks.component(DRIVE, held_by("c2", PATROL.task))
    assert [status.configurator for status in tasks.asked.running().statuses] == ["c1"]
    assert (tasks.asked.running().silent, tasks.asked.running().complaints) == ((), ())
    running = tasks.asked.running(by_components=True)
    assert [found.configurator for found in running.statuses] == ["c1"]
    assert [found.configurator for found in tasks.asked.all(running)] == ["c1"]
    assert running.silent == ("c2",)
    assert running.complaints == ("the configurator 'c2' of 'patrol' holds drive, but does not answer",)


@pytest.mark.parametrize("name", [None, "patrol", "c2"])
@pytest.mark.parametrize(
    ("later", "said"),
    [(AT_REST, "they have come to rest, and if it was suspended"), (held_by("c2", PATROL.task), "they act on")],
)
def test_nothing_is_said_to_be_taken_down_that_a_silent_configurator_holds(
    tasks: Tasks, name: str | None, later: CallAnswer, said: str
) -> None:
    tasks.component(DRIVE, *[held_by("c2", PATROL.task)] * 5, later)
    began = tasks.network.time
    with pytest.raises(NetworkError, match=f"'c2' of 'patrol' holds drive, but does not answer; {said}"):
        tasks.asked.stop(name)
    assert 0.3 < tasks.network.time - began < 10.0


@pytest.mark.parametrize("name", [None, "patrol", "c2"])
def test_a_configurator_that_lives_and_does_not_answer_is_named_with_the_task_that_it_holds_components_for(
    tasks: Tasks, name: str | None
) -> None:
    tasks.configurator("c2", PATROL.task, DRIVE, answers=False)
    tasks.component(DRIVE, *[held_by("c2", PATROL.task)] * 3, AT_REST)
    with pytest.raises(
        NetworkError, match=r"^the configurator 'c2' of 'patrol' holds drive, but does not answer; they h"
    ):
        tasks.asked.stop(name)
    assert tasks.asked.running().silent == ("c2",)


def test_a_task_whose_end_the_sites_keep_is_taken_down_once_all_rests_though_its_configurator_is_silent(
    tasks: Tasks,
) -> None:
    tasks.site(PATROL)
    tasks.component(DRIVE, *[held_by("c2", PATROL.task)] * 3, AT_REST)
    names, running = tasks.asked.stop("patrol")
    assert names == ("patrol",)
    assert running.complaints == (), "it holds nothing any more"
    assert tasks.kept == [replace(PATROL, revision=2, ended=True)]


def test_a_configurator_that_has_not_answered_is_an_error_though_all_rests_and_it_is_not_seen_any_more(
    tasks: Tasks,
) -> None:
    """One that is suspended is asked for three seconds, and its life seems to end meanwhile."""
    tasks.component(DRIVE, AT_REST)
    suspended = tasks.network.node()
    suspended.announce(KEYS.configurator_life("c2", "1"))
    suspended.serve(KEYS.configurator_call("c2", "status"), lambda request: None)
    suspended.later(1.0, suspended.close)
    with pytest.raises(NetworkError, match=r"^the configurator 'c2' did not answer and is not seen any more"):
        tasks.asked.stop()


@pytest.mark.process
@pytest.mark.parametrize("name", [None, "patrol"])
def test_a_run_of_this_machine_that_is_suspended_and_not_seen_is_named_by_its_task(
    tasks: Tasks, name: str | None
) -> None:
    """One that has been suspended for longer has lost its link, and its components are at rest and free."""
    tasks.configurator("c1", TIDY.task)
    with suspended_run("lab", "patrol", HERE), suspended_run("lab", "tidy", HERE):  # tidy is seen, and answers
        running = tasks.asked.running()
        assert [task.name for task in running.suspended] == ["patrol"]
        assert running.complaints == tuple(one.suspension() for one in running.suspended)
        with pytest.raises(NetworkError, match=r"^process \d+ of this machine, which runs the task .patrol., is susp"):
            tasks.asked.stop(name)
    assert (tasks.asked.running().statuses == ()) == (name is None)
    assert tasks.asked.running().suspended == ()


@pytest.mark.process
def test_an_inside_goes_on_where_a_run_of_its_name_is_suspended(tasks: Tasks) -> None:
    tasks.configurator("c2", "patrol~2", outside=PATROL_COMPOSITE)
    with suspended_run("lab", "patrol", HERE), pytest.raises(NetworkError, match="which runs the task 'patrol'"):
        tasks.asked.stop("patrol")
    assert len(tasks.asked.running().statuses) == 1


@pytest.mark.process
def test_a_run_of_this_machine_in_another_ecology_of_the_name_is_nothing_to_this_one(tasks: Tasks) -> None:
    with suspended_run("lab", "patrol", "tcp/127.0.0.1:7002"):
        names, running = tasks.asked.stop()
        assert (names, running.suspended, running.complaints) == ((), (), ())


def test_a_run_of_this_machine_that_is_not_suspended_is_not_named_before_it_is_seen(tasks: Tasks) -> None:
    with tasks.asked.claim("patrol"):
        names, running = tasks.asked.stop()
        assert (names, running.suspended, running.complaints) == ((), (), ())


@pytest.mark.parametrize("kept", [True, False])
def test_a_task_that_is_kept_is_not_said_to_be_taken_down_where_its_configurator_may_be_silent(
    tasks: Tasks, kept: bool
) -> None:
    tasks.configurator("c2", PATROL.task, answers=False)
    tasks.configurator("c3", TIDY.task)
    tasks.site(PATROL if kept else TIDY)
    if not kept:
        assert tasks.asked.stop("tidy")[0] == ("tidy",)
        return
    with pytest.raises(NetworkError, match="the configurator 'c2' lives, but does not answer"):
        tasks.asked.stop("patrol")
    assert tasks.kept == [replace(PATROL, revision=2, ended=True)]


def test_what_another_configurator_holds_is_nothing_to_the_end_of_a_task(tasks: Tasks) -> None:
    tasks.configurator("c1", TIDY.task)
    tasks.component(DRIVE, held_by("c2", PATROL.task))
    assert tasks.asked.stop("tidy")[0] == ("tidy",)


@pytest.mark.parametrize("elsewhere", [False, True])
def test_the_site_of_a_run_ends_with_it_and_so_does_the_ecology_unless_it_has_sites_elsewhere(
    tasks: Tasks, monkeypatch: pytest.MonkeyPatch, elsewhere: bool
) -> None:
    file = announce(LocalSite("lab", "s1", HERE, os.getpid()))
    for site in ("s1", "s2") if elsewhere else ("s1",):
        tasks.network.node().announce(KEYS.site_life(site, "1"))
    configurator = tasks.configurator("c1", PATROL.task)

    def link(_: MemoryBus) -> str:
        if configurator.open:
            return "hub"
        file.unlink(missing_ok=True)
        return ""

    monkeypatch.setattr(MemoryBus, "link", property(link))
    if elsewhere:
        with pytest.raises(NetworkError, match="cut off from the ecology"):
            tasks.asked.stop()
    else:
        assert tasks.asked.stop()[0] == ("patrol",)
