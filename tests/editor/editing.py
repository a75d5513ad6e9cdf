"""An editor: a client of the protocol that talks to a real `rcyaml lsp`, and remembers what it shows."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Coroutine, Sequence
from pathlib import Path
from typing import Any

from lsprotocol import types
from pygls import uris
from pygls.lsp.client import LanguageClient

from terminals import COMMAND, environment

WITHIN = 30  # seconds, on a busy machine


class Editor:
    """Shown diagnostics are kept by path, with the version of the document."""

    def __init__(self) -> None:
        self.client = LanguageClient("tests", "1")
        self.shown: dict[str, types.PublishDiagnosticsParams] = {}
        self.messages: list[str] = []
        self.versions: dict[str, int] = {}
        self.watched = asyncio.Event()
        self.registered: list[str] = []

        @self.client.feature(types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)
        def publish(params: types.PublishDiagnosticsParams) -> None:
            self.shown[str(uris.to_fs_path(params.uri))] = params

        @self.client.feature(types.WINDOW_SHOW_MESSAGE)
        def show(params: types.ShowMessageParams) -> None:
            self.messages.append(params.message)

        @self.client.feature(types.WINDOW_LOG_MESSAGE)
        def log(params: types.LogMessageParams) -> None:
            pass

        @self.client.feature(types.CLIENT_REGISTER_CAPABILITY)
        def register(params: types.RegistrationParams) -> None:
            self.watched.set()
            self.registered += [one.method for one in params.registrations]

    async def start(
        self,
        *folders: Path,
        command: Sequence[str] = (),
        encodings: Sequence[str] = ("utf-16",),
        schema_server: str = "yes",
        operations: Sequence[types.ResourceOperationKind] = (),
    ) -> types.InitializeResult:
        await self.client.start_io(*(command or [*COMMAND, "lsp"]), env=environment())
        capabilities = types.ClientCapabilities(
            general=types.GeneralClientCapabilities(position_encodings=[types.PositionEncodingKind(e) for e in encodings]),
            text_document=types.TextDocumentClientCapabilities(
                definition=types.DefinitionClientCapabilities(dynamic_registration=True),
                synchronization=types.TextDocumentSyncClientCapabilities(dynamic_registration=True),
                code_action=types.CodeActionClientCapabilities(dynamic_registration=True),
            ),
            workspace=types.WorkspaceClientCapabilities(
                file_operations=types.FileOperationClientCapabilities(will_rename=True, did_rename=True),
                did_change_watched_files=types.DidChangeWatchedFilesClientCapabilities(dynamic_registration=True),
                workspace_edit=types.WorkspaceEditClientCapabilities(
                    document_changes=True, change_annotation_support=types.ChangeAnnotationsSupportOptions(),
                    resource_operations=operations or None,
                ),
            ),
        )  # fmt: skip
        opened = [types.WorkspaceFolder(folder.as_uri(), folder.name) for folder in folders]
        result = await self.client.initialize_async(
            types.InitializeParams(
                capabilities, workspace_folders=opened or None, initialization_options={"schemaServer": schema_server}
            )
        )
        self.client.initialized(types.InitializedParams())
        return result

    async def stop(self) -> None:
        await self.client.shutdown_async(None)
        self.client.exit(None)
        await self.client.stop()

    def open(self, path: Path, text: str | None = None) -> None:
        self.versions[str(path)] = 1
        item = types.TextDocumentItem(
            path.as_uri(), "yaml", 1, path.read_bytes().decode() if text is None else text
        )  # fmt: skip
        self.client.text_document_did_open(types.DidOpenTextDocumentParams(item))

    def change(self, path: Path, text: str) -> None:
        self.versions[str(path)] += 1
        self.client.text_document_did_change(
            types.DidChangeTextDocumentParams(
                types.VersionedTextDocumentIdentifier(self.versions[str(path)], path.as_uri()),
                [types.TextDocumentContentChangeWholeDocument(text)],
            )
        )

    def close(self, path: Path) -> None:
        self.client.text_document_did_close(types.DidCloseTextDocumentParams(self._named(path)))

    def saved(self, path: Path) -> None:
        self.client.text_document_did_save(types.DidSaveTextDocumentParams(self._named(path)))

    def _named(self, path: Path) -> types.TextDocumentIdentifier:
        return types.TextDocumentIdentifier(path.as_uri())

    def codes(self, path: Path) -> list[str]:
        shown = self.shown.get(str(path))
        return [str(one.code) for one in shown.diagnostics] if shown else []

    async def until(self, condition: Callable[[], object], what: object = "") -> None:
        limit = time.monotonic() + WITHIN
        while not condition():
            assert time.monotonic() < limit, (what, self.shown, self.messages)
            await asyncio.sleep(0.01)

    async def until_codes(self, path: Path, *codes: str) -> list[types.Diagnostic]:
        """The diagnostics of a document, as soon as these are shown."""
        await self.until(lambda: str(path) in self.shown and self.codes(path) == [*codes], (path, codes))
        return list(self.shown[str(path)].diagnostics)

    async def rest(self) -> None:
        """Waits until everything is checked."""
        await asyncio.sleep(1)

    async def actions(self, path: Path, where: types.Range) -> list[types.CodeAction]:
        found = await self.client.text_document_code_action_async(
            types.CodeActionParams(self._named(path), where, types.CodeActionContext([]))
        )
        return [one for one in found or () if isinstance(one, types.CodeAction)]

    async def formatted(self, path: Path) -> Sequence[types.TextEdit]:
        options = types.FormattingOptions(2, True)
        return await self.client.text_document_formatting_async(types.DocumentFormattingParams(self._named(path), options)) or []  # fmt: skip


def edited(test: Callable[[Editor], Coroutine[Any, Any, None]]) -> None:
    """Runs a test with an editor, which is ended in any case."""

    async def run() -> None:
        editor = Editor()
        try:
            await asyncio.wait_for(test(editor), 4 * WITHIN)
        finally:
            await asyncio.wait_for(editor.stop(), WITHIN)

    asyncio.run(run())
