"""`echo`: signals of a living output, and that a reader disturbs nobody."""

from __future__ import annotations

import json
import signal
from dataclasses import replace
from datetime import datetime

import pytest

import selfconf as sc
from selfconf.api.living.echo import HeardSignal
from selfconf.cli import echo
from selfconf.model.term import IRI
from selfconf.protocol.messages import SignalEncoding, Stamp
from tests.cli.command import run
from tests.cli.processes import Home, component_of
from tests.lab import iri

pytestmark = pytest.mark.process

STAMP = Stamp(IRI("urn:c"), "life", 1, 0.25)


def test_so_many_signals_are_shown_as_are_wanted(inhabited: Home, capsys: pytest.CaptureFixture[str]) -> None:
    program, where = inhabited.run(), inhabited.arguments()
    program.act("running")
    lines = run(capsys, "echo", "person-tracker", "pose", "--count", "30", *where).out.splitlines()
    assert len(lines) == 30
    assert '"frame": "map"' in lines[0]
    assert float(lines[-1].split("/s")[0].split()[-1]) > 1
    outcome = run(capsys, "echo", iri("person-tracker"), "pose", "--count", "2", "--format", "json", *where)
    bodies = [json.loads(line) for line in outcome.out.splitlines()]
    assert [body["component"] for body in bodies] == [iri("person-tracker")] * 2
    assert bodies[1]["sequence"] > bodies[0]["sequence"]
    assert program.end() == 0


def test_ctrl_c_ends_it_and_a_reader_that_hangs_holds_up_nobody(inhabited: Home) -> None:
    program = inhabited.run()
    program.act("running")
    reader = inhabited.selfconf("echo", "person-tracker", "pose", "--format", "json", *inhabited.arguments())
    assert json.loads(reader.line())["value"]
    reader.send(signal.SIGSTOP)
    before = inhabited.state(component_of("tracker"))
    assert before is not None

    def issued() -> int:
        now = inhabited.state(component_of("tracker"))
        return 0 if now is None else now.issued["pose"]

    assert inhabited.until(lambda: issued() > before.issued["pose"] + 20)
    assert inhabited.active("drive", "control") == {"drive", "control"}
    reader.send(signal.SIGCONT)
    assert json.loads(reader.line())["value"]
    assert reader.end(signal.SIGINT) == 0
    assert "Traceback" not in reader.complaints
    assert inhabited.active("drive", "control") == {"drive", "control"}
    assert program.end() == 0


def test_of_a_component_that_acts_for_no_task_it_is_said_why_nothing_comes(inhabited: Home) -> None:
    program = inhabited.run()
    program.act("running")
    said: list[str] = []
    with sc.join(inhabited.ecology, connect=[inhabited.endpoint()]) as living:
        living.signals(iri("person-tracker"), "pose", said.append)
        assert said == []
        assert program.end() == 0
        living.signals(iri("person-tracker"), "pose", said.append)
        living.signals(iri("person-tracker"), "pose")
        assert [*living.complaints] == said
    assert said == ["person-tracker acts for no task now, and says nothing before it does"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("nobody", "pose"), "no component nobody is advertised"),
        (("person-tracker", "sound"), "person-tracker has no output 'sound'; its outputs: 'pose'"),
        (("astrid-drive", "x"), "its outputs: none"),
        (("person-tracker", "pose", "--count", "0"), "a whole number above zero"),
    ],
)
def test_what_is_not_there_is_one_sentence(
    words: tuple[str, ...], said: str, inhabited: Home, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(capsys, "echo", *words, *inhabited.arguments()).is_one_sentence(said)


def test_values_are_shortened_and_bytes_described() -> None:
    long = echo._text(HeardSignal(STAMP, 2.0, 9000, False, "x" * 9000, 3))
    assert len(long) < 500
    assert long.endswith("(8602 characters more) (3 passed over)")
    image = Stamp(IRI("urn:c"), "life", 1, 0.25, SignalEncoding("image/x-raw", "uint8", (2, 3)))
    assert echo._text(HeardSignal(image, 2.0, 6, True)).endswith("<image/x-raw of uint8 2 x 3, 6 bytes>")
    assert echo._text(HeardSignal(STAMP, 2.0, 6, True)).endswith("2.0/s  <6 bytes>")
    assert "/s" not in echo._text(HeardSignal(STAMP, 0.0, 6, True)), "of the first signals no rate is known"


def test_the_time_of_a_clock_of_its_own_is_shown_with_its_date_or_as_it_is() -> None:
    own = echo._text(HeardSignal(replace(STAMP, time=86_400.25), 2.0, 6, True))
    assert own.startswith(f"{datetime.fromtimestamp(86_400).astimezone():%Y-%m-%d %H:%M:%S}.250  ")
    assert echo._text(HeardSignal(replace(STAMP, time=1e300), 2.0, 6, True)).startswith("1e+300 s  ")
