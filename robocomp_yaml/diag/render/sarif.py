"""Diagnostics as SARIF 2.1.0 (OASIS), which code hosts and editors read."""

from __future__ import annotations

import os
from collections.abc import Sequence
from urllib.parse import quote

from robocomp_yaml import __version__
from robocomp_yaml.diag.codes import row_of
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.fix import Fix
from robocomp_yaml.diag.render.json import dumps
from robocomp_yaml.diag.span import Span

_SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"


def render(diagnostics: Sequence[Diagnostic], documents: int) -> str:
    ids = sorted({diagnostic.code for diagnostic in diagnostics})
    rules = [
        {"id": row.id, "fullDescription": {"text": row.why}, "defaultConfiguration": {"level": row.severity}}
        for row in map(row_of, ids)
    ]
    driver = {"name": "rcyaml", "version": __version__, "rules": rules}
    run = {
        "tool": {"driver": driver},
        "columnKind": "unicodeCodePoints",
        "results": [_result(diagnostic, ids) for diagnostic in diagnostics],
    }
    return dumps({"$schema": _SCHEMA, "version": "2.1.0", "runs": [run]})


def _result(diagnostic: Diagnostic, ids: list[str]) -> dict[str, object]:
    text = f"{diagnostic.message} ({diagnostic.hint})" if diagnostic.hint else diagnostic.message
    result: dict[str, object] = {
        "ruleId": diagnostic.code,
        "ruleIndex": ids.index(diagnostic.code),
        "level": diagnostic.severity,
        "message": {"text": text},
        "locations": [_location(diagnostic.span)],
    }
    if diagnostic.related:
        result["relatedLocations"] = [
            {**_location(related.span), "message": {"text": related.message}} for related in diagnostic.related
        ]
    if fixes := [_fix(fix) for fix in diagnostic.fixes if fix.is_spelled]:
        result["fixes"] = fixes
    return result


def _fix(fix: Fix) -> dict[str, object]:
    by_file: dict[str, list[dict[str, object]]] = {}
    for edit in fix.edits:
        replacement = {"deletedRegion": _region(edit.span), "insertedContent": {"text": edit.text}}
        by_file.setdefault(edit.span.file, []).append(replacement)
    changes = [{"artifactLocation": _artifact(file), "replacements": edits} for file, edits in by_file.items()]
    return {"description": {"text": fix.title}, "artifactChanges": changes}


def _location(span: Span) -> dict[str, object]:
    return {"physicalLocation": {"artifactLocation": _artifact(span.file), "region": _region(span)}}


def _artifact(file: str) -> dict[str, object]:
    return {"uri": quote(os.fsencode(file))}


def _region(span: Span) -> dict[str, object]:
    return {"startLine": span.line, "startColumn": span.column, "endLine": span.end_line, "endColumn": span.end_column}
