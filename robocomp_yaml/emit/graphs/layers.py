"""In which layer each node stands: above all that it needs, as far as circles allow."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from robocomp_yaml.digraph import inner_first


def layers(nodes: Iterable[str], needs: Mapping[str, Sequence[str]]) -> dict[str, int]:
    """The layer of each node, 0 the topmost. A line that closes a circle counts for nothing. What needs nothing stands
    just below the lowest that needs it, and what is alone stands at the bottom."""
    names = list(nodes)
    depth = _depths(names, needs)
    height = max(depth.values(), default=0)
    users: dict[str, list[str]] = {}
    for name in names:
        for other in needs.get(name, ()):
            users.setdefault(other, []).append(name)
    found = {name: height - depth[name] for name in names}
    for name in sorted(names, key=lambda name: found[name]):
        below = [found[user] for user in users.get(name, ()) if found[user] < found[name]]
        if below and not needs.get(name):
            found[name] = max(below) + 1
    return found


def _depths(names: Sequence[str], needs: Mapping[str, Sequence[str]]) -> dict[str, int]:
    """How many others stand below each node, one below the other; found without recursion, for chains may be long."""
    depth: dict[str, int] = {}
    for name in inner_first(names, lambda name: needs.get(name, ())):
        depth[name] = 1 + max((depth[other] for other in needs.get(name, ()) if other in depth), default=-1)
    return depth
