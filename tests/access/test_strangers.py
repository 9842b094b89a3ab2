"""A stranger without a certificate who connects again and again: nothing is noticed by whom it does not concern."""

from __future__ import annotations

import json
import signal
import sys
import time
from pathlib import Path

import pytest

from selfconf.protocol.endpoints import endpoint_port
from tests.cli.processes import Home, dormant
from tests.harness.effort import of_keys

TASK = ("sonar", "encoder", "tracker", "control", "drive")
CONNECTIONS = 2000
FLOOD = """
import os, socket, sys

port, left, held = int(sys.argv[1]), int(sys.argv[2]), []
print("begun", flush=True)
while left:
    left -= 1
    try:
        connection = socket.create_connection(("127.0.0.1", port), 0.01)
    except OSError:
        continue
    if left % 3 == 0:
        held.append(connection)
        continue
    if left % 3 == 1:
        connection.sendall(os.urandom(200))
    connection.close()
print("done", flush=True)
"""
"""Connects so often to a port: a third of the connections stay silent, a third end at once, a third say nonsense."""


@of_keys
@pytest.mark.process
def test_programs_of_the_host_join_at_once_while_a_stranger_floods_the_hub(tmp_path: Path) -> None:
    home = Home(tmp_path, keys=True)
    try:
        for name in TASK:
            dormant(home, name)
        site = home.site("home", "ads")
        task = home.run()
        task.act("running")
        flood = home.program(sys.executable, "-c", FLOOD, str(endpoint_port(home.endpoint())), str(CONNECTIONS))
        assert flood.line() == "begun"
        took = []
        while not (took and flood.over):
            began = time.monotonic()
            status = home.selfconf("status", "--ecology", home.ecology, "--format", "json")
            said = status.rest()
            assert status.ended() == 0, status.complaints
            assert json.loads(said)[0]["phase"] == "running"
            took.append(time.monotonic() - began)
        assert min(took) < 2.0
        assert max(took) < 8.0, "one that had to wait for the flood would have taken minutes"
        task.send(signal.SIGTERM)
        assert '"act": "lost"' not in task.rest()
        assert "connections without a trusted certificate wait" in site.complaints
    finally:
        home.close()
