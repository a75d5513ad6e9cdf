"""What `rcyaml lsp` says of the schemas, with and without a server of schemas beside it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

pytest.importorskip("pygls")

from lsprotocol import types

from conftest import write_tree
from editor.editing import Editor, edited
from editor.robot import DOCUMENTS
from robocomp_yaml import api
from robocomp_yaml.api.completing import schema_keys
from robocomp_yaml.source.discover import kind_of
from robocomp_yaml.source.tree import Mapping, Node, Sequence, parse

pytestmark = pytest.mark.processes

NAMED_BY_THE_USER = {"force", "mode", "fingers", "length"}  # parameters, which are in no schema of the package


def _paths(node: Node, keys: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    if isinstance(node, Mapping):
        for key, value in node.items():
            yield (*keys, key.lexeme)
            yield from _paths(value, (*keys, key.lexeme))
    for item in node.items if isinstance(node, Sequence) else ():
        yield from _paths(item, (*keys, ""))


@pytest.mark.parametrize("name", [name for name in DOCUMENTS if name.endswith(".yaml")])
def test_every_key_has_its_documentation(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(write_tree(tmp_path, DOCUMENTS))
    root, _ = parse(name, DOCUMENTS[name])
    assert root is not None
    kind = kind_of(name) or "workspace"
    without = {keys for keys in _paths(root) if not schema_keys.about(kind, keys)}
    assert {keys[-1] for keys in without} <= NAMED_BY_THE_USER, without


async def _hovered(editor: Editor, path: Path, text: str) -> tuple[str, types.Range] | None:
    """What is shown at the `|` in a text."""
    before, behind = text.split("|")
    editor.change(path, before + behind)
    lines = before.split("\n")
    there = types.Position(len(lines) - 1, len(lines[-1].encode("utf-16-le")) // 2)
    found = await editor.client.text_document_hover_async(
        types.HoverParams(types.TextDocumentIdentifier(path.as_uri()), there)
    )
    if found is None:
        return None
    assert isinstance(found.contents, types.MarkupContent) and found.range is not None
    return found.contents.value, found.range


COMPONENT = "component: EyeComp\nlanguage: python\nperiod: 20\nimports: [Gripper]\nrequires: [Gripper]\n"


@pytest.mark.parametrize("schema_server", ["no", "auto"])
def test_without_a_server_of_schemas_keys_have_their_documentation(tmp_path: Path, schema_server: str) -> None:
    ws = write_tree(tmp_path / "ws", {**DOCUMENTS, "eye/eye.cdsl.yaml": COMPONENT, "loose/rcyaml.yaml": ""})
    eye, settings = ws / "eye/eye.cdsl.yaml", ws / "rcyaml.yaml"

    async def test(editor: Editor) -> None:
        await editor.start(ws, schema_server=schema_server)
        editor.open(eye)
        editor.open(settings)
        shown = await _hovered(editor, eye, COMPONENT.replace("period", "per|iod"))
        assert shown is not None and shown[0].startswith("#### ") and "compute()" in shown[0]
        assert shown[1] == types.Range(types.Position(2, 0), types.Position(2, 6))
        crlf = COMPONENT.replace("\n", "\r\n").replace(
            "period: 20", "x-note: \U0001f916 # \U0001f916\r\nlang: \U0001f916"
        )
        assert await _hovered(editor, eye, crlf.replace("lang:", "la|ng:")) is None, "it is no key"
        named = await _hovered(editor, eye, COMPONENT.replace("requires: [Gripper", "requires: [Grip|per"))
        assert named is not None and "interface" in named[0] and "\n---\n\n#### " in named[0], "the name and the place"
        broken = await _hovered(editor, eye, "component: EyeComp\nlang|uage: {name: cpp\n")
        assert broken is not None and broken[0].startswith("#### Language")
        value = await _hovered(editor, eye, COMPONENT.replace(": python", ": pyt|hon"))
        assert value is not None and value[0].startswith("#### Language")
        assert await _hovered(editor, eye, COMPONENT + "# per|iod\n") is None
        assert (found := await _hovered(editor, settings, "inter|faces: [interfaces]\n")) and "#### " in found[0]
        assert not editor.messages

    edited(test)


def test_beside_a_server_of_schemas_nothing_is_told_or_offered_twice(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ws = write_tree(tmp_path / "ws", {**DOCUMENTS, "eye/eye.cdsl.yaml": COMPONENT})
    eye = ws / "eye/eye.cdsl.yaml"

    async def offered(editor: Editor, text: str) -> set[str]:
        before, behind = text.split("|")
        editor.change(eye, before + behind)
        lines = before.split("\n")
        found = await editor.client.text_document_completion_async(
            types.CompletionParams(
                types.TextDocumentIdentifier(eye.as_uri()), types.Position(len(lines) - 1, len(lines[-1]))
            )
        )
        return {one.label for one in (found if isinstance(found, list) else found.items if found else ())}

    async def test(editor: Editor) -> None:
        await editor.start(ws, schema_server="yes")
        editor.open(eye)
        assert await _hovered(editor, eye, COMPONENT.replace("period", "per|iod")) is None
        assert "Gripper" in await offered(editor, COMPONENT.replace("requires: [Gripper]", "requires: [|]"))
        monkeypatch.chdir(ws)
        assert not api.load().compile().apply().has_errors
        fresh = "module: RoboCompFresh\ninterfaces: {Fresh: {methods: {go: }}}\n"
        editor.open(ws / "interfaces/Fresh.idsl.yaml", fresh)
        await editor.rest()
        names = await offered(editor, COMPONENT.replace("requires: [Gripper]\n", "requires: [|]\n"))
        assert "Gripper" not in names, "the schema offers it"
        assert "Fresh" in names, "it is in no schema yet"
        assert not editor.messages

    edited(test)


@pytest.mark.parametrize("schema_server", ["no", "yes"])
def test_values_say_what_they_are(tmp_path: Path, schema_server: str) -> None:
    """Of which parameter, and what the enumerators mean; no server of schemas knows that under `set:`."""
    values = "component: ../eye.cdsl.yaml\nparameters:\n  mode: slow\n  lenses: [{width: 3}]\n"
    robot = (
        "deployment: Robot\ncomponents:\n"
        "  eye: {component: eye, set: {mode: fast, 'lenses[0].width': 4, camera.gain: 2, lenses: [{width: 5}]}}\n"
    )
    ws = write_tree(
        tmp_path / "ws",
        {
            "rcyaml.yaml": "",
            "eye/eye.cdsl.yaml": "component: EyeComp\nlanguage: python\n",
            "eye/eye.pdsl.yaml": (
                "component: eye.cdsl.yaml\n"
                "types: {Mode: {enum: {slow: {doc: With care.}, fast: }}, Lens: {struct: {width: {type: int, unit: mm}}}}\n"
                "parameters:\n  mode: {type: Mode, default: slow, doc: How it looks.}\n  lenses: {list: Lens, default: []}\n"
                "  camera: {group: {gain: {type: float, default: 1.5}}}\n"
            ),
            "eye/etc/config.yaml": values,
            "robot.ddsl.yaml": robot,
        },
    )
    config, deployment = ws / "eye/etc/config.yaml", ws / "robot.ddsl.yaml"

    async def test(editor: Editor) -> None:
        async def hovered(path: Path, text: str) -> str:
            return (await _hovered(editor, path, text) or ("",))[0]

        await editor.start(ws, schema_server=schema_server)
        editor.open(config)
        editor.open(deployment)
        told = await hovered(deployment, robot.replace(": fast", ": fa|st"))
        assert "parameter mode: " in told and "How it looks." in told and "- `slow`: With care." in told
        assert "parameter lenses[0].width: int" in await hovered(deployment, robot.replace("width': 4", "width': |4"))
        assert "parameter lenses.width: int" in await hovered(deployment, robot.replace("width: 5", "width: |5"))
        assert "default: 1.5" in await hovered(deployment, robot.replace("gain: 2", "gain: |2"))
        elsewhere = robot.replace("component: eye,", "component: nowhere,")
        assert not await hovered(deployment, elsewhere.replace(": fast", ": fa|st"))
        with_ours = [await hovered(config, values.replace(*one)) for one in ((": slow", ": sl|ow"), (": 3", ": |3"))]
        if schema_server == "yes":
            assert with_ours == ["", ""], "that is said by the schema"
        else:
            assert "With care." in with_ours[0] and "parameter lenses.width: int" in with_ours[1]
        assert not editor.messages

    edited(test)
