"""The options of the commands that are a site: its ecology, its name, where it listens, and who may reach it."""

from __future__ import annotations

import argparse

from selfconf.cli.options import add_keys_argument


def add_site_arguments(parser: argparse.ArgumentParser, listen: str, sites: str) -> None:
    """Add the options of a site; `listen` is the help of that option, `sites` the one that says where others listen."""
    parser.add_argument(
        "--ecology", metavar="NAME", help="the ecology that this site is part of (default: $SELFCONF_ECOLOGY)"
    )
    parser.add_argument(
        "--name", metavar="SITE", help="the name of the site (default: that of its certificate, or a random one)"
    )
    parser.add_argument("--listen", metavar="ENDPOINT", help=listen)
    parser.add_argument(
        sites,
        metavar="ENDPOINT",
        action="append",
        default=[],
        help="where other sites listen; repeatable (default: $SELFCONF_CONNECT); sites of the ecology on this machine"
        " are found without it",
    )
    add_keys_argument(parser)
    parser.add_argument(
        "--insecure",
        action="store_true",
        help="listen beyond this host without keys: any program that reaches it may do everything",
    )
