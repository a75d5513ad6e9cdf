"""Which deployment a command is about: the one that is named, else the only one that there is."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import click

from robocomp_yaml.source.discover import documents_below, kind_of

if TYPE_CHECKING:
    from robocomp_yaml.pipeline import Analysis


class DocumentAnd(click.Argument):
    """`[DDSL]` and the words behind it, as the parameters `ddsl` and this one. A first word that is neither a document
    nor a folder with one is a word already, about the only deployment below this folder."""

    def __init__(self, declarations: list[str], most: int | None = None, metavar: str = "", **more: object) -> None:
        self._most = most
        super().__init__(declarations, nargs=-1, type=click.Path(), metavar=f"[DDSL] {metavar}".rstrip(), **more)

    def process_value(self, ctx: click.Context, value: object) -> tuple[str, ...]:
        words: tuple[str, ...] = super().process_value(ctx, value) or ()
        ctx.params["ddsl"], rest = self._split(ctx, words)
        if self._most is not None and len(rest) > self._most:
            extra = rest[self._most :]
            raise click.UsageError(f"Got unexpected extra argument{'s' * (len(extra) > 1)} ({' '.join(extra)})", ctx)
        return rest

    def _split(self, ctx: click.Context, words: tuple[str, ...]) -> tuple[str, tuple[str, ...]]:
        if not words:
            return ".", ()
        first, *rest = words
        is_folder = os.path.isdir(first)
        if is_folder and (_below(first) or not _below(".")):
            return first, tuple(rest)
        if not is_folder and os.path.exists(first):
            return first, tuple(rest)
        is_path = "/" in first or first.endswith((".yaml", ".yml"))
        if self._most == 0 or is_path or not _below("."):
            raise click.BadParameter(f"Path '{first}' does not exist.", ctx, self, "'[DDSL]'")
        return ".", words


def document(path: str, include: tuple[str, ...]) -> str:
    """The deployment's document that a path means. Ends the command where a folder has none, or several."""
    if not os.path.isdir(path):
        return path
    found = deployments_of(path, include)
    if not found:
        raise click.UsageError(
            f"'{path}' is to have a deployment document; it has none: `rcyaml new deployment NAME` writes one"
        )
    return one_of(found)


def one_of(found: list[str]) -> str:
    if len(found) > 1:
        names = ", ".join(sorted(found))
        raise click.UsageError(f"there are several deployments here, of which one is to be named: {names}")
    return found[0]


def deployments_of(folder: str, include: tuple[str, ...] = (), analysis: Analysis | None = None) -> list[str]:
    """The deployments of a folder, else those below it; those that others include are parts of these. `analysis` is of
    the folder, where there is one."""
    below, here = _below(folder), os.path.normpath(folder)
    found = [path for path in below if (os.path.dirname(path) or ".") == here] or below
    if len(found) < 2:
        return found
    if analysis is None:
        from robocomp_yaml.pipeline import analyse

        analysis = analyse(found, include)
    parts = {real for real, linked in analysis.program.deployments.items() if linked.is_included}
    return [path for path in found if os.path.realpath(path) not in parts] or found


def _below(folder: str) -> list[str]:
    return [os.path.normpath(path) for path in documents_below(folder) if kind_of(path) == "ddsl"]
