"""A program that a site has started is ended: when told to, when it is frozen, and when the site closes."""

from __future__ import annotations

import json
import os
import signal
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from selfconf import rendezvous
from selfconf.bus.memory import Network
from selfconf.bus.port import Replies
from selfconf.errors import PeerError
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import End, Wake
from selfconf.site import Site, component_program, restart_limit
from selfconf.site.process_group import ProcessGroup
from selfconf.termination import alive
from tests.site.served import KEYS, SLEEPER, ask, live, python, until
from tests.site.started import NUMBERED, fails, program, runs

pytestmark = pytest.mark.process


def test_a_process_that_is_ended_is_not_started_again_but_can_be(
    network: Network, tmp_path: Path, site: Callable[..., Site]
) -> None:
    made = site(python(NUMBERED))
    made.start(SLEEPER)
    assert live(network, lambda: len(runs(tmp_path)) == 1)
    replies: list[Replies] = []
    network.node().ask(KEYS.end("home"), encode(End(SLEEPER)), 5.0, replies.append)
    assert live(network, lambda: bool(replies))
    assert [sample.payload for sample in replies[0].samples] == [b"ended"]
    assert not alive(runs(tmp_path)[0])
    live(network, lambda: len(runs(tmp_path)) > 1, 0.5)
    assert len(runs(tmp_path)) == 1
    made.start(SLEEPER)
    assert live(network, lambda: len(runs(tmp_path)) == 2)


