"""What two language servers know at forty positions: `rcyaml lsp`, and yaml-language-server with our schemas.

A position is a document of the small robot, and a part of it with «the word at the cursor». Completion is asked after
the first letter of the word; all else with the word; and what is reported is asked with a mistake instead of the word.
"""

from __future__ import annotations

import asyncio
import os
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import msgspec
from lsprotocol import types
from pygls import uris
from pygls.exceptions import JsonRpcException

from editor.editing import Editor
from editor.robot import DOCUMENTS
from editor.yaml_language_server import LanguageServer

GRIPPER, SHAPES = "interfaces/Gripper.idsl.yaml", "interfaces/Shapes.idsl.yaml"
HAND, WHEELS = "components/hand/hand.cdsl.yaml", "components/wheels/wheels.cdsl.yaml"
PARAMETERS, CONFIG = "components/hand/hand.pdsl.yaml", "components/hand/etc/config.yaml"
ROBOT = "deployments/robot.ddsl.yaml"
NOTHING = "–"
MOST = 3  # names in a cell

POSITIONS = [
    (GRIPPER, "imports: [«Shapes»]"), (GRIPPER, "where: «Shapes.Pose»"), (GRIPPER, "returns: «bool»"),
    (GRIPPER, "throws: [«Shapes.Blocked»]"), (SHAPES, "sequence: «Pose»"), (GRIPPER, "«Gripper»:\n"),
    (GRIPPER, "«grasp»:"), (GRIPPER, "«methods»:\n"),
    (HAND, "imports: [«Gripper», Odometry]"), (HAND, "implements: [«Gripper»]"), (HAND, "publishes: [«GripperEvents»]"),
    (HAND, "subscribes: [«Odometry»]"), (WHEELS, "requires: [«Gripper»]"), (HAND, "language: «python»"),
    (HAND, "parameters: «hand.pdsl.yaml»"), (HAND, "component: «HandComp»"),
    (PARAMETERS, "component: «hand.cdsl.yaml»"), (PARAMETERS, "type: «float»"),
    (PARAMETERS, "range: [0, «40»]", "-5"), (PARAMETERS, "default: «10»", "100"), (PARAMETERS, "list: «Finger»"),
    (PARAMETERS, "«force»:"), (PARAMETERS, "default: «soft»"), (PARAMETERS, "«unit»: N"),
    (CONFIG, "component: «../hand.cdsl.yaml»"), (CONFIG, "«force»: 12"), (CONFIG, "force: «12»", "99"),
    (CONFIG, "mode: «firm»"), (CONFIG, "«mode»: firm"), (CONFIG, "«length»: 0.2"), (CONFIG, "length: «0.2»", "long"),
    (CONFIG, "«parameters»:"),
    (ROBOT, "component: «../components/hand»"), (ROBOT, "«force»: 12"), (ROBOT, "force: «12»", "99"),
    (ROBOT, "host: «torso»\n"), (ROBOT, "Gripper: «hand»"), (ROBOT, "«Gripper»: hand"),
    (ROBOT, "after: [«storm»]"), (ROBOT, "components: [«hand», wheels]"),
]  # fmt: skip


class Spot(msgspec.Struct, frozen=True):
    """A position in a text: before and behind the word, and the word with a mistake."""

    path: str
    shown: str
    before: str
    word: str
    behind: str
    mistake: str

    @property
    def text(self) -> str:
        return self.before + self.word + self.behind

    @property
    def start(self) -> types.Position:
        lines = self.before.split("\n")
        return types.Position(len(lines) - 1, len(lines[-1]))

    @property
    def inside(self) -> types.Position:
        return types.Position(self.start.line, self.start.character + 1)


def spots() -> Iterator[Spot]:
    for path, part, *more in POSITIONS:
        text = DOCUMENTS[path].lstrip("\n")
        plain = re.sub("[«»]", "", part)
        assert text.count(plain) >= 1, (path, part)
        at = text.index(plain) + part.index("«")
        word = part[part.index("«") + 1 : part.index("»")]
        mistake = more[0] if more else word[:-2] + word[-1] + word[-2]
        shown = part.strip().replace("«", "⟪").replace("»", "⟫")
        yield Spot(path, shown, text[:at], word, text[at + len(word) :], mistake)


def _listed(labels: list[str]) -> str:
    rest = len(labels) - MOST
    return (
        ", ".join(f"`{one}`" for one in labels[:MOST]) + (f" and {rest} more" if rest > 0 else "")
        if labels
        else NOTHING
    )


