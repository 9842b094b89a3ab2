"""A thing is looked for: it lives here while it answers, and why it does not is said once."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from selfconf.bridging.wot.thing_client import ThingLimits
from tests.bridging.thing_server import ThingServer, reply
from tests.bridging.wot.bridged import HASTY, active, bridging, written
from tests.sdk.living import LivingStage, until

Start = Callable[[], ThingServer]


def test_a_thing_lives_as_long_as_it_answers(
    thing_server: Callable[[int], ThingServer], living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server(0)
    server.values["/on"] = True
    with bridging(living, tmp_path / "ads", written(tmp_path, server.describe())) as found:
        assert until(lambda: found.lives("lamp"))
        server.close()
        assert until(lambda: not found.lives("lamp"))
        assert found.complained("lamp: GET http")
        again = thing_server(server.port)
        again.values["/on"] = True
        assert until(lambda: found.lives("lamp"))


def test_a_thing_of_many_outputs_that_has_gone_is_a_sentence_or_two(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server, names = thing_server(), [f"on{number}" for number in range(12)]
    server.values.update({f"/{name}": True for name in names})
    properties = {name: {"@type": "rob:Switch", "readOnly": True, "forms": [{"href": name}]} for name in names}
    with bridging(living, tmp_path / "ads", written(tmp_path, server.describe(properties=properties))) as found:
        active(found)
        assert until(lambda: {one.path for one in server.received} == {f"/{name}" for name in names})
        server.close()
        assert until(lambda: not found.lives("lamp"))
        assert 1 <= sum("does not answer" in one for one in found.complaints) <= 2, found.complaints


def test_another_reason_for_which_a_thing_does_not_answer_is_news(
    thing_server: Callable[[int], ThingServer], living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server(0)
    server.close()
    source = written(tmp_path, server.describe(base=server.url.replace("http:", "https:") + "/"))
    with bridging(living, tmp_path / "ads", source) as found:
        assert until(lambda: found.complained("does not answer: Connection refused"))
        thing_server(server.port)
        assert until(lambda: found.complained("does not answer: there is no TLS to speak with it"))


def test_a_thing_without_anything_to_read_is_there_while_it_listens(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server()
    description = server.describe(properties={}, actions={"blink": {"forms": [{"href": "blink"}]}})
    with bridging(living, tmp_path / "ads", written(tmp_path, description)) as found:
        assert until(lambda: found.lives("lamp"))
        assert server.received == []
        server.close()
        assert until(lambda: not found.lives("lamp"))


@pytest.mark.slow
def test_a_thing_that_is_slow_is_a_sentence_and_holds_up_nobody(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    good, slow = thing_server(), thing_server()
    good.values["/on"] = True
    slow.answers["/on"] = slow.say_nothing
    source = written(tmp_path, slow.describe("slow"), good.describe("fine"))
    hasty = replace(HASTY, limits=ThingLimits(answer=2.0))
    with bridging(living, tmp_path / "ads", source, settings=hasty) as found:
        assert until(lambda: found.lives("fine"))
        assert until(lambda: found.complained("slow: GET"))
        assert found.complained("has not answered in full within 2 s")
        assert not found.lives("slow")


def test_a_thing_that_answers_nonsense_is_complained_of_once(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server()
    numbers = itertools.count()
    server.answers["/on"] = lambda handler: reply(handler, f"nonsense {next(numbers)}".encode())
    with bridging(living, tmp_path / "ads", written(tmp_path, server.describe())) as found:
        assert until(lambda: len(server.received) > 20)
        assert sum("answers what is not JSON: b'nonsense 0'" in complaint for complaint in found.complaints) == 1
        assert len(found.complaints) == 1


def test_a_component_that_lives_elsewhere_is_left_to_live(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server()
    server.values["/on"] = True
    source = written(tmp_path, server.describe())
    with bridging(living, tmp_path / "one", source) as first:
        assert until(lambda: first.lives("lamp"))
        with bridging(living, tmp_path / "two", source) as second:
            assert until(lambda: second.complained("urn:thing:lamp is alive already"))
        assert first.lives("lamp")


@pytest.mark.slow
def test_a_thing_that_is_lost_again_and_again_waits_longer_each_time(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server()
    server.values["/on"] = True
    server.answers["/bad"] = lambda handler: reply(handler, b"<html>", media="text/html")
    properties = {name: {"forms": [{"href": name}], "readOnly": True} for name in ("on", "bad")}
    settings = replace(HASTY, look=0.1, longest_wait=60.0)
    source = written(tmp_path, server.describe(properties=properties))
    waits = []
    with bridging(living, tmp_path / "ads", source, settings=settings) as found:
        for times in range(1, 6):
            assert until(lambda: found.lives("lamp"))
            answers = living.apply("urn:thing:lamp")
            assert until(lambda: answers)  # noqa: B023 - it is waited for in this turn
            assert until(lambda: len(found.causes()) == times)  # noqa: B023 - as above
            began = time.monotonic()
            assert until(lambda: not found.lives("lamp"))
            assert until(lambda: found.lives("lamp"))
            waits.append(time.monotonic() - began)
    assert waits[-1] >= 1.0  # 1.6 after the fifth time, less what a busy machine took to see that it was lost
    assert waits[0] < waits[-1]