def test_a_process_that_does_not_want_to_end_is_killed_with_all_that_it_started(
    network: Network, tmp_path: Path, site: Callable[..., Site], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(component_program, "TERMINATION", 0.3)
    deaf = "import signal; signal.signal(signal.SIGTERM, signal.SIG_IGN); "
    fork = "import os; os.fork(); "
    made = site(python(deaf + fork + 'open("run-%d" % os.getpid(), "w").write(str(os.getpid()))'))
    made.start(SLEEPER)
    assert live(network, lambda: len(runs(tmp_path)) == 2)
    ended: list[bool] = []
    made.processes.end(SLEEPER, "", lambda: ended.append(True))
    assert live(network, lambda: bool(ended))
    assert not any(map(alive, runs(tmp_path)))


def test_a_process_that_is_told_to_end_may_come_to_rest_before(
    network: Network, tmp_path: Path, site: Callable[..., Site]
) -> None:
    rests = "import signal, time; "
    rests += 'signal.signal(signal.SIGTERM, lambda *_: (time.sleep(0.3), open("rests", "w").close(), exit(0))); '
    made = site(python(rests + NUMBERED))
    made.start(SLEEPER)
    assert live(network, lambda: len(runs(tmp_path)) == 1)
    ended: list[bool] = []
    made.processes.end(SLEEPER, "", lambda: ended.append(True))
    assert live(network, lambda: bool(ended), component_program.TERMINATION)
    assert (tmp_path / "here" / "rests").exists()


def test_what_a_process_leaves_behind_is_looked_at_less_and_less_often(
    network: Network, site: Callable[..., Site], monkeypatch: pytest.MonkeyPatch
) -> None:
    looks: list[bool] = []

    class Counting(ProcessGroup):
        def gone(self) -> bool:
            looks.append(super().gone())
            return looks[-1]

    monkeypatch.setattr(component_program, "ProcessGroup", Counting)
    deaf = "import os, signal; signal.signal(signal.SIGTERM, signal.SIG_IGN)"
    made = site(python(f"{deaf}; os.fork() and os._exit(0); os.setsid()"))
    made.start(SLEEPER)
    assert live(network, lambda: bool(looks) and program(made).group is None)
    assert looks[-1]
    assert len(looks) < 15  # within two seconds


def test_a_frozen_process_is_ended_without_going_on(
    network: Network, tmp_path: Path, site: Callable[..., Site]
) -> None:
    told = 'import signal; signal.signal(signal.SIGTERM, lambda *_: open("acted", "w").close()); '
    made = site(python(told + NUMBERED))
    made.start(SLEEPER)
    assert live(network, lambda: len(runs(tmp_path)) == 1)
    os.kill(runs(tmp_path)[0], signal.SIGSTOP)
    group = program(made).group
    assert group is not None
    assert live(network, group.frozen)
    ended: list[bool] = []
    made.processes.end(SLEEPER, "", lambda: ended.append(True))
    assert live(network, lambda: bool(ended), 1.5)
    assert not (tmp_path / "here" / "acted").exists()


def test_only_the_life_that_the_site_has_started_is_ended(
    network: Network, tmp_path: Path, site: Callable[..., Site]
) -> None:
    made = site(python('import json, os; open("environment", "w").write(json.dumps(dict(os.environ)))'))
    with pytest.raises(PeerError, match="has not started"):
        made.processes.end(SLEEPER)
    made.start(SLEEPER)
    path = tmp_path / "here" / "environment"
    assert live(network, lambda: path.exists() and path.read_text().endswith("}"))
    life = json.loads(path.read_text())[rendezvous.LIFE_VARIABLE]
    network.node().announce(KEYS.life(SLEEPER, life))
    network.node().announce(KEYS.life(SLEEPER, "a-duplicate"))
    network.run(lambda: False, 0.1)
    errors = ask(network, KEYS.end("home"), encode(End(SLEEPER, "a-duplicate"))).errors
    assert "has not started the life a-duplicate" in errors[0]
    ended: list[bool] = []
    made.processes.end(SLEEPER, life, lambda: ended.append(True))
    assert live(network, lambda: bool(ended))


@pytest.mark.parametrize("gone", [False, True])
def test_a_start_while_the_process_ends_comes_after_its_end(
    network: Network, tmp_path: Path, site: Callable[..., Site], gone: bool
) -> None:
    slow = (
        'import os, signal; signal.signal(signal.SIGTERM, lambda *_: open("told", "w").close());'
        "open(str(os.getpid()), 'w').close()"
    ).replace("'", '"')
    made = site(python(slow + "; signal.pause(); " + NUMBERED + "; raise SystemExit(0)"))
    made.start(SLEEPER)
    group = program(made).group
    assert group is not None
    assert live(network, (tmp_path / "here" / str(group.number)).exists)
    made.processes.end(SLEEPER)
    made.start(SLEEPER)
    if gone:  # which the site has not noticed
        os.waitid(os.P_PID, group.number, os.WEXITED | os.WNOWAIT)
    made.processes.end(SLEEPER)  # as another task does that has shared it, and has not heard yet that it ends
    assert program(made).group is group
    assert live(network, lambda: program(made).group not in (None, group))
    assert group.gone()


def test_a_terminal_reaches_the_site_alone(network: Network, tmp_path: Path, site: Callable[..., Site]) -> None:
    made = site(python(NUMBERED))
    made.start(SLEEPER)
    assert live(network, lambda: len(runs(tmp_path)) == 1)
    (process,) = runs(tmp_path)
    assert os.getsid(process) == os.getpgid(process) == process
    made.close()
    assert not alive(process)


def test_what_is_ended_while_it_pauses_is_not_started_again(
    network: Network, tmp_path: Path, site: Callable[..., Site], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(restart_limit, "FIRST_PAUSE", 0.4)
    made, heard, ended = site(python(NUMBERED)), fails(network), list[bool]()
    made.start(SLEEPER)
    assert live(network, lambda: len(runs(tmp_path)) == 1)
    os.kill(runs(tmp_path)[0], signal.SIGKILL)
    assert live(network, lambda: bool(heard) and program(made).group is None)
    made.processes.end(SLEEPER, "", lambda: ended.append(True))
    assert ended
    live(network, lambda: len(runs(tmp_path)) > 1, 1.0)
    assert len(runs(tmp_path)) == 1


def test_nothing_is_started_again_once_the_site_closes_on_another_thread(
    network: Network, tmp_path: Path, site: Callable[..., Site], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(restart_limit, "FIRST_PAUSE", 0.0)
    made = site(python(NUMBERED + "; raise SystemExit(3)"), more="; sc:restarts 1000 ")
    made.start(SLEEPER)
    over = threading.Event()
    bus = threading.Thread(target=live, args=(network, over.is_set))
    bus.start()
    assert until(lambda: len(runs(tmp_path)) > 3)
    made.processes.close()
    started = len(list((tmp_path / "here").glob("run-*")))
    assert not over.wait(0.5)
    over.set()
    bus.join()
    assert len(list((tmp_path / "here").glob("run-*"))) == started
    with pytest.raises(PeerError, match="is ending"):
        made.start(SLEEPER)


def test_a_process_that_is_being_started_as_the_site_closes_has_ended_with_it(
    site: Callable[..., Site], monkeypatch: pytest.MonkeyPatch
) -> None:
    begun, known = threading.Event(), threading.Event()

    class Late(ProcessGroup):
        def __init__(self, *arguments: Any) -> None:
            super().__init__(*arguments)
            begun.set()
            known.wait(10.0)

    monkeypatch.setattr(component_program, "ProcessGroup", Late)
    made = site(python("import time; time.sleep(60)"))
    starting, closing = (threading.Thread(target=do) for do in (lambda: made.start(SLEEPER), made.processes.close))
    starting.start()
    assert begun.wait(10.0)
    closing.start()
    closing.join(0.1)
    closes_late = closing.is_alive()
    known.set()
    starting.join()
    closing.join()
    assert closes_late, "it does not know yet what to end"
    group = program(made).group
    assert group is not None
    assert group.code() is not None


def test_a_site_that_is_ending_replies_nothing_to_what_asks_it_to_start_a_component(
    network: Network, site: Callable[..., Site]
) -> None:
    """As one that has ended: a task that was told that it cannot start it would not wait for a site that is back."""
    site(python("import time; time.sleep(60)")).processes.close()
    heard: list[Replies] = []
    network.node().ask(KEYS.wake("home"), encode(Wake(SLEEPER)), 5.0, heard.append)
    network.run(lambda: bool(heard))
    assert heard == [Replies()]
