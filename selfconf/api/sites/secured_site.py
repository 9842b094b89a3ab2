"""The keys of a site: its certificate, the rules of its hub, and certificates for the components that it starts."""

from __future__ import annotations

import secrets
from collections.abc import Callable, Mapping
from pathlib import Path

from selfconf import this_machine
from selfconf.access import (
    AccessRules,
    Doorkeeper,
    GuardedHub,
    HostAuthority,
    Principal,
    PrincipalKind,
    SiteIdentity,
    believed,
    first_rules,
    introduce,
    open_keys,
)
from selfconf.api.sites.joining import Joining
from selfconf.bus.port import Bus
from selfconf.bus.zenoh import Security, hear_refusals
from selfconf.errors import AuthorError
from selfconf.model.immutable import replace
from selfconf.model.setting_names import setting
from selfconf.model.term import IRI
from selfconf.site import Shelf, Site, programs_of


class SecuredSite:
    """A site that has keys."""

    def __init__(self, keys: Path, name: str | None) -> None:
        """Raises AuthorError for keys that are none, or of another holder than a site of that name, and NetworkError.

        From now on, what Zenoh logs is read: it must be made before any session is opened.
        """
        self._folder = open_keys(keys)
        wanted = name or f"s{secrets.token_hex(3)}"  # only an authority can choose
        self._credentials = self._folder.credentials((PrincipalKind.SITE,), wanted)
        self.name = self._credentials.name.partition(".")[2]
        """The name of the site, as its certificate has it."""
        if name is not None and name != self.name:
            raise AuthorError(
                f"{keys} is for the site {self.name}, not for {name}; give {setting('name', self.name)}, or no name"
            )
        self._host = HostAuthority(self._folder)
        self._host.share(this_machine.made_runtime_folder())
        self._credentials = replace(self._credentials, authorities=self._host.hub_authorities())
        self._refusals = hear_refusals()
        self._first = AccessRules(())
        self._programs: Callable[[], Mapping[IRI, IRI]] = dict

    def first(self, ecology: str, name: str, shelf: Shelf) -> Security:
        """How its hub is secured to begin with: with the rules that follow from what this site knows by itself."""
        shelf.refresh()
        programs = programs_of(one.profile for one in shelf.advertisements.values())
        self._first = first_rules(ecology, name, self._folder, programs)
        return self._security(self._first)

    def _security(self, rules: AccessRules) -> Security:
        return Security(self._credentials, rules.access_control(), rules.access_control(at_uplinks=True))

    def introduce(self, bus: Bus, ecology: str) -> None:
        """Show the certificate of the site to the one that relays on this host. Raises NetworkError."""
        introduce(bus, ecology, self._credentials)

    def keys_of(self, program: IRI) -> Path:
        """The folder of keys of a process that this site starts, by the component that stands for it."""
        sharing = sorted(c for c, first in self._programs().items() if first == program and c != program)
        return self._host.component(Principal.component(program), [Principal.component(c) for c in sharing])

    def believed(self) -> Mapping[IRI, str]:
        """The site of each component, for tasks of this site: its own are its own, unless a person says otherwise.

        Raises AuthorError.
        """
        return {**dict.fromkeys(self._programs(), self.name), **believed(self._folder.path)}

    def keep_door(
        self, site: Site, joining: Joining, complain: Callable[[str], None], distrusted: Callable[[], None]
    ) -> None:
        """From now on, let in clients that show a good certificate, and renew what expires.

        `distrusted` is to end the site: it is called as soon as its own certificate was revoked, and again each second.
        """
        self._programs = lambda: site.programs
        ecology = site.keys.ecology
        identity = SiteIdentity(ecology, site.name, self._folder, self._credentials, own=self._programs)
        hub = GuardedHub(
            self._first,
            relays=lambda: joining.relays,
            sites=this_machine.LocalSiteNames(ecology),
            open_anew=lambda rules: joining.secure(self._security(rules)),
            distrusted=distrusted,
            refusals=self._refusals,
        )
        Doorkeeper(site.bus, identity, hub, complain)
