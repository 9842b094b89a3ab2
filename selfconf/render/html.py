"""Answers as HTML for notebooks: tables, and a configuration as a diagram that needs no script.

What is shown may come from the network, so every text is escaped.
"""

from __future__ import annotations

import html
from collections.abc import Mapping, Sequence

from selfconf.model.configuration import Configuration
from selfconf.model.term import IRI
from selfconf.model.wording import plain
from selfconf.render.text import Name

COLUMN, ROW, WIDTH, HEIGHT = 260, 64, 190, 44
"""Pixels: from one column of nodes to the next, from one row to the next, and the size of a node."""
CHARACTERS = 26
"""How many characters of a name a node has room for."""


def html_table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table."""
    cells = "".join(f"<th style='text-align:left'>{_shown(cell)}</th>" for cell in head)
    body = "".join(
        "<tr>" + "".join(f"<td style='text-align:left'>{_shown(cell)}</td>" for cell in row) + "</tr>" for row in rows
    )
    return f"<table><thead><tr>{cells}</tr></thead><tbody>{body}</tbody></table>"


def html_text(text: str) -> str:
    """Plain text as it is, in a fixed-width font."""
    return f"<pre>{_shown(text)}</pre>"


def diagram(configuration: Configuration, name: Name) -> str:
    """A configuration as SVG: a node for each component, in columns from sources to sinks, an arrow for each pair."""
    columns = _columns(configuration)
    place: dict[IRI, tuple[int, int]] = {}
    for column in range(max(columns.values(), default=0) + 1):
        for row, component in enumerate(c for c in configuration.components if columns[c] == column):
            place[component] = 10 + column * COLUMN, 10 + row * ROW
    width = max((x for x, _ in place.values()), default=0) + WIDTH + 10
    height = max((y for _, y in place.values()), default=0) + HEIGHT + 10
    arrows = "".join(_arrow(place[source], place[sink], labels) for (source, sink), labels in _pairs(configuration))
    nodes = "".join(_node(configuration, component, *place[component], name) for component in place)
    return (
        f"<svg xmlns='http://www.w3.org/2000/svg' width='{width}' height='{height}' viewBox='0 0 {width} {height}' "
        "font-family='sans-serif' font-size='12'><defs><marker id='selfconf-arrow' viewBox='0 0 8 8' refX='8' refY='4' "
        "markerWidth='8' markerHeight='8' orient='auto'><path d='M0 0L8 4L0 8z' fill='#64748b'/></marker></defs>"
        f"{arrows}{nodes}</svg>"
    )


def _columns(configuration: Configuration) -> dict[IRI, int]:
    """For each component the length of the longest way to it from a source; a loop is cut where it closes."""
    column = dict.fromkeys(configuration.components, 0)
    for _ in configuration.components:
        for connection in configuration.connections:
            wanted = column[connection.source] + 1
            if connection.source != connection.sink and column[connection.sink] < wanted < len(column):
                column[connection.sink] = wanted
    used = {number: place for place, number in enumerate(sorted(set(column.values())))}
    return {component: used[number] for component, number in column.items()}


def _pairs(configuration: Configuration) -> list[tuple[tuple[IRI, IRI], list[str]]]:
    pairs: dict[tuple[IRI, IRI], list[str]] = {}
    for c in configuration.connections:
        pairs.setdefault((c.source, c.sink), []).append(f"{c.output} → {c.input}")
    return list(pairs.items())


def _arrow(source: tuple[int, int], sink: tuple[int, int], labels: Sequence[str]) -> str:
    x1, y1, x2, y2 = source[0] + WIDTH, source[1] + HEIGHT // 2, sink[0], sink[1] + HEIGHT // 2
    title = _shown("\n".join(labels))
    path = f"M{x1} {y1}C{x1 + 40} {y1} {x2 - 40} {y2} {x2} {y2}"
    return (
        f"<path d='{path}' fill='none' stroke='#64748b' marker-end='url(#selfconf-arrow)'><title>{title}</title></path>"
    )


def _node(configuration: Configuration, component: IRI, x: int, y: int, name: Name) -> str:
    role = configuration.role_of(component)
    shown = name(component)
    shown = shown if len(shown) <= CHARACTERS else f"{shown[: CHARACTERS - 1]}…"
    part = "recruit" if role is None else role.short
    below = f"<tspan x='{x + 10}' dy='15' fill='#64748b'>{_shown(part)}</tspan>"
    return (
        f"<g><title>{_shown(component)}</title><rect x='{x}' y='{y}' width='{WIDTH}' height='{HEIGHT}' rx='8' "
        f"fill='#eff6ff' stroke='#3b82f6'/><text x='{x + 10}' y='{y + 19}' fill='#0f172a'>{_shown(shown)}{below}</text>"
        "</g>"
    )


def html_sections(sections: Mapping[str, str]) -> str:
    """Parts of a page, each under its heading; the parts are HTML already."""
    return "".join(f"<h4>{_shown(heading)}</h4>{part}" for heading, part in sections.items())


def _shown(text: str) -> str:
    """A text as HTML that shows it, and in which nothing turns the direction of writing around."""
    return html.escape(plain(text))
