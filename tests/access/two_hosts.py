"""Two hosts, as network namespaces that a pair of virtual cables connects, and a page of the docs followed on them.

    unshare -rn python -m tests.access.two_hosts FOLDER

It prints the lines of JSON of the run of the page. Each host has a folder of its own, and no address but loopback and
the one that the page says. Nothing outside of the namespaces is reached or changed.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ADDRESSES = {"kitchen": "192.168.1.7", "attic": "192.168.1.8"}
PATIENCE = 60.0


class Host:
    """A network namespace, with a folder."""

    def __init__(self, folder: Path, name: str, prefix: list[str]) -> None:
        self.folder, self._prefix = folder / name, prefix
        self.folder.mkdir()
        path = f"{folder}:{os.environ['PATH']}"
        self._environment = {
            **{name: value for name, value in os.environ.items() if not name.startswith("SELFCONF_")},
            "SELFCONF_RUNTIME_DIR": str(self.folder / "runtime"),
            "PYTHONPATH": str(ROOT),
            "PATH": path,
        }

    def start(self, command: str) -> subprocess.Popen[str]:
        """Start what somebody types there."""
        return subprocess.Popen(
            [*self._prefix, *shlex.split(command)],
            cwd=self.folder,
            env=self._environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def type(self, command: str) -> str:
        """What a command prints that somebody types there; ends this program if it fails."""
        typed = self.start(command)
        out, err = typed.communicate(timeout=PATIENCE)
        if typed.returncode:
            raise SystemExit(f"{command}: {err}")
        return out


def steps() -> list[list[str]]:
    """The commands of the steps on two hosts, as docs/access.md has them."""
    section = (ROOT / "docs/access.md").read_text().partition("\n## On two hosts\n")[2].partition("\n## ")[0]
    blocks = re.findall(r"```console\n(.*?)```", section, re.S)
    return [re.findall(r"^ *\$ (.*)$", block.replace("\\\n", " "), re.M) for block in blocks]


def cable(second: int) -> None:
    """Connect this namespace with that of a process."""
    there = f"nsenter -t {second} -n "
    for command in (
        "ip link set lo up",
        f"ip link add v0 type veth peer name v1 netns {second}",
        f"ip addr add {ADDRESSES['kitchen']}/24 dev v0",
        "ip link set v0 up",
        f"{there}ip link set lo up",
        f"{there}ip addr add {ADDRESSES['attic']}/24 dev v1",
        f"{there}ip link set v1 up",
    ):
        subprocess.run(command.split(), check=True)


def waited(condition: Callable[[], object], what: str) -> None:
    """Wait until something holds."""
    deadline = time.monotonic() + PATIENCE
    while not condition():
        if time.monotonic() > deadline:
            raise SystemExit(f"{what} has not come")
        time.sleep(0.05)  # nothing tells of a file that another program writes


def main() -> None:
    """Follow the page."""
    folder = Path(sys.argv[1])
    mine = Path("/proc/self/ns/net").readlink()
    holder = subprocess.Popen(["unshare", "-n", "cat"], stdin=subprocess.PIPE)
    waited(lambda: Path(f"/proc/{holder.pid}/ns/net").readlink() != mine, "the namespace")
    cable(holder.pid)
    program = folder / "selfconf"
    program.write_text(f'#!/bin/sh\nexec {sys.executable} -m selfconf "$@"\n')
    program.chmod(0o755)
    kitchen, attic = Host(folder, "kitchen", []), Host(folder, "attic", ["nsenter", "-t", str(holder.pid), "-n"])
    for host, name in ((kitchen, "display"), (attic, "clock")):
        (host.folder / "ads").mkdir()
        for kind in ("ttl", "py"):
            shutil.copy(ROOT / f"examples/clock/{name}.{kind}", host.folder / "ads")
    shutil.copy(ROOT / "examples/clock/tell-the-time.ttl", kitchen.folder / "task.ttl")
    on_kitchen, on_attic, on_either = steps()
    sites = []
    try:
        for command in on_kitchen[:-1]:
            kitchen.type(command)
        sites.append(kitchen.start(on_kitchen[-1]))
        waited(lambda: list(kitchen.folder.glob("runtime/*@kitchen.json")), "the site of the kitchen")
        shutil.copytree(kitchen.folder / "attic-keys", attic.folder / "attic-keys")
        sites.append(attic.start(on_attic[0]))
        waited(lambda: list(attic.folder.glob("runtime/*@attic.json")), "the site of the attic")
        discover, run, access = on_either
        waited(lambda: ":clock" in kitchen.type(discover), "the clock in the attic")
        task = kitchen.start(f"{run} --format json")
        sites.insert(0, task)
        for line in task.stdout or ():
            print(line, end="", flush=True)
            if '"act": "running"' in line:
                print(kitchen.type(access), flush=True)
                return
        raise SystemExit(f"{run}: {task.stderr.read() if task.stderr else ''}")
    finally:
        for process in (*sites, holder):
            process.terminate()
            process.wait(PATIENCE)


if __name__ == "__main__":
    main()
