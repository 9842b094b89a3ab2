"""A doorkeeper on a bus in memory, and what it does."""

from __future__ import annotations

from selfconf.access import (
    AccessRules,
    Authority,
    Certificate,
    Doorkeeper,
    GuardedHub,
    KeysFolder,
    PrincipalKind,
    SiteIdentity,
    first_rules,
)
from selfconf.bus.memory import Network
from selfconf.bus.port import Replies
from selfconf.bus.zenoh import RefusalLog
from selfconf.errors import NetworkError
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Introduction

KEYS = Keys("lab")
LAMP, BELL = IRI("urn:lamp"), IRI("urn:bell")


class Door:
    """A doorkeeper of the site `home`, and what it does."""

    def __init__(self, folder: KeysFolder) -> None:
        self.network, self.folder = Network(1), folder
        self.bus = self.network.node()
        self.enforced: list[AccessRules] = []
        self.said: list[str] = []
        self.hub_opens = True
        self.sites = ["home"]
        self.refusals = RefusalLog(clock=lambda: 0.0)
        credentials = folder.credentials((PrincipalKind.SITE,), "home")
        self.own = {LAMP: LAMP}
        site = SiteIdentity("lab", "home", folder, credentials, own=lambda: self.own)
        hub = GuardedHub(
            first_rules("lab", "home", folder, {LAMP: LAMP}),
            relays=lambda: True,
            sites=lambda: self.sites,
            open_anew=self.open_anew,
            distrusted=lambda: self.said.append("it ends"),
            refusals=self.refusals,
        )
        self.keeper = Doorkeeper(self.bus, site, hub, self.said.append)
        self.other = self.network.node()

    def ask(self, key: str, payload: bytes = b"") -> Replies:
        """What is answered to somebody else."""
        heard: list[Replies] = []
        self.other.ask(key, payload, 5.0, heard.append)
        self.other.run(lambda: bool(heard))
        return heard[0]

    def open_anew(self, rules: AccessRules) -> None:
        """Open the hub with other rules."""
        self.enforced.append(rules)
        if not self.hub_opens:
            raise NetworkError("the port is in use")

    def introduce(self, certificate: str) -> Replies:
        """What is answered to who shows a certificate."""
        return self.ask(KEYS.introduce("home"), encode(Introduction(certificate)))

    def pass_time(self, seconds: float) -> None:
        """Let time pass."""
        until = self.bus.now() + seconds
        self.bus.run(lambda: self.bus.now() >= until)

    @property
    def principals(self) -> set[str]:
        """Who may do anything."""
        return {access.principal for access in self.keeper.rules.accesses}


class CountedReads(Authority):
    """A folder of keys that counts how often all who were let in are read."""

    reads = 0

    def admitted(self, ecology: str) -> dict[str, Certificate]:
        self.reads += 1
        return super().admitted(ecology)
