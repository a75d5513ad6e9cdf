"""`deploy rollback`: back to the last `up` that was all ready."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from conftest import write_tree
from small_networks import Place
from test_roles import Rcyaml, Robot


@pytest.fixture
def robot(place: Place, tmp_path: Path, rcyaml: Rcyaml) -> Robot:
    return Robot(tmp_path, rcyaml)


def speed(value: str, more: str = "") -> tuple[str, ...]:
    shown = f'laser: {{program: sh, args: [-c, "echo speed $SPEED; exec sleep 600"], env: {{SPEED: "{value}"}}}}'
    return (shown, 'camera: {program: sleep, args: ["600"]}', *([more] if more else []))


BROKEN = 'arm: {program: sh, args: [-c, "exit 3"], restart: "no"}'


def last(robot: Robot) -> str:
    return robot.deploy("logs", "laser", "-n", "1").splitlines()[-1].partition("| ")[2]


def test_back_and_forth(robot: Robot, place: Place) -> None:
    robot.write(*speed("1"))
    robot.deploy("up")
    camera = robot.of("camera")["pid"]
    robot.write(*speed("2", 'arm: {program: sleep, args: ["600"]}'))
    robot.deploy("up")
    said = robot.deploy("rollback")
    assert "laser   ready" in said and "arm     stopped" in said and "2 processes as desired" in said
    assert last(robot) == "speed 1" and robot.of("camera")["pid"] == camera
    plan = robot.deploy("plan")  # the document is as it was
    assert "env SPEED: 1 → 2" in plan and "+ arm" in plan
    assert "knows only what runs now" in robot.deploy("rollback", code=2)
    robot.deploy("up")
    assert last(robot) == "speed 2"


def test_after_a_failed_up(robot: Robot) -> None:
    robot.write(*speed("1"))
    robot.deploy("up")
    robot.write(*speed("2", BROKEN))
    robot.deploy("up", "--on-failure", "keep", code=1)
    assert last(robot) == "speed 2"
    robot.deploy("rollback")
    assert last(robot) == "speed 1"
    robot.deploy("status")


def test_with_a_document_that_cannot_be_read(robot: Robot) -> None:
    robot.write(*speed("1"))
    robot.deploy("up")
    robot.write(*speed("2"))
    robot.deploy("up")
    write_tree(robot.root, {"robot.ddsl.yaml": "deployment: Robot\ncomponents: [\n"})
    robot.deploy("rollback")
    assert last(robot) == "speed 1"


def test_an_up_that_changes_nothing_is_no_step_of_history(robot: Robot) -> None:
    for value in ("1", "2", "2", "2"):
        robot.write(*speed(value))
        robot.deploy("up")
    robot.deploy("rollback")
    assert last(robot) == "speed 1"


@pytest.mark.parametrize("comes_up", [False, True])
def test_without_an_earlier_up_it_is_refused(robot: Robot, comes_up: bool) -> None:
    robot.write(*speed("1"))
    if comes_up:
        robot.deploy("up")
        robot.deploy("down")
        assert not list(robot.root.rglob("history.json"))
    said = robot.deploy("rollback", code=2)
    assert "Robot cannot go back: rcyaml knows no `up` that was all ready" in said


def test_secrets_of_earlier_configurations_are_for_the_owner_only(robot: Robot) -> None:
    robot.write(*speed("1"))
    robot.deploy("up")
    (found,) = robot.root.rglob("history.json")
    assert found.stat().st_mode & 0o077 == 0


def test_a_rollback_that_fails_too_says_so(robot: Robot) -> None:
    """Of `up` and of `restart`; what was not restarted meanwhile goes on."""

    def write(value: str) -> None:
        once = f'"test -e once || exit 4; exec sleep 600", "{value}"'
        robot.write(
            f'laser: {{program: sh, args: [-c, {once}], restart: "no", ready: 2 s}}',
            'camera: {program: sleep, args: ["600"], after: [laser]}',
        )

    write_tree(robot.root, {"once": ""})
    write("1")
    robot.deploy("up")
    (robot.root / "once").unlink()
    write("2")
    said = robot.deploy("up", "--on-failure", "rollback", code=1)
    assert "Robot: failed; the rollback failed, too: laser is not ready\n" in said
    write_tree(robot.root, {"once": ""})
    robot.deploy("up")
    (robot.root / "once").unlink()
    found = json.loads(robot.deploy("restart", "--on-failure", "rollback", "--format", "json", "laser", code=1))
    assert (found["result"]["undone"], found["result"]["not_restored"]) == ("rollback", ["laser"])
