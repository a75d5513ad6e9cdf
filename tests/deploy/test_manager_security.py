"""The manager against an attacker: pages of other sites, other users of the machine, hostile requests and documents."""

from __future__ import annotations

import json
import os
import socket
import ssl
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from conftest import write_tree
from processes import until
from test_manager import ROBOT, Manager, manager

API = "/api/deployments"
EVIL = "<img src=x onerror=alert(1)>"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("secure") / "robot"
    text = ROBOT.replace("groups:", f'  odd: {{program: echo, args: ["{EVIL}"], role: task}}\ngroups:')
    write_tree(made, {"robot.ddsl.yaml": text, "rcyaml.yaml": "{}\n", "../secret.txt": "a secret"})
    return made


@pytest.fixture(scope="module")
def served(folder: Path) -> Iterator[Manager]:
    with manager(folder) as one:
        yield one


def cookie(one: Manager) -> str:
    return f"rcyaml-{one.port}={one.token}"


def browser(one: Manager, path: str, method: str = "GET", body: str | None = None, **headers: str) -> tuple[int, str]:
    """What a browser gets, which has the cookie."""
    connection = one.connection()
    sent = {"cookie": cookie(one)} | {name.replace("_", "-"): value for name, value in headers.items()}
    connection.request(method, path, body, sent)
    response = connection.getresponse()
    return response.status, "" if "event-stream" in response.headers["content-type"] else response.read().decode()


def raw(one: Manager, request: bytes) -> bytes:
    with socket.create_connection(("127.0.0.1", one.port), 10) as connection:
        connection.sendall(request)
        return connection.recv(65536)


@pytest.mark.parametrize("kind", ["text/plain", "application/x-www-form-urlencoded", "multipart/form-data", ""])
def test_a_form_of_another_site_changes_nothing(served: Manager, kind: str) -> None:
    """Such requests need no permission of CORS."""
    body = json.dumps({"change": {"change": "rename", "entry": "arm", "name": "stolen"}})
    for site, origin in (("cross-site", "https://evil.com"), ("same-site", "http://localhost:8000"), ("none", "null")):
        headers = {"origin": origin, "sec-fetch-site": site, "content-type": kind}
        assert browser(served, f"{API}/Robot/edit", "POST", body, **headers)[0] == 403, (site, origin)
    assert browser(served, f"{API}/Robot/edit", "POST", body, content_type=kind)[0] == 403  # an old browser
    assert "stolen" not in served.robot("document")[1]["text"]
    own = {"origin": f"http://127.0.0.1:{served.port}", "content-type": kind}
    assert browser(served, f"{API}/Robot/plan?name=arm", **own)[0] == 200


def test_pages_of_other_sites_read_nothing(served: Manager) -> None:
    for path in (f"{API}/Robot/events", f"{API}/Robot/log-events", f"{API}/Robot/document", "/", "/main.js"):
        for origin in ("https://evil.com", "http://127.0.0.1:8000", f"https://127.0.0.1:{served.port}", "null"):
            assert browser(served, path, origin=origin)[0] == 403, (path, origin)
        for site in ("cross-site", "same-site"):  # other ports of this machine are the same site: cookies are sent
            assert browser(served, path, sec_fetch_site=site, sec_fetch_mode="no-cors")[0] == 403
    status, _ = browser(served, f"{API}/Robot/document", sec_fetch_site="same-site", sec_fetch_mode="navigate")
    assert status == 403
    assert browser(served, "/", sec_fetch_site="cross-site", sec_fetch_mode="navigate")[0] == 200
    for method in ("OPTIONS", "PUT", "DELETE", "PATCH", "TRACE"):
        assert browser(served, f"{API}/Robot/edit", method, origin="https://evil.com")[0] == 403
        assert browser(served, f"{API}/Robot/edit", method)[0] in (403, 405)


