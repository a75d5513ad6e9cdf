"""`rcyaml top` of a network on three hosts: what another host does not say is unknown, also while it is away."""

from __future__ import annotations

import json
import shutil
import signal
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from conftest import write_tree
from terminals import COMMAND
from three_hosts import Deployment, three_hosts

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(shutil.which("icegridnode") is None, reason="IceGrid is not installed (Debian: zeroc-icegrid)"),
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
    pytest.importorskip("IceGrid", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    with three_hosts() as hosts:
        talk = Deployment(hosts, tmp_path, {"XDG_STATE_HOME": f"{tmp_path}/own"})
        write_tree(tmp_path, {
            "talk.ddsl.yaml": NETWORK.format(**hosts.addresses),
            "eye/eye.cdsl.yaml": "component: Eye\nlanguage: python\nperiod: 40 ms\n",
        })  # fmt: skip
        try:
            talk.rcyaml("compile")
            if hosts.prefix:
                talk.deploy("up", code=1)
                talk.start_node("head")
                talk.start_node("arm")
            talk.deploy("up")
            yield talk
        finally:
            talk.clean_up()


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
        assert found["far"]["memory"] is found["far"]["cpu"] is found["pan"]["memory"] is None

        talk.hosts.link("head", "down")
        try:
            samples(lambda found: found["far"]["worker"] is None and found["far"]["state"] == "lost")
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

    document = talk.root / "talk.ddsl.yaml"
    document.write_text(document.read_text() + '  new: {program: sleep, args: ["600"], host: onboard}\n')
    talk.deploy("up")
    samples(lambda found: "new" in found and found["new"]["cpu"] is not None)
    talk.deploy("down")
    samples(lambda found: found["near"]["state"] == found["pan"]["state"] == "not started")
