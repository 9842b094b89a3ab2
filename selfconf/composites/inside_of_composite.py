"""What is inside of a living composite: the task that does what the composite is called for.

When a composite is activated its inside becomes a task with the rank of the one that holds it, of several the first,
and it acts once that task runs; what fails inside is repaired inside, and only a refusal is a FAIL of the composite,
with the reason. When it is released its inside comes to rest.

Its operational parameters are parameters of the template, known by their names: the values that they are set to are
bound when the composite is activated. Other values than before have the inside begin anew. Where an optional input of
the composite gets a source, or loses its last one, the inside is configured again beside what runs.

Neither signals nor calls pass here. The inputs inside that are those of the composite follow what feeds it, and a
configurator that asks the composite to act hears which outputs stand behind its own, and which components inside call
what it needs (`CallAnswer`, and `Moved` when they change). Where what stood behind an output, or what feeds that, is
lost and not replaced within `REPLACING`, nothing does: an input that follows it is not to take a component that rests,
or knows nothing new, for one that has nothing to say. Those outside that may call an operation of the composite may
call the one that stands behind it.
"""

from __future__ import annotations

import logging
import math
import secrets
from collections.abc import Callable, Mapping, Set
from functools import partial

from selfconf.bus.port import Bus, Urgency
from selfconf.composites.inside_prospect import InsideProspect
from selfconf.composition import why_none
from selfconf.deployment import Outside, RunRequest, TaskRunner
from selfconf.errors import SelfconfError
from selfconf.model.configuration import Configuration
from selfconf.model.immutable import replace
from selfconf.model.profile import Profile
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.run_event import ComponentLost, ComponentReleased, RunEvent, TaskRunning
from selfconf.model.term import IRI, Term
from selfconf.protocol.codec import encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Apply, Moved, Wires
from selfconf.sdk import Component, ComponentRuntime, Refused, Signal

log = logging.getLogger(__name__)

STARTING_INSIDE = 25.0
"""Seconds that the inside of a composite may take to run: each site may take 15 to start what is dormant."""
REPLACING = 0.5
"""Seconds after which those outside hear that nothing stands behind an output: most repairs take less."""


class _CompositeCode(Component):
    """What a composite does itself: nothing."""

    def called(self, operation: str, request: Signal) -> None:
        """Refuse: a caller of a composite does not know what stands behind it."""
        raise Refused(f"{operation!r} of a composite is answered by a component inside of it")


RequestWith = Callable[[Mapping[str, Term], Callable[[], Set[str]]], RunRequest]
"""Gives the request for the inside of a composite, with values for the parameters of the composite by name.

And with what tells the inputs of the composite that are fed. It raises SelfconfError for values with which there is no
inside.
"""


