"""`keys`: an authority for an ecology, and the certificates that it issues."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from selfconf.cli.options import add_format_argument, add_keys_argument, number_option
from selfconf.cli.parsing import add_parser
from selfconf.cli.terminal import display, display_json
from selfconf.errors import AuthorError
from selfconf.model.wording import counted, utc_text

if TYPE_CHECKING:
    from selfconf.access import Authority, Certificate, KeysFolder

EXAMPLE = """  selfconf keys init keys                                    # once; the folder stays on this machine
  selfconf site examples/clock --ecology clock --keys keys   # here the folder is all that is needed
  selfconf keys issue site.attic --keys keys --host 192.168.1.7 --out attic-keys   # for another host"""

LONGEST_DAYS = 3650.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    init = _action(actions, "init", "make an authority, in a folder of its own", "keys")
    init.add_argument("folder", metavar="DIR", type=Path, help="the folder to make")
    issued = "conf.alice --keys keys --out alice-keys"
    issue = _action(actions, "issue", "issue a certificate, into a folder for its holder", issued)
    issue.add_argument(
        "holder", metavar="HOLDER", help="site.NAME, conf.NAME (runs tasks), read.NAME (looks on), or a component's IRI"
    )
    issue.add_argument(
        "--out", metavar="DIR", type=Path, required=True, help="the folder to make; give it to the holder"
    )
    issue.add_argument(
        "--host",
        metavar="HOST",
        action="append",
        default=[],
        help="a name or address, besides loopback, under which others reach a site; repeatable",
    )
    _add_days(issue)
    add_keys_argument(issue)
    anew = "issue a holder's certificate anew, for the same key; programs go on meanwhile"
    renew = _action(actions, "renew", anew, "alice-keys --keys keys")
    renew.add_argument("folder", metavar="DIR", type=Path, help="the folder of the holder")
    _add_days(renew)
    add_keys_argument(renew)
    shown = "show the holder of a folder of keys, when its certificate expires, and what is wrong with it"
    show = _action(actions, "show", shown, "alice-keys")
    show.add_argument("folder", metavar="DIR", type=Path, help="a folder of keys")
    add_format_argument(show)
    revoked = "close a name to every program, until its certificates have expired"
    revoke = _action(actions, "revoke", revoked, "conf.alice --keys keys")
    revoke.add_argument("holder", metavar="HOLDER", help="as for `issue`")
    add_keys_argument(revoke)


def _action(
    actions: argparse._SubParsersAction[argparse.ArgumentParser], name: str, does: str, example: str
) -> argparse.ArgumentParser:
    return add_parser(actions, name, does, f"  selfconf keys {name} {example}")


def _add_days(parser: argparse.ArgumentParser) -> None:
    # The default is `selfconf.access.DAYS`, which is not loaded to parse arguments; a test compares them.
    parser.add_argument(
        "--days", metavar="N", type=_days, default=7.0, help="for how many days it is good (default: %(default)g)"
    )


def _days(text: str) -> float:
    days = number_option(text)
    if not 0 < days <= LONGEST_DAYS:
        raise argparse.ArgumentTypeError(f"{text!r} is no number of days above zero, and at most {LONGEST_DAYS:g}")
    return days


def run(given: argparse.Namespace) -> int:
    """Do what is asked; 1 if `show` finds something wrong."""
    return {"init": _init, "issue": _issue, "renew": _renew, "show": _show, "revoke": _revoke}[given.action](given)


def _init(given: argparse.Namespace) -> int:
    from selfconf.access import Authority

    Authority.init(given.folder)
    display(f"made an authority in {given.folder}; this folder permits everything, so keep it to yourself")
    return 0


def _issue(given: argparse.Namespace) -> int:
    from selfconf.access import Principal

    certificate = _authority(given).issue(Principal.written(given.holder), given.out, given.host, given.days)
    until = utc_text(certificate.ends)
    display(f"{given.out} speaks for {certificate.common_name}, until {until}; give it to its holder")
    return 0


def _renew(given: argparse.Namespace) -> int:
    certificate = _authority(given).renew(given.folder, given.days)
    display(f"{given.folder} speaks for {certificate.common_name}, until {utc_text(certificate.ends)}")
    return 0


def _revoke(given: argparse.Namespace) -> int:
    from selfconf.access import Principal

    authority, principal = _authority(given), Principal.written(given.holder)
    number = authority.revoke(principal)
    display(f"revoked {counted(number, 'certificate')} of {principal}")
    if authority.aware():
        display("the folders of keys that were issued on this machine, and are where they were, know it")
    display(f"copy {authority.path / 'revoked.pem'} into the folder of keys of every site on another machine")
    for site, folder in authority.unaware():
        where = "" if folder is None else f", which is not in {folder} any more, or cannot be written"
        display(f"copy it into the folder of {site} too{where}")
    return 0


def _show(given: argparse.Namespace) -> int:
    from selfconf.access import Authority, open_keys

    folder = open_keys(given.folder)
    shown = [
        _described(one, folder) for one in (folder.issued() if isinstance(folder, Authority) else [folder.pair()[0]])
    ]
    if given.format == "json":
        display_json({"authority": folder.is_authority, "certificates": shown})
    else:
        display(f"{given.folder}: {'an authority' if folder.is_authority else 'keys of a holder'}")
        for one in shown:
            display(f"  {one['name']:<24} until {one['ends']}  {one['fault'] or 'good'}")
    return 1 if not folder.is_authority and shown[0]["fault"] else 0


def _described(certificate: Certificate, folder: KeysFolder) -> dict[str, Any]:
    revoked = certificate.serial in folder.revoked()
    return {
        "name": certificate.common_name,
        "serial": f"{certificate.serial:x}",
        "begins": utc_text(certificate.begins),
        "ends": utc_text(certificate.ends),
        "hosts": list(certificate.hosts),
        "fault": "was revoked" if revoked else certificate.fault(folder.believed_authorities()),
    }


def _authority(given: argparse.Namespace) -> Authority:
    from selfconf import rendezvous
    from selfconf.access import Authority

    folder = rendezvous.keys_folder(given.keys)
    if folder is None:
        raise AuthorError("which authority? give its folder: --keys DIR; `selfconf keys init DIR` makes one")
    return Authority(folder)
