"""When a site believes what it sees of the other sites, before it takes over the tasks of those that are not seen.

After a common stall, or the loss of a hub, each site sees the others go and come back one by one. Would it take over at
once what those have that it does not see yet, then so would each of the others: twenty sites that keep twenty tasks
began three hundred configurators in two seconds, which left the machine no time for the connections, so that the sites
lost sight of each other again, and so on for good.
"""

from __future__ import annotations

from collections.abc import Callable

CALM = 0.3
"""Seconds without a site that comes or goes after which all count as seen; components let go of a task that no site
runs after a second."""
CALM_OVER_NEW_LINK = 2.0
"""Seconds without such a change after which all count as seen by a site that has lost its hub meanwhile, or has heard
that one is opened anew: a hub that many reach again may say nothing for so long."""
LONGEST_UNREST = 10.0
"""Seconds after which what is seen counts though sites still come and go."""


class StableView:
    """Whether the sites that are seen at a moment are those that there are.

    They are if at most one has gone and was not seen again, as when a site has ended; and once none has come or gone
    for a while. A site that has just begun waits for that, and so does one that hears of a hub which is opened anew.
    """

    def __init__(self, now: Callable[[], float], link: Callable[[], str]) -> None:
        """`link` names the link of this site to its hub; it is another one after each loss."""
        self._now, self._link = now, link
        self._has_just_begun = True
        self._missing: set[str] = set()
        """The sites that have gone in the present unrest, and were not seen since."""
        self._returned: set[str] = set()
        """The sites that have come in the present unrest: if they go, they were not only out of sight."""
        self._before, self._is_over_new_link = link(), False
        """The link by which others were seen before it, and whether that was lost in it."""
        self._hub_reopens = False
        """Whether it was announced: a hub was about to be opened anew."""
        self._began = self._changed = now()
        """When it began, and when a site has come or gone last."""

    def reopens(self) -> None:
        """Note that a hub is about to be opened anew: the sites that are seen through it seem to go, and come back."""
        self._note_change()
        self._hub_reopens = True

    def changes(self, site: str, alive: bool) -> None:
        """Note that a site comes or goes."""
        self._note_change()
        if alive:
            self._missing.discard(site)
            self._returned.add(site)
        elif site not in self._returned:
            self._missing.add(site)

    def _note_change(self) -> None:
        now = self._now()
        if now - self._changed >= CALM and not self.unrest():
            self._missing, self._returned, self._began, self._has_just_begun = set(), set(), now, False
            self._before, self._is_over_new_link, self._hub_reopens = self._link(), False, False
        self._changed = now
        self._is_over_new_link |= self._link() != self._before

    def unrest(self) -> float:
        """For how many more seconds others may be there than are seen, if nothing changes; 0 if not."""
        if len(self._missing) <= 1 and not self._hub_reopens and not self._has_just_begun:
            return 0.0
        return max(0.0, min(self._changed + self._calm(), self._began + LONGEST_UNREST) - self._now())

    def _calm(self) -> float:
        # A link that is lost as this is asked was there in the calm before.
        has_new_link = self._hub_reopens or self._is_over_new_link or self._link() not in ("", self._before)
        return CALM_OVER_NEW_LINK if has_new_link else CALM
