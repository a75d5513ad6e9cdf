"""What the server does with the messages of an editor. A module with a feature of its own adds it by `add`."""

from __future__ import annotations

from collections.abc import Iterable

from lsprotocol import types

from robocomp_yaml.lsp import commands, completion, lenses, navigation, rename
from robocomp_yaml.lsp.messages import real_path
from robocomp_yaml.lsp.more_fixes import MORE, with_more
from robocomp_yaml.lsp.server import Server, folders_of, of_code, watchers
from robocomp_yaml.lsp.session import EditedText


def make(include: Iterable[str] = ()) -> Server:
    """A server that knows all messages."""
    server, include = Server(), tuple(include)

    @server.feature(types.INITIALIZE)
    def begin(params: types.InitializeParams) -> None:
        server.begin(folders_of(params), include)
        server.configure(params.initialization_options)

    @server.feature(types.INITIALIZED)
    async def watch(params: types.InitializedParams) -> None:
        capabilities = server.client_capabilities.workspace
        files = capabilities.did_change_watched_files if capabilities else None
        if files is not None and files.dynamic_registration:
            method = types.WORKSPACE_DID_CHANGE_WATCHED_FILES
            registration = types.Registration("rcyaml-files", method, watchers())
            await server.client_register_capability_async(types.RegistrationParams([registration]))
        if made := list(of_code(server.client_capabilities)):
            await server.client_register_capability_async(types.RegistrationParams(made))

    @server.feature(types.TEXT_DOCUMENT_DID_OPEN)
    async def opened(params: types.DidOpenTextDocumentParams) -> None:
        item = params.text_document
        if path := real_path(item.uri):
            await server.edited(EditedText(item.uri, path, item.text, item.version))

    @server.feature(types.TEXT_DOCUMENT_DID_CHANGE)
    async def changed(params: types.DidChangeTextDocumentParams) -> None:
        item = params.text_document
        if params.content_changes and (path := real_path(item.uri)):
            await server.edited(EditedText(item.uri, path, params.content_changes[-1].text, item.version))

    @server.feature(types.TEXT_DOCUMENT_DID_CLOSE)
    async def closed(params: types.DidCloseTextDocumentParams) -> None:
        if path := real_path(params.text_document.uri):
            await server.closed(path)

    @server.feature(types.TEXT_DOCUMENT_DID_SAVE)
    async def saved(params: types.DidSaveTextDocumentParams) -> None:
        await server.saved()

    @server.feature(types.WORKSPACE_DID_CHANGE_WATCHED_FILES)
    async def files_changed(params: types.DidChangeWatchedFilesParams) -> None:
        await server.saved()

    @server.feature(types.WORKSPACE_DID_RENAME_FILES, rename.FILES)
    async def files_renamed(params: types.RenameFilesParams) -> None:
        await server.saved()

    @server.feature(types.WORKSPACE_DID_CHANGE_CONFIGURATION)
    async def configured(params: types.DidChangeConfigurationParams) -> None:
        server.configure(params.settings)
        await server.saved()

    @server.feature(types.WORKSPACE_DID_CHANGE_WORKSPACE_FOLDERS)
    async def folders_changed(params: types.DidChangeWorkspaceFoldersParams) -> None:
        added = [path for one in params.event.added if (path := real_path(one.uri))]
        removed = {path for one in params.event.removed if (path := real_path(one.uri))}

        def change() -> None:
            server.session.folders[:] = [*(one for one in server.session.folders if one not in removed), *added]

        await server.run(change)
        await server.saved()

    @server.answers(
        types.TEXT_DOCUMENT_CODE_ACTION,
        types.CodeActionOptions(code_action_kinds=[types.CodeActionKind.QuickFix, commands.SOURCE]),
    )
    def actions(params: types.CodeActionParams) -> list[types.CodeAction]:
        path, only = real_path(params.text_document.uri) or "", params.context.only
        made: list[types.CodeAction] = []
        is_asked = only is None or any("quickfix".startswith(one) for one in only)
        if path in server.session.code:
            found, texts = server.session.of_code(path)
            return server.messages(texts).actions(found, params.range) if is_asked else []
        if path not in server.session.open:
            return []
        if is_asked:
            found, texts = server.session.of_document(path)
            if any(one.code in MORE for one in found):
                known = server.session.names_around(path)
                found, texts = with_more(found, known), known.texts
            made += server.messages(texts).actions(found, params.range)
        if only is not None and any(commands.SOURCE.value.startswith(one) for one in only):
            made += commands.actions(params.text_document.uri) if server.session.is_document(path) else []
        return made

    @server.answers(types.TEXT_DOCUMENT_FORMATTING)
    def formatted(params: types.DocumentFormattingParams) -> list[types.TextEdit]:
        from robocomp_yaml.api.formatting import layout

        if (document := server.document(params.text_document)) is None:
            return []  # such as another program's YAML
        after = layout(document.path, document.raw)[0]
        if not isinstance(after, bytes) or after == document.raw:
            return []  # a broken document stays as it is
        whole = types.Range(types.Position(0, 0), server.lines(document.text).end())
        return [types.TextEdit(whole, after.decode())]

    navigation.add(server)
    completion.add(server)
    rename.add(server)
    commands.add(server)
    lenses.add(server)
    return server
