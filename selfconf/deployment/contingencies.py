"""Contingencies: to what a task is configured again if a component is lost, found out before that happens.

While a task runs, its configurator has time. So it searches for the configuration without one component, for each of
those that play in turn. If that component is lost, and nothing else is other than was supposed, the answer is there,
and the repair begins at once, however long the search has taken. It is the answer that the search would give then, as
that depends on nothing but what it is asked.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from typing import NamedTuple

from selfconf.bus.port import Bus
from selfconf.configurator import Plan, plan_of
from selfconf.deployment.run_request import RunRequest
from selfconf.errors import SelfconfError
from selfconf.model.configuration import Configuration
from selfconf.model.obstacle import NotJudged
from selfconf.model.partition import Barred
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement

log = logging.getLogger(__name__)

MOST_SECONDS = 0.5
"""Seconds after which no further component of a configuration is looked at, and that a search may have taken for more
of its kind to be made beforehand: what there is no time for is searched for when it is needed."""
REST = 10
"""Contingencies are found out anew, while the ecology changes, after so many times as long as that has taken."""


class Contingency(NamedTuple):
    """What the search has answered to a question that may come."""

    configuration: Configuration
    plan: Plan
    """The plan of its deployment."""
    not_judged: Mapping[IRI, NotJudged]
    """The components that were left out because they cannot be judged."""


class _Supposed(NamedTuple):
    """What a search is about, but for the component that is lost besides."""

    found: Mapping[IRI, Advertisement]
    lost: frozenset[IRI]
    running: Configuration


class Contingencies:
    """Finds out what the task of a configurator is to be changed to if a component is lost."""

    def __init__(
        self,
        bus: Bus,
        request: RunRequest,
        advertised: Callable[[], Mapping[IRI, Advertisement]],
        runs: Callable[[], bool] = lambda: True,
    ) -> None:
        """`advertised` is what a search is made among now, and `runs` whether the task does."""
        self._bus, self._request, self._advertised, self._runs = bus, request, advertised, runs
        self._supposed: _Supposed | None = None
        """The state for which contingencies are found out now, or have been."""
        self._known: dict[Barred, Contingency | None] = {}
        """By the component that is lost, None where there is no configuration, or was no time to find it; replaced with
        what is supposed, and filled by another thread."""
        self._next: tuple[frozenset[IRI], Configuration] | None = None
        """For what contingencies are to be found out next."""
        self._rested = 0.0
        """When contingencies may be found out anew, by the clock of the bus."""
        self.searched = 0.0
        """How many seconds the last search has taken."""

    def prepare(self, lost: frozenset[IRI], running: Configuration) -> None:
        """Find out, when there is time, what comes after `running` if one more component than the `lost` is lost.

        The inside of a composite has none, as its search also depends on what is outside, which may change unnoticed.
        """
        if self._request.outside is not None:
            return
        waits, self._next = self._next is not None, (lost, running)
        if not waits:
            self._bus.later(max(0.0, self._rested - self._bus.now()), self._begin)

    def _begin(self) -> None:
        following, self._next = self._next, None
        if following is None or not self._runs() or self.searched > MOST_SECONDS:
            return
        supposed = _Supposed(self._advertised(), *following)
        if supposed != self._supposed:
            self._supposed, self._known = supposed, {}
            known = self._known
            self._request.at_leisure(lambda: self._find_out(supposed, known))

    def _find_out(self, supposed: _Supposed, known: dict[Barred, Contingency | None]) -> None:
        """Search without each component that is not known about; interrupted, it goes on with the next one.

        Unless that has taken too long already: a search that is interrupted again and again would never rest.
        """
        began = self._bus.now()
        try:
            for component in supposed.running.components:
                if self._bus.now() - began > MOST_SECONDS:
                    break
                if component not in known:
                    outcome = self._request.compose(supposed.found, supposed.lost | {component}, supposed.running)
                    if isinstance(outcome, Configuration):
                        not_judged = dict(self._request.composer.not_judged())
                        known[component] = Contingency(outcome, plan_of(outcome), not_judged)
                    else:
                        known[component] = None
        except SelfconfError:
            pass  # the search is made when it is needed, and what is wrong with it is reported then
        except Exception:  # as a task that runs must go on
            log.exception("the search for a contingency broke")
        finally:
            now = self._bus.now()
            self._rested = now + REST * (now - began)
            if now - began > MOST_SECONDS:
                for component in supposed.running.components:
                    known.setdefault(component, None)

    def answer(
        self, found: Mapping[IRI, Advertisement], left_out: frozenset[Barred], running: Configuration | None
    ) -> Contingency | None:
        """What the search answers if it is asked this, where that is known and is a configuration."""
        supposed = self._supposed
        if (
            supposed is None
            or supposed.running is not running
            or not supposed.lost < left_out
            or supposed.found != found
        ):
            return None
        more = left_out - supposed.lost
        return self._known.get(next(iter(more))) if len(more) == 1 else None
