"""Why a component plays a role, from the events of a run."""

from __future__ import annotations

from datetime import datetime

import pytest

from selfconf.errors import PeerError
from selfconf.render.task_story import story
from selfconf.render.why import told_why, why_sentences
from tests.render.told_events import EVENTS, HOME, LOST, recruiting, running

PASSED = {HOME + "position": [HOME + "tracker"]}


def test_a_role_is_told_with_what_failed_what_was_passed_over_and_what_would_change_it() -> None:
    first, second, third, fourth = why_sentences(story("navigate", EVENTS), "position", PASSED)
    assert first.startswith("position in navigate: odometry, since ")
    assert "it took over from tracker: lost at " in second
    assert second.endswith("(fail, out of view)")
    assert third == "  passed over, though first in order: tracker"
    assert fourth.startswith("  what would change it: tracker able to act again")


def test_only_of_what_was_lost_it_is_said_that_it_has_to_be_able_to_act_again() -> None:
    passed = {HOME + "position": [HOME + "slow-tracker", HOME + "tracker"]}
    *_, over, change, ask = why_sentences(story("navigate", EVENTS), "position", passed)
    assert over == "  passed over, though first in order: slow-tracker, tracker"
    assert change == "  what would change it: tracker able to act again; without `run --upgrade` a new start as well"
    assert ask == "  `selfconf partition TEMPLATE --why` says what comes of slow-tracker"


def test_of_what_others_play_on_without_it_is_said_why_it_was_lost_and_that_it_has_to_be_free_again() -> None:
    both = running(10.0, "odometry")
    both["configuration"]["roles"][0]["components"].insert(0, HOME + "tracker")
    given_up = {**LOST, "cause": "yield", "detail": "the task tidy of priority 3 asks for it"}
    found = story("navigate", [both, given_up, running(21.0, "odometry")])
    *_, over, why, change = why_sentences(found, "position", PASSED)
    assert over == "  passed over, though first in order: tracker"
    assert why.startswith("  tracker was lost at ")
    assert why.endswith("(yield, the task tidy of priority 3 asks for it)")
    assert change == "  what would change it: tracker free again; without `run --upgrade` a new start as well"


def test_who_goes_first_and_who_has_come_back_is_said() -> None:
    first, over, back, order = why_sentences(
        story("navigate", [*EVENTS, running(40.0, "tracker")]), "position", {HOME + "position": []}
    )
    assert first.startswith("position in navigate: tracker, since ")
    assert over == "  it took over from odometry"
    assert back.startswith("  tracker was lost at ")
    assert back.endswith("(fail, out of view), and has come back")
    assert order == "  no other candidate went before it in the latest search"


def test_who_was_lost_and_has_not_come_back_yet_is_said() -> None:
    lost = {"act": "lost", "time": 20.0, "component": HOME + "tracker", "cause": "crash"}
    _, why = why_sentences(story("navigate", [running(10.0, "tracker"), lost]), "position", {})
    assert why.startswith("  tracker was lost at ")
    assert why.endswith("(crash)")


def test_what_goes_on_through_a_repair_is_told_since_it_began() -> None:
    found = story("navigate", EVENTS)
    (drive,) = (line for line in why_sentences(found, "drive", {}) if "drive" in line)
    assert drive.endswith(datetime.fromtimestamp(10.0).astimezone().strftime("since %Y-%m-%d %H:%M:%S"))


def test_at_an_earlier_moment_the_answer_is_that_of_then() -> None:
    (only,) = why_sentences(story("navigate", EVENTS, at=15.0), "position", {})
    assert "tracker, since" in only


def test_a_component_a_bound_value_and_the_task_name_roles() -> None:
    found = story("navigate", EVENTS)
    assert len(why_sentences(found, "astrid-drive", {})) == 1
    assert len(why_sentences(found, HOME + "Astrid", {})) == 3
    assert len(why_sentences(found, "navigate", {})) == 3
    assert why_sentences(found, "kitchen", {}) == []


def test_an_iri_means_no_other_component_of_the_same_local_name() -> None:
    lamp, door = "urn:dev:lamp:1", "urn:dev:door:1"
    roles = [{"role": f"{HOME}{name}", "components": [one]} for name, one in (("light", lamp), ("entry", door))]
    found = story("evening", [{"act": "running", "time": 1.0, "configuration": {"template": HOME, "roles": roles}}])
    (only,) = why_sentences(found, lamp, {})
    assert only.startswith("light in evening: 1, since ")
    assert len(why_sentences(found, "1", {})) == 2


def test_a_lost_component_plays_no_role_and_it_is_said_why() -> None:
    (only,) = why_sentences(story("navigate", EVENTS), "tracker", PASSED)
    assert only.startswith("tracker plays no role in navigate: lost at ")


def test_what_was_passed_over_without_a_loss_is_said() -> None:
    (only,) = why_sentences(story("navigate", [running(1.0, "odometry")]), "tracker", PASSED)
    assert only == "tracker goes before odometry for the role position, and was passed over"


