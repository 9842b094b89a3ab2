"""Chromium without a display, driven by its DevTools protocol over a pipe: no package is needed but the browser.

What would leave this machine passes a proxy that answers nothing, and notes whom it was asked for: `Chromium.outside`.
"""

from __future__ import annotations

import base64
import itertools
import json
import os
import select
import shutil
import socket
import subprocess
import threading
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

CHROMIUM = os.environ.get("SELFCONF_CHROMIUM") or shutil.which("chromium") or shutil.which("chromium-browser")
PATIENCE = 60.0
"""Seconds that anything may take, on a busy machine."""
ENDING = 10.0
"""Seconds that the browser may take to end."""
OPTIONS = (
    "--headless=new",
    "--no-sandbox",  # it asks for rights that a container does not have, and the page is our own
    "--disable-dev-shm-usage",
    "--disable-gpu",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-default-apps",
    "--disable-extensions",
    "--disable-sync",
    "--no-first-run",
    "--no-default-browser-check",
    "--remote-debugging-pipe",
)
KEYS = {"Enter": 13, "Tab": 9, "Escape": 27, "/": 191}
"""The virtual codes of the keys that are not letters."""
FIND = """(css, text) => [...document.querySelectorAll(css)].find((one) =>
  (one.getAttribute("aria-label") === text || [one, ...one.children].some((each) => each.textContent.trim() === text))
  && one.checkVisibility())"""


