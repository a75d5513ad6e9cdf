"""What the components of a workspace share, and which components are standalone."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import Tree, write_tree
from robocomp_yaml import resources
from robocomp_yaml.emit import runtime
from robocomp_yaml.emit.exports import compose

MOTOR = "module: RoboCompMotor\nimports: [Types]\ninterfaces:\n  Motor:\n    methods:\n      move: {in: {to: Types.Angle}}\n"
TYPES = "module: Types\ntypes:\n  Angle: {struct: {degrees: float}}\n"
HAND = "module: RoboCompHand\ninterfaces:\n  Hand:\n    methods:\n      grip: {}\n"
WORKSPACE: Tree = {
    "rcyaml.yaml": "interfaces: [interfaces]\n",
    "interfaces/Motor.idsl.yaml": MOTOR,
    "interfaces/Types.idsl.yaml": TYPES,
    "interfaces/Hand.idsl.yaml": HAND,
    "components/motor/motor.cdsl.yaml": "component: MotorComp\nlanguage: cpp\nimports: [Motor]\nimplements: [Motor]\n",
    "components/arm/arm.cdsl.yaml": "component: ArmComp\nlanguage: cpp\nimports: [Motor, Hand]\nrequires: [Motor, Hand]\n",
}
Run = Callable[..., Result]
LANGUAGES = {
    "cpp": ("runtime/cpp", "generated/component.cmake", "generated/runtime/log.cpp"),
    "java": ("runtime/java", "generated/Main.java", "generated/runtime/Log.java"),
    "python": ("runtime/python/generated", "generated/component.py", "generated/runtime/log.py"),
}
ROBOCOMP = "compatibility: robocomp\n"
SHARED, STATES = "runtime/cpp", "generated/component.cmake"


def files(folder: Path) -> set[str]:
    found = {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}
    return {path for path in found if ".rcyaml/" not in path}


def generated(folder: Path, component: str) -> set[str]:
    return {path for path in files(folder / "components" / component) if path.startswith("generated/")}


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    return write_tree(tmp_path, WORKSPACE)


def in_language(workspace: Path, language: str, more: str = "") -> None:
    for document in workspace.glob("components/*/*.cdsl.yaml"):
        document.write_text(document.read_text().replace("cpp", language) + more)


@pytest.mark.parametrize(
    ("language", "more"),
    [*((language, "") for language in LANGUAGES), ("cpp", ROBOCOMP), ("python", ROBOCOMP)],
)
def test_run_time_and_slice_are_written_once(rcyaml: Run, workspace: Path, language: str, more: str) -> None:
    in_language(workspace, language, more)
    shared = workspace / LANGUAGES[language][0]
    assert rcyaml("-q", "compile", ".").exit_code == 0
    for component in ("motor", "arm"):
        own = files(workspace / "components" / component)
        assert len(generated(workspace, component)) <= (12 if more else 10)
        assert not any(path.startswith(("slice/", "generated/runtime/")) for path in own)
    assert files(workspace / "slice") == {"Motor.ice", "Types.ice", "Hand.ice"}
    assert files(shared) == {file.path for file in runtime.files(language)}
    assert "slice/CommonBehavior.ice" in files(shared)


def test_compiling_one_component_writes_what_it_shares(rcyaml: Run, workspace: Path) -> None:
    assert rcyaml("-q", "compile", "components/motor").exit_code == 0
    assert files(workspace / "slice") == {"Motor.ice", "Types.ice"}
    assert files(workspace / SHARED)
    assert rcyaml("-q", "compile", "components/arm").exit_code == 0
    assert files(workspace / "slice") == {"Motor.ice", "Types.ice", "Hand.ice"}


def test_the_second_compile_changes_nothing(rcyaml: Run, workspace: Path) -> None:
    rcyaml("-q", "compile", ".")
    assert rcyaml("-q", "compile", "--check", ".").exit_code == 0
    assert rcyaml("-q", "compile", "--check", "components/arm").exit_code == 0
    assert rcyaml("-q", "compile", "--check", "interfaces").exit_code == 0


def test_a_module_without_a_document(rcyaml: Run, workspace: Path) -> None:
    rcyaml("-q", "compile", ".")
    (workspace / "interfaces/Hand.idsl.yaml").unlink()
    (workspace / "components/arm/arm.cdsl.yaml").write_text("component: ArmComp\nlanguage: cpp\n")
    assert rcyaml("-q", "compile", ".").exit_code == 0
    assert files(workspace / "slice") == {"Motor.ice", "Types.ice"}


def test_configured_folders(rcyaml: Run, workspace: Path) -> None:
    (workspace / "rcyaml.yaml").write_text(
        "interfaces: [interfaces]\noutput: {slice: made/ice, runtime: made/common}\n"
    )
    assert rcyaml("-q", "compile", ".").exit_code == 0
    assert files(workspace / "made/common/cpp") and "Motor.ice" in files(workspace / "made/ice")
    states = (workspace / "components/motor" / STATES).read_text()
    assert "../../made/common/cpp" in states and "../../made/ice" in states


@pytest.mark.parametrize("language", LANGUAGES)
def test_standalone_and_back(rcyaml: Run, workspace: Path, language: str) -> None:
    """As with a workspace of an earlier version, in which each component had its own run time."""
    in_language(workspace, language)
    code = {"cpp": "src/specificworker.cpp", "java": "src/SpecificWorker.java", "python": "src/specificworker.py"}[
        language
    ]
    yours = {"cpp": "CMakeLists.txt", "java": "bin/.gitignore", "python": "bin/MotorComp"}[language]
    assert rcyaml("-q", "compile", "--standalone", ".").exit_code == 0
    assert not (workspace / "runtime").exists()
    motor = workspace / "components/motor"
    assert {"slice/Motor.ice", LANGUAGES[language][2], "generated/slice/CommonBehavior.ice"} <= files(motor)
    (motor / code).write_text("# mine\n")
    (motor / yours).write_text("# mine, too\n")
    assert rcyaml("-q", "compile", ".").exit_code == 0
    assert len(generated(workspace, "motor")) <= 10 and not (motor / "slice").exists()
    assert (motor / code).read_text() == "# mine\n"
    assert (motor / yours).read_text() == "# mine, too\n"
    assert rcyaml("-q", "compile", "--check", ".").exit_code == 0
    assert rcyaml("-q", "compile", "--check", "--standalone", ".").exit_code == 1


def test_outside_a_workspace_it_is_standalone(rcyaml: Run, workspace: Path) -> None:
    (workspace / "rcyaml.yaml").unlink()
    assert rcyaml("-q", "compile", "-I", "interfaces", ".").exit_code == 0
    assert {"slice/Hand.ice", "generated/runtime/log.cpp"} <= files(workspace / "components/arm")
    assert not (workspace / "runtime").exists()


def test_with_an_output_folder_it_is_standalone(rcyaml: Run, workspace: Path) -> None:
    assert rcyaml("-q", "compile", ".", "-o", "out").exit_code == 0
    assert {"slice/Hand.ice", "generated/runtime/log.cpp"} <= files(workspace / "out/components/arm")


@pytest.mark.parametrize("is_same", [True, False])
def test_a_common_behavior_of_the_workspace(rcyaml: Run, workspace: Path, is_same: bool) -> None:
    """Only one with the meaning of RoboComp's can be replaced by that of the run time."""
    text = resources.text("templates/slice/CommonBehavior.ice")
    text = re.sub(r"/\*\*.*?\*/\s*", "", text) if is_same else text.replace("timeAwake", "awake")
    write_tree(workspace, {"CommonBehavior.ice": text})
    assert rcyaml("migrate", "CommonBehavior.ice", "-o", "interfaces").exit_code == 0
    cdsl = workspace / "components/motor/motor.cdsl.yaml"
    cdsl.write_text(cdsl.read_text().replace("[Motor]", "[Motor, CommonBehavior]", 1))
    assert rcyaml("-q", "compile", ".").exit_code == 0
    assert ("generated/runtime/log.cpp" in generated(workspace, "motor")) is not is_same
    assert len(generated(workspace, "arm")) <= 10
    if is_same:
        assert "CommonBehavior" not in (workspace / "components/motor" / STATES).read_text()


