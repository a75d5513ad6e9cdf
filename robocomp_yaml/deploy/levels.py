"""The order of restarts: one level of the network's order at a time, so that at any time as little as possible is down.

All processes of a level stop together, and the next level stops only when they are ready again.
"""

from __future__ import annotations

from collections.abc import Collection

from robocomp_yaml.deploy.circles import circles_in
from robocomp_yaml.deploy.plan import RESTART, START, Plan, PlanStep
from robocomp_yaml.deploy.spec import ProcessSpec
from robocomp_yaml.digraph import postorder
from robocomp_yaml.grouping import grouped


def levels(plan: Plan, skipped: Collection[str]) -> list[list[PlanStep]]:
    """The steps that restart a running process, by level: each step is in a later level than all steps that it is
    after. The steps of a circle are in one level, because none of them is ready alone."""
    of = circles_in(plan).of
    specs = {step.name: step.spec for step in plan.steps.values() if step.spec}
    groups = grouped((of.get(name, name), name) for name in specs)
    after = {
        group: [of.get(other, other) for name in names for other in specs[name].process.after if other in specs]
        for group, names in groups.items()
    }
    depth: dict[str, int] = {}
    above: dict[str | int, int] = {}
    for group in postorder(after, lambda group: after[group]):
        above[group] = 1 + max((above[other] for other in after[group] if other != group and other in above), default=0)
        depth |= dict.fromkeys(groups[group], above[group])
    found = grouped((depth[step.name], step) for step in plan.of(RESTART) if step.name not in skipped)
    return [found[level] for level in sorted(found)]


def in_the_way(plan: Plan) -> set[str]:
    """The processes that restart and now listen on a port at which another process will start. They stop before
    anything starts, and so does a process of which the ports are unknown."""
    taken: dict[tuple[str, int], set[str]] = {}
    for step in plan.of(START, RESTART):
        for port in _ports(step.spec):
            taken.setdefault(port, set()).add(step.name)
    return {
        step.name
        for step in plan.of(RESTART)
        if step.before is None or any(taken.get(port, set()) - {step.name} for port in _ports(step.before))
    }


def _ports(spec: ProcessSpec | None) -> set[tuple[str, int]]:
    return {(spec.address, one.port) for one in spec.process.endpoints if one.port} if spec else set()
