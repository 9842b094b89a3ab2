"""How a site joins its ecology: as the one that relays on its machine, or as a client of that one.

The first site of an ecology on a machine relays, on a usual port; all others there are its clients. When it is gone, a
site that has lost it takes its place, on the same port if that is free. So a machine is one router to the others,
however many sites it has, and there is a router as long as there is a site. (Fifty routers that see each other come and
go cost two processors and do not recover from a common stall; fifty clients of one cost a twentieth of a processor.)

A site with an endpoint of its own, or that connects to another machine, relays beside the others.

A relay may hang. A site that has had no hub for long takes its place on another port, and writes into its file that it
relays no more; `hub_wait` says how long.

The usual ports of two ecologies may overlap. Then a site that has lost its hub may find that of the other ecology:
that passes on what is said in this one as well, but it is not where programs look for this one. So a site takes the
place all the same while no site of its ecology relays, and connects its own hub to the other.

A hub may break inside while its process goes on (`hub_health`). So a site that relays asks its own hub, again and
again, and opens another one when it does not answer. The others ask theirs, more seldom, and cut the connection to one
that does not, so that it is made anew.
"""

from __future__ import annotations

import logging
import os
import random
import socket
from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from selfconf import rendezvous, this_machine
from selfconf.api.sites.announced_site import AnnouncedSite
from selfconf.api.sites.hub_health import HubHealth
from selfconf.api.sites.hub_wait import HubWait
from selfconf.bus.timer import Timer
from selfconf.bus.zenoh import Hub, Security, ZenohBus, client, cut_connections, listens, router
from selfconf.errors import NetworkError
from selfconf.protocol.endpoints import endpoint_host, endpoint_port
from selfconf.protocol.keys import Keys
from selfconf.this_machine import LocalSite

log = logging.getLogger(__name__)

HASTE = 0.05
"""Seconds within which, by chance, a site that has lost its hub looks whether there is a place to take."""
LOOK_AGAIN = 0.2
"""Seconds after which a site that still has no hub looks again."""
NAMESAKE = 1.0
"""Seconds that the network may take to say whether another site has the same name."""
MEETING = 0.6
"""Seconds that it may take to see the sites of other hosts after connecting to them."""
STILL_MINE = 1.0
"""How often, in seconds, a site that relays looks whether another has taken its place."""
STILL_HEARD = 6
"""After how many times as long a site that does not relay looks again whether its hub answers."""


