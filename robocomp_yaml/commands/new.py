"""`rcyaml new interface|component|parameters|deployment`: writes a new document, where the workspace keeps its kind. A
folder without a workspace becomes one."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import click

from robocomp_yaml import languages
from robocomp_yaml.commands import _options
from robocomp_yaml.commands._command import CommandGroup
from robocomp_yaml.commands._plugin_choices import PluginChoice
from robocomp_yaml.diag import terminal

if TYPE_CHECKING:
    from robocomp_yaml.api.new.documents import NewDocument
    from robocomp_yaml.plugins import Plugins


@click.group(cls=CommandGroup, short_help="Write a new document of any kind.")
def command() -> None:
    """Write a new document that checks and compiles, with comments that explain it.

    It is written where the workspace keeps its kind. A folder that belongs to no workspace becomes one.
    """


@command.command(short_help="Write new interface documents.")
@click.argument("names", nargs=-1, required=True, metavar="NAME...")
@_options.text_or_json
@click.pass_context
def interface(ctx: click.Context, names: tuple[str, ...], format_: str) -> None:
    """Write interfaces/NAME.idsl.yaml: a module with an interface NAME. Several NAMEs make several documents."""
    from robocomp_yaml.api.new.documents import interface_document

    _create(ctx, format_, lambda root: [interface_document(root, name) for name in dict.fromkeys(names)])


def _names(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Shell completion: the interfaces that the workspace defines."""
    from robocomp_yaml.api.new.imports import interfaces_of
    from robocomp_yaml.link.workspace import root_above

    root = root_above(".")
    return [name for name in interfaces_of(root) if name.startswith(incomplete)] if root else []


def languages_with(plugins: Plugins) -> list[str]:
    """The languages of components: the built-in ones, and those of plug-ins."""
    return [*languages.table(), *(one.name for one in plugins.languages)]


def _uses(name: str, meaning: str, metavar: str = "INTERFACE") -> Callable[[Any], Any]:
    return click.option(
        f"--{name}", multiple=True, metavar=metavar, shell_complete=_names, help=f"The {meaning}; may be repeated."
    )


@command.command(short_help="Write a new component document.")
@click.argument("name")
@click.option("--language", type=PluginChoice(languages_with), default=languages.DEFAULT, show_default=True,
              help="The language of its code.")  # fmt: skip
@_uses("implements", "interfaces that it serves")
@_uses("requires", "interfaces of others that it calls")
@_uses("publishes", "topics that it publishes", "TOPIC")
@_uses("subscribes", "topics that it receives", "TOPIC")
@_options.reading
def component(
    ctx: click.Context, /, name: str, language: str, include: tuple[str, ...], format_: str, **uses: tuple[str, ...]
) -> None:  # fmt: skip
    """Write components/NAME/NAME.cdsl.yaml (in lower case): a component NAME.

    INTERFACE and TOPIC are names that a document of the workspace defines, or Module.NAME if several documents define
    NAME.
    """
    from robocomp_yaml.api.new.documents import component_document

    _create(ctx, format_, lambda root: [component_document(root, name, language, uses, include)])


@command.command(short_help="Write a new parameters document of a component.")
@click.argument("name")
@_options.text_or_json
@click.pass_context
def parameters(ctx: click.Context, name: str, format_: str) -> None:
    """Write the parameters document of the component NAME, beside the component's document."""
    from robocomp_yaml.api.new.documents import parameters_document

    _create(ctx, format_, lambda root: [parameters_document(root, name)])


@command.command(short_help="Write a new deployment document.")
@click.argument("name")
@_options.text_or_json
@click.pass_context
def deployment(ctx: click.Context, name: str, format_: str) -> None:
    """Write deployments/NAME.ddsl.yaml (in lower case): the components of the workspace, on this machine."""
    from robocomp_yaml.api.new.deployment import deployment_document

    _create(ctx, format_, lambda root: [deployment_document(root, name)], "deploy plan")


def _create(
    ctx: click.Context, format_: str, make: Callable[[str], list[NewDocument]], next_: str = "compile"
) -> None:  # fmt: skip
    from robocomp_yaml.api.new import workspace

    report = _options.FileReport(ctx, format_)
    with report.writing():
        paths = workspace.create(make, report.add)
    report.end(terminal.typed("rcyaml", *next_.split(), *paths))
