"""`rcyaml lsp`, driven by a client over its standard streams."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

pytest.importorskip("pygls")

from lsprotocol import types

from conftest import write_tree
from editor.editing import Editor, edited
from editor.speaking import COMPONENT, DOCUMENTS, PARAMETERS, ROBOT, SPEECH, at

pytestmark = pytest.mark.processes

PLACE = {
    **DOCUMENTS,
    "speech/speech.pdsl.yaml": PARAMETERS,
    "speech/etc/config.yaml": "component: ../speech.cdsl.yaml\nparameters: {volume: 4}\n",
    "robot.ddsl.yaml": "deployment: Robot\ncomponents: {speech: {component: speech}}\n",
}


@pytest.fixture
def ws(tmp_path: Path) -> Path:
    folder = write_tree(tmp_path / "ws", {**PLACE, "speech/bin/SpeechComp": ""})
    (folder / "speech/bin/SpeechComp").chmod(0o755)
    return folder


def _applied(text: str, edits: list[types.TextEdit]) -> str:
    lines = text.split("\n")
    for edit in sorted(edits, key=lambda one: (one.range.start.line, one.range.start.character), reverse=True):
        assert edit.range.start.line == edit.range.end.line
        line = lines[edit.range.start.line].encode("utf-16-le")
        start, end = 2 * edit.range.start.character, 2 * edit.range.end.character
        lines[edit.range.start.line] = (line[:start] + edit.new_text.encode("utf-16-le") + line[end:]).decode(
            "utf-16-le"
        )
    return "\n".join(lines)


def test_marks_come_with_the_keys_and_go_again(ws: Path) -> None:
    interface, component = ws / "interfaces/Speech.idsl.yaml", ws / "speech/speech.cdsl.yaml"

    async def test(editor: Editor) -> None:
        await editor.start(ws)
        editor.open(interface)
        editor.open(component)
        await editor.until_codes(component)
        for _ in range(3):
            editor.change(interface, SPEECH.replace("string", "strng"))
            found = await editor.until_codes(interface, "RC1010")
            assert found[0].range == at(2, 38, 43) and found[0].source == "rcyaml"
            assert found[0].severity == types.DiagnosticSeverity.Error
            assert found[0].message == "unknown type 'strng'\ndid you mean 'string'?"
            editor.change(interface, SPEECH)
            await editor.until_codes(interface)
        editor.change(interface, "module: [")
        await editor.until_codes(interface, "RC0101")
        editor.change(interface, SPEECH)
        await editor.until_codes(interface)
        assert not editor.messages

    edited(test)


def test_unsaved_texts_count_in_all_documents(ws: Path) -> None:
    interface, component, values = (
        ws / "interfaces/Speech.idsl.yaml", ws / "speech/speech.cdsl.yaml", ws / "speech/etc/config.yaml",
    )  # fmt: skip

    async def test(editor: Editor) -> None:
        await editor.start(ws)
        editor.open(interface)
        await editor.until_codes(interface)
        editor.change(interface, SPEECH.replace("  Speech:", "  Talk:"))
        found = await editor.until_codes(component, "RC2003")  # it is not even open
        assert found[0].range.start.line == 3
        editor.open(component)
        editor.change(component, COMPONENT.replace("implements: [Speech]", "implements: [Talk]"))
        await editor.until_codes(component)

        editor.open(ws / "speech/speech.pdsl.yaml")
        editor.change(ws / "speech/speech.pdsl.yaml", PLACE["speech/speech.pdsl.yaml"].replace("[0, 9]", "[0, 3]"))
        await editor.until_codes(values, "RC3303")
        editor.close(ws / "speech/speech.pdsl.yaml")  # not saved: the file counts again
        await editor.until_codes(values)

        new = ws / "interfaces/Mouth.idsl.yaml"
        editor.open(new, "module: RoboCompMouth\ninterfaces: {Mouth: {methods: {shut: {}}}}\n")
        editor.change(
            component,
            COMPONENT.replace("imports: [Speech]\nimplements: [Speech]", "imports: [Mouth]\nimplements: [Mouth]"),
        )
        await editor.until_codes(component)
        editor.close(new)
        await editor.until_codes(component, "RC2101")

    edited(test)


def test_changes_on_the_disk_count(ws: Path) -> None:
    component = ws / "speech/speech.cdsl.yaml"

    async def test(editor: Editor) -> None:
        await editor.start(ws)
        await editor.until(editor.watched.is_set)
        editor.open(component)
        await editor.until_codes(component)
        aside = (ws / "interfaces/Speech.idsl.yaml").rename(ws / "aside")
        event = types.FileEvent(aside.as_uri(), types.FileChangeType.Deleted)
        editor.client.workspace_did_change_watched_files(types.DidChangeWatchedFilesParams([event]))
        await editor.until_codes(component, "RC2101")
        aside.rename(ws / "interfaces/Speech.idsl.yaml")
        editor.saved(component)
        await editor.until_codes(component)

    edited(test)


@pytest.mark.parametrize(("encoding", "column"), [("utf-16", 41), ("utf-8", 43), ("utf-32", 40)])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_positions_behind_an_emoji(ws: Path, encoding: str, column: int, end: str) -> None:
    interface = ws / "interfaces/Speech.idsl.yaml"
    text = f"module: RoboCompSpeech # \U0001f916 é{end}interfaces:{end}  S: {{doc: '\U0001f916', methods: {{say: {{in: {{a: strng}}}}}}}}{end}"

    async def test(editor: Editor) -> None:
        started = await editor.start(ws, encodings=[encoding])
        assert started.capabilities.position_encoding == encoding
        editor.open(interface, text)
        found = (await editor.until_codes(interface, "RC1010"))[0]
        assert found.range == at(2, column, column + 5)
        action, *_ = await editor.actions(interface, found.range)
        assert action.edit is not None and action.edit.document_changes
        change = action.edit.document_changes[0]
        assert isinstance(change, types.TextDocumentEdit)
        assert [(one.range, one.new_text) for one in change.edits if isinstance(one, types.TextEdit)] == [
            (found.range, "string")
        ]

    edited(test)


def test_fixes_are_quick_fixes(ws: Path) -> None:
    component = ws / "speech/speech.cdsl.yaml"
    text = "component: SpeechComp\nlanguage: python\n# \U0001f916\nimplements: [Speech]\n"

    async def test(editor: Editor) -> None:
        await editor.start(ws)
        editor.open(component, text)
        found = (await editor.until_codes(component, "RC2003"))[0]
        assert await editor.actions(component, at(0, 0, 0)) == []
        (action,) = await editor.actions(component, at(3, 15, 15))
        assert action.title == "Import 'Speech'" and action.kind == types.CodeActionKind.QuickFix
        assert list(action.diagnostics or ()) == [found]
        assert action.edit is not None and action.edit.document_changes
        change = action.edit.document_changes[0]
        assert isinstance(change, types.TextDocumentEdit) and change.text_document.version == 1
        fixed = _applied(text, [one for one in change.edits if isinstance(one, types.TextEdit)])
        editor.change(component, fixed)
        await editor.until_codes(component)
        assert "imports: [Speech]\n" in fixed

    edited(test)


def test_documents_are_formatted_as_by_fmt(ws: Path) -> None:
    interface = ws / "interfaces/Speech.idsl.yaml"

    async def test(editor: Editor) -> None:
        await editor.start(ws)
        editor.open(interface, "module:   RoboCompSpeech # \U0001f916\r\n\r\n\r\n\r\ninterfaces: {  Speech: }")
        (edit,) = await editor.formatted(interface)
        assert edit.new_text == "module: RoboCompSpeech # \U0001f916\n\ninterfaces: {Speech: }\n"
        assert edit.range == types.Range(types.Position(0, 0), types.Position(4, 24))
        editor.change(interface, edit.new_text)
        assert not await editor.formatted(interface)
        editor.change(interface, "module: [")
        assert not await editor.formatted(interface)  # what is broken stays

    edited(test)


def test_several_workspaces_and_a_file_outside_of_any(tmp_path: Path) -> None:
    one, two = (write_tree(tmp_path / name, PLACE) for name in ("one", "two"))
    alone = (
        write_tree(tmp_path / "alone", {"Speech.idsl.yaml": SPEECH, "other.cdsl.yaml": "component: 3\n"})
        / "Speech.idsl.yaml"
    )

    async def test(editor: Editor) -> None:
        await editor.start(one, two)
        for ws in (one, two):
            editor.open(ws / "interfaces/Speech.idsl.yaml")
        editor.open(alone)
        editor.change(two / "interfaces/Speech.idsl.yaml", SPEECH.replace("  Speech:", "  Talk:"))
        editor.change(alone, SPEECH.replace("string", "strng"))
        await editor.until_codes(two / "speech/speech.cdsl.yaml", "RC2003")
        await editor.until_codes(alone, "RC1010")
        await editor.rest()
        assert editor.codes(one / "speech/speech.cdsl.yaml") == []
        assert str(alone.with_name("other.cdsl.yaml")) not in editor.shown
        editor.close(alone)
        await editor.until_codes(alone)
        editor.close(two / "interfaces/Speech.idsl.yaml")
        await editor.until_codes(two / "speech/speech.cdsl.yaml")

    edited(test)


def test_a_workspace_without_an_open_document_is_known_when_the_next_is_opened(ws: Path) -> None:
    """Its marks go with its last document, and what changed on the disk meanwhile counts."""
    interface, component = ws / "interfaces/Speech.idsl.yaml", ws / "speech/speech.cdsl.yaml"

    async def test(editor: Editor) -> None:
        await editor.start(ws)
        editor.open(interface, SPEECH.replace("  Speech:", "  Talk:"))
        await editor.until_codes(component, "RC2003")
        editor.close(interface)
        await editor.until_codes(component)
        interface.write_text(SPEECH.replace("  Speech:", "  Voice:"))
        editor.open(component)
        (found,) = await editor.until_codes(component, "RC2003")
        assert "Voice" in found.message
        await editor.rest()
        assert editor.codes(component) == ["RC2003"] and not editor.messages

    edited(test)


@pytest.mark.parametrize("place", ["rcyaml.yaml", "robot.mock.yaml"])
def test_mock_scripts_and_settings_are_checked_and_completed(ws: Path, place: str) -> None:
    path = ws / place
    key, wrong = ("interfaces", "RC0204") if place == "rcyaml.yaml" else ("interfaces", "")

    async def test(editor: Editor) -> None:
        await editor.start(ws, schema_server="no")
        editor.open(path, f"{key}: 3\n")
        await editor.until(lambda: editor.codes(path), "a mark")
        assert not wrong or editor.codes(path) == [wrong]
        editor.change(path, "inter\n")
        named = types.TextDocumentIdentifier(path.as_uri())
        found = await editor.client.text_document_completion_async(types.CompletionParams(named, types.Position(0, 5)))
        assert isinstance(found, list) and key in {one.label for one in found}
        editor.change(path, f"{key}: []\n" if place == "rcyaml.yaml" else f"{key}: {{Speech: {{}}}}\n")
        await editor.until(lambda: not editor.codes(path), "no mark")
        assert not editor.messages

    edited(test)


def test_paths_lead_to_their_files(ws: Path) -> None:
    write_tree(ws, {"speech/own.pdsl.yaml": "parameters: {}\n", "speech/speech.cdsl.yaml": f"{COMPONENT}parameters: own.pdsl.yaml\n",
                    "robot.ddsl.yaml": "deployment: R\ninclude: [arm.ddsl.yaml]\n", "arm.ddsl.yaml": "deployment: A\n"})  # fmt: skip

    async def test(editor: Editor) -> None:
        await editor.start(ws)
        for name, place, file in (
            ("speech/speech.cdsl.yaml", types.Position(4, 14), "speech/own.pdsl.yaml"),
            ("robot.ddsl.yaml", types.Position(1, 12), "arm.ddsl.yaml"),
        ):
            editor.open(ws / name)
            named = types.TextDocumentIdentifier((ws / name).as_uri())
            where = await editor.client.text_document_definition_async(types.DefinitionParams(named, place))
            assert isinstance(where, types.Location)
            assert (where.uri, where.range) == ((ws / file).as_uri(), at(0, 0, 0))

    edited(test)


def test_other_files_are_left_alone(ws: Path) -> None:
    async def test(editor: Editor) -> None:
        await editor.start(ws)
        editor.open(ws / "compose.yaml", "services: [")
        editor.client.text_document_did_open(
            types.DidOpenTextDocumentParams(types.TextDocumentItem("untitled:Untitled-1", "yaml", 1, "module: ["))
        )
        editor.open(ws / "interfaces/Speech.idsl.yaml", "module: [")
        await editor.until_codes(ws / "interfaces/Speech.idsl.yaml", "RC0101")
        await editor.rest()
        assert str(ws / "compose.yaml") not in editor.shown and not editor.messages

    edited(test)


def test_a_handler_that_fails_says_so_and_the_server_lives_on(ws: Path, tmp_path: Path) -> None:
    interface = ws / "interfaces/Speech.idsl.yaml"
    broken = tmp_path / "broken.py"
    broken.write_text(
        "from robocomp_yaml.link import linker\nfrom robocomp_yaml.lsp import features\n"
        "link = linker.Linker.link_named\n"
        "def fails(self, named):\n"
        "    link(self, named)\n"
        "    if any(b'explode' in raw for raw in self.documents.disk.contents.values()):\n"
        "        raise ZeroDivisionError('on purpose')\n"
        "linker.Linker.link_named = fails\n"
        "features.make().start_io()\n"
    )

    async def test(editor: Editor) -> None:
        await editor.start(ws, command=[sys.executable, str(broken)])
        editor.open(interface)
        await editor.until_codes(interface)
        editor.change(interface, f"{SPEECH}# explode\n")
        await editor.until(lambda: any("on purpose" in one and "Speech.idsl.yaml" in one for one in editor.messages))
        editor.change(interface, SPEECH.replace("string", "strng"))
        await editor.until_codes(interface, "RC1010")

    edited(test)


def test_half_a_pair_and_a_long_line_do_not_end_it(ws: Path) -> None:
    interface = ws / "interfaces/Speech.idsl.yaml"

    async def test(editor: Editor) -> None:
        await editor.start(ws)
        editor.open(interface, f"{SPEECH}# \u2028 {'x' * 100_000}\n# {ROBOT * 1000}\n")
        await editor.until_codes(interface)
        editor.change(interface, f"# a\u2028b\x85c\n{SPEECH.replace('string', 'strng')}")
        found = await editor.until_codes(interface, "RC1010")
        assert found[0].range.start.line == 3

    edited(test)


def test_names_are_found_across_documents_and_in_unsaved_texts(ws: Path) -> None:
    interface, component = ws / "interfaces/Speech.idsl.yaml", ws / "speech/speech.cdsl.yaml"
    named = types.TextDocumentIdentifier(component.as_uri())
    text = COMPONENT.replace("component:", f"# {ROBOT}\ncomponent:").replace("implements: ", f"# {ROBOT}\nimplements: ")

    async def test(editor: Editor) -> None:
        await editor.start(ws)
        editor.open(component)
        editor.change(component, text)
        editor.open(interface)
        editor.change(interface, f"# {ROBOT}\n{SPEECH}")
        there = types.Position(5, 15)
        (where,) = [await editor.client.text_document_definition_async(types.DefinitionParams(named, there))]
        assert isinstance(where, types.Location)
        assert where.uri == interface.as_uri() and where.range == at(3, 2, 8)
        found = await editor.client.text_document_references_async(
            types.ReferenceParams(types.ReferenceContext(True), named, there)
        )
        assert [(one.uri, one.range) for one in found or ()] == [
            (interface.as_uri(), at(3, 2, 8)), (component.as_uri(), at(5, 13, 19)),
        ]  # fmt: skip
        shown = await editor.client.text_document_hover_async(types.HoverParams(named, there))
        assert shown is not None and isinstance(shown.contents, types.MarkupContent)
        assert (
            "interface RoboCompSpeech.Speech" in shown.contents.value
            and "used once in documents" in shown.contents.value
        )
        assert (
            await editor.client.text_document_definition_async(types.DefinitionParams(named, types.Position(0, 0)))
            is None
        )

        symbols = await editor.client.text_document_document_symbol_async(
            types.DocumentSymbolParams(types.TextDocumentIdentifier(interface.as_uri()))
        )
        assert [one.name for one in symbols or ()] == ["RoboCompSpeech", "Speech"]
        inner = [one for one in symbols or () if isinstance(one, types.DocumentSymbol)][1].children
        assert [one.name for one in inner or ()] == ["say"]
        everywhere = await editor.client.workspace_symbol_async(types.WorkspaceSymbolParams("spcomp"))
        assert [one.name for one in everywhere or ()] == ["SpeechComp"]
        assert not editor.messages

    edited(test)


def test_names_are_completed_with_their_import(ws: Path) -> None:
    component = ws / "speech/speech.cdsl.yaml"
    named = types.TextDocumentIdentifier(component.as_uri())
    text = f"component: SpeechComp\nlanguage: python\nimplements: [{ROBOT}, Sp"

    async def test(editor: Editor) -> None:
        await editor.start(ws)
        editor.open(component, text)
        found = await editor.client.text_document_completion_async(
            types.CompletionParams(named, types.Position(2, len("implements: [") + 6))
        )
        assert isinstance(found, (list, tuple))
        (item,) = found
        assert item.label == "Speech" and item.detail == "interface RoboCompSpeech.Speech, imports Speech"
        assert isinstance(item.text_edit, types.TextEdit) and item.text_edit.range == at(2, 17, 19)
        (more,) = item.additional_text_edits or ()
        assert more.new_text == "\nimports: [Speech]" and more.range == at(1, 16, 16)
        assert not editor.messages

    edited(test)
