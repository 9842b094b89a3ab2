"""A router of Zenoh, for nodes of ROS 2 where `ros2 run rmw_zenoh_cpp rmw_zenohd` is not installed."""

from __future__ import annotations

import argparse
import json
import threading

import zenoh


def main() -> None:
    """Relay between nodes until the process is ended."""
    parser = argparse.ArgumentParser(description="a router of Zenoh")
    parser.add_argument("--port", type=int, default=7447)
    given = parser.parse_args()
    settings = zenoh.Config()
    settings.insert_json5("mode", json.dumps("router"))
    settings.insert_json5("listen/endpoints", json.dumps([f"tcp/127.0.0.1:{given.port}"]))
    settings.insert_json5("scouting/multicast/enabled", "false")
    with zenoh.open(settings):
        print(f"relaying on tcp/127.0.0.1:{given.port}", flush=True)
        threading.Event().wait()


if __name__ == "__main__":
    main()