def test_a_link_of_another_site_leads_to_the_page(served: Manager) -> None:
    """Such as the printed address in a terminal that is a web page: strict cookies are not sent after its redirect."""
    headers = {"sec-fetch-site": "cross-site", "sec-fetch-mode": "navigate", "cookie": ""}
    status, text = browser(served, f'/?token={served.token}&a="><script>', **headers)
    assert (status, 'content="0;url=/?a=%22%3E%3Cscript%3E"' in text) == (200, True)
    assert "<script" not in text


def test_answers_say_how_they_are_to_be_read(served: Manager) -> None:
    for path in ("/", f"{API}/Robot/status", "/no-such", f"{API}/{EVIL.replace(' ', '%20')}/graph", "/favicon.ico"):
        response = served.open(path)
        text = response.read().decode()
        assert response.headers["x-content-type-options"] == "nosniff"
        assert response.headers["referrer-policy"] == "no-referrer"
        assert response.headers["cache-control"] == "no-store"
        policy = response.headers["content-security-policy"]
        assert "default-src 'none'" in policy and "frame-ancestors 'none'" in policy and "unsafe" not in policy
        assert "access-control-allow-origin" not in response.headers
        assert "server" not in response.headers
        assert EVIL not in text or response.headers["content-type"] == "application/json"


def test_markup_is_data(served: Manager) -> None:
    assert EVIL in served.robot("document")[1]["text"]
    wrong = served.robot("document")[1]["text"].replace("odd:", f'"{EVIL}":')
    status, answer = served.robot("write", {"path": "robot.ddsl.yaml", "text": wrong})
    assert (status, EVIL in answer["error"]) == (422, True)
    status, answer = served.robot("edit", {"change": {"change": "remove", "entry": EVIL}})
    assert (status, EVIL in answer["error"]) == (400, True)


@pytest.mark.parametrize(
    "path",
    [
        "/../../secret.txt", "/..%2f..%2fsecret.txt", "/%2e%2e/%2e%2e/secret.txt", "/....//secret.txt", "/%00",
        "/main.js/../../../secret.txt", "//etc/passwd", "/\\..\\..\\secret.txt", "/static/%252e%252e/secret.txt",
        f"{API}/..%2f..%2f/document", f"{API}/Robot%2f..%2f..%2fsecret/graph", f"{API}/Robot/../../../secret.txt",
        f"{API}/Robot/document?path=..%2fsecret.txt", f"{API}/Robot/document?path=../secret.txt",
        f"{API}/Robot/component?name=../../secret.txt", f"{API}/Robot/logs?name=../../secret.txt",
        f"{API}/Robot/availability?host=../../etc", f"{API}/Robot/topic?topic=../../etc/passwd",
    ],
)  # fmt: skip
def test_no_path_leads_out(served: Manager, path: str) -> None:
    status, answer = served.ask(path)
    assert status in (400, 404), (path, answer)
    assert "a secret" not in str(answer) and "root:" not in str(answer)


def test_large_and_endless_bodies_end(served: Manager) -> None:
    large = "x" * (1 << 20)
    assert served.robot("diagnose", {"path": "robot.ddsl.yaml", "text": large})[0] == 413
    said = f"POST {API}/Robot/edit HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer {served.token}\r\n"
    assert b" 413 " in raw(served, f"{said}Content-Length: 99999999999\r\n\r\n{{".encode())  # nothing is waited for
    chunk = b"10000\r\n" + b"x" * 0x10000 + b"\r\n"
    with socket.create_connection(("127.0.0.1", served.port), 10) as connection:
        connection.sendall(f"{said}Transfer-Encoding: chunked\r\n\r\n".encode())
        try:
            for _ in range(200):
                connection.sendall(chunk)
        except OSError:
            pass  # it has answered, and listens no more
        assert b" 413 " in connection.recv(65536)
    both = f"{said}Content-Length: 4\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\nGET / HTTP/1.1\r\n\r\n"
    assert b" 200 " not in raw(served, both.encode())
    assert b" 400 " in raw(served, b"GET / HTTP/1.1\r\n" + b"X: " + b"y" * 200_000 + b"\r\n\r\n")
    assert b" 421 " in raw(served, b"GET / HTTP/1.0\r\n\r\n")


