"""`rcyaml lsp`: the language server over the protocol.

All analyses run in one thread, one after the other, so that the server answers meanwhile. There are two stages: the
edited document and all that it names, at once; its workspace, when typing rests. The second stage is given up as soon
as anything else is to be done.
"""

from __future__ import annotations

import asyncio
import gc
import logging
import traceback
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Any, BinaryIO, TypeVar

from lsprotocol import types
from pygls.lsp.server import LanguageServer

from robocomp_yaml import __version__
from robocomp_yaml.diag.codes import files as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.lsp.messages import SOURCE, Messages, path_of, real_path, uri_of_path
from robocomp_yaml.lsp.positions import UTF16, TextLines
from robocomp_yaml.lsp.session import Cancelled, EditedText, Session
from robocomp_yaml.source.spelled import DocumentTexts

AUTO, YES, NO = "auto", "yes", "no"
AT_ONCE, AT_REST = 0.02, 0.25  # seconds after the last key
MANY_JOBS = 300  # after so many, garbage is collected
_CODE, _SOURCES = "**/{src,generated}/**/*.{py,pyi,cpp,h,hpp,java}", "**/src/**/*.{py,cpp,h,hpp,java}"
_SLICE, _MACHINE = "**/*.ice", "**/*.scxml"
_WATCHED = "**/*"
SHAPE = frozenset(
    code.id for code in (codes.UNKNOWN_KEY, codes.MISSING_KEY, codes.WRONG_SHAPE, codes.NOT_A_MAPPING, codes.WRONG_NAME)
)
"""What a server of schemas tells, too."""
_Made = TypeVar("_Made")
Versions = dict[str, int | None]


