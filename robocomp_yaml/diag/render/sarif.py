"""Diagnostics as SARIF 2.1.0 (OASIS), which code hosts and editors read."""

from __future__ import annotations

import os
from collections.abc import Sequence
from urllib.parse import quote

from robocomp_yaml import __version__
from robocomp_yaml.diag.codes import table
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.render.json import dumps
from robocomp_yaml.diag.span import Span

_SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"


def render(diagnostics: Sequence[Diagnostic], documents: int) -> str:
    ids = sorted({diagnostic.code for diagnostic in diagnostics})
    rules = [
        {"id": row.id, "fullDescription": {"text": row.why}, "defaultConfiguration": {"level": row.severity}}
        for row in (table()[id_] for id_ in ids)
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
    return result


def _location(span: Span) -> dict[str, object]:
    region = {
        "startLine": span.line, "startColumn": span.column, "endLine": span.end_line, "endColumn": span.end_column,
    }  # fmt: skip
    return {"physicalLocation": {"artifactLocation": {"uri": quote(os.fsencode(span.file))}, "region": region}}
