"""What every part of the runtime of a component is given: its bus, its thread, its profile, its life, FAIL."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Protocol

from selfconf.bus.port import Bus
from selfconf.model.immutable import immutable
from selfconf.model.profile import Profile
from selfconf.model.signal_fields import SignalFields
from selfconf.model.term import IRI
from selfconf.protocol.activation import Activation
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Cause
from selfconf.sdk.code_thread import CodeThread


class RaiseFail(Protocol):
    """Raises FAIL for a component; may be called from any thread."""

    def __call__(self, reason: str, cause: Cause = Cause.FAIL) -> None: ...


@immutable
class ComponentContext:
    """One life of a component, as the parts of its runtime see it."""

    bus: Bus
    keys: Keys
    profile: Profile
    life: str
    """The name of this life of the component."""
    thread: CodeThread
    """Runs the code of the component."""
    fields: Mapping[IRI, SignalFields]
    """Those of the kinds of signals, as far as they are known."""
    activation: Callable[[], Activation]
    """Returns for which tasks the component is held now, and which wait for it."""
    fail: RaiseFail

    def malformed(self, problem: str) -> None:
        """Raise FAIL for what the component has emitted and is not of the type that its advertisement promises."""
        self.fail(problem, Cause.MALFORMED)
