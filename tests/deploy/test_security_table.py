"""The table of docs/security.md: who can do what with a deployment on three hosts, plain and with `security: tls`.

Each row is a test. A client is a program of its own: as the same user, as another user of the machine, or on another
host; with or without token and certificate.
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

import control_client
from conftest import ROOT
from processes import until
from robocomp_yaml.deploy.authority import properties
from seen import NEEDS_ICEGRID
from test_icegrid import HEARER, TELLER, WORDS
from three_hosts import Deployment, talking_head

pytestmark = [
    pytest.mark.slow,
    NEEDS_ICEGRID,
    pytest.mark.skipif(os.geteuid() != 0, reason="only root becomes another user, and joins network namespaces"),
]

NETWORK = """\
deployment: Talk
hosts:
  onboard: {{address: {onboard}}}
  head: {{address: {head}}}
  arm: {{address: {arm}}}
services:
  storm: {{icestorm: {{host: onboard, publish: 9998}}}}
components:
  mouth: {{component: talkinghead/components/mouth, host: arm, ports: {{Mouth: 10001, CommonBehavior: 10002}}}}
  speech: {{component: talkinghead/components/speech, host: onboard, ports: {{Speech: 10003, CommonBehavior: 10004}}}}
  hearer: {{component: words/hearer, host: arm, ports: {{CommonBehavior: 10006}}}}
  teller: {{component: words/teller, host: head, ports: {{CommonBehavior: 10007}}, after: [hearer]}}
  other: {{program: sleep, args: [600], host: onboard, endpoints: {{Other: tcp -p 10009}}, ready: {{command: ["true"]}}}}
groups:
  face: {{components: [mouth], expose: {{Mouth: {{member: mouth, rate: 50, allow: [move]}}}}}}
"""
OTHERS = {
    "words/rcyaml.yaml": "interfaces: [interfaces/]\n",
    "words/interfaces/Words.idsl.yaml": WORDS,
    **{
        f"words/{name}/{name}.cdsl.yaml": (
            f"component: {name.title()}\nlanguage: python\nimports: [Words]\n{key}: [Words]\nperiod: 20 ms\n"
        )
        for name, key in (("teller", "publishes"), ("hearer", "subscribes"))
    },
    "words/teller/src/specificworker.py": TELLER,
    "words/hearer/src/specificworker.py": HEARER.replace('os.environ["GREETING"]', '"nothing"'),
}
RECORDER = """\
import socket, sys
raw = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(3))
print("recording", flush=True)
with open(sys.argv[1], "wb", buffering=0) as file:
    while True:
        file.write(raw.recv(1 << 16))
