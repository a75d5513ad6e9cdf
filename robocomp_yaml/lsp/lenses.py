"""Code lenses and inlay hints: the notes of an open document, as the protocol has them."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from lsprotocol import types

from robocomp_yaml.lsp.messages import real_path
from robocomp_yaml.lsp.notes import hints_of, lens_of
from robocomp_yaml.lsp.positions import TextLines
from robocomp_yaml.lsp.server import Server
from robocomp_yaml.lsp.session import KnownNames

_Note = TypeVar("_Note")


def add(server: Server) -> None:
    async def noted(
        params: types.CodeLensParams | types.InlayHintParams, notes: Callable[[KnownNames, TextLines, str], list[_Note]]
    ) -> list[_Note]:
        """The notes in an open document of a workspace."""
        path = real_path(params.text_document.uri) or ""

        def job() -> list[_Note]:
            opened = server.session.open.get(path)
            if opened is None or not server.session.is_document(path):
                return []
            return notes(server.session.names_around(path), server.lines(opened.text), path)

        return await server.run(job)

    @server.feature(types.TEXT_DOCUMENT_CODE_LENS)
    async def lenses(params: types.CodeLensParams) -> list[types.CodeLens]:
        return await noted(params, lambda known, lines, path: [
            types.CodeLens(lines.range(one.span), types.Command(title, ""))
            for one in known.names.in_document(path)
            for title in lens_of(known, one)
        ])  # fmt: skip

    @server.feature(types.TEXT_DOCUMENT_INLAY_HINT)
    async def hints(params: types.InlayHintParams) -> list[types.InlayHint]:
        first, last = params.range.start.line + 1, params.range.end.line + 1
        return await noted(params, lambda known, lines, path: [
            types.InlayHint(lines.range(span).end, label, tooltip=more, padding_left=True)
            for span, label, more in hints_of(known, path)
            if first <= span.line <= last
        ])  # fmt: skip
