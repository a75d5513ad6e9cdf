"""Repositories as they are: copies of interfaces, interfaces elsewhere, files of other programs, second configs, paths of
other machines, and code of every generation of RoboComp's own tool."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree

Run = Callable[..., Result]


def module(name: str, methods: str = "void go();") -> str:
    return f"module RoboComp{name} {{ interface {name} {{ {methods} }}; }};\n"


def cdsl(name: str, *, requires: str = "", implements: str = "", imports: str = "", language: str = "python") -> str:
    lines = "".join(f'import "{one}.idsl";\n' for one in imports.split())
    ports = f"requires {requires};" * bool(requires) + f"implements {implements};" * bool(implements)
    return f"{lines}Component {name} {{ Communications {{ {ports} }}; language {language}; }};\n"


def document(path: Path, key: str) -> str:
    return next((line for line in path.read_text().splitlines() if line.startswith(f"{key}:")), "")


# Copies of interfaces


@pytest.mark.parametrize("folder", ["src", "generated"])
def test_a_copy_is_skipped_if_its_original_is_known(rcyaml: Run, tmp_path: Path, folder: str) -> None:
    write_tree(tmp_path, {
        "interfaces/Arm.idsl": module("Arm"), f"a/{folder}/Arm.ice": module("Arm", "void old();"),
        f"a/{folder}/Leg.ice": module("Leg"), "a/a.cdsl": cdsl("A", requires="Arm", imports="Arm"),
    })  # fmt: skip
    result = rcyaml("migrate", ".")
    assert result.exit_code == 0 and "2 skipped, since they are copies" in result.output
    assert document(tmp_path / "rcyaml.yaml", "interfaces") == "interfaces: [interfaces]"
    assert sorted(path.name for path in tmp_path.rglob("*.idsl.yaml")) == ["Arm.idsl.yaml"]
    assert rcyaml("compile").exit_code == 0
    assert "void old" not in (tmp_path / "slice/Arm.ice").read_text()


def test_a_copy_without_an_original_belongs_to_its_component(rcyaml: Run, tmp_path: Path) -> None:
    """Two components have different versions of one interface; a third one has none."""
    write_tree(tmp_path, {
        "a/src/Arm.ice": module("Arm", "void one();"), "a/a.cdsl": cdsl("A", requires="Arm", imports="Arm"),
        "b/src/Arm.ice": '#include <Base.ice>\n' + module("Arm", "void two();"), "b/src/Base.ice": module("Base"),
        "b/b.cdsl": cdsl("B", requires="Arm", imports="Arm"), "c/c.cdsl": cdsl("C", requires="Arm", imports="Arm"),
    })  # fmt: skip
    result = rcyaml("migrate", ".")
    assert result.exit_code == 0, result.output
    assert document(tmp_path / "rcyaml.yaml", "interfaces") == ""
    imports = {name: document(tmp_path / f"{name}/{name}.cdsl.yaml", "imports") for name in "abc"}
    assert imports == {"a": "imports: [src/Arm]", "b": "imports: [src/Arm]", "c": "imports: [../a/src/Arm]"}
    compiled = rcyaml("compile")
    assert compiled.exit_code == 0, compiled.output
    assert "void one" in (tmp_path / "a/slice/Arm.ice").read_text()
    assert "void two" in (tmp_path / "b/slice/Arm.ice").read_text()
    assert "void one" in (tmp_path / "slice/Arm.ice").read_text()
    assert "0 files written" in rcyaml("compile").output


def test_a_copy_that_is_passed_is_migrated(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"a/src/Arm.ice": module("Arm"), "a/a.cdsl": cdsl("A")})
    assert rcyaml("migrate", "a/src/Arm.ice").exit_code == 0
    assert (tmp_path / "a/src/Arm.idsl.yaml").exists()


def test_an_ice_file_of_its_own_is_no_copy(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"src/Arm.ice": module("Arm"), "lib/x.cdsl": cdsl("X", requires="Arm", imports="Arm")})
    assert rcyaml("migrate", ".").exit_code == 0
    assert document(tmp_path / "rcyaml.yaml", "interfaces") == "interfaces: [src]"
    assert rcyaml("compile").exit_code == 0


# Interfaces elsewhere


def test_an_interface_that_the_folders_of_include_lack(rcyaml: Run, tmp_path: Path) -> None:
    """Nobody is told to pass the folder that was passed."""
    write_tree(tmp_path, {"core/Arm.idsl": module("Arm"), "a/a.cdsl": cdsl("A", requires="Leg", imports="Leg")})
    assert "pass that folder with -I" in rcyaml("migrate", "a").output
    said = rcyaml("migrate", "a", "-I", "core", "--force").output
    assert "it is not in core, either: pass the folder that has it with -I, too" in said, said


def test_the_folders_of_include_are_kept(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {
        "core/Arm.idsl.yaml": "module: RoboCompArm\ninterfaces: {Arm: {methods: {go: }}}\n",
        "robot/a/a.cdsl": cdsl("A", requires="Arm", imports="Arm"),
    })  # fmt: skip
    assert rcyaml("migrate", "robot", "-I", "core").exit_code == 0
    assert document(tmp_path / "robot/rcyaml.yaml", "interfaces") == "interfaces: [../core]"
    assert rcyaml("compile", "robot").exit_code == 0


def test_legacy_interfaces_of_include_are_migrated_into_the_repository(rcyaml: Run, tmp_path: Path) -> None:
    """With all that they import, and nothing is written elsewhere."""
    write_tree(tmp_path, {
        "core/Arm.idsl": 'import "Base.idsl";\n' + module("Arm"), "core/Base.ice": module("Base"),
        "core/Leg.idsl": module("Leg"), "robot/a/a.cdsl": cdsl("A", requires="Arm", imports="Arm"),
    })  # fmt: skip
    result = rcyaml("migrate", "robot", "-I", "core")
    assert result.exit_code == 0 and result.output.count("note[RC5041]") == 1, "once a folder"
    assert "2 migrated, too, from a folder of the search path, core: Arm, Base" in result.output
    assert sorted(path.name for path in (tmp_path / "robot/interfaces").iterdir()) == [
        "Arm.idsl.yaml",
        "Base.idsl.yaml",
    ]
    assert not list((tmp_path / "core").glob("*.yaml"))
    assert rcyaml("compile", "robot").exit_code == 0


@pytest.mark.parametrize(("written", "found"), [("Arm", "arm"), ("arm", "Arm"), ("ARM", "arm")])
def test_an_interface_of_include_in_another_case(rcyaml: Run, tmp_path: Path, written: str, found: str) -> None:
    component = cdsl("A", requires="Arm", imports=written)
    write_tree(tmp_path, {f"core/{found}.idsl": module("Arm"), "robot/a/a.cdsl": component})
    result = rcyaml("migrate", "robot", "-I", "core")
    assert result.exit_code == 0 and "warning[RC5008]" in result.output, result.output
    assert rcyaml("compile", "robot").exit_code == 0


AGM = ("AGMExecutive", "AGMCommonBehavior", "AGMWorldModel", "AGMExecutiveTopic")  # what `agmagent` imports


@pytest.mark.parametrize("home", ["core", "robot/a/src", "robot/interfaces"])
def test_the_interfaces_of_an_option_are_found(rcyaml: Run, tmp_path: Path, home: str) -> None:
    """No file names them: in a folder of -I, as copies of the component, and in the repository."""
    suffix = "ice" if home.endswith("src") else "idsl"
    agent = cdsl("A", implements="AGMCommonBehavior", imports="AGMCommonBehavior")
    write_tree(tmp_path, {
        **{f"{home}/{name}.{suffix}": module(name) for name in AGM},
        "robot/a/a.cdsl": agent.replace("language", "options agmagent; language"),
    })  # fmt: skip
    search = ["-I", "core"] if home == "core" else []
    assert rcyaml("migrate", "robot", *search).exit_code == 0
    compiled = rcyaml("compile", "robot")
    assert compiled.exit_code == 0 and "RC2101" not in compiled.output, compiled.output
    assert (tmp_path / "robot/a/generated/component.py").exists()


def test_a_missing_interface_of_an_option_is_reported(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"a.cdsl": cdsl("A").replace("language", "options agmagent; language")})
    result = rcyaml("migrate", ".")
    assert result.exit_code == 0 and result.output.count("warning[RC5009]") == len(AGM), result.output
    assert "imports:" not in (tmp_path / "a.cdsl.yaml").read_text()


def test_robocomps_own_folder_is_named(rcyaml: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_tree(tmp_path, {
        "opt/interfaces/IDSLs/Arm.idsl": module("Arm"), "robot/a.cdsl": cdsl("A", requires="Arm", imports="Arm"),
    })  # fmt: skip
    monkeypatch.setenv("ROBOCOMP", str(tmp_path / "opt"))
    said = rcyaml("migrate", "robot").output
    assert f"add `-I {tmp_path}/opt/interfaces/IDSLs`" in said
    assert rcyaml("migrate", "robot", "-I", f"{tmp_path}/opt/interfaces/IDSLs").exit_code == 0
    assert rcyaml("check", "robot").exit_code == 0


# Files of other programs


FOREIGN = {
    "target.aggt": "{\n\t1:robot(1,1)\n\tmug:mug(1,1)\n}\n",
    "etc/goal.aggt": "{\n\t1:robot(1,1)\n\t1->mug(imagine)\n}\nprecondition\n{\n}\n",
    "net/yolo.cfg": "[net]\nbatch=1\nhue=.1\n[shortcut]\nfrom=-3\n",
    "ld.conf": "/opt/robocomp/lib\n",
    "empty/etc/config": "",
    "comments.conf": "# nothing yet\n",
    "templates/etc/config": "${endpoints}\nName=${name}\n",
}


def test_files_of_other_programs_are_skipped(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {**FOREIGN, "a/a.cdsl": cdsl("A"), "a/etc/config": "Speed = 3\n"})
    result = rcyaml("migrate", ".", "--report", "ledger.json")
    assert result.exit_code == 0 and "error" not in result.output.splitlines()[0], result.output
    assert result.output.count("RC5043") == 1 and "skipped, since their content" in result.output
    files = json.loads((tmp_path / "ledger.json").read_text())["files"]
    assert {file["source"] for file in files if file["status"] != "skipped"} == {"a/a.cdsl", "a/etc/config"}
    assert sorted(path.name for path in tmp_path.rglob("config*.yaml")) == ["config.yaml"]


def test_configs_without_a_component_are_reported_once_a_folder(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {f"etc/{name}.conf": f"{name} = 1\n" for name in "abcde"} | {"etc2/f.conf": "f = 1\n"})
    said = rcyaml("migrate", ".").output
    assert said.count("RC5027") == 2 and "a, b, c and 2 more" in said


# Networks of other machines


RCMANAGER = """<rcmanager>
 <node alias="arm" endpoint="commonbehavior:tcp -p 11247">
  <upCommand command="rcremote localhost arm /home/x/robot/components/arm bin/arm --Ice.Config=/home/x/robot/etc/arm.conf" />
 </node>
