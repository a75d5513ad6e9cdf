"""The full names of topics. A topic that an include both publishes and subscribes to belongs to the include, and its
full name begins with the include's name.

An end of a topic is a publisher or a subscriber. Its name for the topic is looked up from its own scope outwards: the
topic belongs to the first scope in which another process is at the other end. An end may also name a topic of an
include in its scope (`left/State`), or a topic outside all includes (`/State`).
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence

import msgspec
from msgspec.structs import replace


class NamedEnd(msgspec.Struct, frozen=True):
    """An end of a topic. `name` is the topic's name in its document, `scope` the scope of the end ('' or `arm.hand.`).
    `is_out` is True for a publisher."""

    owner: str
    scope: str
    name: str
    is_out: bool


class _Lookup(msgspec.Struct, frozen=True):
    """The lookup of an end in `scope` under `name`. If a scope to which its own name leads has no other end, the lookup
    returns to `home`, where the name is `spelled`, and continues outwards."""

    index: int
    scope: str
    name: str
    home: str
    spelled: str


def full_names(ends: Sequence[NamedEnd], scopes: Collection[str], outermost: str = "") -> list[str]:
    """The name of each end's topic in its IceStorm, which serves the scope `outermost` and all scopes in it."""
    names = [""] * len(ends)
    waiting: dict[tuple[str, str], list[_Lookup]] = {}
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


def _first(index: int, end: NamedEnd, scopes: Collection[str], outermost: str) -> _Lookup:
    """The scope in which the lookup of a name begins: an include that the name begins with, or outside all includes."""
    outside = end.name.lstrip("/")
    is_absolute = outside not in ("", end.name)
    home, spelled = (outermost, outside) if is_absolute else (end.scope, end.name)
    scope, name = home, spelled
    while True:
        first, slash, rest = name.partition("/")
        if not (slash and rest and f"{scope}{first}." in scopes):
            return _Lookup(index, scope, name, home, spelled)
        scope, name = f"{scope}{first}.", rest


def _following(visit: _Lookup) -> _Lookup:
    if len(visit.scope) > len(visit.home):
        return replace(visit, scope=visit.home, name=visit.spelled)
    outer = visit.scope[: visit.scope.rstrip(".").rfind(".") + 1]
    return replace(visit, scope=outer, home=outer)


def _is_closed(ends: Iterable[NamedEnd]) -> bool:
    """Whether one process publishes what another one subscribes to. Only publishers, or only subscribers, look for the
    other end outside."""
    out: set[str] = set()
    subscribed: set[str] = set()
    for end in ends:
        (out if end.is_out else subscribed).add(end.owner)
    return bool(out and subscribed) and len(out | subscribed) > 1