"""
SLICE = ROOT / "templates" / "slice" / "CommonBehavior.ice"
NOBODY = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"]
PORTS = {"mouth": ("arm", 10002), "speech": ("onboard", 10004), "hearer": ("arm", 10006), "teller": ("head", 10007)}


class Table:
    """A running deployment, and its clients."""

    def __init__(self, talk: Deployment, protocol: str) -> None:
        self.talk, self.protocol = talk, protocol
        self.state = Path(talk.environment["XDG_STATE_HOME"])

    @property
    def token(self) -> str:
        (found,) = self.state.glob("rcyaml/deployments/*/token")
        return found.read_text().strip()

    @property
    def certificate(self) -> dict[str, str]:
        self.talk.rcyaml("call", "--deployment", "talk.ddsl.yaml", "speech.isBusy")  # the first command makes it
        (found,) = self.state.glob("rcyaml/authorities/*/commands.pem")
        return properties(str(found))

    def call(
        self, process: str, operation: str, source: str = "", token: str = "", user: list[str] | None = None,
        tls: dict[str, str] | None = None, protocol: str = "", address: str = "",
    ) -> str:  # fmt: skip
        """What came of a call of CommonBehavior, from a host (its own, without `source`), at an address (its own)."""
        host, port = PORTS[process]
        at = address or self.talk.hosts.addresses[host]
        proxy = f'commonbehavior:{protocol or self.protocol} -h "{at}" -p {port}'
        command = [*(user or ()), sys.executable, control_client.__file__, str(SLICE), proxy, operation, token]
        command += [f"{key}={value}" for key, value in (tls or {}).items()]
        done = self.talk.hosts.run(source or host, command)
        return done.stdout.strip() or done.stderr


@contextmanager
def running(security: str) -> Iterator[Table]:
    pytest.importorskip("IceGrid", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    root = Path(tempfile.mkdtemp(prefix="security"))
    root.chmod(0o755)  # another user can enter it: what protects files are their own modes
    environment = {"XDG_STATE_HOME": f"{root}/state"}
    before = {key: os.environ.get(key) for key in environment}
    os.environ.update(environment)
    try:
        with talking_head(root, NETWORK + security, _start_nodes, OTHERS) as talk:
            talk.environment.update(environment)
            talk.hosts.need_a_network("so that a call comes from another host")
            talk.until_ready()
            yield Table(talk, "ssl" if security else "tcp")
            talk.deploy("down")
            left = [path for path in root.glob(".rcyaml/deployments/Talk/config/*") if path.is_file()]
            assert not left, "configurations and keys that `down` left behind"
            assert not list(root.glob("state/rcyaml/deployments/*/token"))
    finally:
        for key, value in before.items():
            if value is None:
                os.environ.pop(key, None)
            else:
                os.environ[key] = value
        shutil.rmtree(root, ignore_errors=True)


def _start_nodes(talk: Deployment) -> None:
    talk.deploy("up", code=1)
    for host in ("head", "arm"):
        talk.start_node(host)


@pytest.fixture(scope="module")
def plain() -> Iterator[Table]:
    with running("") as table:
        yield table


@pytest.fixture(scope="module")
def tls() -> Iterator[Table]:
    with running("security: tls\n") as table:
        yield table


# Plain: whoever reaches a TCP port calls methods and reads; nobody without the token controls.


def test_plain_another_user_reads_but_does_not_control(plain: Table) -> None:
    assert plain.call("speech", "getPeriod", user=NOBODY).startswith("ok")
    assert "token of its deployment" in plain.call("speech", "killYourSelf", user=NOBODY)
    assert "token of its deployment" in plain.call("speech", "setPeriod", token="guessed", user=NOBODY)


def test_plain_the_owner_without_the_token_does_not_control(plain: Table) -> None:
    assert "token of its deployment" in plain.call("speech", "setPeriod")
    assert plain.call("speech", "setPeriod", token=plain.token) == "ok NoneType"


def test_plain_another_host_reads_and_never_controls(plain: Table) -> None:
    for process in PORTS:
        source = next(host for host in ("head", "arm", "onboard") if host != PORTS[process][0])
        assert plain.call(process, "getPeriod", source).startswith("ok")
        for token in ("", plain.token):
            assert "needs TLS" in plain.call(process, "setPeriod", source, token)


def test_plain_the_own_commands_know_the_token(plain: Table) -> None:
    said = plain.talk.rcyaml("param", "set", "--deployment", "talk.ddsl.yaml", "speech", "period.compute", "80")
    assert "period.compute = 80" in said
    said = plain.talk.rcyaml(
        "param", "set", "--deployment", "talk.ddsl.yaml", "mouth", "period.compute", "80", code=None
    )
    assert "needs TLS" in said, "it is on another host"


# With TLS: nobody without a certificate gets an answer.


def test_tls_nobody_without_a_certificate_gets_an_answer(tls: Table) -> None:
    plugin = {"Ice.Plugin.IceSSL": "IceSSL:createIceSSL", "IceSSL.VerifyPeer": "0"}
    for process in PORTS:
        for source in ("onboard", "head", "arm"):
            assert tls.call(process, "getPeriod", source, tls=plugin).startswith("failed"), (process, source)
    assert tls.call("speech", "getPeriod", protocol="tcp").startswith("failed")


def test_tls_a_certificate_of_another_authority_is_rejected(tls: Table, tmp_path: Path) -> None:
    own = tmp_path / "own.pem"
    words = "req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -subj /CN=rcyaml -days 10 -keyout"
    subprocess.run(
        ["openssl", *words.split(), str(tmp_path / "key"), "-out", str(tmp_path / "certificate")],
        check=True, capture_output=True,
    )  # fmt: skip
    own.write_text((tmp_path / "key").read_text() + (tmp_path / "certificate").read_text())
    trusting = {**properties(str(own)), "IceSSL.VerifyPeer": "0"}
    for process in PORTS:
        assert tls.call(process, "getPeriod", "onboard", tls=trusting).startswith("failed")
        assert tls.call(process, "getPeriod", "onboard", tls=properties(str(own))).startswith("failed")


def test_tls_with_a_certificate_another_host_reads_and_with_the_token_it_controls(tls: Table) -> None:
    for process in PORTS:
        source = next(host for host in ("head", "arm", "onboard") if host != PORTS[process][0])
        assert tls.call(process, "getPeriod", source, tls=tls.certificate).startswith("ok")
        assert "token of its deployment" in tls.call(process, "setPeriod", source, tls=tls.certificate)
        assert tls.call(process, "setPeriod", source, tls.token, tls=tls.certificate) == "ok NoneType"


def test_tls_components_and_topics_work_across_hosts(tls: Table) -> None:
    talk = tls.talk
    until(lambda: "says 'Shelly' with the mouth" in talk.logs("speech"), lambda: talk.logs())
    until(lambda: "heard word" in talk.logs("hearer"), lambda: talk.logs())


def test_tls_the_own_commands_know_certificates_and_token(tls: Table) -> None:
    own = ("--deployment", "talk.ddsl.yaml")
    assert "returns: false" in tls.talk.rcyaml("call", *own, "speech.isBusy")
    assert "period.compute = 90" in tls.talk.rcyaml("param", "set", *own, "mouth", "period.compute", "90")
    assert "Words.word(number:" in tls.talk.rcyaml("topic", "echo", *own, "Words", "--count", "2")
    assert "1 subscriber" in tls.talk.rcyaml("topic", "list", *own)


def test_tls_what_stays_plain_is_told_by_plan(tls: Table) -> None:
    said = tls.talk.deploy("plan")
    assert "'other' stays plain under `security: tls`: it is a program" in said and "RC4114" in said
    assert "nothing to do" in said


# The network: what is sent there, and a second network of the hosts.


@contextmanager
def captured(table: Table, host: str, path: Path) -> Iterator[list[bytes]]:
    """All that a host sends and receives meanwhile, in one element at the end."""
    hosts, found = table.talk.hosts, list[bytes]()
    with hosts.begin(host, [sys.executable, "-c", RECORDER, str(path)]) as recorder:
        try:
            assert recorder.stdout is not None and recorder.stdout.readline() == "recording\n"
            yield found
            time.sleep(0.3)
        finally:
            recorder.terminate()
    found.append(path.read_bytes())


@pytest.mark.parametrize("name", ["plain", "tls"])
def test_what_is_sent_between_hosts(name: str, request: pytest.FixtureRequest, tmp_path: Path) -> None:
    """Plain, everybody on the way reads all except the token; with TLS, nothing."""
    table: Table = request.getfixturevalue(name)
    talk, own = table.talk, ("--deployment", "talk.ddsl.yaml")
    rcyaml = [sys.executable, "-m", "robocomp_yaml"]
    with captured(table, "head", tmp_path / "sent") as sent:
        call = ["call", *own, "speech.say", "text=a-canary-of-ours", "overwrite=true"]
        said = talk.hosts.run("head", [*rcyaml, *call], cwd=talk.root, env=talk.environment)
        assert "returns: true" in said.stdout, said.stderr
        before = talk.logs("hearer")  # of a limited number of lines
        until(lambda: talk.logs("hearer") != before, lambda: talk.logs("hearer"))
        for process in ("teller", "speech"):
            talk.rcyaml("param", "set", *own, process, "period.compute", "90", code=None)
    # Operations with their length and what follows: three letters are somewhere in every long text that looks random.
    words = [b"a-canary-of-ours", b"speech", b"\x03say\x00", b"\x04word"]
    readable = [word for word in words if word in sent[0]]
    assert readable == ([] if name == "tls" else words)
    assert table.token.encode() not in sent[0] and len(sent[0]) > 2000


@pytest.mark.parametrize("name", ["plain", "tls"])
def test_on_another_network_of_a_host_nobody_answers(name: str, request: pytest.FixtureRequest) -> None:
    table: Table = request.getfixturevalue(name)
    tls = table.certificate if name == "tls" else None
    second = {"arm": ["10.98.0.3", "fd98::3"], "head": ["10.98.0.2", "fd98::2"]}
    hosts = table.talk.hosts
    for host, addresses in second.items():
        for address in addresses:
            length = "64" if ":" in address else "24"
            words = ["ip", "address", "replace", f"{address}/{length}", "dev", "eth0"]
            assert hosts.run(host, [*words, *(["nodad"] if ":" in address else [])]).returncode == 0
    for process in ("mouth", "hearer"):
        assert table.call(process, "getPeriod", "head", tls=tls).startswith("ok")
        for address in second["arm"]:
            for source in ("head", "arm"):
                said = table.call(process, "getPeriod", source, tls=tls, address=address)
                assert "ConnectionRefused" in said, (process, address, said)


# Files: another user reads nothing, and nothing listens beyond the addresses of the document.


@pytest.mark.parametrize("name", ["plain", "tls"])
def test_another_user_reads_no_file(name: str, request: pytest.FixtureRequest) -> None:
    table: Table = request.getfixturevalue(name)
    for folder in (table.talk.folder, str(table.state / "rcyaml" / "deployments"), str(table.state)):
        done = table.talk.hosts.run("onboard", [*NOBODY, "find", folder, "-type", "f", "-readable"])
        assert "deployments" not in done.stdout or not [
            line for line in done.stdout.splitlines() if "/.rcyaml/" in line or "/state/rcyaml/" in line
        ], done.stdout
    every = subprocess.run(["find", table.talk.folder, "-type", "f", "-perm", "/077"], capture_output=True, text=True)
    open_ = [line for line in every.stdout.splitlines() if "/config/" in line or line.endswith((".pem", "token"))]
    assert not open_


@pytest.mark.parametrize("name", ["plain", "tls"])
def test_nothing_listens_beyond_the_hosts_addresses(name: str, request: pytest.FixtureRequest) -> None:
    """Components, gate, IceStorm, registry and nodes."""
    table: Table = request.getfixturevalue(name)
    for host, address in table.talk.hosts.addresses.items():
        rows = [line.split()[3] for line in table.talk.hosts.run(host, ["ss", "-Hltn"]).stdout.splitlines()]
        assert rows
        others = [row for row in rows if row.rpartition(":")[0] not in (address, "127.0.0.1", f"[::ffff:{address}]")]
        assert not others, f"{host}: {others}"


@pytest.mark.parametrize("name", ["plain", "tls"])
def test_no_output_has_the_token(name: str, request: pytest.FixtureRequest) -> None:
    table: Table = request.getfixturevalue(name)
    talk = table.talk
    said = talk.logs() + talk.deploy("plan") + talk.deploy("status", "--format", "json") + talk.rcyaml(
        "param", "list", "--deployment", "talk.ddsl.yaml", "speech"
    ) + talk.rcyaml("config", "show", "speech", code=None)  # fmt: skip
    assert table.token not in said
    assert "PRIVATE KEY" not in said


def test_tls_a_component_that_hangs_on_another_host_is_started_again(tls: Table) -> None:
    """It is asked over TLS, by what supervises it there."""
    before = tls.talk.pids()["hearer"]
    os.kill(before, signal.SIGSTOP)
    until(lambda: tls.talk.status()["hearer"]["pid"] != before, lambda: tls.talk.logs("hearer"), 40)
    assert "not alive: it does not answer" in tls.talk.logs("hearer")
    assert all("not alive" not in tls.talk.logs(name) for name in ("teller", "mouth", "speech"))