@pytest.mark.parametrize(
    "body",
    [
        "[" * 50_000, '{"change": ' * 5000, '{"change": {"change": "set", "entry": "arm", "parameter": "a", "value": '
        + "[" * 5000 + "]" * 5000 + "}}", '{"change": 1}', '{"change": {"change": "rename", "entry": "\\ud800"}}', "null",
        '{"change": {"change": "port", "entry": "arm", "number": 1e999}}', "\x00", '{"path": "\\ud800", "text": ""}',
        '{"change": {"change": "port", "entry": "arm", "number": 99999999999999999999999999}}', "{'a': 1}",
    ],
)  # fmt: skip
def test_wrong_bodies_get_a_sentence(served: Manager, body: str) -> None:
    for command in ("edit", "write", "diagnose", "positions", "call", "push"):
        connection = served.connection()
        headers = {"authorization": f"Bearer {served.token}"}
        connection.request("POST", f"{API}/Robot/{command}", body.encode("utf-8", "surrogatepass"), headers)
        response = connection.getresponse()
        answer = json.loads(response.read())
        assert (response.status in (400, 422), bool(answer["error"])) == (True, True), (command, answer)
        assert "Traceback" not in answer["error"]


def test_bombs_are_small(served: Manager) -> None:
    laughs = ["a0: &a0 [" + "x, " * 9 + "x]"]
    laughs += [f"a{i}: &a{i} [" + ", ".join([f"*a{i - 1}"] * 10) + "]" for i in range(1, 12)]
    texts = ["\n".join(laughs), "a: " + "[" * 90_000, "a: " + "{b: " * 90_000, "? " * 90_000, "- " * 90_000,
             "a: &a [*a, *a]", "&a a: *a", "x: !!python/object/apply:os.system [id]", "<<: " * 50_000,
             "components: {" + ", ".join(f"c{i}: {{program: [}}" for i in range(20_000)) + "}"]  # fmt: skip
    for text in texts:
        began = time.monotonic()
        for command in ("diagnose", "write"):
            status, answer = served.robot(command, {"path": "robot.ddsl.yaml", "text": f"deployment: X\n{text}"})
            assert (status, bool(answer["diagnostics"])) == (200 if command == "diagnose" else 422, True), text[:50]
        assert time.monotonic() - began < 20, text[:50]
    memory = Path(f"/proc/{served.process.pid}/status").read_text()
    assert int(memory.split("VmRSS:")[1].split()[0]) < 200_000  # KiB


def test_a_pattern_cannot_stop_the_manager(served: Manager) -> None:
    began = time.monotonic()
    assert served.robot("logs?grep=" + "(a%2B)%2B" * 3 + "%24")[0] in (200, 400)
    assert served.robot("logs?grep=(")[0] == 400
    assert served.robot("logs?since=" + "9" * 500 + "&last=99999999")[0] in (200, 400)
    assert time.monotonic() - began < 10


def test_the_token_is_in_no_log_and_no_file(served: Manager, folder: Path) -> None:
    served.ask(f"/?token={served.token}")
    served.robot("edit", {"change": {"change": "after", "entry": "camera", "needed": ["base"]}})
    served.robot("undo", {})
    kept = [path for path in folder.rglob("*") if path.is_file() and served.token.encode() in path.read_bytes()]
    assert kept == []
    assert served.printed.count(served.token) == 1
    command = Path(f"/proc/{served.process.pid}/cmdline").read_bytes()
    environment = Path(f"/proc/{served.process.pid}/environ").read_bytes()
    assert served.token.encode() not in command + environment


