"""`bridge`: a site whose components are Things or nodes of ROS 2, which know nothing of selfconf."""

from __future__ import annotations

import argparse
import importlib.util
import re
from pathlib import Path

from selfconf.cli.options import add_ontology_argument, domain, number_option
from selfconf.cli.parsing import add_parser
from selfconf.cli.site_options import add_site_arguments
from selfconf.cli.terminal import complaining_aside
from selfconf.errors import InstallationError

WOT_EXAMPLE = """  selfconf bridge wot examples/imports/lamp.td.json --ecology home
  selfconf bridge wot http://192.0.2.7/things --rate 5 --credentials things.json --ecology home"""
ROS2_EXAMPLE = """  selfconf bridge ros2 --connect tcp/127.0.0.1:7447 --domain 0 --ecology home
  selfconf bridge ros2 --definitions /opt/ros/jazzy/share --definitions ~/ws/install/lab_msgs/share --ecology home"""
EXAMPLE = f"{WOT_EXAMPLE}\n{ROS2_EXAMPLE}"
MOST_HERTZ = 100.0
_HOST = re.compile(r"[\w.-]+|\[?[0-9A-Fa-f.]*:[0-9A-Fa-f.]*:[0-9A-Fa-f.:]*\]?")
LISTENING = "where to listen, as for `selfconf site`"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    worlds = parser.add_subparsers(dest="world", metavar="WORLD", required=True)
    does = "let Things of the W3C Web of Things take part in an ecology, over HTTP"
    wot = add_parser(worlds, "wot", does, WOT_EXAMPLE)
    wot.add_argument(
        "sources",
        metavar="SOURCE",
        nargs="+",
        help="Thing Descriptions: a file, a folder with *.json and *.jsonld below it, or an http or https URL, also of"
        " a directory of Things; read again every 5 seconds",
    )
    wot.add_argument(
        "--rate",
        metavar="HZ",
        type=_rate,
        default=1.0,
        help="how often to read a property that cannot be observed (default: %(default)g)",
    )
    wot.add_argument(
        "--credentials",
        metavar="FILE",
        type=Path,
        help="a JSON file that only you can read, with username and password, token or key for each origin",
    )
    wot.add_argument(
        "--host",
        metavar="HOST",
        type=_host,
        action="append",
        default=[],
        help="a further host to which descriptions may lead that were fetched; repeatable",
    )
    add_ontology_argument(wot)
    add_site_arguments(wot, LISTENING, "--sites")
    does = "let the nodes of a ROS 2 domain take part in an ecology, over rmw_zenoh: jazzy, kilted and lyrical"
    ros2 = add_parser(worlds, "ros2", does, ROS2_EXAMPLE)
    ros2.add_argument(
        "--connect",
        dest="router",  # of ROS 2, and not where a site listens, as `connect` of the project file says
        metavar="ENDPOINT",
        default="tcp/127.0.0.1:7447",
        help="where the router of ROS 2 listens (default: %(default)s)",
    )
    ros2.add_argument(
        "--domain", metavar="N", type=domain, default=0, help="the ROS_DOMAIN_ID of the nodes (default: %(default)s)"
    )
    ros2.add_argument(
        "--definitions",
        metavar="FOLDER",
        type=Path,
        action="append",
        default=[],
        help="a folder with PACKAGE/msg/*.msg, PACKAGE/srv/*.srv and PACKAGE/action/*.action below it, whose fields are"
        " known then, so that services and actions of these types can be called; repeatable (default:"
        " $SELFCONF_ROS_DEFINITIONS, separated by colons, which components read too)",
    )
    add_site_arguments(ros2, LISTENING, "--sites")


def run(given: argparse.Namespace) -> int:
    """Bridge until SIGINT, SIGTERM or SIGHUP; then 0."""
    module, extra = ("rosbags", "ros2") if given.world == "ros2" else ("aiohttp", "wot")
    if importlib.util.find_spec(module) is None:
        raise InstallationError(f"{module} is missing; install the extra `{extra}`")
    from selfconf.api.sites.bridge_program import serve_nodes, serve_things
    from selfconf.api.sites.site_program import SiteOptions

    site = SiteOptions(
        ecology=given.ecology,
        name=given.name,
        listen=given.listen,
        connect=tuple(given.sites),
        keys=given.keys,
        insecure=given.insecure,
        ontologies=tuple(given.ontology) if given.world == "wot" else (),
    )
    with complaining_aside() as complain:
        if given.world == "ros2":
            serve_nodes(given.router, given.domain, given.definitions, site, complain)
        else:
            serve_things(given.sources, given.rate, given.credentials, given.host, site, complain)
    return 0


def _host(text: str) -> str:
    if not _HOST.fullmatch(text):
        raise argparse.ArgumentTypeError(
            f"{text!r} is no host; it takes a name or an address, such as 192.0.2.7, without scheme and port"
        )
    return text.strip("[]")  # as URLs have an address of IPv6


def _rate(text: str) -> float:
    rate = number_option(text)
    if not 0.001 <= rate <= MOST_HERTZ:
        raise argparse.ArgumentTypeError(f"{text!r} is no rate; it takes a number of hertz from 0.001 to 100")
    return rate
