"""A ROS 2 talker is replaced by another when it dies: `python -m examples.ros2`.

It starts a router, two talkers and a listener on three topics of ROS 2, a bridge that lets them play in an ecology, and
a task: the listener is to hear a talker. Then it kills the talker that is heard. It needs the package `zenoh-ros2-sdk`,
by which there are nodes without ROS 2 installed.
"""

from __future__ import annotations

import secrets
from pathlib import Path

from examples.players import Player, free_port, need, stage, until

HERE = Path(__file__).parent

DOMAIN = "7"


def main() -> None:
    """Play the scene once."""
    need("rosbags", "zenoh_ros2_sdk")
    ecology, port = f"chat-{secrets.token_hex(3)}", str(free_port())
    where = ("--port", port, "--domain", DOMAIN)
    node = str(HERE / "node.py")
    with stage() as play:
        play(str(HERE / "router.py"), "--port", port).says("relaying")
        talkers = {
            name: play(node, "talker", f"/{name}/chatter", "--name", name, *where)
            for name in ("talker_one", "talker_two")
        }
        listener = play(node, "listener", "/chatter", *where)
        site = ("--domain", DOMAIN, "--ecology", ecology)
        bridge = play("-m", "selfconf", "bridge", "ros2", "--connect", f"tcp/127.0.0.1:{port}", *site)
        bridge.says("is here", times=3)
        task = play("-m", "selfconf", "run", str(HERE / "chat.ttl"), "--wait", "--ecology", ecology)
        task.says("running")
        until(lambda: any(heard(listener, name) for name in talkers), "a talker")
        one, other = sorted(talkers, key=lambda name: heard(listener, name), reverse=True)
        print(f"* {one} is killed", flush=True)
        talkers[one].process.kill()
        until(lambda: heard(listener, other), "the other talker")
        print("* that was all", flush=True)


def heard(listener: Player, talker: str) -> bool:
    """Whether the listener has heard a talker."""
    return any(line.startswith(f"heard {talker} ") for line in listener.lines)


if __name__ == "__main__":
    main()
