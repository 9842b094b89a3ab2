"""The side of the Things of the W3C's Web of Things: found by their descriptions, reached over HTTP.

`ThingWorld` is the world of the things that some sources describe, and `ThingSettings` how it treats them;
`read_credentials` reads the `ThingCredentials` by which it is let in;
`is_url` tells the sources that are fetched, `host_of` from where, `unreadable_file` why a file describes no thing. It
needs aiohttp, the extra `wot`.
"""

from selfconf.bridging.wot.credentials import ThingCredentials, read_credentials
from selfconf.bridging.wot.thing_sources import host_of, is_url, unreadable_file
from selfconf.bridging.wot.thing_watch import ThingSettings
from selfconf.bridging.wot.thing_world import ThingWorld

__all__ = [
    "ThingCredentials",
    "ThingSettings",
    "ThingWorld",
    "host_of",
    "is_url",
    "read_credentials",
    "unreadable_file",
]
