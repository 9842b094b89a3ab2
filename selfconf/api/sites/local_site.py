"""A site of one's own on this machine: a process that serves advertisements for as long as it is needed."""

from __future__ import annotations

import os
import secrets
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType

from selfconf import files, rendezvous, this_machine
from selfconf.api.arguments import checked_text
from selfconf.errors import AuthorError, NetworkError, SiteMisusedError
from selfconf.files import STDIN
from selfconf.model.setting_names import setting
from selfconf.module_command import module_command
from selfconf.protocol.keys import checked_name
from selfconf.termination import parent_environment
from selfconf.this_machine import LocalSite

SITE_STARTS = 20.0
"""How long, in seconds, a site may take to listen."""
OWN_SITE_ENDS = 15.0
"""How long, in seconds, a site may take to end with all that it has started; one that hangs is killed then."""
MISUSE = 2
"""The exit code of a program that has said in one sentence why it cannot run."""


class SiteProcess:
    """A site as a process of its own: it listens once the `with` block begins, and is ended with it.

    What the site and the components that it starts print goes to stderr.
    """

    def __init__(
        self,
        paths: Sequence[str | Path],
        ecology: str | None = None,
        connect: Sequence[str] = (),
        keys: Path | None = None,
        reasoning: str = "",
        ontologies: Sequence[Path] = (),
    ) -> None:
        """Raises AuthorError for paths that cannot be watched. `keys` is the folder of keys of an authority.

        `reasoning` is the mode in which it configures the insides of its composites, with some `ontologies`.
        """
        self.paths = [Path(path) for path in paths]
        if STDIN in self.paths:
            ads = setting("ads")
            raise AuthorError(f"a site watches the files of its advertisements, so give files to {ads}, not -")
        if STDIN in map(Path, ontologies):
            ontology = setting("ontology")
            raise AuthorError(
                f"each component that a site starts reads its ontologies, so give files to {ontology}, not -"
            )
        for path in self.paths:
            files.existing(path)
        ecology, self._connect = rendezvous.asked_for(ecology, connect)
        self.ecology = f"run-{secrets.token_hex(3)}" if ecology is None else ecology
        self.name = f"s{secrets.token_hex(3)}"
        self._insides = ["--reasoning", reasoning] if reasoning else []
        self._insides += [part for path in ontologies for part in ("--ontology", str(path))]
        self._keys = _of_authority(rendezvous.keys_folder(keys))
        self._process: subprocess.Popen[bytes] | None = None
        self.endpoint = ""
        """Where it listens."""
        self.exit_code_before_end: int | None = None
        """The exit code of a process that has ended before it was asked to."""

    def __enter__(self) -> SiteProcess:
        """Raises NetworkError if it does not listen in time, SiteMisusedError if it has said why it cannot."""
        where = [part for endpoint in self._connect for part in ("--connect", endpoint)]
        names = ["--ecology", self.ecology, "--name", self.name, *self._insides]
        if self._keys is not None:
            names += ["--keys", str(self._keys)]
        self._process = subprocess.Popen(
            module_command("selfconf", "site", *map(str, self.paths), *names, *where),
            stdin=subprocess.DEVNULL,
            stdout=sys.stderr,
            start_new_session=True,  # Ctrl-C is for the program that owns the site, which ends it in its own time
            env={**os.environ, **parent_environment()},
        )
        try:
            self.endpoint = self._listening(self._process)
        except BaseException:
            self._end()
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._end()

    @property
    def endpoints(self) -> list[str]:
        """Where to connect: to the site itself, and to those that it is connected to."""
        return [self.endpoint, *self._connect]

    def running(self) -> bool:
        """Whether the process runs; once it has ended by itself, `exit_code_before_end` says how."""
        if self._process is not None and self.exit_code_before_end is None:
            self.exit_code_before_end = self._process.poll()
        return self.exit_code_before_end is None

    def _end(self) -> None:
        if self._process is not None:
            self.running()
            self._process.terminate()
            try:
                self._process.wait(OWN_SITE_ENDS)
            except subprocess.TimeoutExpired:  # its components see that it is gone, and end
                self._process.kill()
                self._process.wait()

    def _listening(self, process: subprocess.Popen[bytes]) -> str:
        deadline = time.monotonic() + SITE_STARTS
        while time.monotonic() < deadline:
            for site in this_machine.local_sites(self.ecology):
                if site.site == self.name:
                    return site.endpoint
            try:
                process.wait(0.02)
            except subprocess.TimeoutExpired:
                continue
            if process.returncode == MISUSE:
                raise SiteMisusedError("the site for the advertisements cannot run, and has said why")
            raise NetworkError(f"the site for the advertisements ended with code {process.returncode}")
        raise NetworkError(f"the site for the advertisements does not listen after {SITE_STARTS:.0f} s")


def sites(ecology: str | None = None) -> tuple[LocalSite, ...]:
    """The sites that run on this machine, of one ecology or of all, sorted: name, endpoint and process of each.

    Raises AuthorError for a text that names no ecology, and ProgrammerError for what is no text.

    >>> [site.site for site in sites()]
    ['home']
    """
    if ecology is not None:
        checked_name(checked_text(ecology, "the name of an ecology"), "an ecology")
    return tuple(this_machine.local_sites(ecology))


def _of_authority(keys: Path | None) -> Path | None:
    """A folder of keys by which a site of any name can be started. Raises AuthorError for that of one holder."""
    if keys is None:
        return None
    from selfconf.access import open_keys  # what it needs is an extra

    if not open_keys(keys).is_authority:
        raise AuthorError(
            f"{keys} is not the folder of an authority, by which a site can be started for these files; start one with"
            " `selfconf site`, and leave the files out here"
        )
    return keys