class Server(LanguageServer):
    """The server with its session. `session` is used only in the thread of analyses, but for the texts of code."""

    def __init__(self) -> None:
        super().__init__(SOURCE, __version__, types.TextDocumentSyncKind.Full)
        self.session = Session()
        self._worker = ThreadPoolExecutor(1, "analysis")
        self._jobs = self._collected = 0
        gc.disable()  # `_collect` does it
        self._at_once: dict[str, asyncio.TimerHandle] = {}
        self._at_rest: dict[str, asyncio.TimerHandle] = {}
        self._shown: dict[str, str] = {}  # the URIs with diagnostics, by path
        self.schema_server = AUTO

    def start_io(self, stdin: BinaryIO | None = None, stdout: BinaryIO | None = None) -> None:
        """Serves an editor until it ends the session. The protocol tells it all errors. They are not logged to the
        standard error as well: where an editor does not read it, its pipe would be full after some fifty refused
        requests, and the server would wait for ever."""
        logging.getLogger().addHandler(logging.NullHandler())
        super().start_io(stdin, stdout)

    async def run(self, job: Callable[[], _Made]) -> _Made:
        """The result of a job in the thread of analyses. The analysis of a workspace that runs there is given up."""
        self._jobs += 1
        if self._jobs - self._collected > MANY_JOBS:  # typing never rests
            await asyncio.get_running_loop().run_in_executor(self._worker, self._collect)
        return await asyncio.get_running_loop().run_in_executor(self._worker, job)

    def answers(self, method: str, options: object = None) -> Callable[[Callable[[Any], object]], None]:
        """A function with this decorator answers a message, in the thread of analyses."""

        def register(answer: Callable[[Any], object]) -> None:
            @self.feature(method, options)
            async def asked(params: Any) -> Any:
                return await self.run(partial(answer, params))

        return register

    def document(self, named: types.TextDocumentIdentifier) -> EditedText | None:
        """The document that a message means, if it is open and one of rcyaml's."""
        document = self.session.open.get(real_path(named.uri) or "")
        return document if document is not None and self.session.is_document(document.path) else None

    def _collect(self) -> None:
        """Collects garbage, which otherwise would be done in the middle of an analysis: all that it makes is young."""
        gc.collect()
        self._collected = self._jobs

    # Documents

    def begin(self, folders: Iterable[str], include: Iterable[str]) -> None:
        self.session = Session(folders, include)

    def configure(self, options: object) -> None:
        """Options of the editor: `schemaServer` says whether a server of JSON Schemas reads the same documents."""
        if isinstance(options, dict):
            inner = options.get("rcyaml")
            options = inner if isinstance(inner, dict) else options
            value = options.get("schemaServer", options.get("schema_server"))
        else:
            value = getattr(options, "schemaServer", None)
        if value in (AUTO, YES, NO):
            self.schema_server = value

    def has_schema_server(self, path: str) -> bool:
        """Whether another server tells what the schema says of a document. AUTO: if the document or the workspace is
        made for one."""
        if self.schema_server != AUTO:
            return self.schema_server == YES
        return self.session.is_for_schema_server(path)

    async def edited(self, document: EditedText) -> None:
        """A document, or a file of the user's code, was opened or changed."""
        if is_code(document.path):
            await self.run(lambda: self.session.edit_code(document))
            await self._check_later()
            return
        await self.run(lambda: self.session.edit(document))
        self._later(self._at_once, document.path, AT_ONCE, self._check_document)
        await self._check_later()

    async def closed(self, path: str) -> None:
        close = self.session.close_code if is_code(path) else self.session.close
        gone = await self.run(lambda: close(path))
        for one in gone:
            self._publish(one, [], DocumentTexts({}, {}), {})
        await self._check_later()

    async def saved(self) -> None:
        """Files may have changed on the disk."""
        await self.run(self.session.refresh)
        await self._check_later()

    async def _check_later(self) -> None:
        for root in await self.run(self.session.roots):
            self._later(self._at_rest, root, AT_REST, self._check_workspace)

    def _later(
        self, timers: dict[str, asyncio.TimerHandle], path: str, seconds: float, check: Callable[[str], Any]
    ) -> None:
        if path in timers:
            timers[path].cancel()
        loop = asyncio.get_running_loop()
        timers[path] = loop.call_later(seconds, lambda: loop.create_task(self._guarded(check, path)))

    async def _guarded(self, check: Callable[[str], Any], path: str) -> None:
        """A check that fails is reported, and the server continues."""
        try:
            await check(path)
        except Exception as error:  # noqa: BLE001 (whatever is wrong with one document, the others are checked)
            self.failed(f"cannot check {path}", error)

    def failed(self, what: str, error: BaseException) -> None:
        reason = f"{type(error).__name__}: {error}"
        self.window_show_message(types.ShowMessageParams(types.MessageType.Error, f"rcyaml: {what}: {reason}"))
        text = "".join(traceback.format_exception(error))
        self.window_log_message(types.LogMessageParams(types.MessageType.Error, text))

    # Diagnostics

    async def _check_document(self, path: str) -> None:
        def check() -> tuple[list[Diagnostic], DocumentTexts, Versions] | None:
            if path not in self.session.open or not self.session.is_checked(path):
                return None
            return *self.session.of_document(path), self.session.versions()

        made = await self.run(check)
        if made is not None and made[2].get(path) == self.session.versions().get(path):
            self._publish(path, *made)

    async def _check_workspace(self, root: str) -> None:
        """Checks a workspace. If anything else is to be done meanwhile, this begins again later."""
        jobs = self._jobs

        def check() -> tuple[dict[str, list[Diagnostic]], DocumentTexts, Versions] | None:
            if root not in self.session.roots():
                return None
            workspace = self.session.workspace_of_root(root)
            is_first = not workspace.is_known
            found = self.session.of_workspace(root, lambda: self._jobs != jobs)
            self._collect()
            if is_first:
                gc.freeze()  # the collector need not visit the kept documents
            return found, workspace.texts, self.session.versions()

        try:
            made = await asyncio.get_running_loop().run_in_executor(self._worker, check)
        except Cancelled:
            self._later(self._at_rest, root, AT_REST, self._check_workspace)
            return
        if made is None:
            return
        found, texts, versions = made
        if versions != self.session.versions():  # an edit came in between, after which this begins again
            return
        for file, diagnostics in found.items():
            self._publish(file, diagnostics, texts, versions)

    def _publish(
        self, path: str, diagnostics: Iterable[Diagnostic], texts: DocumentTexts, versions: Versions
    ) -> None:  # fmt: skip
        """Shows the diagnostics of a document, or that it has none."""
        messages = self.messages(texts)
        is_told = self.has_schema_server(path)
        shown = [messages.diagnostic(one) for one in diagnostics if not (is_told and one.code in SHAPE)]
        if not shown and path not in self._shown and path not in self.session.open:
            return
        uri = self._shown.get(path) or self.uri_of(path)
        if shown:
            self._shown[path] = uri
        else:
            self._shown.pop(path, None)
        self.text_document_publish_diagnostics(types.PublishDiagnosticsParams(uri, shown, versions.get(path)))

    def messages(self, texts: DocumentTexts) -> Messages:
        known: dict[str, TextLines] = {}

        def lines_of(path: str) -> TextLines:
            if path not in known:
                document = texts.get(path)
                known[path] = self.lines(document.text if document is not None else self.session.text_of(path))
            return known[path]

        return Messages(lines_of, self.uri_of, self.version_of)

    def lines(self, text: str) -> TextLines:
        encoding = self.workspace.position_encoding
        return TextLines(text, str(getattr(encoding, "value", encoding)) if encoding else UTF16)

    def uri_of(self, path: str) -> str:
        document = self.session.open.get(path) or self.session.code.get(path)
        return document.uri if document is not None else uri_of_path(path)

    def version_of(self, path: str) -> int | None:
        document = self.session.open.get(path) or self.session.code.get(path)
        return document.version if document is not None else None


