"""What has come of a demo: in a few lines, and as figures."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from sim.account import Account, short
from sim.home.apartment import read_apartment
from sim.peis_home import standing_point

GOAL = "bedroom"


def summary(account: Account) -> Iterator[str]:
    """The run in a few lines: configurations, the gap, where she ended."""
    for word, configuration in zip(("before", "after"), account.around_loss(), strict=False):
        names = [short(component) for role in configuration["roles"] for component in role["components"]]
        yield f"{word + ':':9}{', '.join(names)}"
    gap = account.gap()
    if gap is not None:
        yield f"{'gap:':9}{gap * 1000:.1f} ms from FAIL to the first pose of the new source at the navigator"
        yield f"{'':9}({(account.search() or 0.0) * 1000:.1f} ms of it for composing the new configuration)"
    if account.end is not None:
        error = arrival_error(account)
        touched = ", ".join(account.end["touched"]) or "nothing"
        yield f"{'end:':9}{account.end['outcome']} after {account.end['time']:.1f} simulated seconds"
        yield f"{'':9}{error * 100:.1f} cm from the goal; touched {touched}"


def result(account: Account) -> dict[str, Any]:
    """The run as figures: outcome, error in metres, which source of poses failed and why, gap and search in seconds."""
    assert account.end is not None
    loss = account.loss
    return {
        "outcome": account.end["outcome"],
        "simulated_seconds": account.end["time"],
        "error": arrival_error(account),
        "touched": account.end["touched"],
        "lost": short(loss["component"]) if loss else None,
        "cause": loss["cause"] if loss else None,
        "gap": account.gap(),
        "search": account.search(),
        "configurations": account.configurations,
    }


def arrival_error(account: Account) -> float:
    """How far, in metres, she truly ended from the standing point of the goal."""
    assert account.end is not None
    stand = standing_point(read_apartment(), GOAL)
    return math.hypot(account.end["x"] - stand.x, account.end["y"] - stand.y)
