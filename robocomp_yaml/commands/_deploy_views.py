"""The output of plans, results, states and logs of deployments, as text and as JSON."""

from __future__ import annotations

import json
import zlib
from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING, Any

from robocomp_yaml.deploy import json_data
from robocomp_yaml.deploy.differences import shown_path
from robocomp_yaml.deploy.engine import OWN, Line
from robocomp_yaml.deploy.operations import KEEP_GOING, ROLL_BACK, Result, Status
from robocomp_yaml.deploy.plan import CHANGE, KEEP, RESTART, START, STOP, Plan
from robocomp_yaml.diag.terminal import Shown, columns, cut, line, pad, paint, shown
from robocomp_yaml.network.network import Network

if TYPE_CHECKING:
    from robocomp_yaml.deploy.probe import ProbedProgram

_SIGNS = {START: "+", STOP: "-", RESTART: "~", CHANGE: "*", KEEP: "="}
_TINTS = {START: "32", STOP: "31", RESTART: "33", CHANGE: "36", KEEP: "2"}
_LOG_TINTS = ("36", "33", "32", "35", "34", "96", "93", "92", "95", "94")


def plan_lines(plan: Plan, network: Network, color: bool, *, everything: bool) -> list[Shown]:
    """A line for each process that changes, with its changes and the values that replace what the user chose, and a
    summary line. `everything` also prints the other processes, and all values of all configurations."""
    width = max(map(columns, plan.steps), default=0)
    lines = []
    for step in plan.steps.values():
        if step.action != KEEP or everything:
            head = line(f"{_SIGNS[step.action]} ", pad(step.name, width), f"  {step.action}")
            lines.append(line(paint(head, _TINTS[step.action], color), f": {step.reason}"))
            if len(step.changes) > 1:
                lines += [shown(f"    {change}") for change in step.changes]
            if settings := network.settings_of(step.name) if step.action != STOP else []:  # programs have none
                from robocomp_yaml.commands._origins import is_worth_a_line, origin

                chosen = [one for one in settings if everything or is_worth_a_line(one)]
                lines += [shown(f"    {one.key} = {one.value}  # {origin(one)}") for one in chosen]
    counts = [(len(plan.of(action)), action) for action in (START, STOP, RESTART, CHANGE, KEEP)]
    summary = ", ".join(f"{count} to {action}" for count, action in counts if count)
    return [*lines, shown("nothing to do" if plan.is_empty else summary)]


def stop_lines(stopping: list[str], reasons: dict[str, str], color: bool) -> list[Shown]:
    """As `plan_lines`, for what stops, in that order."""
    width = max(map(columns, stopping), default=0)
    lines = []
    for name in stopping:
        head = line(f"{_SIGNS[STOP]} ", pad(name, width), f"  {STOP}")
        lines.append(line(paint(head, _TINTS[STOP], color), f": {reasons[name]}" if name in reasons else ""))
    return [*lines, shown(f"{len(stopping)} to stop" if stopping else "nothing to do")]


def plan_data(plan: Plan, network: Network | None = None) -> list[dict[str, Any]]:
    """The steps; with a network, also the values of the configurations of what does not stop."""
    from robocomp_yaml.commands._origins import settings_data

    made = json_data.plan_steps(plan)
    for step, data in zip(plan.steps.values(), made, strict=True):
        if network is not None and step.action != STOP:
            data["config"] = settings_data(network.settings_of(step.name))
    return made


def result_text(network: Network, result: Result) -> str:
    if result.plan.is_empty and result.diagnostics:
        return f"{network.name}: nothing to do, but not all processes are ready"
    if result.plan.is_empty:
        return f"{network.name}: nothing to do, {_count(len(result.plan.steps))} as desired"
    if not result.diagnostics:
        return f"{network.name}: {_count(len(result.plan.of(START, RESTART, CHANGE, KEEP)))} as desired"
    if not result.undone:
        return f"{network.name}: nothing was changed"
    if lost := result.not_restored:
        not_ready = f"{', '.join(lost)} {'is' if len(lost) == 1 else 'are'} not ready"
        return f"{network.name}: failed; the rollback failed, too: {not_ready}"
    after = {ROLL_BACK: "rolled back to what ran before", KEEP_GOING: "the started processes keep running"}
    return f"{network.name}: failed; {after.get(result.undone, 'the started processes were stopped')}"


