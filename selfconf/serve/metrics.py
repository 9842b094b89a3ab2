"""What a server counts, in the text format of Prometheus (version 0.0.4)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping

from selfconf.protocol.messages import Cause

PROMETHEUS = "text/plain; version=0.0.4; charset=utf-8"
_ESCAPES = str.maketrans({"\\": r"\\", '"': r"\"", "\n": r"\n"})
CAUSES = frozenset(cause.value for cause in Cause)
"""The causes of a loss that have a count of their own: what a peer makes up has none."""
OTHER = "other"
"""The cause by which all others are counted."""


class Metrics:
    """Counts queries, failures and configurations since the server began."""

    def __init__(self, began: float = 0.0) -> None:
        """`began` is when, in seconds of the Unix epoch: configurators tell their latest events of before, too.

        Were these counted, each start of a server would look like a rush of failures.
        """
        self._began = began
        self._queries: Counter[str] = Counter()
        self._query_seconds = 0.0
        self._losses: Counter[str] = Counter()
        self._acts: Counter[str] = Counter()
        self.changes = 0
        """How often something in the ecology has changed."""

    def queried(self, status: str, seconds: float) -> None:
        """Count a query by the status of its answer."""
        self._queries[status] += 1
        self._query_seconds += seconds

    def happened(self, act: str, cause: str, moment: float) -> None:
        """Count an event of a run, by its time."""
        if moment < self._began:
            return
        self._acts[act] += 1
        if act == "lost":
            self._losses[cause if cause in CAUSES else OTHER] += 1

    def text(self, gauges: Mapping[str, Iterable[tuple[Mapping[str, str], float]]]) -> str:
        """All metrics; `gauges` are those that the server reads off the ecology, each with its labels."""
        lines: list[str] = []
        for name, values in gauges.items():
            lines += _family(name, "gauge", values)
        queries = [({"status": status}, float(count)) for status, count in sorted(self._queries.items())]
        lines += _family("selfconf_queries_total", "counter", queries)
        lines += _family("selfconf_query_seconds_total", "counter", [({}, self._query_seconds)])
        # Every cause has its count from the beginning: to Prometheus growth from nothing is none.
        losses = [({"cause": cause}, float(self._losses[cause])) for cause in (*sorted(CAUSES), OTHER)]
        lines += _family("selfconf_component_losses_total", "counter", losses)
        lines += _family("selfconf_configurations_total", "counter", [({}, float(self._acts["running"]))])
        lines += _family("selfconf_changes_total", "counter", [({}, float(self.changes))])
        return "\n".join(lines) + "\n"


HELP = {
    "selfconf_up": "Whether the server is linked to its ecology.",
    "selfconf_sites": "Sites that live.",
    "selfconf_components": "Advertised components by state.",
    "selfconf_components_held": "Components that a task holds.",
    "selfconf_tasks": "Tasks by phase.",
    "selfconf_subscribers": "Clients that receive events.",
    "selfconf_queries_total": "SPARQL queries by the HTTP status of the answer.",
    "selfconf_query_seconds_total": "Seconds spent on SPARQL queries.",
    "selfconf_component_losses_total": "Components that tasks have lost, by cause.",
    "selfconf_configurations_total": "Configurations that were complete.",
    "selfconf_changes_total": "Changes of the ecology that were seen.",
}
"""What each metric means."""


def _family(name: str, kind: str, values: Iterable[tuple[Mapping[str, str], float]]) -> list[str]:
    lines = [f"# HELP {name} {HELP[name]}", f"# TYPE {name} {kind}"]
    for labels, value in values:
        inside = ",".join(f'{label}="{text.translate(_ESCAPES)}"' for label, text in labels.items())
        lines.append(f"{name}{{{inside}}} {value:.15g}" if inside else f"{name} {value:.15g}")
    return lines