def is_code(path: str) -> bool:
    """Whether it may be the user's code, or Slice."""
    return path.endswith((".py", ".cpp", ".h", ".hpp", ".java", ".ice"))


def watchers() -> types.DidChangeWatchedFilesRegistrationOptions:
    return types.DidChangeWatchedFilesRegistrationOptions([types.FileSystemWatcher(_WATCHED)])


def folders_of(params: types.InitializeParams) -> list[str]:
    """The folders that the editor has opened."""
    named = [folder.uri for folder in params.workspace_folders or ()] or [params.root_uri or ""]
    return [path for uri in named if (path := path_of(uri))]


def of_code(capabilities: types.ClientCapabilities) -> Iterator[types.Registration]:
    """What is answered in code, too, which editors otherwise do not send to this server."""
    known = capabilities.text_document
    selector = [types.TextDocumentFilterPattern(pattern=one, scheme="file") for one in (_CODE, _SLICE)]
    if known is None:
        return
    if known.definition is not None and known.definition.dynamic_registration:
        options = types.DefinitionRegistrationOptions(selector)
        yield types.Registration("rcyaml-definition", types.TEXT_DOCUMENT_DEFINITION, options)
    if known.references is not None and known.references.dynamic_registration:
        more = types.ReferenceRegistrationOptions(selector)
        yield types.Registration("rcyaml-references", types.TEXT_DOCUMENT_REFERENCES, more)
    sync, actions = known.synchronization, known.code_action
    if sync is not None and sync.dynamic_registration and actions is not None and actions.dynamic_registration:
        sources: list[types.TextDocumentFilter] = [
            types.TextDocumentFilterPattern(pattern=one, scheme="file") for one in (_SOURCES, _SLICE, _MACHINE)
        ]
        kinds = [types.CodeActionKind.QuickFix]
        for method, made in (
            (types.TEXT_DOCUMENT_DID_OPEN, types.TextDocumentRegistrationOptions(sources)),
            (types.TEXT_DOCUMENT_DID_CHANGE,
             types.TextDocumentChangeRegistrationOptions(types.TextDocumentSyncKind.Full, sources)),
            (types.TEXT_DOCUMENT_DID_SAVE, types.TextDocumentSaveRegistrationOptions(sources)),
            (types.TEXT_DOCUMENT_DID_CLOSE, types.TextDocumentRegistrationOptions(sources)),
            (types.TEXT_DOCUMENT_CODE_ACTION, types.CodeActionRegistrationOptions(sources, kinds)),
        ):  # fmt: skip
            yield types.Registration(f"rcyaml-{method.rpartition('/')[2]}", method, made)
