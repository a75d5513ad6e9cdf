"""The manager, as programs use it: a real server, and a real network of programs."""

from __future__ import annotations

import json
import os
import shutil
import signal
import socket
import ssl
import stat
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from http.client import HTTPConnection, HTTPResponse
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urlsplit

import pytest

from conftest import write_tree
from processes import kill_left, until

pytest.importorskip("starlette", reason="pip install rcyaml[manager]")
pytest.importorskip("uvicorn", reason="pip install rcyaml[manager]")

ROBOT = """\
deployment: Robot
components:
  base: {program: sh, args: [-c, "echo the base turns; exec sleep 600"], ready: {log: turns}}  # the base
  camera: {program: sleep, args: ["600"], role: server}
  arm: {program: sleep, args: ["600"], after: [base], role: server}
groups: {body: {components: [base, arm]}}
"""


class Manager:
    """A running manager; `api` are paths below its address."""

    def __init__(self, process: subprocess.Popen[str], printed: str) -> None:
        self.process, self.printed = process, printed
        self.open_ones: list[HTTPConnection] = []
        words = printed.split()
        address = next((word for word in words if word.startswith("http")), "")
        self.port = urlsplit(address).port or 0
        self.token = parse_qs(urlsplit(address).query)["token"][0] if address else words[words.index("token:") + 1]

    def connection(self) -> HTTPConnection:
        made = HTTPConnection("127.0.0.1", self.port, timeout=30)
        self.open_ones.append(made)
        return made

    def close(self) -> None:
        for connection in self.open_ones:
            connection.close()

    def ask(self, path: str, body: Any = None, method: str = "", **headers: str) -> tuple[int, Any]:
        response = self.open(path, body, method, **headers)
        content = response.read().decode()
        is_json = "json" in response.headers.get("content-type", "")
        return response.status, json.loads(content) if is_json else content

    def open(self, path: str, body: Any = None, method: str = "", **headers: str) -> HTTPResponse:
        connection = self.connection()
        sent = {"authorization": f"Bearer {self.token}"} | headers
        data = None if body is None else json.dumps(body)
        connection.request(method or ("GET" if body is None else "POST"), path, data, sent)
        return connection.getresponse()

    def robot(self, path: str, body: Any = None) -> tuple[int, Any]:
        return self.ask(f"/api/deployments/Robot/{path}", body)

    def words(self) -> dict[str, str]:
        return {one["name"]: one["words"] for one in self.robot("status")[1]["processes"]}


