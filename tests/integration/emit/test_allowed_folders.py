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
