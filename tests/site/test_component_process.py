"""What a site knows of one process: whose lives are its own, whether any of its components lives, and what is wrong."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from selfconf.bus.memory import Network
from selfconf.model.profile import Profile
from selfconf.protocol.messages import Cause
from selfconf.site.component_process import MOST_WATCHED, ComponentProcess
from selfconf.site.life_watch import FROZEN, WITHOUT_LIFE
from selfconf.site.process_group import ProcessGroup
from selfconf.termination import stopped
from tests.lab import iri
from tests.site.served import KEYS, until

pytestmark = pytest.mark.process
LEFT, RIGHT = iri("left"), iri("right")


@pytest.fixture
def process(network: Network, tmp_path: Path) -> Iterator[ComponentProcess]:
    """A process of two components that waits."""
    group = ProcessGroup((sys.executable, "-c", "import signal; signal.pause()"), tmp_path, {})
    for _, pipe in group.pipes():
        os.close(pipe)
    made = ComponentProcess(network.node(), KEYS, group, "given")
    made.follow((Profile(LEFT), Profile(RIGHT)))
    yield made
    made.close()
    group.kill()
    assert group.wait(10.0)


def test_of_a_process_are_the_lives_of_the_name_that_it_was_given_and_such_as_its_components_have_chosen(
    network: Network, process: ComponentProcess
) -> None:
    assert process.is_life(LEFT, "given")
    assert not process.lived
    end_life = network.node().announce(KEYS.life(LEFT, "chosen"))
    network.run(lambda: False, 0.1)
    assert process.is_life(LEFT, "chosen")
    assert not process.is_life(RIGHT, "chosen")
    assert process.lived
    assert (process.last_life(LEFT), process.last_life(RIGHT)) == ("chosen", "")
    end_life()
    network.run(lambda: False, 0.1)
    assert not process.is_life(LEFT, "chosen")
    assert process.was_life("chosen")
    assert not process.was_life("another")


def test_of_a_process_that_is_gone_it_is_still_known_which_lives_it_had(
    network: Network, process: ComponentProcess
) -> None:
    node = network.node()
    node.announce(KEYS.life(LEFT, "chosen"))
    network.run(lambda: False, 0.1)
    process.close()
    assert process.was_life("chosen")
    assert process.lived
    assert not process.is_life(LEFT, "chosen"), "what has this life is another process"
    node.announce(KEYS.life(RIGHT, "later"))
    network.run(lambda: False, 0.1)
    assert not process.was_life("later")


def test_one_living_component_is_enough_and_without_one_the_process_has_some_time(
    network: Network, process: ComponentProcess
) -> None:
    end_life = network.node().announce(KEYS.life(RIGHT, "chosen"))
    network.run(lambda: False, WITHOUT_LIFE + 1.0)
    trouble = process.trouble()
    assert trouble is not None
    assert trouble[0] is Cause.HUNG, "it announces a life, and answers no question"
    end_life()
    network.run(lambda: False, WITHOUT_LIFE - 1.0)
    cause, sentence = process.trouble() or (None, "")
    assert cause is Cause.CRASH
    assert "has had no life" in sentence


def test_a_frozen_process_without_a_life_is_in_trouble_soon(network: Network, process: ComponentProcess) -> None:
    network.run(lambda: False, FROZEN + 1.0)
    assert process.trouble() is None
    process.group._send(signal.SIGSTOP)
    assert until(lambda: stopped(process.group.number))
    cause, sentence = process.trouble() or (None, "")
    assert cause is Cause.CRASH
    assert "frozen" in sentence


def test_of_many_components_of_a_process_only_some_are_followed(network: Network, process: ComponentProcess) -> None:
    names = [iri(f"lamp-{number}") for number in range(2 * MOST_WATCHED)]
    process.follow(map(Profile, names))
    for name in names:
        network.node().announce(KEYS.life(name, f"life of {name.short}"))
    network.run(lambda: False, 0.1)
    followed = [name for name in names if process.last_life(name)]
    assert followed == names[: MOST_WATCHED - 2]
