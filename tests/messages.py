"""What a process that runs tests says to the one that has started it, where pytest-xdist runs them in several.

It would say of each test that it begins and ends, and how each of its three phases went: six messages, which for most
tests take longer than the test. That a phase before or after a test went well is news only where its duration is asked
for, and that a test begins where each is named.
"""

from __future__ import annotations

from typing import Any

import pytest

_MARKS = frozenset(("logstart", "logfinish"))


def keep_short(config: pytest.Config) -> None:
    """Let this process say how a test went, and of what goes before and after it only what is no success."""
    if config.get_verbosity() > 0 or config.option.durations is not None:
        return
    for plugin in config.pluginmanager.get_plugins():
        send = getattr(plugin, "sendevent", None)
        if send is not None:
            plugin.sendevent = lambda name, send=send, **facts: None if _is_idle(name, facts) else send(name, **facts)


def _is_idle(name: str, facts: dict[str, Any]) -> bool:
    if name in _MARKS:
        return True
    return name == "testreport" and facts["data"]["when"] != "call" and facts["data"]["outcome"] == "passed"
