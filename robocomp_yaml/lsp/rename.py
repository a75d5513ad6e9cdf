"""Renaming in the editor: everywhere, with a preview of what changes in code."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from robocomp_yaml.api.renaming import Renaming
from robocomp_yaml.diag.errors import Faulty, Refused
from robocomp_yaml.lsp.messages import real_path
from robocomp_yaml.lsp.positions import TextLines
from robocomp_yaml.lsp.server import Server
from robocomp_yaml.naming.renaming import NameEdit

_IN_DOCUMENTS, _IN_CODE = "documents", "code"
_Edits = Sequence[types.TextEdit | types.AnnotatedTextEdit | types.SnippetTextEdit]


class RenameRefused(JsonRpcException):
    """The editor shows the message."""

    CODE = -32803  # RequestFailed
    MESSAGE = "refused"


def add(server: Server) -> None:
    @server.feature(types.TEXT_DOCUMENT_PREPARE_RENAME)
    async def prepare(params: types.PrepareRenameParams) -> types.PrepareRenamePlaceholder | None:
        path = real_path(params.text_document.uri) or ""

        def job() -> types.PrepareRenamePlaceholder | None:
            document = server.session.open.get(path)
            if document is None or not server.session.is_document(path):
                return None
            lines = server.lines(document.text)
            known = server.session.names_around(path)
            found = known.names.at(path, *lines.place(params.position))
            if found is None or found[0] in known.names.paths:
                return None
            return types.PrepareRenamePlaceholder(lines.range(found[0]), found[1].name)

        return await server.run(job)

    @server.feature(types.TEXT_DOCUMENT_RENAME, types.RenameOptions(prepare_provider=True))
    async def rename(params: types.RenameParams) -> types.WorkspaceEdit | None:
        path = real_path(params.text_document.uri) or ""

        def job() -> types.WorkspaceEdit | None:
            document = server.session.open.get(path)
            if document is None or not server.session.is_document(path):
                return None
            place = server.lines(document.text).place(params.position)
            known = server.session.names_around(path)
            found = known.names.at(path, *place)
            if found is None or found[0] in known.names.paths:
                raise RenameRefused("this is not a name of the documents")
            workspace = server.session.workspace_of(path)
            look = workspace.living.look(workspace.root)
            try:
                made = Renaming(look, look.with_texts, [workspace.root], found[1], params.new_name, known.names)
            except (Refused, Faulty) as refused:
                raise RenameRefused(f"'{params.new_name}': {refused}") from None
            return _edit(server, made, {one.path: one.before.decode("utf-8-sig", "replace") for one in made.written})

        return await server.run(job)


def _edit(server: Server, made: Renaming, texts: dict[str, str]) -> types.WorkspaceEdit:
    workspace = server.client_capabilities.workspace
    can = workspace.workspace_edit if workspace is not None else None
    is_annotated = can is not None and can.change_annotation_support is not None
    by_file: dict[str, list[NameEdit]] = {}
    for one in made.edits:
        by_file.setdefault(one.span.file, []).append(one)
    if can is None or not can.document_changes:
        return types.WorkspaceEdit(
            changes={
                server.uri_of(path): [one for one in _edits(server.lines(texts[path]), edits, is_annotated=False)
                                      if isinstance(one, types.TextEdit)]
                for path, edits in by_file.items()
            }
        )  # fmt: skip
    changes = [
        types.TextDocumentEdit(
            types.OptionalVersionedTextDocumentIdentifier(server.uri_of(path), server.version_of(path)),
            _edits(server.lines(texts[path]), edits, is_annotated=is_annotated),
        )
        for path, edits in by_file.items()
    ]
    annotations = {
        _IN_DOCUMENTS: types.ChangeAnnotation("Documents", description=made.what),
        _IN_CODE: types.ChangeAnnotation("Your code", needs_confirmation=True, description=made.what),
    }
    return types.WorkspaceEdit(document_changes=changes, change_annotations=annotations if is_annotated else None)


def _edits(lines: TextLines, edits: Iterable[NameEdit], *, is_annotated: bool) -> _Edits:
    return [
        types.AnnotatedTextEdit(_IN_CODE if one.is_code else _IN_DOCUMENTS, lines.range(one.span), one.text)
        if is_annotated
        else types.TextEdit(lines.range(one.span), one.text)
        for one in edits
    ]
