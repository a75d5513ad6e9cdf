"""What `rcyaml lsp` says in files beside the documents: Slice, SCXML, and the user's code while it is typed."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("pygls")

from lsprotocol import types
from pygls import uris

from conftest import write_tree
from editor.editing import Editor, edited
from editor.speaking import DOCUMENTS, PARAMETERS, ROBOT, at, worker
from robocomp_yaml import api

pytestmark = pytest.mark.processes

MACHINE = f"""\
<?xml version="1.0"?>
<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0" initial="idle">
  <state id="idle">
    <!-- {ROBOT} --><transition event="go" target="moving"/>
  </state>
  <state id="moving"><transition event="stop" target="idle"/></state>
</scxml>
"""
PLACE = {
    **DOCUMENTS,
    **worker("Speech_say(self, text: str) -> None:", f"print('{ROBOT}', self.parameters.volume, self.Speech_say)"),
    "speech/speech.pdsl.yaml": PARAMETERS,
    "arm/arm.cdsl.yaml": "component: ArmComp\nlanguage: python\nstatemachine: arm.scxml\n",
    "arm/arm.scxml": MACHINE,
    "by hand/Old.ice": f"// {ROBOT} Speech\nmodule RoboCompSpeech {{\r\n interface Speech {{ void say(string text); }};\r\n}};\n",
}  # fmt: skip


@pytest.fixture
def ws(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    ws = write_tree(tmp_path / "ws", PLACE)
    monkeypatch.chdir(ws)
    assert not api.load().compile(targets=["slice"]).apply().has_errors
    return ws


def _word(path: Path, where: types.Range) -> str:
    line = path.read_bytes().decode().splitlines()[where.start.line].encode("utf-16-le")
    return line[2 * where.start.character : 2 * where.end.character].decode("utf-16-le")


async def _definition(editor: Editor, path: Path, line: int, column: int) -> types.Location | None:
    named = types.TextDocumentIdentifier(path.as_uri())
    found = await editor.client.text_document_definition_async(
        types.DefinitionParams(named, types.Position(line, column))
    )
    assert found is None or isinstance(found, types.Location)
    return found


@pytest.mark.parametrize("file", ["slice/Speech.ice", "by hand/Old.ice"])
def test_slice_leads_to_the_documents_and_back(ws: Path, file: str) -> None:
    interface, slice_ = ws / "interfaces/Speech.idsl.yaml", ws / file

    async def test(editor: Editor) -> None:
        await editor.start(ws)
        editor.open(interface)
        await editor.until(lambda: types.TEXT_DOCUMENT_DEFINITION in editor.registered, "as an editor of Slice")
        named = types.TextDocumentIdentifier(interface.as_uri())
        for line, column, name in ((0, 12, "RoboCompSpeech"), (2, 4, "Speech"), (2, 22, "say"), (2, 32, "text")):
            there = types.Position(line, column)
            made = await editor.client.text_document_declaration_async(types.DeclarationParams(named, there))
            assert isinstance(made, (list, tuple))
            (place,) = [one.range for one in made if one.uri == slice_.as_uri()]
            assert _word(slice_, place) == name
            back = await _definition(editor, slice_, place.start.line, place.start.character)
            assert back is not None and back.uri == interface.as_uri() and _word(interface, back.range) == name
        # not saved yet, nor on the disk any more
        editor.open(slice_, "\n" + slice_.read_text())
        back = await _definition(editor, slice_, place.start.line + 1, place.end.character)
        assert back is not None and _word(interface, back.range) == "text"
        used = await editor.client.text_document_references_async(
            types.ReferenceParams(types.ReferenceContext(False), named, types.Position(2, 22))
        )
        assert [one.range.start.line for one in used or () if one.uri == slice_.as_uri()] == [place.start.line + 1]
        assert await _definition(editor, slice_, 0, 0) is None
        editor.close(slice_)
        assert not editor.messages and str(slice_) not in editor.shown

    edited(test)


def test_a_state_machine_is_checked_and_fixed_while_it_is_typed(ws: Path) -> None:
    machine = ws / "arm/arm.scxml"

    async def fixed(editor: Editor, code: str, text: str) -> types.CodeAction:
        editor.change(machine, text)
        await editor.until(lambda: editor.codes(machine) == [code], code)
        (mark,) = editor.shown[str(machine)].diagnostics
        (action,) = await editor.actions(machine, mark.range)
        assert action.edit is not None and action.edit.document_changes
        (change,) = action.edit.document_changes
        assert isinstance(change, types.TextDocumentEdit)
        lines = text.splitlines(keepends=True)
        for edit in sorted(change.edits, key=lambda one: one.range.start.line, reverse=True):
            assert isinstance(edit, types.TextEdit) and edit.range.start.line == edit.range.end.line
            line = lines[edit.range.start.line].encode("utf-16-le")
            start, end = 2 * edit.range.start.character, 2 * edit.range.end.character
            lines[edit.range.start.line] = (line[:start] + edit.new_text.encode("utf-16-le") + line[end:]).decode(
                "utf-16-le"
            )
        assert "".join(lines) == MACHINE, lines
        return action

    async def test(editor: Editor) -> None:
        await editor.start(ws)
        editor.open(machine)
        await fixed(editor, "RC2221", MACHINE.replace('target="moving"', 'target="movng"'))
        await fixed(editor, "RC2208", MACHINE.replace('event="go"', 'evnt="go"'))
        await fixed(
            editor,
            "RC2207",
            MACHINE.replace('<state id="idle">', '<stat id="idle">').replace("  </state>", "  </stat>"),
        )
        assert (
            await fixed(editor, "RC2206", MACHINE.replace(' xmlns="http://www.w3.org/2005/07/scxml"', ""))
        ).is_preferred
        assert (
            await fixed(editor, "RC2211", MACHINE.replace('version="1.0" initial', 'version="1.1" initial'))
        ).is_preferred
        # the marks move with their lines, until the workspace is checked again
        wrong = MACHINE.replace('target="moving"', 'target="movng"')
        editor.change(machine, wrong)
        await editor.until(lambda: editor.codes(machine) == ["RC2221"], "RC2221")
        editor.change(machine, f"{wrong.partition('?>')[0]}?>\n\n<!-- more -->{wrong.partition('?>')[2]}")
        for action in await editor.actions(machine, types.Range(types.Position(0, 0), types.Position(9, 0))):
            assert action.edit is not None and action.diagnostics and action.diagnostics[0].range.start.line == 5
        editor.change(machine, MACHINE)
        await editor.until(lambda: not editor.codes(machine), "none")
        assert await editor.formatted(machine) == []
        hover = await editor.client.text_document_hover_async(
            types.HoverParams(types.TextDocumentIdentifier(machine.as_uri()), types.Position(2, 13))
        )
        assert hover is None or "idle" in str(hover.contents)
        assert not editor.messages

    edited(test)


def test_code_is_checked_and_fixed_before_it_is_saved(ws: Path) -> None:
    code, document = ws / "speech/src/specificworker.py", ws / "speech/speech.cdsl.yaml"
    text = code.read_text()

    async def test(editor: Editor) -> None:
        def lacks(method: str) -> bool:
            return any(one.code == "RC6201" and method in one.message for one in editor.shown[str(code)].diagnostics)

        await editor.start(ws)
        editor.open(document)
        editor.open(code)
        await editor.until(lambda: editor.codes(code), "what the class lacks")
        editor.change(code, f"# {ROBOT}\n{text.replace('parameters.volume', 'parameters.volum')}")
        await editor.until(lambda: "RC6306" in editor.codes(code), "RC6306")
        (mark,) = [one for one in editor.shown[str(code)].diagnostics if one.code == "RC6306"]
        assert mark.range == at(6, 36, 41)
        (action,) = await editor.actions(code, mark.range)
        assert action.edit is not None and action.edit.document_changes
        (change,) = action.edit.document_changes
        assert isinstance(change, types.TextDocumentEdit)
        assert change.text_document.uri == code.as_uri() and change.text_document.version == 2
        (edit,) = change.edits
        assert isinstance(edit, types.TextEdit) and (edit.new_text, edit.range) == ("volume", mark.range)
        editor.change(code, f"# {ROBOT}\n{text}")
        await editor.until(lambda: "RC6306" not in editor.codes(code), "no RC6306")
        parameters = ws / "speech/speech.pdsl.yaml"
        editor.open(parameters)
        renamed = await editor.client.text_document_rename_async(
            types.RenameParams(types.TextDocumentIdentifier(parameters.as_uri()), types.Position(1, 15), "loudness")
        )
        assert renamed is not None and renamed.document_changes
        in_code = [one for one in renamed.document_changes if isinstance(one, types.TextDocumentEdit)
                   and one.text_document.uri == code.as_uri()]  # fmt: skip
        assert [(one.text_document.version, edit.range) for one in in_code for edit in one.edits
                if not isinstance(edit, types.SnippetTextEdit)] == [(3, at(6, 36, 42))]  # fmt: skip
        # what the class lacks is judged by the text that is not saved, too
        editor.change(code, text.replace("Speech_say", "Speech_sey"))
        await editor.until(lambda: lacks("Speech_say"), "Speech_say is missing")
        editor.close(code)  # the file counts again
        await editor.until(lambda: editor.codes(code) and not lacks("Speech_say"), "nothing is missing any more")
        assert not editor.messages and code.read_text() == text

    edited(test)


def test_other_yaml_is_not_formatted(ws: Path) -> None:
    other = ws / "docker-compose.yaml"

    async def test(editor: Editor) -> None:
        await editor.start(ws)
        editor.open(other, "services:   {a:    'b'}\n")
        assert await editor.formatted(other) == []
        assert str(uris.to_fs_path(other.as_uri())) not in editor.shown and not editor.messages

    edited(test)
