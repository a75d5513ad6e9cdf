"""Renders diagnostics, with a module for each format: `render(diagnostics, documents, ...)`."""

from __future__ import annotations

import importlib
from collections.abc import Sequence

from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.diagnostic import Diagnostic

FORMATS = ("text", "json", "sarif")


def tell(
    format_: str, diagnostics: Sequence[Diagnostic], documents: int, color: bool = False, *, err: bool = False
) -> None:  # fmt: skip
    """Prints the diagnostics of a run that read that number of documents, on standard error if `err`."""
    module = importlib.import_module(f"{__name__}.{format_}")
    if format_ == "text":
        terminal.say(*module.render(diagnostics, documents, color), err=err)
    else:
        terminal.data(module.render(diagnostics, documents), json=True, err=err)
