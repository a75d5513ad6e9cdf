"""The library: what it promises, and that the command line prints the same."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import Tree, read_tree, write_tree
from robocomp_yaml import api

Rcyaml = Callable[..., Result]

SPEECH = "module: RoboCompSpeech\ninterfaces: {Speech: {methods: {say: {in: {text: string}}}}}\n"
TREE: Tree = {
    "rcyaml.yaml": "interfaces: [interfaces]\n",
    "interfaces/Speech.idsl.yaml": SPEECH,
    "speech/speech.cdsl.yaml": "component: SpeechComp\nlanguage: python\nimports: [Speech]\nimplements: [Speech]\n",
    "speech/speech.pdsl.yaml": "component: speech.cdsl.yaml\nparameters:\n  volume: {type: int, default: 3, range: [0, 9]}\n",
    "speech/etc/config.yaml": "component: ../speech.cdsl.yaml\nparameters: {volume: 4}\n",
    "robot.ddsl.yaml": "deployment: Robot\ncomponents: {speech: {component: speech}}\n",
}


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(write_tree(tmp_path, TREE))
    return tmp_path


def test_all_promised_names_exist() -> None:
    assert sorted(api.__all__) == sorted(set(api.__all__))
    for name in api.__all__:
        assert getattr(api, name) is not None
    with pytest.raises(AttributeError):
        api.nothing  # noqa: B018


def test_check_and_the_command_report_the_same(place: Path, rcyaml: Rcyaml) -> None:
    write_tree(place, {"interfaces/Bad.idsl.yaml": "module: RoboCompBad\nimports: [Speach]\n"})
    printed = json.loads(rcyaml("check", "--format", "json").stdout)["diagnostics"]
    found = api.load().check()
    assert [(one.code, one.message, one.span.file, one.span.line) for one in found] == [
        (one["code"], one["message"], one["file"], one["line"]) for one in printed
    ]
    assert str(found[0]) == ("interfaces/Bad.idsl.yaml:2:11: error[RC1101]: unknown import 'Speach'")


def test_an_overlay_is_used_everywhere(place: Path) -> None:
    texts = {
        "interfaces/Speech.idsl.yaml": SPEECH.replace("say:", "stop: {}, say:"),
        "mouth/mouth.cdsl.yaml": "component: MouthComp\nlanguage: cpp\nimports: [Speech]\nrequires: [Speech]\n",
        "speech/etc/config.yaml": "component: ../speech.cdsl.yaml\nparameters: {volume: 7}\n",
        "robot.ddsl.yaml": "deployment: Robot\ncomponents: {a: {component: speech}, b: {component: mouth}}\n",
    }
    before = read_tree(place)
    workspace = api.load(overlay=texts)
    assert "mouth/mouth.cdsl.yaml" in workspace.documents
    assert {one.code for one in workspace.check()} == {
        "RC4403"
    }  # the documents have no errors; nothing is compiled yet
    assert sorted(workspace.network().processes) == ["a", "b"]
    assert workspace.values("speech/etc/config.yaml").get("volume") == 7
    paths = {file.path for file in workspace.compile().files}
    assert {"mouth/CMakeLists.txt", "speech/bin/SpeechComp"} <= paths
    assert read_tree(place) == before


def test_a_compile_writes_nothing_before_apply(place: Path, rcyaml: Rcyaml) -> None:
    before = read_tree(place)
    plan = api.load().compile()
    assert plan.dirty and not plan.has_errors and read_tree(place) == before
    diff = next(file.diff for file in plan.look(with_diff=True).files if file.path == "slice/Speech.ice")
    assert "+module RoboCompSpeech" in diff
    done = plan.apply()
    assert [(file.path, file.action) for file in done.files] == [(file.path, file.action) for file in plan.files]
    assert rcyaml("compile", "--check").exit_code == 0
    assert not api.load().compile().dirty


def test_apply_uses_the_current_files(place: Path) -> None:
    plan = api.load().compile()
    write_tree(place, {"slice/Speech.ice": "// mine\n"})
    done = plan.apply()
    assert {one.code for one in done.diagnostics if one.severity == api.ERROR} == {"RC6001"}
    assert (place / "slice/Speech.ice").read_text() == "// mine\n"
    assert not (place / "slice/CommonBehavior.ice").exists()


def test_which_network(place: Path) -> None:
    assert api.load().network("robot.ddsl.yaml").name == "Robot"
    write_tree(place, {"arm.ddsl.yaml": "deployment: Arm\ncomponents: {x: {program: /bin/true}}\n"})
    workspace = api.load()
    assert sorted(workspace.networks) == ["arm.ddsl.yaml", "robot.ddsl.yaml"]
    with pytest.raises(api.Refused, match="arm.ddsl.yaml, robot.ddsl.yaml"):
        workspace.network()
    with pytest.raises(api.Refused, match="'leg.ddsl.yaml' is not a deployment"):
        workspace.network("leg.ddsl.yaml")
    write_tree(place, {"arm.ddsl.yaml": "deployment: [\n"})
    with pytest.raises(api.Faulty) as faulty:
        api.load().network("arm.ddsl.yaml")
    assert {one.span.file for one in faulty.value.diagnostics} == {"arm.ddsl.yaml"}
    with pytest.raises(api.Refused, match="no deployment"):
        api.load("interfaces").network()


def test_values(place: Path) -> None:
    values = api.load().values("SpeechComp")
    assert values.file == "speech/etc/config.yaml" and not values.diagnostics
    row = values.rows()[0]
    assert (row.path, row.data, row.node is not None) == ("volume", 4, True)
    with pytest.raises(api.Refused, match="did you mean 'volume'"):
        values.get("volumee")
    with pytest.raises(api.Faulty, match="0 to 9"):
        values.set("volume", "10")
    change = values.set("volume", "9")
    assert (change.value, change.was) == ("9", "4") and "+parameters: {volume: 9}" in change.diff()
    assert values.get("volume") == 4
    change.apply()
    assert api.load().values("speech").get("volume") == 9
    assert "volume=9" in api.load().values("speech").export()


def test_a_document_that_has_changed_meanwhile_is_kept(place: Path) -> None:
    """Locations are those of the text that was read, not of the current one."""
    values = api.load().values("speech")
    write_tree(place, {"speech/etc/config.yaml": "# mine\ncomponent: ../speech.cdsl.yaml\nparameters: {volume: 4}\n"})
    change = values.set("volume", "9")
    assert change.after == b"component: ../speech.cdsl.yaml\nparameters: {volume: 9}\n"
    with pytest.raises(api.Refused, match="changed meanwhile"):
        change.apply()
    assert (place / "speech/etc/config.yaml").read_text().startswith("# mine\n")


def test_migrating_writes_nothing_before_apply(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write_tree(tmp_path, {"old/Mouth.idsl": "module RoboCompMouth { interface Mouth { void close(); }; };\n"})
    migration = api.migrate("old")
    assert ("old/Mouth.idsl.yaml", "create") in [(file.path, file.action) for file in migration.files]
    assert not (tmp_path / "old/Mouth.idsl.yaml").exists() and not migration.has_errors and migration.lost == 0
    migration.apply()
    assert api.load("old").check() == []
    assert {file.action for file in api.migrate("old").files} == {"unchanged"}


def test_a_text_that_no_file_can_have_is_reported() -> None:
    (found,) = api.load("a.idsl.yaml", overlay={"a.idsl.yaml": "module: \ud800\n"}).check()
    assert (found.code, found.span.line, found.span.column) == ("RC0002", 1, 9)


def test_values_have_two_forms_for_programs(tmp_path: Path) -> None:
    (tmp_path / "p.pdsl.yaml").write_text("parameters: {a: {type: int, default: 1}}\n")
    (tmp_path / "x.config.yaml").write_text("component: p.pdsl.yaml\nparameters: {a: 2}\n")
    values = api.load(str(tmp_path)).values(str(tmp_path / "x.config.yaml"))
    assert "a=2" in values.export() and "a = 2" in values.export("toml")
    with pytest.raises(api.Refused, match="choose ice or toml"):
        values.export("tmol")


IMPOSSIBLE: dict[str, Callable[[str], object]] = {
    "load": lambda path: api.load(path).check(),
    "include": lambda path: api.load(include=[path]),
    "overlay": lambda path: api.load(overlay={path: "x"}),
    "follow": lambda path: api.follow(path),
    "edit": lambda path: api.edit(path),
    "living edit": lambda path: api.follow().edit(path, "x"),
    "look": lambda path: api.follow().look(path),
    "glance": lambda path: api.follow().glance(path),
    "values": lambda path: api.load().values(path),
    "deployment": lambda path: api.load().deployment(path),
    "lenient deployment": lambda path: api.load().deployment(path, lenient=True),
    "network": lambda path: api.load().network(path),
    "output": lambda path: api.load().compile(output=path),
    "migrate": lambda path: api.migrate(path),
    "output of migrate": lambda path: api.migrate("speech", output=path),
}


@pytest.mark.parametrize("path", ["a\0b", "a\0b.cdsl.yaml", "a\ud800b"], ids=["NUL", "NUL in a name", "surrogate"])
@pytest.mark.parametrize("call", IMPOSSIBLE)
def test_a_path_that_no_file_can_have_is_refused(place: Path, call: str, path: str) -> None:
    with pytest.raises(api.Refused, match="cannot be the path of a file"):
        IMPOSSIBLE[call](path)


@pytest.mark.parametrize(
    ("folder", "said"),
    [("nowhere", "there is no folder 'nowhere'"), ("robot.ddsl.yaml", "'robot.ddsl.yaml' is not a folder")],
)
def test_a_folder_of_imports_must_exist(place: Path, rcyaml: Rcyaml, folder: str, said: str) -> None:
    for call in (api.load, api.follow, api.edit, api.migrate):
        with pytest.raises(api.Refused, match=said):
            call(include=["interfaces", folder])
    result = rcyaml("check", "-I", folder)
    assert result.exit_code == 2 and ("is a file" in result.stderr or said in result.stderr)


def test_a_folder_of_imports_may_be_unsaved(place: Path) -> None:
    unsaved = {"more/Face.idsl.yaml": "module: F\n", "x.cdsl.yaml": "component: X\nlanguage: python\nimports: [Face]\n"}
    assert "RC1101" not in {one.code for one in api.load("x.cdsl.yaml", include=["more"], overlay=unsaved).check()}


def test_apply_writes_what_no_error_blocks_and_the_files_for_editors(place: Path) -> None:
    """As docs/api.md says."""
    write_tree(place, {"bad/bad.cdsl.yaml": "component: BadComp\nlanguage: python\nimports: [Nope]\n"})
    plan = api.load().compile()
    assert plan.has_errors and plan.outcome.left_out == {"bad/bad.cdsl.yaml": True}
    planned = {file.path for file in plan.files}
    assert planned == {file.path for file in plan.apply().files}
    found = read_tree(place)
    assert planned <= found.keys() and not [path for path in found if path.startswith(("bad/generated", "bad/src"))]
    for file in (".vscode/settings.json", ".rcyaml/schemas/cdsl.schema.json"):
        assert file in found and file not in planned
