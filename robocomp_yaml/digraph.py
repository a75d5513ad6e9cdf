"""Walks of directed graphs: what is reached, an order that has inner ones first, and circles.

No walk recurses, for chains may be long.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from graphlib import CycleError, TopologicalSorter
from typing import TypeVar

Node = TypeVar("Node", bound=Hashable)


def reachable(starts: Iterable[Node], following: Callable[[Node], Iterable[Node]]) -> dict[Node, None]:
    """These nodes and all that follow them, directly or not, the nearest first. What follows a node is asked once."""
    found = dict.fromkeys(starts)
    todo = list(found)
    for node in todo:
        for other in following(node):
            if other not in found:
                found[other] = None
                todo.append(other)
    return found


def postorder(starts: Iterable[Node], inner: Callable[[Node], Iterable[Node]]) -> Iterator[Node]:
    """These nodes and all below them, each once and behind those below it; where a line closes a circle, behind as many
    as can be."""
    entered: set[Node] = set()
    for start in starts:
        path = [(start, iter(inner(start)))] if start not in entered else []
        entered.add(start)
        while path:
            node, below = path[-1]
            other = next((other for other in below if other not in entered), None)
            if other is None:
                yield node
                path.pop()
            else:
                entered.add(other)
                path.append((other, iter(inner(other))))


def generations(after: Mapping[Node, Iterable[Node]]) -> list[tuple[Node, ...]] | None:
    """The nodes in waves, each wave behind all that it is after; None where there is a circle."""
    sorter = TopologicalSorter(after)
    try:
        sorter.prepare()
    except CycleError:
        return None
    found: list[tuple[Node, ...]] = []
    while sorter.is_active():
        found.append(sorter.get_ready())
        sorter.done(*found[-1])
    return found


def cyclic_components(graph: Mapping[Node, Iterable[Node]]) -> list[set[Node]]:
    """The nodes that lie on circles, each set with all that share circles. `graph` has what follows each node."""
    try:
        TopologicalSorter(graph).prepare()
        return []
    except CycleError:
        import networkx  # slow to import, and wanted only to explain

    whole: networkx.DiGraph[Node] = networkx.DiGraph({node: list(others) for node, others in graph.items()})
    found = networkx.strongly_connected_components(whole)
    return [knot for knot in found if len(knot) > 1 or any(whole.has_edge(node, node) for node in knot)]


def cycle_through(graph: Mapping[Node, Iterable[Node]], knot: set[Node], start: Node) -> list[Node]:
    """A circle through a node of a knot, from this node on: by the first that follows it, and the shortest way back."""
    import networkx

    inside = {node: [other for other in graph[node] if other in knot] for node in knot}
    way: list[Node] = networkx.shortest_path(networkx.DiGraph(inside), inside[start][0], start)
    return [start, *way[:-1]]
