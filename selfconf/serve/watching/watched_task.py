"""A task as an observer sees it: by the status of its configurator, by its notices, and by what it has deployed."""

from __future__ import annotations

from selfconf.model.term import IRI
from selfconf.protocol.keys import task_name
from selfconf.protocol.messages import Notice, Status
from selfconf.serve.watching.change import Body
from selfconf.serve.watching.checked import checked_event

ENDED = {"stopped": "stopped", "refused": "refused", "detached": "detached"}
"""The phase in which a task ends, by the last event of its run."""
TOLD = frozenset(
    {
        *("composed", "waking", "awaiting", "activated", "released", "declined", "unreachable", "lost", "running"),
        *("waiting", "refused", "stopped", "detached", "cut off", "connected", "complaint", "left out"),
    }
)
"""The acts of a run that clients of `/events` hear of; which are worth a line, `page/model.js` says."""

_UNKNOWN = Status("", "unknown", IRI.unchecked(""), 0, 0.0)
"""What is said of a task whose configurator has not said anything yet."""


class WatchedTask:
    """What is known of one task and its configurator."""

    def __init__(self, configurator: str) -> None:
        self.configurator = configurator
        self.alive = True
        self.is_leaving = False
        """Whether the life of its configurator has ended, whose last notice may still come."""
        self.is_told = False
        """Whether its configurator has told of it as sites would keep it."""
        self.status: Status | None = None
        self.sequence = 0
        """The number of the last event that was heard."""
        self.configuration: Body | None = None
        self.deployed = 0
        """The epoch of the newest configuration that it has told."""
        self.deployed_text = b""
        """What its configurator has said last of what it has deployed, if that counts yet."""
        self.refusal: Body | None = None
        self._waits_since = 0
        """The number of the event that has told of the refusal for which it waits; 0 if it does not."""
        self.lost: dict[str, Body] = {}
        self.ended = ""
        self._identity = ""

    @property
    def identity(self) -> str:
        """The identity of the task; the configurator's name until that is known."""
        return self._identity or self.configurator

    def take_status(self, status: Status) -> None:
        """Note what the configurator says of itself."""
        self.status, self._identity = status, status.task or self._identity
        for component, cause in status.lost.items():
            self.lost.setdefault(component, {"cause": str(cause), "detail": "", "time": None})
        self.lost = {component: why for component, why in self.lost.items() if component in status.lost}

    def hear(self, notice: Notice) -> Body | None:
        """Note an event; return it as clients hear of it, or None if it is known or they do not."""
        if notice.sequence <= self.sequence:
            if notice.sequence == self._waits_since:  # it comes once more when its refusal is explained
                self.refusal = checked_event(notice.event).get("refusal") or self.refusal
            return None
        self.sequence, self._identity = notice.sequence, notice.task or self._identity
        event = checked_event(notice.event)
        act = event["act"]
        if act == "lost":
            why = {fact: event.get(fact) for fact in ("cause", "detail", "time")}
            self.lost[str(event.get("component"))] = why
        if act == "running":
            self.refusal, self._waits_since = None, 0
            if event["epoch"] != self.deployed:  # the notice of what is deployed says more
                self.configuration = event["configuration"] or self.configuration
        if act in ("waiting", "refused"):
            self.configuration, self.refusal = None, event["refusal"]
            self._waits_since = notice.sequence if act == "waiting" else 0
        self.ended = ENDED.get(act, self.ended)
        if act not in TOLD:
            return None
        return {**event, "task": self.identity, "configurator": self.configurator}

    def body(self, detached: bool) -> Body:
        """The task as JSON."""
        status = self.status or _UNKNOWN
        over = not self.alive or bool(self.ended)
        return {
            "name": task_name(self.identity),
            "configurator": self.configurator,
            "phase": self.ended or (status.phase if self.alive else "gone"),
            "over": over,
            "detached": detached,
            "priority": status.priority,
            "beginning": status.beginning,
            "since": status.since,
            "epoch": status.epoch,
            "host": status.host,
            "process": status.process,
            "template": status.template,
            "inside_of": status.outside,
            "components": [] if over else list(status.components),
            "owed": list(status.owed),
            "dropped": dict(status.dropped),
            "lost": self.lost,
            "configuration": None if over else self.configuration,
            "refusal": self.refusal,
        }
