"""The demo as people see it: real processes, real Zenoh sessions, the physics world, pictures at the end."""

from __future__ import annotations

import importlib.util
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from sim.demo import DemoOptions, run
from tests.harness.effort import at_night, thorough
from tests.harness.yardstick import Yardstick
from tests.serve.chromium import CHROMIUM, Chromium, Page

pytest.importorskip("pybullet", reason="the demo needs PyBullet")
pytestmark = [pytest.mark.sim, pytest.mark.process]
PATIENCE = 120.0


class Demo:
    """A demo in the background."""

    def __init__(self, folder: Path, *arguments: str) -> None:
        self.out = folder / "out"
        self.environment = {**os.environ, "SELFCONF_RUNTIME_DIR": str(folder / "runtime")}
        command = [sys.executable, "-m", "selfconf", "demo", "--out", str(self.out), *arguments]
        self.process = subprocess.Popen(
            command, env=self.environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
        )
        self.said: list[str] = []

    def until(self, words: str) -> str:
        """The first line that holds these words; fails if the demo ends before."""
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self.said.append(line)
            if words in line:
                return line
        raise AssertionError(f"it ended without saying {words!r}:\n{''.join(self.said)}")

    def end(self) -> int:
        """Let it end by itself; its exit code."""
        rest, _ = self.process.communicate(timeout=PATIENCE)
        self.said.append(rest)
        return self.process.returncode

    def page(self) -> str:
        """The address of its page, once that is there."""
        address = re.search(r"http://127\.0\.0\.1:\d+/", self.until("page: serving the ecology"))
        assert address is not None
        return address[0]

    @property
    def ecology(self) -> str:
        """The name of its ecology."""
        found = re.search(r"demo-[0-9a-f]+", "".join(self.said))
        assert found is not None
        return found.group()

    def selfconf(self, *arguments: str) -> str:
        """What another command says about the ecology meanwhile."""
        command = [sys.executable, "-m", "selfconf", *arguments, "--ecology", self.ecology]
        done = subprocess.run(
            command, env=self.environment, text=True, capture_output=True, check=True, timeout=PATIENCE
        )
        return done.stdout

    def processes(self) -> list[int]:
        """The processes on this machine that belong to the demo's ecology."""
        found = []
        for entry in Path("/proc").iterdir():
            try:
                command = (entry / "cmdline").read_bytes().decode() if entry.name.isdigit() else ""
            except OSError:
                continue
            if self.ecology in command:
                found.append(int(entry.name))
        return found

    def gone(self) -> bool:
        """Whether nothing of the demo runs any more, given some time."""
        deadline = time.monotonic() + 10
        while self.processes() and time.monotonic() < deadline:
            self.process.poll()
        return not self.processes()


WITNESS = """(() => {{
  const seen = window.seen = {{}};
  const note = (what, there) => {{ if (there && !seen[what]) seen[what] = Date.now() / 1000; }};
  const says = (css, ...texts) => texts.every((text) => document.querySelector(css).textContent.includes(text));
  new MutationObserver(() => {{
    const players = [...document.querySelectorAll('.box .face .name')].map((name) => name.textContent);
    note('diagram', players.includes('{by}'));
    note('loss', says('#events', '{replaced} failed:'));
    note('repair', says('#events', '{by} takes over'));
    note('reason', says('#below', '{replaced} failed:'));
  }}).observe(document.body, {{ subtree: true, childList: true, characterData: true }});
}})()"""
"""Lets a page note when it first shows that one component was replaced by another, in seconds of the Unix epoch."""


ENDED = """fetch('/state').then((answer) => answer.json()).then(({ tasks, events }) => {
  const phases = Object.values(tasks).map((task) => task.phase);
  return phases.length === 1 && phases[0] === 'stopped' && events;
})"""
"""What has happened, once the page has heard of the end of the one task; the server hears of it after the demo."""


def assert_seen(page: Page, reason: str, yardstick: Yardstick) -> float:
    """Diagram, time line and reason were shown within a second of what they tell, once all that is over.

    Returns how many seconds after the loss the last of them was. These are seconds of a machine that has a processor
    for each program: on one that is so many times slower they last so many times as long.
    """
    events = page.until(ENDED)
    lost = next(event for event in events if event["act"] == "lost")
    runs = next(event for event in events if event["act"] == "running" and event["time"] > lost["time"])
    told = {"loss": lost, "reason": lost, "repair": runs, "diagram": runs}
    seen: dict[str, float] = page.until("Object.keys(window.seen).length === 4 && window.seen")
    assert reason in lost["detail"]
    shown = max(seen.values())
    slower = yardstick.slower(lost["time"], shown)
    assert {what: late for what in seen if (late := (seen[what] - told[what]["time"]) / slower) > 1.0} == {}
    return (shown - float(lost["time"])) / slower


