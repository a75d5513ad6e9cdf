"""`rcyaml call`: a method of a running component."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from robocomp_yaml.commands import _options, _talking
from robocomp_yaml.commands._command import LibraryCommand
from robocomp_yaml.diag import terminal

if TYPE_CHECKING:
    from robocomp_yaml.api.calling import RemoteMethod


@click.command(cls=LibraryCommand, short_help="Call a method of a running component.",
               context_settings={"ignore_unknown_options": True})  # fmt: skip
@click.argument("method", shell_complete=_talking.completing(_talking.methods))
@click.argument("arguments", nargs=-1, metavar="[NAME=VALUE]...")
@_talking.deployment
@_talking.timeout
@click.option("--repeat", type=click.IntRange(1), metavar="N", help="Call N times.")
@_talking.every
@click.option(
    "--identity",
    default="",
    metavar="NAME",
    help="Ice's identity of the object; by default, the interface in lower case.",
)
@_talking.ice_config
@_options.include
@_talking.yaml_or_json
@click.pass_context
def command(
    ctx: click.Context, method: str, arguments: tuple[str, ...], deployment: str | None, timeout: float,
    repeat: int | None, every: float | None, identity: str, ice_config: str | None, include: tuple[str, ...],
    format_: str,
) -> None:  # fmt: skip
    """Call METHOD, such as speech.Speech.say, and print what it returns; no code is generated for it.

    METHOD begins with an entry of the deployment, a component of this workspace, or HOST:PORT. Arguments are text=hello
    or pose.x=2.5, a mapping in YAML such as '{text: hello}', or - for YAML from standard input. Exit code 1: the method
    raised an exception, which is printed, or there was no answer.
    """
    from robocomp_yaml.api.addresses import Addresses
    from robocomp_yaml.api.calling import RemoteMethod

    chosen = RemoteMethod(Addresses(deployment or "", include), method, identity)
    _talking.reject_options(ctx, arguments, [one.name for one in chosen.method.inputs])
    stdin = _talking.standard_input() if "-" in arguments else None
    made = chosen.arguments(arguments, stdin)
    count = repeat if repeat or every else 1
    ctx.exit(_call(chosen, made, ice_config or "", timeout, count, every, format_))


def _call(
    method: RemoteMethod, made: tuple[object, ...], ice_config: str, timeout: float, count: int | None,
    every: float | None, format_: str,
) -> int:  # fmt: skip

    is_one, code = count == 1, 0
    with method.connected(ice_config, timeout) as calls:
        for number in _talking.times(count, every):
            reply = calls.call(made)
            code = 1 if reply.throws else code
            text = _talking.as_text(reply.data, format_, line=not is_one and format_ == "json")
            if reply.data or format_ == "json" or not is_one:
                between = "---\n" if number and format_ == "yaml" else ""
                terminal.data(f"{between}{text}", json=format_ == "json")
    return code
