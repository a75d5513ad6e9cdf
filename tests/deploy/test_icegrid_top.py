"""`rcyaml top` of a network on three hosts: also what processes use there; while a host is away, that is unknown."""

from __future__ import annotations

import json
import signal
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from robocomp_yaml.deploy.local import procfs
from seen import NEEDS_ICEGRID
from terminals import COMMAND
from three_hosts import Deployment, talking

pytestmark = [
    pytest.mark.slow,
    NEEDS_ICEGRID,
]
NETWORK = """\
deployment: Talk
hosts: {{onboard: {{address: {onboard}}}, head: {{address: {head}}}, arm: {{address: {arm}}}}}
components:
  near: {{component: eye, host: onboard}}
  far: {{component: eye, host: head}}
  pan: {{program: sleep, args: ["600"], host: arm}}
"""
Samples = Callable[[Callable[[dict[str, Any]], object]], dict[str, Any]]


@pytest.fixture
def talk(tmp_path: Path) -> Iterator[Deployment]:
    with talking(
        tmp_path, NETWORK, {"eye/eye.cdsl.yaml": "component: Eye\nlanguage: python\nperiod: 40 ms\n"}
    ) as deployment:
        yield deployment


@pytest.fixture
def samples(talk: Deployment) -> Iterator[Samples]:
    """`samples(holds)`: the next sample of a running `top` for which this holds, by the processes' names."""
    top = talk.hosts.begin("onboard", [*COMMAND, "top", "--format", "json", "--every", "500ms"], cwd=talk.root,
                           env=talk.environment, stderr=subprocess.PIPE)  # fmt: skip
    assert top.stdout is not None and top.stderr is not None
    lines, seen = top.stdout, dict[str, Any]()

    def next_with(holds: Callable[[dict[str, Any]], object]) -> dict[str, Any]:
        for line in lines:
            sample = json.loads(line)
            seen.update({one["name"]: one for one in sample["processes"]}, problem=sample["problem"])
            if holds(seen):
                return seen
        raise AssertionError(f"it has ended: {top.stderr.read() if top.stderr else ''}\n{seen}")

    yield next_with
    top.send_signal(signal.SIGINT)
    assert top.wait(30) == 130
    assert "Traceback" not in top.stderr.read()
    top.stdout.close()
    top.stderr.close()


def test_hosts(talk: Deployment, samples: Samples) -> None:
    found = samples(lambda found: found["far"]["worker"])
    assert {found[name]["host"] for name in ("near", "far", "pan")} == set(talk.hosts.addresses)
    for name in ("near", "far"):
        assert found[name]["state"] == "running" and found[name]["worker"]["period"] == 0.04
    assert found["near"]["memory"] > 1 << 20 and found["near"]["cpu"] is not None
    assert not found["pan"]["is_component"] and found["pan"]["pid"]
    if talk.hosts.prefix:
        found = samples(lambda found: found["far"]["cpu"] and found["pan"]["cpu"] is not None)
        assert found["far"]["cpu"] < 2 and found["far"]["memory"] > found["pan"]["memory"] > 1 << 16
        talk.hosts.link("head", "down")
        try:
            samples(lambda found: found["far"]["worker"] is None and found["far"]["state"] == "lost")
            found = samples(lambda found: found["pan"]["memory"])
            assert found["far"]["memory"] is found["far"]["cpu"] is None, "unknown, not 0"
            found = samples(lambda found: found["near"]["worker"])
            assert found["pan"]["pid"] and found["near"]["state"] == "running", "the others are seen all the same"
        finally:
            talk.hosts.link("head", "up")
        samples(lambda found: found["far"]["worker"] and found["far"]["state"] == "running")

    # As any command, it starts the registry again, if its guard was killed, too.
    talk.kill_daemon("registry", for_good=True)
    for _ in range(4):
        found = samples(lambda found: found["near"]["worker"] and found["near"]["state"] == "running")
    samples(lambda found: not found["problem"] and found["far"]["pid"])

    status = talk.status()
    for name, least in (("near", 1 << 20), ("far", 1 << 20), ("pan", 1 << 16)):
        one = status[name]
        assert least < one["memory"] < 1 << 30 and 0 <= one["cpu"] < 100
        measured = procfs.memory(procfs.descendants({one["pid"]}, procfs.table()))
        assert 0.5 * measured < one["memory"] < 2 * measured

    document = talk.root / "talk.ddsl.yaml"
    document.write_text(document.read_text() + '  new: {program: sleep, args: ["600"], host: onboard}\n')
    talk.deploy("up")
    samples(lambda found: "new" in found and found["new"]["cpu"] is not None)
    talk.deploy("down")
    samples(lambda found: found["near"]["state"] == found["pan"]["state"] == "not started")
