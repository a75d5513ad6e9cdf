"""`rcyaml config`: the values of a component's parameters, offline and without a robot."""

from __future__ import annotations

import os

import click

from robocomp_yaml.commands import _options
from robocomp_yaml.commands._command import Command, Group


def _meant(ctx: click.Context, param: click.Parameter, said: str) -> str:
    from robocomp_yaml.api import which

    return which.values(said)


class _FileMayLack(Command):
    """Its first argument may be left out where there is only one document that it can be."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        wanted = [param.name for param in self.get_params(ctx) if isinstance(param, click.Argument)]
        found, _, _ = self.make_parser(ctx).parse_args(list(args))
        given = [found[name] for name in wanted if name and isinstance(found.get(name), str)]
        lacks = len(given) == len(wanted) - 1 and not os.path.exists(given[0])
        return super().parse_args(ctx, ["", *args] if lacks else args)


file = click.argument("file", metavar="[FILE]", default="", callback=_meant)
format_ = click.option("--format", "format_", type=click.Choice(["text", "json"]), default="text",
                       help="How to print it.")  # fmt: skip

reveal = click.option("--reveal", is_flag=True, help="Show secrets too.")


@click.group(cls=Group, short_help="Values of parameters: check, show, change, export.")
def command() -> None:
    """The values of a component's parameters: without a build, and without a robot.

    FILE is a values document: etc/config.yaml, or NAME.config.yaml. A component's folder, its document or its name
    stand for its etc/config.yaml; where there is only one component, FILE may be left out.
    """


@command.command(short_help="A first document, with defaults and docs as comments.")
@click.argument("file", metavar="[COMPONENT]", default="")
@_options.include
@click.pass_context
def new(ctx: click.Context, file: str, include: tuple[str, ...]) -> None:
    """Write a first values document to etc/config.yaml in a component's folder. COMPONENT is that folder, the
    component's document (or that of its parameters), or its name; where there is only one, it may be left out. It may
    also be the values document to be written, NAME.config.yaml, for the component beside it or one folder up.

    Values and connections that the component's etc/config has are taken over."""
    from robocomp_yaml.commands import _values

    _values.new(ctx, file, include)


@command.command(short_help="Everything that is wrong with the values.")
@file
@_options.include
@_options.format_
@click.pass_context
def check(ctx: click.Context, file: str, include: tuple[str, ...], format_: str) -> None:
    """Report everything that is wrong with the values in FILE and the layers it builds on, at line and column."""
    from robocomp_yaml.commands import _values

    _values.check(ctx, file, include, format_)


@command.command(short_help="Every effective value, and where it comes from.")
@file
@reveal
@_options.include
@format_
@click.pass_context
def show(ctx: click.Context, file: str, reveal: bool, include: tuple[str, ...], format_: str) -> None:
    """Print every effective value with the file and line that set it, and what it overrode. Secrets are hidden.
    References to the environment and to files are shown as such: their values are never read here."""
    from robocomp_yaml.commands import _values

    _values.show(ctx, file, include, format_, reveal=reveal)


@command.command(short_help="One effective value.", cls=_FileMayLack)
@file
@click.argument("path")
@reveal
@_options.include
@format_
@click.pass_context
def get(
    ctx: click.Context, file: str, path: str, reveal: bool, include: tuple[str, ...], format_: str
) -> None:  # fmt: skip
    """Print the effective value at PATH, such as motors[0].vel. A secret is hidden."""
    from robocomp_yaml.commands import _values

    _values.get(ctx, file, path, include, format_, reveal=reveal)


@command.command(
    "set",
    short_help="Change one value; all else stays as it is.",
    cls=_FileMayLack,
    context_settings={
        "ignore_unknown_options": True,
    },
)
@file
@click.argument("path")
@click.argument("value")
@_options.include
@format_
@click.pass_context
def set_(
    ctx: click.Context, file: str, path: str, value: str, include: tuple[str, ...], format_: str
) -> None:  # fmt: skip
    """Give the parameter at PATH another VALUE in FILE, checked by its type and limits. Text needs no quotes; null
    returns to the default, and {env: NAME} or {file: PATH} is what the environment or a file has when the component
    starts. Comments, order and layout of the document stay, byte for byte."""
    from robocomp_yaml.commands import _values

    _values.set_value(ctx, file, path, value, include, format_)


@command.command(short_help="The values as Ice properties or TOML.")
@file
@click.option("--as", "form", type=click.Choice(["ice", "toml"]), default="ice", help="What to print.")
@reveal
@_options.include
@click.pass_context
def export(ctx: click.Context, file: str, form: str, reveal: bool, include: tuple[str, ...]) -> None:
    """Print all effective values as an Ice property file, from which a component runs that knows nothing of YAML, or as
    TOML. Secrets are hidden on a terminal, and go into a pipe or a file."""
    from robocomp_yaml.commands import _values

    _values.export(ctx, file, form, include, reveal=reveal)
