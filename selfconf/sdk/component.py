"""The class that an author derives from, what arrives on its inputs, and the answers to its calls."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from selfconf import ros2
from selfconf.errors import ProgrammerError
from selfconf.model.immutable import immutable
from selfconf.model.term import IRI

if TYPE_CHECKING:
    from selfconf.sdk.runtime import ComponentRuntime


class Refused(Exception):
    """Raised in `started` by a component that cannot act now; the configurator looks for another one.

    Raised in `called`, it tells the caller why there is no answer.
    """


@immutable
class Signal:
    """What an output issued, with its source, its time, and its number.

    The value is what JSON has, or bytes, or an array: one of NumPy, which is not to be written to, or, where NumPy is
    not installed, a memoryview. A message of a ROS 2 node is an object with its fields, if the extra `ros2` is
    installed and its type is known, and else bytes.
    """

    value: Any
    source: IRI
    time: float
    """Seconds: of the Unix epoch, unless the source keeps a clock of its own, such as a simulation's."""
    sequence: int
    media: str = ""
    """The media type of bytes, if the source has said one."""

    def __getitem__(self, field: str) -> Any:
        return self.value[field]


class CallStatus(str, Enum):
    """What has become of a call of an operation."""

    ANSWERED = "answered"
    REFUSED = "refused"
    """The component that was called does not do it, or cannot; `detail` of the answer says why."""
    LATE = "late"
    """There was no answer in time; what was asked for may have been done, or be done yet."""
    GONE = "gone"
    """The component that was called does not live, or has ended before it answered."""
    NOT_CONNECTED = "not connected"
    """The configuration connects no component to the operation, which is optional then."""


@immutable
class Response:
    """The answer to a call of an operation; true if there is one, else it says why not."""

    status: CallStatus
    value: Any = None
    """What was answered, as values of signals are."""
    source: IRI | None = None
    """The component that was called."""
    detail: str = ""
    """Why there is no answer."""

    def __bool__(self) -> bool:
        return self.status is CallStatus.ANSWERED

    def __getitem__(self, field: str) -> Any:
        return self.value[field]


