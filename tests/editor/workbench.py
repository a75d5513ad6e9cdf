"""A workspace of rcyaml's, open in an editor: documents are typed in, and the editor's answers come back.

In a text `|` marks the cursor. A document's first line is rcyaml's modeline, and all else is relative to it.
"""

from __future__ import annotations

import itertools
import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from editor.yaml_language_server import LanguageServer
from robocomp_yaml.link import workspace_files

SUFFIX = {
    "idsl": ".idsl.yaml",
    "cdsl": ".cdsl.yaml",
    "pdsl": ".pdsl.yaml",
    "ddsl": ".ddsl.yaml",
    "config": ".config.yaml",
    "workspace": "/rcyaml.yaml",
    "mock": ".mock.yaml",
}


@dataclass(frozen=True, slots=True)
class Proposal:
    """What completion offers; `text` is a snippet with `$1`, `${2:name}` …"""

    label: str
    text: str


class Workbench:
    def __init__(self, server: LanguageServer, folder: Path) -> None:
        workspace_files.install(str(folder))
        self.folder = folder
        self.server = self._server = server
        self._number = itertools.count()
        settings = json.loads((folder / workspace_files.SETTINGS).read_text(encoding="utf-8"))
        server.start(folder, settings["yaml.schemas"])

    def complete(self, kind: str, text: str) -> list[Proposal]:
        path = self._document(kind)
        return self._proposals(path, self._with_modeline(kind, path, text))

    def complete_with(self, modeline: str, text: str) -> list[Proposal]:
        """In a values document with a first line of its own."""
        return self._proposals(self._document("config"), modeline + text)

    def hover_with(self, modeline: str, text: str) -> str:
        return self._server.hover(self._document("config"), modeline + text)

    def _proposals(self, path: Path, text: str) -> list[Proposal]:
        return [
            Proposal(item["label"], item.get("textEdit", {}).get("newText", item.get("insertText", item["label"])))
            for item in self._server.completion(path, text)
        ]

    def hover(self, kind: str, text: str) -> str:
        path = self._document(kind)
        return self._server.hover(path, self._with_modeline(kind, path, text))

    def messages(self, kind: str, texts: Sequence[str]) -> list[list[str]]:
        """What the editor marks in each text: `line:column message`, in the order of the text.

        All are opened at once, since the server waits a while before it looks at a document.
        """
        paths = [self._document(kind) for _ in texts]
        return self.marked(
            (path, self._with_modeline(kind, path, text)) for path, text in zip(paths, texts, strict=True)
        )

    def marked(self, documents: Iterable[tuple[Path, str]]) -> list[list[str]]:
        """The same for whole documents, first line and all."""
        opened = list(documents)
        for path, text in opened:
            self._server.open(path, text)
        found = [self._server.diagnostics(path) for path, _ in opened]
        for path, _ in opened:
            self._server.close(path)
        return [[f"{line}:{column} {message}" for line, column, message in sorted(map(_plain, each))] for each in found]

    def _document(self, kind: str) -> Path:
        """The path of a document not used before; it exists only in the editor."""
        return self.folder / "documents" / f"{next(self._number)}{SUFFIX[kind]}"

    def _with_modeline(self, kind: str, path: Path, text: str) -> str:
        return f"{workspace_files.modeline(kind, str(path), str(self.folder))}\n{text}"


def _plain(diagnostic: dict[str, Any]) -> tuple[int, int, str]:
    start = diagnostic["range"]["start"]
    return start["line"], start["character"] + 1, diagnostic["message"]
