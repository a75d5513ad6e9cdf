"""Diagnostics and fixes as the protocol has them."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable

from lsprotocol import types
from pygls import uris

from robocomp_yaml.diag.diagnostic import ERROR, NOTE, WARNING, Diagnostic
from robocomp_yaml.diag.fix import Fix
from robocomp_yaml.diag.span import Span
from robocomp_yaml.lsp.positions import TextLines

SOURCE = "rcyaml"
_SEVERITIES = {
    ERROR: types.DiagnosticSeverity.Error,
    WARNING: types.DiagnosticSeverity.Warning,
    NOTE: types.DiagnosticSeverity.Information,
}


class Messages:
    """`lines_of` returns the lines of a file, `uri_of` its URI as the editor writes it, `version_of` the version of an
    open document."""

    def __init__(
        self, lines_of: Callable[[str], TextLines], uri_of: Callable[[str], str],
        version_of: Callable[[str], int | None],
    ) -> None:  # fmt: skip
        self._lines_of, self._uri_of, self._version_of = lines_of, uri_of, version_of

    def diagnostic(self, one: Diagnostic) -> types.Diagnostic:
        return types.Diagnostic(
            range=self._lines_of(one.span.file).range(one.span),
            message=one.message + (f"\n{one.hint}" if one.hint else ""),
            severity=_SEVERITIES[one.severity],
            code=one.code,
            source=SOURCE,
            related_information=[
                types.DiagnosticRelatedInformation(self.location(related.span), related.message)
                for related in one.related
            ],
        )

    def location(self, span: Span) -> types.Location:
        return types.Location(self._uri_of(span.file), self._lines_of(span.file).range(span))

    def actions(self, found: Iterable[Diagnostic], wanted: types.Range) -> list[types.CodeAction]:
        """The fixes of the diagnostics in a range, as quick fixes."""
        made = []
        for one in found:
            shown = self.diagnostic(one)
            if one.fixes and _touches(shown.range, wanted):
                made += [self._action(fix, shown, is_only=len(one.fixes) == 1) for fix in one.fixes]
        return made

    def _action(self, fix: Fix, shown: types.Diagnostic, *, is_only: bool) -> types.CodeAction:
        title = f"{fix.title[:1].upper()}{fix.title[1:]}"
        return types.CodeAction(
            title, types.CodeActionKind.QuickFix, [shown], is_preferred=fix.safe and is_only, edit=self.edit(fix)
        )

    def edit(self, fix: Fix) -> types.WorkspaceEdit:
        by_file: dict[str, list[types.TextEdit | types.AnnotatedTextEdit | types.SnippetTextEdit]] = {}
        for edit in fix.edits:
            where = self._lines_of(edit.span.file).range(edit.span)
            by_file.setdefault(edit.span.file, []).append(types.TextEdit(where, edit.text))
        return types.WorkspaceEdit(
            document_changes=[
                types.TextDocumentEdit(
                    types.OptionalVersionedTextDocumentIdentifier(self._uri_of(file), self._version_of(file)), edits
                )
                for file, edits in by_file.items()
            ]
        )


def _touches(one: types.Range, other: types.Range) -> bool:
    first, last = (one.start.line, one.start.character), (one.end.line, one.end.character)
    start, end = (other.start.line, other.start.character), (other.end.line, other.end.character)
    return first <= end and start <= last


def path_of(uri: str) -> str | None:
    """The path of a document; None if it is no file."""
    return uris.to_fs_path(uri) if uri.startswith("file:") else None


def real_path(uri: str) -> str | None:
    """The real path of a document; None if it is no file."""
    path = path_of(uri)
    return os.path.realpath(path) if path else None


def uri_of_path(path: str) -> str:
    return str(uris.from_fs_path(path))
