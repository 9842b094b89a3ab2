"""Whether a configurator reaches its ecology, and what it does not believe as long as it may not.

To a configurator that is cut off from the network all lives seem to end at once. So no end is believed while there is
no link, nor over another link than before; once there is one again, and for long enough that others are connected too,
the ecology is asked what has become of its components. A program that was suspended was as good as cut off.
"""

from __future__ import annotations

import logging

from selfconf.configurator import Failed, Reconnected
from selfconf.deployment.components.calls import Calls
from selfconf.deployment.components.living_sites import LivingSites
from selfconf.deployment.task_context import TaskContext
from selfconf.model.run_event import EcologyReachable, EcologyUnreachable
from selfconf.model.term import IRI

log = logging.getLogger(__name__)

PULSE = 0.25
"""How often, in seconds, a configurator looks whether it has been suspended."""
SUSPENDED = 1.0
"""A pause of so many seconds more than `PULSE` means that this program was suspended, and so cut off."""
CUT_OFF = 0.25
"""Seconds between two looks of a configurator that is cut off whether it still is."""
MOST_REOPENINGS, REOPENINGS_WITHIN = 6, 60.0
"""How often in how many seconds a site is believed that its hub is about to be opened anew: it is, as others join.
Those that this node has seen come true, as its own link was lost, do not count."""
SETTLING = 1.0
"""Seconds that other nodes may take to be connected again after this one.

It is the grace period of components (`GRACE` of `selfconf.sdk.runtime.supervision`): after it, each has turned itself
off or has seen its supervisor again.
"""


class Reachability:
    """Whether the configurator of one task reaches its ecology."""

    def __init__(self, context: TaskContext, calls: Calls, sites: LivingSites) -> None:
        self._bus, self._ecology, self._calls, self._sites = context.ecology.bus, context.ecology, calls, sites
        self._state, self._step, self._report = context.state, context.step, context.report
        self._link = self._bus.link
        self.cut_off = False
        """Whether this node was found to be cut off, and has not been connected again for long enough since."""
        self.unsure = False
        """Whether it was cut off or suspended, and does not know yet what has become of its components meanwhile."""
        self._withheld: dict[tuple[IRI, str], Failed] = {}
        """The latest failure of each life of a component that was heard of while this node was unsure."""
        self._reopenings: dict[str, list[float]] = {}
        """When each site has last said that its hub is about to be opened anew."""
        self._last_pulse = self._bus.now()

    @property
    def undisturbed(self) -> bool:
        """Whether this node is connected, as it has been for long enough, over one link."""
        return not self.cut_off and self._bus.link == self._link

    def await_link(self) -> None:
        """Believe no end while this node is cut off; what has become of the components is asked afterwards."""
        if not self.cut_off:
            self.cut_off = True
            self._report(EcologyUnreachable())
            self._look()

    def reconnected(self) -> None:
        """This node was cut off for so long that all it knows may be outdated: every connection counts as gone."""
        self._calls.forget_connections()
        self._report(EcologyReachable())
        self._step(Reconnected())

    def pulse(self) -> None:
        """Look from time to time whether this program was suspended, for as long as the task goes on."""
        if not self._state().ended:
            self._bus.later(PULSE, self.pulse)
            self._look_whether_suspended()

    def _look_whether_suspended(self) -> None:
        """Notice that this program stood still for a while: it was as good as cut off.

        Whatever has not been answered meanwhile says nothing.
        """
        now = self._bus.now()
        late, self._last_pulse = now - self._last_pulse - PULSE, now
        if late > SUSPENDED:
            log.warning("this program was suspended for %.1f s; looking at what has become of the ecology", late)
            if self._ecology.followed:
                self.unsure = True
                self.await_link()

    def reopens(self, site: str) -> None:
        """A site's hub is about to be opened anew: lives seem to end, one after the other, and sites among the last.

        A site that says so again and again is not believed, nor one that does not live: no end would be any more.
        """
        now = self._bus.now()
        lately = {one: [at for at in said if now - at < REOPENINGS_WITHIN] for one, said in self._reopenings.items()}
        self._reopenings = {one: said for one, said in lately.items() if said}
        said = self._reopenings.get(site, [])
        if len(said) < MOST_REOPENINGS and self._ecology.followed and self._sites.lives(site):
            self._reopenings[site] = [*said, now]
            self.await_link()

    def heed(self, failed: Failed) -> None:
        """Feed the machine with a failure that was heard of; while this node is unsure, that waits.

        A repair would find that nothing answers, and give up what another configurator may have repaired long since.
        The failure may be heard of before the first pulse after a suspension.
        """
        self._look_whether_suspended()
        if self._bus.link != self._link:
            self.await_link()
        if self.unsure:
            self._withheld[failed.component, failed.life] = failed
        else:
            self._step(failed)

    def _look(self) -> None:
        """See whether there is a link again."""
        if self._state().ended:
            return
        if self._bus.link:
            self._bus.later(SETTLING, self._settled)
        else:
            self.unsure = True
            self._bus.later(CUT_OFF, self._look)

    def _settled(self) -> None:
        """There was a link again; if there is still, the others have found theirs as well."""
        if not self._bus.link or self._state().ended:
            self._look()
            return
        if self._bus.link != self._link:
            self._reopenings.clear()
        self._link, self.cut_off, self.unsure = self._bus.link, False, False
        self.reconnected()
        withheld, self._withheld = self._withheld, {}
        for failed in withheld.values():
            self._step(failed)
