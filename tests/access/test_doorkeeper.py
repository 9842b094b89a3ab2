"""The doorkeeper of a site, on a bus in memory: it learns what sites advertise, and has its rules follow."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.access import Authority, Principal, PrincipalKind, believe
from selfconf.access.doorkeeper import GONE_AFTER, INTRODUCE_AGAIN, LOOK_AT_ALL
from selfconf.bus.memory import MemoryBus
from selfconf.bus.port import Request, Urgency
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.messages import Access, Introduction, Page, RefusedAttempt
from tests.access.door import BELL, KEYS, LAMP, CountedReads, Door


def advertise(door: Door, site: str, *components: IRI) -> MemoryBus:
    """Another site, that has shown its certificate and advertises some components."""
    bus = door.network.node()

    def answer(request: Request) -> None:
        for index, component in enumerate(components):
            page = Page(index, len(components), 1, component, life="1")
            request.reply(KEYS.advertisement(site, component), b"", encode(page))
        request.finish()

    bus.serve(KEYS.advertisements(site), answer)
    bus.announce(KEYS.site_life(site, "1"))
    shown = door.folder.credentials((PrincipalKind.SITE,), site).certificate
    bus.ask(KEYS.introduce("home"), encode(Introduction(shown.read_text())), 5.0, lambda replies: None)
    door.pass_time(2.0)
    return bus


def vouched(door: Door, site: str) -> set[str]:
    """The components that another site may speak for."""
    return {c for access in door.keeper.rules.accesses if access.principal == f"site.{site}" for c in access.about}


def test_another_site_speaks_for_what_it_advertises(door: Door) -> None:
    advertise(door, "attic", BELL)
    assert vouched(door, "attic") == {Principal.component(BELL).name}


def test_another_site_of_the_host_hears_what_third_sites_say(door: Door) -> None:
    """It has no other hub, and may keep a task of which components live at a third site of the host."""
    bus = advertise(door, "attic", BELL)
    (attic,) = (access for access in door.keeper.rules.accesses if access.principal == "site.attic")
    assert attic.told
    door.sites.append("attic")
    bus.announce(KEYS.site_life("attic", "2"))
    door.pass_time(1.0)
    (attic,) = (access for access in door.keeper.rules.accesses if access.principal == "site.attic")
    assert not attic.told, "all that it hears"


def test_what_the_site_itself_advertises_anew_is_in_its_rules_at_once(door: Door) -> None:
    changed = door.network.node().publisher(KEYS.changed("home"), Urgency.EVENT)
    door.own[BELL] = BELL
    changed.put(b"")
    door.pass_time(1.0)
    assert Principal.component(BELL).common_name in door.principals
    del door.own[BELL]
    changed.put(b"")
    door.pass_time(1.0)
    assert Principal.component(BELL).common_name not in door.principals


def test_a_site_whose_advertisements_stay_costs_no_new_rules(tmp_path: Path) -> None:
    folder = CountedReads(Authority.init(tmp_path / "keys").path)
    door = Door(folder)
    bus = advertise(door, "attic", BELL)
    before = folder.reads
    for number in range(20):
        end = bus.announce(KEYS.site_life("attic", f"2{number}"))
        door.pass_time(0.2)
        end()
        door.pass_time(0.2)
    assert folder.reads - before <= 4, "those of the looks from time to time"


def test_what_two_sites_advertise_is_nobodys_until_somebody_says_whose(door: Door) -> None:
    advertise(door, "attic", BELL)
    advertise(door, "cellar", BELL)
    assert vouched(door, "attic") == vouched(door, "cellar") == set()
    assert [said for said in door.said if "urn:bell is advertised by the sites attic and cellar" in said]
    believe(door.folder.path, BELL, "cellar")
    door.pass_time(2.0)
    assert vouched(door, "attic") == set()
    assert vouched(door, "cellar") == {Principal.component(BELL).name}


def test_a_site_that_is_revoked_has_no_say_in_whose_a_component_is(door: Door) -> None:
    advertise(door, "attic", BELL)
    advertise(door, "cellar", BELL)
    assert vouched(door, "cellar") == set()
    reader = door.folder.credentials((PrincipalKind.READER,), "attic").certificate
    door.folder.admit("lab", reader.read_bytes())  # its name says nothing of the site
    door.folder.revoke(Principal(PrincipalKind.SITE, "attic"))
    door.pass_time(2.0)
    assert {"read.attic", "site.attic"} & door.principals == {"read.attic"}
    assert vouched(door, "cellar") == {Principal.component(BELL).name}


def test_what_a_site_has_advertised_that_is_gone_is_that_of_the_one_that_advertises_it_now(door: Door) -> None:
    advertise(door, "attic", BELL).close()
    advertise(door, "cellar", BELL)
    assert vouched(door, "cellar") == set(), "only the way to the other one may be gone, for a moment"
    door.pass_time(GONE_AFTER + LOOK_AT_ALL)
    assert vouched(door, "cellar") == {Principal.component(BELL).name}
    assert not [said for said in door.said if "is advertised by the sites" in said]
    advertise(door, "attic", BELL)
    assert vouched(door, "attic") == vouched(door, "cellar") == set()
    assert [said for said in door.said if "urn:bell is advertised by the sites attic and cellar" in said]


def test_what_is_believed_to_be_that_of_a_site_that_was_not_seen_yet_is_no_others(door: Door) -> None:
    believe(door.folder.path, BELL, "attic")
    advertise(door, "cellar", BELL)
    assert vouched(door, "cellar") == set()
    assert [said for said in door.said if "urn:bell is advertised by the site cellar, and believed to be" in said]
    advertise(door, "attic", BELL)
    assert vouched(door, "attic") == {Principal.component(BELL).name}


def test_a_site_goes_on_with_its_own(door: Door) -> None:
    advertise(door, "attic", LAMP)
    assert vouched(door, "attic") == set()
    assert Principal.component(LAMP).common_name in door.principals
    assert door.said


def test_what_was_refused_is_told_once_and_shown_to_who_asks(door: Door) -> None:
    for _ in range(3):
        door.refusals.take("2126Z WARN acc-0 ThreadId(1) zenoh_link_tls::unicast: peer sent no certificates. Hint: x")
    door.pass_time(10.0)
    assert door.said == ["refused: a client without a trusted certificate: peer sent no certificates"]
    replies = door.ask(KEYS.access("home"))
    shown = [decode(sample.payload, RefusedAttempt) for sample in replies.samples if b"refused" in sample.payload[:40]]
    assert [(one.principal, one.number) for one in shown] == [("", 3)]
    rules = [decode(sample.payload, Access) for sample in replies.samples if b"access" in sample.payload[:40]]
    assert tuple(rules) == door.keeper.rules.accesses


@pytest.mark.parametrize("answer", ["knows", "does not know", "refuses", "does not finish"])
def test_a_site_shows_its_certificate_seldom_once_all_others_know_it_and_often_before(door: Door, answer: str) -> None:
    shown: list[float] = []
    attic, key = door.network.node(), KEYS.introduce("attic")
    own = door.folder.credentials((PrincipalKind.SITE,), "attic").certificate.read_text()

    def hear(request: Request) -> None:
        shown.append(attic.now())
        if answer == "refuses":
            request.refuse("it cannot read its keys")
        else:
            request.reply(key, encode(Introduction(own, answer != "does not know")))
        if answer != "does not finish":
            request.finish()

    attic.serve(key, hear)
    door.pass_time(INTRODUCE_AGAIN)  # as a site begins it shows it more often
    shown.clear()
    door.pass_time(4 * INTRODUCE_AGAIN)
    assert len(shown) == (0 if answer == "knows" else 4)


def test_a_site_that_is_revoked_ends(door: Door) -> None:
    door.folder.revoke(Principal(PrincipalKind.SITE, "home"))
    door.pass_time(1.5)
    assert door.said[-1] == "it ends"


def test_what_a_site_says_for_its_components_before_these_are_known_is_no_attempt(door: Door) -> None:
    bus = advertise(door, "attic")
    for component in (BELL, LAMP):
        line = "2126-01-01T00:00:00Z TRACE rx ThreadId(1) x: {}"
        key = KEYS.outputs(component)
        peer = "a1 on Interface(lo)+CertCommonName(site.attic) is unauthorized to Declare Queryable (ingress) on"
        door.refusals.take(line.format(f"{peer} {key}"))
        door.refusals.take(line.format("Msg intercepted!"))
    bus.close()
    advertise(door, "attic", BELL)
    door.pass_time(5.0)
    assert [said for said in door.said if "refused" in said] == [
        f"refused: site.attic: Declare Queryable on {KEYS.outputs(LAMP)}"
    ]


def test_a_folder_in_which_nothing_changes_is_read_seldom_and_at_once_when_something_does(tmp_path: Path) -> None:
    authority = Authority.init(tmp_path / "keys")
    folder = CountedReads(authority.path)
    door = Door(folder)
    door.pass_time(5.0)
    before = folder.reads
    door.pass_time(3.0 * LOOK_AT_ALL)
    assert 2 <= folder.reads - before <= 4
    bob = authority.issue(Principal(PrincipalKind.CONFIGURATOR, "bob"), tmp_path / "bob")
    authority.admit("lab", bob.pem)  # as another site of this host does
    door.pass_time(1.5)
    assert "conf.bob" in door.principals
