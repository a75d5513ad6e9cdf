"""Code lenses and inlay hints: the notes of an open document, as the protocol has them."""

from __future__ import annotations

from lsprotocol import types

from robocomp_yaml.lsp.notes import hints_of, lens_of
from robocomp_yaml.lsp.server import Server


def add(server: Server) -> None:
    @server.answers(types.TEXT_DOCUMENT_CODE_LENS)
    def lenses(params: types.CodeLensParams) -> list[types.CodeLens]:
        if (document := server.document(params.text_document)) is None:
            return []
        known, lines = server.session.names_around(document.path), server.lines(document.text)
        return [
            types.CodeLens(lines.range(one.span), types.Command(title, ""))
            for one in known.names.in_document(document.path)
            for title in lens_of(known, one)
        ]

    @server.answers(types.TEXT_DOCUMENT_INLAY_HINT)
    def hints(params: types.InlayHintParams) -> list[types.InlayHint]:
        if (document := server.document(params.text_document)) is None:
            return []
        known, lines = server.session.names_around(document.path), server.lines(document.text)
        first, last = params.range.start.line + 1, params.range.end.line + 1
        return [
            types.InlayHint(lines.range(span).end, label, tooltip=more, padding_left=True)
            for span, label, more in hints_of(known, document.path)
            if first <= span.line <= last
        ]
