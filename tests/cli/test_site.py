"""`site`: it serves, finds its sisters on the same machine, and ends cleanly."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pyoxigraph as ox
import pytest

from selfconf.bus.port import Replies
from selfconf.bus.zenoh import ZenohBus, router
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import End, Wake
from selfconf.rendezvous import LIFE_VARIABLE
from selfconf.termination import alive
from tests.cli.command import run
from tests.cli.processes import Home, component_of, dormant
from tests.lab import ADVERTISEMENTS, PREFIXES, iri

pytestmark = pytest.mark.process


def test_it_says_what_it_serves_and_where_and_leaves_nothing_behind(home: Home) -> None:
    site = home.site("peis-home", "ads")
    meeting = json.loads((home.runtime / f"{home.ecology}@peis-home.json").read_text())
    assert meeting["process"] == site.number
    assert site.end(signal.SIGINT) == 0
    where = f"ecology {home.ecology} serves {len(ADVERTISEMENTS)} advertisements on {meeting['endpoint']}"
    assert site.complaints == f"site peis-home of {where}\n"
    assert home.left_behind() == []


def test_a_site_with_nothing_yet_as_of_a_bridge_says_so(home: Home) -> None:
    (home.folder / "later").mkdir()
    site = home.site("peis-home", "later")
    assert site.end(signal.SIGINT) == 0
    assert "serves 0 advertisements so far on " in site.complaints


def test_an_empty_path_as_of_a_variable_that_is_not_set_is_no_folder(capsys: pytest.CaptureFixture[str]) -> None:
    # A site that took it for the current folder would be refused, too, as it would listen beyond this host.
    found = run(capsys, "site", "", "--ecology", "home", "--listen", "tcp/0.0.0.0:0")
    assert found.is_one_sentence("an empty text is no path; the current folder is '.'")


def test_sites_of_one_ecology_on_one_machine_find_each_other(home: Home, capsys: pytest.CaptureFixture[str]) -> None:
    home.site("a", "ads/tracker.ttl")
    home.site("b", "ads/drive.ttl")

    def found(endpoint: str) -> dict[str, str]:
        arguments = "--ecology", home.ecology, "--connect", endpoint
        body = run(capsys, "discover", "--format", "json", *arguments).body
        return {row["component"]: row["site"] for row in body["components"]}

    both = {iri("person-tracker"): "a", iri("astrid-drive"): "b"}
    # With keys the hub of the first is opened anew when it gets to know the second, and hears nobody meanwhile.
    assert home.until(lambda: found(home.endpoint("a")) == both)
    assert home.until(lambda: found(home.endpoint("b")) == both)


def test_a_file_that_is_added_while_it_runs_is_served(home: Home, capsys: pytest.CaptureFixture[str]) -> None:
    home.site("a", "ads")

    def known() -> set[str]:
        body = run(capsys, "discover", "--format", "json", *home.arguments()).body
        return {row["component"] for row in body["components"]}

    assert iri("lamp") not in known()
    (home.folder / "ads" / "lamp.ttl").write_text(PREFIXES + ":lamp a sc:Component, :Lamp .")
    assert home.until(lambda: iri("lamp") in known(), 5.0)


@pytest.fixture
def taken(monkeypatch: pytest.MonkeyPatch) -> ZenohBus:
    """Somebody else who listens, without keys."""
    monkeypatch.delenv("SELFCONF_KEYS", raising=False)
    return router()


def test_the_environment_can_name_its_ecology(home: Home) -> None:
    nameless = home.selfconf("site", "ads")
    assert nameless.ended() == 2
    assert "give --ecology NAME, or set SELFCONF_ECOLOGY" in nameless.complaints
    home.environment["SELFCONF_ECOLOGY"] = home.ecology
    site = home.selfconf("site", "ads", "--name", "named")
    assert home.until(lambda: (home.runtime / f"{home.ecology}@named.json").exists())
    assert site.end(signal.SIGINT) == 0


def test_what_it_cannot_do_is_one_sentence(tmp_path: Path, capsys: pytest.CaptureFixture[str], taken: ZenohBus) -> None:
    folder = str(tmp_path)
    for arguments, words in (
        ((str(tmp_path / "nowhere"), "--ecology", "e"), "no file or folder"),
        ((folder, "--ecology", "a/b"), "cannot name an ecology"),
        ((folder, "--ecology", "e", "--name", "a b"), "cannot name a site"),
        ((folder, "--ecology", "e", "--listen", taken.endpoint), f"cannot listen on {taken.endpoint}"),
        ((folder, "--ecology", "e", "--listen", "here"), "here"),
        ((folder, "--ecology", "e", "--listen", "tcp/127.0.0.1:99999"), "tcp/127.0.0.1:99999 is no endpoint"),
        ((folder, "--ecology", "e", "--listen", "tcp/no.such.host.invalid:0"), "cannot listen on"),
        ((folder, "--ecology", "e", "--connect", "there"), "there"),
    ):
        assert run(capsys, "site", *arguments).is_one_sentence(words)
    taken.close()


def wake(home: Home, name: str) -> None:
    """Have the site start a component."""
    answers: list[Replies] = []

    def answered() -> bool:  # the hub listens before it has heard what its site answers
        answers.append(home.ask(home.keys.wake("a"), encode(Wake(component_of(name)))))
        return bool(answers[-1].samples or answers[-1].errors)

    assert home.until(answered)
    assert [sample.payload for sample in answers[-1].samples] == [b"started"], answers[-1].errors


def test_a_component_that_crashes_lives_again_though_nobody_asked(home: Home) -> None:
    dormant(home, "tracker")
    site = home.site("a", "ads")
    wake(home, "tracker")
    killed: set[int] = set()

    def lives_anew() -> bool:
        return killed.isdisjoint(site.children()) and home.state(component_of("tracker")) is not None

    for _ in range(2):
        assert home.until(lives_anew)
        (process,) = site.children()
        killed.add(process)
        os.kill(process, signal.SIGKILL)
    assert home.until(lives_anew)


def test_a_command_that_components_share_is_one_process(home: Home) -> None:
    for name in ("tracker", "odometry"):
        dormant(home, name, "tracker,odometry")
    site = home.site("a", "ads")
    for name in ("tracker", "odometry"):
        wake(home, name)
    assert home.until(lambda: all(home.state(component_of(name)) is not None for name in ("tracker", "odometry")))
    assert len(site.children()) == 1


def test_a_component_that_does_not_want_to_end_is_ended_and_can_be_started_again(home: Home) -> None:
    dormant(home, "tracker")
    site = home.site("a", "ads")
    wake(home, "tracker")
    assert home.until(lambda: home.state(component_of("tracker")) is not None)
    state = home.state(component_of("tracker"))
    (process,) = site.children()
    os.kill(process, signal.SIGSTOP)
    given = Path(f"/proc/{process}/environ").read_bytes().split(b"\0")
    assert state is not None
    assert f"{LIFE_VARIABLE}={state.life}".encode() in given
    asked = home.ask(home.keys.end("a"), encode(End(component_of("tracker"), state.life)))
    assert [sample.payload for sample in asked.samples] == [b"ended"], asked.errors
    assert not alive(process)
    wake(home, "tracker")
    assert home.until(lambda: home.state(component_of("tracker")) is not None)


def test_what_components_print_is_kept_and_ctrl_c_ends_them_with_their_site(home: Home, tmp_path: Path) -> None:
    (home.folder / "sayer.py").write_text("import signal\nprint('hello')\nsignal.pause()\n")
    dormant(home, "tracker")
    advertisement = home.folder / "ads" / "tracker.ttl"
    text = advertisement.read_text().replace("components.py tracker", "sayer.py")
    advertisement.write_text(text)
    site = home.site("a", "ads", options=("--log", str(tmp_path / "kept")))
    wake(home, "tracker")
    log = tmp_path / "kept" / f"{home.ecology}@a.log"
    assert home.until(lambda: log.exists() and "hello" in log.read_text())
    assert f" stdout {component_of('tracker')} hello\n" in log.read_text()
    (process,) = site.children()
    assert site.end(signal.SIGINT) == 0
    assert not alive(process)
    assert "hello\n" in site.complaints


def test_a_component_that_is_frozen_is_ended_and_lives_again(home: Home) -> None:
    dormant(home, "tracker")
    site = home.site("a", "ads")
    wake(home, "tracker")
    assert home.until(lambda: home.state(component_of("tracker")) is not None)
    (process,) = site.children()
    os.kill(process, signal.SIGSTOP)
    assert home.until(lambda: not alive(process))
    assert home.until(lambda: home.state(component_of("tracker")) is not None)
    assert process not in site.children()


def test_a_task_whose_only_tracker_crashes_goes_on_with_the_tracker_that_its_site_starts_again(home: Home) -> None:
    (home.folder / "ads" / "odometry.ttl").unlink()
    dormant(home, "tracker")
    site = home.site("a", "ads")
    home.components("sonar", "encoder", "control", "drive")
    run = home.run()
    run.act("running")
    (process,) = site.children()
    os.kill(process, signal.SIGKILL)
    assert run.act("lost")["component"] == component_of("tracker")
    run.act("running")  # its site may have started it again before it is to be woken
    assert site.children() != [process]
    assert home.active("tracker", "control", "drive") == {"tracker", "control", "drive"}
    assert run.end(signal.SIGINT) == 0


def test_a_component_is_restarted_by_the_site_that_has_started_it(
    home: Home, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in ("sonar", "encoder", "tracker", "control", "drive"):
        dormant(home, name)
    home.site("a", "ads")
    where = home.arguments()
    task = home.run()
    task.act("running")
    before = home.state(component_of("tracker"))
    outcome = run(capsys, "site", "restart", "person-tracker", *where)
    assert outcome.code == 0, outcome.err
    assert outcome.out.startswith(f"{iri('person-tracker')} lives again at site a: process ")
    after = home.state(component_of("tracker"))
    assert before is not None
    assert after is not None
    assert before.life != after.life
    assert task.act("lost")["component"] == iri("person-tracker")
    task.act("running")
    assert task.end() == 0


def test_what_cannot_be_restarted_is_one_sentence(inhabited: Home, capsys: pytest.CaptureFixture[str]) -> None:
    where = inhabited.arguments()
    refused = run(capsys, "site", "restart", iri("person-tracker"), *where)
    assert refused.is_one_sentence("the site peis-home cannot start person-tracker", "no sc:command")
    assert run(capsys, "site", "restart", "nobody", *where).is_one_sentence("no component nobody")
    assert run(capsys, "site", "restart", *where).is_one_sentence("restart takes one component")
    assert inhabited.state(component_of("tracker")) is not None


def test_a_component_that_another_program_has_started_is_not_its_site_s_to_restart(
    home: Home, capsys: pytest.CaptureFixture[str]
) -> None:
    dormant(home, "tracker")
    home.site("a", "ads")
    home.components("tracker")
    refused = run(capsys, "site", "restart", "person-tracker", *home.arguments())
    assert refused.is_one_sentence("the site a did not end person-tracker: this site has not started")


@pytest.mark.parametrize("own", [True, False], ids=["site", "run"])
def test_components_check_what_they_emit_by_the_ontologies_of_their_site(home: Home, own: bool) -> None:
    (home.folder / "words").mkdir()
    words = PREFIXES + 'rob:PlanarPose2D rob:field ( [ rob:fieldName "colour" ; rob:datatype xsd:string ] ) .\n'
    quads = ox.parse(words.encode(), format=ox.RdfFormat.TURTLE)
    ox.serialize(quads, home.folder / "words" / "poses.rdf", ox.RdfFormat.RDF_XML)
    for name in ("sonar", "encoder", "tracker", "control", "drive"):
        dormant(home, name)
    given = "--ontology", "words"
    if own:
        home.site("a", "ads", options=given)
    task = home.run("--wait") if own else home.run("--wait", "--ads", "ads", *given)
    lost = task.act("lost")
    assert (lost["component"], lost["cause"]) == (iri("person-tracker"), "malformed")
    assert "colour" in lost["detail"]
    task.end()


def test_an_ontology_that_cannot_be_read_is_one_sentence(home: Home, capsys: pytest.CaptureFixture[str]) -> None:
    words = home.folder / "words.ttl"
    words.write_text("no Turtle")
    given = "site", str(home.folder / "ads"), "--ecology", home.ecology, "--ontology"
    assert run(capsys, *given, str(words)).is_one_sentence("words.ttl:1:")
    assert run(capsys, *given, "nowhere").is_one_sentence("there is no file or folder nowhere")


def test_a_site_whose_terminal_is_held_goes_on_and_ends_when_it_is_told(home: Home) -> None:
    """As with Ctrl-S, or with a pipe that nobody reads."""
    reading, writing = os.pipe()
    os.set_blocking(writing, False)
    with suppress(BlockingIOError):
        while os.write(writing, b"x" * 4096):
            pass
    os.set_blocking(writing, True)
    command = (sys.executable, "-m", "selfconf", "site", "ads", "--ecology", home.ecology, "--name", "s1")
    site = subprocess.Popen(command, cwd=home.folder, env=home.environment, stdin=subprocess.DEVNULL, stderr=writing)
    try:
        assert home.until(lambda: (home.runtime / f"{home.ecology}@s1.json").exists())
        (home.folder / "ads" / "broken.ttl").write_text("this is no Turtle")
        (home.folder / "ads" / "lamp.ttl").write_text(PREFIXES + ":lamp a sc:Component, :Lamp .")
        served = home.keys.advertisements("s1")
        assert home.until(lambda: len(home.ask(served, seconds=1.0).samples) > len(ADVERTISEMENTS), 10.0)
        site.send_signal(signal.SIGTERM)
        assert site.wait(10.0) == 0
    finally:
        site.kill()
        site.wait()
        os.close(reading)
        os.close(writing)
