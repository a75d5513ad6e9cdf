"""`[DDSL]` on a command line, which may be left out where there is only one deployment."""

from __future__ import annotations

import os
from typing import Any

import click

from robocomp_yaml.source.discover import of_kind


class DocumentAnd(click.Argument):
    """`[DDSL]` and the words behind it, as the parameters `ddsl` and this one. A first word that is neither a document
    nor a folder with one is a word already, about the only deployment below this folder."""

    def __init__(self, declarations: list[str], most: int | None = None, metavar: str = "", **more: Any) -> None:
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
        if is_folder and (of_kind(first, "ddsl") or not of_kind(".", "ddsl")):
            return first, tuple(rest)
        if not is_folder and os.path.exists(first):
            return first, tuple(rest)
        is_path = "/" in first or first.endswith((".yaml", ".yml"))
        if self._most == 0 or is_path or not of_kind(".", "ddsl"):
            raise click.BadParameter(f"Path '{first}' does not exist.", ctx, self, "'[DDSL]'")
        return ".", words