@pytest.fixture
def yardstick() -> Iterator[Yardstick]:
    with Yardstick() as yardstick:
        yield yardstick


@pytest.fixture
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Chromium | None]:
    """A browser; None where there is none, or no server."""
    if CHROMIUM is None or importlib.util.find_spec("uvicorn") is None:
        yield None
        return
    browser = Chromium(tmp_path_factory.mktemp("browser"))
    yield browser
    browser.close()


@pytest.fixture
def demo(tmp_path: Path) -> Iterator[list[Demo]]:
    demos: list[Demo] = []
    yield demos
    for one in demos:
        if one.process.poll() is None:
            one.process.send_signal(signal.SIGINT)
            one.process.communicate(timeout=PATIENCE)


@thorough
def test_astrid_arrives_and_pictures_are_drawn(tmp_path: Path, demo: list[Demo]) -> None:
    demo.append(Demo(tmp_path, "--speed", "max", "--seed", "3", "--pictures", "draft"))
    assert demo[0].end() == 0, demo[0].said
    result = json.loads((demo[0].out / "result.json").read_text())
    assert result["outcome"] == "arrived"
    assert result["error"] < 0.25
    assert (result["lost"], result["cause"], result["touched"]) == ("person-tracker", "fail", [])
    assert 0 < result["gap"] < 2
    drawn = {path.name for path in demo[0].out.iterdir()}
    assert drawn >= {"run.webp", "run-plan.png", "run-perspective.png", "configuration-1.svg", "tracker-view.png"}
    assert demo[0].gone()


HIDING = """
import sys

class Hiding:
    def find_spec(self, name, *_):
        if name.partition(".")[0] in ("mitsuba", "mitsuba_oidn", "PIL", "pygraphviz", "resvg_py", "shapely"):
            raise ModuleNotFoundError(f"No module named {name!r}")

sys.meta_path.insert(0, Hiding())
"""
"""The module `sitecustomize` of a Python in which nothing is installed that draws pictures."""


def test_the_living_ecology_can_be_asked_while_a_demo_without_pictures_runs(
    tmp_path: Path, demo: list[Demo], monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "sitecustomize.py").write_text(HIDING)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    demo.append(Demo(tmp_path, "--speed", "0.2", "--pictures", "none"))
    running = demo[0]
    running.until("         running")
    count = running.selfconf("query", "SELECT (COUNT(?c) AS ?n) { ?c a rob:PositionSensor }", "--format", "csv")
    assert count.split() == ["n", "2"]
    deployed = running.selfconf("query", "SELECT ?c { ?x a sc:Configuration ; sc:assignment/sc:component ?c }")
    assert "home:person-tracker" in deployed
    assert "running" in running.selfconf("status")
    running.process.send_signal(signal.SIGINT)
    assert running.end() != 0
    assert running.gone()


