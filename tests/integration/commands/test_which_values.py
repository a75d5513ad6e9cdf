"""Commands about values accept a document, a component's folder, document or name, or nothing if there is only one."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree

Run = Callable[..., Result]
TREE = {
    "rcyaml.yaml": "", "components/arm/arm.cdsl.yaml": "component: ArmComp\nlanguage: python\n",
    "components/arm/arm.pdsl.yaml": "component: arm.cdsl.yaml\nparameters: {force: {type: int, default: 2}}\n",
}  # fmt: skip
BASE = {"components/base/cdsl.yaml": "component: BaseComp\nlanguage: cpp\n"}
ARM = "components/arm/etc/config.yaml"
SAID = [
    "components/arm", "components/arm/", "components/arm/arm.cdsl.yaml", "components/arm/arm.pdsl.yaml", "ArmComp", "arm",
    "armcomp", ".", "components",
]  # fmt: skip


@pytest.mark.parametrize("arguments", [[], *([each] for each in SAID)])
def test_new_accepts_all_forms(rcyaml: Run, tmp_path: Path, arguments: list[str]) -> None:
    write_tree(tmp_path, TREE)
    result = rcyaml("config", "new", *arguments)
    assert result.exit_code == 0, result.output
    assert (tmp_path / ARM).is_file()
    assert rcyaml("config", "new", *arguments).exit_code == 2


@pytest.mark.parametrize("arguments", [[], *([each] for each in SAID), [ARM]])
def test_the_other_commands_accept_all_forms(rcyaml: Run, tmp_path: Path, arguments: list[str]) -> None:
    write_tree(tmp_path, {**TREE, ARM: "component: ../arm.cdsl.yaml\nparameters: {force: 3}\n"})
    assert rcyaml("config", "check", *arguments).exit_code == 0
    assert "force = 3" in rcyaml("config", "show", *arguments).stdout
    assert "force=3" in rcyaml("config", "export", *arguments).stdout
    assert rcyaml("config", "get", *arguments, "force").stdout == "3\n"
    assert rcyaml("config", "set", *arguments, "force", "4", "--format", "json").exit_code == 0
    assert rcyaml("config", "get", "-I", ".", *arguments, "--format", "json", "force").exit_code == 0
    assert rcyaml("config", "set", *arguments, "force", "-4").exit_code == 0
    assert "force: -4" in (tmp_path / ARM).read_text()


@pytest.mark.parametrize(("args", "problem"), [
    (["new"], "this folder has several components: components/arm/arm.cdsl.yaml, components/base/cdsl.yaml; name one of"),
    (["show", "components"], "'components' has several components"),
    (["new", "ArmCmp"], "unknown component 'ArmCmp'; did you mean 'ArmComp'?"),
    (["check", "base"], "components/base/etc/config.yaml does not exist yet: `rcyaml config new components/base/cdsl.yaml`"),
    (["show", "x.config.yaml"], "'x.config.yaml' does not exist"),
    (["new", "components/arm/a.cdsl.yaml"], "'components/arm/a.cdsl.yaml' does not exist"),
    (["new", "rcyaml.yaml"], "'rcyaml.yaml' is not a document of a component"),
    (["new", "robot.ddsl.yaml"], "'robot.ddsl.yaml' is a deployment; name one of its components"),
    (["show", "robot.ddsl.yaml"], "`rcyaml -v deploy plan robot.ddsl.yaml` shows the values of its processes"),
    (["show", "empty"], "'empty' has no component; `rcyaml new component NAME` writes one"),
    (["get", "components/arm/arm.pdsl.yaml"], "components/arm/etc/config.yaml does not exist yet"),
])  # fmt: skip
def test_unclear_arguments_are_rejected(rcyaml: Run, tmp_path: Path, args: list[str], problem: str) -> None:
    write_tree(tmp_path, {**TREE, **BASE, "empty": None, "robot.ddsl.yaml": "deployment: Robot\n"})
    result = rcyaml("config", *args)
    assert result.exit_code == 2, result.output
    assert problem in result.output


def test_a_path_without_a_parameter_is_no_parameter(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {**TREE, ARM: "parameters: {}\n"})
    for args in (["get", ARM], ["get", "components/arm"], ["set", ARM], ["set"]):
        assert "Missing argument" in rcyaml("config", *args).output, args