def test_a_refusal_is_told_with_its_reasons_near_misses_and_repairs() -> None:
    refusal = {
        "reasons": [{"role": HOME + "sonar", "message": "no component is eligible for the role sonar"}],
        "near_misses": [{"role": HOME + "sonar", "component": HOME + "array", "obstacle": "support is Astrid"}],
        "repairs": [{"message": "add one component for the role sonar"}],
    }
    found = story("navigate", [*EVENTS, {"act": "waiting", "time": 30.0, "refusal": refusal}])
    for term in ("sonar", "array", "navigate", "Astrid", "tracker"):
        assert why_sentences(found, term, {})[1:] == [
            "  no component is eligible for the role sonar",
            f"  tracker: {why_sentences(found, term, {})[2].partition(': ')[2]}",
            "  nearly, as sonar: array, but support is Astrid",
            "  what would change it: add one component for the role sonar",
        ]


def test_a_search_that_ended_undecided_is_told_as_that() -> None:
    undecided = {"code": "undecided", "message": "not decided within 1 step; allow more by --steps"}
    first, why = why_sentences(story("patrol", [{"act": "waiting", "time": 30.0, "refusal": undecided}]), "patrol", {})
    assert first.startswith("patrol has no configuration, since ")
    assert why == "  not decided within 1 step; allow more by --steps"


def test_a_recruit_is_told_by_its_own_name_by_what_it_feeds_and_by_its_task() -> None:
    found = story("locate", [recruiting(10.0, "converter", "lidar")])
    (only,) = why_sentences(found, "lidar", {})
    assert only.startswith("lidar in locate: recruited to feed converter, since ")
    player, fed = why_sentences(found, "place", {})
    assert player.startswith("place in locate: locator, since ")
    assert fed == "  fed by recruits: converter"
    assert why_sentences(found, "locate", {})[2:] == [
        *why_sentences(found, "converter", {}),
        *why_sentences(found, "lidar", {}),
    ]


def test_of_a_recruit_it_is_said_from_which_it_took_over_and_that_it_has_come_back() -> None:
    lost = {"act": "lost", "time": 20.0, "component": HOME + "lidar", "cause": "crash"}
    events = [recruiting(10.0, "converter", "lidar"), lost, recruiting(21.0, "converter", "camera")]
    found = story("locate", events)
    first, second = why_sentences(found, "camera", {})
    assert first.startswith("camera in locate: recruited to feed converter, since ")
    assert second.startswith("  it took over from lidar: lost at ")
    (gone,) = why_sentences(found, "lidar", {})
    assert gone.startswith("lidar plays no role in locate: lost at ")
    back = why_sentences(story("locate", [*events, recruiting(40.0, "converter", "lidar")]), "lidar", {})
    assert back[1] == "  it took over from camera"
    assert back[2].endswith("(crash), and has come back")
    assert len(back) == 3


def test_a_near_miss_that_could_be_recruited_is_told_as_that() -> None:
    near = {"role": HOME + "place", "component": HOME + "lidar", "obstacle": "it issues Ping", "recruit": True}
    found = story("locate", [{"act": "waiting", "time": 30.0, "refusal": {"near_misses": [near]}}])
    assert "  nearly, to be recruited for place: lidar, but it issues Ping" in why_sentences(found, "lidar", {})


def test_of_a_task_that_is_being_configured_it_is_said_that_it_has_no_configuration_yet() -> None:
    found = story("navigate", [{"act": "discovered", "time": 10.0}, LOST])
    first, loss = why_sentences(found, "navigate", {})
    assert first == "navigate has no configuration yet"
    assert loss.startswith("  tracker: lost at ")
    assert why_sentences(story("navigate", [{"act": "discovered", "time": 10.0}], at=5.0), "navigate", {}) == []
    ended = story("navigate", [{"act": "discovered", "time": 10.0}, {"act": "stopped", "time": 11.0}])
    assert why_sentences(ended, "navigate", {}) == []


def test_what_a_stranger_tells_does_no_harm() -> None:
    with pytest.raises(PeerError, match="no events of a run"):
        told_why("navigate", [{"act": "running", "configuration": {"roles": [3]}}], "navigate", None, {})
    odd = [{"act": "running", "time": "noon", "configuration": 3}, {"act": ["lost"]}, {}, {"act": "waiting"}]
    assert why_sentences(story("navigate", odd), "navigate", {})[0].startswith("navigate has no configuration")


def test_of_a_task_that_was_taken_down_it_is_said_until_when() -> None:
    stopped = {"act": "stopped", "time": 30.0}
    assert ", until " in why_sentences(story("navigate", [*EVENTS, stopped]), "position", {})[0]
    again = story("navigate", [*EVENTS, stopped, running(40.0, "tracker")])
    assert ", until " not in why_sentences(again, "position", {})[0]
