"""What a demo learns while it runs: the configurator's acts, the world's events, the first pose of each source."""

from __future__ import annotations

import json
import math
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
    eyes: list[str] = field(default_factory=list)
    """The cameras that looked inside of a composite, one after another."""
    played: list[dict[str, Any]] = field(default_factory=list)
    searches: list[dict[str, Any]] = field(default_factory=list)
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
        """Note an act of the configurator; it words itself, and is passed over where it has no words."""
        act = fact["act"]
        if act == "composed":
            self.searches.append(fact)
        elif act == "lost":
            self.losses.append(fact)
        elif act == "running":
            self.configurations.append(fact["configuration"])
        elif act == "refused":
            self.refused = True
            reasons = "; ".join(reason["message"] for reason in fact["refusal"]["reasons"])
            return f"{fact['time'] - self.began:8.3f} s         no configuration: {reasons}"
        # What is no act, and no loss, stands below what the acts say.
        below = "" if fact["message"].startswith(("act ", "LOST ")) else " " * 7
        return f"{fact['time'] - self.began:8.3f} s  {below}{fact['message']}" if fact["message"] else None

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
        if event == "covered":
            return f"{time}         simulated {fact['time']:4.1f} s: a cloth covers the lens of the {fact['name']}"
        if event == "eye":
            self.eyes.append(fact["name"])
            return f"{time}         the {fact['name']} looks"
        self.played.append(fact)
        return f"{time}         {fact['speaker']} {event}"

    @property
    def loss(self) -> dict[str, Any] | None:
        """The loss of a source of poses; a navigator that was ended meanwhile, say, is no part of the experiment."""
        sources = {source for configuration in self.configurations for source in _players(configuration, "position")}
        return next((loss for loss in self.losses if loss["component"] in sources), None)

    def around_loss(self) -> list[dict[str, Any]]:
        """The last configuration with the source that was lost, and the first one without; else the newest alone."""
        if self.loss is None:
            return self.configurations[-1:]
        lost, all_of_them = self.loss["component"], self.configurations
        without = (n for n, found in enumerate(all_of_them) if n > 0 and lost not in _players(found, "position"))
        after = next(without, len(all_of_them))
        return all_of_them[after - 1 : after + 1]

    def gap(self) -> float | None:
        """Seconds from that loss to the first pose of the source that took over."""
        lost = self.loss["time"] if self.loss else math.inf
        return next((pose["real"] - lost for pose in self.first_poses if pose["real"] >= lost), None)

    def search(self) -> float | None:
        """Seconds that the search for the next configuration took."""
        lost = self.loss["time"] if self.loss else math.inf
        return next((search["seconds"] for search in self.searches if search["time"] >= lost), None)


def _players(configuration: dict[str, Any], role: str) -> list[str]:
    """The IRIs of the components that play a role, given by the last segment of its IRI."""
    return [
        player for played in configuration["roles"] if short(played["role"]) == role for player in played["components"]
    ]


def short(iri: str) -> str:
    """The last segment of an IRI."""
    return IRI(iri).short