class Joining:
    """The bus of one site, and its part in relaying."""

    def __init__(
        self,
        ecology: str,
        name: str,
        listen: str | None,
        connect: Sequence[str],
        security: Security | None = None,
    ) -> None:
        """Opens the bus, in a turn (`this_machine.turn`). Raises NetworkError."""
        self._ecology, self._name, self._security = ecology, name, security
        self._usual = rendezvous.usual_endpoints(ecology, secure=security is not None)
        hubs = self._other_hubs()
        self._elsewhere = [endpoint for endpoint in connect if endpoint not in (*hubs, *self._usual)]
        self.bus = self._opened(listen, hubs)
        self._reached_at = hubs[0] if hubs else ""
        self._file = AnnouncedSite(self._described)
        self._log = ""
        self.served: Sequence[str] = ()
        """The files and folders with what the site advertises, for others on this machine."""
        # With keys a hub has an endpoint for its own host, too.
        self._hub_wait = HubWait(self.bus.now, hubs, endpoints_each=1 if security is None else 2)
        self._next_look = Timer(self.bus, LOOK_AGAIN, self._look)
        self._hub_health = HubHealth(self.bus, Keys(ecology).site_life(name, "*"), self._hub_is_broken)
        self.bus.watch_link(self._link_changed)
        self.bus.later(STILL_MINE, self._look_from_time_to_time)

    @property
    def endpoint(self) -> str:
        """Where the site is reached."""
        return self.bus.endpoint or self._reached_at

    @property
    def relays(self) -> bool:
        """Whether others are connected to a hub of this site."""
        return bool(self.bus.endpoint)

    @property
    def endpoints(self) -> list[str]:
        """Where a component of this site looks for a hub: where the site is reached first."""
        from_here = [self.bus.from_here] if self.relays else self._from_here()
        return list(dict.fromkeys([*from_here, self.endpoint, *self._usual]))

    @property
    def reaches_others(self) -> bool:
        """Whether this site is to connect to sites of other hosts."""
        return bool(self._elsewhere)

    def unanswered(self) -> list[str]:
        """The endpoints of other hosts at which nothing answers. It takes time; on any thread."""
        if not self.relays:
            return []
        linked = {(endpoint_host(one), endpoint_port(one)) for one in self.bus.reached}
        with_port = (one for one in self._elsewhere if endpoint_port(one) is not None)
        return [one for one in with_port if linked.isdisjoint(_addresses(one)) and not listens(one)]

    def namesake(self) -> str:
        """The life of another site of this name, if one is seen in the ecology; empty if not."""
        deadline = self.bus.now() + (MEETING if self._elsewhere else 0.0)  # over an uplink others are seen only later
        while not (lives := self._lives_of_name()) and self.bus.now() < deadline:
            self.bus.poll(0.05)
        return lives[0].rpartition("/")[2] if lives else ""

    def _lives_of_name(self) -> tuple[str, ...]:
        heard: list[tuple[str, ...]] = []
        self.bus.roll_call(Keys(self._ecology).site_life(self._name, "*"), NAMESAKE, heard.append)
        deadline = self.bus.now() + 2 * NAMESAKE
        self.bus.run(lambda: bool(heard) or self.bus.now() > deadline)
        return heard[0] if heard else ()

    def _described(self) -> LocalSite:
        """The site, as its file has it."""
        return LocalSite(
            self._ecology,
            self._name,
            self.endpoint,
            os.getpid(),
            relays=self.relays,
            log=self._log,
            from_here=self.bus.from_here,
            served=self.served,
        )

    def announce(self, log: Path, served: Iterable[Path]) -> None:
        """Write down for others on this machine where this site is reached, its log, and what it serves.

        Raises NetworkError.
        """
        self._log, self.served = str(log), [str(path.resolve()) for path in served]
        self._file.write()

    @contextmanager
    def _turn(self) -> Iterator[bool]:
        """A turn of this site, if it can be had at once; the value says whether it is."""
        with ExitStack() as stack:
            try:
                mine = stack.enter_context(this_machine.turn(seconds=0.0))
            except NetworkError as error:
                self._file.complain(error)
                mine = False
            yield mine

    def secure(self, security: Security) -> None:
        """Have other rules, or another certificate, as long as this site relays, and whenever it does.

        Raises NetworkError.
        """
        self._security = security
        self.bus.secure(security)

    def leave(self) -> None:
        """Take back what was written down."""
        self._file.remove()

    def _relaying(self) -> list[LocalSite]:
        """The other sites of this machine that relay."""
        return [site for site in this_machine.relaying_sites(self._ecology) if site.site != self._name]

    def _other_hubs(self) -> list[str]:
        """Where their hubs are reached."""
        return _reached_at(self._relaying())

    def _from_here(self) -> list[str]:
        """Where the sites of this machine that relay are reached by their own host."""
        return [site.from_here for site in this_machine.relaying_sites(self._ecology) if site.from_here]

    def _opened(self, listen: str | None, hubs: list[str]) -> ZenohBus:
        connect = [*hubs, *self._elsewhere]
        if listen is not None:
            return router(listen, [*connect, *(self._usual if hubs else ())], security=self._security)
        if hubs and not self._elsewhere:
            try:
                own = None if self._security is None else self._security.credentials
                return client(list(dict.fromkeys([*self._from_here(), *hubs, *self._usual])), credentials=own)
            except NetworkError:  # those that relay hang
                pass
        for endpoint in self._usual:
            try:
                return router(endpoint, connect, self._usual, self._security)
            except NetworkError:  # the port is taken
                continue
        anywhere = self._usual[0].rpartition(":")[0] + ":0"
        return router(anywhere, connect, self._usual, self._security)

    # The one that relays may be gone, or it was stopped and another has taken its place.

    def _link_changed(self) -> None:
        if self.bus.link:
            self._reached()
        else:
            self._hub_wait.begin()
        self._next_look.reset(random.uniform(0.0, HASTE))

    def _reached(self) -> None:
        """There is a hub; where it is one that has begun since, say so, or others would try the one before first."""
        hubs = self._other_hubs()
        self._hub_wait.end(hubs)
        if self._file.is_there and not self.relays and hubs and self._reached_at not in hubs:
            self._reached_at = hubs[0]
            self._file.write_again()

    def _look_from_time_to_time(self) -> None:
        self.bus.later(STILL_MINE * (1 if self.relays else STILL_HEARD), self._look_from_time_to_time)
        if not self._file.is_there:
            return
        if self._file.is_lost:
            self._file.write_again()
        # It may have lost its hub before it was announced, and looked in vain. Whether others relay is not looked at:
        # of many sites each would read the files of all.
        if self._is_replaced() or not (self.relays or self.bus.link):
            self._next_look.stop()
            self._look()
        elif self.bus.link or (self.relays and self._hub_wait.is_over(suspended=False)):
            self._hub_health.ask()

    def _hub_is_broken(self) -> None:
        if self.relays:
            self._replace_hub()
        else:
            self._connect_anew()

    def _connect_anew(self) -> None:
        """Cut the connection to a hub that is there, but seems to answer nothing; the bus makes another one."""
        log.error("nothing is heard from the hub; connecting to it anew")
        for endpoint in dict.fromkeys([self._reached_at, *self._other_hubs(), *self._usual, *self._elsewhere]):
            cut_connections(endpoint, from_here=True)

    def _replace_hub(self) -> None:
        """Open another hub in the place of one that has broken: where that was, if it lets go of its port."""
        if not self._is_believed():
            return
        before = self.bus.endpoint
        log.error("the hub at %s does not answer; opening another one", before)
        with self._turn() as mine:
            if mine:
                self.bus.relay_no_more()
                self._relay_at(list(dict.fromkeys((before, *self._usual))), self._other_hubs())

    def _look(self) -> None:
        if not self._file.is_there:
            return
        if not self.bus.link:
            self._hub_wait.begin()  # when the change was reported, it was not lost yet
        done = self._in_order() or self._looked_in_turn()
        if not done or not self.bus.link:
            self._next_look.set()

    def _in_order(self) -> bool:
        """Whether there is nothing to change; a turn is not taken then, as one that is stopped in it keeps it."""
        return not (self._is_replaced() if self.relays else self._lacks_hub())

    def _is_replaced(self) -> bool:
        """Whether this site relays, and another has written into its file that it does not, as it has its place."""
        return self.relays and self._file.is_overruled

    def _lacks_hub(self) -> bool:
        """Whether this site is connected to no hub of its ecology: to none, or while no site of this machine relays."""
        return not (self.bus.link and self._other_hubs())

    def _looked_in_turn(self) -> bool:
        """Give or take the place of the one that relays, if it is this site's turn; whether it was."""
        with self._turn() as mine:
            if mine and self.relays:
                self._give_place()
            elif mine and self._lacks_hub():
                self._take_place()
        return mine

    def _give_place(self) -> None:
        """Relay no more, if another site has taken the place meanwhile."""
        if self._is_replaced():
            before = self.bus.endpoint
            self.bus.relay_no_more()
            self._reached_at = next(iter(self._other_hubs()), before)
            self._file.write_again()

    def _take_place(self) -> None:
        """Relay, if no site does, or if those that do hang."""
        relaying = self._relaying()
        hubs = _reached_at(relaying)
        if hubs != self._hub_wait.awaited:
            self._hub_wait.begin_anew(hubs)
        suspended = all(site.is_suspended() for site in relaying)
        if (not hubs or self._hub_wait.is_over(suspended)) and self._is_believed():
            self._relay_at(self._places(), hubs)

    def _places(self) -> list[str]:
        """Where this site can relay: at the usual ports, or at that of loopback where the one before did."""
        loopback = self._usual[0].rpartition(":")[0]
        before = [self._reached_at] if self._reached_at.rpartition(":")[0] == loopback else []
        return list(dict.fromkeys([*self._usual, *before]))

    def _is_believed(self) -> bool:
        """Whether others would connect to a hub of this site, and it to theirs: not with an expired certificate."""
        if self._security is None:
            return True
        from selfconf.access import is_in_time  # what it needs is an extra

        return is_in_time(self._security.credentials)

    def _relay_at(self, endpoints: Sequence[str], hubs: Sequence[str]) -> None:
        """Relay at the first of some endpoints that is free, beside others that relay and keep their places.

        And beside what has a usual port and is no site of this ecology: if it is the hub of another, what has lost its
        hub may have gone there. With keys nothing is let in there.
        """
        ours = {site.endpoint for site in this_machine.local_sites(self._ecology)}
        strange: list[str] = []
        for endpoint in endpoints:
            try:
                hub = Hub(endpoint, self._security)
            except NetworkError:  # the port is taken, by one that hangs or by another program
                if self._security is None and endpoint not in ours:
                    strange.append(endpoint)
                continue
            for other in this_machine.local_sites(self._ecology):
                if other.relays and other.endpoint in self._usual:
                    with suppress(NetworkError):  # then two relay once that one goes on
                        this_machine.announce_no_relay(other)
            known = [one for one in hubs if one not in self._usual]
            self.bus.relay(hub, [*known, *strange, *self._elsewhere])
            self._hub_wait.begin_anew([endpoint])
            self._file.write_again()
            return


def _addresses(endpoint: str) -> set[tuple[str, int | None]]:
    """The addresses of an endpoint's host, each with the port; none where there is no such host."""
    host, port = endpoint_host(endpoint), endpoint_port(endpoint)
    try:
        return {(str(place[4][0]), port) for place in socket.getaddrinfo(host or None, port)}
    except (OSError, UnicodeError):
        return set()


def _reached_at(sites: Sequence[LocalSite]) -> list[str]:
    """Where sites are reached, each endpoint once."""
    return list(dict.fromkeys(site.endpoint for site in sites))
