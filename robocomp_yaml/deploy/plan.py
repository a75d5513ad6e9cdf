"""The plan of `up`: the desired state of each process is compared with its actual state.

A process restarts when something changed that it cannot apply while it runs. Processes that depend on it go on: Ice
reconnects by itself, and if the process has moved, the configurations of its users have changed, too. Only a program
that does not use Ice restarts with a process that it is `after`.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping

import msgspec

from robocomp_yaml.deploy.differences import Difference, differences, shown_path
from robocomp_yaml.deploy.engine import RUNNING, STOPPED, Running
from robocomp_yaml.deploy.spec import ProcessSpec, spec_of
from robocomp_yaml.deploy.states import fault, is_unstable
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.digraph import postorder, reachable
from robocomp_yaml.grouping import grouped
from robocomp_yaml.network.network import Network, Process

START, STOP, RESTART, CHANGE, KEEP = "start", "stop", "restart", "change", "keep"


class PlanStep(msgspec.Struct, frozen=True):
    """What happens to one process. `spec` is its desired spec, None if it stops; `before` is the spec that it runs
    with. CHANGE applies what needs no restart."""

    name: str
    action: str
    reason: str
    changes: tuple[Difference, ...] = ()
    spec: ProcessSpec | None = None
    running: Running | None = None

    @property
    def before(self) -> ProcessSpec | None:
        return self.running.spec if self.running else None


class Plan(msgspec.Struct):
    """Steps by the process's name: first those that stop and are not desired, then the network's in its order."""

    steps: dict[str, PlanStep] = {}

    def of(self, *actions: str) -> list[PlanStep]:
        return [step for step in self.steps.values() if step.action in actions]

    @property
    def is_empty(self) -> bool:
        return all(step.action == KEEP for step in self.steps.values())


def plan(
    network: Network, running: Mapping[str, Running], names: Iterable[str] = (), forced: Collection[str] = ()
) -> Plan:
    """The plan from the actual state, `running`, to the network. `names` limit it to these processes, with all that
    they are after, and those that must restart with them. `forced` processes restart in any case."""
    chosen = with_dependences(network, names) if names else {process.name for process in network.enabled()}
    steps: dict[str, PlanStep] = {}
    for name in running:
        process = network.processes.get(name)
        if not names and (process is None or not process.enabled):
            reason = "it is no longer part of the deployment" if process is None else "it is disabled"
            steps[name] = PlanStep(name, STOP, reason, running=running[name])
    digests: dict[str, str] = {}
    for wave in network.order:
        for name in wave:
            process = network.processes[name]
            follows = _restarting(process, steps)
            if name in chosen or (follows and name in running):
                spec = spec_of(network, process, digests)
                steps[name] = _step(spec, running.get(name), forced, follows)
    return Plan(steps)


def unhealthy(plan: Plan) -> list[Diagnostic]:
    """A diagnostic for each process that goes on although it ends again and again, or is not alive: no step of a plan
    helps it."""
    kept = [(step.running, step.spec.process.span) for step in plan.of(CHANGE, KEEP) if step.running and step.spec]
    return [found for running, where in kept if (found := ill(running, where))]


def ill(running: Running, where: Span) -> Diagnostic | None:
    """A diagnostic for a process that runs, and ends again and again or is not alive."""
    if is_unstable(running):
        return deploying.UNSTABLE.at(where, name=running.name, how=running.last_exit)
    if running.state != RUNNING or not running.not_alive:
        return None
    again = typed("rcyaml", "deploy", "restart", *([shown_path(where.file)] if where.file else []), running.name)
    return deploying.NOT_ALIVE.at(where, name=running.name, why=running.not_alive, hint=f"`{again}` starts it again")


def with_dependences(network: Network, names: Iterable[str]) -> set[str]:
    """The enabled ones of these processes, and of all that they are after or wait for, directly or not."""

    def needed(name: str) -> Iterable[str]:
        process = network.processes.get(name)
        return (*process.after, *process.awaits) if process else ()

    return {name for name in reachable(names, needed) if name in network.processes and network.processes[name].enabled}


def with_dependents(after: Mapping[str, Iterable[str]], names: Iterable[str]) -> set[str]:
    """These processes and all that are after them, directly or not. `after` has for each process what it is after."""
    behind = grouped((other, name) for name, before in after.items() for other in before)
    return set(reachable(names, lambda name: behind.get(name, ())))


def disabled(network: Network, names: Iterable[str]) -> Iterator[Diagnostic]:
    """A warning for each of these names that is that of a disabled process: it is not started."""
    for process in map(network.find, names):
        if process is not None and not process.enabled:
            yield deploying.DISABLED.at(process.span, name=process.name, hint="remove `enabled: false`")


def in_order(after: Mapping[str, Iterable[str]]) -> list[str]:
    """The names, each after those that it is after; in a circle, after as many of them as possible."""
    return list(postorder(after, lambda name: [other for other in after[name] if other in after]))


def _restarting(process: Process, steps: Mapping[str, PlanStep]) -> str:
    """A restarting process with which this one must restart, because it cannot reconnect by itself; '' if there is
    none."""
    if process.is_ice:
        return ""
    return next((name for name in process.after if name in steps and steps[name].action == RESTART), "")


def _step(spec: ProcessSpec, running: Running | None, forced: Collection[str], follows: str) -> PlanStep:
    name = spec.name
    if running is None:
        return PlanStep(name, START, "it does not run yet", spec=spec)
    if running.state == STOPPED:
        return PlanStep(name, START, "it was stopped", spec=spec, running=running)
    why = fault(running, is_server=spec.process.is_server)
    if why and running.state != RUNNING:
        return PlanStep(name, START, why, spec=spec, running=running)
    if running.spec is None:
        return PlanStep(name, RESTART, "another version of rcyaml started it", spec=spec, running=running)
    changes = tuple(differences(running.spec, spec))
    if name in forced:
        return PlanStep(name, RESTART, "its restart was requested", changes, spec, running)
    if any(not change.is_live for change in changes):
        return PlanStep(name, RESTART, _first(changes), changes, spec, running)
    if follows and running.state == RUNNING:
        return PlanStep(name, RESTART, f"it is after {follows}, which restarts", changes, spec, running)
    if changes:
        return PlanStep(name, CHANGE, _first(changes), changes, spec, running)
    return PlanStep(name, KEEP, why or "nothing changed", spec=spec, running=running)


def _first(changes: tuple[Difference, ...]) -> str:
    """The change that is the reason, and the number of further changes."""
    first = next((change for change in changes if not change.is_live), changes[0])
    more = len(changes) - 1
    return f"{first}" + (f", and {more} more" if more else "")
