"""The demo: two sites, the world, the Thinking Cap and the configurator, each a process, and what comes of them.

It starts them, tells what happens, and ends them, whatever happens; then it draws the pictures. The processes meet
in an ecology with a name of its own, on free ports of 127.0.0.1, so that any number of demos run side by side.
"""

from __future__ import annotations

import json
import os
import shutil
import signal
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from types import FrameType

from selfconf.termination import ending_signals
from sim.account import Account
from sim.crew import Crew
from sim.stage import STARTING, DemoError, Stage

ROOT = Path(__file__).resolve().parent.parent
EXAMPLES = ROOT / "examples"
RESULTS = (
    "run.npz",
    "result.json",
    "run.webp",
    "run-*.png",
    "configuration-*.svg",
    "configuration-*.png",
    "tracker-view.png",
)
"""What a run leaves in its folder."""
PLAYING = 2.0
"""Seconds that the radio plays before a plug is pulled, and after another speaker has taken over."""


@dataclass(frozen=True)
class DemoOptions:
    """What is played, and how: the scene, its noise and speed, and where the results go."""

    out: Path
    scene: str = "navigate"
    seed: int = 1
    speed: float = 1.0
    """Simulated seconds for each second; infinite for as fast as it goes."""
    gui: bool = False
    pictures: str = "fine"
    policy: str = "repair"
    serve: bool = False
    """Whether the ecology is shown in a browser, until Ctrl-C."""
    keys: Path | None = None
    """The folder of an authority; without one there are no keys."""

    @property
    def environment(self) -> dict[str, str]:
        """The variables that its processes share."""
        return {} if self.keys is None else {"SELFCONF_KEYS": str(self.keys.absolute())}

    @property
    def shown(self) -> str:
        """The option by which a command shows a certificate of that authority."""
        return "" if self.keys is None else f" --keys {self.keys}"


def run(given: DemoOptions) -> int:
    """Play the scene that the options name; 0 if it ends as it should."""
    for number in ending_signals():
        signal.signal(number, _interrupt)
    scenes = {"navigate": _navigate, "composite": _navigate, "radio": _radio}
    try:
        return scenes[given.scene](given)
    except DemoError as error:
        print(f"selfconf demo: {error}", file=sys.stderr)
        return 1


def _interrupt(number: int, _: FrameType | None) -> None:
    """End as Ctrl-C does, taking everything down."""
    raise KeyboardInterrupt


def _tell(sentence: str) -> None:
    print(sentence, flush=True)


def _navigate(given: DemoOptions) -> int:
    from sim.outcome import result, summary  # loads the world, which takes a moment

    for old in (path for pattern in RESULTS for path in given.out.glob(pattern)):
        old.unlink()  # an earlier run's pictures would pass for this one's
    if given.scene == "composite":
        _tell("One component tells where she is; inside are a camera and a tracker, and the camera fails first.")
    _tell("Astrid goes to the bedroom. Each line: seconds of real time, which act of self-configuration, what.")
    _tell("Act 1 asks the ecology, act 2 collects its answers, act 3 composes a configuration, act 4 deploys it.")
    record = given.out.absolute() / "run.npz"
    with Crew(given.environment) as crew:
        stage = Stage(crew, _tell)
        _tell(f"meanwhile, in another terminal: selfconf discover --ecology {stage.ecology}{given.shown}")
        inside = given.scene == "composite"
        stage.site("living-room", EXAMPLES / "eyes" if inside else EXAMPLES / "peis-home" / "person-tracker.ttl")
        others = sorted(set((EXAMPLES / "peis-home").glob("*.ttl")) - {EXAMPLES / "peis-home" / "person-tracker.ttl"})
        stage.site("astrid", *others)
        if given.serve:
            stage.serve()
        world = _world_arguments(given, stage, record)
        crew.start("world", "-m", "sim.peis_home", *world)
        stage.until(lambda: stage.account.ready, STARTING, ("world",), "the world was there")
        goal = "goal=(AT BEDROOM)"
        stage.configurator(EXAMPLES / "navigate.ttl", given.policy, "robot=:Astrid", goal)
        limit = max(120.0, 130.0 / given.speed) + 60.0
        account = stage.account

        def ended() -> bool:
            return account.end is not None or account.refused

        stage.until(ended, limit, ("world", "configurator"), "the end of the run")
        crew.end("configurator", signal.SIGINT)
        stage.listen(0.2)
        if given.serve:
            stage.linger()
    if account.end is None:
        raise DemoError("Astrid has not arrived: there is no configuration for her task")
    _tell("")
    for sentence in summary(account):
        _tell(sentence)
    figures = given.out / "result.json"
    figures.write_text(json.dumps(result(account), indent=2) + "\n")
    _tell(f"wrote {figures}")
    if given.pictures != "none":
        for path in _drawing()(account, record, given.out, given.pictures, _tell):
            _tell(f"wrote {path}")
    return 0 if account.end["outcome"] == "arrived" and not account.end["touched"] else 1


def _drawing() -> Callable[[Account, Path, Path, str, Callable[[str], None]], list[Path]]:
    """What draws the pictures of a run. A signal waits until it is loaded: interrupted as it loads, Mitsuba aborts."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, ending_signals())
    try:
        from sim.gallery import draw_run
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
    return draw_run


def _world_arguments(given: DemoOptions, stage: Stage, record: Path) -> list[str]:
    """What the program of the world is started with."""
    world = ["--ecology", stage.ecology, "--connect", stage.endpoint, "--record", str(record)]
    world += ["--seed", str(given.seed), "--speed", str(given.speed), *(["--gui"] if given.gui else [])]
    return [*world, "--eyes"] if given.scene == "composite" else world


def _radio(given: DemoOptions) -> int:
    _tell("The radio plays in the living room; then a person pulls the plug of a speaker.")
    sound = Path(tempfile.mkdtemp(prefix="selfconf-sound-"))
    try:
        with Crew({**given.environment, "SIM_SOUND": str(sound)}) as crew:
            stage = Stage(crew, _tell)
            stage.site("living-room", EXAMPLES / "radio")
            if given.serve:
                stage.serve()
            stage.configurator(EXAMPLES / "radio.ttl", given.policy, "room=:living-room")
            account = stage.account
            vital = ("configurator", "living-room")

            def playing() -> set[str]:
                return {fact["speaker"] for fact in account.played if fact["event"] == "plays"}

            stage.until(lambda: len(playing()) >= 2, STARTING, vital, "two speakers played")
            stage.listen(PLAYING)
            plugged = next(fact for fact in account.played if fact["event"] == "plays")
            _tell(f"          pulling the plug of {plugged['speaker']}")
            os.kill(plugged["process"], signal.SIGUSR1)
            stage.until(lambda: len(playing()) >= 3, STARTING, vital, "another speaker played in its place")
            stage.until(lambda: len(account.configurations) >= 2, STARTING, vital, "a second configuration")
            stage.listen(PLAYING)
            crew.end("configurator", signal.SIGINT)
            stage.listen(1.0)
            if given.serve:
                stage.linger()
        for path in sorted(sound.glob("*.wav")):
            shutil.copy(path, given.out / path.name)
            _tell(f"wrote {given.out / path.name}")
    finally:
        shutil.rmtree(sound, ignore_errors=True)
    before, after = ([c for r in cfg["roles"] for c in r["components"]] for cfg in account.configurations[:2])
    _tell(f"before: {', '.join(c.rpartition('#')[2] for c in before)}")
    _tell(f"after:  {', '.join(c.rpartition('#')[2] for c in after)}")
    return 0
