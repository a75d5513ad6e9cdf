"""`rcyaml new interface`, `rcyaml new component` and `rcyaml new deployment`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import read_tree, write_tree
from robocomp_yaml import languages

Run = Callable[..., Result]
WORKSPACE = {"rcyaml.yaml": "interfaces: [interfaces]\n", "interfaces": None}
SPEECH = "module: RoboCompSpeech\ninterfaces:\n  Speech:\n    methods:\n      reset:\n"
EVENTS = "topics:\n  SpeechEvents:\n    methods:\n      spoken: {in: {text: string}}\n"


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    return write_tree(tmp_path, {**WORKSPACE, "interfaces/Speech.idsl.yaml": SPEECH + EVENTS})


def imports(path: Path) -> str:
    return next(line.partition(":")[2].partition("#")[0].strip() for line in path.read_text().splitlines()
                if line.startswith("imports:"))  # fmt: skip


@pytest.mark.parametrize("name", ["Mouth", "mouth", "RoboCompMouth", "X"])
def test_a_new_interface_checks_and_compiles(rcyaml: Run, workspace: Path, name: str) -> None:
    assert rcyaml("new", "interface", name).exit_code == 0
    document = f"interfaces/{name}.idsl.yaml"
    first = (workspace / document).read_text().splitlines()[0]
    assert first == "# yaml-language-server: $schema=../.rcyaml/schemas/idsl.schema.json"
    assert rcyaml("check", document).stdout == "1 document: nothing wrong\n"
    assert rcyaml("compile", document).exit_code == 0
    assert (workspace / ".rcyaml/schemas/idsl.schema.json").is_file()


@pytest.mark.parametrize("language", languages.table())
def test_a_new_component_checks_and_compiles(rcyaml: Run, workspace: Path, language: str) -> None:
    uses = ("--implements", "Speech", "--publishes", "SpeechEvents", "--subscribes", "SpeechEvents")
    result = rcyaml("new", "component", "TalkComp", "--language", language, *uses)
    assert result.exit_code == 0
    document = workspace / "components/talkcomp/talkcomp.cdsl.yaml"
    assert document.read_text().startswith("# yaml-language-server: $schema=../../.rcyaml/schemas/cdsl.schema.json\n")
    assert imports(document) == "[Speech]"
    assert rcyaml("check").stdout == "2 documents: nothing wrong\n"
    assert rcyaml("compile").exit_code == 0
    assert (workspace / "components/talkcomp/src").is_dir()


def test_a_component_needs_no_interfaces(rcyaml: Run, workspace: Path) -> None:
    assert rcyaml("new", "component", "Lonely").exit_code == 0
    assert rcyaml("check", "components").stdout == "1 document: nothing wrong\n"


def test_without_a_workspace_this_folder_becomes_one(rcyaml: Run, tmp_path: Path) -> None:
    assert rcyaml("new", "interface", "Speech").exit_code == 0
    assert rcyaml("new", "component", "TalkComp", "--requires", "Speech").exit_code == 0
    documents = {path for path in read_tree(tmp_path) if path.endswith(("idsl.yaml", "cdsl.yaml", "rcyaml.yaml"))}
    assert documents == {"rcyaml.yaml", "interfaces/Speech.idsl.yaml", "components/talkcomp/talkcomp.cdsl.yaml"}
    assert rcyaml("check").stdout == "2 documents: nothing wrong\n"


def test_new_works_in_a_folder_of_the_workspace(rcyaml: Run, workspace: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(workspace / "interfaces")
    assert "wrote ../interfaces/Mouth.idsl.yaml" in rcyaml("new", "interface", "Mouth").stdout
    rcyaml("new", "component", "TalkComp", "--requires", "Mouth")
    assert rcyaml("check", "..").stdout == "3 documents: nothing wrong\n"


def test_the_layout_of_the_workspace_is_used(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"rcyaml.yaml": "interfaces: [idsl, more]\n", "idsl": None, "more": None})
    rcyaml("new", "interface", "Speech")
    assert (tmp_path / "idsl/Speech.idsl.yaml").is_file()


def test_an_interface_that_is_not_searched_is_imported_by_path(rcyaml: Run, workspace: Path) -> None:
    write_tree(workspace, {"far/Mouth.idsl.yaml": SPEECH.replace("Speech", "Mouth")})
    rcyaml("new", "component", "TalkComp", "--requires", "Mouth")
    assert imports(workspace / "components/talkcomp/talkcomp.cdsl.yaml") == "[../../far/Mouth]"
    assert rcyaml("check", "components").exit_code == 0


def test_an_interface_of_another_folder_is_found_with_include(rcyaml: Run, workspace: Path, tmp_path: Path) -> None:
    elsewhere = tmp_path.parent / f"{tmp_path.name}-elsewhere"
    write_tree(elsewhere, {"Mouth.idsl.yaml": SPEECH.replace("Speech", "Mouth")})
    assert rcyaml("new", "component", "TalkComp", "--requires", "Mouth", "-I", str(elsewhere)).exit_code == 0
    assert rcyaml("check", "-I", str(elsewhere)).exit_code == 0


def test_an_ambiguous_interface_needs_its_module(rcyaml: Run, workspace: Path) -> None:
    other = SPEECH.replace("RoboCompSpeech", "RoboCompOther")
    write_tree(workspace, {"interfaces/Other.idsl.yaml": other})
    result = rcyaml("new", "component", "TalkComp", "--requires", "Speech")
    assert result.exit_code == 2
    assert "write RoboCompOther.Speech or RoboCompSpeech.Speech" in result.stderr
    assert rcyaml("new", "component", "TalkComp", "--requires", "RoboCompOther.Speech").exit_code == 0
    assert imports(workspace / "components/talkcomp/talkcomp.cdsl.yaml") == "[Other]"
    assert rcyaml("check").stdout == "3 documents: nothing wrong\n"


def components_of(root: Path) -> str:
    """The text of `components:` in the new deployment."""
    text = (root / "deployments/head.ddsl.yaml").read_text()
    return text.partition("\ncomponents:\n")[2].partition("\n\n")[0]


def errors(result: Result) -> list[str]:
    return [line for line in result.stdout.splitlines() if line.startswith("error")]


def test_a_new_deployment_has_the_workspaces_components(rcyaml: Run, workspace: Path) -> None:
    rcyaml("new", "component", "TalkComp", "--implements", "Speech", "--subscribes", "SpeechEvents")
    rcyaml("new", "component", "Listener", "--requires", "Speech", "--publishes", "SpeechEvents")
    result = rcyaml("new", "deployment", "Head")
    assert result.stdout.splitlines()[-1] == "next: rcyaml deploy plan deployments/head.ddsl.yaml"
    assert components_of(workspace).splitlines() == [
        "  listener:",
        "    component: ../components/listener/listener.cdsl.yaml",
        "  talk:",
        "    component: ../components/talkcomp/talkcomp.cdsl.yaml",
    ]
    assert "storm: {icestorm: }" in (workspace / "deployments/head.ddsl.yaml").read_text()
    assert rcyaml("compile").exit_code == 0
    assert rcyaml("check").stdout == "4 documents: nothing wrong\n"


def test_a_new_deployment_has_the_connections_that_do_not_follow(rcyaml: Run, workspace: Path) -> None:
    for name in ("TalkComp", "Talk2", "talk"):
        rcyaml("new", "component", name, "--implements", "Speech")
    rcyaml("new", "component", "Listener", "--requires", "Speech")
    rcyaml("new", "deployment", "Head")
    assert "      Speech: talk  # or talk2, talk3" in components_of(workspace).splitlines()
    assert errors(rcyaml("check")) == []


def test_a_new_deployment_invents_no_address(rcyaml: Run, workspace: Path) -> None:
    rcyaml("new", "component", "Listener", "--requires", "Speech")
    rcyaml("new", "deployment", "Head")
    assert "connect:" not in components_of(workspace) and "10000" not in components_of(workspace)
    checked = rcyaml("check")
    assert [line.partition("]")[0] for line in errors(checked)] == ["error[RC4201"], checked.stdout
    assert 'connect: {Speech: "speech:tcp -h HOST -p PORT"}' in checked.stdout


def test_a_new_deployment_sets_parameters_without_a_default(rcyaml: Run, workspace: Path) -> None:
    rcyaml("new", "component", "TalkComp")
    write_tree(workspace, {"components/talkcomp/talkcomp.pdsl.yaml": (
        "component: talkcomp.cdsl.yaml\nparameters:\n  device: string\n  speed: {type: int, default: 3}\n"
        "  Yolo: {group: {size: {type: int, range: [2, 4]}, on: {type: bool, optional: true}}}\n"
    )})  # fmt: skip
    rcyaml("new", "deployment", "Head")
    assert "    set: {device: text, Yolo: {size: 2}}  # examples" in components_of(workspace)
    assert errors(rcyaml("check")) == []


def test_compiling_a_new_deployment_compiles_its_components(rcyaml: Run, workspace: Path) -> None:
    rcyaml("new", "component", "TalkComp", "--implements", "Speech")
    rcyaml("new", "deployment", "Head")
    rcyaml("new", "component", "OtherComp")
    assert rcyaml("compile", "deployments/head.ddsl.yaml").exit_code == 0
    assert (workspace / "components/talkcomp/bin/TalkComp").is_file()
    assert not (workspace / "components/othercomp/bin").exists()


def test_a_new_deployment_without_components_checks(rcyaml: Run, tmp_path: Path) -> None:
    assert rcyaml("new", "deployment", "Head").exit_code == 0
    assert rcyaml("check").stdout == "1 document: nothing wrong\n"


@pytest.mark.parametrize(
    ("args", "reason"),
    [
        (["deployment", "../Head"], "is not a name"),
        (["interface", "../Speech"], "is not a name"),
        (["interface", "a/b"], "is not a name"),
        (["interface", "Sprache-1"], "is not a name"),
        (["interface", "1st"], "is not a name"),
        (["interface", "Señal"], "is not a name"),
        (["interface", "Speech\n"], "is not a name"),
        (["interface", ""], "is not a name"),
        (["interface", "X" * 500], "is too long: a name has at most"),
        (["interface", "_1"], "'_1' cannot be an interface"),
        (["interface", "interface"], "a reserved word of Slice"),
        (["interface", "Speech"], "interfaces/Speech.idsl.yaml exists already"),
        (["component", "../../etc/passwd"], "is not a name"),
        (["component", "Talk", "--language", "rust"], "'rust' is not one of"),
        (["component", "Talk", "--requires", "Spech"], "did you mean 'Speech'?"),
        (["component", "Talk", "--requires", "Qwerty"], "`rcyaml new interface NAME` writes one"),
        (["component", "Talk", "--requires", "Speech", "--requires", "Speech"], "--requires Speech is repeated"),
        (["component"], "Missing argument 'NAME'"),
        (["robot", "Shelly"], "unknown command 'new robot'"),
    ],
)
def test_wrong_usage_is_rejected_and_writes_nothing(rcyaml: Run, workspace: Path, args: list[str], reason: str) -> None:
    before = read_tree(workspace)
    result = rcyaml("new", *args)
    assert result.exit_code == 2
    assert reason in result.stderr.replace("\n", " ")
    assert read_tree(workspace) == before


@pytest.mark.parametrize(("name", "meant"), [("ArmCmp", "ArmComp"), ("armcmp", "armcomp"), ("Armcomp2", "armcomp")])
def test_parameters_of_a_misspelled_component(rcyaml: Run, workspace: Path, name: str, meant: str) -> None:
    rcyaml("new", "component", "ArmComp")
    before = read_tree(workspace)
    result = rcyaml("new", "parameters", name)
    assert (result.exit_code, read_tree(workspace)) == (2, before)
    assert f"unknown component '{name}'; did you mean '{meant}'?" in " ".join(result.stderr.split())


def test_parameters_may_come_before_their_component(rcyaml: Run, workspace: Path) -> None:
    assert rcyaml("new", "component", "ArmComp").exit_code == 0
    assert rcyaml("new", "parameters", "Gripper").exit_code == 0
    assert rcyaml("new", "parameters", "ArmComp").exit_code == 0
    assert rcyaml("new", "parameters", "ArmComp2").exit_code == 0, "the one that it is like has its own"
    assert rcyaml("check").exit_code == 0


def test_an_existing_component_is_kept(rcyaml: Run, workspace: Path) -> None:
    rcyaml("new", "component", "TalkComp")
    before = read_tree(workspace)
    assert rcyaml("new", "component", "talkcomp", "--language", "cpp").exit_code == 2
    assert read_tree(workspace) == before


def test_interfaces_are_completed_in_the_shell(workspace: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from click.shell_completion import BashComplete

    from robocomp_yaml.cli import group

    monkeypatch.chdir(workspace)
    shell = BashComplete(group, {}, "rcyaml", "_RCYAML_COMPLETE")
    found = shell.get_completions(["new", "component", "TalkComp", "--requires"], "Sp")
    assert [item.value for item in found] == ["Speech", "SpeechEvents"]


@pytest.mark.parametrize(
    "args", [("interface", "1x"), ("interface", "class"), ("component", "C", "--implements", "Nobody")]
)
def test_rejected_documents_leave_no_workspace(args: tuple[str, ...], rcyaml: Run, tmp_path: Path) -> None:
    assert rcyaml("new", *args).exit_code == 2
    assert list(tmp_path.iterdir()) == []


def test_several_interfaces_or_none(rcyaml: Run, tmp_path: Path) -> None:
    assert rcyaml("new", "interface", "Arm", "class", "Leg").exit_code == 2
    assert not list(tmp_path.iterdir())
    done = rcyaml("new", "interface", "Arm", "Leg", "Arm")
    assert done.stdout.endswith("next: rcyaml compile interfaces/Arm.idsl.yaml interfaces/Leg.idsl.yaml\n")
    assert rcyaml("check").stdout == "2 documents: nothing wrong\n"
    before = read_tree(tmp_path)
    assert "exists already" in rcyaml("new", "interface", "Hand", "Leg").stderr
    assert read_tree(tmp_path) == before
