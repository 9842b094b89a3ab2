"""The bus over Zenoh: nothing else of selfconf imports Zenoh.

* `client` opens the `ZenohBus` of a program, `router` that of a site with its `Hub`, which keeps the rules and the
  certificate of a `Security`. `cut_connections` ends what is left of the connections to an endpoint,
  and `listens` says whether one is taken there.
* `open_session` opens a bare session; `ANYWHERE_ON_LOOPBACK` is the endpoint of a hub that takes any free port, and
  `with_port` puts a free port in place of port 0; `GREETING` is how long a silent end is waited for;
  `check_endpoint` refuses what is no endpoint, before anything is opened.
* `hear_refusals` reads in Zenoh's log what the hub of this process refuses, and keeps it as a `RefusalLog`, of each key
  `LONGEST_KEY` characters; `includes` says whether a key is one of those that were granted.
"""

from selfconf.bus.zenoh.bus import ZenohBus
from selfconf.bus.zenoh.key_inclusion import includes
from selfconf.bus.zenoh.opening import client, listens, router
from selfconf.bus.zenoh.refusals import LONGEST_KEY, RefusalLog, hear_refusals
from selfconf.bus.zenoh.relay import Hub, cut_connections
from selfconf.bus.zenoh.session import (
    ANYWHERE_ON_LOOPBACK,
    GREETING,
    Security,
    check_endpoint,
    open_session,
    with_port,
)

__all__ = [
    "ANYWHERE_ON_LOOPBACK",
    "GREETING",
    "LONGEST_KEY",
    "Hub",
    "RefusalLog",
    "Security",
    "ZenohBus",
    "check_endpoint",
    "client",
    "cut_connections",
    "hear_refusals",
    "includes",
    "listens",
    "open_session",
    "router",
    "with_port",
]
