"""The lives of components that have obeyed a task, and what is left of those that have ended, or seem to have."""

from __future__ import annotations

from collections.abc import Iterable

from selfconf.discovery import EcologyView
from selfconf.model.term import IRI

LEFT_BEHIND = 8
"""How many lives of a component are remembered at most that may only be frozen."""


class HeldLives:
    """The lives of the components that one task holds, or has held."""

    def __init__(self, ecology: EcologyView) -> None:
        self._ecology = ecology
        self._held: dict[IRI, str] = {}
        """The life of each component that has obeyed a call of this task, and not yet a release."""
        self._left_behind: dict[IRI, tuple[str, ...]] = {}
        """The lives that have obeyed a call of this task, and ended, or seemed to, before they obeyed a release."""
        self._lost: dict[IRI, str] = {}
        self._called: set[IRI] = set()
        """The components that were asked to be held, or to act, whatever has come of it."""
        self._unborn: set[IRI] = set()
        """The components that had no life when they were to be woken, and have had none since."""
        self._gone: set[IRI] = set()
        """The components without a life for so long that what is left of an earlier one acts for no task, if it is not
        only frozen, and those whose sites have said that their processes have ended; what is owed to them stays owed,
        as one that was frozen goes on with what it did."""

    def life(self, component: IRI) -> str | None:
        """The life of a component that calls mean: the one that is held, else the one that it lives."""
        return self._held.get(component) or self._ecology.life(component)

    def lives_on(self, component: IRI) -> bool:
        """Whether the life that is held lives; where none is, whether the component lives at all."""
        held = self._held.get(component)
        return self._ecology.life(component) is not None if held is None else self._ecology.lives_on(component, held)

    def lost_life(self, component: IRI) -> str:
        """The life of a component that counts as lost when it is woken again, or nothing.

        One that was started for this task, was left behind, or was to be ended, as it did not obey a release.
        """
        return self._lost.get(component, "")

    def never_acted(self, component: IRI) -> bool:
        """Whether a component had no life when it was to be woken, has had none since, and was never called."""
        return component in self._unborn - self._called

    def out_of_control(self, owed: Iterable[IRI]) -> tuple[IRI, ...]:
        """The components that are owed a release and may still act, sorted."""
        return tuple(sorted(one for one in owed if one not in self._gone or self.lives_on(one)))

    def called(self, component: IRI) -> None:
        """Note that a component is asked to be held, or to act."""
        self._called.add(component)
        self._gone.discard(component)

    def awaited(self, component: IRI) -> None:
        """Note that a component is to be woken that has no life."""
        self._unborn.add(component)

    def born(self, component: IRI) -> None:
        """Note that a component lives."""
        self._unborn.discard(component)
        self._gone.discard(component)

    def lost(self, component: IRI, life: str) -> None:
        """Note which life of a component counts as lost when it is woken again."""
        self._lost[component] = life

    def gone(self, component: IRI) -> None:
        """Note that what may be left of a component acts for no task any more."""
        self._gone.add(component)

    def obeyed(self, component: IRI, life: str, late: bool) -> None:
        """Note that a life of a component has obeyed a call of this task.

        One that is heard of `late`, as the call was of an older epoch, is not held if it has ended since, nor in the
        place of another that lives.
        """
        if late and not self._ecology.lives_on(component, life):
            return
        if not (late and component in self._held and self.lives_on(component)):
            self._held[component] = life
        self.caught_up(component, life)

    def has_obeyed(self, component: IRI, life: str) -> bool:
        """Whether a life of a component has obeyed a call of this task, and not yet a release."""
        return self._held.get(component) == life or self.was_left_behind(component, life)

    def released(self, component: IRI) -> None:
        """Note that a component has obeyed a release."""
        self._held.pop(component, None)
        self._lost.pop(component, None)

    def leave_behind(self, component: IRI) -> None:
        """Remember the life of a component that is held and does not live any more: it may only be frozen."""
        life = self._held.pop(component, None)
        if life is not None:
            self._lost[component] = life
            self._left_behind[component] = (*self._left_behind.get(component, ()), life)[-LEFT_BEHIND:]

    def leave_behind_if_ended(self, component: IRI) -> None:
        """Remember the life of a component that is held, if it has ended."""
        held = self._held.get(component)
        if held is not None and not self._ecology.lives_on(component, held):
            self.leave_behind(component)

    def was_left_behind(self, component: IRI, life: str) -> bool:
        """Whether a life of a component was left behind."""
        return life in self._left_behind.get(component, ())

    def caught_up(self, component: IRI, life: str) -> None:
        """Note that a life has answered a call: it has been left behind no longer."""
        left = tuple(one for one in self._left_behind.pop(component, ()) if one != life)
        if left:
            self._left_behind[component] = left
