"""Act 3 of a running task: the search for a configuration, apart from the bus, and what comes of its answer."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Mapping
from typing import NamedTuple

from selfconf.bus.port import Undo
from selfconf.configurator import Compose, Composed, Phase, Policy, plan_of
from selfconf.deployment.components import Liveness
from selfconf.deployment.contingencies import Contingencies
from selfconf.deployment.task_context import TaskContext
from selfconf.errors import ProgrammerError, SelfconfError
from selfconf.model.configuration import Configuration
from selfconf.model.immutable import replace
from selfconf.model.obstacle import NotJudged
from selfconf.model.partition import Barred
from selfconf.model.refusal import Outcome, Refusal, Undecided
from selfconf.model.run_event import ComponentLeftOut, SearchEnded
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement

log = logging.getLogger(__name__)


class _Better(NamedTuple):
    """The answer to a search for something better than what runs, and what it was about."""

    found: Mapping[IRI, Advertisement]
    left_out: frozenset[Barred]
    outcome: Outcome
    not_judged: Mapping[IRI, NotJudged]


class TaskSearch:
    """Searches for one task, one search at a time, and feeds its machine with the answers."""

    def __init__(
        self,
        context: TaskContext,
        liveness: Liveness,
        give_up: Callable[[SelfconfError], None],
    ) -> None:
        """`give_up` ends the task where it cannot be searched for."""
        self._bus, self._ecology, self._request = context.ecology.bus, context.ecology, context.request
        self._liveness = liveness
        self._state, self._step, self._report, self._give_up = context.state, context.step, context.report, give_up
        self._contingencies = Contingencies(self._bus, self._request, self._advertised, lambda: self._runs)
        self._better: _Better | None = None
        """What was answered last when the task ran and looked for something better."""
        self._left_out: set[IRI] = set()
        """The components that were reported to play no role, as they cannot be judged."""
        self._outdated: Undo = lambda: None
        """Abandons the search that was begun last."""

    def begin(self, effect: Compose) -> None:
        """Search elsewhere, as a search must keep this configurator from nothing; unless its answer is known.

        A task that runs looks again and again whether there is something better: it asks the same as long as nothing
        has changed, and a search may take long.
        """
        self._outdated()  # the answer of an earlier search is not looked at any more
        found, began = self._advertised(), time.monotonic()
        ignores_holders = self._state().ignores_holders
        known = None if ignores_holders else self._contingencies.answer(found, effect.left_out, effect.running)
        if known is not None:
            composed = Composed(effect.attempt, known.configuration, plan=known.plan)
            self._composed(composed, time.monotonic() - began, known.not_judged)
            return
        better, looks_again = self._better, self._runs
        if looks_again and better is not None and (better.found, better.left_out) == (found, effect.left_out):
            self._composed(Composed(effect.attempt, better.outcome), time.monotonic() - began, better.not_judged)
            return
        taken, refused = self._state().taken.keys(), self._state().refusal if ignores_holders else None

        def work() -> None:
            began = time.monotonic()
            try:
                outcome = self._request.compose(found, effect.left_out, effect.running)
                plan = plan_of(outcome) if isinstance(outcome, Configuration) else None
                not_judged = dict(self._request.composer.not_judged())
                refusal = outcome if isinstance(outcome, Refusal) else refused
                usable = self._request.composer.usable(taken, refusal) if isinstance(refusal, Refusal) else {}
            except SelfconfError as error:
                trouble = error
                self._bus.wake_up(lambda: self._give_up(trouble))
                return
            except Exception as error:  # nothing may wait forever for a search that broke
                log.exception("the search broke")
                broken = ProgrammerError(f"the search broke: {type(error).__name__}: {error}")
                self._bus.wake_up(lambda: self._give_up(broken))
                return
            if isinstance(outcome, Refusal):
                outcome = outcome.told_of_held(usable)
            seconds = time.monotonic() - began
            composed = Composed(effect.attempt, outcome, frozenset(usable), plan)
            if looks_again and not isinstance(outcome, Undecided):
                self._better = _Better(found, effect.left_out, outcome, not_judged)
            self._bus.wake_up(lambda: self._searched(composed, seconds, not_judged))

        self._outdated = self._request.aside(work)

    def abandon(self) -> None:
        """End the search that was begun last, as its task has ended: other work may wait for that."""
        self._outdated()

    def prepare(self) -> None:
        """Find out, when there is time, what the search will answer if one of the components that run is lost."""
        state = self._state()
        if state.policy is Policy.REPAIR and state.target is not None:
            lost = frozenset(state.lost) | frozenset(state.taken)
            self._contingencies.prepare(lost, state.target)

    @property
    def _runs(self) -> bool:
        return self._state().phase is Phase.RUNNING

    def _advertised(self) -> Mapping[IRI, Advertisement]:
        return {component: found.advertisement for component, found in self._ecology.discovery.found.items()}

    def _searched(self, composed: Composed, seconds: float, not_judged: Mapping[IRI, NotJudged]) -> None:
        self._contingencies.searched = seconds
        self._composed(composed, seconds, not_judged)

    def _composed(self, composed: Composed, seconds: float, not_judged: Mapping[IRI, NotJudged]) -> None:
        for component in sorted(not_judged.keys() - self._left_out):
            self._report(ComponentLeftOut(component, not_judged[component].reason))
        self._left_out |= not_judged.keys()
        outcome = composed.outcome
        if isinstance(outcome, Refusal):
            outcome = replace(outcome, missing_sites=self._ecology.silent_sites(self._ecology.discovery))
            composed = replace(composed, outcome=outcome)
        current = composed.attempt == self._state().attempt
        counts = current and not self._state().ignores_holders and self._state().phase is Phase.COMPOSING
        if isinstance(outcome, Configuration):
            goes_on = bool(self._state().contested(outcome))
        else:
            goes_on = self._state().searches_again
        if counts and not goes_on:
            self._report(SearchEnded(outcome, seconds))
        wanted = outcome.components if isinstance(outcome, Configuration) else ()
        self._liveness.select(wanted, lambda: self._step(composed))
