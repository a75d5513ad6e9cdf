"""In which order processes start: in waves, each behind all that it needs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import msgspec

from robocomp_yaml import digraph
from robocomp_yaml.diag.codes import networks as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.model.component import FAIL, IGNORE, WAIT

AFTER = "after"


class Need(msgspec.Struct, frozen=True):
    """`source` starts after `target`. `absent` is what it does when the other is not there yet (IGNORE, WAIT or FAIL),
    '' where nobody knows; `port` is its proxy, AFTER for what the document says by `after:`."""

    source: str
    target: str
    absent: str
    port: str
    span: Span


def ordered(
    names: Iterable[str], needs: Iterable[Need]
) -> tuple[list[tuple[str, ...]], dict[str, tuple[str, ...]], list[Diagnostic]]:
    """The waves, what each process starts after, and what is wrong. Where processes need each other in a circle, one
    that can wait for another starts before it."""
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
        kept, told = _broken(kept, after, position)
        diagnostics += told


def optional(needs: Iterable[Need]) -> dict[str, set[str]]:
    """Of each process those that it can do without: whatever it needs of them, it ignores that they are absent."""
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


def _broken(
    needs: list[Need], after: Mapping[str, Iterable[str]], position: Mapping[str, int]
) -> tuple[list[Need], list[Diagnostic]]:
    """The needs without one of each knot of circles: the one that is easiest to do without."""
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
        told = max((need for need in needs if (need.source, need.target) == (source, target)), key=_cost)
        diagnostics.append(_told(told, [*circle, source]))
    return [need for need in needs if (need.source, need.target) not in dropped], diagnostics


def _cost(need: Need) -> int:
    """IGNORE and WAIT are made for it."""
    return {IGNORE: 0, WAIT: 1, "": 2, FAIL: 3}[need.absent] if need.port != AFTER else 4


def _told(drop: Need, circle: list[str]) -> Diagnostic:
    around = " → ".join(circle)
    if drop.absent in (IGNORE, WAIT):
        does = "waits for it" if drop.absent == WAIT else "does without it until it is there"
        return codes.CYCLE.at(drop.span, circle=around, first=drop.source, second=drop.target, does=does)
    hint = "leave one `after:` out" if drop.port == AFTER else f"let one of them wait: `absent: {WAIT}` in its CDSL"
    return codes.DEADLOCK.at(drop.span, circle=around, hint=hint)