def test_interfaces_of_another_workspace(rcyaml: Run, workspace: Path) -> None:
    """Their Slice is in the component's folder, because the other workspace is not requested."""
    write_tree(workspace / "other", {"rcyaml.yaml": "", "Eye.idsl.yaml": HAND.replace("Hand", "Eye")})
    home = workspace / "home"
    write_tree(home, {path: text for path, text in WORKSPACE.items() if "arm" not in path})
    cdsl = home / "components/motor/motor.cdsl.yaml"
    cdsl.write_text(cdsl.read_text().replace("[Motor]", "[Motor, Eye]", 1))
    assert rcyaml("-q", "compile", "-I", "other", "home").exit_code == 0
    own = files(home / "components/motor")
    assert {"slice/Eye.ice", "slice/Motor.ice"} <= own and not any("runtime" in path for path in own)
    assert files(home / SHARED) and not (workspace / "other/slice").exists()


def test_an_edited_file_of_the_run_time_is_kept(rcyaml: Run, workspace: Path) -> None:
    rcyaml("-q", "compile", ".")
    log = workspace / SHARED / "runtime/log.cpp"
    log.write_text(log.read_text() + "// mine\n")
    done = rcyaml("-q", "compile", ".")
    assert "log.cpp.orig" in done.output and log.with_name("log.cpp.orig").read_text().endswith("// mine\n")
    assert not log.read_text().endswith("// mine\n")


