"""The program behind a command: one process for all its components, started again after a crash."""

from __future__ import annotations

import errno
import os
import signal
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import pytest

from selfconf.bus.memory import Network
from selfconf.errors import PeerError
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Wake
from selfconf.site import Site, component_program, life_watch, restart_limit
from selfconf.site.component_process import SEEN_BY_ALL
from selfconf.termination import alive
from tests.lab import iri
from tests.site.served import KEYS, SLEEPER, ask, dormant, live, python
from tests.site.started import NUMBERED, fails, given_life, program, runs

pytestmark = pytest.mark.process


def test_a_command_that_two_components_share_is_started_once(
    network: Network, tmp_path: Path, site: Callable[..., Site]
) -> None:
    made = site(python(NUMBERED), "left", "right")
    for name in ("left", "right", "left"):
        ask(network, KEYS.wake("home"), encode(Wake(iri(name))))
    assert live(network, lambda: bool(runs(tmp_path)))
    live(network, lambda: False, 0.3)
    assert len(runs(tmp_path)) == 1
    assert made.processes.by_component[iri("left")] is made.processes.by_component[iri("right")]


def test_the_end_of_a_process_is_heard_of_though_its_pipes_end_before_it(
    network: Network, monkeypatch: pytest.MonkeyPatch, site: Callable[..., Site]
) -> None:
    monkeypatch.setattr(component_program, "PROCESS_CHECK", 1_000.0)
    heard = fails(network)
    site(python("import os, time; os.close(1); os.close(2); time.sleep(0.1); os._exit(3)")).start(SLEEPER)
    assert live(network, lambda: bool(heard))


def test_the_same_command_in_another_folder_is_another_program(
    network: Network, tmp_path: Path, site: Callable[..., Site]
) -> None:
    dormant(tmp_path / "here" / "below", python(NUMBERED), "other")
    made = site(python(NUMBERED))
    for name in ("sleeper", "other"):
        made.start(iri(name))
    assert live(network, lambda: bool(runs(tmp_path)) and any((tmp_path / "here" / "below").glob("run-*")))


def test_a_program_that_crashes_is_started_again_and_that_is_said(
    network: Network, tmp_path: Path, site: Callable[..., Site]
) -> None:
    made, heard = site(python(NUMBERED)), fails(network)
    made.start(SLEEPER)
    for number in (1, 2):
        assert live(network, lambda number=number: len(runs(tmp_path)) == number)
        os.kill(runs(tmp_path)[-1], signal.SIGKILL)
    assert live(network, lambda: len(runs(tmp_path)) == 3)
    assert [alive(process) for process in runs(tmp_path)] == [False, False, True]
    assert [fail.detail for fail in heard] == [
        "the process that its site started for it has ended with code -9; it is started again"
    ] * 2


@pytest.mark.parametrize(("lives", "said"), [((), ""), (("own",), "own"), (("own", "twin"), "")])
def test_a_site_says_which_life_has_ended_if_that_is_known(
    network: Network, tmp_path: Path, site: Callable[..., Site], lives: tuple[str, ...], said: str
) -> None:
    made, heard = site(python(NUMBERED)), fails(network)
    made.start(SLEEPER)
    assert live(network, lambda: len(runs(tmp_path)) == 1)
    for life in lives:
        network.node().announce(KEYS.life(SLEEPER, life))
    live(network, lambda: False, 0.1)
    os.kill(runs(tmp_path)[-1], signal.SIGKILL)
    assert live(network, lambda: bool(heard))
    assert [fail.life for fail in heard] == [said]


@pytest.mark.parametrize("code", [0, 2, 3])
def test_whoever_asks_for_a_program_again_and_again_leaves_it_its_pauses_after_the_first(
    network: Network, tmp_path: Path, site: Callable[..., Site], code: int
) -> None:
    made, heard = site(python(f"{NUMBERED}; raise SystemExit({code})")), fails(network)

    def crashed(times: int) -> bool:
        return live(network, lambda: len(heard) == times and program(made).group is None)

    made.start(SLEEPER)
    assert crashed(1)
    made.start(SLEEPER)
    assert program(made).running
    for number, pause in ((2, 0.4), (3, 1.6)):
        assert crashed(number)
        made.start(SLEEPER)
        assert not live(network, lambda: program(made).running, 0.8 * pause)
        assert live(network, lambda number=number: len(runs(tmp_path)) == number + 1)


