"""The runtime of one component: what joins the code of a component to the bus.

It holds the liveliness token, obeys control calls by the table in `selfconf.protocol.activation`, and has the
component's code run what they ask for, on the thread of that code. Everything else, supervision and the watch over the
code included, happens on the thread of the bus, so that it never waits for the code. `ControlCalls` reads the calls,
`CallAnswers` makes their answers, and `WaitingTasks` deals with the tasks that a call has to wait for; `ComponentCode`
calls the code, and `Applying` has it begin; outputs, inputs, unfed inputs, operations and supervision have modules of
their own.
"""

from __future__ import annotations

import logging
import secrets
from collections.abc import Callable, Mapping, Sequence
from functools import partial

from selfconf.bus.port import Bus, Urgency
from selfconf.errors import PeerError
from selfconf.model.profile import Profile
from selfconf.model.signal_fields import SignalFields
from selfconf.model.term import IRI
from selfconf.model.wording import sayable
from selfconf.protocol import activation as table
from selfconf.protocol.activation import Activation, ActivationStep
from selfconf.protocol.codec import encode
from selfconf.protocol.keys import Keys, task_name
from selfconf.protocol.messages import (
    Apply,
    CallAnswer,
    Cause,
    Fail,
    Release,
    Reserve,
    Verdict,
    Wire,
)
from selfconf.sdk.code_thread import CodeThread
from selfconf.sdk.component import Component
from selfconf.sdk.component_code import ComponentCode
from selfconf.sdk.component_context import ComponentContext
from selfconf.sdk.inputs import InputEvents, InputFollower, Inputs
from selfconf.sdk.operations import NeededOperations, OfferedOperations, OperationSignals
from selfconf.sdk.outputs import Outputs
from selfconf.sdk.runtime.applying import LIFE_ENDS, Applying
from selfconf.sdk.runtime.component_timers import ComponentTimers
from selfconf.sdk.runtime.control_calls import CallAnswers, ControlCalls, Reply
from selfconf.sdk.runtime.other_lives import OtherLives
from selfconf.sdk.runtime.supervision import Supervision
from selfconf.sdk.runtime.waiting_tasks import WaitingTasks

log = logging.getLogger(__name__)

MOST_PENDING = 256
"""How many calls wait for the component's code and its inputs at most; those that come later are refused."""


