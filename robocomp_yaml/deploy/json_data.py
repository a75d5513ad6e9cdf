"""Plans, results, states and lines of logs as JSON's types, for every interface to rcyaml."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import msgspec

from robocomp_yaml.deploy.engine import Line, Running
from robocomp_yaml.deploy.operations import Result, Status
from robocomp_yaml.deploy.plan import Plan, PlanStep
from robocomp_yaml.network.network import Network

if TYPE_CHECKING:
    from robocomp_yaml.deploy.push.planned import HostPush

PRESENT = "another one is present"
"""The state of a shared IceStorm that is not started, because another one answers at its address."""


def plan_steps(plan: Plan) -> list[dict[str, Any]]:
    return [_step(step) for step in plan.steps.values()]


def _step(step: PlanStep) -> dict[str, Any]:
    changes = [
        {"field": change.field, "old": change.old, "new": change.new, "needs_restart": not change.is_live}
        for change in step.changes
    ]
    host = step.spec.process.host if step.spec else step.running.host if step.running else ""
    return {"name": step.name, "host": host, "action": step.action, "reason": step.reason, "changes": changes}


def result_data(result: Result) -> dict[str, object]:
    outcome = result.outcome
    ready = [name for name in outcome.began if name not in outcome.failed]
    return {
        "plan": plan_steps(result.plan),
        "result": {
            "ready": ready, "failed": list(outcome.failed), "skipped": outcome.skipped, "undone": result.undone,
            "not_restored": result.not_restored,
        },
    }  # fmt: skip


def state_in_words(one: Status) -> str:
    if one.running is None:
        return PRESENT if one.is_ready else "not started"
    if one.state == "running":
        if one.is_ready:
            return "ready"
        if one.running.not_alive:
            return f"not alive: {one.running.not_alive}"
        if one.own and not one.own.is_running:
            return one.own.words
        return f"running, not ready: {one.unmet}" if one.unmet else "running, not ready"
    return f"{one.state}: {one.running.last_exit}" if one.running.last_exit else one.state


def status_data(network: Network, found: Sequence[Status]) -> list[dict[str, Any]]:
    return [_status(network, one, one.running) for one in found]


def _status(network: Network, one: Status, running: Running | None) -> dict[str, Any]:
    process = network.processes.get(one.name)
    address = network.address(process) if process else ""
    return {
        "name": one.name, "host": one.host, "state": one.state if running else state_in_words(one),
        "ready": one.is_ready,
        "pid": running.pid if running else 0, "uptime": round(running.uptime, 3) if running else 0,
        "restarts": running.restarts if running else 0, "last_exit": running.last_exit if running else "",
        "not_alive": running.not_alive if running else "", "own": msgspec.to_builtins(one.own),
        "unmet": one.unmet,
        "memory": running.memory if running else 0, "cpu": running.cpu if running else 0,
        "lost_lines": running.lost_lines if running else 0,
        "endpoints": [
            {
                "interface": endpoint.interface, "identity": endpoint.identity, "endpoint": endpoint.text,
                "host": address, "port": endpoint.port,
            }
            for endpoint in (process.endpoints if process else ())
        ],
    }  # fmt: skip


def line_data(logged: Line) -> dict[str, str]:
    return {"name": logged.name, "time": logged.time, "text": logged.text}


def push_data(one: HostPush) -> dict[str, object]:
    return {
        "host": one.host.name, "address": one.host.address, "sent": sorted(one.send), "bytes": one.size,
        "deleted": sorted(one.delete), "replaced": sorted(one.replaced), "changed": sorted(one.changed),
        "built_there": sorted(one.built), "unchanged": one.unchanged,
    }  # fmt: skip
