"""The manager of a network on three hosts (network namespaces), plain and with TLS: what happens elsewhere is shown."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager
from http.client import HTTPConnection
from pathlib import Path
from typing import Any

import pytest

from conftest import write_tree
from seen import NEEDS_ICEGRID
from three_hosts import Deployment, three_hosts

pytest.importorskip("starlette", reason="pip install rcyaml[manager]")
pytest.importorskip("uvicorn", reason="pip install rcyaml[manager]")
pytestmark = [
    pytest.mark.slow,
    NEEDS_ICEGRID,
]
NETWORK = """\
deployment: Talk
hosts: {{onboard: {{address: {onboard}}}, head: {{address: {head}}}, arm: {{address: {arm}}}}}
components:
  near: {{component: eye, host: onboard}}
  far: {{component: eye, host: head}} # behind the neck
  pan: {{program: sleep, args: ["600"], host: arm, role: server}}
"""
EYES = {
    "Eye.idsl.yaml": "module: RoboCompEye\ninterfaces: {Eye: {methods: {look: {returns: int}}}}\n",
    "eye/eye.cdsl.yaml": "component: Eye\nlanguage: python\nimports: [../Eye]\nimplements: [Eye]\nperiod: 40 ms\n",
}


class SocketManager:
    """A manager on a unix socket, which is reached from any namespace."""

    def __init__(self, path: Path, token: str) -> None:
        self.path, self.token = path, token

    def connection(self) -> HTTPConnection:
        made = HTTPConnection("localhost", timeout=60)
        made.sock = socket.socket(socket.AF_UNIX)
        made.sock.settimeout(60)
        made.sock.connect(str(self.path))
        return made

    def talk(self, path: str, body: Any = None) -> tuple[int, Any]:
        connection = self.connection()
        headers = {"authorization": f"Bearer {self.token}"}
        data = None if body is None else json.dumps(body)
        connection.request("GET" if body is None else "POST", f"/api/deployments/Talk/{path}", data, headers)
        response = connection.getresponse()
        answer = json.loads(response.read())
        connection.close()
        return response.status, answer

    def happened(self) -> Generator[dict[str, Any], None, None]:
        """What happens from now on."""
        connection = self.connection()
        headers = {"authorization": f"Bearer {self.token}"}
        connection.request("GET", "/api/deployments/Talk/events", None, headers)
        response, kind = connection.getresponse(), ""
        try:
            while line := response.readline().decode():
                kind = line[7:].strip() if line.startswith("event: ") else kind
                if line.startswith("data: ") and kind in ("happened", "states"):
                    yield {"kind": kind, **json.loads(line[6:])}
        finally:
            response.close()
            connection.close()

    def words(self) -> dict[str, str]:
        return {one["name"]: one["words"] for one in self.talk("status")[1]["processes"]}

    def until(self, name: str, holds: Callable[[str], bool], within: float = 60) -> float:
        """The seconds until the words of a process are so."""
        began = time.monotonic()
        while not holds(self.words().get(name, "")):
            assert time.monotonic() - began < within, self.words()
            time.sleep(0.05)
        return time.monotonic() - began


@contextmanager
def managed(talk: Deployment, name: str = "socket") -> Iterator[SocketManager]:
    path = talk.root / name
    command = [sys.executable, "-m", "robocomp_yaml", "manager", "talk.ddsl.yaml", "--unix", str(path)]
    environment = {"PYTHONUNBUFFERED": "1", **talk.environment}
    running = talk.hosts.begin("onboard", command, cwd=talk.root, env=environment, stderr=subprocess.STDOUT)
    assert running.stdout is not None
    printed = ""
    try:
        while "Ctrl-C" not in printed and (line := running.stdout.readline()):
            printed += line
        assert "Ctrl-C" in printed, printed
        words = printed.split()
        yield SocketManager(path, words[words.index("token:") + 1])
        running.send_signal(signal.SIGINT)
        assert running.wait(20) == 130, running.stdout.read()
        assert "Traceback" not in running.stdout.read()
    finally:
        running.kill()
        running.wait()
        running.stdout.close()


@pytest.fixture(scope="module", params=["", "security: tls\n"], ids=["plain", "tls"])
def talk(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Deployment]:
    pytest.importorskip("IceGrid", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    root = tmp_path_factory.mktemp("talk")
    with three_hosts() as hosts:
        talk = Deployment(hosts, root, {"XDG_STATE_HOME": f"{root}/own"})
        write_tree(
            root, {"talk.ddsl.yaml": NETWORK.format(**hosts.addresses) + request.param, **EYES, "rcyaml.yaml": ""}
        )
        try:
            talk.rcyaml("compile")
            if hosts.prefix:
                talk.deploy("up", code=1)
                talk.start_node("head")
                talk.start_node("arm")
            yield talk
        finally:
            talk.clean_up()


def test_a_network_is_started_watched_changed_and_stopped(talk: Deployment) -> None:
    document = talk.root / "talk.ddsl.yaml"
    with managed(talk) as one, managed(talk, "second") as other:
        status, done = one.talk("up", {"timeout": 120})
        assert (status, done["ok"]) == (200, True), done
        for each in (one, other):
            for name in ("near", "far", "pan"):
                each.until(name, lambda words: words == "ready")
        # What others do: a process is killed.
        events = other.happened()
        next(events)
        pid = next(state["pid"] for state in one.talk("status")[1]["processes"] if state["name"] == "far")
        began = time.monotonic()
        os.kill(pid, signal.SIGKILL)
        next(found for found in events if found["kind"] == "states"
             and any(state["name"] == "far" and (state["words"], state["pid"]) != ("ready", pid)
                     for state in found["processes"]))  # fmt: skip
        shown = time.monotonic() - began
        print(f"kill -9 of a process of another host was shown after {shown:.2f} s")
        assert shown < 8  # two seconds on a machine that does nothing else
        events.close()
        # A document is edited by somebody else, and by both managers.
        version = one.talk("document")[1]["version"]
        document.write_text(document.read_text() + "# mine\n")
        move = {"change": {"change": "rename", "entry": "pan", "name": "tilt"}, "based_on": version}
        status, conflict = one.talk("edit", move)
        assert (status, conflict["theirs"].endswith("# mine\n")) == (409, True)
        version = one.talk("document")[1]["version"]
        assert one.talk("edit", {**move, "based_on": version})[0] == 200
        assert other.talk("edit", {**move, "based_on": version})[0] == 409
        assert other.talk("undo", {})[0] == 200  # what another manager did
        assert document.read_text().endswith("# mine\n")
        assert "pan:" in document.read_text()
        for name in ("near", "far", "pan"):
            one.until(name, lambda words: words == "ready")
        status, answer = one.talk("call", {"method": "far.Eye.look"})
        assert (status, answer) == (200, {"returns": 0})
        lines = one.talk("logs?name=far&last=5")[1]["lines"]
        assert lines
        assert other.talk("restart", {"names": ["pan"], "timeout": 60})[1]["ok"]
        assert set(one.talk("down", {})[1]["stopped"]) == {"near", "far", "pan"}
        one.until("far", lambda words: words in ("not started", "stopped"))
