"""What was measured, as a page of Markdown: tables, and what of the goals is met."""

from __future__ import annotations

from collections.abc import Mapping

from benchmarks.machine import described, table
from benchmarks.scale.engines import Found

LOAD, RDFLIB, REST = 2.0, 30.0, 0.02
"""The goals: load over parsing at most, rdflib over load at least, the rest over load at most."""
CROWD = 0.05
"""What of the search time cannot be told from none."""
HEAD = (
    "components", "load / parse", "partition ms", "search ms", "refusal ms", "those / load", "octets each",
    "Oxigraph store / load", "octets each", "rdflib parse / load", "rdflib parse + read / load", "octets each",
)  # fmt: skip
FORMS = {
    "alike": "as above",
    "labelled": "each with a label, a comment and a serial number of its own",
    "files": "as above, each in a file of its own",
    "linked": "as the first, with named ports that are described in statements of their own",
    "topical": "as the first, with port names of its own robot (`/robot7/out0`), and a rate for each output",
    "unlike": "each with types, signals, modes and places that no other has",
}


def cells(size: int, own: Found, store: Found | None, graph: Found | None) -> list[str]:
    """One size, by every engine."""
    load = own["load"]
    return [
        f"{size:,}",
        f"{load / own['parse']:.2f}",
        *(f"{1000 * own[part]:.1f}" for part in ("partition", "search", "refusal")),
        f"{100 * share(own):.1f} %",
        f"{own['bytes']:,.0f}",
        *((f"{store['load'] / load:.1f}", f"{store['bytes'] / size:,.0f}") if store else ("", "")),
        *((f"{graph['load'] / load:.0f}", f"{(graph['load'] + graph['read']) / load:.0f}") if graph else ("", "")),
        f"{graph['bytes']:,.0f}" if graph else "",
    ]


def share(own: Found) -> float:
    """What partition, search and refusal take of the load."""
    return (own["partition"] + own["search"] + own["refusal"]) / own["load"]


def judged(rows: Mapping[int, tuple[Found, Found | None, Found | None]], crowded: Found) -> list[str]:
    """Each goal, what was measured, and whether it is met."""
    found = {size: own["load"] / own["parse"] for size, (own, _, _) in rows.items()}
    worst = max(found.values())
    load = f"Load takes at most {LOAD:g} times as long as bare iteration over the parser"
    lines = [f"{load}: {worst:.2f} at worst, {verdict(worst <= LOAD)}."]
    size = min(max(rows), 100_000)
    own, _, graph = rows[size]
    if graph:
        times = graph["load"] / own["load"]
        lines.append(
            f"Load is {RDFLIB:g} times as quick as rdflib at {size:,}: {times:.0f} times as quick as its parsing "
            f"alone, {(graph['load'] + graph['read']) / own['load']:.0f} with reading the profiles from its graph, "
            f"{verdict(times >= RDFLIB)}."
        )
    lines.append(
        f"Partition, search and refusal together take less than {100 * REST:g} % of the load at {size:,}: "
        f"{100 * share(own):.2f} %, {verdict(share(own) < REST)} "
        f"({100 * share(own) * own['load'] / own['parse']:.1f} % of bare iteration)."
    )
    more = crowded["in the crowd"] / crowded["alone"] - 1
    lines.append(
        f"{crowded['unwanted']:,.0f} components that no role wants change the search time by nothing to be measured: "
        f"{1e6 * crowded['alone']:.0f} us without them, {1e6 * crowded['in the crowd']:.0f} us with them, "
        f"{verdict(more < CROWD)}."
    )
    return lines


def verdict(met: bool) -> str:
    """Whether a goal is met."""
    return "met" if met else "**missed**"


def page(
    rows: Mapping[int, tuple[Found, Found | None, Found | None]],
    forms: Mapping[str, Found],
    styles: Mapping[str, Found],
    form_size: int,
    crowded: Found,
) -> str:
    """The whole page."""
    formed = [
        [FORMS[form], f"{found['load'] / found['parse']:.2f}", f"{found['bytes']:,.0f}"]
        for form, found in forms.items()
    ]
    written = [
        [style, f"{found['load'] / found['parse']:.2f}", f"{found['bytes']:,.0f}"] for style, found in styles.items()
    ]
    slow = [style for style, found in styles.items() if found["load"] > LOAD * found["parse"]]
    slower = f" Beyond {LOAD:g} times the parsing: {'; '.join(slow)}." if slow else ""
    worst = [FORMS[form] for form, found in forms.items() if found["load"] > LOAD * found["parse"]]
    beyond = f" Beyond {LOAD:g} times the parsing: {'; '.join(worst)}." if worst else ""
    goals = "\n".join(f"* {line}" for line in judged(rows, crowded))
    return f"""# Many advertisements

<!-- Made by `python -m benchmarks.scale --full --write`. -->

`configure` over generated ecologies in one Turtle file: components of 200 kinds, each with ports, a parameter,
properties and a preference; the paper's template of five roles wants five of the kinds, on one of five robots.
Figures are ratios, except for parts of milliseconds, and processor time in one process, the least of some trials.

{goals}

## By size

*Parse* is bare iteration over Oxigraph's parser on the same bytes, nothing kept; *load* is from the files to
advertisements that can be partitioned, as `configure --ads` reads them; *partition* F1 ... F5; *search* the first
configuration; *refusal* the same once the robot has lost its drives, with all that `configure` tells then: reasons,
near misses, repairs, and whether subclass mode would do (it reads the ontologies for that). Nobody has looked at the
advertisements before they are partitioned. Beside it a bulk load into an Oxigraph store in memory, which parses in
several threads; rdflib's parsing into a graph; and that with reading the same profiles from the graph. Octets are what
the process grew by at its peak, for each advertisement. A few milliseconds of a refusal do not depend on the ecology.

{table(HEAD, [cells(size, *row) for size, row in rows.items()])}

## By what recurs

Load parses each piece of text once, however many components say it, and pieces that differ in strings and digits alone
once for all of them. So it depends on how much components have in common; {form_size:,} components.{beyond}

{table(("advertisements", "load / parse", "octets each"), formed)}

## By what wrote the file

The same {form_size:,} components as programs write them; the goal is {LOAD:g} times the parsing for each.{slower}

{table(("written by", "load / parse", "octets each"), written)}

{described("pyoxigraph", "rdflib")}
"""
