"""`rcyaml build`: components to programs."""

from __future__ import annotations

import click

from robocomp_yaml.building.job import RELEASE, TYPES
from robocomp_yaml.commands import _options
from robocomp_yaml.commands._command import Command


@click.command(cls=Command, short_help="Build components; only what is not what it is made of.")
@click.argument("components", nargs=-1, metavar="[COMPONENT]...")
@click.option(
    "--type", "type_", type=click.Choice(TYPES, case_sensitive=False), help="How C++ is built; Release, unless said."
)
@click.option("-j", "--jobs", type=click.IntRange(min=1), help="How much is done at once; as many as processors.")
@click.option("-D", "defines", multiple=True, metavar="NAME=VALUE", help="A variable for CMake; may be repeated.")
@click.option("--clean", is_flag=True, help="Take the build trees away, and build nothing.")
@_options.include
@click.option("--format", "format_", type=click.Choice(["text", "json"]), default="text", help="How to print it.")
@click.pass_context
def command(
    ctx: click.Context, components: tuple[str, ...], type_: str | None, jobs: int | None, defines: tuple[str, ...],
    clean: bool, include: tuple[str, ...], format_: str,
) -> None:  # fmt: skip
    """Build COMPONENTs (by name, folder or document; by default, all below this folder) as they were compiled last.

    C++ is built with CMake and Ninja, all components of a workspace in one tree, build/TYPE/; Java with the JDK; Python
    is compiled to bytecode and imported once. A component that fails keeps no other from being built.
    """
    from robocomp_yaml.commands import _building

    if clean:
        _building.clean(ctx, components, include, type_, format_)
    _building.build(ctx, components, include, type_ or RELEASE, jobs, defines, format_)
