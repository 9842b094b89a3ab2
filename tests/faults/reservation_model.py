"""An explicit-state model of how tasks reserve the components that they share.

Configurators and components are small state machines. Between a configurator and a component messages keep their
order, between different pairs they overtake each other at will. A configurator reserves the components of its target
one after the other in one order of all components; a component that is held remembers who waits, higher priority
first, then the earlier beginning. When it becomes free it offers itself to the first. A holder of lower priority is
asked to yield: it turns its actuators to rest, releases, and searches again. A waiting task lets go of everything when
the component that it waits for begins to act for somebody else, and stays in the queue. So does one that holds nothing
that acts, when what it lacks is kept for another that goes before. Components of a task may have to be started, at each
attempt anew; what is offered to the task meanwhile it reserves out of turn.

Faults are bounded: a configurator crashes; a component falsely believes that a configurator is gone, and what is on
the way between the two is lost; a holder is slow to yield and is preempted. `Scheme` turns single rules off, so that
the tests can show that each of them is needed.

`tests/faults/exploration.py` explores it.
"""

from __future__ import annotations

from collections.abc import Sequence

from tests.faults.reservation_state import (
    ACTUATORS,
    DEAD,
    ENDED,
    QUEUED,
    RELEASING,
    RESERVING,
    RESTING,
    RUNNING,
    SOURCES,
    WAITING,
    WAKING,
    Claim,
    Configurator,
    Mask,
    Place,
    Scheme,
    State,
    Thawed,
    bits,
)

SEARCH, JOIN, GIVE_UP, ANEW = range(4)
"""What comes after everything was released: go on with the target, stay in the queue, end, or search among all."""
ANSWERS = {
    RESERVING: ("reserved", "wait", "kept", "acting", "lower"),
    WAKING: ("reserved", "wait", "kept", "acting", "lower"),
    SOURCES: ("applied", "refused"),
    ACTUATORS: ("applied", "refused"),
    RESTING: ("rested",),
    RELEASING: ("released",),
}
"""The answers that a configurator waits for in each phase."""


