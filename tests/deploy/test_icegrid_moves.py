"""A network on three hosts, run by IceGrid: a gate between a group and those outside, and processes that move."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import ROOT
from processes import until
from three_hosts import Deployment, three_hosts

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(shutil.which("icegridnode") is None, reason="IceGrid is not installed (Debian: zeroc-icegrid)"),
]

NETWORK = """\
deployment: Talk
hosts:
  onboard: {{address: {onboard}}}
  head: {{address: {head}}}
  arm: {{address: {arm}}}
components:
  mouth: {{component: talkinghead/components/mouth, host: arm, ready: 20 s}}
  speech: {{component: talkinghead/components/speech, host: head, ready: 20 s}}
  watch: {{program: sleep, args: ["600"], host: onboard}}
groups:
  face: {{components: [mouth], expose: {{Mouth: {{member: mouth, rate: 50, allow: [move]}}}}}}
"""
GREETING = 4
"""Words that speech says when it starts, each with a call of `move`; then it calls `close`."""


@pytest.fixture(scope="module")
def talk(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Deployment]:
    """The network, up on three hosts."""
    pytest.importorskip("IceGrid", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    root = tmp_path_factory.mktemp("moves")
    with three_hosts() as hosts:
        deployment = Deployment(hosts, root)
        shutil.copytree(ROOT / "examples" / "talkinghead", root / "talkinghead")
        (root / "talk.ddsl.yaml").write_text(NETWORK.format(**hosts.addresses), encoding="utf-8")
        try:
            deployment.rcyaml("migrate", "talkinghead")
            deployment.rcyaml("compile", "talkinghead")
            if hosts.prefix:
                deployment.deploy("up", code=1)  # it writes the scripts that start nodes, and has no SSH
                for host in ("head", "arm"):
                    deployment.start_node(host)
            deployment.deploy("up")
            yield deployment
        finally:
            deployment.clean_up()


def test_a_gate_on_another_host_lets_pass_what_it_may(talk: Deployment) -> None:
    assert _hosts(talk) == {"mouth": "arm", "face.gate": "arm", "speech": "head", "watch": "onboard"}
    _greets(talk, 1)


def test_a_gate_that_is_killed_is_back_and_its_users_go_on(talk: Deployment) -> None:
    before = talk.pids()
    os.kill(before["face.gate"], 9)
    until(lambda: talk.pids()["face.gate"] not in (0, before["face.gate"]), lambda: talk.logs())
    now = {name: one["pid"] for name, one in talk.until_ready().items()}
    assert {name for name in now if now[name] != before[name]} == {"face.gate"}


def test_a_component_moves_and_those_that_use_it_follow(talk: Deployment) -> None:
    """From one host to the other, with its gate; whoever calls it is told where it is now."""
    before = talk.until_ready()
    document = talk.root / "talk.ddsl.yaml"
    document.write_text(document.read_text().replace("components/mouth, host: arm", "components/mouth, host: onboard"))
    planned = json.loads(talk.deploy("plan", "--format", "json"))["plan"]
    assert {step["name"]: step["action"] for step in planned} == {
        "mouth": "restart", "face.gate": "restart", "speech": "restart", "watch": "keep",
    }  # fmt: skip
    talk.deploy("up")
    now = talk.until_ready()
    assert _hosts(talk) == {"mouth": "onboard", "face.gate": "onboard", "speech": "head", "watch": "onboard"}
    assert now["watch"]["pid"] == before["watch"]["pid"]
    assert talk.copies("mouth") == 1 == talk.copies("face.gate") == talk.copies("speech")
    if talk.hosts.prefix:
        assert _network(now["mouth"]["pid"]) == _network(now["watch"]["pid"]) != _network(now["speech"]["pid"])
    _greets(talk, 2)
    assert "nothing to do" in talk.deploy("up")


def test_what_moved_is_followed_restarted_and_taken_down(talk: Deployment) -> None:
    follower = talk.begin("logs", "-f", "mouth", "speech")
    assert follower.stdout and follower.stdout.readline()  # what there is; from here on it follows
    before = talk.until_ready()
    talk.deploy("restart", "speech", "mouth")
    now = talk.until_ready()
    assert {name for name in now if now[name]["pid"] != before[name]["pid"]} == {"mouth", "speech"}
    _greets(talk, 3)
    follower.terminate()
    followed = follower.communicate(timeout=20)[0].splitlines()
    assert {line[:6] for line in followed if "rcyaml: started" in line} == {"mouth ", "speech"}
    assert [line for line in followed if "says 'Shelly' with the mouth" in line]
    talk.deploy("down", "mouth")
    assert {name for name, one in talk.status().items() if one["ready"]} == {"watch"}
    assert talk.copies("mouth") == 0 == talk.copies("speech")


def _greets(talk: Deployment, times: int) -> None:
    """Speech has said its greeting so many times since the deployment came up; what its gate forbids did not pass."""
    until(lambda: talk.logs("speech").count("lets pass move, not 'close'") >= times, lambda: talk.logs())
    assert talk.logs("speech").count("with the mouth") == GREETING * times
    assert talk.logs("mouth").count("moves to") == GREETING * times
    assert "closes" not in talk.logs("mouth")


def _hosts(talk: Deployment) -> dict[str, str]:
    return {name: one["host"] for name, one in talk.status().items()}


def _network(pid: int) -> str:
    return os.readlink(Path("/proc", str(pid), "ns", "net"))
