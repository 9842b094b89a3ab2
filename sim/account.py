"""What a demo learns while it runs: the configurator's acts, the world's events, the first pose of each source."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import Any

from selfconf.model.term import IRI
from sim.crew import Line


@dataclass
class Account:
    """The lines of all processes taken in, and told as sentences; times are real, in seconds since the start."""

    began: float
    configurations: list[dict[str, Any]] = field(default_factory=list)
    losses: list[dict[str, Any]] = field(default_factory=list)
    first_poses: list[dict[str, Any]] = field(default_factory=list)
    played: list[dict[str, Any]] = field(default_factory=list)
    search_seconds: list[float] = field(default_factory=list)
    end: dict[str, Any] | None = None
    ready: bool = False
    refused: bool = False

    def take(self, line: Line) -> str | None:
        """Take a line in; the sentence that tells it, or None if it is not worth one."""
        if line.text is None:
            return None
        try:
            fact = json.loads(line.text)
        except ValueError:
            fact = None
        if not isinstance(fact, dict):
            return f"          {line.process}: {line.text}" if line.text.strip() else None
        if "act" in fact:
            return self._act(fact)
        return self._event(fact)

    def _act(self, fact: dict[str, Any]) -> str | None:
        act = fact["act"]
        time = f"{fact['time'] - self.began:8.3f} s"
        if act == "query":
            return f"{time}  act 1  asking the ecology what it has"
        if act == "discovered":
            return f"{time}  act 2  {fact['components']} components at the sites {', '.join(fact['sites'])}"
        if act == "composed":
            self.search_seconds.append(fact["seconds"])
            roles = fact["outcome"].get("roles")
            names = ", ".join(short(c) for role in roles for c in role["components"]) if roles else "nothing fits"
            return f"{time}  act 3  {names}  ({fact['seconds'] * 1000:.1f} ms)"
        if act == "connecting":
            ends = f"{short(fact['source'])} {fact['output']} -> {short(fact['sink'])} {fact['input']}"
            return f"{time}  act 4  connecting {ends}"
        if act == "lost":
            self.losses.append(fact)
            return f"{time}  {fact['cause'].upper():5}  {short(fact['component'])}: {fact['detail']}"
        if act == "running":
            self.configurations.append(fact["configuration"])
            return f"{time}         configured, running"
        if act == "refused":
            self.refused = True
            reasons = "; ".join(reason["message"] for reason in fact["refusal"]["reasons"])
            return f"{time}         no configuration: {reasons}"
        words = {
            "watching": "act 4  listening to FAIL of",
            "waking": "act 4  waking",
            "activated": "act 4  active:",
            "set": "act 4  parameters set:",
            "released": "       turned off:",
            "stopped": "       taken down",
        }
        if act in words:
            return f"{time}  {words[act]} {short(fact.get('component', ''))}".rstrip()
        if act in ("activating", "refused", "complaint") and "detail" not in fact:
            return None
        detail = fact.get("detail", "")
        return f"{time}         {short(fact.get('component', ''))} {act}: {detail}"

    def _event(self, fact: dict[str, Any]) -> str | None:
        time = f"{fact['real'] - self.began:8.3f} s"
        event = fact["event"]
        if event == "ready":
            self.ready = True
            return f"{time}         the world is there"
        if event == "first pose":
            self.first_poses.append(fact)
            return f"{time}         the navigator has its first pose from {short(fact['source'])}"
        if event == "progress":
            return f"{time}         simulated {fact['time']:4.1f} s: Astrid drives, {fact['left']:.1f} m from the goal"
        if event == "end":
            self.end = fact
            return f"{time}         {fact['outcome']} after {fact['time']:.1f} simulated seconds"
        self.played.append(fact)
        return f"{time}         {fact['speaker']} {event}"

    def gap(self) -> float | None:
        """Seconds from the first loss that mattered to the first pose of the source that took over."""
        if not self.losses:
            return None
        lost = self.losses[0]
        later = [pose["real"] for pose in self.first_poses if pose["real"] > lost["time"]]
        return later[0] - lost["time"] if later else None


def short(iri: str) -> str:
    """The last segment of an IRI."""
    return IRI(iri).short