class ComponentRuntime:
    """Joins a component to the bus."""

    def __init__(
        self,
        bus: Bus,
        keys: Keys,
        profile: Profile,
        component: Component,
        life: str = "",
        code_thread: CodeThread | None = None,
        superseded: Callable[[str], None] = lambda reason: None,
        fields: Mapping[IRI, SignalFields] | None = None,
        inputs: InputFollower | None = None,
        restless: Callable[[str], None] = lambda why: None,
    ) -> None:
        """`superseded` is called when another process is the same component, and this one has to go.

        `restless` is called when the component, an actuator, has broken as it was to come to rest, and may act on.
        `fields` are those of the kinds of signals that the component emits, as far as they are known. `inputs` does as
        the calls of configurators say, in the place of inputs that the code reads.
        """
        self.bus, self.keys, self.profile, self.component = bus, keys, profile, component
        self.life = life or secrets.token_hex(4)
        """Which incarnation of the component this is."""
        self.activation = Activation()
        self._superseded, self._told_restless = superseded, restless
        thread = code_thread or CodeThread(inline=True)
        context = ComponentContext(
            bus, keys, profile, self.life, thread, fields or {}, lambda: self.activation, self.fail
        )
        self.code = ComponentCode(
            context,
            component,
            woken=self._woken,
            restless=self._restless,
            rests=lambda: self.offered_operations.end(),
        )
        self._timers = ComponentTimers(bus, self.code)
        self._closed = False
        self._after_stop: list[Callable[[], None]] = []
        """What waits for the code to be at rest."""
        self._pending = 0
        """How many calls were not answered yet."""
        component._runtime = self
        self.outputs = Outputs(context, lambda: self.code.active)
        heard = InputEvents(self.code.deliver, self._report_silence, self.code.unfed)
        self.inputs: InputFollower = inputs or Inputs(bus, keys, thread, profile, heard, self.code.read_value)
        signals = OperationSignals(profile.component, self.life)
        self.offered_operations = OfferedOperations(context, signals, self.code, self.callers)
        self.needed_operations = NeededOperations(context, signals, self.code)
        self.supervision = Supervision(bus, self._orphaned)
        self._fail = bus.publisher(keys.fail(profile.component), Urgency.EVENT)
        self._waiting = WaitingTasks(
            context,
            become=self._keep,
            ask_holder=lambda task, why: self._put_fail(Cause.YIELD, why, task),
            let_go=self._let_go,
        )
        self._answers = CallAnswers(context, lambda: self.stopping, self.code, self.inputs, self.outputs)
        self._applying = Applying(
            context, self.code, self.inputs, self.needed_operations, self._answers, self._begin_for_none
        )
        self.calls = ControlCalls(context, self._answers, self._obey_at_rest)
        self._token = bus.announce(keys.life(profile.component, self.life))  # last: from now on it is called
        self._other_lives = OtherLives(context, self._outlived)

    @property
    def active(self) -> bool:
        """Whether the component acts: unlike `activation` it ends in the thread and the moment of a FAIL."""
        return self.code.active

    @property
    def stopping(self) -> bool:
        """Whether the component was turned off, and is not at rest yet: it may still act."""
        return self.code.stopping or self.inputs.ending

    @property
    def closed(self) -> bool:
        """Whether the component has left the ecology."""
        return self._closed

    def close(self, closed: Callable[[], None] = lambda: None) -> None:
        """Turn the component off and leave the ecology; `closed` is called when its code is at rest."""
        if self._closed:
            closed()
            return
        self._closed = True
        self._applying.close()
        self._drop([hold.claim.task for hold in self.activation.holds])
        self.calls.close()
        self._token()
        self._other_lives.close()
        self.outputs.close()
        self.offered_operations.close()
        self._fail.undeclare()
        self._waiting.close()
        self._when_at_rest(closed)

    # What the component does.

    def fail(self, reason: str, cause: Cause = Cause.FAIL) -> None:
        """Raise FAIL, at once, also on the way to a start; may be called from any thread."""
        if self.code.wanted:
            self.code.end_acting()
            self._applying.failure = reason
            self._put_fail(cause, reason)
            self.bus.wake_up(self._failed)

    def hung(self, why: str) -> None:
        """Raise FAIL for code that has not returned."""
        self.fail(why, Cause.HUNG)

    def _woken(self, port: str) -> None:
        """Have the code that has been started again hear what is connected, and the last signals."""
        self.inputs.say_again(port)
        self.needed_operations.say_again()

    def _restless(self, why: str) -> None:
        """Raise FAIL for code that broke as it was to rest: like one that hangs, it does what it likes until it ends.

        A release that it broke in is not obeyed.
        """
        self.fail(why, Cause.HUNG)
        self.bus.wake_up(lambda: self._told_restless(why))

    def every(self, seconds: float, action: Callable[[], None]) -> None:
        """Call `action` at that interval until the component stops or fails; see `ComponentTimers`."""
        self._timers.every(seconds, action)

    def _failed(self) -> None:
        """What `fail` leaves for the bus's thread."""
        self._become(*table.fail(self.activation))

    def _put_fail(self, cause: Cause, detail: str, task: str = "", epoch: int | None = None) -> None:
        epoch = self.activation.epoch if epoch is None else epoch
        newest = self.outputs.newest
        self._fail.put(encode(Fail(self.profile.component, self.life, epoch, cause, sayable(detail), task, newest)))

    # Control calls.

    def _obey_at_rest(self, message: Reserve | Apply | Release, reply: Reply) -> None:
        """Obey a call once the code that was stopped is at rest. Raises PeerError where too many wait for an answer."""
        if self._pending >= MOST_PENDING:
            raise PeerError(
                f"{MOST_PENDING} calls wait for the code of {self.profile.component.short}; try again later"
            )

        def answered(answer: CallAnswer) -> None:
            self._pending -= 1
            reply(answer)

        self._pending += 1
        self._when_at_rest(partial(self._obey, message, answered))

    def _obey(self, message: Reserve | Apply | Release, reply: Reply) -> None:
        if self._closed:  # while the call waited for the code to be at rest; its site may start another life
            verdict = Verdict.DONE if isinstance(message, Release) else Verdict.OTHER_LIFE
            reply(self._answers.answer(verdict, message.task, LIFE_ENDS))
            return
        before = self.activation
        after, verdict, step = table.obey(
            before,
            message,
            shareable=self.profile.is_shareable,
            reserved_first=not self.profile.outputs,
            gone=self.supervision.gone,
            unseen=self.supervision.unseen,
        )
        self._become(after, step)
        if verdict is not Verdict.DONE:
            reply(self._declining(verdict, message))
            self._waiting.ask_to_yield()
            self._waiting.offer()
        elif isinstance(message, Apply):
            starts = step is not ActivationStep.NONE
            if starts:
                self.outputs.forget()
                if self.activation.queue:
                    self._waiting.tell("")
            self._applying.apply(message, reply, starts=starts)
            self._rest_or_act()  # once what it lost is known to be unfed
        elif isinstance(message, Release):
            self._rest_or_act()
            self._grant()
            if step is ActivationStep.STOP and self.profile.signal_outputs:
                # For inputs that follow it all the same; it may be held by now for a task that was reserved.
                self._put_fail(Cause.LET_GO, "it was released", epoch=0)
            self._when_at_rest(lambda: reply(self._answers.answer(Verdict.DONE, message.task)))
            self._when_at_rest(self._waiting.offer)
        else:
            self._follow_what_is_left(before, message.task)
            reply(self._answers.answer(Verdict.DONE, message.task))

    def _declining(self, verdict: Verdict, message: Reserve | Apply | Release) -> CallAnswer:
        """The answer to a call that is not obeyed."""
        if verdict is Verdict.BUSY:
            by = table.in_the_way(self.activation, message, self.supervision.gone, self.supervision.unseen)
            return self._answers.busy(message, by)
        return self._answers.answer(verdict, message.task, "it has failed" if verdict is Verdict.REFUSED else "")

    def _follow_what_is_left(self, before: Activation, task: str) -> None:
        """Follow no more what a task that the component acts for has not reserved with it, after it was given up."""
        last, hold = before.hold(task), self.activation.hold(task)
        if hold is None or last is None or not (hold.active and isinstance(hold.claim, Apply)):
            return
        if hold.claim.inputs != last.claim.inputs:
            self._applying.follow(hold.claim)

    def _begin_for_none(self, task: str) -> None:
        """Act neither for a task whose call to start came to nothing, nor for those that share what has not begun."""
        acts = self.code.active
        holds = self.activation.holds
        self._drop([hold.claim.task for hold in holds if hold.claim.task == task or (hold.active and not acts)])

    # Being on and off.

    def _become(self, activation: Activation, step: ActivationStep) -> None:
        """Take on an activation; the code stops if it says so, and is started by what called for it."""
        served, self.activation = table.served(self.activation, activation), activation
        if step in (ActivationStep.STOP, ActivationStep.RESTART):
            self._stop()
        self.offered_operations.callers_changed()
        self.inputs.holders_changed()
        if step is ActivationStep.RAISE_FAIL:
            self.code.end_acting()  # again: another thread's FAIL may have been overtaken by a release and an apply
        self.supervision.watch({hold.claim.supervisor for hold in activation.holds})
        self._other_lives.follow(bool(activation.holds))
        for task in served:
            self._waiting.tell(task)
        self._waiting.holders_changed(activation)

    def _keep(self, activation: Activation) -> None:
        """Take on an activation that differs in nothing but the task for which the component is kept."""
        self.activation = activation

    def _drop(self, tasks: Sequence[str]) -> None:
        self._become(*table.drop(self.activation, tasks))
        self._rest_or_act()
        self._grant()

    def _rest_or_act(self) -> None:
        """Let actuators rest while all tasks that the component acts for lack a part, and else act."""
        lacking = self.activation.rests
        self.code.lack_a_part(lacking)
        self.inputs.lack_a_part(lacking)

    def _grant(self) -> None:
        """Do what is wished by all that still hold the component; those that wait for it ask again, and are served."""
        wish = table.granted(self.activation)
        if wish is not None:
            self._obey(wish, lambda answer: None)

    def _stop(self) -> None:
        """Be off: no timers, no inputs, and the component's code at rest."""
        self._timers.end()
        self.inputs.end()
        self.needed_operations.end()
        self.offered_operations.end()
        self.code.stop(self.at_rest)

    def _when_at_rest(self, action: Callable[[], None]) -> None:
        """Do something once the code that was stopped is at rest; at once if it is."""
        if self.stopping:
            self._after_stop.append(action)
        else:
            action()

    def at_rest(self) -> None:
        """Go on with what waits for the component to be at rest, if it is."""
        waiting, self._after_stop = self._after_stop, []
        for action in waiting:
            self._when_at_rest(action)

    def _orphaned(self, supervisor: str) -> None:
        tasks = table.held_under(self.activation, supervisor)
        self._let_go(tasks, "the configurator of the task seemed to be gone")

    def _let_go(self, tasks: Sequence[str], why: str) -> None:
        """Hold the component for some tasks no more, and tell those that still count on it."""
        names = ", ".join(map(task_name, tasks))
        log.warning("%s: letting go of %s: %s", self.profile.component.short, names, why)
        for task in tasks:
            self._put_fail(Cause.LET_GO, why, task)
        self._drop(tasks)
        self._when_at_rest(self._waiting.offer)

    def _outlived(self, life: str) -> None:
        """Leave the ecology: another process is the same component, and stays."""
        if not self._closed:
            reason = f"{self.profile.component} is alive already, in the life {life}; this process leaves"
            log.error("%s", reason)
            self.close(partial(self._superseded, reason))

    # What is noticed of the inputs, and asked for the operations.

    def callers(self, operation: str) -> frozenset[IRI]:
        """The components that may call an operation, for the tasks that this one acts for."""
        claims = [hold.claim for hold in self.activation.holds if hold.active]
        return frozenset(
            caller for claim in claims if isinstance(claim, Apply) for caller in claim.callers.get(operation, ())
        )

    def _report_silence(self, wire: Wire, seconds: float) -> None:
        """Raise FAIL for a component whose output has stopped: on the own key, as a report."""
        detail = f"no signal on {wire.output!r} for {seconds:.2f} s"
        self._fail.put(encode(Fail(wire.component, "", self.activation.epoch, Cause.SILENCE, detail)))
