"""The user's list of running deployments: nothing that runs is lost, with or without its document and its folder."""

from __future__ import annotations

import json
import os
import shutil
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from conftest import write_tree
from processes import kill_left, until
from robocomp_yaml.api.addresses import Addresses
from robocomp_yaml.deploy import registered
from seen import status
from small_networks import Place, is_alive, readable_by_others
from test_roles import Rcyaml

DOCUMENT = """\
deployment: {name}
components:
  base: {{program: sh, args: [-c, "echo the base turns; exec sleep 600"], ready: {{log: turns}}}}
  arm: {{program: sleep, args: ["600"], after: [base]}}
"""


@pytest.fixture
def place(tmp_path: Path) -> Iterator[Place]:
    """A folder for one deployment, alone in its parent."""
    place = Place(tmp_path / "above" / "robot")
    yield place
    kill_left(place.folder)


@pytest.fixture
def robot(place: Place, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, rcyaml: Rcyaml) -> Iterator[Path]:
    """A folder with a running deployment; the working folder is another one."""
    monkeypatch.setenv("XDG_STATE_HOME", f"{tmp_path}/own")
    root = place.root
    write_tree(root, {"robot.ddsl.yaml": DOCUMENT.format(name="Robot"), "elsewhere": None})
    assert rcyaml("deploy", "up", f"{root}/robot.ddsl.yaml").exit_code == 0
    monkeypatch.chdir(root / "elsewhere")
    yield root
    kill_left(f"{root}/.rcyaml/deployments/Other")


def rows(rcyaml: Rcyaml) -> list[list[str]]:
    return [line.split() for line in rcyaml("deploy", "ls").stdout.splitlines()]


def test_the_list(robot: Path, rcyaml: Rcyaml) -> None:
    document = f"{robot}/robot.ddsl.yaml"
    assert rows(rcyaml) == [
        ["DEPLOYMENT", "STATE", "ENGINE", "HOSTS", "DOCUMENT"],
        ["Robot", "running", "local", "localhost", "../robot.ddsl.yaml"],
    ]
    (one,) = json.loads(rcyaml("deploy", "ls", "--format", "json").stdout)["deployments"]
    assert (one["name"], one["document"], one["has_document"]) == ("Robot", document, True)
    assert readable_by_others(registered.root()) == []
    assert rcyaml("deploy", "down", document).exit_code == 0
    assert rcyaml("deploy", "ls").stdout == "no deployment is running\n"


@pytest.mark.parametrize("lost", [(), (".rcyaml",), ("robot.ddsl.yaml",), (".rcyaml", "robot.ddsl.yaml")])
def test_status_logs_and_down_by_name(robot: Path, rcyaml: Rcyaml, lost: tuple[str, ...]) -> None:
    pids = {name: one["pid"] for name, one in _status(rcyaml, robot).items()}
    for name in lost:
        path = robot / name
        shutil.rmtree(path) if path.is_dir() else path.unlink()
    assert {name: one["pid"] for name, one in _status(rcyaml, robot).items()} == pids
    assert "base | the base turns\n" in rcyaml("deploy", "logs", "Robot", "base").stdout
    done = rcyaml("deploy", "down", "Robot")
    assert done.exit_code == 0 and done.stdout == "arm   stopped\nbase  stopped\n"
    until(lambda: not any(map(is_alive, pids.values())), "they end")
    assert rcyaml("deploy", "ls").stdout == "no deployment is running\n"
    assert not [path for path in robot.rglob("*") if path.is_file() and "config" in path.parts]


def test_with_the_document_but_without_the_folder(robot: Path, rcyaml: Rcyaml) -> None:
    shutil.rmtree(robot / ".rcyaml")
    document = f"{robot}/robot.ddsl.yaml"
    assert [one["ready"] for one in _status(rcyaml, robot, document).values()] == [True, True]
    assert readable_by_others(f"{robot}/.rcyaml/deployments/Robot") == []
    assert rcyaml("deploy", "down", document).stdout == "arm   stopped\nbase  stopped\n"


def test_with_the_path_of_a_document_that_is_gone(robot: Path, rcyaml: Rcyaml) -> None:
    (robot / "robot.ddsl.yaml").unlink()
    result = rcyaml("deploy", "down", "../robot.ddsl.yaml")
    assert result.exit_code == 0 and "is gone: the running processes are used instead" in result.stderr


