"""What `rcyaml lsp` says beside documents: places in code, lenses, hints, commands; and which server tells what."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("pygls")

from lsprotocol import types
from pygls import uris
from pygls.exceptions import JsonRpcException

from conftest import write_tree
from editor.editing import Editor, edited
from editor.speaking import DOCUMENTS, PARAMETERS, ROBOT, at, worker
from robocomp_yaml import api
from robocomp_yaml.addresses.port_numbers import default_port

pytestmark = pytest.mark.processes

PLACE = {
    **DOCUMENTS,
    **worker("Speech_say(self, text: str) -> None:", f"print('{ROBOT}', self.parameters.volume, self.Speech_say)"),
    "speech/speech.pdsl.yaml": PARAMETERS,
    "robot.ddsl.yaml": "deployment: Robot\ncomponents: {mouth: {component: speech}}\n",
}


@pytest.fixture
def ws(tmp_path: Path) -> Path:
    return write_tree(tmp_path / "ws", PLACE)


def _places(found: object, ws: Path) -> list[tuple[str, types.Range]]:
    assert isinstance(found, (list, tuple))
    return [(str(Path(str(uris.to_fs_path(one.uri))).relative_to(ws)), one.range) for one in found]


def test_references_lead_into_code(ws: Path) -> None:
    interface = ws / "interfaces/Speech.idsl.yaml"
    named = types.TextDocumentIdentifier(interface.as_uri())
    there = types.Position(2, 22)

    async def test(editor: Editor) -> None:
        await editor.start(ws)
        editor.open(interface)
        found = await editor.client.text_document_references_async(
            types.ReferenceParams(types.ReferenceContext(False), named, there)
        )
        code = "speech/src/specificworker.py"
        assert _places(found, ws) == [(code, at(4, 8, 18)), (code, at(5, 49, 59))]
        made = await editor.client.text_document_implementation_async(types.ImplementationParams(named, there))
        assert _places(made, ws) == [(code, at(4, 8, 18))]
        assert not editor.messages

    edited(test)


def test_references_of_what_cannot_be_renamed(ws: Path) -> None:
    """Instances cannot share the port that their configuration would then set for the interface."""
    robot = "deployment: Robot\ncomponents: {'m{i}': {component: speech, instances: 2}}\n"
    config = f"Speech.Endpoints=tcp -p {default_port('SpeechComp', 'Speech')}\n"
    write_tree(ws, {"robot.ddsl.yaml": robot, "speech/etc/config": config, "speech/speech.pdsl.yaml": ""})
    (ws / "speech/speech.pdsl.yaml").unlink()
    write_tree(ws, worker("Speech_say(self, text: str) -> None:", "print(self.Speech_say)"))
    interface = ws / "interfaces/Speech.idsl.yaml"
    named, there = types.TextDocumentIdentifier(interface.as_uri()), types.Position(2, 4)

    async def test(editor: Editor) -> None:
        await editor.start(ws)
        symbols = await editor.client.workspace_symbol_async(types.WorkspaceSymbolParams("spcomp"))
        assert [one.name for one in symbols or ()] == ["SpeechComp"], "also before a document is open"
        editor.open(interface)
        found = await editor.client.text_document_references_async(
            types.ReferenceParams(types.ReferenceContext(False), named, there)
        )
        assert {"speech/etc/config", "speech/src/specificworker.py"} <= {path for path, _ in _places(found, ws)}
        with pytest.raises(JsonRpcException, match="RC3331"):
            await editor.client.text_document_rename_async(types.RenameParams(named, there, "Voice"))

    edited(test)


def test_lenses_hints_and_hover(ws: Path) -> None:
    interface, robot = ws / "interfaces/Speech.idsl.yaml", ws / "robot.ddsl.yaml"

    async def test(editor: Editor) -> None:
        await editor.start(ws)
        editor.open(interface)
        editor.open(robot)
        lenses = await editor.client.text_document_code_lens_async(
            types.CodeLensParams(types.TextDocumentIdentifier(interface.as_uri()))
        )
        assert [(one.range, one.command.title) for one in lenses or () if one.command] == [
            (at(2, 2, 8), "1 implements it")
        ]
        hints = await editor.client.text_document_inlay_hint_async(
            types.InlayHintParams(types.TextDocumentIdentifier(robot.as_uri()), at(0, 0, 0))
        )
        assert list(hints or ()) == []
        whole = types.Range(types.Position(0, 0), types.Position(9, 0))
        (hint,) = await editor.client.text_document_inlay_hint_async(
            types.InlayHintParams(types.TextDocumentIdentifier(robot.as_uri()), whole)
        ) or ()  # fmt: skip
        assert hint.position == types.Position(1, 38) and str(hint.label).startswith("⟨Speech ")
        assert not editor.messages

    edited(test)


def test_a_workspace_is_compiled(ws: Path) -> None:
    component = ws / "speech/speech.cdsl.yaml"

    async def test(editor: Editor) -> None:
        started = await editor.start(ws)
        provider = started.capabilities.execute_command_provider
        assert provider is not None and {"rcyaml.compile", "rcyaml.merge"} <= set(provider.commands)
        editor.open(component)

        async def run() -> None:
            editor.messages.clear()
            await editor.client.workspace_execute_command_async(
                types.ExecuteCommandParams("rcyaml.compile", [component.as_uri()])
            )
            await editor.until(lambda: editor.messages)

        editor.change(component, f"{PLACE['speech/speech.cdsl.yaml']}# unsaved\n")
        await run()
        assert "save " in editor.messages[0] and not (ws / "speech/generated").exists()
        editor.change(component, PLACE["speech/speech.cdsl.yaml"])
        await run()
        assert "compiled, " in editor.messages[0] and (ws / "speech/generated/genericworker.py").exists()
        await run()
        assert editor.messages == ["rcyaml: compiled, nothing has changed"]

    edited(test)


@pytest.mark.parametrize(("setting", "shown"), [("no", ["RC0202"]), ("yes", []), ("auto", ["RC0202"])])
def test_what_a_server_of_schemas_tells_is_not_told_twice(ws: Path, setting: str, shown: list[str]) -> None:
    robot = ws / "robot.ddsl.yaml"
    text = "deployment: Robot\ncomponents: {mouth: {component: speech, hots: left}}\n"

    async def keys(editor: Editor, text: str, line: int, column: int) -> set[str]:
        found = await editor.client.text_document_completion_async(
            types.CompletionParams(types.TextDocumentIdentifier(robot.as_uri()), types.Position(line, column))
        )
        assert isinstance(found, (list, tuple))
        return {one.label for one in found}

    async def test(editor: Editor) -> None:
        await editor.start(ws, schema_server=setting)
        editor.open(robot, text)
        await editor.until_codes(robot, *shown)
        editor.change(robot, "deployment: Robot\ncomponents: {mouth: {component: speech, }}\n")
        offered = await keys(editor, text, 1, 40)
        assert ("host" in offered) == bool(shown)
        if setting == "auto":
            schema = "# yaml-language-server: $schema=.rcyaml/schemas/ddsl.schema.json\n"
            editor.change(robot, schema + text)
            await editor.until_codes(robot)
            settings = types.DidChangeConfigurationParams({"rcyaml": {"schemaServer": "no"}})
            editor.client.workspace_did_change_configuration(settings)
            editor.change(robot, schema + text + "# x\n")
            await editor.until_codes(robot, "RC0202")
        assert not editor.messages

    edited(test)


@pytest.mark.parametrize(
    ("line", "column", "file", "where"),
    [
        (4, 11, "interfaces/Speech.idsl.yaml", at(2, 2, 8)),  # Spe|ech_say
        (4, 17, "interfaces/Speech.idsl.yaml", at(2, 21, 24)),  # Speech_s|ay
        (5, 37, "speech/speech.pdsl.yaml", at(1, 13, 19)),  # parameters.vol|ume, behind an emoji
        (5, 58, "interfaces/Speech.idsl.yaml", at(2, 21, 24)),
        (4, 27, "", None),  # an argument, which is the code's own name
        (0, 8, "", None),
        (3, 8, "", None),
    ],
)
def test_the_users_code_leads_to_the_documents(
    ws: Path, line: int, column: int, file: str, where: types.Range | None
) -> None:
    code = ws / "speech/src/specificworker.py"
    named, there = types.TextDocumentIdentifier(code.as_uri()), types.Position(line, column)

    async def test(editor: Editor) -> None:
        await editor.start(ws)
        editor.open(code)
        found = await editor.client.text_document_definition_async(types.DefinitionParams(named, there))
        if where is None:
            assert found is None
            return
        assert _places([found], ws) == [(file, where)]
        used = await editor.client.text_document_references_async(
            types.ReferenceParams(types.ReferenceContext(True), named, there)
        )
        assert (file, where) in _places(used, ws) and len(used or ()) > 1
        assert str(code) not in editor.shown and not editor.messages

    edited(test)


def test_generated_code_leads_to_the_documents(ws: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ws)
    assert not api.load().compile().apply().has_errors
    code = ws / "speech/generated/genericworker.py"
    lines = code.read_text().splitlines()
    line = next(number for number, text in enumerate(lines) if "def Speech_say" in text)

    async def test(editor: Editor) -> None:
        await editor.start(ws)
        await editor.until(lambda: types.TEXT_DOCUMENT_DEFINITION in editor.registered, "as an editor of code")
        there = types.Position(line, lines[line].index("_say") + 2)
        found = await editor.client.text_document_definition_async(
            types.DefinitionParams(types.TextDocumentIdentifier(code.as_uri()), there)
        )
        assert _places([found], ws) == [("interfaces/Speech.idsl.yaml", at(2, 21, 24))]
        assert not editor.messages

    edited(test)


@pytest.mark.parametrize("language", ["python", "cpp", "java"])
def test_a_method_leads_to_what_was_generated_from_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, language: str
) -> None:
    place = {**DOCUMENTS, "speech/speech.cdsl.yaml": DOCUMENTS["speech/speech.cdsl.yaml"].replace("python", language)}
    ws = write_tree(tmp_path / "ws", place)
    monkeypatch.chdir(ws)
    api.load().compile().apply()
    interface = ws / "interfaces/Speech.idsl.yaml"
    named = types.TextDocumentIdentifier(interface.as_uri())
    there = types.Position(2, 22)

    async def test(editor: Editor) -> None:
        await editor.start(ws)
        editor.open(interface)
        found = await editor.client.text_document_declaration_async(types.DeclarationParams(named, there))
        assert isinstance(found, (list, tuple)) and found
        lines = []
        for one in found:
            path = Path(str(uris.to_fs_path(one.uri)))
            if path.suffix == ".ice":
                continue  # test_language_server_beside.py
            assert path.parent == ws / "speech/generated"
            line = path.read_text().splitlines()[one.range.start.line]
            word = line[one.range.start.character : one.range.end.character]
            assert word in ("say", "Speech_say"), line
            lines.append(line)
            back = await editor.client.text_document_definition_async(
                types.DefinitionParams(types.TextDocumentIdentifier(one.uri), one.range.end)
            )
            assert isinstance(back, types.Location) and (back.uri, back.range.start) == (
                interface.as_uri(), types.Position(2, 21),
            ), line  # fmt: skip
        head = {"python": "def Speech_say(", "cpp": "virtual void Speech_say(", "java": "abstract void Speech_say("}
        assert any(head[language] in line for line in lines), lines
        every = await editor.client.text_document_references_async(
            types.ReferenceParams(types.ReferenceContext(True), named, there)
        )
        assert every is not None and {str(one) for one in found} < {str(one) for one in every}
        source = await editor.client.text_document_implementation_async(types.ImplementationParams(named, there))
        assert isinstance(source, (list, tuple)) and source, "the user's method"
        assert not editor.messages

    edited(test)


def test_code_is_checked_where_no_document_is_open(ws: Path) -> None:
    code, other = ws / "speech/src/specificworker.py", ws.parent / "other/tool.py"
    write_tree(ws.parent, {"other/tool.py": "self.parameters.vloume\n", "other/wrong.idsl.yaml": "nothing: 1\n"})
    text = code.read_text().replace("print(", "print(self.parameters.vloume, ")

    async def test(editor: Editor) -> None:
        await editor.start(ws.parent)
        editor.open(other)
        editor.open(code)
        editor.change(code, text)
        _, wrong = await editor.until_codes(code, "RC6201", "RC6306")
        assert [action.title for action in await editor.actions(code, wrong.range)] == ["Write 'volume'"]
        editor.change(code, text.replace("vloume", "volume"))
        await editor.until_codes(code, "RC6201")
        editor.change(code, text)
        await editor.until_codes(code, "RC6201", "RC6306")
        editor.close(code)
        await editor.until_codes(code)
        assert not [path for path in editor.shown if "other" in str(path)], "that folder is none of rcyaml's"
        assert not editor.messages

    edited(test)