def status_lines(
    network: Network, found: Sequence[Status], color: bool, room: int | None = None
) -> list[Shown]:  # fmt: skip
    """A table of the processes. `room` is the width of a terminal in columns: the last column is cut to fit. Hosts are
    shown if there are several."""
    rows: list[tuple[str, ...]] = [("PROCESS", "STATE", "PID", "HOST", "UP", "RESTARTS", "MEMORY", "CPU", "SERVES")]
    for status in found:
        running = status.running
        alive = running if running and running.pid else None
        rows.append(
            (
                status.name,
                json_data.state_in_words(status),
                str(alive.pid) if alive else "-",
                status.host,
                duration(alive.uptime) if alive else "-",
                str(running.restarts) if running else "-",
                _memory(alive.memory) if alive else "-",
                _cpu(alive.cpu) if alive else "-",
                _endpoints(network, status.name),
            )
        )
    if len({status.host for status in found}) < 2:
        at = rows[0].index("HOST")
        rows = [(*row[:at], *row[at + 1 :]) for row in rows]
    widths = [max(columns(row[column]) for row in rows) for column in range(len(rows[0]))]
    if room is not None:
        widths[-1] = min(widths[-1], max(room - sum(widths[:-1]) - 2 * len(widths[:-1]), len(rows[0][-1])))
    lines = []
    states: list[Status | None] = [None, *found]
    for row, one in zip(rows, states, strict=True):
        cells = [pad(cell, width) for cell, width in zip(row, widths, strict=True)]
        cells[-1] = cut(row[-1], widths[-1])
        if one:
            tint = "31" if one.is_down else "32" if one.is_ready else "33" if one.running else "2"
            cells[1] = paint(cells[1], tint, color)
        lines.append(Shown("  ".join(cells).rstrip()))
    return lines


def _memory(size: int | None) -> str:
    return "unknown" if size is None else f"{size / (1 << 20):.0f} MiB"


def _cpu(seconds: float | None) -> str:
    return "unknown" if seconds is None else f"{seconds:.1f} s" if seconds < 100 else duration(seconds)


def lost_lines(found: Sequence[Status]) -> list[Shown]:
    """A line for each process whose log is not written, because the disk is full."""
    lost = [(one.name, one.running.lost_lines) for one in found if one.running and one.running.lost_lines]
    return [
        line(f"{count} line{'' if count == 1 else 's'} of the log of '{name}' could not be written: is the disk full?")
        for name, count in lost
    ]


def probe_lines(found: Sequence[ProbedProgram], color: bool) -> list[Shown]:
    """A line for each program that a host was asked for."""
    rows = [(shown_path(one.program) if "/" in one.program else one.program, *_verdict(one)) for one in found]
    width = max((columns(row[0]) for row in rows), default=0)
    return [
        line("  ", pad(program, width), "  ", paint(verdict, tint, color), f", for {', '.join(one.used_by)}")
        for (program, verdict, tint), one in zip(rows, found, strict=True)
    ]


def _verdict(one: ProbedProgram) -> tuple[str, str]:
    if not one.path:
        return "missing, or not executable", "31"
    if one.missing:
        return f"lacks {', '.join(one.missing)}", "31"
    return f"there, of {one.day}, digest {one.digest}", "32"


class LogView:
    """Lines of logs, each after the name of its process."""

    def __init__(self, names: Collection[str], color: bool, times: bool) -> None:
        self._width, self._color, self._times = max(map(columns, names), default=0), color, times

    def text(self, logged: Line) -> Shown:
        tint = _LOG_TINTS[zlib.crc32(logged.name.encode()) % len(_LOG_TINTS)]
        text = shown(logged.text, tabs=True)
        if text.startswith(OWN):
            text = paint(text, "2", self._color)
        head = paint(line(pad(logged.name, self._width), " |"), tint, self._color)
        return line(f"{logged.time} " if self._times else "", head, " ", text)


def line_data(logged: Line) -> str:
    return json.dumps(json_data.line_data(logged), ensure_ascii=False) + "\n"


def _endpoints(network: Network, name: str) -> str:
    process = network.processes.get(name)
    return ", ".join(f"{one.interface}:{one.port}" for one in process.endpoints) if process else ""


def duration(seconds: float) -> str:
    """A duration in words: '45 s', '12 min', '3 h 20 min', '5 d 2 h'."""
    if seconds < 120:
        return f"{seconds:.0f} s"
    minutes = int(seconds // 60)
    if minutes < 120:
        return f"{minutes} min"
    hours = minutes // 60
    return f"{hours} h {minutes % 60} min" if hours < 48 else f"{hours // 24} d {hours % 24} h"


def _count(number: int) -> str:
    return f"{number} process{'' if number == 1 else 'es'}"
