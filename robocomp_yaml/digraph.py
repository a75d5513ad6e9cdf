"""Algorithms on trees and directed graphs: reachable nodes, orders, cycles.

None of them recurses, because chains may be long.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from graphlib import CycleError, TopologicalSorter
from typing import TypeVar

Node = TypeVar("Node", bound=Hashable)


def reachable(starts: Iterable[Node], following: Callable[[Node], Iterable[Node]]) -> dict[Node, None]:
    """The start nodes and all nodes that are reachable from them, in breadth-first order. `following` is called once
    for each node."""
    seen = dict.fromkeys(starts)
    queue = list(seen)
    for node in queue:
        for other in following(node):
            if other not in seen:
                seen[other] = None
                queue.append(other)
    return seen


def preorder(roots: Iterable[Node], inner: Callable[[Node], Iterable[Node]]) -> Iterator[Node]:
    """All nodes of trees in depth-first order: each node before those below it, of which `inner` returns the next
    ones."""
    todo = [*roots][::-1]
    while todo:
        node = todo.pop()
        yield node
        todo += reversed([*inner(node)])


def postorder(starts: Iterable[Node], inner: Callable[[Node], Iterable[Node]]) -> Iterator[Node]:
    """The start nodes and all nodes below them, in depth-first postorder: each node once, after the nodes below it. An
    edge that closes a cycle does not count."""
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
    """The nodes in topological generations, each after all generations that it depends on; None if the graph has a
    cycle. `after` has the nodes that each node depends on."""
    sorter = TopologicalSorter(after)
    try:
        sorter.prepare()
    except CycleError:
        return None
    result: list[tuple[Node, ...]] = []
    while sorter.is_active():
        result.append(sorter.get_ready())
        sorter.done(*result[-1])
    return result


def cyclic_components(graph: Mapping[Node, Iterable[Node]]) -> list[set[Node]]:
    """The strongly connected components that have a cycle. `graph` has the successors of each node."""
    try:
        TopologicalSorter(graph).prepare()
        return []
    except CycleError:
        import networkx  # slow to import, and used only for error messages

    whole: networkx.DiGraph[Node] = networkx.DiGraph({node: list(others) for node, others in graph.items()})
    components = networkx.strongly_connected_components(whole)
    return [one for one in components if len(one) > 1 or any(whole.has_edge(node, node) for node in one)]


def cycle_through(graph: Mapping[Node, Iterable[Node]], component: set[Node], start: Node) -> list[Node]:
    """A cycle through a node of a strongly connected component, from this node on: by its first successor, and the
    shortest path back."""
    import networkx

    inside = {node: [other for other in graph[node] if other in component] for node in component}
    path: list[Node] = networkx.shortest_path(networkx.DiGraph(inside), inside[start][0], start)
    return [start, *path[:-1]]
