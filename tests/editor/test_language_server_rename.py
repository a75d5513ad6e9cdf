"""Renaming by `rcyaml lsp`: in documents, unsaved ones too, and in code."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("pygls")

from lsprotocol import types
from pygls import uris
from pygls.exceptions import JsonRpcException

from conftest import write_tree
from editor.editing import Editor, edited

pytestmark = pytest.mark.processes

ROBOT = "\U0001f916"
PLACE = {
    "rcyaml.yaml": "interfaces: [interfaces]\n",
    "interfaces/Speech.idsl.yaml": "module: RoboCompSpeech\ninterfaces:\n  Speech: {methods: {say: {in: {text: string}}}}\n",
    "speech/speech.cdsl.yaml": "component: SpeechComp\nlanguage: python\nimports: [Speech]\nimplements: [Speech]\n",
    "speech/src/specificworker.py": (
        "from generated.genericworker import GenericWorker\n\n\nclass SpecificWorker(GenericWorker):\n"
        f"    def Speech_say(self, text: str) -> None:  # {ROBOT}\n        print('{ROBOT}', self.Speech_say)\n"
    ),
    "robot.ddsl.yaml": "deployment: Robot\nhosts: {left: 10.0.0.2}\ncomponents: {mouth: {component: speech, host: left}}\ngroups: {all: {components: [mouth]}}\n",
}  # fmt: skip


@pytest.fixture
def ws(tmp_path: Path) -> Path:
    return write_tree(tmp_path / "ws", PLACE)


def _at(line: int, start: int, end: int) -> types.Range:
    return types.Range(types.Position(line, start), types.Position(line, end))


async def _renamed(editor: Editor, path: Path, line: int, column: int, name: str) -> types.WorkspaceEdit:
    named = types.TextDocumentIdentifier(path.as_uri())
    made = await editor.client.text_document_rename_async(types.RenameParams(named, types.Position(line, column), name))
    assert made is not None
    return made


def _changes(edit: types.WorkspaceEdit, ws: Path) -> dict[str, list[tuple[types.Range, str, str]]]:
    made = {}
    for change in edit.document_changes or ():
        assert isinstance(change, types.TextDocumentEdit)
        path = str(Path(str(uris.to_fs_path(change.text_document.uri))).relative_to(ws))
        made[path] = [
            (one.range, one.new_text, one.annotation_id)
            for one in change.edits if isinstance(one, types.AnnotatedTextEdit)
        ]  # fmt: skip
        assert len(made[path]) == len(change.edits)
    return made


def test_a_name_is_renamed_in_documents_and_code(ws: Path) -> None:
    component, robot = ws / "speech/speech.cdsl.yaml", ws / "robot.ddsl.yaml"
    named = types.TextDocumentIdentifier(component.as_uri())

    async def test(editor: Editor) -> None:
        started = await editor.start(ws)
        provider = started.capabilities.rename_provider
        assert provider
        editor.open(component)
        text = f"# {ROBOT}\r\n" + PLACE["speech/speech.cdsl.yaml"].replace("[Speech]\n", f"[Speech] # {ROBOT}\r\n")
        editor.change(component, text)  # unsaved
        there = types.Position(4, 15)
        ready = await editor.client.text_document_prepare_rename_async(types.PrepareRenameParams(named, there))
        assert ready == types.PrepareRenamePlaceholder(_at(4, 13, 19), "Speech")
        nothing = types.PrepareRenameParams(named, types.Position(3, 12))  # the import is a file
        assert await editor.client.text_document_prepare_rename_async(nothing) is None

        made = await _renamed(editor, component, 4, 15, "Talk")
        assert _changes(made, ws) == {
            "interfaces/Speech.idsl.yaml": [(_at(2, 2, 8), "Talk", "documents")],
            "speech/speech.cdsl.yaml": [(_at(4, 13, 19), "Talk", "documents")],
            "speech/src/specificworker.py": [
                (_at(4, 8, 18), "Talk_say", "code"),
                (_at(5, 25, 35), "Talk_say", "code"),
            ],
        }
        assert made.change_annotations is not None and made.change_annotations["code"].needs_confirmation

        editor.open(robot)
        made = await _renamed(editor, robot, 2, 14, "voice")
        assert _changes(made, ws) == {
            "robot.ddsl.yaml": [(_at(2, 13, 18), "voice", "documents"), (_at(3, 28, 33), "voice", "documents")]
        }
        assert not editor.messages

    edited(test)


def test_a_renaming_is_refused_with_its_reason(ws: Path) -> None:
    interface, robot = ws / "interfaces/Speech.idsl.yaml", ws / "robot.ddsl.yaml"

    async def test(editor: Editor) -> None:
        await editor.start(ws)
        editor.open(robot)
        editor.open(interface)
        for path, line, column, name, reason in (
            (robot, 2, 14, "all", "RC4001"),
            (robot, 0, 3, "x", "not a name"),
            (interface, 2, 4, "RoboCompSpeech", "RC"),
            (interface, 2, 4, "no name", "RC"),
        ):
            with pytest.raises(JsonRpcException, match=reason):
                await _renamed(editor, path, line, column, name)
        await _renamed(editor, interface, 2, 4, "Talk")  # it lives on
        assert not editor.messages

    edited(test)