@contextmanager
def manager(folder: Path, *words: str) -> Iterator[Manager]:
    command = [sys.executable, "-m", "robocomp_yaml", "manager", "--no-browser", *words]
    environment = {**os.environ, "PYTHONUNBUFFERED": "1"}
    process = subprocess.Popen(
        command, cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    assert process.stdout is not None
    printed = ""
    try:
        while "Ctrl-C" not in printed and (line := process.stdout.readline()):
            printed += line
        assert "Ctrl-C" in printed, printed
        one = Manager(process, printed)
        try:
            yield one
        finally:
            one.close()
    finally:
        process.kill()
        process.wait()
        process.stdout.close()


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    monkeypatch.setenv("XDG_STATE_HOME", f"{tmp_path}/own")
    folder = tmp_path / "robot"
    write_tree(folder, {"robot.ddsl.yaml": ROBOT, "rcyaml.yaml": "{}\n"})
    yield folder
    kill_left(f"{folder}/.rcyaml/deployments/Robot")


def test_commands_that_say_what_is_ready_are_run_seldom(robot: Path) -> None:
    """Each is a process of its own: with fifty of them, they would cost more than the manager."""
    asked, document = robot / "asked", robot / "robot.ddsl.yaml"
    command = f"ready: {{command: [sh, -c, 'echo x >> {asked}']}}"
    document.write_text(
        ROBOT.replace('camera: {program: sleep, args: ["600"]', f"camera: {{program: sleep, args: ['600'], {command}")
    )
    with manager(robot) as one:
        assert one.robot("up", {})[1]["ok"]
        until(lambda: one.words() == dict.fromkeys(("base", "camera", "arm"), "ready"), "all are ready")
        time.sleep(2.5)
        before = asked.read_text().count("x")
        time.sleep(7)
        assert asked.read_text().count("x") - before <= 1
        states = {state["name"]: state for state in one.robot("status")[1]["processes"]}
        assert list(states) == ["base", "camera", "arm"]
        assert states["base"]["load"] == 0
        os.kill(states["camera"]["pid"], signal.SIGKILL)
        until(lambda: one.robot("status")[1]["processes"][1]["restarts"] == 1, "it is asked again at once", 8)
        assert one.robot("down", {})[1]["ok"]


def read_events(response: HTTPResponse, kind: str) -> Iterator[Any]:
    """The data of the events of a kind. Fails if the next one takes a minute: others may come all the time."""
    last, until = "", time.monotonic() + 60
    while line := response.readline().decode():
        assert time.monotonic() < until, f"no event {kind}"
        if line.startswith("event: "):
            last = line[7:].strip()
        if line.startswith("data: ") and last == kind:
            yield json.loads(line[6:])
            until = time.monotonic() + 60


def test_a_network_is_planned_started_watched_and_stopped(robot: Path) -> None:
    with manager(robot) as one:
        assert one.words() == dict.fromkeys(("base", "camera", "arm"), "not started")
        assert [step["name"] for step in one.robot("plan?name=arm")[1]["plan"] if step["action"] == "start"] == [
            "base", "arm",
        ]  # fmt: skip
        events = one.open("/api/deployments/Robot/events")
        states, happened = read_events(events, "states"), read_events(events, "happened")
        assert len(next(states)["processes"]) == 3
        status, done = one.robot("up", {})
        assert (status, done["ok"], done["result"]["ready"]) == (200, True, ["base", "camera", "arm"])
        pid = {state["name"]: state["pid"] for state in one.robot("status")[1]["processes"]}["camera"]
        assert pid
        assert next(happened)["text"] == "up"
        os.kill(pid, signal.SIGKILL)
        began = time.monotonic()
        told = next(found for found in happened if found["name"] == "camera" and "SIGKILL" in found["text"])
        assert time.monotonic() - began < 5  # one second on a machine that does nothing else
        if "started again" not in told["text"]:  # it was seen while it waited
            next(found for found in happened if found["name"] == "camera" and "started again" in found["text"])

        plan = one.robot("plan?action=down&name=base")[1]
        assert (plan["stop"], plan["reasons"]) == (["arm", "base"], {"arm": "it is after base"})
        restarts = one.robot("plan?action=restart&name=camera")[1]["plan"]
        assert [step["name"] for step in restarts if step["action"] == "restart"] == ["camera"]
        assert one.robot("restart", {"names": ["camera"]})[1]["ok"]
        assert one.robot("down", {"names": ["base"]})[1]["stopped"] == ["arm", "base"]
        assert one.robot("down", {})[1]["stopped"] == ["camera"]
        assert "down: done" in [past["text"] for past in one.robot("history")[1]["happened"]]


def test_what_others_start_is_seen_and_the_network_goes_on(robot: Path) -> None:
    rcyaml = [sys.executable, "-m", "robocomp_yaml", "deploy"]
    with manager(robot) as one:
        subprocess.run([*rcyaml, "up", "--on-failure", "keep"], cwd=robot, check=True, capture_output=True)
        deadline = time.monotonic() + 20
        while set(one.words().values()) != {"ready"} and time.monotonic() < deadline:
            time.sleep(0.1)
        assert set(one.words().values()) == {"ready"}
        one.process.send_signal(signal.SIGINT)
        assert one.process.wait(20) == 130
    shown = subprocess.run([*rcyaml, "status"], cwd=robot, capture_output=True, text=True)
    assert (shown.returncode, shown.stdout.count("ready")) == (0, 3)
    with manager(robot) as one:
        assert set(one.words().values()) == {"ready"}
        one.process.send_signal(signal.SIGTERM)
        assert one.process.wait(20) == 143


def test_logs_are_read_and_followed(robot: Path) -> None:
    with manager(robot) as one:
        assert one.robot("up", {"names": ["base"]})[1]["ok"]
        lines = one.robot("logs?name=base&grep=turns")[1]["lines"]
        assert [(line["name"], line["text"]) for line in lines] == [("base", "the base turns")]
        following = read_events(one.open("/api/deployments/Robot/log-events?name=body&last=0"), "line")
        assert one.robot("restart", {"names": ["base"]})[1]["ok"]
        assert next(line for line in following if line["text"] == "the base turns")["name"] == "base"
        assert one.robot("logs?last=many")[0] == 400
        assert one.ask("/api/deployments/Robot/log-events?name=bass")[0] == 404


def test_documents_are_changed_and_conflicts_keep_the_file(robot: Path) -> None:
    document = robot / "robot.ddsl.yaml"
    with manager(robot) as one:
        version = one.robot("document")[1]["version"]
        change = {"change": "after", "entry": "camera", "needed": ["arm"]}
        status, shown = one.robot("edit", {"change": change, "based_on": version, "write": False})
        assert (status, shown["written"], document.read_text()) == (200, False, ROBOT)
        assert "after: [arm]" in shown["diff"]
        assert one.robot("edit", {"change": change, "based_on": version})[1]["written"]
        assert document.read_text() == ROBOT.replace("role: server}\n  arm", "role: server, after: [arm]}\n  arm")
        events = read_events(one.open("/api/deployments/Robot/events"), "documents")
        mine = document.read_text() + "# mine\n"
        document.write_text(mine)
        assert one.robot("entries")[0] == 200  # what one page reads, the others are told all the same
        assert next(events) == {"problem": ""}
        past = [each["text"] for each in one.robot("history")[1]["happened"]]
        assert past == ["after camera arm", "robot.ddsl.yaml was changed elsewhere"]
        status, conflict = one.robot("edit", {"change": change, "based_on": version})
        assert (status, conflict["theirs"], document.read_text()) == (409, mine, mine)
        assert "after: [arm]" in conflict["ours"]
        assert one.robot("undo", {})[0] == 400
        wrong = {"change": "connect", "entry": "camera", "port": "Mouth", "to": "nobody"}
        status, _ = one.robot("edit", {"change": wrong})
        assert status in (400, 422)
        assert document.read_text() == mine
        move = {"change": "rename", "entry": "camera", "name": "eye"}
        assert one.robot("edit", {"change": move})[0] == 200
        assert one.robot("undo", {})[0] == 200
        assert document.read_text() == mine
        assert one.robot("redo", {})[0] == 200
        assert "  eye: " in document.read_text()
        assert [node["name"] for node in one.robot("graph")[1]["nodes"]] == ["base", "eye", "arm"]
        document.rename(robot / "other.ddsl.yaml")
        status, refused = one.robot("graph")
        assert (status, "robot.ddsl.yaml is not there any more" in refused["error"]) == (400, True)


def test_nothing_outside_of_the_workspace_is_served(robot: Path) -> None:
    write_tree(robot.parent, {"secret.ddsl.yaml": "deployment: Secret\n", "secret.txt": "secret"})
    (robot / "link.ddsl.yaml").symlink_to("../secret.ddsl.yaml")
    with manager(robot, "robot.ddsl.yaml") as one:
        for path in (
            "../secret.ddsl.yaml",
            f"{robot.parent}/secret.txt",
            "/etc/passwd",
            "link.ddsl.yaml",
            "rcyaml.yaml\0",
        ):
            status, answer = one.ask(f"/api/deployments/Robot/document?path={path.replace(chr(0), '%00')}")
            assert (status, "not a document of this workspace" in answer["error"]) == (400, True), path
        for path in ("/../robot.ddsl.yaml", "/robot.ddsl.yaml", "/%2e%2e/robot.ddsl.yaml", "/..%2frobot.ddsl.yaml"):
            assert one.ask(path)[0] == 404, path
        assert (
            one.robot("edit", {"change": {"change": "rename", "entry": "x", "name": "y"}, "document": "/etc/x"})[0]
            == 400
        )
        assert one.ask("/api/deployments/Rboot/graph")[0] == 404


@pytest.mark.parametrize(("option", "rights"), [("--read-only", ()), ("--operate", ("down",))])
def test_rights_hold_for_every_command(robot: Path, option: str, rights: tuple[str, ...]) -> None:
    with manager(robot, option) as one:
        paths = one.ask("/api/openapi.json")[1]["paths"]
        changing = [path for path, methods in paths.items() if "post" in methods]
        assert len(changing) > 12
        for path in changing:
            (right,) = paths[path]["post"]["tags"]
            status, answer = one.ask(path.replace("{deployment}", "Robot"), {"nonsense": 1})
            assert status == (400 if right == "read" or (right == "operate" and rights) else 403), (path, answer)
        assert one.robot("document")[0] == 200
        for right in rights:
            assert one.robot(right, {})[0] == 200


def test_strangers_are_refused(robot: Path) -> None:
    with manager(robot) as one:
        for headers in (
            {"authorization": "Bearer x"},
            {"authorization": ""},
            {"Host": "evil.com"},
            {"Origin": "http://evil.com"},
        ):
            assert one.ask("/api/deployments", **headers)[0] in (403, 421), headers
        connection = one.connection()
        connection.request("GET", f"/?token={one.token}")
        response = connection.getresponse()
        assert (response.status, response.headers["location"]) == (303, "/")
        cookie = response.headers["set-cookie"].partition(";")[0]
        connection = one.connection()
        connection.request("GET", "/api/deployments", headers={"cookie": cookie})
        assert connection.getresponse().status == 200


def test_a_unix_socket_is_its_owners(robot: Path, tmp_path: Path) -> None:
    path = tmp_path / "s"
    left = socket.socket(socket.AF_UNIX)
    left.bind(str(path))
    left.close()  # as a manager that was killed leaves it
    with manager(robot, "--unix", str(path)) as one:
        assert stat.S_IMODE(path.stat().st_mode) == 0o600
        with socket.socket(socket.AF_UNIX) as connection:
            connection.connect(str(path))
            connection.sendall(
                f"GET /api/deployments HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer {one.token}\r\n"
                "Connection: close\r\n\r\n".encode()
            )
            answer = b"".join(iter(lambda: connection.recv(4096), b""))
        assert answer.startswith(b"HTTP/1.1 200")
        command = [sys.executable, "-m", "robocomp_yaml", "manager", "--unix", str(path)]
        again = subprocess.run(command, cwd=robot, capture_output=True, text=True, timeout=60)
        assert (again.returncode, "address already in use" in again.stderr) == (2, True)
        one.process.send_signal(signal.SIGINT)
        assert one.process.wait(20) == 130
    assert not path.exists()


def test_others_are_served_encrypted(robot: Path, tmp_path: Path) -> None:
    if shutil.which("openssl") is None:
        pytest.skip("openssl is not installed")
    key, certificate = f"{tmp_path}/key.pem", f"{tmp_path}/cert.pem"
    subprocess.run(
        ["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days",
         "1", "-subj", "/CN=robot", "-addext", "subjectAltName=IP:127.0.0.1", "-keyout", key, "-out", certificate],
        check=True, capture_output=True,
    )  # fmt: skip
    command = [sys.executable, "-m", "robocomp_yaml", "manager", "--no-browser", "--listen", "0.0.0.0"]
    for words in ([], ["--cert", certificate], ["--key", key]):
        refused = subprocess.run([*command, *words], cwd=robot, capture_output=True, text=True, timeout=60)
        assert (refused.returncode, "--cert and --key" in refused.stderr) == (2, True)
    with manager(robot, "--listen", "127.0.0.1", "--cert", certificate, "--key", key) as one:
        assert "https://127.0.0.1" in one.printed
        context = ssl.create_default_context(cafile=certificate)
        plain = socket.create_connection(("127.0.0.1", one.port), 20)
        with context.wrap_socket(plain, server_hostname="127.0.0.1") as connection:
            connection.sendall(f"GET /?token={one.token} HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n".encode())
            assert b"Secure" in connection.recv(4096)


def test_several_deployments_and_broken_ones(robot: Path) -> None:
    write_tree(robot, {"broken.ddsl.yaml": "deployment: Broken\ncomponents: [\n", "second.ddsl.yaml": ROBOT})
    with manager(robot, "robot.ddsl.yaml", "broken.ddsl.yaml", "second.ddsl.yaml") as one:
        found = one.ask("/api/deployments")[1]["deployments"]
        assert [(each["id"], bool(each["problem"])) for each in found] == [
            ("Robot", False), ("broken", True), ("Robot-2", False),
        ]  # fmt: skip
        assert one.ask("/api/deployments/broken/graph")[0] == 422
        assert one.ask("/api/deployments/Robot-2/graph")[1]["document"] == "second.ddsl.yaml"
        (robot / "broken.ddsl.yaml").write_text("deployment: Broken\n")
        assert one.ask("/api/deployments/broken/graph")[0] == 200


def test_it_says_how_to_reach_it(robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SSH_CONNECTION", "10.0.0.9 50000 10.0.0.2 22")
    with manager(robot) as one:
        assert f"ssh -L {one.port}:localhost:{one.port} 10.0.0.2" in one.printed
        with manager(robot) as other:
            assert other.port not in (0, one.port)
