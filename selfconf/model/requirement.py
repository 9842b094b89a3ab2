"""What a configuration has to meet, one by one: the words in which a refusal says what cannot hold together."""

from __future__ import annotations

from selfconf.model.immutable import immutable
from selfconf.model.profile import WantedSignal
from selfconf.model.term import IRI


@immutable
class RolePlayed:
    """A role is played by as many components as it asks for at least."""

    role: IRI

    def __str__(self) -> str:
        return f"{self.role.short} is played"


@immutable
class InputFed:
    """The components that play a role get a signal.

    Where an interaction into the role names an input, `input` is the first that the same interactions may feed.
    """

    role: IRI
    wanted: WantedSignal
    input: str | None = None

    def __str__(self) -> str:
        port = f" at {self.input!r}" if self.input else ""
        return f"{self.role.short} gets the {self.wanted} that it needs{port}"


@immutable
class OneValue:
    """A free parameter, by name, has one value that all candidates chosen admit."""

    parameter: str

    def __str__(self) -> str:
        return f"there is one {self.parameter} for all"


@immutable
class OneRoleEach:
    """No component plays two roles."""

    def __str__(self) -> str:
        return "no component plays two roles"


Requirement = RolePlayed | InputFed | OneValue | OneRoleEach