def test_in_the_folder_of_a_document_that_is_gone(robot: Path, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without a name: also in a folder above; not in another one."""
    (robot / "robot.ddsl.yaml").unlink()
    monkeypatch.chdir(robot)
    assert "robot.ddsl.yaml is gone" in rcyaml("deploy", "status").stderr
    (robot / "other").mkdir()
    monkeypatch.chdir(robot / "other")
    assert "has no deployment document" in rcyaml("deploy", "down").stderr
    monkeypatch.chdir(robot.parent)
    assert rcyaml("deploy", "down").stdout == "arm   stopped\nbase  stopped\n"


def test_a_process_of_the_document_here_goes_first(
    robot: Path, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_tree(robot, {"other/other.ddsl.yaml": DOCUMENT.format(name="Other").replace("arm:", "Robot:")})
    monkeypatch.chdir(robot / "other")
    assert "Robot    not started" in rcyaml("deploy", "status", "Robot").stdout
    assert len(_status(rcyaml, robot, "../robot.ddsl.yaml")) == 2


def test_a_deployment_here_has_its_name_also_when_it_does_not_run(
    robot: Path, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("One", "Two"):
        write_tree(robot, {f"other/{name}.ddsl.yaml": DOCUMENT.format(name=name)})
    monkeypatch.chdir(robot / "other")
    assert "base     not started" in rcyaml("deploy", "status", "Two", "base").stdout
    assert rcyaml("deploy", "down", "One").stdout == "One: nothing was running\n"
    assert rcyaml("deploy", "status", "Three").exit_code == 2
    write_tree(robot, {"other/three.ddsl.yaml": DOCUMENT.format(name="Two")})
    refused = rcyaml("deploy", "status", "Two")
    assert refused.exit_code == 2 and "several deployments" in refused.stderr, refused.stderr


def test_two_of_the_same_name(robot: Path, rcyaml: Rcyaml) -> None:
    write_tree(robot, {"copy/robot.ddsl.yaml": DOCUMENT.format(name="Robot")})
    assert rcyaml("deploy", "up", f"{robot}/copy/robot.ddsl.yaml").exit_code == 0
    try:
        result = rcyaml("deploy", "down", "Robot")
        assert result.exit_code == 2 and f"{robot}/copy/robot.ddsl.yaml" in result.stderr
    finally:
        assert rcyaml("deploy", "down", f"{robot}/copy/robot.ddsl.yaml").exit_code == 0
    assert rcyaml("deploy", "down", "Robot").exit_code == 0


def test_what_was_killed_is_not_running(robot: Path, rcyaml: Rcyaml, place: Place) -> None:
    os.kill(place.keeper_and_supervisor()[1], signal.SIGKILL)
    place.wait_gone()
    assert rows(rcyaml)[1][:3] == ["Robot", "not", "running"]
    shutil.rmtree(robot / ".rcyaml")
    assert rcyaml("deploy", "ls").stdout == "no deployment is running\n"


def test_a_state_folder_that_cannot_be_written_prevents_nothing(
    tmp_path: Path, place: Place, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setenv("XDG_STATE_HOME", f"{tmp_path}/file")
    write_tree(tmp_path, {"robot.ddsl.yaml": DOCUMENT.format(name="Robot")})
    assert rcyaml("deploy", "up", "robot.ddsl.yaml").exit_code == 0
    assert rcyaml("deploy", "down", "robot.ddsl.yaml").exit_code == 0


def _status(rcyaml: Rcyaml, root: Path, name: str = "Robot") -> dict[str, dict[str, Any]]:
    return status(rcyaml, f"{root}/.rcyaml/deployments/Robot", name)


def test_who_does_not_answer_at_its_own_address_may_run_without_a_document(
    robot: Path, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch
) -> None:
    def hint() -> str:
        return Addresses().peer("lamp.CommonBehavior.getPeriod").not_running

    write_tree(robot, {"lamp/lamp.cdsl.yaml": "component: Lamp\nlanguage: python\n"})
    monkeypatch.chdir(robot)
    alone = "start it with `rcyaml run lamp`"
    assert hint() == alone, "the document is there"
    (robot / "robot.ddsl.yaml").unlink()
    gone = "Robot runs here, and its document is gone: `rcyaml deploy status Robot` shows its ports"
    assert hint() == f"{gone}; or {alone}"
    monkeypatch.chdir(robot / "lamp")
    assert rcyaml("deploy", "down", "Robot").exit_code == 0
    monkeypatch.chdir(robot)
    assert hint() == alone
