"""What a configurator knows about its task, as values."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Set
from dataclasses import field
from enum import Enum, IntEnum

from selfconf.configurator.events import Call
from selfconf.configurator.starting_order import Callers, Plan
from selfconf.model.configuration import Configuration
from selfconf.model.holder import Holder
from selfconf.model.immutable import immutable, replace
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.sharing import Avoided, contested_by
from selfconf.model.term import IRI, Term
from selfconf.protocol.messages import Cause, Wires

MOST_PUT_OFF = 10
"""How many searches in a row may find nothing and not count, for what has appeared meanwhile."""


class Phase(str, Enum):
    """Where the configurator is."""

    IDLE = "idle"
    DISCOVERING = "discovering"
    COMPOSING = "composing"
    RESERVING = "reserving"
    DEPLOYING = "deploying"
    RUNNING = "running"
    DISMANTLING = "dismantling"
    REFUSED = "refused"
    STOPPED = "stopped"


class Policy(str, Enum):
    """What to do with the rest of a configuration when a component is lost."""

    REPAIR = "repair"
    DISMANTLE = "dismantle"


class Applied(IntEnum):
    """How far a component has come with what it is to do for a task."""

    NOT_YET = 0
    """It does not act, as far as is known."""
    SENT = 1
    """It was applied to: it may act, if with other inputs."""
    ACTS = 2
    """It has said that it acts, if with other inputs."""
    CONFIRMED = 3
    """It has said that it acts with these inputs and values, for these callers."""


@immutable
class Held:
    """A component that was called for this task: what it is to do, and how far that has come."""

    inputs: Wires
    values: Mapping[str, Term] = field(default_factory=dict)
    callers: Callers = field(default_factory=dict)
    life: str = ""
    asked: bool = False
    """Whether it was asked to be held for this task, or no more, and has not answered: it may be held.

    So is what was adopted, until it has obeyed a claim.
    """
    reserved: bool = False
    """Whether it has said that it is held for this task."""
    applied: Applied = Applied.NOT_YET
    rests: bool = False
    """Whether it is an actuator that is to rest by its last call, as something lacks a part."""

    @property
    def active(self) -> bool:
        """Whether it was applied to: it may act."""
        return self.applied >= Applied.SENT

    @property
    def acts(self) -> bool:
        """Whether it has said that it acts."""
        return self.applied >= Applied.ACTS

    @property
    def confirmed(self) -> bool:
        """Whether it has said that it acts as it is to."""
        return self.applied is Applied.CONFIRMED

    def at_most(self, applied: Applied) -> Held:
        """Return this component as one that has come so far at most."""
        return replace(self, applied=min(self.applied, applied))

    @property
    def sources(self) -> Iterator[IRI]:
        """The components of which its inputs follow outputs."""
        return (wire.component for wires in self.inputs.values() for wire in wires)

    def is_wired_to(self, components: Set[IRI]) -> bool:
        """Whether it follows some others, or may be called by them."""
        return not components.isdisjoint(
            (*self.sources, *(one.component for some in self.callers.values() for one in some))
        )

    @property
    def may_be_held(self) -> bool:
        """Whether it may be held for this task, as far as is known."""
        return self.asked or self.reserved or self.active

    @property
    def is_adopted(self) -> bool:
        """Whether it acts as the last configurator of the task has told it to, and has not answered this one yet."""
        return self.acts and not self.life


class Revival(IntEnum):
    """Whether the site of a lost component can start it again, its process having ended or being about to."""

    NONE = 0
    """It goes on, or its site cannot start it again."""
    POSSIBLE = 1
    """Its site can start it again."""
    BROKE_EARLY = 2
    """Its site can start it again, but it broke before it acted."""
    LIVES_ANEW = 3
    """It lives again, but broke before it acted: it is tried again after what was not tried."""

    @classmethod
    def where(cls, startable: bool) -> Revival:
        """That of a component that has just been lost."""
        return cls.POSSIBLE if startable else cls.NONE


@immutable
class Loss:
    """Why a component was given up, and in which life."""

    cause: Cause
    detail: str = ""
    life: str = ""
    busy: bool = field(default=False, kw_only=True)
    """Whether another task held it: it may be had once that one lets go of it."""
    answered: bool = field(default=True, kw_only=True)
    """Whether that is known from the component: else it could not be reached, and may well be able to act."""
    revival: Revival = field(default=Revival.NONE, kw_only=True)
    again: bool = field(default=False, kw_only=True)
    """Whether it is the loss of the same life once more, as its end was heard after the component was held anew."""

    @property
    def why(self) -> str:
        """The cause, with its detail if there is one, for people."""
        return f"{self.cause.value}, {self.detail}" if self.detail else self.cause.value

    @property
    def startable(self) -> bool:
        """Whether its site can start it again, or has done so."""
        return self.revival >= Revival.POSSIBLE

    @property
    def broke_early(self) -> bool:
        """Whether it broke before it acted, and its site can start it again, or has done so."""
        return self.revival >= Revival.BROKE_EARLY

    @property
    def lasts(self) -> bool:
        """Whether it was lost for what is known of a life that goes on: it is lost until it lives anew."""
        excused = self.busy or self.startable or self.cause is Cause.CRASH
        return bool(self.life) and self.answered and not excused


@immutable
class State:
    """All that a configurator knows about its task, apart from the advertisements."""

    policy: Policy = Policy.REPAIR
    patient: bool = False
    """Whether a refusal does not end the task: the configurator waits until the ecology has what it needs."""
    task: str = ""
    """The identity of the task."""
    alone: bool = False
    """Whether no other configurator can go on with the task: this one has begun it, and it ends with this one."""
    inside: bool = False
    """Whether the task is the inside of a composite: where it is refused, the whole may do without the composite."""
    priority: int = 0
    phase: Phase = Phase.IDLE
    epoch: int = 0
    attempt: int = 0
    target: Configuration | None = None
    plan: Plan | None = None
    """What the components of the target are to do, and in which order they start, since its deployment began."""
    fallback: Configuration | None = None
    """What ran before a change for the better: if that does not come about, it is what is wanted again."""
    held: Mapping[IRI, Held] = field(default_factory=dict)
    pending: frozenset[tuple[IRI, Call]] = frozenset()
    disagreeing: frozenset[IRI] = frozenset()
    """The components that are applied to again once other tasks that share them want the same of them."""
    unreleased: tuple[tuple[IRI, ...], ...] = ()
    """The components that act on until those that they feed are at rest, wave by wave: all, while dismantling, and what
    is not needed any more, while running."""
    surplus: Mapping[IRI, Wires] = field(default_factory=dict)
    """What each component followed that was not needed any more by what runs, or ran last: these may still act."""
    owed: Mapping[IRI, int] = field(default_factory=dict)
    """The components that were released and have not obeyed yet, each with the epoch of the release."""
    watched: frozenset[IRI] = frozenset()
    lost: Mapping[IRI, Loss] = field(default_factory=dict)
    ended_lives: Mapping[IRI, Loss] = field(default_factory=dict)
    """The last loss of each component that was the end, or the hanging, of a life: the same may be heard again."""
    taken: Mapping[IRI, Holder] = field(default_factory=dict)
    """The components that tasks of the same or a higher priority hold, as of the last discovery.

    Of those that can be shared, the ones of which a configuration that was found would want something else.
    """
    sharers: Mapping[IRI, Holder] = field(default_factory=dict)
    """Such tasks that hold components which can be shared, with what they want of them, as of the last discovery."""
    avoided: Avoided = field(default_factory=dict)
    """What the search that goes on leaves out for the sake of others that share a component."""
    free: frozenset[IRI] = frozenset()
    """The components that have said that they are free since the ecology was last asked: they know it first."""
    offered: frozenset[IRI] = frozenset()
    """The components that are kept for this task for a moment, as it waits for them, or were."""
    asked_about: frozenset[IRI] = frozenset()
    """The components for which the ecology was asked once who holds them, as they have said that another task does."""
    queued: frozenset[IRI] = frozenset()
    """The components that remember that this task waits for them."""
    ignores_holders: bool = False
    """Whether the search that is going on is for what there would be if the others let go of what they hold."""
    afterwards: Phase = Phase.STOPPED
    """What comes when everything has been released: COMPOSING, REFUSED or STOPPED."""
    refusal: Refusal | Undecided | None = None
    repeats: Mapping[IRI, int] = field(default_factory=dict)
    """How often each component has made the deployment begin anew since the ecology was last asked."""
    rewired: frozenset[IRI] = frozenset()
    """The components whose outputs are issued by others than before, since the deployment that goes on began."""
    rests: bool = False
    """Whether the actuators inside of a composite are to rest, as what the composite is part of is incomplete."""
    unseen: bool = False
    """Whether something that was held was not advertised when the ecology was last asked."""
    has_yielded: bool = False
    """Whether another task has asked for something since this one ran: it may let go of what it had before."""
    news: bool = False
    """Whether something has appeared since the ecology was last asked, or the task has run, and others may have ended.
    """
    improving: bool = False
    """Whether the ecology was asked for what the strategy would rather have than what runs."""
    unsettled: frozenset[IRI] = frozenset()
    """The components that had appeared just before that, which are not changed to before they have stayed."""
    awaits_return: bool = False
    """Whether the last search has found nothing, and waits for what was lost before it counts."""
    return_awaited_since: int = 0
    """The number of the search since which that is waited for, through others that have found nothing; 0: it is not."""
    has_awaited_return: bool = False
    """Whether that was in vain since the last configuration was found: then no search waits again."""
    put_off: int = 0
    """How many searches in a row have found nothing and did not count, for what had appeared meanwhile."""

    def contested(self, configuration: Configuration) -> dict[IRI, Holder]:
        """The components of a configuration that others hold and would share, but want something else of.

        Of those that are held for this task already, others may be about to want the same: a source that is lost is
        lost to all. But for the sake of something better no other task is to change.
        """
        others = {c: one for c, one in self.sharers.items() if c not in self.held or self.phase is Phase.RUNNING}
        return contested_by(others, configuration)

    @property
    def wanted(self) -> Configuration | None:
        """What is to run: during a change for the better still what ran before."""
        return self.fallback or self.target

    @property
    def unchanged(self) -> State:
        """This state, but without a change for the better: that is given up."""
        return replace(self, target=self.wanted, fallback=None)

    @property
    def heeds_others(self) -> bool:
        """Whether searches leave something out as another task held it, or may, when the ecology was last asked."""
        return bool(self.taken or self.sharers or any(loss.busy for loss in self.lost.values()))

    @property
    def left_to_others(self) -> bool:
        """Whether the last search left something out for the sake of other tasks."""
        return bool(self.taken or self.avoided)

    @property
    def ended(self) -> bool:
        """Whether the task has ended, so that nothing is done about it any more."""
        return self.phase is Phase.STOPPED or (self.phase is Phase.REFUSED and not self.patient)

    @property
    def phase_in_words(self) -> str:
        """The name of its phase; `waiting` where there is no configuration and the task goes on."""
        return self.phase.value if self.phase is not Phase.REFUSED or self.ended else "waiting"

    @property
    def searches_again(self) -> bool:
        """Whether a search that finds nothing does not count yet: the next one has more to choose from."""
        return self.asks_again or any(loss.startable for loss in self.lost.values())

    @property
    def goes_on_unseen(self) -> bool:
        """Whether all of the target is held and nothing of it was lost, though some is not advertised any more.

        Then a search that finds nothing says that a site is out of sight, not that a component is.
        """
        if not self.unseen or self.target is None:
            return False
        return all(
            one in self.held and self.held[one].reserved and one not in self.lost for one in self.target.components
        )

    @property
    def may_await_return(self) -> bool:
        """Whether the end of the task waits for what has gone without a word: it may have been cut off for a moment.

        Or for a task of higher priority that has asked for something: a change for the better holds two for a moment.
        """
        gone = self.unseen or any(loss.cause is Cause.CRASH and not loss.startable for loss in self.lost.values())
        waits = not (self.patient or self.inside or self.has_awaited_return)
        return waits and (gone or self.has_yielded)

    @property
    def waits_for_news(self) -> bool:
        """Whether there is nothing to do about the task until something appears, or is free."""
        return self.phase is Phase.REFUSED or (self.phase is Phase.COMPOSING and self.awaits_return)

    @property
    def asks_again(self) -> bool:
        """Whether the ecology is asked again before a refusal; where something appears all the time, not forever."""
        return self.news and self.put_off < MOST_PUT_OFF
