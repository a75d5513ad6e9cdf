"""A small LSP client, enough to ask yaml-language-server what an editor would ask."""

from __future__ import annotations

import json
import queue
import subprocess
import threading
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

CURSOR = "|"
_MARKDOWN = ["markdown", "plaintext"]
_CAPABILITIES = {
    "textDocument": {
        "completion": {"completionItem": {"snippetSupport": True, "documentationFormat": _MARKDOWN}},
        "hover": {"contentFormat": _MARKDOWN},
        "publishDiagnostics": {},
    },
    "workspace": {"configuration": True, "workspaceFolders": True},
}


class LanguageServer:
    """A running server. Every call waits for its answer, `TIMEOUT` seconds at most."""

    TIMEOUT = 20.0

    def __init__(self, command: Iterable[str]) -> None:
        self._settings: Mapping[str, object] = {}
        self._process = subprocess.Popen(
            list(command), stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
        )
        self._answers: dict[int, queue.Queue[Any]] = {}
        self._diagnostics: dict[str, queue.Queue[list[dict[str, Any]]]] = {}
        self._sending = threading.Lock()
        self._last_id = 0
        threading.Thread(target=self._read, daemon=True).start()

    def start(self, folder: Path, schemas: Mapping[str, object], options: Mapping[str, object] | None = None) -> None:
        """Begin a session on a folder, with the `yaml.schemas` of its settings and no catalogue from the network.
        `options` are for the initialization."""
        wanted = {"validate": True, "hover": True, "completion": True}
        yaml = {**wanted, "schemas": schemas, "schemaStore": {"enable": False}}
        self._settings = {"yaml": yaml, "[yaml]": {"editor.tabSize": 2}}
        root = {"uri": folder.as_uri(), "name": folder.name}
        self.request(
            "initialize",
            {
                "processId": None, "rootUri": root["uri"], "workspaceFolders": [root], "capabilities": _CAPABILITIES,
                "initializationOptions": options,
            },
        )  # fmt: skip
        self._notify("initialized", {})
        self._notify("workspace/didChangeConfiguration", {"settings": self._settings})

    def stop(self) -> None:
        self.request("shutdown", None)
        self._notify("exit", None)
        self._process.wait(self.TIMEOUT)
        for pipe in (self._process.stdin, self._process.stdout):
            assert pipe is not None
            pipe.close()

    def open(self, path: Path, text: str) -> None:
        """Open a document; it need not exist on disk."""
        self._diagnostics[path.as_uri()] = queue.Queue()  # the server clears the marks of a document that is closed
        self._notify(
            "textDocument/didOpen",
            {"textDocument": {"uri": path.as_uri(), "languageId": "yaml", "version": 1, "text": text}},
        )

    def close(self, path: Path) -> None:
        self._notify("textDocument/didClose", {"textDocument": {"uri": path.as_uri()}})

    def diagnostics(self, path: Path) -> list[dict[str, Any]]:
        """What the server says about a document just opened."""
        return self._diagnostics[path.as_uri()].get(timeout=self.TIMEOUT)

    def completion(self, path: Path, text: str) -> list[dict[str, Any]]:
        """The proposals at the cursor, marked with | in the text."""
        answer = self._at_cursor("textDocument/completion", path, text)
        items: list[dict[str, Any]] = answer["items"] if isinstance(answer, dict) else (answer or [])
        return items

    def hover(self, path: Path, text: str) -> str:
        """The Markdown shown at the cursor, marked with | in the text."""
        answer = self._at_cursor("textDocument/hover", path, text)
        return str(answer["contents"]["value"]) if answer else ""

    def _at_cursor(self, method: str, path: Path, text: str) -> Any:
        before, _, after = text.partition(CURSOR)
        position = {"line": before.count("\n"), "character": len(before) - before.rfind("\n") - 1}
        self.open(path, before + after)
        try:
            return self.request(method, {"textDocument": {"uri": path.as_uri()}, "position": position})
        finally:
            self.close(path)

    def request(self, method: str, params: object) -> Any:
        self._last_id += 1
        answer: queue.Queue[Any] = queue.Queue()
        self._answers[self._last_id] = answer
        self._send({"id": self._last_id, "method": method, "params": params})
        message = answer.get(timeout=self.TIMEOUT)
        if "error" in message:
            raise RuntimeError(f"{method}: {message['error']['message']}")
        return message["result"]

    def _notify(self, method: str, params: object) -> None:
        self._send({"method": method, "params": params})

    def _send(self, message: dict[str, object]) -> None:
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        stdin = self._process.stdin
        assert stdin is not None
        with self._sending:
            stdin.write(b"Content-Length: %d\r\n\r\n" % len(body) + body)
            stdin.flush()

    def _read(self) -> None:
        stdout = self._process.stdout
        assert stdout is not None
        while header := stdout.readline():
            length = int(header.split(b":")[1])
            while stdout.readline().strip():
                pass
            self._receive(json.loads(stdout.read(length)))
        for waiting in list(self._answers.values()):
            waiting.put({"error": {"message": "yaml-language-server has ended"}})

    def _receive(self, message: dict[str, Any]) -> None:
        method = message.get("method")
        if method is None:
            self._answers.pop(message["id"]).put(message)
        elif method == "textDocument/publishDiagnostics":
            params = message["params"]
            self._diagnostics.setdefault(params["uri"], queue.Queue()).put(params["diagnostics"])
        elif method == "workspace/configuration":
            sections = [item["section"] for item in message["params"]["items"]]
            self._send({"id": message["id"], "result": [self._settings.get(section) for section in sections]})
        elif "id" in message:
            self._send({"id": message["id"], "result": None})