</rcmanager>
"""


def test_paths_of_another_machine_are_mapped(rcyaml: Run, tmp_path: Path) -> None:
    """And a config in a folder for all components belongs to the one that the network starts with it."""
    write_tree(tmp_path, {
        "etc/robot.xml": RCMANAGER, "components/arm/arm.cdsl": cdsl("arm"), "etc/arm.conf": "Speed = 3\n",
        "etc/other.conf": "Volume = 1\n",
    })  # fmt: skip
    result = rcyaml("migrate", ".")
    assert result.exit_code == 0 and "becomes the component other" in result.output, result.output
    assert "  config: ../../etc/arm.config.yaml\n" in (tmp_path / "etc/robot.ddsl.yaml").read_text().replace(
        "    ", "  "
    )
    assert document(tmp_path / "etc/arm.config.yaml", "component") == "component: ../components/arm/arm.cdsl.yaml"
    assert rcyaml("check").exit_code == 0, rcyaml("check").output


GONE = """<rcmanager>
 <node alias="arm" endpoint="base:tcp -p 11247">
  <dependence alias="leg" />
  <upCommand command="rcremote HOST arm /home/x/robot/arm bin/arm CONFIG" />
 </node>
 <node alias="leg" endpoint="leg:tcp -p 11248"><upCommand command="rcremote localhost leg /home/x/robot/leg bin/leg etc/config" /></node>
