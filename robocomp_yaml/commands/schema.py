"""`rcyaml schema`: the JSON Schema of a kind of document, or which one applies to a file and how editors find it."""

from __future__ import annotations

import os
import re

import click
from click.shell_completion import CompletionItem

from robocomp_yaml.commands import _plugged
from robocomp_yaml.commands._command import Command
from robocomp_yaml.diag import terminal
from robocomp_yaml.source.regular import regular, whole

_MODELINE = re.compile(r"^#\s*yaml-language-server\s*:.*?\$schema\s*=\s*(\S+)", re.MULTILINE)


def _kinds(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """Shell completion: the kinds, else files."""
    from robocomp_yaml.link.workspace_files import GLOBS

    kinds = [CompletionItem(kind) for kind in GLOBS if kind.startswith(incomplete)]
    return kinds or [CompletionItem(incomplete, type="file")]


@click.command(cls=Command, short_help="Print the JSON Schema of a kind of document.")
@click.argument("kind", metavar="[KIND|FILE]", required=False, shell_complete=_kinds)
@click.pass_context
def command(ctx: click.Context, kind: str | None) -> None:
    """Print the JSON Schema of a KIND of document, or say which one applies to FILE; without either, list the kinds."""
    from robocomp_yaml.link.workspace_files import GLOBS, schema_of

    if kind is None:
        _list()
    elif kind in GLOBS:
        terminal.data(schema_of(kind, _plugged.here()), json=True)
    else:
        _tell(os.path.normpath(kind))


def _list() -> None:
    """The kinds, and where this workspace keeps the schema of each."""
    from robocomp_yaml.link.workspace import root_above
    from robocomp_yaml.link.workspace_files import GLOBS, schema_path

    root = root_above(".")
    for name, globs in GLOBS.items():
        installed = os.path.normpath(os.path.join(root or ".", schema_path(name)))
        terminal.say(f"{name:<10} {', '.join(globs):<28} {installed if os.path.isfile(installed) else ''}".rstrip())


def _tell(document: str) -> None:
    """Which schema applies to a document, and by what its editor finds it."""
    from robocomp_yaml.link.workspace import root_above
    from robocomp_yaml.link.workspace_files import modeline, schema_path

    kind = _kind_of(document)
    folder = os.path.dirname(document) or "."
    root = root_above(folder) or folder
    terminal.say(f"{document} has the schema '{kind}'")
    named = _named(document)
    installed = os.path.normpath(os.path.join(root, schema_path(kind)))
    if named is not None:
        terminal.say(f"editors find it by the first lines of the document: {named}")
        _tell_whether_right(kind, os.path.normpath(os.path.join(folder, named)), named, root)
    elif os.path.isfile(installed):
        terminal.say(f"editors find it by the workspace's settings: {installed}")
        _tell_whether_right(kind, installed, installed, root)
    else:
        init = f"`{terminal.typed('rcyaml', 'init', root)}`"
        terminal.say(f"editors do not find it: {init} installs it, and the document's first line would name it:")
        terminal.say(modeline(kind, document, root))


def _kind_of(document: str) -> str:
    from robocomp_yaml.diag.suggest import suggest
    from robocomp_yaml.link.workspace_files import GLOBS
    from robocomp_yaml.source.discover import WORKSPACE_FILE, kind_of

    kind = "workspace" if os.path.basename(document) == WORKSPACE_FILE else kind_of(document)
    if kind is None:
        meant = suggest(document, GLOBS)
        hint = f"did you mean '{meant}'?" if meant else f"kinds are {', '.join(GLOBS)}"
        raise click.UsageError(f"'{document}' is neither a kind nor the name of a document; {hint}")
    if not os.path.isfile(document):
        raise click.UsageError(f"there is no file '{document}'")
    return kind


def _named(document: str) -> str | None:
    """The schema that a document's modeline names."""
    try:
        with open(document, encoding="utf-8", errors="replace", opener=regular) as file:
            head = file.read(10_000)
    except OSError as error:
        raise click.UsageError(f"cannot read {document}: {error.strerror}") from error
    found = _MODELINE.search(head)
    return found[1] if found else None


def _tell_whether_right(kind: str, path: str, named: str, root: str) -> None:
    from robocomp_yaml.link.workspace_files import schema_of

    init = f"`{terminal.typed('rcyaml', 'init', root)}`"

    if "://" in named:
        return
    if not os.path.isfile(path):
        terminal.say(f"that file is missing: {init} writes it again")
    elif whole(path)[0] != schema_of(kind, _plugged.here(root)).encode("utf-8"):
        terminal.say(f"that file is not this version's schema: {init} writes it again")