class Ours:
    """The answers of `rcyaml lsp`."""

    def __init__(self, editor: Editor, folder: Path, capabilities: types.ServerCapabilities) -> None:
        self._editor, self._folder, self._capabilities = editor, folder, capabilities

    async def answers(self, spot: Spot) -> list[str]:
        path = self._folder / spot.path
        if str(path) not in self._editor.versions:
            self._editor.open(path, spot.text)
        self._editor.change(path, spot.before + spot.word[:1] + spot.behind)
        labels = await self._completed(path, spot)
        self._editor.change(path, spot.text)
        told = [labels, await self._hovered(path, spot), await self._defined(path, spot), await self._used(path, spot)]
        told.append(await self._renamed(path, spot))
        told += await self._reported(path, spot)
        self._editor.change(path, spot.text)
        return told

    def _at(self, path: Path, spot: Spot) -> dict[str, Any]:
        return {"text_document": types.TextDocumentIdentifier(path.as_uri()), "position": spot.inside}

    async def _completed(self, path: Path, spot: Spot) -> str:
        found = await self._editor.client.text_document_completion_async(types.CompletionParams(**self._at(path, spot)))
        items = found.items if isinstance(found, types.CompletionList) else found or []
        return _listed([item.label for item in items])

    async def _hovered(self, path: Path, spot: Spot) -> str:
        found = await self._editor.client.text_document_hover_async(types.HoverParams(**self._at(path, spot)))
        return "yes" if found else NOTHING

    async def _defined(self, path: Path, spot: Spot) -> str:
        found = await self._editor.client.text_document_definition_async(types.DefinitionParams(**self._at(path, spot)))
        targets = [found] if isinstance(found, types.Location) else list(found or ())
        places = [
            (one.target_uri, one.target_range) if isinstance(one, types.LocationLink) else (one.uri, one.range)
            for one in targets
        ]
        names = {f"`{os.path.basename(str(uris.to_fs_path(uri)))}:{where.start.line + 1}`" for uri, where in places}
        return ", ".join(sorted(names)) or NOTHING

    async def _used(self, path: Path, spot: Spot) -> str:
        context = types.ReferenceContext(include_declaration=False)
        found = await self._editor.client.text_document_references_async(
            types.ReferenceParams(context=context, **self._at(path, spot))
        )
        return str(len(found)) if found else NOTHING

    async def _renamed(self, path: Path, spot: Spot) -> str:
        if not self._capabilities.rename_provider:
            return NOTHING
        try:
            found = await self._editor.client.text_document_rename_async(
                types.RenameParams(new_name="Renamed", **self._at(path, spot))
            )
        except JsonRpcException:
            return NOTHING
        changed = [
            one for one in (found.document_changes if found else None) or () if isinstance(one, types.TextDocumentEdit)
        ]
        edits = {one.text_document.uri: len(one.edits) for one in changed}
        edits |= {uri: len(edits) for uri, edits in ((found.changes if found else None) or {}).items()}
        return f"{sum(edits.values())} in {len(edits)}" if edits else NOTHING

    async def _at_rest(self, path: Path) -> None:
        """Waits until the document and its workspace are checked."""
        seen: list[str] | None = None
        for _ in range(100):
            await asyncio.sleep(0.5)
            shown = self._editor.shown.get(str(path))
            is_current = shown is not None and shown.version == self._editor.versions[str(path)]
            if is_current and seen == self._editor.codes(path):
                return
            seen = self._editor.codes(path) if is_current else None
        raise AssertionError(path)

    async def _reported(self, path: Path, spot: Spot) -> list[str]:
        self._editor.change(path, spot.before + spot.mistake + spot.behind)
        await self._at_rest(path)
        shown = self._editor.shown
        codes = [str(one.code) for one in shown[str(path)].diagnostics]
        whole = types.Range(types.Position(0, 0), types.Position(10_000, 0))
        titles = [action.title for action in await self._editor.actions(path, whole)]
        return [", ".join(dict.fromkeys(codes)) or NOTHING, str(len(titles)) if titles else NOTHING]


def theirs(server: LanguageServer, folder: Path, number: int, spot: Spot) -> list[str]:
    """The answers of yaml-language-server."""
    kind = next(kind for kind in KINDS if spot.path.endswith((f".{kind}.yaml", f"/{kind}.yaml")))

    def beside(what: str) -> Path:  # the server keeps what it knows of a document by its name and version
        return (folder / spot.path).with_name(f"{what}{number}.{kind}.yaml")

    items = server.completion(beside("completion"), f"{spot.before}{spot.word[:1]}|{spot.behind}")
    hover = server.hover(beside("hover"), f"{spot.before}{spot.word[:1]}|{spot.word[1:]}{spot.behind}")
    server.open(beside("mistake"), spot.before + spot.mistake + spot.behind)
    reported = server.diagnostics(beside("mistake"))
    server.close(beside("mistake"))
    return [_listed([item["label"] for item in items]), "yes" if hover else NOTHING, "yes" if reported else NOTHING]


HEAD = """# Forty positions

What completion, hover, definition, references and rename give at forty positions in all kinds of documents of a small
robot, and what is reported if the word has a mistake. The word at the cursor is ⟪marked⟫. Completion is
asked after its first letter. The answers are those of `rcyaml lsp`, and of yaml-language-server 1.25 with the schemas that `rcyaml compile`
has written, but without `rcyaml lsp`; definition, references, rename and fixes are unknown to it. *References* is their
number, *rename* the number of edits and of documents, *fixes* the number of quick fixes.

This page is made by `pytest tests/editor/test_positions.py --update-golden`.
"""
KINDS = {
    "idsl": "Interfaces", "cdsl": "Components", "pdsl": "Parameters", "config": "Values", "ddsl": "Deployments",
}  # fmt: skip
COLUMNS = (
    "position", "completion", "hover", "definition", "references", "rename", "reported", "fixes",
    "completion without `rcyaml lsp`", "hover", "reported",
)  # fmt: skip


def page(rows: list[tuple[Spot, list[str]]]) -> str:
    lines = [HEAD]
    for kind, title in KINDS.items():
        lines += [f"## {title}\n", f"| {' | '.join(COLUMNS)} |", f"|{'---|' * len(COLUMNS)}"]
        for spot, cells in rows:
            if spot.path.endswith((f".{kind}.yaml", f"/{kind}.yaml")):
                lines.append(f"| `{spot.shown}` | {' | '.join(cells)} |")
        lines.append("")
    return "\n".join(lines)