@pytest.mark.usefixtures("handlers")
def test_a_signal_that_is_ignored_as_by_nohup_ends_no_demo(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sim.demo._navigate", lambda given: 0)
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    assert run(DemoOptions(tmp_path)) == 0
    assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    assert signal.getsignal(signal.SIGTERM) not in (signal.SIG_IGN, signal.SIG_DFL)


@pytest.mark.usefixtures("handlers")
def test_a_refused_task_is_what_the_demo_ends_with(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    examples = shutil.copytree("examples", tmp_path / "examples")
    (examples / "peis-home" / "thinking-cap.ttl").unlink()
    monkeypatch.setattr("sim.demo.EXAMPLES", examples)
    assert run(DemoOptions(tmp_path, speed=float("inf"), pictures="none")) == 1
    assert "there is no configuration for her task" in capfd.readouterr().err


@at_night
def test_a_camera_is_replaced_inside_of_a_composite_and_the_composite_by_odometry(
    tmp_path: Path, demo: list[Demo]
) -> None:
    demo.append(Demo(tmp_path, "--scene", "composite", "--speed", "max", "--seed", "3", "--pictures", "draft"))
    assert demo[0].end() == 0, demo[0].said
    result = json.loads((demo[0].out / "result.json").read_text())
    assert result["outcome"] == "arrived"
    assert result["error"] < 0.25
    # What the task outside is told of is the composite alone, once.
    assert (result["lost"], result["cause"], result["touched"]) == ("position-service", "fail", [])
    assert len(result["configurations"]) == 2
    words = "".join(demo[0].said)
    told = [words.index(part) for part in ("a cloth covers the lens", "the lower-camera looks", "LOST")]
    assert told == sorted(told)
    assert words.count("LOST") == 1
    assert "no component is eligible for the role tracker" in words
    assert demo[0].gone()


@at_night
def test_a_dismantling_configurator_arrives_too(tmp_path: Path, demo: list[Demo]) -> None:
    demo.append(Demo(tmp_path, "--speed", "max", "--policy", "dismantle", "--pictures", "none"))
    assert demo[0].end() == 0, demo[0].said
    result = json.loads((demo[0].out / "result.json").read_text())
    assert result["outcome"] == "arrived"
    assert len(result["configurations"]) == 2


@pytest.mark.parametrize(
    ("keys", "protocol"),
    [pytest.param((), "tcp", marks=at_night, id="open"), pytest.param(("--keys",), "tls", id="keys")],
)
def test_a_speaker_that_fails_is_replaced_and_a_browser_shows_it(
    keys: tuple[str, ...],
    protocol: str,
    tmp_path: Path,
    demo: list[Demo],
    browser: Chromium | None,
    yardstick: Yardstick,
) -> None:
    demo.append(Demo(tmp_path, "--scene", "radio", *keys, *(() if browser is None else ("--serve",))))
    if browser is not None:
        page = browser.page(demo[0].page())
        page.value(WITNESS.format(replaced="-speaker", by="shelf-speaker"))
        demo[0].until("the page shows what has happened")
        assert_seen(page, "a person has pulled the plug", yardstick)
        page.click("tuner")
        page.says(".log", "for looking on only" if keys else "started as process")
        demo[0].process.send_signal(signal.SIGINT)
    assert demo[0].end() == 0, demo[0].said
    words = "".join(demo[0].said)
    assert f"on {protocol}/127.0.0.1:" in words
    assert "before: tuner, left-speaker, right-speaker" in words
    assert re.search(r"after:  tuner, .*shelf-speaker", words)
    recordings = list(demo[0].out.glob("*.wav"))
    assert len(recordings) == 3
    # At 8,000 samples of 2 bytes a second: something to listen to.
    assert all(recording.stat().st_size > 16_000 for recording in recordings)
    assert demo[0].gone()


@at_night
def test_astrid_arrives_with_keys_too(tmp_path: Path, demo: list[Demo]) -> None:
    demo.append(Demo(tmp_path, "--keys", str(tmp_path / "authority"), "--speed", "max", "--pictures", "none"))
    running = demo[0]
    assert f"--keys {tmp_path}/authority" in running.until("in another terminal")
    running.until("         running")
    sites = json.loads(running.selfconf("access", "--keys", str(tmp_path / "authority"), "--format", "json"))["sites"]
    assert [site["refused"] for site in sites] == [[], []], "every program of the demo does what it may"
    assert running.end() == 0, running.said
    result = json.loads((running.out / "result.json").read_text())
    assert (result["outcome"], result["lost"], result["touched"]) == ("arrived", "person-tracker", [])
    assert running.gone()


def test_the_drive_is_shown_in_a_browser_until_ctrl_c(
    tmp_path: Path, demo: list[Demo], browser: Chromium | None, yardstick: Yardstick
) -> None:
    if browser is None:
        pytest.skip("there is no Chromium, or the extra `serve` is not installed")
    demo.append(Demo(tmp_path, "--serve", "--pictures", "none"))
    shown, address = demo[0], demo[0].page()
    pages = [browser.page(address, *size) for size in ((1320, 780, False), (390, 844, True))]
    for page in pages:
        page.value(WITNESS.format(replaced="person-tracker", by="absolute-odometry"))
    shown.until("         running")
    for page in pages:
        page.until("document.querySelectorAll('.box').length === 5")
    shown.until("the page shows what has happened")
    for page in pages:
        assert assert_seen(page, "Astrid has left the view", yardstick) < 1.0  # odometry lives already
        assert page.trouble == []
    shown.process.send_signal(signal.SIGINT)
    assert shown.end() == 0
    assert shown.gone()
