"""What a site says of the attempts that were refused at its hub: each once, and of many only some."""

from __future__ import annotations

from collections.abc import Callable

import pytest
import zenoh

from selfconf.access.refusal_reports import LOOKS, MOST_TOLD, RefusalReports
from selfconf.bus.memory import MemoryBus, Network
from selfconf.bus.zenoh import LONGEST_KEY, RefusalLog
from selfconf.protocol.keys import Keys

KEYS = Keys("lab")
NO_CERTIFICATE = "2126Z WARN acc-0 ThreadId(1) zenoh_link_tls::unicast: peer sent no certificates. Hint: x"


class Reports:
    """Reports of what a log says, and what was said."""

    def __init__(self) -> None:
        self.network = Network(1)
        self.bus, self.log, self.said = self.network.node(), RefusalLog(clock=lambda: 0.0), list[str]()
        self.allowed = set[str]()
        """The principals that may do what they try."""
        self.reports = RefusalReports(self.bus, self.log, self.said.append, lambda one: one.principal in self.allowed)

    def refuse(self, name: str, attempt: str, key: str) -> None:
        """Have the log say that a client may not do that."""
        line = "2126-01-01T00:00:00Z TRACE rx ThreadId(1) x: {}"
        peer = f"a1 on Interface(lo)+CertCommonName({name}) is unauthorized to {attempt} (ingress) on {key}"
        self.log.take(line.format(peer))
        self.log.take(line.format("Msg intercepted!"))

    def look(self, times: int) -> None:
        """Look so often, each time with time for an answer."""
        for _ in range(times):
            self.reports.look()
            self.bus.poll(5.0)


def test_an_attempt_is_told_of_once_and_not_before_it_has_stayed_refused() -> None:
    site = Reports()
    site.log.take(NO_CERTIFICATE)
    site.look(LOOKS - 1)
    assert site.said == []
    site.look(5)
    assert site.said == ["refused: a client without a trusted certificate: peer sent no certificates"]


def test_what_a_client_may_do_meanwhile_is_not_told_of() -> None:
    site = Reports()
    site.refuse("conf.bob", "Put", KEYS.fail("urn-lamp"))
    site.refuse("conf.eve", "Put", KEYS.fail("urn-lamp"))
    site.look(LOOKS - 1)
    site.allowed.add("conf.bob")
    assert [one.principal for one in site.reports.refused] == ["conf.eve"]
    site.look(5)
    assert [said.split(": ")[1] for said in site.said] == ["conf.eve"]


def test_a_site_that_passes_on_who_lives_is_not_complained_of() -> None:
    site = Reports()
    site.network.node().announce(KEYS.site_life("attic", "1"))
    for life in ("1", "0bad"):
        site.refuse("site.cellar", "Liveliness Token", KEYS.site_life("attic", life))
    site.look(LOOKS + 1)
    assert [one.key for one in site.log.refused] == [KEYS.site_life("attic", "0bad")]
    assert [said for said in site.said if KEYS.site_life("attic", "0bad") in said]
    assert not [said for said in site.said if KEYS.site_life("attic", "1") in said]


def test_a_life_whose_key_was_too_long_to_be_kept_hides_no_attempt(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its first characters may be no key: Zenoh would refuse the question for it."""
    site, call = Reports(), MemoryBus.roll_call

    def call_as_zenoh(bus: MemoryBus, key: str, seconds: float, done: Callable[[tuple[str, ...]], None]) -> None:
        zenoh.KeyExpr(key)
        call(bus, key, seconds, done)

    monkeypatch.setattr(MemoryBus, "roll_call", call_as_zenoh)
    site.refuse("comp.bell", "Liveliness Token", f"selfconf/{'x' * (LONGEST_KEY - 10)}/live/1")
    site.refuse("comp.lamp", "Put", "selfconf/lab/task/a")
    site.look(LOOKS)
    assert [said.split(": ")[1] for said in site.said] == ["comp.bell", "comp.lamp"]


def test_of_many_attempts_of_one_principal_only_some_are_told_of_in_a_minute() -> None:
    site = Reports()
    for number in range(3 * MOST_TOLD):
        site.reports.tell("conf.eve", f"attempt {number}", "")
    assert len(site.said) == MOST_TOLD
    site.reports.tell("conf.bob", "Put", "a/key")
    assert site.said[MOST_TOLD:] == ["refused: conf.bob: Put on a/key"]
    site.bus.poll(61.0)
    site.reports.tell("conf.eve", "Put", "a/key")
    assert site.said[MOST_TOLD + 1 :] == ["refused: conf.eve: Put on a/key"]
