"""The other end of the bare Zenoh round trip: `python -m benchmarks.failover_echo ENDPOINT`."""

from __future__ import annotations

import json
import sys

import zenoh
from zenoh.handlers import Callback


def main() -> None:
    """Echo until stdin ends."""
    config = zenoh.Config()
    config.insert_json5("mode", '"client"')
    config.insert_json5("scouting/multicast/enabled", "false")
    config.insert_json5("connect/endpoints", json.dumps([sys.argv[1]]))
    with zenoh.open(config) as session:
        back = session.declare_publisher("echo/back", congestion_control=zenoh.CongestionControl.BLOCK, express=True)

        def answer(sample: zenoh.Sample) -> None:
            back.put(sample.payload)

        session.declare_subscriber("echo/go", Callback(answer, indirect=False))
        print("ready", flush=True)
        sys.stdin.read()


if __name__ == "__main__":
    main()
