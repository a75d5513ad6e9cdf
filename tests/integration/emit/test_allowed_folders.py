"""`compile` writes to folders named on the command line and to their workspaces; a document cannot name others."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import Tree, write_tree

Run = Callable[..., Result]
ARM = "component: Arm\nlanguage: python\n"
DEPLOYMENT = "deployment: R\ncomponents: {arm: {component: ../arm/arm.cdsl.yaml}}\n"
MODULE = "module: M\ninterfaces: {I: {methods: {go: }}}\n"


def refused(result: Result) -> list[tuple[str, str]]:
    found = json.loads(result.stdout)["diagnostics"]
    return [(each["file"], each["hint"]) for each in found if each["code"] == "RC6002"]


@pytest.mark.parametrize("args", [["robot"], ["robot/r.ddsl.yaml", "-o", "out"]])
def test_a_component_elsewhere_must_be_named(args: list[str], rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"arm/arm.cdsl.yaml": ARM, "robot/r.ddsl.yaml": DEPLOYMENT, "robot/rcyaml.yaml": ""})
    result = rcyaml("compile", *args, "--format", "json")
    told = refused(result)
    if "-o" not in args:
        assert result.exit_code == 1
        hint = "to write there, run `rcyaml compile arm/arm.cdsl.yaml`, or set the output folder with -o DIR"
        assert told == [("arm/arm.cdsl.yaml", hint)]
        assert rcyaml("compile", "arm/arm.cdsl.yaml").exit_code == 0
        assert (tmp_path / "arm/generated").is_dir()
    else:
        assert told == [] and not (tmp_path / "arm/generated").exists()


INSIDE: dict[str, tuple[Tree, str]] = {
    "of the workspace above": ({"rcyaml.yaml": "", "arm/arm.cdsl.yaml": ARM, "nets/r.ddsl.yaml": DEPLOYMENT}, "nets"),
    "of the document's workspace": (
        {"rcyaml.yaml": "", "arm/arm.cdsl.yaml": ARM, "nets/r.ddsl.yaml": DEPLOYMENT},
        "nets/r.ddsl.yaml",
    ),
    "of no workspace, from above": ({"arm/arm.cdsl.yaml": ARM, "nets/r.ddsl.yaml": DEPLOYMENT}, "nets/r.ddsl.yaml"),
    "of values": (
        {"arm/arm.cdsl.yaml": ARM, "arm/etc/config.yaml": "component: ../arm.cdsl.yaml\n"},
        "arm/etc/config.yaml",
    ),
}


@pytest.mark.parametrize("name", INSIDE)
def test_a_component_below_the_working_folder_is_compiled(name: str, rcyaml: Run, tmp_path: Path) -> None:
    files, path = INSIDE[name]
    write_tree(tmp_path, files)
    assert rcyaml("compile", path).exit_code == 0
    assert (tmp_path / "arm/generated").is_dir()


def test_a_workspace_that_is_a_link_is_inside_itself(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(
        tmp_path,
        {"disk/rcyaml.yaml": "", "disk/M.idsl.yaml": MODULE, "disk/arm/arm.cdsl.yaml": ARM, "robot": "-> disk"},
    )
    assert rcyaml("compile", "robot").exit_code == 0
    assert (tmp_path / "disk/slice/M.ice").is_file() and (tmp_path / "disk/arm/generated").is_dir()


def test_slice_stays_in_the_workspace(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"robot/rcyaml.yaml": "output: {slice: ../there}\n", "robot/M.idsl.yaml": MODULE})
    assert [file for file, _ in refused(rcyaml("compile", "robot", "--format", "json"))] == ["robot/M.idsl.yaml"]
    assert not (tmp_path / "there").exists()


def told(result: Result) -> list[tuple[str, str, str]]:
    found = json.loads(result.stdout)["diagnostics"]
    return [(each["code"], each["message"], each["hint"]) for each in found]


@pytest.mark.parametrize("blocked", ["runtime", "runtime/python", "runtime/python/generated"])
def test_a_file_where_the_shared_run_time_must_be_is_named(blocked: str, rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"rcyaml.yaml": "", "arm/arm.cdsl.yaml": ARM, blocked: "mine\n"})
    message = f"cannot write 'runtime/python/generated': '{blocked}' is not a folder"
    assert told(rcyaml("compile", "--format", "json")) == [("RC6005", message, "")]
    assert (tmp_path / blocked).read_text() == "mine\n"


def test_a_file_of_the_user_in_the_shared_run_time_is_adopted_as_the_hint_says(rcyaml: Run, tmp_path: Path) -> None:
    users = "runtime/python/generated/runtime/worker.py"
    write_tree(tmp_path, {"w/rcyaml.yaml": "", "w/arm/arm.cdsl.yaml": ARM, f"w/{users}": "mine\n"})
    ((code, _, hint),) = told(rcyaml("compile", "w", "--format", "json"))
    assert (code, hint) == ("RC6001", "`rcyaml compile --adopt w` overwrites it, and keeps your file as .orig")
    assert rcyaml("compile", "--adopt", "w").exit_code == 0
    assert (tmp_path / f"w/{users}.orig").read_text() == "mine\n"


def test_a_link_out_of_the_workspace_is_the_cause(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"w/rcyaml.yaml": "", "w/arm/arm.cdsl.yaml": ARM, "elsewhere/x": ""})
    (tmp_path / "w/runtime").symlink_to(tmp_path / "elsewhere")
    hint = "remove the link that leads there, or set the output folder with -o DIR"
    assert refused(rcyaml("compile", "w", "--format", "json")) == [("w/rcyaml.yaml", hint)]


def test_the_run_time_of_another_workspace_comes_with_its_folder(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"other/rcyaml.yaml": "", "other/arm/arm.cdsl.yaml": ARM, "robot/rcyaml.yaml": "",
                          "robot/r.ddsl.yaml": DEPLOYMENT.replace("../arm", "../other/arm")})  # fmt: skip
    hint = "to write there, run `rcyaml compile other`, or set the output folder with -o DIR"
    assert ("other/rcyaml.yaml", hint) in refused(rcyaml("compile", "robot", "--format", "json"))
    assert rcyaml("compile", "other").exit_code == 0
