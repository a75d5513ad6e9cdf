"""A document that describes another deployment than what runs, or is at another path: nothing runs twice unnoticed."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from conftest import write_tree
from processes import kill_left
from small_networks import Place
from test_roles import Rcyaml

DOCUMENT = """\
deployment: {name}
components:
  base: {{program: sleep, args: ["600"]}}
  arm: {{program: sleep, args: ["600"], after: [base]}}
"""


@pytest.fixture
def robot(place: Place, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, rcyaml: Rcyaml) -> Iterator[Path]:
    """A document whose deployment runs as `Old`, and is called `New` now."""
    monkeypatch.setenv("XDG_STATE_HOME", f"{tmp_path}/own")
    monkeypatch.chdir(tmp_path)
    write_tree(tmp_path, {"robot.ddsl.yaml": DOCUMENT.format(name="Old")})
    assert rcyaml("deploy", "up").exit_code == 0
    write_tree(tmp_path, {"robot.ddsl.yaml": DOCUMENT.format(name="New")})
    yield tmp_path
    for name in ("Old", "New"):
        kill_left(f"{tmp_path}/.rcyaml/deployments/{name}")


@pytest.mark.parametrize("command", ["plan", "up", "restart", "down", "rollback"])
def test_what_would_run_twice_or_stay_is_refused(robot: Path, rcyaml: Rcyaml, command: str) -> None:
    refused = rcyaml("deploy", command)
    assert refused.exit_code == 2
    assert "robot.ddsl.yaml described 'Old' before, which still runs" in refused.stderr
    assert "`rcyaml deploy down Old` stops it" in refused.stderr


def test_status_says_it(robot: Path, rcyaml: Rcyaml) -> None:
    shown = rcyaml("deploy", "status")
    assert "base     not started" in shown.stdout and "described 'Old' before" in shown.stderr


def test_the_old_name_means_what_runs(robot: Path, rcyaml: Rcyaml) -> None:
    shown = rcyaml("deploy", "status", "Old")
    assert "base     ready" in shown.stdout
    assert "robot.ddsl.yaml describes another deployment now: the running processes are used instead" in shown.stderr
    assert "base | rcyaml: started" in rcyaml("deploy", "logs", "Old", "base").stdout
    assert rcyaml("deploy", "down", "Old").stdout == "arm   stopped\nbase  stopped\n"
    assert rcyaml("deploy", "ls").stdout == "no deployment is running\n"
    assert rcyaml("deploy", "up").exit_code == 0
    assert rcyaml("deploy", "down", "New").stdout == "arm   stopped\nbase  stopped\n"


def test_two_names_of_one_document_stop_their_own(robot: Path, rcyaml: Rcyaml) -> None:
    """An earlier version started both."""
    write_tree(robot, {"second.ddsl.yaml": DOCUMENT.format(name="New")})
    assert rcyaml("deploy", "up", "second.ddsl.yaml").exit_code == 0
    (robot / "second.ddsl.yaml").unlink()
    assert rcyaml("deploy", "down", "Old").exit_code == 0
    assert rcyaml("deploy", "ls").stdout.split()[5:7] == ["New", "running"]
    assert rcyaml("deploy", "down", "New").stdout == "arm   stopped\nbase  stopped\n"


def test_a_document_at_another_path(robot: Path, rcyaml: Rcyaml) -> None:
    write_tree(robot, {"moved/robot.ddsl.yaml": DOCUMENT.format(name="Old")})
    (robot / "robot.ddsl.yaml").unlink()
    for command in ("plan", "status", "down"):
        said = rcyaml("deploy", command, "moved/robot.ddsl.yaml")
        assert "another 'Old' runs, whose document robot.ddsl.yaml is gone" in said.stderr
        assert "`rcyaml deploy down robot.ddsl.yaml` stops it" in said.stderr
    for command in ("up", "restart", "rollback"):
        assert rcyaml("deploy", command, "moved/robot.ddsl.yaml").exit_code == 2  # they would run twice
    assert rcyaml("deploy", "down", "robot.ddsl.yaml").stdout == "arm   stopped\nbase  stopped\n"
    assert not rcyaml("deploy", "status", "moved/robot.ddsl.yaml").stderr


def test_a_folder_that_was_moved_has_what_ran_in_it(place: Place, tmp_path: Path, rcyaml: Rcyaml) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_STATE_HOME", f"{tmp_path}/own")
        write_tree(tmp_path, {"a/robot.ddsl.yaml": DOCUMENT.format(name="Moved")})
        patch.chdir(tmp_path / "a")
        assert rcyaml("deploy", "up").exit_code == 0
        (tmp_path / "a").rename(tmp_path / "b")
        patch.chdir(tmp_path / "b")
        shown = rcyaml("deploy", "status")
        assert shown.stdout.count("ready") == 2 and not shown.stderr
        assert rcyaml("deploy", "up").exit_code == 0  # in the folder of today
        assert rcyaml("deploy", "ls").stdout.count("Moved") == 1
        assert rcyaml("deploy", "down").stdout == "arm   stopped\nbase  stopped\n"
        assert rcyaml("deploy", "ls").stdout == "no deployment is running\n"


def test_what_was_killed_prevents_nothing(robot: Path, rcyaml: Rcyaml) -> None:
    kill_left(f"{robot}/.rcyaml/deployments/Old")
    assert rcyaml("deploy", "plan").exit_code == 0
