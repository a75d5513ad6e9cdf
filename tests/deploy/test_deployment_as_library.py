"""`api.Deployment`: the commands of `rcyaml deploy` as functions."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path

import pytest

from conftest import write_tree
from robocomp_yaml import api
from robocomp_yaml.deploy import folder
from robocomp_yaml.deploy.attached import Attached
from small_networks import Place

LEGS = """\
deployment: Legs
components:
  left: {program: sh, args: [-c, "echo one; exec sleep 600"], ready: {log: one}}
  right: {program: sleep, args: ["600"], after: [left]}
  lamp: {program: sleep, args: ["600"]}
groups: {both: {components: [left, right]}}
"""
BROKEN = LEGS.replace(
    "groups:", "  knee: {program: sh, args: [-c, 'echo it hurts; exit 4'], after: [right], restart: \"no\"}\ngroups:"
)


@pytest.fixture
def legs(place: Place, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(write_tree(tmp_path, {"robot.ddsl.yaml": LEGS}))
    return tmp_path


def opened(**more: str) -> api.Deployment:
    return api.load().deployment(**more)


def test_groups_steps_and_states(legs: Path) -> None:
    deployment, told = opened(), []
    try:
        assert {step.name: step.action for step in deployment.plan().steps.values()} == dict.fromkeys(
            ("left", "right", "lamp"), "start"
        )
        result = deployment.up("both", report=lambda event: told.append((event.name, event.kind)))
        assert not result.diagnostics and ("right", "ready") in told and "lamp" not in dict(told)
        first = {one.name: one.running.pid for one in deployment.status("both") if one.running}
        deployment.up("right", restart=True)
        again = {one.name: one.running.pid for one in opened().status() if one.running}
        assert again["left"] == first["left"] and again["right"] != first["right"] and "lamp" not in again
        assert [line.text for line in deployment.logs("left", last=1)] == ["one"]
    finally:
        assert set(deployment.down()) == {"left", "right"}
    assert deployment.down() == [] and deployment.diagnostics == []


def test_a_callback_chooses_what_happens_after_a_failure(legs: Path) -> None:
    write_tree(legs, {"robot.ddsl.yaml": BROKEN})
    asked: list[str] = []

    async def keep(result: api.Result) -> str:
        asked.extend(result.outcome.failed)
        return "keep"

    deployment = opened()
    try:
        result = deployment.up(on_failure=keep)
        assert (asked, result.undone) == (["knee"], "keep")
        (fault,) = deployment.diagnostics
        assert (fault.code, fault.span.file) == ("RC7004", "robot.ddsl.yaml") and "knee | it hurts" in fault.more
        assert {one.name for one in deployment.status() if one.state == "running"} == {"left", "right", "lamp"}
    finally:
        deployment.down()


def test_an_attached_up_takes_all_down_at_its_end(legs: Path) -> None:
    lines: list[str] = []

    def on_up(enough: asyncio.Event) -> None:
        asyncio.get_running_loop().call_later(0.1, enough.set)

    deployment = opened()
    deployment.up(stays=Attached(on_up, lambda line: lines.append(line.text)))
    assert "one" in lines
    assert not [one for one in deployment.status() if one.state == "running"]


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: opened().plan("lampe"), "Legs has no process or group 'lampe'; did you mean 'lamp'?"),
        (lambda: opened().status("lamp", "bot"), "did you mean 'both'?"),
        (lambda: opened().probe("localhots"), "Legs has no host 'localhots'; did you mean 'localhost'?"),
        (lambda: opened(engine="icegrd"), "no engine 'icegrd'; did you mean 'icegrid'?"),
        (lambda: opened().up(on_failure="rolback"), "did you mean 'rollback'?"),
        (lambda: opened().export("systmd"), "did you mean 'systemd'?"),
        (lambda: opened(path="other.ddsl.yaml"), "'other.ddsl.yaml' is not a deployment"),
    ],
)
def test_unknown_names_are_rejected(legs: Path, call: Callable[[], object], said: str) -> None:
    with pytest.raises(api.Refused, match=said.replace("?", r"\?")):
        call()
    assert not (legs / ".rcyaml/deployments").exists()


def test_only_one_process_changes_a_deployment_at_a_time(legs: Path) -> None:
    deployment = opened()
    with folder.locked(deployment.network.folder), pytest.raises(api.Faulty, match="another rcyaml is changing"):
        deployment.up()
    assert [one.code for one in deployment.diagnostics] == ["RC7005"]
    assert deployment.down() == []


def test_documents_with_errors_are_rejected(legs: Path) -> None:
    write_tree(legs, {"robot.ddsl.yaml": LEGS.replace("[left]", "[lfet]")})
    with pytest.raises(api.Faulty) as raised:
        opened()
    assert [one.span.line for one in raised.value.diagnostics] == [4]


def test_exports_are_files_or_data(legs: Path) -> None:
    deployment = opened()
    files = deployment.export("systemd")
    written = deployment.write_export("systemd", "units")
    assert (
        written == [f"units/{path}" for path in files] and (legs / written[0]).read_text() == files[next(iter(files))]
    )
    (legs / written[0]).write_text("mine\n")
    with pytest.raises(api.Faulty):
        deployment.write_export("systemd", "units")
    assert (legs / written[0]).read_text() == "mine\n"
