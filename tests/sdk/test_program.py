"""`main`: a component class as a program; what it says when it cannot join."""

from __future__ import annotations

import os
import select
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from selfconf.bus.zenoh import client
from selfconf.protocol.messages import Reserve
from selfconf.sdk import Component, main, parent_environment, program
from selfconf.sdk.program import HUNG_EXIT_CODE, TIME_TO_END
from tests.lab import write_advertisements
from tests.sdk.living import PATIENCE, PREFIXES, LivingStage, until


class Lamp(Component):
    """A lamp."""


@pytest.fixture(autouse=True)
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    """No endpoint is waited for."""
    monkeypatch.setattr("selfconf.rendezvous.client", partial(client, seconds=0.1))


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((), "selfconf site"),
        (("--ecology", "home"), "of the ecology 'home'"),
        (("--ecology", "home", "--connect", "tcp/127.0.0.1:1"), "no site answers at tcp/127.0.0.1:1"),
        (("--ecology", "home", "--connect", "somewhere"), "no endpoint"),
    ],
)
def test_a_program_that_finds_no_ecology_says_so_in_one_sentence(
    arguments: tuple[str, ...], words: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    kind = type("Tracker", (Lamp,), {"advertisement": write_advertisements(tmp_path, "tracker") / "tracker.ttl"})
    with pytest.raises(SystemExit, match="2"):
        main(kind, arguments=arguments)
    said = capsys.readouterr().err
    assert words in said
    assert said.count("\n") == 1


def test_the_environment_that_a_site_gives_names_the_ecology(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("SELFCONF_ECOLOGY", "home")
    monkeypatch.setenv("SELFCONF_CONNECT", "tcp/127.0.0.1:1")
    with pytest.raises(SystemExit, match="2"):
        main(Lamp, arguments=())
    assert "no site answers at tcp/127.0.0.1:1" in capsys.readouterr().err


def test_no_component_lives_that_cannot_start_as_another_one_of_its_program_takes_long_to_be_made(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    said = list[str]()

    class Noted(Component):
        def __init__(self) -> None:
            said.append("made")

    class Noting:
        def add(self, component: Component, life: str) -> None:
            said.append("joined")

    monkeypatch.setattr(program, "open_host", lambda *given: Noting())
    monkeypatch.setattr(program, "run_until_ended", lambda host: None)
    with pytest.raises(SystemExit, match="0"):
        main(Noted, Noted, arguments=())
    assert said == ["made", "made", "joined", "joined"]


@pytest.mark.parametrize(
    ("kinds", "found"),
    [((), "not nothing"), ((object,), "not <class 'object'>"), ((Lamp, Lamp()), "not <tests.sdk.test_program.Lamp ")],
)
def test_what_is_no_class_of_a_component_is_refused_in_a_sentence(
    kinds: tuple[Any, ...], found: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit, match="2"):
        main(*kinds, arguments=())
    said = capsys.readouterr().err
    assert said.startswith("`main` takes classes that are derived from selfconf.sdk.Component, not ")
    assert found in said


def test_help_tells_what_the_component_is(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(Lamp, arguments=("--help",))
    assert "A lamp." in capsys.readouterr().out


# Programs as processes of their own.

PROGRAM = '''
import sys, threading, time
from pathlib import Path
from selfconf.sdk import Component, main

class Lamp(Component):
    """A lamp."""

    advertisement = Path(__file__).parent / "lamp.ttl"

    def started(self):
        if "thread" in sys.argv:
            threading.Thread(target=time.sleep, args=(60.0,)).start()
        self.every(0.01, self.shine)

    def shine(self):
        if "leave" in sys.argv:
            sys.exit(3)
        if "hang" in sys.argv:
            print("hanging", flush=True)
            while True:
                time.sleep(0.01)  # code that never returns
        if "close" in sys.argv:
            self._runtime.bus._session.close()
        if "busy" in sys.argv:
            time.sleep(0.2)  # code that takes long

    def stopped(self):
        print("at rest", flush=True)

main(Lamp)
'''
LAMP = """:lamp a sc:Component, :Lamp ; sc:deadline [ sc:value 0.3 ; sc:unit unit:SEC ] ;
    sc:hasOutput [ sc:name "light" ; sc:signalType :Light ] ."""


class Programs:
    """Processes that are one component, each started and ended by a test."""

    def __init__(self, stage: LivingStage) -> None:
        self.stage = stage
        (stage.folder / "lamp.ttl").write_text(PREFIXES + LAMP)
        (stage.folder / "lamp.py").write_text(PROGRAM)
        self.started: list[subprocess.Popen[str]] = []

    def start(self, *arguments: str, **environment: str) -> subprocess.Popen[str]:
        """Start a program."""
        command = (sys.executable, "lamp.py", "--ecology", self.stage.ecology, "--connect", self.stage.endpoint)
        clean = {name: value for name, value in os.environ.items() if not name.startswith("SELFCONF_")}
        path = {"PYTHONPATH": str(Path(__file__).parents[2])}
        process = subprocess.Popen(
            [*command, *arguments],
            cwd=self.stage.folder,
            env={**clean, **path, **environment},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.started.append(process)
        return process

    def lives(self) -> bool:
        """Whether the component is alive."""
        called: list[tuple[str, ...]] = []
        self.stage.caller.roll_call(self.stage.keys.any_life(), PATIENCE, called.append)
        return until(lambda: called) and bool(called[0])

    def acting(self, *arguments: str, **environment: str) -> subprocess.Popen[str]:
        """Start a program, and activate its component."""
        process = self.start(*arguments, **environment)
        assert until(self.lives, 2 * PATIENCE)
        answers = self.stage.apply("urn:c:lamp")
        assert until(lambda: answers)
        return process

    def abandoned_actuator(self, program: str, **environment: str) -> subprocess.Popen[str]:
        """Start a program whose component is an actuator, activate that, and let its configurator leave."""
        (self.stage.folder / "motor.ttl").write_text(f"{PREFIXES}:motor a sc:Component, :Motor .")
        (self.stage.folder / "lamp.py").write_text(program)
        process = self.start(**environment)
        assert until(self.lives, 2 * PATIENCE)
        reserved = self.stage.call("urn:c:motor", "reserve", Reserve(1, self.stage.supervisor, "task~1"))
        assert until(lambda: reserved)
        answers = self.stage.apply("urn:c:motor")
        assert until(lambda: answers)
        self.stage.leave()
        return process


@pytest.fixture
def programs(living: LivingStage) -> Iterator[Programs]:
    """Programs of one component in an ecology."""
    programs = Programs(living)
    yield programs
    for process in programs.started:
        process.kill()
        process.communicate()


@pytest.mark.process
def test_a_program_whose_component_lives_already_names_who_holds_it_and_exits_with_2(programs: Programs) -> None:
    first = programs.start()
    assert until(programs.lives, 2 * PATIENCE)
    _, said = programs.start().communicate(timeout=2 * PATIENCE)
    assert programs.started[1].returncode == 2
    assert f"urn:c:lamp is alive already: process {first.pid} on " in said
    assert said.count("\n") == 1


@pytest.mark.process
def test_a_program_ends_on_a_signal_with_its_component_at_rest(programs: Programs) -> None:
    process = programs.acting()
    process.send_signal(signal.SIGTERM)
    said, _ = process.communicate(timeout=PATIENCE)
    assert (process.returncode, said) == (0, "at rest\n")


@pytest.mark.process
def test_a_program_ends_on_a_signal_though_its_code_has_started_a_thread_that_goes_on(programs: Programs) -> None:
    process = programs.acting("thread")
    process.send_signal(signal.SIGTERM)
    said, _ = process.communicate(timeout=PATIENCE)
    assert (process.returncode, said) == (0, "at rest\n")


@pytest.mark.process
def test_a_program_ends_by_its_code_though_that_has_started_a_thread_that_goes_on(programs: Programs) -> None:
    process = programs.acting("thread", "leave")
    said, _ = process.communicate(timeout=PATIENCE)
    assert (process.returncode, said) == (3, "at rest\n")


@pytest.mark.process
def test_a_program_whose_code_hangs_ends_on_a_signal_all_the_same(programs: Programs) -> None:
    process = programs.acting("hang")
    assert until(lambda: programs.stage.fails)
    assert process.poll() is None
    began = time.monotonic()
    process.send_signal(signal.SIGTERM)
    _, said = process.communicate(timeout=2 * PATIENCE)
    assert process.returncode == HUNG_EXIT_CODE
    assert time.monotonic() - began < TIME_TO_END + 1.0
    assert "urn:c:lamp: `every` has not returned within 0.3 s" in said


@pytest.mark.process
def test_time_in_which_a_program_stood_still_is_none_that_its_code_has_taken(programs: Programs) -> None:
    process = programs.acting("busy")
    for _ in range(3):
        process.send_signal(signal.SIGSTOP)
        until(lambda: False, 0.8)
        process.send_signal(signal.SIGCONT)
        until(lambda: False, 0.3)
    assert not programs.stage.fails


@pytest.mark.process
def test_a_program_that_a_site_has_started_ends_when_its_code_hangs_so_that_it_can_be_started_again(
    programs: Programs,
) -> None:
    process = programs.acting("hang", **parent_environment())
    assert process.wait(PATIENCE) == HUNG_EXIT_CODE
    assert until(lambda: programs.stage.fails)
    assert programs.stage.fails[0][1].detail == "`every` has not returned within 0.3 s"


@pytest.mark.process
def test_a_program_whose_code_closes_its_session_comes_to_rest_and_ends_so_that_it_can_be_started_again(
    programs: Programs,
) -> None:
    process = programs.acting("close", **parent_environment())
    said, complained = process.communicate(timeout=PATIENCE)
    assert process.returncode == HUNG_EXIT_CODE
    assert said == "at rest\n"
    assert complained == "code of urn:c:lamp has closed the session by which it was in the ecology\n"


@pytest.mark.process
def test_a_life_that_ends_as_its_code_hangs_is_over_before_its_process_is_so_that_no_task_begins_it_anew(
    programs: Programs,
) -> None:
    lasting = "from selfconf.sdk import program\nprogram.HUNG_ENDS = 60.0\n"
    (programs.stage.folder / "lamp.py").write_text(lasting + PROGRAM)
    process = programs.acting("hang", **parent_environment())
    assert until(lambda: programs.stage.fails)
    assert until(lambda: not programs.lives())
    assert process.poll() is None


# A terminal that is held: whatever the program has to say of what it does, nobody reads it.

HOLDING = """
import os, sys
from pathlib import Path
from selfconf.sdk import Component, main

class Motor(Component):
    advertisement = Path(__file__).parent / "motor.ttl"

    def stopped(self):
        print("at rest", flush=True)

while True:  # nobody has read what it said before
    os.set_blocking(2, False)
    try:
        os.write(2, b"x" * 4096)
    except BlockingIOError:
        os.set_blocking(2, True)
        break
main(Motor)
"""


@pytest.mark.process
def test_an_actuator_whose_configurator_is_gone_comes_to_rest_though_its_terminal_is_held(programs: Programs) -> None:
    process = programs.abandoned_actuator(HOLDING)
    assert process.stdout is not None
    assert select.select([process.stdout], [], [], PATIENCE)[0]
    assert process.stdout.readline() == "at rest\n"
    process.send_signal(signal.SIGTERM)
    assert process.wait(PATIENCE) == 0


JAMMED = """
from pathlib import Path
from selfconf.sdk import Component, main

class Motor(Component):
    advertisement = Path(__file__).parent / "motor.ttl"

    def stopped(self):
        raise RuntimeError("jammed")

main(Motor)
"""


@pytest.mark.process
def test_a_program_that_a_site_has_started_ends_when_its_actuator_breaks_as_it_is_to_rest(programs: Programs) -> None:
    process = programs.abandoned_actuator(JAMMED, **parent_environment())
    assert process.wait(PATIENCE) == HUNG_EXIT_CODE
    assert process.stderr is not None
    assert "urn:c:motor: it broke in stopped: RuntimeError: jammed" in process.stderr.read()


@pytest.mark.process
def test_a_program_that_a_site_has_started_ends_when_its_code_hangs_though_nobody_reads_what_it_says(
    programs: Programs,
) -> None:
    (programs.stage.folder / "lamp.py").write_text(HOLDING.split("main(")[0] + PROGRAM)
    process = programs.acting("hang", **parent_environment())
    assert process.wait(PATIENCE) == HUNG_EXIT_CODE