</rcmanager>
"""


@pytest.mark.parametrize(("host", "config", "cwd"), [
    ("localhost", "etc/gone", "arm"), ("localhost", "--Ice.Config=/etc/arm.conf", "arm"),
    ("10.0.0.7", "etc/gone", "/home/x/robot/arm"),
])  # fmt: skip
def test_a_config_that_is_in_no_repository(rcyaml: Run, tmp_path: Path, host: str, config: str, cwd: str) -> None:
    """RCManager starts the others all the same: so does a deployment. The graph is exported as it was."""
    write_tree(tmp_path, {
        "robot.xml": GONE.replace("HOST", host).replace("CONFIG", config), "arm/arm.cdsl": cdsl("arm"),
        "leg/leg.cdsl": cdsl("leg"), "leg/etc/config": "Speed = 3\n",
    })  # fmt: skip
    result = rcyaml("migrate", ".")
    assert result.exit_code == 0 and "RC5050" in result.output and "although arm is known" in result.output
    text = (tmp_path / "robot.ddsl.yaml").read_text()
    assert "    program: bin/arm\n" in text and f"    cwd: {cwd}\n" in text and "component: leg/leg.cdsl.yaml" in text
    checked = rcyaml("check")
    assert checked.exit_code == 0 and "RC4103" not in checked.output, checked.output
    exported = rcyaml("deploy", "export", "--as", "rcmanager", "robot.ddsl.yaml").output
    assert '<node alias="arm" endpoint="base:' in exported and '<dependence alias="leg"/>' in exported


def test_a_proxy_whose_key_has_another_case_is_connected(rcyaml: Run, tmp_path: Path) -> None:
    """RCManager does not read it; the component would not find it."""
    write_tree(tmp_path, {
        "robot.xml": RCMANAGER.replace("--Ice.Config=/home/x/robot/etc/arm.conf", "etc/config"), "Eye.idsl": module("Eye"),
        "components/arm/arm.cdsl": cdsl("arm", requires="Eye", imports="Eye"),
        "components/arm/etc/config": "eyeProxy = eye:tcp -h far -p 17332\nCommonBehavior.Endpoints=tcp -p 11247\n",
    })  # fmt: skip
    assert rcyaml("migrate", ".").exit_code == 0
    assert 'connect: {Eye: "eye:tcp -h far -p 17332"}' in (tmp_path / "robot.ddsl.yaml").read_text().replace(
        "Eye: eye:tcp -h far -p 17332", 'Eye: "eye:tcp -h far -p 17332"'
    )
    assert rcyaml("check").exit_code == 0, rcyaml("check").output


# Second and edited configs


def test_a_second_config_of_the_user_stays(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"a/a.cdsl": cdsl("A"), "a/etc/config": "Speed = 3\n", "a/etc/config_real": "Speed = 9\n"})
    assert rcyaml("migrate", ".").exit_code == 0
    config = tmp_path / "a/etc/config_real"
    config.write_text("Speed = 10\nMine = 1\n")
    result = rcyaml("compile")
    assert result.exit_code == 0 and result.output.count("RC6010") == 1
    assert "a/etc/config_real" in result.output and "Speed" in result.output
    assert config.read_text() == "Speed = 10\nMine = 1\n" and (tmp_path / "a/generated/component.py").exists()
    assert "0 files written" in rcyaml("compile").output
    assert rcyaml("compile", "--adopt").exit_code == 0
    assert "Speed=9" in config.read_text() and "Mine" in (tmp_path / "a/etc/config_real.orig").read_text()


def legacy_files(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.suffix != ".yaml"}


@pytest.mark.parametrize("configs", [
    {"config": "Speed = 3\nArm.Endpoints=tcp -p 10001\n", "config_real": "Speed = 9\nArm.Endpoints=tcp -p 10001 # mine\n"},
    {"config_real": "Speed = 9\n", "config_sim": "Speed = 3\n"},
    {"robot.conf": "Speed = 9\n"},
    {"config.toml": "Speed = 3\nLimit = 1e-4\n[Endpoints]\nArm = \"tcp -p 10001\"\n[Net]\nPose = [0, 0]\n"},
    {"config.toml": "Speed = 3\n", "config": "Speed = 4\n", "config_real": "Speed=5\n"},
    {"generic_config": "Arm.Endpoints=tcp -p 10001\nIce.Warn.Connections=0\n", "specific_config": "Row = up,  1,\t2\n"},
    {"generic_config.debug": "Arm.Endpoints=tcp -p 10001\n", "specific_config.debug": "Speed=1\n", "specific_config": "Speed=2\n"},
])  # fmt: skip
def test_the_configs_of_a_repository_stay(rcyaml: Run, tmp_path: Path, configs: dict[str, str]) -> None:
    """As they are, without a copy beside them, and without a further one that nobody wrote. All say what their
    documents say."""
    files = {f"a/etc/{name}": text for name, text in configs.items()}
    arm = {"Arm.idsl": module("Arm"), "a/a.cdsl": cdsl("A", implements="Arm", imports="Arm")}
    write_tree(tmp_path, {**arm, **files})
    assert rcyaml("migrate", ".").exit_code == 0
    for _ in range(2):
        result = rcyaml("compile")
        assert result.exit_code == 0 and "RC6010" not in result.output, result.output
        assert legacy_files(tmp_path / "a/etc") == {name: text.encode() for name, text in configs.items()}
    assert rcyaml("check").exit_code == 0 and rcyaml("compile", "--check").exit_code == 0


def test_a_toml_config_that_is_adopted_is_toml(rcyaml: Run, tmp_path: Path) -> None:
    text = 'Speed = 3\n[Endpoints]\nCommonBehavior = "tcp -p 10001"\n'
    write_tree(tmp_path, {"a/a.cdsl": cdsl("A"), "a/etc/config.toml": text})
    assert rcyaml("migrate", ".").exit_code == 0 and rcyaml("compile").exit_code == 0
    assert rcyaml("config", "set", "a/etc/config.toml.config.yaml", "Speed", "4").exit_code == 0
    assert rcyaml("compile").exit_code == 0
    found = tomllib.loads((tmp_path / "a/etc/config.toml").read_text())
    assert found == {"Speed": 4, "Endpoints": {"CommonBehavior": "tcp -p 10001"}}
    assert (tmp_path / "a/etc/config.toml.orig").read_text() == text


# Code of every generation


PYTHON = "from genericworker import *\n\nclass SpecificWorker(GenericWorker):\n{}\n    def setParams(self, params):\n        return True\n"
CONSTRUCTORS = [
    "(self, proxy_map)", "(self, proxy_map, startup_check=False)", "(self, proxy_map,startup_check)", "(self, mprx)",
    "(self, proxy_map, configData, startup_check=False)", "(self, proxy_map, params, startup_check=False)",
]  # fmt: skip


@pytest.mark.parametrize("constructor", CONSTRUCTORS)
@pytest.mark.parametrize("method", ["Arm_go", "go"])
def test_python_of_every_generation_fits(rcyaml: Run, tmp_path: Path, constructor: str, method: str) -> None:
    code = PYTHON.format(f"    def __init__{constructor}:\n        pass\n\n    def {method}(self):\n        pass\n")
    write_tree(tmp_path, {
        "Arm.idsl": module("Arm"), "a/a.cdsl": cdsl("A", implements="Arm", imports="Arm"), "a/src/specificworker.py": code,
    })  # fmt: skip
    assert rcyaml("migrate", ".").exit_code == 0
    for command in (["check"], ["compile"], ["compile", "--merge"]):
        said = rcyaml(*command).output
        assert "RC62" not in said, said
    assert (tmp_path / "a/src/specificworker.py").read_text() == code


HEADER = "#include <genericworker.h>\nclass SpecificWorker : public GenericWorker\n{{\nQ_OBJECT\npublic:\n{}}};\n"


@pytest.mark.parametrize("constructor", [
    "(MapPrx& mprx)", "(MapPrx& mprx, bool startup_check)", "(TuplePrx tprx)", "(TuplePrx tprx, bool startup_check)",
    "(const ConfigLoader& configLoader, TuplePrx tprx, bool startup_check)", "(MapPrx &mprx, QObject *parent = 0)",
])  # fmt: skip
@pytest.mark.parametrize(
    "rest",
    [
        "\tvoid Arm_go();\n\tvoid initialize(int period);\n",
        "\tvoid go();\n",
        "\tvoid Arm_go();\n\tvoid initialize();\n",
    ],
)
def test_cpp_of_every_generation_fits(rcyaml: Run, tmp_path: Path, constructor: str, rest: str) -> None:
    header = HEADER.format(f"\tSpecificWorker{constructor};\n{rest}")
    names = [line.split("(")[0].split()[-1] for line in rest.splitlines()]
    source = f'#include "specificworker.h"\nSpecificWorker::SpecificWorker{constructor.replace(" = 0", "")} {{}}\n'
    for name, line in zip(names, rest.splitlines(), strict=True):
        source += f"void SpecificWorker::{name}({line.split('(')[1].split(')')[0]}) {{}}\n"
    write_tree(tmp_path, {
        "Arm.idsl": module("Arm"), "a/a.cdsl": cdsl("A", implements="Arm", imports="Arm", language="cpp"),
        "a/src/specificworker.h": header, "a/src/specificworker.cpp": source,
    })  # fmt: skip
    assert rcyaml("migrate", ".").exit_code == 0
    for command in (["check"], ["compile"], ["compile", "--merge"]):
        said = rcyaml(*command).output
        assert "RC62" not in said, said


def test_a_method_of_the_old_name_that_is_that_of_another_interface(rcyaml: Run, tmp_path: Path) -> None:
    """Two interfaces have `drive`, with other parameters; the class has one of them."""
    header = (
        "class SpecificWorker : public GenericWorker\n{\nQ_OBJECT\npublic:\n    SpecificWorker(MapPrx& mprx);\n"
        "    void drive(float x, float z);\n};\n"
    )
    source = "SpecificWorker::SpecificWorker(MapPrx& mprx) {}\nvoid SpecificWorker::drive(float x, float z) {}\n"
    write_tree(tmp_path, {
        "Omni.idsl": module("Omni", "void drive(float x, float z);"), "Diff.idsl": module("Diff", "void drive(float x);"),
        "a/a.cdsl": cdsl("A", implements="Omni, Diff", imports="Omni Diff", language="cpp"),
        "a/src/specificworker.h": header, "a/src/specificworker.cpp": source,
    })  # fmt: skip
    assert rcyaml("migrate", ".").exit_code == 0
    said = rcyaml("check").output
    assert "RC6201" in said and "lacks Diff_drive" in said and "Omni_drive" not in said, said


@pytest.mark.parametrize(("old", "new", "code"), [
    ("def __init__(self, proxy_map)", "def __init__(self)", "RC6202"), ("def Arm_go(self)", "def Arm_goes(self)", "RC6201"),
    ("def Arm_go(self)", "def Arm_go(self, far)", "RC6202"),
])  # fmt: skip
def test_code_that_does_not_fit_is_reported(rcyaml: Run, tmp_path: Path, old: str, new: str, code: str) -> None:
    worker = PYTHON.format("    def __init__(self, proxy_map):\n        pass\n\n    def Arm_go(self):\n        pass\n")
    write_tree(tmp_path, {
        "Arm.idsl": module("Arm"), "a/a.cdsl": cdsl("A", implements="Arm", imports="Arm"),
        "a/src/specificworker.py": worker.replace(old, new),
    })  # fmt: skip
    assert rcyaml("migrate", ".").exit_code == 0
    assert code in rcyaml("check").output


def test_what_robocomps_newest_tool_generated_is_taken_over(rcyaml: Run, tmp_path: Path) -> None:
    code = PYTHON.format("    def __init__(self, proxy_map, configData, startup_check=False):\n        pass\n")
    write_tree(tmp_path, {
        "a/a.cdsl": cdsl("A"), "a/src/specificworker.py": code, "a/generated/interfaces.py": "import Ice\n",
        "a/generated/genericworker.py": "class GenericWorker: pass\n",
    })  # fmt: skip
    assert rcyaml("migrate", ".").exit_code == 0
    result = rcyaml("compile")
    assert result.exit_code == 0, result.output
    assert (tmp_path / "a/generated/interfaces.py.orig").read_text() == "import Ice\n"
    assert (tmp_path / "a/generated/genericworker.py").read_text() == "class GenericWorker: pass\n"


def test_two_components_in_the_folder_of_one(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"arm/arm.cdsl": cdsl("Arm"), "arm/old.cdsl": cdsl("OldArm")})
    assert rcyaml("migrate", ".").exit_code == 0
    result = rcyaml("compile")
    assert result.exit_code == 1 and "OldArm is not compiled: its folder is that of Arm" in result.output
    assert (tmp_path / "arm/generated/component.py").exists()


def test_a_second_run_keeps_the_folders_of_interfaces(rcyaml: Run, tmp_path: Path) -> None:
    """What the first one converted from the search path is not converted again, and is found."""
    write_tree(tmp_path, {
        "lib/Arm.idsl": "module RoboCompArm { interface Arm { void go(); }; };\n",
        "bot/arm/arm.cdsl": 'import "Arm.idsl";\nComponent arm { Communications { requires Arm; }; language python; };\n',
    })  # fmt: skip
    texts = []
    for folders in (["-I", str(tmp_path / "lib")], ["-I", str(tmp_path / "lib")], []):
        result = rcyaml("migrate", str(tmp_path / "bot"), *folders)
        assert result.exit_code == 0 and "RC5009" not in result.output, result.output
        texts.append((tmp_path / "bot/rcyaml.yaml").read_text(encoding="utf-8"))
    assert "interfaces: [interfaces]" in texts[0] and texts == texts[:1] * 3
    assert rcyaml("check", str(tmp_path / "bot")).exit_code == 0


def test_a_run_after_a_compile_has_all_configurations(rcyaml: Run, tmp_path: Path) -> None:
    """Those that the compiler knows as the user's are sources still: parameters that only they have stay."""
    line = "ArmProxy = arm:tcp -h localhost -p 10003\n"
    write_tree(tmp_path, {
        "Arm.idsl": "module RoboCompArm { interface Arm { void go(); }; };\n",
        "bot/bot.cdsl": 'import "Arm.idsl";\nComponent bot { Communications { requires Arm; }; language python; };\n',
        "bot/etc/config": line, "bot/etc/config_lab": f"{line}tile = 200\n", "bot/etc/sim.conf": f"{line}roof = 3\n",
    })  # fmt: skip
    assert rcyaml("migrate", ".").exit_code == 0
    parameters = (tmp_path / "bot/bot.pdsl.yaml").read_text(encoding="utf-8")
    assert "tile" in parameters and "roof" in parameters
    assert rcyaml("compile").exit_code == 0
    assert rcyaml("migrate", ".").exit_code == 0
    assert (tmp_path / "bot/bot.pdsl.yaml").read_text(encoding="utf-8") == parameters
