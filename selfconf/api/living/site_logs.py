"""The logs in which sites keep what their components print: files on this machine, and what other sites tell.

A log stays after its site has ended: what a component said before it died is in it. The site of another machine can be
asked for its log as long as it lives.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Collection
from functools import partial
from pathlib import Path

from selfconf import this_machine
from selfconf.api.synchronous_bus import SynchronousBus
from selfconf.errors import AuthorError, NetworkError, PeerError
from selfconf.model.setting_names import setting
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import Keys, checked_name, owner_of
from selfconf.protocol.messages import LogPart, LogQuestion
from selfconf.site import log_part

LogSource = Callable[[LogQuestion], LogPart]
"""Answers a question for one log."""


def site_logs(ecology: str | None, folder: Path | None = None) -> list[Path]:
    """The logs of the sites of an ecology on this machine, also of those that have ended, sorted.

    Without a folder they are where the sites that run keep them, or will once a component has printed something, and in
    the folder that is usual. Raises NetworkError, where there is none, and AuthorError where several ecologies have
    logs and none is named, or for what names none.
    """
    if ecology is not None:
        checked_name(ecology, "an ecology")
    running = _logs_of_running_sites(ecology) if folder is None else set()
    folders = {this_machine.log_folder(), *(path.parent for path in running)} if folder is None else {folder}
    found = sorted(running.union(*(one.glob(f"{ecology or '*'}@*.log") for one in folders)))
    if ecology is None:
        found = _of_one_ecology(found)
    if not found:
        which = "" if ecology is None else f" of the ecology {ecology!r}"
        where = ", ".join(map(str, sorted(folders)))
        raise NetworkError(
            f"no site{which} has kept a log in {where}; a site keeps one, on its own host, from the first component on"
            " that it starts"
        )
    return found


def names_of_log(path: Path) -> tuple[str, str]:
    """The ecology and the site of a log."""
    ecology, _, site = path.name.removesuffix(".log").partition("@")
    return ecology, site


def _logs_of_running_sites(ecology: str | None) -> set[Path]:
    return {Path(site.log) for site in this_machine.local_sites(ecology) if site.log}


def _of_one_ecology(logs: list[Path]) -> list[Path]:
    """The logs of the only ecology that has some, or else of the only one of these that lives. Raises AuthorError."""
    named = {names_of_log(path)[0] for path in logs}
    living = named & {site.ecology for site in this_machine.local_sites()}
    chosen = living if len(living) == 1 else named
    if len(chosen) > 1:
        names = ", ".join(sorted(chosen))
        raise AuthorError(f"several ecologies have logs; say which with {setting('ecology')}: {names}")
    return [path for path in logs if names_of_log(path)[0] in chosen]


def local_log(path: Path) -> LogSource:
    """The log of a site of this machine, as a source that answers in full."""
    return lambda question: log_part(path, question, sys.maxsize)


def logs_of_other_sites(
    bus: SynchronousBus, keys: Keys, known: Collection[str], complain: Callable[[str], None], hint: str = ""
) -> dict[str, LogSource]:
    """The logs of the sites that live, but for those that are known, by site, as sources that ask the sites.

    `complain` hears once of each site that does not tell; `hint` is what may be the reason.
    """
    silent = set[str]()

    def told(site: str, question: LogQuestion) -> LogPart:
        """What a site tells of its log; nothing new where it does not answer."""
        trouble: list[str] = []
        try:
            replies = bus.ask(keys.log(site), encode(question))
            trouble += [*replies.errors, *filter(None, [hint])]
            return decode(replies.samples[0].payload, LogPart)
        except IndexError:
            pass
        except (NetworkError, PeerError) as error:
            trouble.append(str(error))
        if site not in silent:
            silent.add(site)
            complain(": ".join((f"the site {site} does not tell what its components have printed", *trouble)))
        return LogPart((), question.position)

    sites = {*map(owner_of, bus.living(keys.any_site_life()))}
    return {site: partial(told, site) for site in sorted(sites - {*known})}
