"""The order in which processes start: in waves, each after the waves of all that it depends on."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import msgspec

from robocomp_yaml import digraph
from robocomp_yaml.diag.codes import networks as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.model.component import FAIL, IGNORE, WAIT

AFTER = "after"


class Dependence(msgspec.Struct, frozen=True):
    """A dependence: `source` starts after `target`. `absent` is what `source` does while `target` is absent (IGNORE,
    WAIT or FAIL), '' if that is unknown. `port` is its proxy, or AFTER for a dependence from `after:`."""

    source: str
    target: str
    absent: str
    port: str
    span: Span


def ordered(
    names: Iterable[str], needs: Iterable[Dependence]
) -> tuple[list[tuple[str, ...]], dict[str, tuple[str, ...]], list[Diagnostic]]:
    """The waves, what each process starts after, and diagnostics. If processes depend on each other in a circle, one
    that can wait for another starts first."""
    position = {name: number for number, name in enumerate(names)}
    kept = [need for need in needs if need.source in position and need.target in position]
    diagnostics: list[Diagnostic] = []
    while True:
        after: dict[str, dict[str, None]] = {name: {} for name in position}
        for need in kept:
            after[need.source][need.target] = None
        waves = digraph.generations(after)
        if waves is not None:
            in_order = [tuple(sorted(wave, key=position.__getitem__)) for wave in waves]
            return in_order, {name: tuple(targets) for name, targets in after.items()}, diagnostics
        kept, reported = _without_circles(kept, after, position)
        diagnostics += reported


def optional(needs: Iterable[Dependence]) -> dict[str, set[str]]:
    """For each process, the processes that it can work without: all its dependences on them have `absent: ignore`."""
    found: dict[str, set[str]] = {}
    needed = []
    for need in needs:
        found.setdefault(need.source, set())
        if need.absent == IGNORE and need.port != AFTER:
            found[need.source].add(need.target)
        else:
            needed.append(need)
    for need in needed:
        found[need.source].discard(need.target)
    return found


def awaited(needs: Iterable[Dependence], after: Mapping[str, Iterable[str]]) -> dict[str, tuple[str, ...]]:
    """For each process, those that it waits for although they start after it, because it starts first in a circle.
    `after` is what `ordered` returned."""
    found: dict[str, dict[str, None]] = {}
    for need in needs:
        is_later = need.source in after and need.target in after and need.target not in after[need.source]
        if is_later and need.absent == WAIT and need.port != AFTER and need.source != need.target:
            found.setdefault(need.source, {})[need.target] = None
    return {name: tuple(targets) for name, targets in found.items()}


def _without_circles(
    needs: list[Dependence], after: Mapping[str, Iterable[str]], position: Mapping[str, int]
) -> tuple[list[Dependence], list[Diagnostic]]:
    """The dependences without one of each set of connected circles, the least important one; with diagnostics."""
    cost: dict[tuple[str, str], int] = {}
    for need in needs:
        pair = need.source, need.target
        cost[pair] = max(cost.get(pair, 0), _cost(need))
    dropped: set[tuple[str, str]] = set()
    diagnostics = []
    for knot in digraph.cyclic_components(after):
        inside = [pair for pair in cost if pair[0] in knot and pair[1] in knot]
        source, target = min(inside, key=lambda pair: (cost[pair], position[pair[0]], position[pair[1]]))
        circle = digraph.cycle_through({**after, source: [target]}, knot, source)
        dropped.add((source, target))
        drop = max((need for need in needs if (need.source, need.target) == (source, target)), key=_cost)
        diagnostics.append(_reported(drop, [*circle, source]))
    return [need for need in needs if (need.source, need.target) not in dropped], diagnostics


def _cost(need: Dependence) -> int:
    """How important a dependence is: with IGNORE and WAIT, a process can start before the other."""
    return {IGNORE: 0, WAIT: 1, "": 2, FAIL: 3}[need.absent] if need.port != AFTER else 4


def _reported(drop: Dependence, circle: list[str]) -> Diagnostic:
    around = " → ".join(circle)
    if drop.absent in (IGNORE, WAIT):
        does = "waits for it" if drop.absent == WAIT else "works without it until it is ready"
        return codes.CYCLE.at(drop.span, circle=around, first=drop.source, second=drop.target, does=does)
    hint = "remove one `after:`" if drop.port == AFTER else f"let one of them wait: `absent: {WAIT}` in its CDSL"
    return codes.DEADLOCK.at(drop.span, circle=around, hint=hint)
