"""The options of a site are the same for each command that is one, but for the name of that of the other sites."""

from __future__ import annotations

import argparse

import pytest

from selfconf.cli.site_options import add_site_arguments


@pytest.mark.parametrize("sites", ["--connect", "--sites"])
def test_a_command_that_is_a_site_has_its_options(sites: str) -> None:
    parser = argparse.ArgumentParser()
    add_site_arguments(parser, "where to listen", sites)
    given = parser.parse_args(["--name", "attic", sites, "tcp/a:1", sites, "tcp/b:2", "--insecure"])
    assert (given.ecology, given.name, given.listen, given.insecure) == (None, "attic", None, True)
    assert getattr(given, sites.removeprefix("--")) == ["tcp/a:1", "tcp/b:2"]
