"""What a site with keys hears of what others advertise, on a bus in memory."""

from __future__ import annotations

from selfconf.access.other_sites import ASK_SITES_AGAIN, SITES_ANSWER, OtherSites
from selfconf.bus.memory import MemoryBus, Network
from selfconf.bus.port import Request
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Known, Page

KEYS = Keys("lab")
BELL, HORN, LAMP = (IRI(f"urn:{name}") for name in ("bell", "horn", "lamp"))


class Advertiser:
    """A site that replies what it advertises, in part where it is `cut`; the same as before with one page."""

    def __init__(self, bus: MemoryBus, name: str, *components: IRI, life: str = "1") -> None:
        self.name, self.components, self.life = name, components, life
        self.revision, self.cut, self.replied = 1, False, list[int]()
        bus.serve(KEYS.advertisements(name), self._answer)

    def change(self, *components: IRI) -> None:
        """Advertise others."""
        self.components, self.revision = components, self.revision + 1

    def _answer(self, request: Request) -> None:
        known = decode(request.payload, Known).revisions.get(f"{self.name}/{self.life}") == self.revision
        total = len(self.components)
        self.replied.append(1 if known else total)
        if known:
            page = encode(Page(0, total, self.revision, life=self.life))
            request.reply(KEYS.advertisements(self.name).replace("**", "none"), b"", page)
        for index, component in enumerate(() if known else self.components):
            page = encode(Page(index, total, self.revision, component, life=self.life))
            request.reply(KEYS.advertisement(self.name, component), b"", page)
            if self.cut:
                return  # what would follow is lost, and the end of the answer
        request.finish()


class Asker:
    """The site `home`, which asks the others of a network."""

    def __init__(self) -> None:
        self.network, self.times = Network(1), 0
        self.sites = OtherSites(self.network.node(), KEYS, "home", self._heard)

    def _heard(self) -> None:
        self.times += 1

    def ask(self) -> dict[str, frozenset[IRI]]:
        """What is known once the others have been asked."""
        self.sites.ask_soon.set()
        self.network.run(lambda: False, SITES_ANSWER + 0.5)
        return self.sites.advertised()


def test_each_other_site_is_known_by_what_it_advertises() -> None:
    asker = Asker()
    for name, components in (("attic", (BELL, HORN)), ("cellar", ()), ("home", (LAMP,))):
        Advertiser(asker.network.node(), name, *components)
    assert asker.ask() == {"attic": frozenset((BELL, HORN))}


def test_a_site_that_has_changed_nothing_is_known_on_and_says_only_that() -> None:
    asker = Asker()
    attic = Advertiser(asker.network.node(), "attic", BELL, HORN)
    assert asker.ask() == asker.ask() == {"attic": frozenset((BELL, HORN))}
    assert attic.replied == [2, 1]
    attic.change(BELL)
    assert asker.ask() == {"attic": frozenset((BELL,))}


def test_of_two_sites_of_one_name_what_both_advertise_counts() -> None:
    asker = Asker()
    Advertiser(asker.network.node(), "attic", BELL)
    Advertiser(asker.network.node(), "attic", HORN, life="2")
    assert asker.ask() == {"attic": frozenset((BELL, HORN))}


def test_what_a_site_replies_under_the_key_of_another_component_does_not_count() -> None:
    asker = Asker()

    def answer(request: Request) -> None:
        request.reply(KEYS.advertisement("attic", BELL), b"", encode(Page(0, 1, 1, HORN, life="1")))
        request.finish()

    asker.network.node().serve(KEYS.advertisements("attic"), answer)
    assert asker.ask() == {"attic": frozenset()}


def test_a_site_that_answers_in_part_is_known_by_what_it_did_before_and_is_asked_again() -> None:
    asker = Asker()
    attic = Advertiser(asker.network.node(), "attic", BELL)
    asker.ask()
    attic.change(HORN, BELL)
    attic.cut = True
    assert asker.ask() == {"attic": frozenset((BELL,))}
    attic.cut = False
    asker.network.run(lambda: False, ASK_SITES_AGAIN)
    assert asker.sites.advertised() == {"attic": frozenset((HORN, BELL))}


def test_changes_without_end_keep_none_from_being_asked_nor_have_it_asked_each_time() -> None:
    asker = Asker()
    strange = Advertiser(asker.network.node(), "strange")
    for _ in range(500):
        asker.sites.ask_soon.set()
        asker.network.run(lambda: False, 0.002)
    assert 2 <= len(strange.replied) <= 25
    assert 2 <= asker.times <= 25
