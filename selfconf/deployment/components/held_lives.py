"""The lives of components that have obeyed a task, and what is left of those that have ended, or seem to have."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass

from selfconf.discovery import EcologyView
from selfconf.model.term import IRI

LEFT_BEHIND = 8
"""How many lives of a component are remembered at most that may only be frozen."""


@dataclass(slots=True)
class _ComponentLives:
    """What one task knows of the lives of one component."""

    held: str | None = None
    """The life that has obeyed a call of this task, and not yet a release."""
    obeyed: tuple[str, int] = ("", 0)
    """The life that has obeyed a call of this task last, and the newest epoch of such a call."""
    left_behind: tuple[str, ...] = ()
    """The lives that have obeyed a call of this task, and ended, or seemed to, before they obeyed a release."""
    lost: str = ""
    """The life that counts as lost when the component is woken again."""
    called: bool = False
    """Whether it was asked to be held, or to act, whatever has come of it."""
    unborn: bool = False
    """Whether it had no life when it was to be woken, and has had none since."""
    gone: bool = False
    """Whether it has had no life for so long that what is left of an earlier one acts for no task, if that is not only
    frozen, or its site has said that its process has ended; what is owed to it stays owed, as one that was frozen goes
    on with what it did."""


class HeldLives:
    """The lives of the components that one task holds, or has held."""

    def __init__(self, ecology: EcologyView) -> None:
        self._ecology = ecology
        self._of: defaultdict[IRI, _ComponentLives] = defaultdict(_ComponentLives)

    def life(self, component: IRI) -> str | None:
        """The life of a component that calls mean: the one that is held, else the one that it lives."""
        return self._of[component].held or self._ecology.life(component)

    def lives_on(self, component: IRI) -> bool:
        """Whether the life that is held lives; where none is, whether the component lives at all."""
        held = self._of[component].held
        return self._ecology.life(component) is not None if held is None else self._ecology.lives_on(component, held)

    def lost_life(self, component: IRI) -> str:
        """The life of a component that counts as lost when it is woken again, or nothing.

        One that was started for this task, was left behind, or was to be ended, as it did not obey a release.
        """
        return self._of[component].lost

    def never_acted(self, component: IRI) -> bool:
        """Whether a component had no life when it was to be woken, has had none since, and was never called."""
        return self._of[component].unborn and not self._of[component].called

    def out_of_control(self, owed: Iterable[IRI]) -> tuple[IRI, ...]:
        """The components that are owed a release and may still act, sorted."""
        return tuple(sorted(one for one in owed if not self._of[one].gone or self.lives_on(one)))

    def called(self, component: IRI) -> None:
        """Note that a component is asked to be held, or to act."""
        self._of[component].called, self._of[component].gone = True, False

    def awaited(self, component: IRI) -> None:
        """Note that a component is to be woken that has no life."""
        self._of[component].unborn = True

    def born(self, component: IRI) -> None:
        """Note that a component lives."""
        self._of[component].unborn = self._of[component].gone = False

    def lost(self, component: IRI, life: str) -> None:
        """Note which life of a component counts as lost when it is woken again."""
        self._of[component].lost = life

    def gone(self, component: IRI) -> None:
        """Note that what may be left of a component acts for no task any more."""
        self._of[component].gone = True

    def obeyed(self, component: IRI, life: str, epoch: int, late: bool) -> None:
        """Note that a life of a component has obeyed a call of this task.

        One that is heard of `late`, as the call was of an older epoch, is not held if it has ended since, nor in the
        place of another that lives.
        """
        if late and not self._ecology.lives_on(component, life):
            return
        known = self._of[component]
        if not (late and known.held is not None and self.lives_on(component)):
            known.held = life
        known.obeyed = life, max(epoch, known.obeyed[1] if known.obeyed[0] == life else 0)
        self.caught_up(component, life)

    def has_obeyed_since(self, component: IRI, life: str, epoch: int) -> bool:
        """Whether a life of a component has obeyed a call of this task that is newer than an epoch."""
        known = self._of[component]
        return known.obeyed[0] == life and known.obeyed[1] > epoch

    def has_obeyed(self, component: IRI, life: str) -> bool:
        """Whether a life of a component has obeyed a call of this task, and not yet a release."""
        return self._of[component].held == life or self.was_left_behind(component, life)

    def released(self, component: IRI, epoch: int) -> None:
        """Note that a component has obeyed a release of an epoch, unless it has obeyed a newer call meanwhile."""
        known = self._of[component]
        if known.obeyed[1] <= epoch:
            known.held, known.lost = None, ""

    def leave_behind(self, component: IRI) -> None:
        """Remember the life of a component that is held and does not live any more: it may only be frozen."""
        known = self._of[component]
        if known.held is not None:
            known.lost, known.left_behind = known.held, (*known.left_behind, known.held)[-LEFT_BEHIND:]
            known.held = None

    def leave_behind_if_ended(self, component: IRI) -> None:
        """Remember the life of a component that is held, if it has ended."""
        if not self.lives_on(component):
            self.leave_behind(component)

    def was_left_behind(self, component: IRI, life: str) -> bool:
        """Whether a life of a component was left behind."""
        return life in self._of[component].left_behind

    def caught_up(self, component: IRI, life: str) -> None:
        """Note that a life has answered a call: it has been left behind no longer."""
        known = self._of[component]
        known.left_behind = tuple(one for one in known.left_behind if one != life)