@pytest.mark.parametrize("language", LANGUAGES)
def test_only_the_compiled_component_has_a_change(rcyaml: Run, workspace: Path, language: str) -> None:
    """The other one shares the changed Slice, and reports that it must be compiled."""
    in_language(workspace, language)
    (workspace / "lab.ddsl.yaml").write_text(
        "deployment: Lab\ncomponents:\n  motor: {component: components/motor/motor.cdsl.yaml}\n"
        "  arm: {component: components/arm/arm.cdsl.yaml, enabled: true, connect: {Hand: 'hand:tcp -p 10099'}}\n"
    )
    rcyaml("-q", "compile", ".")
    assert "RC7012" not in rcyaml("deploy", "plan").output
    (workspace / "interfaces/Types.idsl.yaml").write_text(TYPES.replace("degrees", "radians"))
    assert rcyaml("deploy", "plan").output.count("RC7012") == 2
    assert rcyaml("-q", "compile", "components/motor").exit_code == 0
    told = rcyaml("deploy", "plan").output
    assert told.count("RC7012") == 1 and "'arm' was compiled before" in told


def test_an_interface_beside_a_component_that_hides_another(rcyaml: Run, workspace: Path) -> None:
    """The shared Slice is that of the folder of interfaces."""
    write_tree(workspace, {"components/arm/Hand.idsl.yaml": HAND.replace("grip", "open")})
    assert rcyaml("-q", "compile", "components/motor", "components/arm/arm.cdsl.yaml").exit_code == 0
    assert "void open" in (workspace / "components/arm/slice/Hand.ice").read_text()
    assert not (workspace / "slice/Hand.ice").exists() and (workspace / "slice/Motor.ice").exists()
    assert not any("runtime" in path for path in generated(workspace, "arm"))


@pytest.mark.parametrize(("language", "is_read"), [("python", True), ("java", False)])
def test_a_container_has_what_a_component_shares(
    rcyaml: Run, workspace: Path, monkeypatch: pytest.MonkeyPatch, language: str, is_read: bool
) -> None:
    """Unless the program was built, and contains it."""
    monkeypatch.setattr(compose, "_SYSTEM", re.compile("$^"))  # these folders are below /tmp
    in_language(workspace, language)
    (workspace / "lab.ddsl.yaml").write_text(
        "deployment: Lab\ncomponents:\n  motor: {component: components/motor/motor.cdsl.yaml}\n"
    )
    rcyaml("-q", "compile", ".")
    made = rcyaml("deploy", "export", "--as", "compose").output
    for shared in ("runtime", "slice"):
        assert (f'source: "{workspace / shared}",' in made) is is_read
    assert f'source: "{workspace / "components" / "motor"}",' in made


def test_forty_components_have_few_files(rcyaml: Run, tmp_path: Path) -> None:
    """Eighteen files for each one: its own, its interface, and its part of the run time."""
    tree: Tree = {"rcyaml.yaml": "interfaces: [.]\n"}
    for number in range(40):
        name, needed = f"Part{number}", f"Part{(number + 1) % 40}"
        tree[f"{name}.idsl.yaml"] = f"module: RoboComp{name}\ninterfaces: {{{name}: {{methods: {{stop: }}}}}}\n"
        tree[f"{name}/part.cdsl.yaml"] = (
            f"component: {name}Comp\nlanguage: cpp\nimports: [{name}, {needed}]\n"
            f"implements: [{name}]\nrequires: [{needed}]\n"
        )
    write_tree(tmp_path, tree)
    assert rcyaml("-q", "compile", ".").exit_code == 0
    written = len(files(tmp_path)) - len(tree)
    assert 600 < written <= 720
