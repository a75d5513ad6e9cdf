"""What `rcyaml deploy probe` says of hosts."""

from __future__ import annotations

import click
from msgspec import to_builtins

from robocomp_yaml.commands import _options
from robocomp_yaml.commands._deploying import Opened, end
from robocomp_yaml.deploy.differences import shown_path
from robocomp_yaml.deploy.probe import ProbedProgram, can_run
from robocomp_yaml.diag import terminal


def tell(ctx: click.Context, opened: Opened, name: str = "") -> None:
    """Asks the host of that name, or all of them. The exit code is 1 where one cannot run what the network has for
    it."""
    answers = opened.deployment.probe(name)
    code = 0 if all(can_run(opened.network, host, found) for host, found in answers.items()) else 1
    if opened.format_ == "json":
        data = {host: [to_builtins(one) for one in found] for host, found in answers.items()}
        end(ctx, opened, {"hosts": data}, code)
    for host, found in answers.items():
        terminal.say(f"{host} ({opened.network.hosts[host].address}):", *_lines(found, _options.colored(ctx)))
    end(ctx, opened, code=code)


def _lines(found: list[ProbedProgram], color: bool) -> list[terminal.Shown]:
    rows = [(shown_path(one.program) if "/" in one.program else one.program, *_verdict(one)) for one in found]
    width = max((terminal.columns(row[0]) for row in rows), default=0)
    return [
        terminal.line(
            "  ", terminal.pad(program, width), "  ", terminal.paint(verdict, tint, color),
            f", for {', '.join(one.used_by)}",
        )
        for (program, verdict, tint), one in zip(rows, found, strict=True)
    ]  # fmt: skip


def _verdict(one: ProbedProgram) -> tuple[str, str]:
    if not one.path:
        return "not there, or not executable", "31"
    if one.missing:
        return f"lacks {', '.join(one.missing)}", "31"
    return f"{one.day} {one.digest}", "32"