def test_a_component_that_has_another_command_by_now_is_not_said_to_have_ended_with_the_program_of_before(
    network: Network, tmp_path: Path, site: Callable[..., Site]
) -> None:
    made, heard = site(python(NUMBERED), "left", "right"), fails(network)
    made.start(iri("left"))
    shared = made.processes.by_component[iri("left")]
    assert live(network, lambda: len(runs(tmp_path)) == 1)
    dormant(tmp_path / "here", python(NUMBERED + "; 0"), "left")
    assert live(network, lambda: made.shelf.advertisements[iri("left")].profile.command != shared.command)
    ended: list[bool] = []
    made.processes.end(iri("left"), "", lambda: ended.append(True))
    assert live(network, lambda: bool(ended))
    made.start(iri("left"))
    made.start(iri("right"))
    assert made.processes.by_component[iri("left")] is not shared is made.processes.by_component[iri("right")]
    assert live(network, lambda: len(runs(tmp_path)) == 3)
    assert shared.group is not None
    os.kill(shared.group.number, signal.SIGKILL)
    assert live(network, lambda: bool(heard))
    assert [fail.component for fail in heard] == [iri("right")]


def test_a_component_is_not_started_by_another_command_before_its_process_of_the_last_one_is_gone(
    network: Network, tmp_path: Path, site: Callable[..., Site]
) -> None:
    deaf = "import signal; signal.signal(signal.SIGTERM, signal.SIG_IGN); "
    made = site(python(deaf + NUMBERED))
    made.start(SLEEPER)
    assert live(network, lambda: len(runs(tmp_path)) == 1)
    last = program(made)
    dormant(tmp_path / "here", python(NUMBERED))
    assert live(network, lambda: made.shelf.advertisements[SLEEPER].profile.command != last.command)
    made.processes.end(SLEEPER)
    for _ in range(2):
        made.start(SLEEPER)
    assert live(network, lambda: program(made) is not last)
    assert last.group is None
    assert live(network, lambda: [alive(one) for one in runs(tmp_path)] == [False, True])