class Chromium:
    """A browser with one page at a time, which is that of an address."""

    def __init__(self, folder: Path) -> None:
        """`folder` is for what the browser itself keeps."""
        self._numbers = itertools.count(1)
        self._events: list[dict[str, Any]] = []
        self._unread = b""
        self.outside: list[str] = []
        """Whom the proxy was asked for, by the first lines of the requests."""
        self._proxy = socket.create_server(("127.0.0.1", 0))
        threading.Thread(target=self._refuse, daemon=True).start()
        theirs_in, self._to = os.pipe()
        self._from, theirs_out = os.pipe()
        assert CHROMIUM is not None
        proxy = f"--proxy-server=127.0.0.1:{self._proxy.getsockname()[1]}"
        # The protocol wants its pipe at the descriptors 3 and 4, where a shell puts it; theirs are above these two.
        command = f'exec "$0" "$@" 3<&{theirs_in} 4>&{theirs_out}'
        self._process = subprocess.Popen(
            ["bash", "-c", command, CHROMIUM, *OPTIONS, proxy, f"--user-data-dir={folder}"],
            pass_fds=[theirs_in, theirs_out],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(theirs_in)
        os.close(theirs_out)

    def close(self) -> None:
        """End the browser, by its own means if it can: its other processes write into its folder until they know."""
        with suppress(OSError, AssertionError):
            self.call("Browser.close", {})
        try:
            self._process.wait(ENDING)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        os.close(self._to)
        os.close(self._from)
        self._proxy.close()

    def page(self, url: str, width: int = 1280, height: int = 800, dark: bool = False) -> Page:
        """A page of that size in which an address is loaded."""
        target = self.call("Target.createTarget", {"url": "about:blank"})["targetId"]
        session = self.call("Target.attachToTarget", {"targetId": target, "flatten": True})["sessionId"]
        page = Page(self, target, session, url)
        page.resize(width, height, dark)
        page.open(url)
        return page

    def call(self, method: str, parameters: dict[str, Any], session: str = "") -> dict[str, Any]:
        """Call a method of the protocol, and return its result."""
        number = next(self._numbers)
        message = {"id": number, "method": method, "params": parameters, **({"sessionId": session} if session else {})}
        os.write(self._to, json.dumps(message).encode() + b"\0")
        deadline = time.monotonic() + PATIENCE
        while True:
            answer = self._read(deadline)
            if answer.get("id") == number:
                assert "error" not in answer, (method, answer["error"])
                result: dict[str, Any] = answer["result"]
                return result
            if "method" in answer:
                self._events.append(answer)

    def events(self, session: str) -> list[dict[str, Any]]:
        """What has happened in a page since the last look."""
        found = [event for event in self._events if event.get("sessionId") == session]
        self._events = [event for event in self._events if event.get("sessionId") != session]
        return found

    def _read(self, deadline: float) -> dict[str, Any]:
        while b"\0" not in self._unread:
            ready, _, _ = select.select([self._from], [], [], max(0.0, deadline - time.monotonic()))
            more = os.read(self._from, 1 << 20) if ready else b""
            assert more, f"the browser does not answer; it has {'ended' if self._process.poll() else 'no time'}"
            self._unread += more
        text, _, self._unread = self._unread.partition(b"\0")
        message: dict[str, Any] = json.loads(text)
        return message

    def _refuse(self) -> None:
        while True:
            try:
                line, _ = self._proxy.accept()
            except OSError:
                return
            with line:
                self.outside.append(line.recv(200).partition(b"\r\n")[0].decode("latin-1"))


class Page:
    """A page in a browser, used as a person would, and what has gone wrong in it."""

    def __init__(self, browser: Chromium, target: str, session: str, url: str) -> None:
        self._browser, self._target, self._session, self._url = browser, target, session, url
        self.trouble: list[str] = []
        """Errors of its scripts, what was not loaded, and requests to anybody but the server of the page."""
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")
        self.call("Emulation.setFocusEmulationEnabled", enabled=True)

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Call a method of the protocol for this page."""
        result = self._browser.call(method, parameters, self._session)
        for event in self._browser.events(self._session):
            self._note(event["method"], event["params"])
        return result

    def _note(self, happened: str, facts: dict[str, Any]) -> None:
        if happened == "Runtime.exceptionThrown":
            self.trouble.append(json.dumps(facts["exceptionDetails"]))
        if happened == "Runtime.consoleAPICalled" and facts["type"] == "error":
            self.trouble.append(json.dumps(facts["args"]))
        if happened == "Log.entryAdded" and facts["entry"]["level"] == "error" and "400" not in facts["entry"]["text"]:
            self.trouble.append(facts["entry"]["text"])  # a query that is refused is what a test may ask for
        if happened == "Network.requestWillBeSent" and not facts["request"]["url"].startswith((self._url, "data:")):
            self.trouble.append(facts["request"]["url"])

    def open(self, url: str) -> None:
        """Go to an address, and wait until that is loaded."""
        self.call("Page.navigate", url=url)
        self.until(f"document.readyState === 'complete' && location.href.startsWith({json.dumps(url)})")

    def close(self) -> None:
        """Close the page."""
        self._browser.call("Target.closeTarget", {"targetId": self._target})

    def resize(self, width: int, height: int, dark: bool) -> None:
        """Let the window have that size, and its user like it light or dark."""
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.call("Emulation.setEmulatedMedia", features=[scheme])

    def value(self, expression: str) -> Any:
        """The value of an expression of JavaScript; of a promise, what it comes to."""
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in result, (expression, result["exceptionDetails"])
        return result["result"].get("value")

    def until(self, expression: str, seconds: float = PATIENCE) -> Any:
        """Wait until an expression is true, and return its value."""
        deadline = time.monotonic() + seconds
        while not (value := self.value(expression)):
            assert time.monotonic() < deadline, f"not in {seconds:g} s: {expression}\n{self.text('body')}"
            threading.Event().wait(0.01)  # a page does not tell when an expression becomes true
        return value

    def text(self, css: str) -> str:
        """The text of an element as it is seen; empty if there is none."""
        return str(self.value(f"document.querySelector({json.dumps(css)})?.innerText ?? ''"))

    def says(self, css: str, text: str) -> None:
        """Wait until an element holds a text."""
        self.until(f"(document.querySelector({json.dumps(css)})?.textContent ?? '').includes({json.dumps(text)})")

    def click(self, text: str, css: str = "button") -> None:
        """Click where the element with that text or label is, once there is one."""
        found = f"({FIND})({json.dumps(css)}, {json.dumps(text)})"
        self.until(f"Boolean({found})")
        place = self.value(
            f"(() => {{ const one = {found}; one.scrollIntoView({{ block: 'center' }});"
            " const box = one.getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]; })()"
        )
        for kind in ("mousePressed", "mouseReleased"):
            self.call("Input.dispatchMouseEvent", type=kind, x=place[0], y=place[1], button="left", clickCount=1)

    def press(self, key: str, control: bool = False) -> None:
        """Press a key."""
        said = {} if control else {"text": "\r" if key == "Enter" else key} if len(key) == 1 or key == "Enter" else {}
        code = KEYS.get(key) or ord(key.upper())
        facts = {"key": key, "windowsVirtualKeyCode": code, "modifiers": 2 if control else 0}
        self.call("Input.dispatchKeyEvent", type="keyDown", **facts, **said)
        self.call("Input.dispatchKeyEvent", type="keyUp", **facts)

    def write(self, text: str) -> None:
        """Write a text where the focus is."""
        self.call("Input.insertText", text=text)

    def picture(self) -> bytes:
        """What is seen, as PNG."""
        return base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])
