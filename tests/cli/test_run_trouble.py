"""`run` in trouble, with real processes: beside another run, suspended, ended early, or its own site is killed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from selfconf.termination import alive
from tests.cli.command import run as command
from tests.cli.processes import Home, component_of, dormant
from tests.lab import PREFIXES

pytestmark = pytest.mark.process

EVERYBODY = ("tracker", "sonar", "encoder", "odometry", "control", "drive")
TASK = {"sonar", "encoder", "control", "drive"}


def test_run_with_wait_goes_on_when_another_run_lets_go_of_a_component(inhabited: Home) -> None:
    first = inhabited.run()
    first.act("running")
    second = inhabited.run("--wait")
    lost = second.act("waiting")["lost"]
    assert all("configurator " in why and why.endswith(" holds it") for why in lost.values())
    third = inhabited.run()
    assert third.ended() == 1
    assert first.end(signal.SIGINT) == 0
    second.act("running")
    assert inhabited.active(*EVERYBODY) == TASK | {"tracker"}
    assert second.end(signal.SIGINT) == 0


def test_people_are_told_which_configurator_holds_what_they_need(inhabited: Home) -> None:
    holder = inhabited.run()
    holder.act("running")
    arguments = ("navigate.ttl", "--bind", "robot=:Astrid", "--bind", "goal=x", "--ecology", inhabited.ecology)
    refused = inhabited.selfconf("run", *arguments)
    assert refused.ended() == 1
    assert "refused, the task navigate (priority 0, configurator " in refused.complaints
    assert "start it again" not in refused.complaints
    assert "run again when it is free" in refused.complaints
    assert holder.end(signal.SIGINT) == 0


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no device that is always full")
@pytest.mark.parametrize(("form", "stream"), [("json", "stdout"), ("text", "stderr")])
def test_a_run_whose_lines_cannot_be_written_takes_everything_down(inhabited: Home, form: str, stream: str) -> None:
    words = ("run", "navigate.ttl", "--bind", "robot=:Astrid", "--bind", "goal=x", "--ecology", inhabited.ecology)
    command = [sys.executable, "-m", "selfconf", *words, "--format", form]
    with Path("/dev/full").open("w") as full:
        streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, stream: full}
        done = subprocess.run(
            command, cwd=inhabited.folder, env=inhabited.environment, text=True, check=False, **streams
        )
    assert done.returncode == 2
    if form == "json":
        said = "its lines cannot be written (No space left on device); everything is taken down"
        assert done.stderr == f"selfconf run: {said}\n"
    assert inhabited.active(*EVERYBODY) == set()


def test_a_run_that_was_suspended_goes_on_with_those_that_turned_themselves_off_meanwhile(inhabited: Home) -> None:
    """As Ctrl-Z and `fg` do."""
    run = inhabited.run()
    epoch = run.act("running")["epoch"]
    run.send(signal.SIGSTOP)
    assert inhabited.until(lambda: inhabited.active(*EVERYBODY) == set())
    run.send(signal.SIGCONT)
    assert run.act("running")["epoch"] > epoch
    assert inhabited.active(*EVERYBODY) == TASK | {"tracker"}
    assert run.end(signal.SIGINT) == 0


def test_no_moment_passes_in_which_a_run_that_is_suspended_acts_and_is_not_named(
    inhabited: Home, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    run = inhabited.run()
    run.act("running")
    where = inhabited.arguments()
    (status,) = command(capsys, "status", "--format", "json", *where).body
    name = status["configurator"]
    run.send(signal.SIGSTOP)
    acting = inhabited.active(*EVERYBODY)
    while acting:
        asked = command(capsys, "status", "--format", "json", *where)
        acting = inhabited.active(*EVERYBODY)
        assert not acting or (name in asked.err and asked.code == 2) or asked.body
    run.send(signal.SIGCONT)
    run.act("running")
    run.send(signal.SIGSTOP)
    stopped = command(capsys, "stop", *where)
    assert stopped.code == 2
    assert f"the configurator {name!r}" in stopped.err
    assert inhabited.until(lambda: inhabited.active(*EVERYBODY) == set())
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(inhabited.runtime))  # commands on its machine see the run itself
    said = f"process {status['process']} of this machine, which runs the task {status['task']!r}, is suspended"
    assert inhabited.until(lambda: said in command(capsys, "status", *where).err)
    for asked in ("status", "stop"):
        found = command(capsys, asked, *where)
        assert (found.code, said in found.err) == (2, True)
    run.send(signal.SIGCONT)
    run.act("running")
    assert run.end(signal.SIGINT) == 0


def test_a_component_that_dies_while_it_is_activated_is_started_again_by_its_site(home: Home) -> None:
    dormant(home, "tracker")
    home.site("peis-home", "ads")
    home.components("sonar", "encoder", "control", "drive")
    (home.folder / "tracker.die").touch()
    run = home.run("--wait")
    lost = run.act("lost")
    assert (lost["component"], lost["cause"]) == (component_of("tracker"), "crash")
    run.act("running")
    assert home.active(*EVERYBODY) == TASK | {"tracker"}
    assert run.end(signal.SIGINT) == 0


def test_a_run_whose_own_site_is_killed_says_so_and_takes_everything_down(home: Home) -> None:
    for name in ("tracker", "sonar", "encoder", "control", "drive"):
        dormant(home, name)
    run = home.run("--ads", "ads")
    run.act("running")
    (site,) = run.children()
    os.kill(site, signal.SIGKILL)
    assert run.ended() == 2
    assert "selfconf run: its own site has ended with code -9; everything is taken down\n" in run.complaints


def test_a_run_whose_own_site_cannot_start_says_why_in_one_sentence(home: Home) -> None:
    home.environment["SELFCONF_RUNTIME_DIR"] = "/proc/nope"
    run = home.run("--ads", "ads")
    assert run.ended() == 2
    assert run.complaints.count("\n") == 1
    assert "cannot write in /proc/nope" in run.complaints


def test_sigterm_while_it_begins_leaves_no_site_behind(home: Home) -> None:
    run = home.run("--ads", "ads")
    assert home.until(lambda: bool(run.children()))
    (site,) = run.children()
    assert run.end(signal.SIGTERM) == 130
    assert home.until(lambda: not alive(site))
    assert list(home.runtime.glob("*.json")) == []


def test_a_component_that_cannot_begin_is_asked_for_a_few_times_told_of_once_and_never_out_of_control(
    home: Home,
) -> None:
    """Its program ends with 2 before it lives: the site lets nobody start it without a limit."""
    (home.folder / "ads" / "lamp.ttl").write_text(
        f"{PREFIXES} :lamp a sc:Component, :Lamp ; sc:grounding [ sc:command \"sh -c 'echo no bulb; exit 2'\" ] ."
    )
    template = ":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class :Lamp ."
    (home.folder / "t.ttl").write_text(f"{PREFIXES} {template}")
    run = home.selfconf("run", "t.ttl", "--ads", "ads/lamp.ttl")
    assert run.ended() == 1
    said = run.complaints
    assert said.count("no bulb\n") == 4
    assert said.count("LOST   :lamp: crash, the process that its site started for it has ended with code 2") == 4
    assert said.count("`selfconf log lamp --ecology run-") == 1
    assert said.count("has ended more than 3 times within 60 s") == 1
    assert "LOST   :lamp: refused\n" in said
    assert "was lost" not in said
    assert "out of control" not in said


def test_the_log_of_what_crashes_is_named_with_the_options_by_which_the_ecology_was(home: Home) -> None:
    """Logs of another ecology may be on this machine as well, and then `selfconf log` asks which is meant."""
    (home.folder / "lamp.ttl").write_text(
        f'{PREFIXES} :lamp a sc:Component, :Lamp ; sc:restarts 0 ; sc:grounding [ sc:command "false" ] .'
    )
    template = ":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class :Lamp ."
    (home.folder / "t.ttl").write_text(f"{PREFIXES} {template}")
    home.site("a", "lamp.ttl")
    run = home.selfconf("run", "t.ttl", "--ecology", home.ecology, "--connect", home.endpoint("a"))
    assert run.ended() == 1
    options = f"--ecology {home.ecology} --connect {home.endpoint('a')}"
    assert f"`selfconf log lamp {options}` shows what it has printed\n" in run.complaints


LONG = """
:t a sc:Template ; sc:roles ( :r ) .
:r a sc:Role ; sh:class sc:Component ; sh:sparql [ sh:select \"\"\"SELECT $this WHERE {
  ?a ?b ?c . ?d ?e ?f . ?g ?h ?i . ?j ?k ?l . ?m ?n ?o . FILTER(?a = ?l && ?c = ?d && ?b = ?k && ?i = ?m && ?a = $this)
}\"\"\" ] .
"""
"""A role that takes minutes to judge."""
BEGUN = 0.9
"""Seconds of a processor after which a program is at the search: to start, and to discover, takes a third of that."""


@pytest.mark.parametrize("how", ["a signal", "stop", "a site that ends"])
def test_a_search_of_minutes_ends_with_whom_it_is_for(how: str, home: Home) -> None:
    (home.folder / "long.ttl").write_text(PREFIXES + LONG)
    site = home.site("peis-home", "ads")
    if how == "a site that ends":
        assert home.selfconf("run", "long.ttl", "--ecology", home.ecology, "--detach").ended() == 0
        assert home.until(lambda: _processor_seconds(site.number) > BEGUN)
        assert site.end(signal.SIGTERM) == 0
        return
    run = home.selfconf("run", "long.ttl", "--ecology", home.ecology, "--format", "json")
    assert home.until(lambda: _processor_seconds(run.number) > BEGUN)
    if how == "stop":
        assert home.selfconf("stop", "--ecology", home.ecology).ended() == 0
        assert run.ended() == 0
    else:
        assert run.end(signal.SIGINT) == 0


def _processor_seconds(process: int) -> float:
    """The processor time that a process has used (proc_pid_stat(5), fields 14 and 15)."""
    fields = Path(f"/proc/{process}/stat").read_bytes().rpartition(b")")[2].split()
    return sum(map(int, fields[11:13])) / os.sysconf("SC_CLK_TCK")
