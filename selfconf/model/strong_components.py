"""Strongly connected components of a graph (Tarjan 1972), without recursion: what lies in circles together."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Mapping
from typing import TypeVar

Vertex = TypeVar("Vertex", bound=Hashable)


def strong_components(edges: Mapping[Vertex, Iterable[Vertex]]) -> dict[Vertex, Vertex]:
    """Return the strongly connected component of each node, named by one of its nodes; takes linear time."""
    order: dict[Vertex, int] = {}
    low: dict[Vertex, int] = {}
    group: dict[Vertex, Vertex] = {}
    stack: list[Vertex] = []
    for root in edges:
        work = [(root, iter(edges[root]))] if root not in order else []
        if work:
            order[root] = low[root] = len(order)
            stack.append(root)
        while work:
            node, others = work[-1]
            for other in others:
                if other not in order:
                    order[other] = low[other] = len(order)
                    stack.append(other)
                    work.append((other, iter(edges.get(other, ()))))
                    break
                if other not in group:
                    low[node] = min(low[node], order[other])
            else:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[node])
                if low[node] == order[node]:
                    while True:
                        member = stack.pop()
                        group[member] = node
                        if member == node:
                            break
    return group