def test_a_command_that_no_component_has_any_more_is_not_started_again(
    network: Network, tmp_path: Path, site: Callable[..., Site], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Else two processes would be the component for which it was mended."""
    monkeypatch.setattr(restart_limit, "FIRST_PAUSE", 3.0)
    made, heard = site(python("raise SystemExit(1)")), fails(network)
    made.start(SLEEPER)
    broken = program(made)
    assert live(network, lambda: bool(heard) and broken.group is None)
    dormant(tmp_path / "here", python(NUMBERED))
    assert live(network, lambda: made.shelf.advertisements[SLEEPER].profile.command != broken.command)
    made.start(SLEEPER)
    assert program(made) is not broken
    assert not live(network, lambda: broken.group is not None, 4.0)


def test_a_program_that_crashes_too_often_is_given_up(
    network: Network, tmp_path: Path, site: Callable[..., Site]
) -> None:
    made = site(python(NUMBERED + "; raise SystemExit(3)"), more="; sc:restarts 1 ")
    heard = fails(network)
    made.start(SLEEPER)
    assert live(network, lambda: len(heard) == 2)
    live(network, lambda: len(runs(tmp_path)) > 2, 1.0)
    assert len(runs(tmp_path)) == 2
    assert "for the 2. time within 60 s; it is not started again" in heard[-1].detail
    with pytest.raises(PeerError, match="has ended more than 1 times within 60 s; it can be started in"):
        made.start(SLEEPER)
    network.run(lambda: False, 60.0)
    made.start(SLEEPER)
    assert live(network, lambda: len(runs(tmp_path)) == 3)


def test_a_program_is_started_again_as_often_as_the_most_demanding_of_its_components_says(
    network: Network, tmp_path: Path, site: Callable[..., Site]
) -> None:
    command = python("raise SystemExit(3)")
    dormant(tmp_path / "here", command, "modest", more="; sc:restarts 0 ")
    heard = fails(network)
    site(command, "demanding", more="; sc:restarts 1 ").start(iri("modest"))
    assert live(network, lambda: len(heard) == 2)
    assert "; it is started again" in heard[0].detail
    assert "for the 2. time within 60 s; it is not started again" in heard[1].detail


@pytest.mark.parametrize(("code", "hint"), [(0, " before the component lived; does its program call `main`?"), (2, "")])
def test_a_program_that_wants_to_end_or_cannot_run_is_not_started_again(
    network: Network, tmp_path: Path, site: Callable[..., Site], code: int, hint: str
) -> None:
    made, heard = site(python(f"{NUMBERED}; raise SystemExit({code})")), fails(network)
    made.start(SLEEPER)
    assert live(network, lambda: bool(heard))
    live(network, lambda: len(runs(tmp_path)) > 1, 0.5)
    assert len(runs(tmp_path)) == 1
    assert heard[0].detail == f"the process that its site started for it has ended with code {code}{hint}"


def lost_lives(network: Network, tmp_path: Path, made: Site, number: int, told: bool) -> str:
    """A component is started, lives and ends, wanting to, that many times; its last life, named to the site or not."""
    life = ""
    for run in range(1, number + 1):
        made.start(SLEEPER, life if told else "")
        assert live(network, lambda run=run: len(runs(tmp_path)) == run)
        life = given_life(made)
        leave = network.node().announce(KEYS.life(SLEEPER, life))
        network.run(lambda: False, 0.1)
        leave()
        os.kill(runs(tmp_path)[-1], signal.SIGTERM)
        assert live(network, lambda: program(made).group is None)
    return life


WANTS_TO_END = "import signal, sys; signal.signal(signal.SIGTERM, lambda *_: sys.exit(0)); "


def test_an_end_counts_as_a_crash_where_a_task_has_lost_the_life_whatever_the_code(
    network: Network, tmp_path: Path, site: Callable[..., Site]
) -> None:
    made = site(python(WANTS_TO_END + NUMBERED), more="; sc:restarts 2 ")
    life = lost_lives(network, tmp_path, made, 3, told=True)
    for _ in range(2):
        with pytest.raises(PeerError, match="has ended more than 2 times within 60 s"):
            made.start(SLEEPER, life)


def test_an_end_that_a_task_has_lost_a_life_by_counts_once_and_is_followed_by_a_pause(
    network: Network, tmp_path: Path, site: Callable[..., Site]
) -> None:
    made = site(python(WANTS_TO_END + NUMBERED))
    life = lost_lives(network, tmp_path, made, 2, told=True)
    for _ in range(5):
        made.start(SLEEPER, life)
    assert not live(network, lambda: program(made).running, 0.3)
    assert live(network, lambda: len(runs(tmp_path)) == 3)


def test_a_crash_of_what_has_lived_counts_too(network: Network, tmp_path: Path, site: Callable[..., Site]) -> None:
    made, heard = site(python(NUMBERED), more="; sc:restarts 0 "), fails(network)
    made.start(SLEEPER)
    assert live(network, lambda: len(runs(tmp_path)) == 1)
    network.node().announce(KEYS.life(SLEEPER, given_life(made)))
    network.run(lambda: False, 0.1)
    os.kill(runs(tmp_path)[0], signal.SIGKILL)
    assert live(network, lambda: bool(heard))
    assert "for the 1. time within 60 s; it is not started again" in heard[0].detail
    with pytest.raises(PeerError, match="has ended more than 0 times"):
        made.start(SLEEPER)


def test_python_in_a_command_is_that_of_the_site(
    network: Network, tmp_path: Path, site: Callable[..., Site], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    code = 'import sys; open("python", "w").write(sys.prefix)'
    site(python(code).replace(sys.executable, "python", 1)).start(SLEEPER)
    told = tmp_path / "here" / "python"
    assert live(network, lambda: told.exists() and told.read_text() != "")
    assert told.read_text() == sys.prefix


def test_what_has_wanted_to_end_is_started_as_often_as_it_is_asked_for(
    network: Network, tmp_path: Path, site: Callable[..., Site]
) -> None:
    made = site(python(WANTS_TO_END + NUMBERED), more="; sc:restarts 1 ")
    lost_lives(network, tmp_path, made, 4, told=False)
    made.start(SLEEPER, "another")
    assert program(made).running


def test_what_a_site_has_ended_for_a_task_counts_as_a_crash_when_that_task_asks_for_it_again(
    network: Network, tmp_path: Path, site: Callable[..., Site]
) -> None:
    made = site(python(NUMBERED), more="; sc:restarts 0 ")
    made.start(SLEEPER)
    assert live(network, lambda: len(runs(tmp_path)) == 1)
    life, ended = given_life(made), list[bool]()
    made.processes.end(SLEEPER, life, lambda: ended.append(True))
    with pytest.raises(PeerError, match="has ended more than 0 times"):
        made.start(SLEEPER, life)
    assert live(network, lambda: bool(ended))


@pytest.mark.parametrize("noticed", [True, False])
def test_what_has_crashed_begins_again_though_a_task_wants_the_life_of_before_to_act_no_more(
    network: Network, tmp_path: Path, site: Callable[..., Site], noticed: bool
) -> None:
    made, heard = site(python(NUMBERED)), fails(network)
    made.start(SLEEPER)
    assert live(network, lambda: len(runs(tmp_path)) == 1)
    life, ended = given_life(made), list[bool]()
    os.kill(runs(tmp_path)[-1], signal.SIGKILL)
    os.waitid(os.P_PID, runs(tmp_path)[-1], os.WEXITED | os.WNOWAIT)
    assert not noticed or live(network, lambda: bool(heard) and program(made).group is None)
    made.processes.end(SLEEPER, life, lambda: ended.append(True))
    assert live(network, lambda: len(runs(tmp_path)) == 2)
    assert ended
    assert len(heard) == 1


@pytest.mark.parametrize("shows", [False, True], ids=["and sees no life", "and has not seen yet that it lives again"])
def test_what_is_ended_for_one_task_begins_again_for_another_that_waits_for_it(
    network: Network, tmp_path: Path, site: Callable[..., Site], shows: bool
) -> None:
    made = site(python(NUMBERED))
    made.start(SLEEPER)
    assert live(network, lambda: len(runs(tmp_path)) == 1)
    life, ended = given_life(made), list[bool]()
    leave = network.node().announce(KEYS.life(SLEEPER, life))
    made.start(SLEEPER)
    network.run(lambda: False, 0.1)
    os.kill(runs(tmp_path)[-1], signal.SIGSTOP)
    leave()
    network.run(lambda: False, 0.1)
    if shows:
        network.node().announce(KEYS.life(SLEEPER, life))
        network.run(lambda: False, 0.1)
    made.processes.end(SLEEPER, life, lambda: ended.append(True))
    assert live(network, lambda: len(runs(tmp_path)) == 2)
    assert ended


def test_what_is_ended_while_it_lives_is_waited_for_by_no_task(
    network: Network, tmp_path: Path, site: Callable[..., Site]
) -> None:
    made = site(python(NUMBERED))
    made.start(SLEEPER)
    made.start(SLEEPER)
    assert live(network, lambda: len(runs(tmp_path)) == 1)
    network.node().announce(KEYS.life(SLEEPER, given_life(made)))
    network.run(lambda: False, SEEN_BY_ALL + 0.1)
    made.processes.end(SLEEPER, given_life(made))
    assert live(network, lambda: program(made).group is None)
    assert not live(network, lambda: len(runs(tmp_path)) == 2, 0.5)


def test_what_is_ended_before_it_lives_is_not_started_again_for_who_has_asked_once(
    network: Network, tmp_path: Path, site: Callable[..., Site]
) -> None:
    made = site(python(NUMBERED))
    made.start(SLEEPER)
    assert live(network, lambda: len(runs(tmp_path)) == 1)
    made.processes.end(SLEEPER, given_life(made))
    assert live(network, lambda: program(made).group is None)
    assert not live(network, lambda: len(runs(tmp_path)) == 2, 0.3)


def test_what_a_person_has_ended_is_started_at_once_however_often_it_has_crashed(
    network: Network, tmp_path: Path, site: Callable[..., Site]
) -> None:
    made, heard = site(python(NUMBERED)), fails(network)
    made.start(SLEEPER)
    for number in (1, 2):
        assert live(network, lambda number=number: len(runs(tmp_path)) == number)
        os.kill(runs(tmp_path)[-1], signal.SIGKILL)
        assert live(network, lambda number=number: len(heard) == number)
    assert live(network, lambda: len(runs(tmp_path)) == 3)
    made.processes.end(SLEEPER)
    assert live(network, lambda: program(made).group is None)
    made.start(SLEEPER)
    assert program(made).running


def test_what_a_person_has_ended_counts_as_no_crash_though_a_task_has_lost_it_by_that(
    network: Network, tmp_path: Path, site: Callable[..., Site]
) -> None:
    made = site(python(NUMBERED), more="; sc:restarts 0 ")
    made.start(SLEEPER)
    for run in (1, 2):
        assert live(network, lambda run=run: len(runs(tmp_path)) == run)
        life = given_life(made)
        made.processes.end(SLEEPER)
        made.start(SLEEPER, life)


def test_a_process_that_is_frozen_before_it_lives_is_ended_and_started_again(
    network: Network, tmp_path: Path, site: Callable[..., Site], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(life_watch, "FROZEN", 0.5)
    made, heard = site(python(NUMBERED)), fails(network)
    made.start(SLEEPER)
    assert live(network, lambda: len(runs(tmp_path)) == 1)
    os.kill(runs(tmp_path)[0], signal.SIGSTOP)
    assert live(network, lambda: len(runs(tmp_path)) == 2)
    assert [alive(process) for process in runs(tmp_path)] == [False, True]
    assert "is frozen" in heard[0].detail
    assert "its site ends it; it is started again" in heard[0].detail


def test_of_two_components_of_a_process_one_life_is_enough(
    network: Network, tmp_path: Path, site: Callable[..., Site], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(life_watch, "WITHOUT_LIFE", 0.5)
    made = site(python(NUMBERED), "left", "right")
    end_life = network.node().announce(KEYS.life(iri("left"), "its-own"))
    made.start(iri("right"))
    live(network, lambda: len(runs(tmp_path)) > 1, 1.5)
    assert len(runs(tmp_path)) == 1
    end_life()
    assert live(network, lambda: len(runs(tmp_path)) == 2)


def test_what_components_print_is_in_the_log_with_what_became_of_them(
    network: Network, tmp_path: Path, site: Callable[..., Site]
) -> None:
    made, heard = site(python('import sys; print("hello"); sys.exit("goodbye")')), fails(network)
    made.start(SLEEPER)
    assert live(network, lambda: bool(heard))
    made.close()
    lines = [line.split(" ", 3)[1:] for line in (tmp_path / "home.log").read_text().splitlines()]
    assert ["stdout", SLEEPER, "hello"] in lines
    assert ["stderr", SLEEPER, "goodbye"] in lines
    notes = [text for stream, _, text in lines if stream == "site"]
    assert notes[0].startswith("started as process ")
    assert "has ended with code 1" in notes[1]


def test_a_line_of_the_log_names_all_components_of_its_process_and_no_more_than_fit(
    network: Network, tmp_path: Path, site: Callable[..., Site]
) -> None:
    names = [f"lamp-{number:02}" for number in range(component_program.NAMED_IN_LOG + 8)]
    made, log = site(python('import time; print("hello"); time.sleep(60)'), *names), tmp_path / "home.log"
    made.start(iri(names[-1]))
    assert live(network, lambda: log.exists() and " hello\n" in log.read_text())
    (said,) = [line.split(" ")[2] for line in log.read_text().splitlines() if line.endswith(" hello")]
    assert said.split("|") == [iri(name) for name in (*names[: component_program.NAMED_IN_LOG - 1], names[-1])]


def test_a_command_that_does_not_start_any_more_is_tried_again(
    network: Network, tmp_path: Path, site: Callable[..., Site]
) -> None:
    program_file, hidden = tmp_path / "program", tmp_path / "hidden"
    program_file.write_text(f"#!{sys.executable}\n{NUMBERED}\nimport signal\nsignal.pause()\n")
    program_file.chmod(0o700)
    made = site(str(program_file))
    made.start(SLEEPER)
    assert live(network, lambda: len(runs(tmp_path)) == 1)
    program_file.rename(hidden)
    os.kill(runs(tmp_path)[0], signal.SIGKILL)
    log = tmp_path / "home.log"
    assert live(network, lambda: log.exists() and "does not start" in log.read_text())
    hidden.rename(program_file)
    assert live(network, lambda: len(runs(tmp_path)) == 2)


@pytest.mark.parametrize("broken", ["os.dup", "selfconf.site.processes.PrintedLines"])
def test_no_process_is_left_unwatched_where_no_more_can_be_opened(
    network: Network, site: Callable[..., Site], monkeypatch: pytest.MonkeyPatch, broken: str
) -> None:
    def none_left(*_: object) -> None:
        raise OSError(errno.EMFILE, os.strerror(errno.EMFILE))

    made, heard = site(python("raise SystemExit(0)")), fails(network)
    with monkeypatch.context() as full:
        full.setattr(broken, none_left)
        with suppress(OSError, PeerError):
            made.start(SLEEPER)
    made.start(SLEEPER)
    assert live(network, lambda: bool(heard))


@pytest.mark.parametrize("code", [0, 2])
def test_a_program_that_ends_before_it_lives_is_not_started_for_others_without_a_limit(
    network: Network, tmp_path: Path, site: Callable[..., Site], code: int
) -> None:
    made = site(python(f"{NUMBERED}; raise SystemExit({code})"), more="; sc:restarts 1 ")
    heard = fails(network)
    for number in (1, 2):
        made.start(SLEEPER)
        assert live(network, lambda number=number: len(heard) == number)
    with pytest.raises(PeerError, match="has ended more than 1 times within 60 s"):
        made.start(SLEEPER)
