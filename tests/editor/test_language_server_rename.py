"""Renaming by `rcyaml lsp`: in documents, unsaved ones too, and in code."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

pytest.importorskip("pygls")

from lsprotocol import types
from pygls import uris
from pygls.exceptions import JsonRpcException

from conftest import write_tree
from editor.editing import Editor, edited
from editor.speaking import DOCUMENTS, ROBOT, at, worker

pytestmark = pytest.mark.processes

PLACE = {
    **DOCUMENTS,
    **worker(f"Speech_say(self, text: str) -> None:  # {ROBOT}", f"print('{ROBOT}', self.Speech_say)"),
    "robot.ddsl.yaml": "deployment: Robot\nhosts: {left: 10.0.0.2}\ncomponents: {mouth: {component: speech, host: left}}\ngroups: {all: {components: [mouth]}}\n",
}


@pytest.fixture
def ws(tmp_path: Path) -> Path:
    return write_tree(tmp_path / "ws", PLACE)


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
        assert ready == types.PrepareRenamePlaceholder(at(4, 13, 19), "Speech")
        nothing = types.PrepareRenameParams(named, types.Position(3, 12))  # the import is a file
        assert await editor.client.text_document_prepare_rename_async(nothing) is None

        made = await _renamed(editor, component, 4, 15, "Talk")
        assert _changes(made, ws) == {
            "interfaces/Speech.idsl.yaml": [(at(2, 2, 8), "Talk", "documents")],
            "speech/speech.cdsl.yaml": [(at(4, 13, 19), "Talk", "documents")],
            "speech/src/specificworker.py": [
                (at(4, 8, 18), "Talk_say", "code"),
                (at(5, 25, 35), "Talk_say", "code"),
            ],
        }
        assert made.change_annotations is not None and made.change_annotations["code"].needs_confirmation

        editor.open(robot)
        made = await _renamed(editor, robot, 2, 14, "voice")
        assert _changes(made, ws) == {
            "robot.ddsl.yaml": [(at(2, 13, 18), "voice", "documents"), (at(3, 28, 33), "voice", "documents")]
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


def test_an_editor_that_does_not_read_the_standard_error_can_be_refused_often(ws: Path) -> None:
    """The client of these tests does not read it: its pipe and buffer take 192 KiB, some 180 logged refusals."""
    interface = ws / "interfaces/Speech.idsl.yaml"

    async def test(editor: Editor) -> None:
        await editor.start(ws)
        editor.open(interface)
        for _ in range(300):
            with pytest.raises(JsonRpcException, match="no name"):
                await asyncio.wait_for(_renamed(editor, interface, 2, 4, "no name"), 30)

    edited(test)


def test_paths_follow_files_that_are_renamed(ws: Path) -> None:
    interface, component = ws / "interfaces/Speech.idsl.yaml", ws / "speech/speech.cdsl.yaml"

    async def test(editor: Editor) -> None:
        started = await editor.start(ws)
        files = started.capabilities.workspace and started.capabilities.workspace.file_operations
        assert files and files.will_rename and files.did_rename
        editor.open(component)
        editor.change(component, f"# {ROBOT}\n{PLACE['speech/speech.cdsl.yaml']}")  # unsaved
        made = await _will_rename(editor, (interface, interface.with_name("Talk.idsl.yaml")))
        assert made is not None
        (change,) = made.document_changes or ()
        assert isinstance(change, types.TextDocumentEdit) and change.text_document.uri == component.as_uri()
        assert list(change.edits) == [types.TextEdit(at(3, 10, 16), "Talk")]
        made = await _will_rename(editor, (ws / "speech", ws / "voice"), (interface, ws / "voice/Talk.idsl.yaml"))
        assert made is not None
        texts = {}
        for change in made.document_changes or ():
            assert isinstance(change, types.TextDocumentEdit)
            path = Path(str(uris.to_fs_path(change.text_document.uri)))
            texts[path.name] = [one.new_text for one in change.edits if isinstance(one, types.TextEdit)]
        assert texts == {"robot.ddsl.yaml": ["voice"], "speech.cdsl.yaml": ["Talk"]}
        for old, new in (
            (ws / "notes.txt", ws / "note.txt"),
            (ws.parent / "far/x.idsl.yaml", ws.parent / "y.idsl.yaml"),
        ):
            assert await _will_rename(editor, (old, new)) is None
        assert not editor.messages

    edited(test)


async def _will_rename(editor: Editor, *files: tuple[Path, Path]) -> types.WorkspaceEdit | None:
    named = [types.FileRename(old.as_uri(), new.as_uri()) for old, new in files]
    return await editor.client.workspace_will_rename_files_async(types.RenameFilesParams(named))


def test_the_renaming_of_a_component_offers_its_file(ws: Path) -> None:
    component, robot = ws / "speech/speech.cdsl.yaml", ws / "robot.ddsl.yaml"
    robot.write_text(robot.read_text().replace("component: speech,", "component: speech/speech.cdsl.yaml,"))

    async def test(editor: Editor) -> None:
        await editor.start(ws, operations=[types.ResourceOperationKind.Rename])
        editor.open(component)
        made = await _renamed(editor, component, 0, 15, "VoiceComp")
        *changes, file = made.document_changes or ()
        assert file == types.RenameFile(
            component.as_uri(), component.with_name("voice.cdsl.yaml").as_uri(), annotation_id="file"
        )
        (path,) = [
            one
            for one in changes
            if isinstance(one, types.TextDocumentEdit) and one.text_document.uri == robot.as_uri()
        ]
        assert [getattr(one, "annotation_id", None) for one in path.edits] == ["file"]
        assert [getattr(one, "new_text", None) for one in path.edits] == ["speech/voice.cdsl.yaml"]
        assert made.change_annotations is not None and made.change_annotations["file"].needs_confirmation
        component.with_name("voice.cdsl.yaml").write_text("# another file\n")
        made = await _renamed(editor, component, 0, 15, "VoiceComp")
        assert not any(isinstance(one, types.RenameFile) for one in made.document_changes or ())
        assert not editor.messages

    edited(test)


def test_a_document_has_one_change_with_the_paths_to_the_renamed_file(ws: Path) -> None:
    """Positions count before the change: those of a second one would be wrong in the same line."""
    interface, component = ws / "interfaces/Speech.idsl.yaml", ws / "hand.cdsl.yaml"
    component.write_text("{component: HandComp, language: python, implements: [Speech], imports: [Speech]}\n")

    async def test(editor: Editor) -> None:
        await editor.start(ws, operations=[types.ResourceOperationKind.Rename])
        editor.open(interface)
        lines = interface.read_text().split("\n")
        line = next(number for number, text in enumerate(lines) if "  Speech:" in text)
        made = await _renamed(editor, interface, line, lines[line].index("Speech") + 1, "LongHand")
        changes = [one for one in made.document_changes or () if isinstance(one, types.TextDocumentEdit)]
        (of_component,) = [one for one in changes if one.text_document.uri == component.as_uri()]
        assert sorted(getattr(one, "annotation_id", "") for one in of_component.edits) == ["documents", "file"]
        assert len({one.text_document.uri for one in changes}) == len(changes)
        assert not editor.messages

    edited(test)
