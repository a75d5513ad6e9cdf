"""What `rcyaml lsp` says beside documents: places in code, lenses, hints, commands; and which server tells what."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("pygls")

from lsprotocol import types
from pygls import uris

from conftest import write_tree
from editor.editing import Editor, edited

pytestmark = pytest.mark.processes

ROBOT = "\U0001f916"
PLACE = {
    "rcyaml.yaml": "interfaces: [interfaces]\n",
    "interfaces/Speech.idsl.yaml": "module: RoboCompSpeech\ninterfaces:\n  Speech: {methods: {say: {in: {text: string}}}}\n",
    "speech/speech.cdsl.yaml": "component: SpeechComp\nlanguage: python\nimports: [Speech]\nimplements: [Speech]\n",
    "speech/speech.pdsl.yaml": "component: speech.cdsl.yaml\nparameters: {volume: {type: int, default: 3, range: [0, 9]}}\n",
    "speech/src/specificworker.py": (
        "from generated.genericworker import GenericWorker\n\n\nclass SpecificWorker(GenericWorker):\n"
        f"    def Speech_say(self, text: str) -> None:\n        print('{ROBOT}', self.parameters.volume, self.Speech_say)\n"
    ),
    "robot.ddsl.yaml": "deployment: Robot\ncomponents: {mouth: {component: speech}}\n",
}  # fmt: skip


@pytest.fixture
def ws(tmp_path: Path) -> Path:
    return write_tree(tmp_path / "ws", PLACE)


def _at(line: int, start: int, end: int) -> types.Range:
    return types.Range(types.Position(line, start), types.Position(line, end))


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
        assert _places(found, ws) == [(code, _at(4, 8, 18)), (code, _at(5, 49, 59))]
        made = await editor.client.text_document_implementation_async(types.ImplementationParams(named, there))
        assert _places(made, ws) == [(code, _at(4, 8, 18))]
        assert not editor.messages

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
            (_at(2, 2, 8), "1 implements it")
        ]
        hints = await editor.client.text_document_inlay_hint_async(
            types.InlayHintParams(types.TextDocumentIdentifier(robot.as_uri()), _at(0, 0, 0))
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