class Component:
    """A component of the ecology. Override what you need; each of these methods does nothing by itself."""

    advertisement: ClassVar[str | Path] = ""
    """The Turtle file with the advertisement; a relative path counts from the file that defines the class.

    Of a class that is in no file, as in a notebook, it counts from the current folder.
    """
    component: ClassVar[str] = ""
    """The IRI of the component, needed only where the file advertises several."""

    _runtime: ComponentRuntime | None = None

    @staticmethod
    def signal_value(value: Any, media: str) -> Any:
        """What is received of a value with its media type: of a message of ROS 2 its fields, else the value as it is.

        Raises ValueError for what is not what its media type says: it is passed over, and the log says so.
        """
        return ros2.received(value, media)

    def started(self) -> None:
        """The component has been activated. Raise Refused if it cannot act.

        It should return soon, for nothing else reaches the component meanwhile: after 8 seconds the component counts as
        hung, unless it asks for more by `sc:deadline`. What takes longer belongs on a thread of its own, which calls
        `fail` if it comes to nothing. Parameters have their values, and the sources of this component have started.
        """

    def stopped(self) -> None:
        """The component has been turned off; what actuates must be at rest when this returns.

        It may take 2 seconds, whatever `sc:deadline` says, and so may what else still runs then.

        An actuator, a component without outputs, whatever operations it offers, that raises an exception here counts as
        not at rest: its site ends its process, and one that no site has started is out of control until it is gone.
        """

    def received(self, port: str, signal: Signal) -> None:
        """A signal has arrived on an input."""

    def called(self, operation: str, request: Signal) -> Any:
        """An operation has been called by a component that may do so; what is returned is the answer.

        Raise Refused to say why there is none. An answer is what JSON has, bytes, or an array, of 1 MiB at most. For
        one that takes its time return a `concurrent.futures.Future`, so that nothing else waits: its result is the
        answer, and a Refused that it raises the reason why there is none. It is cancelled when no caller waits for it
        any more: the component is stopped, or the caller has waited long enough or is connected no more.
        """
        raise Refused(f"{operation!r} is advertised, and not written yet")

    def unfed(self, port: str) -> None:
        """An input has lost its last source: what was received on it last is not true any more.

        An actuator, a component without outputs, whatever operations it offers, is stopped when this has lasted for as
        long as it tolerates (`sc:tolerates`, 1 second by default), and started again once the input is fed.
        """

    def fed(self, port: str) -> None:
        """An input that had lost its last source has another, whose first signal is received next.

        An actuator that rests, as another input is still unfed, receives that signal once it is started again.
        """

    def connected(self, operation: str) -> None:
        """An operation that this component needs is connected to one that offers it; called after each `started`."""

    def disconnected(self, operation: str) -> None:
        """An operation that this component needs is not connected any more, while the component goes on."""

    def parameter_set(self, name: str, value: Any) -> None:
        """An operational parameter has a value: text for strings and IRIs, else a number or a truth value.

        It is called before `started` for every parameter of the task, and later for one that changes.
        """

    def emit(self, port: str, value: Any, time: float | None = None, media: str = "") -> None:
        """Issue a signal on an output: any value that JSON has, bytes, or an array. Nothing happens while not active.

        `time` is its time in seconds, now by default. Bytes and arrays, those of NumPy and whatever else has a buffer
        of numbers, travel as they are; `media` is their media type, such as `image/png`. What is emitted may be changed
        afterwards. What no signal can carry, or is not of the type that is advertised, is a FAIL with the cause
        `malformed`. Raises ProgrammerError for an output that is not advertised.
        """
        self._attached().outputs.emit(port, value, time, media)

    def call(
        self,
        operation: str,
        request: Any = None,
        *,
        answered: Callable[[Response], None],
        seconds: float = 2.0,
        media: str = "",
    ) -> None:
        """Call an operation that this component needs: the component that is connected to it is asked, once.

        `request` is what is sent along, of what signals can carry, and of 1 MiB at most; `media` is the media type of
        bytes. `answered` is called with what has come of it within that many seconds, above zero, unless the component
        was stopped meanwhile. Nothing happens while not active. Raises ProgrammerError for an operation that is not
        advertised, for what no request can carry, for a time that is not above zero, and for an `answered` that is no
        function.
        """
        self._attached().needed_operations.call(operation, request, seconds, answered, media)

    def fail(self, reason: str) -> None:
        """Raise FAIL: the component cannot act in its role any more, or not begin to. The configurator turns it off."""
        self._attached().fail(reason)

    def every(self, seconds: float, action: Callable[[], None]) -> None:
        """Call `action` at that interval, in seconds above zero, as long as the component stays active.

        Raises ProgrammerError for an interval that is not above zero, and for an action that is no function.
        """
        self._attached().every(seconds, action)

    @property
    def active(self) -> bool:
        """Whether the component is part of a configuration and has not failed."""
        return self._runtime is not None and self._runtime.active

    def _attached(self) -> ComponentRuntime:
        if self._runtime is None:
            name = type(self).__name__
            raise ProgrammerError(
                f"{name} is not part of an ecology yet; hand it to `main` or a Host, and begin in `started`"
            )
        return self._runtime

    @classmethod
    def advertisement_path(cls) -> Path:
        """Where the advertisement is; raises ProgrammerError if the class names none."""
        if not cls.advertisement:
            raise ProgrammerError(f"{cls.__name__} needs an `advertisement`: the Turtle file that says what it is")
        try:
            folder = Path(inspect.getfile(cls)).parent
        except (OSError, TypeError):  # the class is in no file: it was typed in a notebook, or at a prompt
            folder = Path()
        return folder / cls.advertisement
