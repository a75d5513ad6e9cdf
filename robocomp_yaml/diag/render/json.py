"""Diagnostics as JSON, for tools."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.fix import Fix
from robocomp_yaml.diag.span import Span


def as_data(diagnostic: Diagnostic) -> dict[str, object]:
    """One diagnostic as JSON's types; `more` is omitted if it is empty."""
    data: dict[str, object] = {
        "code": diagnostic.code,
        "severity": diagnostic.severity,
        "message": diagnostic.message,
        "hint": diagnostic.hint,
        **_place(diagnostic.span),
        "related": [{"message": related.message, **_place(related.span)} for related in diagnostic.related],
        "facts": dict(diagnostic.facts),
        "fixes": [fix_as_data(fix) for fix in diagnostic.fixes if fix.is_spelled],
    }
    return {**data, "more": diagnostic.more} if diagnostic.more else data


def fix_as_data(fix: Fix) -> dict[str, object]:
    """A fix as JSON's types."""
    edits = [{**_place(edit.span), "text": edit.text} for edit in fix.edits]
    return {"title": fix.title, "safe": fix.safe, "edits": edits}


def _place(span: Span) -> dict[str, object]:
    return {
        "file": span.file,
        "line": span.line,
        "column": span.column,
        "end_line": span.end_line,
        "end_column": span.end_column,
    }


def render(diagnostics: Sequence[Diagnostic], documents: int) -> str:
    return dumps(run_as_data(diagnostics, documents))


def run_as_data(diagnostics: Sequence[Diagnostic], documents: int) -> dict[str, object]:
    return {"diagnostics": [as_data(diagnostic) for diagnostic in diagnostics], "documents": documents}


def dumps(data: object, indent: int | None = 2) -> str:
    """JSON as UTF-8; bytes in file names that are not UTF-8 are escaped."""
    import json  # most runs print none

    return json.dumps(data, indent=indent, ensure_ascii=False).encode("utf-8", "backslashreplace").decode() + "\n"


def plain(data: Any) -> Any:
    """Data that JSON can spell: numbers that are infinite or none are texts, as in Protobuf's JSON, and so are bytes of
    names that are not UTF-8."""
    if isinstance(data, str):
        return data.encode("utf-8", "backslashreplace").decode()
    if isinstance(data, Mapping):
        return {plain(key): plain(value) for key, value in data.items()}
    if isinstance(data, (list, tuple)):
        return [plain(item) for item in data]
    if isinstance(data, float) and not math.isfinite(data):
        return "NaN" if math.isnan(data) else "Infinity" if data > 0 else "-Infinity"
    return data
