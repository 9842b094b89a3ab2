"""Astrid goes to the bedroom, by a ROS 2 tracker, a Thing, and components of her own: `python -m examples.astrid`.

It starts a room with a lamp, which is a Thing; a node of ROS 2 that finds Astrid in pictures; a bridge to either; and a
task. The room is dark, so the camera asks for light, and the lamp, which was recruited for that, gives it. The tracker
sees Astrid, and she drives until she leaves its picture; it falls silent, her odometry takes its place, and she reaches
the bedroom. It needs the package `zenoh-ros2-sdk`, by which there are nodes without ROS 2 installed.
"""

from __future__ import annotations

import os
import secrets
from pathlib import Path

from examples.players import free_port, need, stage

HERE = Path(__file__).parent
DOMAIN = "8"


def main() -> None:
    """Play the scene once."""
    need("aiohttp", "numpy", "rosbags", "zenoh_ros2_sdk")
    ecology, port = f"astrid-{secrets.token_hex(3)}", str(free_port())
    with stage() as play:
        play(str(HERE.parent / "ros2" / "router.py"), "--port", port).says("relaying")
        room = play(str(HERE / "room.py"))
        os.environ["ROOM"] = url = room.says("http://")
        play(str(HERE / "tracker.py"), "--port", port, "--domain", DOMAIN).says("looking")
        where = ("--domain", DOMAIN, "--ecology", ecology)
        play("-m", "selfconf", "bridge", "ros2", "--connect", f"tcp/127.0.0.1:{port}", *where).says("/tracker is here")
        play("-m", "selfconf", "bridge", "wot", url, "--ecology", ecology).says("floor-lamp is here")
        task = ("--bind", "goal=(AT BEDROOM)", "--ads", str(HERE / "astrid.ttl"), "--ecology", ecology)
        run = play("-m", "selfconf", "run", str(HERE / "go.ttl"), "--wait", *task)
        run.says("my position comes from tracker")
        run.says("my position comes from odometry")
        room.says("Astrid is in the bedroom")
        print("* that was all", flush=True)


if __name__ == "__main__":
    main()
