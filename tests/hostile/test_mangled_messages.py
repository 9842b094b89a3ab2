"""Mangled messages of every kind, read by the codec and heard by every program at its doors: none breaks or stays."""

from __future__ import annotations

import itertools
import logging
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from selfconf.bus.port import Replies, Request, Urgency
from selfconf.composition.composer import Composer
from selfconf.deployment import Keeper, RunRequest, TaskFolder, TaskRunner
from selfconf.errors import PeerError
from selfconf.model.log_line import LogLine
from selfconf.protocol.codec import KINDS, decode, encode
from selfconf.protocol.messages import (
    Access,
    Apply,
    CallAnswer,
    Cause,
    End,
    Fail,
    Free,
    Introduction,
    Known,
    LogPart,
    LogQuestion,
    Message,
    Moved,
    Notice,
    Page,
    RefusedAttempt,
    Release,
    Reserve,
    SignalEncoding,
    Stamp,
    StateOf,
    Status,
    TaskRecord,
    Verdict,
    Wake,
    Wire,
)
from selfconf.sdk.payloads import ELEMENT_FORMATS, read_payload
from selfconf.serve.watching.watcher import EcologyWatcher
from tests.harness.effort import examples
from tests.hostile.bounded import bounded
from tests.hostile.mangling import in_time, mangled, mangled_either, mangled_json, some_mangled
from tests.lab import ADVERTISEMENTS, BOUND, NAVIGATE, PREFIXES, Lab, iri, task_of

WHEELS, CONTROL = iri("wheels"), iri("thinking-cap")
SUPERVISOR = "selfconf/lab/conf/stranger/live/1"
WIRES = {"localize": (Wire(WHEELS, "odometry", 0.1),)}
CONFIGURATION: dict[str, Any] = {"template": iri("navigate"), "roles": [{"role": "a", "components": [WHEELS]}]}
WELL_FORMED: tuple[Message, ...] = (
    Reserve(1, SUPERVISOR, "t~1", "", 1, 1.0, WIRES),
    Apply(1, SUPERVISOR, "t~1", "", 1, 1.0, WIRES, WIRES),
    Release(1, SUPERVISOR, "t~1"),
    StateOf("t~1"),
    CallAnswer(Verdict.DONE, WHEELS, "1", 1, True, "done", SUPERVISOR, "t~1", 1, 1.0, "here"),
    Fail(WHEELS, "", 1, Cause.SILENCE, "why", ""),
    Free(WHEELS, "1", "t~1"),
    Moved(WHEELS, "1", WIRES),
    Wake(WHEELS),
    End(WHEELS, "1"),
    Introduction("-----BEGIN CERTIFICATE-----"),
    Access("conf.a", "may do", ("a",), ("b",), ("c",), ("d",)),
    RefusedAttempt("conf.a", "Query", "a/b", 3, 1.0),
    Known({"site/1": 1}),
    Notice("stranger", 1, "t~1", {"act": "running", "time": 1.0, "message": "m", "configuration": CONFIGURATION}),
    Notice("stranger", 2, "t~1", {"act": "lost", "time": 2.0, "component": WHEELS, "cause": "fail", "detail": "d"}),
    Page(0, 2, 1, WHEELS, "a.ttl", True, "1"),
    Stamp(WHEELS, "1", 1, 1.0, SignalEncoding("image/png", "uint8", (2, 3))),
    Status("stranger", "running", iri("navigate"), 1, 1.0, "host", 1, (WHEELS,), {WHEELS: "fail"}, "t~1", 1, 1.0),
    TaskRecord(
        "t~1", 1, False, 1, 1.0, NAVIGATE, "t.ttl", iri("navigate"), {}, (), {"policy": "repair"}, 1, CONFIGURATION
    ),
    LogQuestion("wheels", 20, "7:100"),
    LogPart((LogLine("2026-11-22T06:30:12.345Z", "stdout", (WHEELS,), "turns"),), "7:150", True),
)
ENCODED = tuple(map(encode, WELL_FORMED))
EACH = 20
"""How many mangled messages a history of the ecology has at each kind of door."""


def test_a_message_of_every_kind_is_mangled() -> None:
    assert {type(message) for message in WELL_FORMED} == set(KINDS)


def read_all(payload: bytes) -> None:
    """Read some bytes as a message of every kind; what is read can be written, and read again."""
    for kind in KINDS:
        try:
            message = decode(payload, kind)
        except PeerError:
            continue
        written = encode(message)
        assert encode(decode(written, kind)) == written


@settings(max_examples=examples(500))
@given(st.sampled_from(ENCODED), st.randoms(use_true_random=False))
def test_the_codec_reads_a_mangled_message_or_says_what_is_wrong(message: bytes, random: Random) -> None:
    with in_time():
        read_all(mangled_json(message, random))
        read_all(mangled(message, random))


@settings(max_examples=examples(500))
@given(st.binary(max_size=200), st.booleans(), st.randoms(use_true_random=False))
def test_a_payload_is_what_its_encoding_says_or_none(payload: bytes, raw: bool, random: Random) -> None:
    sizes = [random.choice((0, 1, 2, 3, 1 << 31, 1 << 62)) for _ in range(random.choice((0, 1, 2, 70)))]
    datatype = random.choice(("", "x", *ELEMENT_FORMATS))
    with in_time():
        try:
            read_payload(payload, raw, SignalEncoding("", datatype, tuple(sizes)))
        except ValueError:
            return


