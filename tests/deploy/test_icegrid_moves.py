"""A network on three hosts, run by IceGrid: a gate of a group, and processes that move."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from processes import until
from seen import NEEDS_ICEGRID
from small_networks import is_alive
from three_hosts import Deployment, talking_head

pytestmark = [
    pytest.mark.slow,
    NEEDS_ICEGRID,
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
  blink: {{program: sleep, args: ["600"], host: head}}
groups:
  face: {{components: [mouth], expose: {{Mouth: {{member: mouth, rate: 50, allow: [move]}}}}}}
"""
GREETING = 4
"""The words for which speech calls `move` when it starts. Then it calls `close`."""


@pytest.fixture(scope="module")
def talk(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Deployment]:
    """The running network on three hosts."""
    pytest.importorskip("IceGrid", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    with talking_head(tmp_path_factory.mktemp("moves"), NETWORK, _start_one_after_the_other) as deployment:
        yield deployment


def _start_one_after_the_other(talk: Deployment) -> None:
    """Without a node, the processes of its host do not start; others can."""
    talk.deploy("up", "watch")
    talk.start_node("head")
    said = talk.deploy("up", "--on-failure", "keep", code=1)
    assert said.count("error[RC7021]") == 1 and "'arm'" in said and "the started processes keep running" in said
    assert {name for name, one in talk.status().items() if one["ready"]} == {"watch", "blink"}
    talk.start_node("arm")


def test_a_gate_on_another_host_forwards_allowed_calls(talk: Deployment) -> None:
    assert _hosts(talk) == {"mouth": "arm", "face.gate": "arm", "speech": "head", "watch": "onboard", "blink": "head"}
    _greets(talk)


def test_a_killed_gate_is_restarted_and_its_users_go_on(talk: Deployment) -> None:
    before = talk.pids()
    os.kill(before["face.gate"], 9)
    until(lambda: talk.pids()["face.gate"] not in (0, before["face.gate"]), lambda: talk.logs())
    now = {name: one["pid"] for name, one in talk.until_ready().items()}
    assert {name for name in now if now[name] != before[name]} == {"face.gate"}


def test_a_component_moves_and_those_that_use_it_follow(talk: Deployment) -> None:
    """It moves to another host with its gate, and its callers get the new address."""
    before = talk.until_ready()
    _move(talk, "arm", "onboard")
    planned = json.loads(talk.deploy("plan", "--format", "json"))["plan"]
    assert {step["name"]: step["action"] for step in planned} == {
        "mouth": "restart", "face.gate": "restart", "speech": "restart", "watch": "keep", "blink": "keep",
    }  # fmt: skip
    talk.deploy("up")
    now = talk.until_ready()
    assert _hosts(talk) == {
        "mouth": "onboard", "face.gate": "onboard", "speech": "head", "watch": "onboard", "blink": "head",
    }  # fmt: skip
    assert now["watch"]["pid"] == before["watch"]["pid"]
    assert talk.copies("mouth") == 1 == talk.copies("face.gate") == talk.copies("speech")
    if talk.hosts.prefix:
        assert _network(now["mouth"]["pid"]) == _network(now["watch"]["pid"]) != _network(now["speech"]["pid"])
    _greets(talk)
    assert "nothing to do" in talk.deploy("up")


def test_a_component_moves_away_from_a_host_without_a_connection(talk: Deployment) -> None:
    """The old one goes on without callers, and ends when its host is back."""
    talk.hosts.need_a_network("so no cable to pull")
    _move(talk, "onboard", "arm")
    talk.deploy("up")
    _greets(talk)
    old = talk.until_ready()["mouth"]["pid"]
    talk.hosts.link("arm", "down")
    try:
        until(lambda: talk.status()["mouth"]["state"] == "lost", "the host does not answer")
        _move(talk, "arm", "onboard")
        talk.deploy("up")
        assert _hosts(talk)["mouth"] == "onboard"
        new = talk.until_ready()["mouth"]["pid"]
        assert talk.copies("mouth") == 2
    finally:
        talk.hosts.link("arm", "up")
    until(lambda: talk.copies("mouth") == 1 == talk.copies("face.gate"), lambda: str(talk.status()))
    assert not is_alive(old)
    assert talk.until_ready()["mouth"]["pid"] == new
    _greets(talk)


def test_a_moved_component_has_logs_restart_and_down(talk: Deployment) -> None:
    follower = talk.begin("logs", "-f", "mouth", "speech")
    assert follower.stdout and follower.stdout.readline()  # what there is; from here on it follows
    before = talk.until_ready()
    talk.deploy("restart", "speech", "mouth")
    now = talk.until_ready()
    assert {name for name in now if now[name]["pid"] != before[name]["pid"]} == {"mouth", "speech"}
    _greets(talk)
    follower.terminate()
    followed = follower.communicate(timeout=20)[0].splitlines()
    assert {line[:6] for line in followed if "rcyaml: started" in line} == {"mouth ", "speech"}
    assert [line for line in followed if "says 'Shelly' with the mouth" in line]
    talk.deploy("down", "mouth")
    assert {name for name, one in talk.status().items() if one["ready"]} == {"watch", "blink"}
    assert talk.copies("mouth") == 0 == talk.copies("speech")


def _greets(talk: Deployment) -> None:
    """Speech has made its calls once for each start. The gate did not forward forbidden calls."""
    times = talk.logs("speech").count("SpeechComp is running")
    until(lambda: talk.logs("speech").count("allows move, not 'close'") == times, lambda: talk.logs())
    assert talk.logs("speech").count("with the mouth") == GREETING * times
    assert talk.logs("mouth").count("moves to") == GREETING * times
    assert "closes" not in talk.logs("mouth")


def _move(talk: Deployment, old: str, new: str) -> None:
    document = talk.root / "talk.ddsl.yaml"
    document.write_text(
        document.read_text().replace(f"components/mouth, host: {old}", f"components/mouth, host: {new}")
    )


def _hosts(talk: Deployment) -> dict[str, str]:
    return {name: one["host"] for name, one in talk.status().items()}


def _network(pid: int) -> str:
    return os.readlink(Path("/proc", str(pid), "ns", "net"))
