"""The deployment may be omitted if there is only one; several are listed."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree

pytestmark = pytest.mark.processes  # a probe runs programs

Rcyaml = Callable[..., Result]
ROBOT = "deployment: Robot\ncomponents: {base: {program: /bin/true}, arm: {program: /bin/true}}\n"
READING = ("plan", "status", "logs", "probe", "down", "export")


def deploy(rcyaml: Rcyaml, what: str, *args: str) -> Result:
    return rcyaml("deploy", what, *args, *(("--as", "systemd") if what == "export" else ()))


@pytest.mark.parametrize("place", ["robot.ddsl.yaml", "deployments/robot.ddsl.yaml", "a/b/ddsl.yaml"])
@pytest.mark.parametrize("what", READING)
def test_the_only_deployment_is_used(rcyaml: Rcyaml, tmp_path: Path, what: str, place: str) -> None:
    write_tree(tmp_path, {place: ROBOT, "build/old.ddsl.yaml": ROBOT, "interfaces/Speech.idsl.yaml": "module: X\n"})
    named, taken = deploy(rcyaml, what, place), deploy(rcyaml, what)
    assert (taken.exit_code, taken.output) == (named.exit_code, named.output) and taken.exit_code == 0
    assert rcyaml("graph").exit_code == 0


def test_a_name_needs_no_document_before_it(rcyaml: Rcyaml, tmp_path: Path) -> None:
    write_tree(tmp_path, {"deployments/robot.ddsl.yaml": ROBOT, "arm/arm.txt": ""})
    for args in (("base",), ("deployments", "base"), (".", "base"), ("deployments/robot.ddsl.yaml", "base")):
        assert deploy(rcyaml, "plan", *args).output == "+ base  start: it does not run yet\n1 to start\n", args
    assert "+ arm" in deploy(rcyaml, "plan", "arm").output, "a folder that has no deployment is none"
    assert "localhost" in deploy(rcyaml, "probe", "localhost").output


@pytest.mark.parametrize(
    ("args", "message"),
    [
        (("plan", "bsae"), "has no process or group 'bsae'; did you mean 'base'?"),
        (("plan", "something"), "has no process or group 'something'; choose one of "),
        (("plan", "robot.ddsl.yml"), "Path 'robot.ddsl.yml' does not exist"),
        (("down", "other/place"), "Path 'other/place' does not exist"),
        (("probe", "moon"), "has no host 'moon'"),
        (("probe", ".", "a", "b"), "Got unexpected extra argument (b)"),
        (("export", "--as", "systemd", "base"), "Path 'base' does not exist"),
        (("export", "--as", "systemd", ".", "base", "arm"), "Got unexpected extra arguments (base arm)"),
    ],
)
def test_words_that_are_neither_names_nor_documents(
    rcyaml: Rcyaml, tmp_path: Path, args: tuple[str, ...], message: str
) -> None:
    write_tree(tmp_path, {"deployments/robot.ddsl.yaml": ROBOT})
    result = rcyaml("deploy", *args)
    assert result.exit_code == 2 and message in result.stderr


@pytest.mark.parametrize("what", [*READING, "up", "restart"])
def test_several_deployments_are_listed(rcyaml: Rcyaml, tmp_path: Path, what: str) -> None:
    write_tree(tmp_path, {"d/robot.ddsl.yaml": ROBOT, "d/two.ddsl.yaml": ROBOT.replace("Robot", "Two")})
    result = deploy(rcyaml, what)
    assert result.exit_code == 2
    assert "there are several deployments: d/robot.ddsl.yaml, d/two.ddsl.yaml; name one of them" in result.stderr
    assert rcyaml("graph").stderr.splitlines()[-1] == result.stderr.splitlines()[-1]


def test_no_deployment_is_reported(rcyaml: Rcyaml, tmp_path: Path) -> None:
    write_tree(tmp_path, {"empty": None})
    for args in ((), (".",), ("empty",)):
        result = deploy(rcyaml, "plan", *args)
        assert (
            result.exit_code == 2
            and "has no deployment document: `rcyaml new deployment NAME` writes one" in result.stderr
        )


def test_included_deployments_do_not_count(rcyaml: Rcyaml, tmp_path: Path) -> None:
    write_tree(tmp_path, {
        "d/base.ddsl.yaml": ROBOT.replace("Robot", "Base"),
        "d/robot.ddsl.yaml": "deployment: Robot\ninclude: [base.ddsl.yaml]\n",
    })  # fmt: skip
    assert deploy(rcyaml, "plan").output.endswith("2 to start\n")
    assert deploy(rcyaml, "plan", "d").output.endswith("2 to start\n")


def test_the_nearest_deployment_is_used(rcyaml: Rcyaml, tmp_path: Path) -> None:
    write_tree(tmp_path, {"robot.ddsl.yaml": ROBOT, "tests/two.ddsl.yaml": ROBOT.replace("Robot", "Two")})
    assert deploy(rcyaml, "status").exit_code == 0 and rcyaml("graph").exit_code == 0
