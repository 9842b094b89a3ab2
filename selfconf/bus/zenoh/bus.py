"""The bus over Zenoh.

A site opens a *relay* (`relay`): a router that listens on one endpoint and is connected to others. Everything
else on its host, the site's own bus included, is a *client* of a relay (`opening`). How sessions are set up stands in
`session`, the topology and the keys in `docs/protocol.md`.

* A callback of Zenoh only puts into a queue of the loop (`callback`): work done in it would delay every other message,
  and by default each callback would have a thread. That of a direct subscription puts into a queue of its owner.
* Answers and lives that come by the thousand are read from a channel (`channels`). With a callback for each of them,
  Zenoh's thread would wait for Python until it misses the keep-alive messages of its router.
* A roll-call whose answer may be incomplete is repeated (`roll_call`).
* A question goes to all queryables. It is not consolidated, because that keeps one reply for each key and waits for the
  slowest. It ends when every queryable has finished, not at the time-out.
* All control calls of one component have the same priority and are express, so that none overtakes another.
"""

from __future__ import annotations

import atexit
import os
import queue
import weakref
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import zenoh
import zenoh.ext
from zenoh.handlers import Callback

from selfconf.bus.loop import Loop
from selfconf.bus.port import LARGEST_REPLIES, Replies, Sample, Urgency
from selfconf.bus.zenoh.channels import each, may_be_many, open_channel, read_together
from selfconf.bus.zenoh.reader_threads import ReaderThreads
from selfconf.bus.zenoh.receivers import DirectReceiver, Receiver, ZenohRequest, callback, sample_of
from selfconf.bus.zenoh.relay import Hub, Relay
from selfconf.bus.zenoh.roll_call import RollCalls
from selfconf.bus.zenoh.session import Security
from selfconf.bus.zenoh.unread_links import UnreadLinks

LAST_TOLD = 0.5
"""Seconds after which the last sample is announced as that, where samples are kept: the last may be lost, too."""
_QUALITY: dict[Urgency, dict[str, Any]] = {
    Urgency.SIGNAL: {
        "congestion_control": zenoh.CongestionControl.DROP,
        "priority": zenoh.Priority.DATA,
        "express": False,
    },
    Urgency.BULK: {
        "congestion_control": zenoh.CongestionControl.DROP,
        "priority": zenoh.Priority.DATA_LOW,
        "express": False,
    },
    Urgency.EVENT: {
        "congestion_control": zenoh.CongestionControl.BLOCK,
        "priority": zenoh.Priority.REAL_TIME,
        "express": True,
    },
}
_LAST_WORDS = 1.0
"""Seconds that a thread that reads a channel may take to end when its session has been closed."""
_OPEN: weakref.WeakSet[ZenohBus] = weakref.WeakSet()


@atexit.register
def _close_all() -> None:
    """Close what was left open."""
    for bus in list(_OPEN):
        bus.close()


def _leave_to_parent() -> None:
    """In a process that was forked, close nothing: the threads of Zenoh that would do it are those of the parent."""
    for bus in list(_OPEN):
        bus.disown()


os.register_at_fork(after_in_child=_leave_to_parent)


class _Publisher:
    """A declared publisher with its quality of service."""

    def __init__(self, bus: ZenohBus, declared: Any) -> None:
        self._bus, self._declared = bus, declared
        self.undeclare = bus._keep(declared)

    def put(self, payload: bytes, attachment: bytes = b"") -> None:
        """Put a sample; with the link down, or the session closed, it is lost without an error, as Zenoh has it."""
        try:
            self._declared.put(payload, attachment=attachment or None)
        except zenoh.ZError:
            if self._bus._open and not self._bus._session.is_closed():
                raise


