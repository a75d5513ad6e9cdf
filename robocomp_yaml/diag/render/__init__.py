"""Renders diagnostics, with a module for each format: `render(diagnostics, documents, ...)`."""

from __future__ import annotations

import importlib
from collections.abc import Mapping, Sequence

from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.diagnostic import Diagnostic

FORMATS = ("text", "json", "sarif")


def tell(
    format_: str, diagnostics: Sequence[Diagnostic], documents: int | None, color: bool = False, *, err: bool = False,
    texts: Mapping[str, str] | None = None,
) -> None:  # fmt: skip
    """Prints the diagnostics of a run that read that number of documents, on standard error if `err`. `texts` are those
    of locations that are in no file."""
    module = importlib.import_module(f"{__name__}.{format_}")
    if format_ == "text":
        terminal.say(*module.render(diagnostics, documents, color, texts), err=err)
    else:
        terminal.data(module.render(diagnostics, documents or 0), json=True, err=err)
