"""A bridge as a program: a site whose components are foreign."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from selfconf import files
from selfconf.api.arguments import checked_path
from selfconf.api.sites.site_program import SiteOptions, serve
from selfconf.api.sites.temporary_folder import temporary_folder
from selfconf.bridging import Bridge, ForeignWorld
from selfconf.model.immutable import replace


def serve_bridge(
    open_world: Callable[[Bridge], ForeignWorld], site: SiteOptions, complain: Callable[[str], None]
) -> None:
    """Bridge a world to an ecology until SIGINT, SIGTERM or SIGHUP. Raises AuthorError and NetworkError.

    `site` is what the site of the bridge begins with, but for what it serves.
    """
    with temporary_folder("selfconf-bridge-") as folder:
        bridge = Bridge(folder, complain, site.ontologies)
        options = replace(site, paths=(folder,))
        serve(options, complain, lambda ecology, session: bridge.living(open_world, ecology, session))


def serve_things(
    sources: Sequence[str],
    rate: float,
    credentials: Path | None,
    hosts: Sequence[str],
    site: SiteOptions,
    complain: Callable[[str], None],
) -> None:
    """Bridge the things that some files, folders and URLs describe. Raises AuthorError and NetworkError.

    Sources are read again and again, so that things come and go; but files of which none can be read now are a mistake.

    `rate` is how often a property is read that cannot be followed, in hertz; `credentials` is the file with the
    secrets of origins; `hosts` are those to which fetched descriptions may lead besides the hosts of the sources. The
    ontologies of the `site` say of which fields signals consist, besides those of selfconf.
    """
    from selfconf.bridging.wot import (
        ThingCredentials,
        ThingSettings,
        ThingWorld,
        host_of,
        is_url,
        read_credentials,
        unreadable_file,
    )

    for source in sources:
        if is_url(source):
            host_of(source)
        else:
            files.existing(checked_path(source))
    wrong = [unreadable_file(source) for source in sources]
    if wrong[0] is not None and all(wrong):
        raise wrong[0]
    told = ThingCredentials() if credentials is None else read_credentials(credentials)
    settings = ThingSettings(rate, told, frozenset(hosts), site.ontologies)
    serve_bridge(partial(ThingWorld, sources, settings), site, complain)


def serve_nodes(
    endpoint: str, domain: int, definitions: Sequence[Path], site: SiteOptions, complain: Callable[[str], None]
) -> None:
    """Bridge the nodes of a ROS 2 domain, whose router listens at an endpoint. Raises AuthorError and NetworkError.

    `definitions` are folders with definitions of interfaces, in addition to the types that are known; without them
    those are that the environment names.
    """
    from selfconf import ros2
    from selfconf.bridging.ros2 import RosWorld
    from selfconf.bus.zenoh import check_endpoint, client

    check_endpoint(endpoint)  # before the site of the bridge begins
    for left_out in ros2.learn(definitions or ros2.named_folders()):
        complain(str(left_out))
    connect = partial(client, [endpoint], wanted="router of ROS 2")
    serve_bridge(partial(RosWorld, connect, domain), site, complain)