def test_links_that_appear_later_lead_nowhere(served: Manager, folder: Path) -> None:
    outside = folder.parent / "outside.ddsl.yaml"
    outside.write_text("deployment: Outside\n")
    (folder / "inner.ddsl.yaml").write_text("deployment: Inner\n")
    version = served.robot("document?path=inner.ddsl.yaml")[1]["version"]
    (folder / "inner.ddsl.yaml").unlink()
    (folder / "inner.ddsl.yaml").symlink_to(outside)
    for command, more in (("document?path=inner.ddsl.yaml", None),
                          ("write", {"path": "inner.ddsl.yaml", "text": "deployment: X\n", "force": True}),
                          ("write", {"path": "inner.ddsl.yaml", "text": "x: y\n", "based_on": version})):  # fmt: skip
        assert served.robot(command, more)[0] == 400, command
    (folder / "deep").symlink_to(folder.parent)
    assert served.robot("document?path=deep/outside.ddsl.yaml")[0] == 400
    assert outside.read_text() == "deployment: Outside\n"
    (folder / "inner.ddsl.yaml").unlink()
    (folder / "deep").unlink()


def test_connections_that_do_nothing_do_not_lock_others_out(served: Manager) -> None:
    idle = [socket.create_connection(("127.0.0.1", served.port), 10) for _ in range(100)]
    try:
        assert served.robot("status")[0] == 200
    finally:
        for one in idle:
            one.close()


def test_an_address_of_every_interface_is_called_by_any_of_them(folder: Path, tmp_path: Path) -> None:
    """But by no name that another site can make mean this machine."""
    key, certificate = f"{tmp_path}/key.pem", f"{tmp_path}/cert.pem"
    made = subprocess.run(
        ["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days",
         "1", "-subj", "/CN=robot", "-keyout", key, "-out", certificate], capture_output=True,
    )  # fmt: skip
    if made.returncode:
        pytest.skip("openssl is not installed")
    with manager(folder, "robot.ddsl.yaml", "--listen", "0.0.0.0", "--cert", certificate, "--key", key) as one:
        assert f"https://{socket.gethostname()}:{one.port}/?token=" in one.printed
        context = ssl.create_default_context()
        context.check_hostname, context.verify_mode = False, ssl.CERT_NONE

        def ask(host: str, **headers: str) -> bytes:
            with context.wrap_socket(socket.create_connection(("127.0.0.1", one.port), 20)) as connection:
                more = "".join(f"{name}: {value}\r\n" for name, value in headers.items())
                said = f"GET /?token={one.token} HTTP/1.1\r\nHost: {host}:{one.port}\r\n{more}\r\n"
                connection.sendall(said.encode())
                return connection.recv(4096)

        for host in ("127.0.0.1", socket.gethostname(), f"{socket.gethostname()}.local"):
            assert b" 303 " in ask(host), host
        for host in ("evil.com", "10.9.8.7", "[2001:db8::1]"):
            assert b" 421 " in ask(host), host
        assert b"Secure" in ask("127.0.0.1")
        assert b" 403 " in ask("127.0.0.1", Origin=f"http://127.0.0.1:{one.port}")  # not encrypted


def test_a_unix_socket_is_never_open_to_others(folder: Path, tmp_path: Path) -> None:
    path = tmp_path / "s"
    path.write_text("a file of the user")
    done: Any = None
    try:
        with manager(folder, "robot.ddsl.yaml", "--unix", str(path)) as done:
            pass
    except AssertionError:
        done = None
    assert done is None
    assert path.read_text() == "a file of the user"
    path.unlink()
    os.umask(before := os.umask(0))
    try:
        os.umask(0)
        with manager(folder, "robot.ddsl.yaml", "--unix", str(path)):
            until(path.exists, "the socket")
            assert path.stat().st_mode & 0o777 == 0o600
    finally:
        os.umask(before)
