"""The full names of topics: what an include both publishes and subscribes to is its own, and is called after it.

Each end calls its topic by a name that is looked up from the scope that it stands in, outwards: the first scope in
which somebody else is at the other end keeps the topic. What has no other end in an include meets what is around it. An
end may also name a topic of an include in its scope (`left/State`), or one of no include (`/State`).
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence

import msgspec
from msgspec.structs import replace


class NamedEnd(msgspec.Struct, frozen=True):
    """An end of a topic: `name` is how its document calls it, in `scope` ('' or `arm.hand.`)."""

    owner: str
    scope: str
    name: str
    is_out: bool


class _Visit(msgspec.Struct, frozen=True):
    """An end that looks for others in `scope` by `name`. Where it finds none in a scope that its own name led it to, it
    goes back to `home`, where it is called `spelled`, and from there outwards."""

    index: int
    scope: str
    name: str
    home: str
    spelled: str


def full_names(ends: Sequence[NamedEnd], scopes: Collection[str], outermost: str = "") -> list[str]:
    """The name of each end's topic in its IceStorm, which serves the scope `outermost` and those inside."""
    names = [""] * len(ends)
    waiting: dict[tuple[str, str], list[_Visit]] = {}
    for index, end in enumerate(ends):
        visit = _first(index, end, scopes, outermost)
        waiting.setdefault((visit.scope, visit.name), []).append(visit)
    while waiting:
        deepest = max(scope.count(".") for scope, _ in waiting)
        for (scope, name), visits in [item for item in waiting.items() if item[0][0].count(".") == deepest]:
            del waiting[scope, name]
            if scope == outermost or _is_closed(ends[visit.index] for visit in visits):
                for visit in visits:
                    names[visit.index] = scope.removeprefix(outermost).replace(".", "/") + name
                continue
            for visit in visits:
                following = _following(visit)
                waiting.setdefault((following.scope, following.name), []).append(following)
    return names


def _first(index: int, end: NamedEnd, scopes: Collection[str], outermost: str) -> _Visit:
    """Where a name leads: into an include that it begins with, or out of all of them."""
    outside = end.name.lstrip("/")
    is_absolute = outside not in ("", end.name)
    home, spelled = (outermost, outside) if is_absolute else (end.scope, end.name)
    scope, name = home, spelled
    while True:
        first, slash, rest = name.partition("/")
        if not (slash and rest and f"{scope}{first}." in scopes):
            return _Visit(index, scope, name, home, spelled)
        scope, name = f"{scope}{first}.", rest


def _following(visit: _Visit) -> _Visit:
    if len(visit.scope) > len(visit.home):
        return replace(visit, scope=visit.home, name=visit.spelled)
    outer = visit.scope[: visit.scope.rstrip(".").rfind(".") + 1]
    return replace(visit, scope=outer, home=outer)


def _is_closed(ends: Iterable[NamedEnd]) -> bool:
    """Whether one publishes what another one hears; what talks to its like only wants company from outside."""
    out: set[str] = set()
    heard: set[str] = set()
    for end in ends:
        (out if end.is_out else heard).add(end.owner)
    return bool(out and heard) and len(out | heard) > 1