class InsideOfComposite:
    """What does as the calls of a configurator say to a composite: it runs the inside as a task."""

    def __init__(
        self,
        bus: Bus,
        ecology: str,
        profile: Profile,
        request_with: RequestWith,
        rested: Callable[[], None],
        superseded: Callable[[InsideOfComposite], None],
    ) -> None:
        """What the inside reports and who ranks it is said here, the rest by `request_with`.

        `rested` is called when the composite acts no more, as it is at rest or has failed; `superseded` when it lives
        no more, as another life of it is seen.
        """
        self._rested = rested
        self._bus, self._ecology, self.profile, self._request_with = bus, ecology, profile, request_with
        self._wires: Wires = {}
        """By which outputs each input of the composite is fed."""
        self._values: Mapping[str, Term] = {}
        """The values of its operational parameters."""
        self._called_by: Mapping[str, tuple[IRI, ...]] = {}
        """Which components may call each of its operations."""
        self._rests = False
        """Whether actuators inside are to rest, as what the composite is part of is incomplete."""
        self.runner: TaskRunner | None = None
        """What runs the inside, while the composite acts."""
        self._beginnings = 0
        """How often an inside has begun: what one reports that has come to rest is passed over."""
        self._again: Apply | None = None
        """The call with which the inside is to begin anew once it has come to rest."""
        self._waiting: list[Callable[[], None]] = []
        """What waits for the inside to run."""
        self.issued: Wires = {}
        self.callers: Mapping[str, tuple[IRI, ...]] = {}
        self._standing: Mapping[IRI, frozenset[str]] = {}
        """The components inside on which outputs of the composite depend, with these, each time anew when it runs."""
        self.prospect: InsideProspect | None = None
        """What may come of the last inside that was refused."""
        self.settled = False
        self._runs_since = math.inf
        """When the last inside began to run; infinity: none has run since one began."""
        self.ran_for = 0.0
        """For how many seconds the last inside that has ended was running."""
        self.ending = False
        self.dropped = 0
        self.runtime = ComponentRuntime(
            bus,
            Keys(ecology),
            profile,
            _CompositeCode(),
            secrets.token_hex(4),
            superseded=lambda reason: superseded(self),
            inputs=self,
        )

    # What the runtime asks for.

    @property
    def patience(self) -> float:
        """How many seconds it may take until an inside runs that has begun: its components may have to be started."""
        return 0.0 if self.settled or self.runner is None else STARTING_INSIDE

    def follow(self, message: Apply) -> None:
        """Begin with the inside, or tell it what it is connected to now; begin anew where values have changed."""
        called_by = {port.name: tuple(sorted(self.runtime.callers(port.name))) for port in self.profile.operations}
        rests = self.runtime.activation.rests
        changed = (self._wires, self._called_by, self._rests) != (message.inputs, called_by, rests)
        other_inputs = self._wires.keys() != message.inputs.keys()
        self._wires, self._called_by, self._rests = dict(message.inputs), called_by, rests
        if self.runner is None:
            self._begin(message)
        elif self._again is not None or message.values != self._values:
            self._again, self.settled = message, False  # the newest call counts, also while the last inside ends
            self.runner.stop()
        elif other_inputs:
            self.runner.reconsider(rests)
        elif changed:
            self.runner.rewire(rests)

    def _begin(self, message: Apply) -> None:
        self._values, self.prospect, self._runs_since = dict(message.values), None, math.inf
        self._beginnings += 1
        try:
            request = self._request_with(self._values, lambda: self._wires.keys())
        except SelfconfError as error:
            self.runtime.fail(str(error))
            self._settle(runs=False)
            self._rested()
            return
        claim = message if self.runtime.activation.first is None else self.runtime.activation.first.claim
        request = replace(
            request,
            outside=Outside(self.profile.component, lambda: self._wires, lambda name: self._called_by.get(name, ())),
            report=partial(self._report, self._beginnings),
            priority=claim.priority,
            ended=self._ended,
        )
        self.runner = runner = TaskRunner(self._bus, self._ecology, request, beginning=claim.beginning)
        runner.start()
        if self._rests:
            runner.rewire(rests=True)

    def when_settled(self, action: Callable[[], None]) -> None:
        """Do something once the inside runs, or cannot."""
        if self.settled or self.runner is None:
            action()
        else:
            self._waiting.append(action)

    def holders_changed(self) -> None:
        """Give the inside the rank of the first of those that hold the composite."""
        first = self.runtime.activation.first
        if first is not None and self.runner is not None:
            self.runner.rank(first.claim.priority, first.claim.beginning)

    def lack_a_part(self, lacking: bool) -> None:
        """Let the actuators inside rest, or act again, if a task has let go of the composite that was in the way."""
        if lacking != self._rests:
            self._rests = lacking
            if self.runner is not None:
                self.runner.rewire(lacking)

    def say_again(self, woken_by: str) -> None:
        """Do nothing: signals go straight to the components inside."""

    def end(self) -> None:
        """Take the inside down; `ending` lasts as long as that takes."""
        self._again = None
        if self.runner is not None:
            self.ending = True
            self.runner.stop()

    def close(self) -> None:
        """Live no more, and act no more."""
        self.runtime.close()

    # What the inside reports.

    def _report(self, beginning: int, event: RunEvent) -> None:
        log.info("%s: %s", self.profile.component.short, event.act)
        if beginning != self._beginnings or self.runner is None or self._again is not None:
            return
        if isinstance(event, ComponentLost | ComponentReleased) and event.component in self._standing:
            lacking, standing = self._standing[event.component], self._standing
            self._bus.later(REPLACING, partial(self._tell_silence, lacking, standing))
        if not isinstance(event, TaskRunning):
            return
        self._standing = self._issuing(event.configuration)
        before, self.issued = self.issued, self.runner.issued_outside()
        called_by, self.callers = self.callers, self.runner.calling_outside()
        if not self.settled:
            self._settle(runs=True)
        elif (self.issued, self.callers) != (before, called_by):
            self._tell_moved()

    def _issuing(self, inside: Configuration) -> dict[IRI, frozenset[str]]:
        """The components inside, each with the outputs of the composite that it issues, or feeds what does."""
        found: dict[IRI, frozenset[str]] = {}
        before: dict[IRI, frozenset[str]] | None = None
        while found != before:
            before = dict(found)
            for one in inside.connections:
                is_own = one.sink == self.profile.component
                issued = frozenset({one.input}) if is_own else found.get(one.sink, frozenset())
                found[one.source] = found.get(one.source, frozenset()) | issued
        return found

    def _tell_silence(self, lacking: frozenset[str], standing: Mapping[IRI, frozenset[str]]) -> None:
        """Tell that nothing stands behind some outputs, unless the inside runs anew, or has ended, since they did."""
        if self._standing is standing:
            before, self.issued = self.issued, {**self.issued, **dict.fromkeys(lacking, ())}
            if self.issued != before:
                self._tell_moved()

    def _tell_moved(self) -> None:
        moved = self._bus.publisher(self.runtime.keys.moved(self.profile.component), Urgency.EVENT)
        moved.put(encode(Moved(self.profile.component, self.runtime.life, self.issued, self.callers)))
        moved.undeclare()

    def _ended(self, refusal: Refusal | Undecided | None) -> None:
        self.ran_for = max(0.0, self._bus.now() - self._runs_since)
        trouble = None if self.runner is None else self.runner.trouble
        if refusal is not None and self.runner is not None:
            self.prospect = InsideProspect(self._bus, self._ecology, self.runner.request, self.runner.state)
        self.runner, self.issued, self.callers, self._standing = None, {}, {}, {}
        ending, self.ending = self.ending, False
        again, self._again = self._again, None
        if again is not None:
            self._begin(again)
            return
        if ending:
            self._settle(runs=False)
            self.runtime.at_rest()
        else:
            self.runtime.fail(f"its inside is refused: {why_none(refusal) if trouble is None else trouble}")
            self._settle(runs=False)
        self._rested()

    def _settle(self, runs: bool) -> None:
        self.settled = runs
        if runs:
            self._runs_since = self._bus.now()
        waiting, self._waiting = self._waiting, []
        for action in waiting:
            action()
