"""`demo`: the paper's experiment in the PyBullet world, which lives in the checkout beside selfconf."""

from __future__ import annotations

import argparse
import importlib
import importlib.util
import math
import os
import socket
import sys
from pathlib import Path

from selfconf.cli.options import number_option, whole_number
from selfconf.errors import AuthorError, InstallationError

EXAMPLE = """  selfconf demo --seed 7 --out out/demo --speed 2
  selfconf demo --keys   # with keys, of an authority of its own"""
OWN_KEYS = "keys"
"""The folder of the authority that `--keys` alone makes, in the folder of the results."""
SLOWEST = 0.001
"""The least speed: a drive of 20 s takes some six hours at it."""
ANSWERS = 5.0
"""Seconds within which a display on another machine must answer."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    parser.add_argument(
        "--scene",
        choices=["navigate", "composite", "radio"],
        default="navigate",
        help="`composite` is `navigate` with a camera and a tracker inside of one component; `radio` has no world, and"
        " heeds none of --seed, --speed, --gui and --pictures (default: %(default)s)",
    )
    parser.add_argument("--seed", metavar="N", type=_seed, default=1, help="decides all noise (default: %(default)s)")
    parser.add_argument(
        "--out",
        metavar="DIR",
        type=Path,
        default=Path("out/demo"),
        help="where results go (default: %(default)s)",
    )
    parser.add_argument(
        "--speed",
        metavar="X",
        type=_speed,
        default=1.0,
        help="simulated seconds per second, or `max` for as fast as it goes (default: real time)",
    )
    parser.add_argument("--gui", action="store_true", help="open PyBullet's window; needs a display")
    parser.add_argument(
        "--pictures", choices=["fine", "draft", "none"], default="fine", help="quality (default: %(default)s)"
    )
    parser.add_argument("--serve", action="store_true", help="show the ecology in a browser, until Ctrl-C")
    parser.add_argument(
        "--keys",
        metavar="DIR",
        nargs="?",
        const=True,
        type=Path,
        help="run with keys of the authority in DIR, which is made if there is none: links are TLS, and each program"
        f" may do only what its certificate permits; without DIR the authority is in the folder {OWN_KEYS} of --out"
        " (default: $SELFCONF_KEYS, or else no keys)",
    )
    parser.add_argument("--policy", choices=["repair", "dismantle"], default="repair", help="default: %(default)s")


def run(given: argparse.Namespace) -> int:
    """0 when Astrid arrives (or the radio plays again), 1 when not."""
    root = Path(__file__).resolve().parent.parent.parent
    if not (root / "sim" / "demo.py").is_file():
        raise InstallationError(
            "the world is not part of the installed package; clone the repository and type `make demo`"
        )
    in_the_world = given.scene != "radio"
    if in_the_world and importlib.util.find_spec("pybullet") is None:
        raise InstallationError(
            "PyBullet is missing; it has wheels for Python 3.10 and 3.11 on Linux x86_64; "
            "in the checkout, pip install '.[sim]'"
        )
    if in_the_world and given.pictures != "none" and importlib.util.find_spec("mitsuba") is None:
        raise InstallationError(
            "Mitsuba, which renders the pictures, is missing; in the checkout, pip install '.[sim]', "
            "or go without by --pictures none"
        )
    if given.serve and importlib.util.find_spec("uvicorn") is None:
        raise InstallationError("the server is missing; in the checkout, pip install '.[sim,serve]'")
    if in_the_world and given.gui and not _display(os.environ.get("DISPLAY", "")):
        raise InstallationError("--gui opens a window, and there is no display; leave it out, the pictures need none")
    try:
        given.out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise AuthorError(f"cannot write in {given.out}: {error.strerror}; choose another folder by --out") from None
    keys = _keys(given)
    if str(root) not in sys.path:
        sys.path.insert(0, str(root))
    demo = importlib.import_module("sim.demo")
    options = demo.DemoOptions(
        given.out, given.scene, given.seed, given.speed, given.gui, given.pictures, given.policy, given.serve, keys
    )
    code: int = demo.run(options)
    return code


def _keys(given: argparse.Namespace) -> Path | None:
    """The folder of the authority of the demo, which is made where there is none; None without keys."""
    from selfconf import rendezvous

    folder = given.out / OWN_KEYS if given.keys is True else rendezvous.keys_folder(given.keys)
    if folder is None:
        return None
    from selfconf.access import Authority, open_keys  # what it needs is an extra

    there = folder.is_dir() and any(folder.iterdir())
    keys = open_keys(folder) if there else Authority.init(folder)
    if not keys.is_authority:
        raise AuthorError(f"{folder} is not the folder of an authority, and the demo makes keys for all its programs")
    return folder


def _display(name: str) -> bool:
    """Whether an X server answers under the name; PyBullet would end the process that asks for it in vain."""
    host, _, number = name.rpartition(":")
    try:
        screen = int(number.partition(".")[0])
        if host in ("", "unix"):
            with socket.socket(socket.AF_UNIX) as line:
                line.connect(f"/tmp/.X11-unix/X{screen}")
        else:
            socket.create_connection((host, 6000 + screen), ANSWERS).close()
    except (OSError, ValueError):
        return False
    return True


def _seed(text: str) -> int:
    seed = whole_number(text)
    if seed is None or seed < 0:
        raise argparse.ArgumentTypeError(f"{text!r} is no seed: give a whole number from zero on")
    return seed


def _speed(text: str) -> float:
    speed = math.inf if text == "max" else number_option(text)
    if not speed >= SLOWEST:
        raise argparse.ArgumentTypeError(f"{text!r} is no speed: give a number from {SLOWEST:g} on, or max")
    return speed
