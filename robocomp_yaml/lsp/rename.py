"""Renaming in the editor: names, with a preview of what changes in code, and files, with all paths to them."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from robocomp_yaml.api.renaming import Renaming
from robocomp_yaml.diag.errors import Faulty, Refused
from robocomp_yaml.diag.span import Span
from robocomp_yaml.grouping import grouped
from robocomp_yaml.lsp.messages import real_path, uri_of_path
from robocomp_yaml.lsp.positions import TextLines
from robocomp_yaml.lsp.server import Server
from robocomp_yaml.lsp.session import EditedText, KnownNames
from robocomp_yaml.naming.names import DefinedName
from robocomp_yaml.naming.of_files import edits_of_moves, file_after
from robocomp_yaml.naming.renaming import NameEdit

_IN_DOCUMENTS, _IN_CODE, _OF_FILE = "documents", "code", "file"
_Edits = Sequence[types.TextEdit | types.AnnotatedTextEdit | types.SnippetTextEdit]
FILES = types.FileOperationRegistrationOptions([
    types.FileOperationFilter(types.FileOperationPattern("**/*", types.FileOperationPatternKind.File), "file"),
    types.FileOperationFilter(types.FileOperationPattern("**/*", types.FileOperationPatternKind.Folder), "file"),
])  # fmt: skip


class RenameRefused(JsonRpcException):
    """The editor shows the message."""

    CODE = -32803  # RequestFailed
    MESSAGE = "refused"


def add(server: Server) -> None:
    def named(
        params: types.PrepareRenameParams | types.RenameParams,
    ) -> tuple[KnownNames, tuple[Span, DefinedName] | None, EditedText] | None:
        """The names around an open document, that at a position which can get another name, and the document."""
        if (document := server.document(params.text_document)) is None:
            return None
        known = server.session.names_around(document.path)
        found = known.names.at(document.path, *server.lines(document.text).place(params.position))
        return known, found if found is not None and found[0] not in known.names.paths else None, document

    @server.answers(types.TEXT_DOCUMENT_PREPARE_RENAME)
    def prepare(params: types.PrepareRenameParams) -> types.PrepareRenamePlaceholder | None:
        match named(params):
            case _, (span, one), document:
                return types.PrepareRenamePlaceholder(server.lines(document.text).range(span), one.name)
        return None

    @server.answers(types.TEXT_DOCUMENT_RENAME, types.RenameOptions(prepare_provider=True))
    def rename(params: types.RenameParams) -> types.WorkspaceEdit | None:
        if (asked := named(params)) is None:
            return None
        known, found, document = asked
        if found is None:
            raise RenameRefused("this is not a name of the documents")
        workspace = server.session.workspace_of(document.path)
        look = workspace.living.look(workspace.root)
        try:
            made = Renaming(look, look.with_texts, [workspace.root], found[1], params.new_name, known.names)
        except (Refused, Faulty) as refused:
            raise RenameRefused(f"'{params.new_name}': {refused}") from None
        return _edit(server, made, known, _with_file(server, found[1], params.new_name))

    @server.answers(types.WORKSPACE_WILL_RENAME_FILES, FILES)
    def will_rename(params: types.RenameFilesParams) -> types.WorkspaceEdit | None:
        """The edits of all paths to files and folders that will be renamed."""
        moves = {old: new for one in params.files
                 if (old := real_path(one.old_uri)) and (new := real_path(one.new_uri)) and old != new}  # fmt: skip
        roots = {server.session.root_of(path): path for path in (*server.session.open, *moves)}
        made: dict[str, list[NameEdit]] = {}
        for path in roots.values():
            known = server.session.names_around(path)
            for edit in edits_of_moves(known.analysis, known.names, moves):
                edits = made.setdefault(os.path.realpath(edit.span.file), [])
                edits += [] if edit in edits else [edit]
        return _workspace_edit(server, made, is_annotated=False) if made else None


def _with_file(server: Server, one: DefinedName, name: str) -> tuple[str, str] | None:
    """The file that has the name, if the editor can ask whether it is renamed as well: its path now and then."""
    can = _can(server)
    kinds = can.resource_operations or () if can is not None else ()
    if can is None or can.change_annotation_support is None or types.ResourceOperationKind.Rename not in kinds:
        return None
    path = one.span.file
    new = file_after(path, one.kind, one.name, name)
    return (path, new) if new is not None and not os.path.lexists(new) else None


def _can(server: Server) -> types.WorkspaceEditClientCapabilities | None:
    workspace = server.client_capabilities.workspace
    return workspace.workspace_edit if workspace is not None else None


def _edit(server: Server, made: Renaming, known: KnownNames, file: tuple[str, str] | None) -> types.WorkspaceEdit:
    can = _can(server)
    is_annotated = can is not None and can.change_annotation_support is not None
    edit = _workspace_edit(server, _by_file(made.edits), is_annotated=is_annotated)
    if not is_annotated:
        return edit
    edit.change_annotations = {
        _IN_DOCUMENTS: types.ChangeAnnotation("Documents", description=made.what),
        _IN_CODE: types.ChangeAnnotation("Your code", needs_confirmation=True, description=made.what),
    }
    if file is not None:
        _add_file(server, edit, known, *file)
    return edit


def _add_file(server: Server, edit: types.WorkspaceEdit, known: KnownNames, old: str, new: str) -> None:
    """Adds that a file is renamed, with all paths to it, as one change that has to be confirmed."""
    moves = {os.path.realpath(old): os.path.realpath(new)}
    paths = _by_file(edits_of_moves(known.analysis, known.names, moves))
    changes = list(edit.document_changes or ())
    of_file = {one.text_document.uri: one for one in changes if isinstance(one, types.TextDocumentEdit)}
    for more in _changes(server, paths, _OF_FILE):
        if before := of_file.get(more.text_document.uri):  # all positions in one document are those before the change
            before.edits = [*before.edits, *more.edits]
        else:
            changes.append(more)
    changes.append(types.RenameFile(server.uri_of(old), uri_of_path(new), annotation_id=_OF_FILE))
    edit.document_changes = changes
    title = f"{os.path.basename(old)} → {os.path.basename(new)}, and the paths to it"
    edit.change_annotations = {
        **(edit.change_annotations or {}),
        _OF_FILE: types.ChangeAnnotation("The file", needs_confirmation=True, description=title),
    }


def _workspace_edit(
    server: Server, by_file: Mapping[str, Sequence[NameEdit]], *, is_annotated: bool
) -> types.WorkspaceEdit:  # fmt: skip
    """The edits as the editor can read them."""
    can = _can(server)
    if can is not None and can.document_changes:
        return types.WorkspaceEdit(document_changes=[*_changes(server, by_file, "" if is_annotated else None)])
    return types.WorkspaceEdit(
        changes={
            server.uri_of(path): [types.TextEdit(lines.range(one.span), one.text) for one in edits]
            for path, edits in by_file.items()
            for lines in [server.lines(server.session.text_of(path))]
        }
    )


def _by_file(edits: Iterable[NameEdit]) -> dict[str, list[NameEdit]]:
    return grouped((one.span.file, one) for one in edits)


def _changes(
    server: Server, by_file: Mapping[str, Sequence[NameEdit]], annotation: str | None
) -> list[types.TextDocumentEdit]:  # fmt: skip
    """`annotation` is that of all edits; '': that of documents or of code; None: the editor knows none."""
    return [
        types.TextDocumentEdit(
            types.OptionalVersionedTextDocumentIdentifier(server.uri_of(path), server.version_of(path)),
            _edits(server.lines(server.session.text_of(path)), edits, annotation),
        )
        for path, edits in by_file.items()
    ]


def _edits(lines: TextLines, edits: Iterable[NameEdit], annotation: str | None) -> _Edits:
    return [
        types.TextEdit(lines.range(one.span), one.text)
        if annotation is None
        else types.AnnotatedTextEdit(
            annotation or (_IN_CODE if one.is_code else _IN_DOCUMENTS), lines.range(one.span), one.text
        )
        for one in edits
    ]