class World:
    """One state, taken apart so that it can be changed."""

    def __init__(self, claims: Sequence[Claim], scheme: Scheme, places: int, state: State) -> None:
        self.claims, self.scheme, self.count = claims, scheme, places
        configurators, components, there, back, budget = state
        self.configurators = Thawed(Configurator, configurators)
        self.places = Thawed(Place, components)
        self.there, self.back, self.budget = list(there), list(back), list(budget)

    def freeze(self) -> State:
        """The state as a value."""
        return (
            self.configurators.freeze(),
            self.places.freeze(),
            tuple(self.there),
            tuple(self.back),
            (self.budget[0], self.budget[1], self.budget[2]),
        )

    def call(self, who: int, component: int, message: str) -> None:
        """A message from a configurator to a component."""
        self.there[who * self.count + component] += (message,)

    def say(self, component: int, who: int, message: str) -> None:
        """A message from a component to a configurator."""
        if self.configurators[who].phase != DEAD:
            self.back[who * self.count + component] += (message,)

    # The component.

    def before(self, who: int, other: int) -> bool:
        """Whether one comes before another in every queue: by priority, then by the beginning."""
        return (-self.claims[who].priority, who) < (-self.claims[other].priority, other)

    def offer_next(self, component: int) -> None:
        """Offer a free component to the first that waits and has not been offered it yet."""
        place = self.places[component]
        if place.holder >= 0:
            place.offered = 0
        place.holder, place.acting, place.offer, place.asked = -1, 0, -1, 0
        for who in bits(place.queue & ~place.offered):
            if place.offer < 0 or self.before(who, place.offer):
                place.offer = who
        if place.offer >= 0:
            place.offered |= 1 << place.offer
            self.say(component, place.offer, "free")

    def forget(self, component: int, who: int) -> None:
        """A component takes a configurator for gone."""
        place = self.places[component]
        place.queue &= ~(1 << who)
        if who in (place.holder, place.offer):
            self.offer_next(component)

    def arrive(self, who: int, component: int) -> None:
        """The next message of a configurator arrives at a component."""
        index = who * self.count + component
        message, self.there[index] = self.there[index][0], self.there[index][1:]
        place = self.places[component]
        if message == "reserve":
            self._reserved(who, component, place)
        elif message == "rest":
            if place.holder == who:
                place.acting = 0
            self.say(component, who, "rested")
        elif message == "release":
            self.forget(component, who)
            self.say(component, who, "released")
        else:
            self._applied(who, component, place, int(message))

    def _reserved(self, who: int, component: int, place: Place) -> None:
        free = place.holder < 0 and (place.offer in (-1, who) or self.before(who, place.offer))
        if place.holder == who or free:
            place.holder, place.offer, place.queue = who, -1, place.queue & ~(1 << who)
            self.say(component, who, "reserved")
            return
        lower = place.holder >= 0 and self.claims[who].priority > self.claims[place.holder].priority
        if lower and not self.scheme.asks_to_yield:
            self.say(component, place.holder, "lost")
            place.holder, place.acting = who, 0
            self.say(component, who, "reserved")
            return
        if self.scheme.one_by_one:
            place.queue |= 1 << who
        if lower and not place.asked:
            place.asked = 1
            self.say(component, place.holder, "yield")
        kept = "wait" if place.holder >= 0 else "kept"
        self.say(component, who, "lower" if lower else "acting" if place.acting else kept)

    def _applied(self, who: int, component: int, place: Place, target: Mask) -> None:
        if place.holder != who:
            self.say(component, who, "refused")
            return
        if self.scheme.tells_waiting and not place.acting:
            for other in bits(place.queue):
                if self.claims[other].priority <= self.claims[who].priority:
                    self.say(component, other, "held")
        place.acting = target
        self.say(component, who, "applied")

    # The configurator.

    def search(self, who: int) -> Mask:
        """The first target without what is excluded; 0 if there is none."""
        excluded = self.configurators[who].excluded
        return next((target for target in self.claims[who].targets if not target & excluded), 0)

    def seek(self, who: int, retry: bool) -> None:
        """Search, release what is surplus, and reserve the rest; `retry`: if nothing is left, wait for the first."""
        one, claim = self.configurators[who], self.claims[who]
        target = self.search(who)
        if not target and claim.patient and retry:
            one.excluded = 0
            target = self.search(who)
            one.target = target
            self.release(who, one.held | one.queued, SEARCH)
            return
        if not target:
            one.target = 0
            if claim.patient and one.queued:
                self.release(who, one.held, JOIN)
            else:
                self.release(who, one.held | one.queued, GIVE_UP)
            return
        one.target = target
        surplus = one.held & ~target
        lacking = target & ~one.held
        if lacking and self.scheme.keeps_order:
            first = lacking & -lacking
            surplus |= one.held & ~one.confirmed & ~(first - 1)
        self.release(who, surplus, SEARCH)

    def release(self, who: int, components: Mask, after: int) -> None:
        """Release components; when all have confirmed it comes `after`."""
        one = self.configurators[who]
        one.phase, one.pending, one.after = RELEASING, components, after
        one.held &= ~components
        one.confirmed &= ~components
        one.queued &= ~components
        for component in bits(components):
            self.call(who, component, "release")
        self.released(who)

    def released(self, who: int) -> None:
        """Go on once everything is released."""
        one = self.configurators[who]
        if one.pending:
            return
        if one.wanted & one.held:
            self.yields(who)
        elif one.after == SEARCH:
            if not one.target or one.target & one.excluded:
                self.seek(who, retry=True)
            else:
                self.wake(who)
        elif one.after == ANEW:
            one.excluded = 0
            self.seek(who, retry=False)
        elif one.after == JOIN:
            one.phase = QUEUED
            if not one.queued:  # everything it waited for has become free meanwhile
                one.excluded = 0
                self.seek(who, retry=False)
        else:
            one.phase, one.target = ENDED, 0

    def wake(self, who: int) -> None:
        """Have what is dormant of the target started, and reserve meanwhile what has been offered; then the rest."""
        one = self.configurators[who]
        lacking = one.target & ~one.held
        offered, one.offered = one.offered & lacking, 0
        if not self.claims[who].dormant & lacking:
            self.reserve(who)
            return
        one.phase, one.pending = WAKING, offered
        for component in bits(offered):
            self.call(who, component, "reserve")

    def woken(self, who: int) -> None:
        """All components live: go on with what is not reserved yet."""
        one = self.configurators[who]
        if one.pending:
            one.phase = RESERVING
        else:
            self.reserve(who)

    def reserve(self, who: int) -> None:
        """Reserve what is lacking of the target, or activate it once nothing is."""
        one = self.configurators[who]
        lacking = one.target & ~one.held
        if not lacking:
            self.activate(who)
            return
        one.phase = RESERVING
        wanted = bits(lacking) if not self.scheme.one_by_one else bits(lacking)[:1]
        one.pending = 0
        for component in wanted:
            one.pending |= 1 << component
            self.call(who, component, "reserve")

    def activate(self, who: int) -> None:
        """Apply to sources, then to actuators; then the task runs."""
        one, claim = self.configurators[who], self.claims[who]
        if one.wanted & one.held:
            self.yields(who)
            return
        sources = one.target & ~claim.actuators & ~one.confirmed
        rest = one.target & ~one.confirmed
        one.phase = SOURCES if sources else ACTUATORS if rest else RUNNING
        one.pending = sources or rest
        for component in bits(one.pending):
            self.call(who, component, str(one.target))
        if one.phase == RUNNING:
            one.excluded = 0
            queued, one.queued = one.queued, 0
            for component in bits(queued):
                self.call(who, component, "release")

    def yields(self, who: int) -> None:
        """Turn the actuators to rest, then release what a task of higher priority wants."""
        one = self.configurators[who]
        acting = one.confirmed & self.claims[who].actuators
        one.phase, one.pending = RESTING, acting
        one.confirmed &= ~acting
        for component in bits(acting):
            self.call(who, component, "rest")
        if not self.scheme.rests_first:
            one.pending = 0
        self.rested(who)

    def rested(self, who: int) -> None:
        """Go on once all actuators rest."""
        one = self.configurators[who]
        if one.pending:
            return
        one.excluded |= one.wanted & one.held
        one.wanted = 0
        if one.after == GIVE_UP:
            self.release(who, one.held | one.queued, GIVE_UP)
        else:
            self.seek(who, retry=True)

    def hear(self, component: int, who: int) -> None:
        """The next message of a component arrives at a configurator."""
        index = who * self.count + component
        message, self.back[index] = self.back[index][0], self.back[index][1:]
        one, bit = self.configurators[who], 1 << component
        if message in ("free", "held", "yield", "lost"):
            self._event(who, component, message)
        elif one.pending & bit and message in ANSWERS.get(one.phase, ()):  # else it answers a call that was taken back
            one.pending &= ~bit
            if one.phase in (RESERVING, WAKING):
                self._answered(who, bit, message)
            elif message == "refused":
                one.held &= ~bit
                self._part_answered(who)
            elif message == "applied":
                one.confirmed |= bit
                self._part_answered(who)
            elif one.phase == RESTING:
                self.rested(who)
            else:
                self.released(who)

    def _part_answered(self, who: int) -> None:
        """Go on with the activation once every call of this stage is answered; without a part, reserve again."""
        one = self.configurators[who]
        if not one.pending:
            self.yields(who) if one.target & ~one.held else self.activate(who)

    def _answered(self, who: int, bit: Mask, message: str) -> None:
        one = self.configurators[who]
        if message == "reserved":
            one.held |= bit
            one.queued &= ~bit
            if not one.pending and one.phase == RESERVING:
                self.reserve(who) if self.scheme.one_by_one or not one.target & ~one.held else self._back_off(who)
        elif not self.scheme.one_by_one:
            if not one.pending:
                self._back_off(who)
        elif one.phase == WAKING:
            one.queued |= bit  # its turn comes
        else:
            one.queued |= bit
            in_order = self.claims[who].patient and not self._out_of_order(one, bit)
            if message == "kept":
                in_order = in_order and (not one.held or bool(one.held & one.confirmed))
            if message == "lower" or (message in ("wait", "kept") and in_order):
                one.phase, one.pending = WAITING, bit
            else:
                one.excluded |= bit
                self.seek(who, retry=False)

    def _back_off(self, who: int) -> None:
        self.release(who, self.configurators[who].held, SEARCH)

    def _out_of_order(self, one: Configurator, bit: Mask) -> bool:
        return self.scheme.keeps_order and bool(one.held & ~(bit - 1))

    def _event(self, who: int, component: int, message: str) -> None:
        one, bit = self.configurators[who], 1 << component
        waits = self._waits_for(one, bit)
        if message == "free":
            self._freed(who, bit, waits)
        elif message == "held":
            if waits:
                one.excluded |= bit
                self.seek(who, retry=False)
        elif message == "yield":
            if one.held & bit:
                one.wanted |= bit
                if one.phase in (RESERVING, WAITING, WAKING):
                    self._yields_early(who)
                elif one.phase == RUNNING:
                    self.yields(who)
        elif one.held & bit:
            self._lose(who, bit)

    def _waits_for(self, one: Configurator, bit: Mask) -> bool:
        return one.phase == WAITING and bool(one.pending & bit)

    def _freed(self, who: int, bit: Mask, waits: bool) -> None:
        one = self.configurators[who]
        one.excluded &= ~bit
        if waits:
            one.phase = RESERVING
            self.call(who, bit.bit_length() - 1, "reserve")
        elif one.phase == QUEUED:
            one.excluded, one.offered = 0, bit
            self.seek(who, retry=False)
        elif one.phase == WAKING and one.target & ~one.held & bit:
            if not one.pending & bit:
                one.pending |= bit
                self.call(who, bit.bit_length() - 1, "reserve")
        elif one.queued & bit and not (one.phase == RESERVING and one.pending & bit):
            one.queued &= ~bit
            self.call(who, bit.bit_length() - 1, "release")
            if one.phase == RELEASING and one.after == JOIN:
                one.after = ANEW  # it may be what was lacking

    def _yields_early(self, who: int) -> None:
        """Let go of all while reserving: nothing acts yet."""
        one = self.configurators[who]
        asked = one.pending
        one.excluded |= one.wanted & one.held
        one.wanted, one.target = 0, 0
        surplus = (
            one.held | one.queued | asked if self.scheme.keeps_order else one.excluded & one.held | one.queued | asked
        )
        self.release(who, surplus, SEARCH)

    def _lose(self, who: int, bit: Mask) -> None:
        one = self.configurators[who]
        one.held &= ~bit
        one.confirmed &= ~bit
        if one.phase in (RESERVING, WAITING, WAKING):
            asked = one.pending
            one.target = 0
            self.release(who, one.held | one.queued | asked, SEARCH)
        elif one.phase == RUNNING:
            self.yields(who)

    # Time and faults.

    def quiet(self, who: int, component: int) -> bool:
        """Whether nothing is on the way between a configurator and a component."""
        index = who * self.count + component
        return not self.there[index] and not self.back[index]

    def time_out(self, who: int, component: int) -> bool:
        """Make a call again whose answer was lost; whether there is one."""
        one, bit = self.configurators[who], 1 << component
        if not one.pending & bit or not self.quiet(who, component):
            return False
        if one.phase in (RESERVING, WAKING):
            self.call(who, component, "reserve")
        elif one.phase in (SOURCES, ACTUATORS):
            self.call(who, component, str(one.target))
        elif one.phase == RESTING:
            self.call(who, component, "rest")
        elif one.phase == RELEASING:
            self.call(who, component, "release")
        else:
            return False
        return True

    def look(self, who: int, component: int) -> bool:
        """Notice what a component has forgotten, by asking from time to time; whether there is anything."""
        one, bit, place = self.configurators[who], 1 << component, self.places[component]
        if not self.quiet(who, component) or one.phase in (DEAD, ENDED):
            return False
        if one.phase == RUNNING and one.held & bit and place.holder != who:
            self._lose(who, bit)
            return True
        if one.queued & bit and not place.queue >> who & 1 and place.offer != who and one.phase in (WAITING, QUEUED):
            one.queued &= ~bit
            self._freed(who, bit, self._waits_for(one, bit))
            return True
        return False
