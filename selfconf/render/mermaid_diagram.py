"""A configuration as a diagram in the language of Mermaid."""

from __future__ import annotations

from selfconf.model.configuration import Configuration
from selfconf.model.wording import one_line
from selfconf.render.text import Name


def mermaid(configuration: Configuration, name: Name) -> str:
    """A configuration as a Mermaid flow chart: a node for each component, an arrow for each connection."""
    nodes = {component: f"c{number}" for number, component in enumerate(configuration.components)}
    lines = ["flowchart LR"]
    for component, node in nodes.items():
        role = configuration.role_of(component)
        part = role.short if role else "recruit"
        lines.append(f'    {node}["{_quoted(name(component))}<br/><i>{_quoted(part)}</i>"]')
    for c in configuration.connections:
        label = _quoted(f"{c.output} → {c.input}")
        lines.append(f'    {nodes[c.source]} -->|"{label}"| {nodes[c.sink]}')
    return "\n".join(lines)


def _quoted(text: str) -> str:
    return one_line(text).replace("&", "&amp;").replace('"', "#quot;").replace("<", "&lt;").replace(">", "&gt;")
