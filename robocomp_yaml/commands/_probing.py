"""How `rcyaml deploy probe` asks hosts, and what it says of them."""

from __future__ import annotations

import asyncio

import click
from msgspec import to_builtins

from robocomp_yaml.commands import _options
from robocomp_yaml.commands._deploying import Opened, end
from robocomp_yaml.deploy.differences import shown_path
from robocomp_yaml.deploy.probe import NODE, Found, ProbeFailed, probe, programs
from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.suggest import suggest
from robocomp_yaml.network.network import Host, Network


def tell(ctx: click.Context, opened: Opened, name: str = "") -> None:
    """Asks the host of that name, or all of them. The exit code is 1 where one cannot run what the network has for
    it."""
    hosts = [_host(opened.network, name)] if name else list(opened.network.hosts.values())
    wanted = programs(opened.network)
    answers: dict[str, list[Found]] = {}

    async def work() -> None:
        asked = await asyncio.gather(*(probe(host, wanted) for host in hosts), return_exceptions=True)
        for host, answer in zip(hosts, asked, strict=True):
            if isinstance(answer, ProbeFailed):
                opened.told.append(
                    deploying.NO_ANSWER.at(host.span, host=host.name, address=host.address, reason=answer)
                )
            elif isinstance(answer, BaseException):
                raise answer
            else:
                answers[host.name] = answer

    asyncio.run(work())
    code = 0 if all(_can_run(opened.network, host, found) for host, found in answers.items()) else 1
    if opened.format_ == "json":
        data = {host: [to_builtins(one) for one in found] for host, found in answers.items()}
        end(ctx, opened, {"hosts": data}, code)
    for host, found in answers.items():
        terminal.say(f"{host} ({opened.network.hosts[host].address}):", *_lines(found, _options.colored(ctx)))
    end(ctx, opened, code=code)


def _host(network: Network, name: str) -> Host:
    if name not in network.hosts:
        meant = suggest(name, network.hosts)
        hint = f"did you mean '{meant}'?" if meant else f"there are {', '.join(network.hosts)}"
        raise click.UsageError(f"{network.name} has no host '{name}'; {hint}")
    return network.hosts[name]


def _can_run(network: Network, host: str, found: list[Found]) -> bool:
    own = {process.name for process in network.enabled() if process.host == host} | {NODE}
    return all(one.can_run for one in found if own & set(one.used_by))


def _lines(found: list[Found], color: bool) -> list[terminal.Shown]:
    rows = [(shown_path(one.program) if "/" in one.program else one.program, *_verdict(one)) for one in found]
    width = max((terminal.columns(row[0]) for row in rows), default=0)
    return [
        terminal.line(
            "  ", terminal.pad(program, width), "  ", terminal.paint(verdict, tint, color),
            f", for {', '.join(one.used_by)}",
        )
        for (program, verdict, tint), one in zip(rows, found, strict=True)
    ]  # fmt: skip


def _verdict(one: Found) -> tuple[str, str]:
    if not one.path:
        return "not there, or not executable", "31"
    if one.missing:
        return f"lacks {', '.join(one.missing)}", "31"
    return f"{one.day} {one.digest}", "32"
