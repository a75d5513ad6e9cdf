"""Which schema an editor takes for a document: by its modeline, or by the workspace's settings."""

from __future__ import annotations

from editor.workbench import Workbench

WRONG = {
    "idsl": ("module: 1\n", "module: is a name"),
    "cdsl": ("component: 1\nlanguage: cpp\n", "component: is a name"),
}


def test_the_modeline_names_the_schema(editor: Workbench) -> None:
    for kind, (text, message) in WRONG.items():
        [[marked]] = editor.messages(kind, [text])
        assert message in marked


def test_the_settings_name_the_schema_where_there_is_no_modeline(editor: Workbench) -> None:
    for kind, (text, message) in WRONG.items():
        for name in (f"some.{kind}.yaml", f"below/{kind}.yaml"):
            [[marked]] = editor.marked([(editor.folder / name, text)])
            assert message in marked
    [[marked]] = editor.marked([(editor.folder / "rcyaml.yaml", "interfaces: 1\n")])
    assert "interfaces: is a list of folders" in marked


def test_other_yaml_is_left_alone(editor: Workbench) -> None:
    assert editor.marked([(editor.folder / "compose.yaml", "module: 1\n")]) == [[]]
