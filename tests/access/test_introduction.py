"""A program shows its certificate until the sites know it; the sites of these tests answer on a bus in memory."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.access import Authority, PrincipalKind
from selfconf.access.introduction import ROUNDS, introduce
from selfconf.bus.memory import Network
from selfconf.bus.port import Request
from selfconf.errors import NetworkError
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Introduction


@pytest.fixture
def folder(tmp_path: Path) -> Authority:
    """The folder of an authority."""
    return Authority.init(tmp_path / "keys")


class Door:
    """A site that knows who has shown a certificate often enough, or lets nobody in."""

    def __init__(
        self,
        network: Network,
        known_after: int = 1,
        refuses: str = "",
        beside: tuple[str, ...] = (),
        name: str = "home",
    ) -> None:
        self.shown: list[str] = []
        self._known_after, self._refuses, self._beside = known_after, refuses, beside
        self._key = Keys("lab").introduce(name)
        network.node().serve(self._key, self.answer)

    def answer(self, request: Request) -> None:
        """Answer an introduction."""
        self.shown.append(decode(request.payload, Introduction).certificate)
        if self._refuses:
            request.refuse(self._refuses)
        else:
            known = len(self.shown) > self._known_after
            request.reply(self._key, encode(Introduction("mine", known, self._beside)))
        request.finish()


@pytest.mark.parametrize("known_after", [0, 1, 3])
def test_a_certificate_is_shown_until_it_is_known(known_after: int, folder: Authority) -> None:
    network = Network(1)
    door, mine = Door(network, known_after), folder.credentials((PrincipalKind.READER,))
    introduce(network.node(), "lab", mine)
    assert door.shown == [mine.certificate.read_text()] * (known_after + 1)


def test_a_site_of_the_same_host_that_has_lost_its_hub_for_a_moment_is_waited_for(folder: Authority) -> None:
    network = Network(1)
    first, mine, seen = Door(network, known_after=0, beside=("home", "attic")), network.node(), []
    attic = Keys("lab").introduce("attic")

    def answer(request: Request) -> None:
        seen.append(len(first.shown))
        request.reply(attic, encode(Introduction("its own", True)))
        request.finish()

    mine.later(0.3, lambda: network.node().serve(attic, answer))
    introduce(mine, "lab", folder.credentials((PrincipalKind.READER,)))
    assert seen
    assert 1 < seen[-1] < ROUNDS


def test_who_is_not_let_in_hears_why(folder: Authority) -> None:
    network = Network(1)
    Door(network, refuses="it was revoked")
    with pytest.raises(NetworkError, match=r"read.main is not let in: it was revoked"):
        introduce(network.node(), "lab", folder.credentials((PrincipalKind.READER,)))


def test_one_site_that_lets_it_in_is_enough(folder: Authority) -> None:
    network = Network(1)
    doors = Door(network, known_after=0), Door(network, refuses="it was revoked", name="attic")
    introduce(network.node(), "lab", folder.credentials((PrincipalKind.READER,)))
    assert [len(door.shown) for door in doors] == [1, 1]


def test_it_is_shown_until_all_sites_know_it(folder: Authority) -> None:
    network = Network(1)
    first, second = Door(network, known_after=0), Door(network, known_after=2, name="attic")
    introduce(network.node(), "lab", folder.credentials((PrincipalKind.READER,)))
    assert len(first.shown) == len(second.shown) == 3


def test_it_is_not_shown_for_ever(folder: Authority) -> None:
    network = Network(1)
    door = Door(network, known_after=100)
    introduce(network.node(), "lab", folder.credentials((PrincipalKind.READER,)))
    assert len(door.shown) == ROUNDS


def test_a_site_that_does_not_answer_yet_is_waited_for(folder: Authority) -> None:
    """Its hub is opened anew, for example."""
    network = Network(1)
    mine, doors = network.node(), list[Door]()
    mine.later(0.3, lambda: doors.append(Door(network, known_after=0)))
    introduce(mine, "lab", folder.credentials((PrincipalKind.READER,)))
    (door,) = doors
    assert len(door.shown) == 1


def test_nobody_need_answer(folder: Authority) -> None:
    introduce(Network(1).node(), "lab", folder.credentials((PrincipalKind.READER,)))
