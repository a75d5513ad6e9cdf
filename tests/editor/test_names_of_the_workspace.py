"""With no server of ours: yaml-language-server completes the names of a compiled workspace, and marks only slips."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest

from editor.robot import DOCUMENTS, run, write_robot
from editor.workbench import Workbench
from robocomp_yaml.api.schemas import names_offered
from robocomp_yaml.link import workspace_files

SCHEMAS = ".rcyaml/schemas"
COMPONENT = "component: A\nlanguage: cpp\n"
METHOD = "module: A\ninterfaces:\n  I:\n    methods:\n      f: "
ENTRY = "deployment: A\ncomponents:\n  a:\n    component: b\n"
INTERFACES = {"Gripper", "Odometry"}
TOPICS = {"GripperEvents", "Odometry"}
TYPES = {"Shapes.Pose", "Shapes.Poses"}

NAMES = [
    ("idsl", "module: A\nimports: [|]", {"Shapes", "Gripper", "Odometry"}),
    ("idsl", "module: A\nimports:\n  - |", {"Shapes", "Gripper", "Odometry"}),
    ("idsl", METHOD + "{in: {a: |}}", TYPES),
    ("idsl", METHOD + "{returns: |}", TYPES),
    ("idsl", METHOD + "{throws: [B|]}", {"Shapes.Blocked"}),
    ("idsl", "module: A\ntypes:\n  P: {sequence: |}", TYPES),
    ("idsl", "module: A\ntypes:\n  P: {struct: {a: |}}", TYPES),
    ("idsl", "module: A\ntypes:\n  P: {map: {key: string, value: |}}", TYPES),
    ("cdsl", COMPONENT + "imports: [S|]", {"Shapes", "Gripper", "Odometry"}),
    ("cdsl", COMPONENT + "implements: [G|]", INTERFACES),
    ("cdsl", COMPONENT + "requires:\n  - |", INTERFACES),
    ("cdsl", COMPONENT + "requires: [{Left: |}]", INTERFACES),
    ("cdsl", COMPONENT + "requires:\n  - Left: {interface: |}", INTERFACES | TOPICS),
    ("cdsl", COMPONENT + "publishes: [G|]", TOPICS),
    ("cdsl", COMPONENT + "subscribes:\n  - |", TOPICS),
    ("pdsl", "component: A\nparameters:\n  p: {type: |}", {"Finger"}),
    ("pdsl", "component: A\nparameters:\n  p: {list: |}", {"Finger"}),
    ("pdsl", "component: A\nparameters:\n  p: |", {"Finger"}),
    ("ddsl", "deployment: A\ncomponents:\n  a: {component: |}", {"../components/hand", "../components/wheels"}),
    ("ddsl", ENTRY + "    host: |", {"torso"}),
    ("ddsl", ENTRY + "    connect: {Gripper: |}", {"hand", "wheels", "body"}),
    ("ddsl", ENTRY + "    after: [s|]", {"hand", "wheels", "body", "storm"}),
    ("ddsl", ENTRY + "groups:\n  g: {components: [h|]}", {"hand", "wheels", "body"}),
    ("ddsl", ENTRY + "groups:\n  g: {host: |}", {"torso"}),
    ("ddsl", "deployment: A\ncomponents:\n  a: {process: |}", {"hand", "wheels"}),
    ("ddsl", "deployment: A\ninclude: [|]", {"robot.ddsl.yaml"}),
]  # fmt: skip
KNOWN = {name for _, _, names in NAMES for name in names}


@pytest.mark.parametrize(("kind", "text", "names"), NAMES)
def test_names_are_completed(compiled: Workbench, kind: str, text: str, names: set[str]) -> None:
    labels = [proposal.label for proposal in compiled.complete(kind, text)]
    assert KNOWN & set(labels) == names
    assert len(labels) == len(set(labels))
    assert not [label for label in labels if label.startswith("for example")], "there are names"


def test_a_name_is_inserted_as_it_is(compiled: Workbench) -> None:
    [name] = [one for one in compiled.complete("ddsl", ENTRY + "    host: |") if one.label == "torso"]
    assert name.text.strip() == "torso"


UNSAVED = [
    ("idsl", "module: A\nimports: [Vendor, ../elsewhere/Vendor]\ntypes:\n  P: {sequence: Vendor.Thing}\n"),
    ("cdsl", COMPONENT + "imports: [Vendor]\nimplements: [Vendor]\nrequires: [Vendor.Arm, {Left: Grippers}]\n"
             "publishes: [GripperEvent]\nsubscribes: [gripperEvents]\n"),
    ("pdsl", "component: A\ntypes:\n  Wheel: {struct: {a: float}}\nparameters:\n  p: {list: Wheel}\n"),
    ("ddsl", "deployment: A\nhosts: {tosro: 10.0.0.1}\ncomponents:\n"
             "  a: {component: ../../x, host: tosro, connect: {Gripper: ahnd}, after: [strom]}\n"),
]  # fmt: skip


def test_a_name_that_the_schema_does_not_know_is_right(compiled: Workbench) -> None:
    """It may be in a folder of -I, or in a document that only an editor has."""
    for kind, text in UNSAVED:
        assert compiled.messages(kind, [text]) == [[]], kind


@pytest.mark.parametrize(
    ("kind", "text", "message"),
    [
        ("cdsl", COMPONENT + "implements: [Girpper]\n", "3:14 did you mean 'Gripper'?"),
        ("cdsl", COMPONENT + "requires: [{Left: {interface: Odomerty}}]\n", "3:31 did you mean 'Odometry'?"),
        ("cdsl", COMPONENT + "subscribes: [GripperEvenst]\n", "3:14 did you mean 'GripperEvents'?"),
        ("idsl", "module: A\nimports: [Shpaes]\n", "2:11 did you mean 'Shapes'?"),
    ],
)
def test_a_slip_is_marked(compiled: Workbench, kind: str, text: str, message: str) -> None:
    assert compiled.messages(kind, [text]) == [[message]]


def test_right_documents_have_no_marks(compiled: Workbench) -> None:
    paths = [path for path in DOCUMENTS if path != "rcyaml.yaml"]
    marked = compiled.marked([(compiled.folder / path, DOCUMENTS[path].lstrip("\n")) for path in paths])
    assert dict(zip(paths, marked, strict=True)) == {path: [] for path in paths}


def schemas(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted((folder / SCHEMAS).iterdir())}


def test_the_schemas_depend_on_the_workspace_alone(compiled: Workbench, tmp_path: Path) -> None:
    """Neither on the requested documents, nor on the working folder, nor on what was compiled before."""
    wanted = schemas(compiled.folder)
    for number, (arguments, inside) in enumerate(
        [
            (["compile", "components/hand/hand.cdsl.yaml"], "."),
            (["compile", "../.."], "components/hand"),
            (["compile", "-I", str(tmp_path / "vendor")], "."),
            (["init", "."], "."),
        ]
    ):
        (tmp_path / "vendor").mkdir(exist_ok=True)
        (tmp_path / "vendor/Vendor.idsl.yaml").write_text("module: Vendor\ninterfaces: {Vendor: {}}\n")
        folder = tmp_path / f"{number}"
        for name, text in DOCUMENTS.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(text.lstrip("\n"))
        run(*arguments, folder=folder / inside)
        assert schemas(folder) == wanted, arguments


def test_each_compile_writes_what_is_new_and_nothing_else(tmp_path: Path) -> None:
    write_robot(tmp_path)
    before = {path: os.stat(path).st_mtime_ns for path in (tmp_path / SCHEMAS).iterdir()}
    run("compile", folder=tmp_path)
    assert {path: os.stat(path).st_mtime_ns for path in (tmp_path / SCHEMAS).iterdir()} == before
    (tmp_path / "interfaces/Arm.idsl.yaml").write_text("module: RoboCompArm\ninterfaces: {Arm: {}}\n")
    run("compile", "interfaces/Arm.idsl.yaml", folder=tmp_path)
    changed = {path.name.partition(".")[0] for path, time in before.items() if os.stat(path).st_mtime_ns != time}
    assert changed == {"idsl", "cdsl"}
    assert '"Arm"' in (tmp_path / SCHEMAS / "cdsl.schema.json").read_text()
    shutil.rmtree(tmp_path / "interfaces")
    (tmp_path / "interfaces").mkdir()
    (tmp_path / "components/hand/hand.cdsl.yaml").write_text("component: HandComp\nlanguage: python\n")
    workspace_files.install(str(tmp_path))
    assert "Gripper" not in (tmp_path / SCHEMAS / "cdsl.schema.json").read_text()


def test_a_broken_document_keeps_its_names_and_a_workspace_below_has_its_own(tmp_path: Path) -> None:
    for name, text in {
        "rcyaml.yaml": "interfaces: [.]\n",
        "Broken.idsl.yaml": "module: RoboCompBroken\nnonsense: 1\ninterfaces: {Broken: {methods: 7}, x-own: {}}\n",
        "Unreadable.idsl.yaml": "module: [\n",
        "below/rcyaml.yaml": "interfaces: [.]\n",
        "below/Below.idsl.yaml": "module: RoboCompBelow\ninterfaces: {Below: {}}\n",
        "Twice.idsl.yaml": "module: RoboCompTwice\ninterfaces: {Same: {}}\n",
        "Again.idsl.yaml": "module: RoboCompAgain\ninterfaces: {Same: {}}\n",
    }.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    workspace_files.install(str(tmp_path))
    text = (tmp_path / SCHEMAS / "cdsl.schema.json").read_text()
    for name, is_known in {
        "Broken": True, "x-own": False, "Below": False, "RoboCompTwice.Same": True, "Same": False,
    }.items():  # fmt: skip
        assert (f'"label": "{name}"' in text) == is_known, name


def test_another_server_can_ask_what_the_schemas_offer(compiled: Workbench, tmp_path: Path) -> None:
    component = str(compiled.folder / "components/new.cdsl.yaml")
    assert names_offered(component) == {"Gripper", "GripperEvents", "Odometry", "Shapes"}
    assert "torso" in names_offered(str(compiled.folder / "new.ddsl.yaml"))
    assert names_offered(str(compiled.folder / "compose.yaml")) == frozenset()
    assert names_offered(str(tmp_path / "alone.cdsl.yaml")) == frozenset()
    (tmp_path / "rcyaml.yaml").write_text("")
    (tmp_path / SCHEMAS).mkdir(parents=True)
    for text in ("[", "[]", "{}"):
        (tmp_path / SCHEMAS / "cdsl.schema.json").write_text(text)
        assert names_offered(str(tmp_path / "alone.cdsl.yaml")) == frozenset()