class ZenohBus(Loop):
    """A Zenoh session as a bus."""

    def __init__(self, session: Any) -> None:
        super().__init__()
        self._session = session
        self.endpoint = ""
        """Where the relay of this bus listens; empty if it has none."""
        self.from_here = ""
        """Where it is reached from its own host; empty if there is none."""
        self._relay: Relay | None = None
        self._declared: set[Any] = set()
        self._direct: set[DirectReceiver] = set()
        self._readers = ReaderThreads()
        """The threads that read channels; none may be left when Python ends, or it ends with a crash."""
        self._roll_calls = RollCalls(self, session, self._readers, lambda: bool(self.link))
        self._open = True
        self._hubs = set[str]()
        """The hubs that this bus is a client of, by Zenoh's events, behind which Zenoh's own list lags."""
        self._turns = 0
        """How often this bus has gained or lost a hub: one that comes back has the same name as before."""
        self._link_watchers: list[Callable[[], None]] = []
        self._lost: list[Callable[[], None]] = []
        """What is called when other code has closed the session."""
        self._unread_links = UnreadLinks(self, session.info.links)
        self._listen_to_links()
        _OPEN.add(self)

    def _listen_to_links(self) -> None:
        """Hear of the hub that there is, and of each that comes or goes.

        Of the first, Zenoh tells on the thread that asks for it. If that is the main thread, a Ctrl-C at this moment is
        raised in the callback: Zenoh prints it and goes on, and the hub is not known. So another thread asks.
        """
        declared: queue.SimpleQueue[Any] = queue.SimpleQueue()

        def listen() -> None:
            try:
                heard = callback(self._turned, self._closed)
                declared.put(self._session.info.declare_transport_events_listener(heard, history=True))
            except zenoh.ZError as error:  # it is raised again, in the thread that waits
                declared.put(error)

        self._readers.begin(listen)
        listener = declared.get()
        if isinstance(listener, zenoh.ZError):
            raise listener
        self._declared.add(listener)

    def relay(self, hub: Hub, connect: Sequence[str]) -> None:
        """Keep a hub, connected to others, until this bus is closed or relays no more."""
        self._relay, self.endpoint, self.from_here = Relay(hub, self, connect), hub.endpoint, hub.from_here

    @property
    def reached(self) -> frozenset[str]:
        """The endpoints, with an address for their host, that the relay of this bus is linked to. On any thread."""
        return frozenset() if self._relay is None else self._relay.reached

    def secure(self, security: Security) -> None:
        """Have other rules, or another certificate, where this bus relays. Raises NetworkError."""
        if self._relay is not None:
            self._relay.secure(security)

    def relay_no_more(self) -> None:
        """Close the hub, if there is one; this bus goes to another hub that it knows."""
        if self._relay is not None:
            self._relay.close()
        self._relay, self.endpoint, self.from_here = None, "", ""

    def watch_link(self, changed: Callable[[], None]) -> Callable[[], None]:
        """Call `changed` whenever this bus has gained or lost its hub, on the bus's thread."""
        receiver = Receiver(self, changed)
        self._link_watchers.append(receiver.received)
        return receiver.until(lambda: self._link_watchers.remove(receiver.received))

    @property
    def link(self) -> str:
        """The hub that this bus is a client of, and how often it has gained or lost one."""
        hubs = ",".join(sorted(self._hubs)) if self._open else ""
        return hubs and f"{hubs} {self._turns}"

    def _turned(self, event: zenoh.TransportEvent) -> None:
        """Called by Zenoh, at once for the hub that there is, then on a thread of its own."""
        if event.transport.whatami != zenoh.WhatAmI.ROUTER:
            return
        change = self._hubs.add if event.kind == zenoh.SampleKind.PUT else self._hubs.discard
        change(str(event.transport.zid))
        self._turns += 1
        if event.kind == zenoh.SampleKind.PUT:
            self._unread_links.watch()
        for tell in tuple(self._link_watchers):
            tell()

    def when_lost(self, lost: Callable[[], None]) -> None:
        """Call `lost` if other code of this process closes the session."""
        self._lost.append(lost)

    def _closed(self) -> None:
        """The session was closed; called by Zenoh, on the thread of the code that has done so."""
        if self._open:
            self._hubs.clear()
            for tell in self._link_watchers:
                tell()
            for lost in self._lost:
                self.wake_up(lost)

    def publisher(
        self, key: str, urgency: Urgency, matched: Callable[[bool], None] | None = None, *, kept: int = 0
    ) -> _Publisher:
        """Declare a key to put on; what is kept is asked for as Zenoh's advanced subscribers do."""
        declared: Any
        if kept:
            cache = zenoh.ext.CacheConfig(max_samples=kept)
            declared = zenoh.ext.declare_advanced_publisher(
                self._session,
                key,
                cache=cache,
                sample_miss_detection=zenoh.ext.MissDetectionConfig(heartbeat=None, sporadic_heartbeat=LAST_TOLD),
                publisher_detection=True,
                **_QUALITY[urgency],
            )
        else:
            declared = self._session.declare_publisher(key, **_QUALITY[urgency])
        if matched is not None:
            changed = matched

            def listen(status: zenoh.MatchingStatus) -> None:
                matching = bool(status.matching)
                self.wake_up(lambda: changed(matching))

            declared.declare_matching_listener(callback(listen))
        return _Publisher(self, declared)

    def subscribe(
        self,
        key: str,
        receive: Callable[[Sample], None],
        urgency: Urgency = Urgency.SIGNAL,
        *,
        direct: bool = False,
    ) -> Callable[[], None]:
        """Receive every sample put on a key from now on."""
        if direct:
            return self._subscribe_directly(key, DirectReceiver(key, receive))
        receiver, urgent = Receiver(self, receive), urgency is Urgency.EVENT

        def arrived(sample: zenoh.Sample) -> None:
            receiver.received_message(sample_of(sample), urgent)

        return receiver.until(self._keep(self._session.declare_subscriber(key, callback(arrived))))

    def _subscribe_directly(self, key: str, receiver: DirectReceiver) -> Callable[[], None]:
        """Begin; once the result has returned there is no call any more."""
        undeclare = self._keep(self._session.declare_subscriber(key, callback(receiver.received)))
        self._direct.add(receiver)

        def undo() -> None:
            receiver.close()
            self._direct.discard(receiver)
            undeclare()

        return undo

    def serve(self, key: str, answer: Callable[[ZenohRequest], None], *, complete: bool = False) -> Callable[[], None]:
        """Answer questions to a key."""

        receiver = Receiver(self, answer)

        def asked(query: zenoh.Query) -> None:
            request = ZenohRequest(query)
            if not receiver.received_message(request):
                request.finish()

        heard = callback(asked)
        return receiver.until(self._keep(self._session.declare_queryable(key, heard, complete=complete)))

    def ask(
        self, key: str, payload: bytes, seconds: float, done: Callable[[Replies], None], attachment: bytes = b""
    ) -> None:
        """Ask all queryables of a key."""
        samples: list[Sample] = []
        errors: list[str] = []
        size = 0

        def listen(replies: Sequence[zenoh.Reply]) -> None:
            nonlocal size
            for reply in replies:
                if reply.ok is not None:
                    size += len(reply.ok.payload) + len(reply.ok.attachment or b"")
                    if size <= LARGEST_REPLIES:
                        samples.append(sample_of(reply.ok))
                elif reply.err is not None:
                    size += len(reply.err.payload)
                    if size <= LARGEST_REPLIES:
                        errors.append(bytes(reply.err.payload).decode(errors="replace"))

        def end() -> None:
            late = "Timeout" in errors or size > LARGEST_REPLIES
            replies = Replies(tuple(samples), tuple(e for e in errors if e != "Timeout"), not late)
            self.wake_up(lambda: done(replies))

        handler: Any = open_channel() if may_be_many(key) else each(listen, end)
        channel = self._session.get(
            key,
            handler,
            payload=payload,
            attachment=attachment or None,
            target=zenoh.QueryTarget.ALL,
            consolidation=zenoh.ConsolidationMode.NONE,
            timeout=seconds,
            congestion_control=zenoh.CongestionControl.BLOCK,
            priority=zenoh.Priority.INTERACTIVE_HIGH,
            express=True,
        )
        self._read_aside(handler, channel, listen, end)

    def announce(self, key: str) -> Callable[[], None]:
        """Be alive under a key."""
        return self._keep(self._session.liveliness().declare_token(key))

    def watch(
        self, key: str, changed: Callable[[str, bool], None], *, history: bool = True, many: bool = False
    ) -> Callable[[], None]:
        """Follow every life under a key, those that are there already first, unless it is without `history`.

        All of them have ended for this bus when other code of the process has closed its session.
        """
        seen: set[str] = set()

        def change(*lives: tuple[str, bool]) -> None:
            for life in lives:
                changed(*life)

        receiver = Receiver(self, change)

        def listen(samples: Sequence[zenoh.Sample]) -> None:
            told = []
            for sample in samples:
                life, alive = str(sample.key_expr), sample.kind == zenoh.SampleKind.PUT
                (seen.add if alive else seen.discard)(life)
                if life in self._roll_calls.doubtful:
                    self._roll_calls.confirm(life, alive, partial(receiver.received, (life, alive)))
                else:
                    told.append((life, alive))
            if told:
                receiver.received(*told)

        def end() -> None:
            if self._open and seen:  # Zenoh tells no end of a life then
                receiver.received(*((life, False) for life in sorted(seen)))

        # A channel is looked at ten times a second; a callback for each of thousands would hold Zenoh's thread up.
        handler: Any = open_channel() if many else each(listen, end)
        self._roll_calls.knows_many |= many
        declared = self._session.liveliness().declare_subscriber(key, handler, history=history)
        self._read_aside(handler, declared.handler, listen, end)
        return receiver.until(self._keep(declared))

    def roll_call(self, key: str, seconds: float, done: Callable[[tuple[str, ...]], None]) -> None:
        """The keys that are alive right now."""
        self._roll_calls.call(key, seconds, done)

    def _read_aside(
        self,
        handler: Any,
        channel: Any,
        take: Callable[[Sequence[Any]], object],
        end: Callable[[], None] = lambda: None,
    ) -> None:
        """Read what a channel of Zenoh receives, on a thread of its own, until it ends; a callback needs none."""
        if isinstance(handler, Callback):
            return

        def read() -> None:
            while some := read_together(channel):
                take(some)
            end()

        self._readers.begin(read)

    def disown(self) -> None:
        """Leave the session to another process, which will close it."""
        self._open = False

    def close(self) -> None:
        """Leave the network."""
        if self._open:
            self._open = False
            self.end()
            for receiver in self._direct:
                receiver.close()
            self._direct.clear()
            self._declared.clear()
            self._session.close()
            self._readers.end(_LAST_WORDS)
            if self._relay is not None:
                self._relay.close()

    def _keep(self, declared: Any) -> Callable[[], None]:
        """Hold on to something declared, which would be gone with its last reference; the result takes it back."""
        self._declared.add(declared)

        def undo() -> None:
            if declared in self._declared:
                self._declared.discard(declared)
                declared.undeclare()

        return undo
