"""Circles of processes that wait for each other: one starts first, and is ready only when the others run.

Each of them waits for its own proxies while it runs, so that inside a circle it is enough that the first one serves.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import msgspec

from robocomp_yaml.deploy.plan import Plan
from robocomp_yaml.digraph import cyclic_components


class Circles(msgspec.Struct):
    """`of` has the number of its circle for each process of one. `awaited` are for each process that starts first those
    of its circle that it waits for while it runs."""

    of: dict[str, int] = {}
    awaited: dict[str, tuple[str, ...]] = {}

    def need_not_be_ready(self, first: str, other: str) -> bool:
        """Whether a process starts when `first`, which it is after, serves, because that one waits for it."""
        return first in self.awaited and self.of[first] == self.of.get(other)


def circles_of(after: Mapping[str, Iterable[str]], awaits: Mapping[str, Iterable[str]]) -> Circles:
    """The circles of processes, by what each is after, and what it waits for while it runs."""
    both = {name: [one for one in (*after[name], *awaits.get(name, ())) if one in after] for name in after}
    of = {name: number for number, circle in enumerate(cyclic_components(both)) for name in circle}
    inside = {
        name: tuple(one for one in awaits.get(name, ()) if name in of and of.get(one) == of[name]) for name in after
    }
    return Circles(of, {name: others for name, others in inside.items() if others})


def circles_in(plan: Plan) -> Circles:
    """The circles of the processes that a plan leaves running."""
    specs = [step.spec for step in plan.steps.values() if step.spec]
    return circles_of(
        {spec.name: spec.process.after for spec in specs}, {spec.name: spec.process.awaits for spec in specs}
    )
