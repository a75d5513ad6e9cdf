"""Choices that plug-ins extend: the plug-ins of the workspaces of a command line."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

    from robocomp_yaml.diag.code import Code
    from robocomp_yaml.plugins import Plugins

_WORDS = "robocomp_yaml.words"


def remember(ctx: click.Context, words: Sequence[str]) -> None:
    """Remembers the words of a command line, before they are parsed."""
    ctx.meta[_WORDS] = tuple(words)


class PluginChoice(click.ParamType):  # type: ignore[type-arg]  # older ones are not generic
    """A choice of the names that `known` returns for the plug-ins of the workspaces of all paths on the command line;
    without a path, of the working folder. The plug-ins are resolved when the names are needed."""

    name = "choice"

    def __init__(self, known: Callable[[Plugins], Sequence[str]]) -> None:
        self._known = known

    def get_metavar(self, param: click.Parameter, ctx: click.Context) -> str:
        return f"[{'|'.join(self.choices(ctx))}]"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        choices = self.choices(ctx)
        if value not in choices:
            for path in _paths(ctx):
                plugins_at(path)  # raises Faulty if the choice may be that of a plug-in that is missing
        return str(click.Choice(choices).convert(value, param, ctx))

    def get_missing_message(self, param: click.Parameter, ctx: click.Context | None = None) -> str:
        return f"Choose from: {', '.join(self.choices(ctx))}"

    def choices(self, ctx: click.Context | None) -> list[str]:
        return list(dict.fromkeys(name for plugins in _plugins(ctx) for name in self._known(plugins)))

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        from click.shell_completion import CompletionItem

        return [CompletionItem(name) for name in self.choices(ctx) if name.startswith(incomplete)]


def plugins_at(path: str = ".") -> Plugins:
    """The plug-ins of the workspace that contains a path. Raises Faulty if one of them is missing or broken."""
    from robocomp_yaml.plugins import NONE

    if not _may_name_plugins(path):
        return NONE
    from robocomp_yaml.diag.errors import Faulty
    from robocomp_yaml.link.workspace import above

    workspace, diagnostics = above(path)
    if not workspace.plugins.whole:
        raise Faulty(diagnostics)
    return workspace.plugins


def codes(ctx: click.Context | None = None) -> dict[str, Code]:
    """The codes of the plug-ins of the command line."""
    return {id_: code for plugins in _plugins(ctx) for id_, code in plugins.codes.items()}


def _plugins(ctx: click.Context | None) -> list[Plugins]:
    from robocomp_yaml.plugins import NONE

    paths = [path for path in _paths(ctx) if _may_name_plugins(path)]
    if not paths:
        return [NONE]
    from robocomp_yaml.link.workspace import above

    return [above(path)[0].plugins for path in paths]


def _may_name_plugins(path: str) -> bool:
    """Whether the workspace of a path may name plug-ins. A quick test: reading its settings imports much."""
    from robocomp_yaml.source.discover import WORKSPACE_FILE
    from robocomp_yaml.source.regular import regular

    folder, below = os.path.abspath(path), ""
    while folder != below:
        with suppress(OSError), open(os.path.join(folder, WORKSPACE_FILE), "rb", opener=regular) as file:
            return b"plugins" in file.read()
        folder, below = os.path.dirname(folder), folder
    return False


def _paths(ctx: click.Context | None) -> list[str]:
    words = ctx.meta.get(_WORDS, ()) if ctx is not None else ()
    return [word for word in words if os.path.exists(word)] or ["."]
