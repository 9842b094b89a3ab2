"""Every interleaving of the messages and faults of the model of reservation, depth first.

What is found wrong, by name:

    acts on part    an actuator acts although a part of its configuration is not held for the same task
    deadlock        nothing can happen any more, and a configurator waits for components that it could have
    livelock        a cycle of messages: it may go on forever
    nobody wins     without any fault, in the end no task runs
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from tests.faults.reservation_model import GIVE_UP, SEARCH, World
from tests.faults.reservation_state import (
    DEAD,
    ENDED,
    QUEUED,
    RESERVING,
    RUNNING,
    WAITING,
    WAKING,
    Claim,
    Configurator,
    Scheme,
    State,
    bits,
)

Path = list[tuple[str, State, Iterator[tuple[str, State]]]]
"""The actions and states from the beginning to the present one, each with what can come next."""


@dataclass(frozen=True, slots=True)
class Bounds:
    """How many faults there may be, and how many states are explored at most."""

    crashes: int = 0
    cuts: int = 0
    preemptions: int = 0
    ends: bool = False
    """Whether a running task may end of its own will."""
    states: int = 400_000

    @property
    def faultless(self) -> bool:
        """Whether there are no faults."""
        return not (self.crashes or self.cuts or self.preemptions)


@dataclass(slots=True)
class Findings:
    """What an exploration found: wrong things by name, each with the actions that lead there."""

    states: int = 0
    complete: bool = True
    """Whether every state was explored."""
    wrong: dict[str, tuple[str, ...]] = field(default_factory=dict)

    def note(self, name: str, path: Path) -> None:
        """Something is wrong at the end of a path; the first path is kept."""
        if name not in self.wrong:
            self.wrong[name] = tuple(action for action, *_ in path)


def acts_on_part(claims: Sequence[Claim], state: State) -> bool:
    """Whether an actuator acts although a part of its configuration is not held for the same task."""
    places = state[1]
    for index, (holder, acting, *_) in enumerate(places):
        if acting and holder >= 0 and claims[holder].actuators >> index & 1:
            for part in bits(acting):
                if places[part][0] != holder:
                    return True
    return False


def could_run(claims: Sequence[Claim], state: State) -> bool:
    """Whether a configurator waits although some target of its is free, or held by tasks that it need not wait for."""
    configurators, places = state[0], state[1]
    for who, one in enumerate(configurators):
        if one[0] in (RUNNING, ENDED, DEAD):
            continue
        if one[0] not in (WAITING, QUEUED):
            return True
        for target in claims[who].targets:
            holders = {places[part][0] for part in bits(target)} - {-1, who}
            if all(
                configurators[other][0] != RUNNING or claims[other].priority < claims[who].priority for other in holders
            ):
                return True
    return False


class Exploration:
    """All that can happen from some claims under a scheme, within bounds."""

    def __init__(self, claims: Sequence[Claim], scheme: Scheme, bounds: Bounds) -> None:
        self.claims, self.scheme, self.bounds = claims, scheme, bounds
        self.places = max(max(claim.targets).bit_length() for claim in claims)

    def world(self, state: State) -> World:
        """A state that can be changed."""
        return World(self.claims, self.scheme, self.places, state)

    def start(self) -> State:
        """The state in which every configurator has just begun."""
        idle = (RESERVING, 0, 0, 0, 0, 0, 0, 0, SEARCH, 0)
        pairs = len(self.claims) * self.places
        budget = self.bounds.crashes, self.bounds.cuts, self.bounds.preemptions
        free = (-1, 0, -1, 0, 0, 0)
        world = self.world(((idle,) * len(self.claims), (free,) * self.places, ((),) * pairs, ((),) * pairs, budget))
        for who in range(len(self.claims)):
            world.seek(who, retry=False)
        return world.freeze()

    def successors(self, state: State) -> Iterator[tuple[str, State]]:
        """Every action that can come next, with the state it leads to."""
        yield from self._messages(state)
        for component in range(self.places):
            yield from self._changes_of_mind(state, component)
        for who in range(len(self.claims)):
            yield from self._ends(state, who)
            if state[0][who][0] == WAKING:
                new = self.world(state)
                new.woken(who)
                yield f"all of {who} live", new.freeze()
            if self.bounds.cuts and self.scheme.asks_again:
                yield from self._second_looks(state, who)

    def _messages(self, state: State) -> Iterator[tuple[str, State]]:
        configurators, _, there, back, _ = state
        for who in range(len(self.claims)):
            for component in range(self.places):
                index = who * self.places + component
                if there[index]:
                    new = self.world(state)
                    new.arrive(who, component)
                    yield f"{component} hears {there[index][0]} of {who}", new.freeze()
                if back[index]:
                    new = self.world(state)
                    if configurators[who][0] == DEAD:
                        new.back[index] = ()
                    else:
                        new.hear(component, who)
                    yield f"{who} hears {back[index][0]} of {component}", new.freeze()

    def _changes_of_mind(self, state: State, component: int) -> Iterator[tuple[str, State]]:
        """What a component does by itself: end an offer, notice an end, rightly or wrongly, preempt."""
        configurators, components, *_, (_, cuts, preemptions) = state
        holder, _, offer, queue, asked, _ = components[component]
        if offer >= 0 and self.scheme.offers_end and configurators[offer][0] != DEAD:
            new = self.world(state)
            if new.quiet(offer, component):
                new.offer_next(component)
                yield f"{component} ends its offer to {offer}", new.freeze()
        for who, one in enumerate(configurators):
            known = who in (holder, offer) or bool(queue >> who & 1)
            if known and one[0] == DEAD:
                new = self.world(state)
                new.forget(component, who)
                yield f"{component} notices the end of {who}", new.freeze()
            elif known and cuts:
                new = self.world(state)
                index = who * self.places + component
                new.there[index], new.back[index], new.budget[1] = (), (), cuts - 1
                new.forget(component, who)
                yield f"{component} wrongly takes {who} for gone", new.freeze()
        if preemptions and asked and holder >= 0:
            new = self.world(state)
            new.budget[2] = preemptions - 1
            new.say(component, holder, "lost")
            new.offer_next(component)
            yield f"{component} preempts {holder}", new.freeze()

    def _ends(self, state: State, who: int) -> Iterator[tuple[str, State]]:
        configurators, *_, (crashes, _, _) = state
        alive = sum(one[0] != DEAD for one in configurators)
        if crashes and configurators[who][0] not in (DEAD, ENDED) and alive > 1:
            new = self.world(state)
            new.configurators[who] = Configurator((DEAD, 0, 0, 0, 0, 0, 0, 0, 0, 0))
            new.budget[0] = crashes - 1
            for index in range(who * self.places, (who + 1) * self.places):
                new.back[index] = ()
            yield f"{who} crashes", new.freeze()
        if self.bounds.ends and configurators[who][0] == RUNNING:
            new = self.world(state)
            new.configurators[who].after = GIVE_UP
            new.yields(who)
            yield f"{who} ends", new.freeze()

    def _second_looks(self, state: State, who: int) -> Iterator[tuple[str, State]]:
        new = self.world(state)  # one that is looked at in vain is as it was
        for component in range(self.places):
            if new.time_out(who, component):
                yield f"{who} calls {component} again", new.freeze()
                new = self.world(state)
            if new.look(who, component):
                yield f"{who} looks at {component}", new.freeze()
                new = self.world(state)

    def explore(self) -> Findings:
        """Explore every interleaving, depth first, and say what is wrong, if anything is."""
        first = self.start()
        findings = Findings()
        on_path: dict[State, bool] = {first: True}
        """Every state that was seen, and whether it lies on the present path."""
        path = [("begin", first, self.successors(first))]
        leaves = [True]
        while path:
            _, state, following = path[-1]
            action, new = next(following, ("", None))
            if new is None:
                if leaves.pop():
                    self._judge_end(state, path, findings)
                on_path[state] = False
                path.pop()
                continue
            leaves[-1] = False
            known = on_path.get(new)
            if known is None:
                if len(on_path) >= self.bounds.states:
                    findings.complete = False
                    break
                on_path[new] = True
                path.append((action, new, self.successors(new)))
                leaves.append(True)
                if self.bounds.faultless and acts_on_part(self.claims, new):
                    findings.note("acts on part", path)
            elif known:
                findings.note("livelock", path)
        findings.states = len(on_path)
        return findings

    def _judge_end(self, state: State, path: Path, findings: Findings) -> None:
        """What is wrong with a state in which nothing can happen any more."""
        if could_run(self.claims, state):
            findings.note("deadlock", path)
        if acts_on_part(self.claims, state):
            findings.note("acts on part", path)
        if self.bounds.faultless and not self.bounds.ends and all(one[0] != RUNNING for one in state[0]):
            findings.note("nobody wins", path)


def explore(claims: Sequence[Claim], scheme: Scheme | None = None, bounds: Bounds | None = None) -> Findings:
    """Explore every interleaving of some claims, by default under all rules and without faults."""
    return Exploration(claims, scheme or Scheme(), bounds or Bounds()).explore()
