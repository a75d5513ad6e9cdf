"""How diagnostics are shown, one module a format: `render(diagnostics, documents, color) -> str`."""

from __future__ import annotations

import importlib
from collections.abc import Sequence

from robocomp_yaml.diag.diagnostic import Diagnostic

FORMATS = ("text", "json", "sarif")


def render(format_: str, diagnostics: Sequence[Diagnostic], documents: int, color: bool = False) -> str:
    """What is printed for a run that looked at so many documents; ends in a newline unless empty."""
    text: str = importlib.import_module(f"{__name__}.{format_}").render(diagnostics, documents, color)
    return text
