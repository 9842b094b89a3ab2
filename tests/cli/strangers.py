"""A site of strangers: it says on the bus whatever a test wants it to say, and a trap for what must not be touched."""

from __future__ import annotations

import os
import socket
import threading
from collections.abc import Mapping, Sequence
from pathlib import Path

from selfconf.access import Authority, PrincipalKind, introduce
from selfconf.bus.port import Request
from selfconf.bus.zenoh import Security, router
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Page

GUILTY = 86
WATCH = """
import os
import sys

TALKING = ("socket.connect", "socket.getaddrinfo", "socket.gethostby", "socket.sendto", "urllib.", "http.", "ftplib.")
STARTING = ("subprocess.Popen", "os.system", "os.exec", "os.posix_spawn", "os.spawn", "os.fork", "pty.spawn")


def watch(event, arguments):
    touched = event != "compile" and any("canary" in str(one)[:1000] for one in arguments)
    started = event.startswith(STARTING) and (not arguments or str(arguments[0]) != sys.executable)
    if touched or started or event.startswith(TALKING):
        os.write(2, f"GUILTY: {event} {arguments!r:.300}\\n".encode())
        os._exit(86)


sys.addaudithook(watch)
"""


class Trap:
    """A file and a server that nobody may touch, and a program that ends any Python program that does.

    Python's audit hooks see nothing of what native code does. So the file is a pipe without a writer, on which whoever
    opens it waits forever, and the server counts its visitors.
    """

    def __init__(self, folder: Path) -> None:
        self.file = folder / "canary.ttl"
        os.mkfifo(self.file)
        self._server = socket.create_server(("127.0.0.1", 0))
        self._server.setblocking(False)
        self.web = f"http://127.0.0.1:{self._server.getsockname()[1]}/canary.ttl"
        self.program = folder / "watch"
        self.program.mkdir()
        (self.program / "sitecustomize.py").write_text(WATCH)

    def set(self, text: str) -> str:
        """A text that leads to the trap."""
        return text.replace("FILE", self.file.as_uri()).replace("WEB", self.web).replace("PATH", str(self.file))

    @property
    def visited(self) -> bool:
        """Whether somebody has come to the server."""
        try:
            self._server.accept()
        except BlockingIOError:
            return False
        return True

    def close(self) -> None:
        """Close the server."""
        self._server.close()


class Strangers:
    """A site that advertises what it likes, and a configurator that claims to have deployed what it likes."""

    def __init__(
        self,
        keys: Keys,
        neighbour: str,
        said: Mapping[IRI, bytes],
        extra: Sequence[tuple[bytes, bytes]] = (),
        authority: Authority | None = None,
    ) -> None:
        """With an `authority` the strangers have a certificate of a site: they are insiders that cannot be trusted."""
        self._keys, self._said, self._extra = keys, said, extra
        shown = None if authority is None else authority.credentials((PrincipalKind.SITE,), "strangers")
        if shown is None:
            self._bus = router(connect=[neighbour])
        else:
            self._bus = router("tls/127.0.0.1:0", [neighbour], security=Security(shown))
            introduce(self._bus, keys.ecology, shown)
        self._bus.serve(keys.advertisements("strangers"), self._advertise)
        self._bus.serve(keys.configuration("stranger"), self._configuration)
        self._bus.announce(keys.site_life("strangers", "1"))
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._bus.run, args=(self._over.is_set,))
        self._thread.start()

    def _advertise(self, request: Request) -> None:
        key = self._keys.advertisement
        for index, (component, payload) in enumerate(self._said.items()):
            page = Page(index, len(self._said), 1, component, f"\x1b[2J{index}.ttl", True)
            request.reply(key("strangers", component), payload, encode(page))
        for payload, attachment in self._extra:
            request.reply(key("strangers", IRI("urn:extra")), payload, attachment)
        request.finish()

    def _configuration(self, request: Request) -> None:
        for payload in self._said.values():
            request.reply(self._keys.configuration("stranger"), payload)
        request.finish()

    def close(self) -> None:
        """Leave the ecology."""
        self._over.set()
        self._thread.join()
        self._bus.close()