def test_nothing_stays_of_mangled_messages() -> None:
    for payload in some_mangled(ENCODED, 500, seed=1):  # what is kept once, such as caches, is kept now
        read_all(payload)
    with bounded(60.0, peak=20.0, left=0.5):
        for payload in some_mangled(ENCODED, 500, seed=2):
            read_all(payload)


class Stranger:
    """A node that says mangled messages on every key, and answers every question with them."""

    def __init__(self, lab: Lab, agent: TaskRunner, said: Sequence[bytes], attached: Sequence[bytes]) -> None:
        self.lab, self._bus, self._said = lab, lab.network.node(), said
        self._attached = itertools.cycle(attached)
        keys, self.agent = lab.keys, agent
        for site in ("strange", "astrid"):
            self._bus.serve(keys.advertisements(site), self._answer(keys.advertisement(site, WHEELS)))
            self._bus.serve(keys.kept_tasks(site), self._answer(keys.kept_task(site, "t~1")))
        for call in ("status", "stop"):
            key = keys.configurator_call("stranger", call)
            self._bus.serve(key, self._answer(key))
        for key in (keys.notices("stranger"), keys.configuration("stranger"), keys.output(WHEELS, "odometry")):
            self._bus.serve(key, self._answer(key))
        self._bus.serve(keys.call(WHEELS), self._answer(keys.call(WHEELS, "state")))
        self._bus.announce(keys.site_life("strange", "1"))
        self._bus.announce(SUPERVISOR)
        self._bus.announce(keys.life(WHEELS, "zzz"))

    def _answer(self, key: str) -> Any:
        def answer(request: Request) -> None:
            for payload in self._said:
                request.reply(key, payload, next(self._attached))
            request.refuse("\x1b[2J\n" + "x" * 10_000)
            request.finish()

        return answer

    def puts(self) -> Iterator[str]:
        """The keys on which programs of others listen."""
        keys = self.lab.keys
        yield from (keys.changed("strange"), keys.task("t~1"), keys.notices("stranger"))
        for component in (WHEELS, CONTROL):
            yield from (keys.fail(component), keys.free(component))
        yield from (keys.output(WHEELS, "odometry"), keys.output(CONTROL, "set.velocity"))

    def questions(self) -> Iterator[str]:
        """The keys at which programs of others answer; taking the task down is not mangled."""
        keys = self.lab.keys
        yield from (keys.call(CONTROL, call) for call in ("reserve", "apply", "release", "state", "nothing"))
        yield from (keys.wake("astrid"), keys.end("astrid"), keys.log("astrid"), keys.advertisements(), keys.keep())
        yield from (keys.configurator_call(self.agent.name, "status"), keys.notices(), keys.kept_tasks())

    def speak(self) -> None:
        """Say everything everywhere."""
        answered: list[Replies] = []
        for key in self.puts():
            publisher = self._bus.publisher(key, Urgency.EVENT)
            for payload in self._said:
                publisher.put(payload, next(self._attached))
            publisher.undeclare()
        asked = list(self.questions())
        for key in asked:
            for payload in self._said:
                self._bus.ask(key, payload, 1.0, answered.append)
        self.lab.let_pass(3.0)
        assert len(answered) == len(asked) * len(self._said)


def request_for(record: TaskRecord) -> RunRequest:
    """The request for the task that a record says, as a site reads it."""
    return replace(RunRequest.of(Composer(task_of(record.document, BOUND))), patient=True)


def history(folder: Path, random: Random, each: int) -> None:
    """Let an ecology with everything in it hear mangled messages; then it still answers, and runs the task anew."""
    lab = Lab(folder)
    lab.navigation()
    bus = lab.network.node()
    Keeper(bus, "lab", "astrid", TaskFolder(folder / "tasks"), request_for)
    EcologyWatcher(lab.network.node(), "lab", lambda change: None, lambda: lab.network.time).begin()
    agent = lab.agent(patient=True)
    assert lab.running(agent)
    texts = tuple((PREFIXES + text).encode() for text in ADVERTISEMENTS.values())
    said = [
        mangled_either(random.choice(ENCODED), random)
        if random.random() < 0.8
        else mangled(random.choice(texts), random)
        for _ in range(each)
    ]
    attached = [mangled_json(random.choice((ENCODED[15], ENCODED[16])), random) for _ in range(each)]
    Stranger(lab, agent, said, attached).speak()
    answered: list[Replies] = []
    for name in lab.components:
        bus.ask(lab.keys.call(lab.profile(name).component, "state"), encode(StateOf("")), 1.0, answered.append)
    lab.let_pass(2.0)
    assert len(answered) == len(lab.components)
    assert all(replies.samples for replies in answered)
    assert not [path for path in folder.rglob("*~*") if path.parent != folder / "tasks"]


@pytest.mark.slow
@settings(max_examples=examples(25))
@given(st.randoms(use_true_random=False))
def test_whoever_hears_mangled_messages_goes_on(random: Random) -> None:
    with TemporaryDirectory() as folder, in_time(60.0):
        history(Path(folder), random, EACH)


@pytest.mark.slow
def test_nothing_stays_of_an_ecology_that_has_heard_mangled_messages(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.CRITICAL)  # pytest keeps what is logged
    history(tmp_path / "before", Random(1), EACH)
    with bounded(120.0, peak=100.0, left=3.0):
        history(tmp_path / "after", Random(2), EACH)
