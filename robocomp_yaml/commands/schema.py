"""`rcyaml schema`: prints the JSON Schema of a kind of document, or which schema applies to a document and how editors
find it."""

from __future__ import annotations

import os

import click
from click.shell_completion import CompletionItem

from robocomp_yaml.commands import _plugin_choices
from robocomp_yaml.commands._command import LibraryCommand
from robocomp_yaml.diag import terminal


def _kinds(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """Shell completion: the kinds, else files."""
    from robocomp_yaml.link.workspace_files import GLOBS

    kinds = [CompletionItem(kind) for kind in GLOBS if kind.startswith(incomplete)]
    return kinds or [CompletionItem(incomplete, type="file")]


@click.command(cls=LibraryCommand, short_help="Print the JSON Schema of a kind of document.")
@click.argument("kind", metavar="[KIND|FILE]", required=False, shell_complete=_kinds)
@click.pass_context
def command(ctx: click.Context, kind: str | None) -> None:
    """Print the JSON Schema of a KIND of document, or which schema applies to FILE; without an argument, list the
    kinds."""
    from robocomp_yaml.link.workspace_files import GLOBS
    from robocomp_yaml.source.schema_text import MARKED, schema_text

    if kind is None:
        _print_kinds()
    elif kind in GLOBS:
        languages = _plugin_choices.plugins_at().languages if kind in MARKED else ()
        terminal.data(schema_text(kind, languages), json=True)
    else:
        _print_schema_of(os.path.normpath(kind))


def _print_kinds() -> None:
    """Prints the kinds, and the path of each schema in this workspace."""
    from robocomp_yaml.api.schemas import installed
    from robocomp_yaml.link.workspace import root_above
    from robocomp_yaml.link.workspace_files import GLOBS

    paths = installed(root_above(".") or ".")
    width = max(len(", ".join(globs)) for globs in GLOBS.values())
    for name, globs in GLOBS.items():
        terminal.say(f"{name:<9}  {', '.join(globs):<{width}}  {paths[name]}".rstrip())


def _print_schema_of(document: str) -> None:
    """Prints which schema applies to a document, and how editors find it."""
    from robocomp_yaml.api.schemas import schema_for

    schema = schema_for(document)
    init = f"`{terminal.typed('rcyaml', 'init', schema.root)}`"
    terminal.say(f"the schema of {document} is '{schema.kind}'")
    if schema.named:
        terminal.say(f"editors find it by the first lines of the document: {schema.named}")
    elif schema.path:
        terminal.say(f"editors find it by the settings of the workspace: {schema.path}")
    else:
        terminal.say(f"editors do not find it: {init} installs it, or write this as the first line of the document:")
        terminal.say(schema.modeline)
    if schema.is_missing:
        terminal.say(f"the file of the schema is missing: {init} writes it")
    elif schema.path and schema.is_outdated(_plugin_choices.plugins_at(schema.root)):
        terminal.say(f"the file of the schema is outdated: {init} writes it")
