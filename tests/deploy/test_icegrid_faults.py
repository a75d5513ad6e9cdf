"""Faults on another host of a network that IceGrid runs: they are reported as on this machine, and nothing is left
over."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from conftest import write_tree
from processes import Ports, until
from seen import NEEDS_ICEGRID
from small_networks import LISTEN
from three_hosts import Deployment, three_hosts

pytestmark = [
    pytest.mark.slow,
    NEEDS_ICEGRID,
]
HEAD = """\
deployment: Talk
hosts:
  onboard: {{address: {onboard}}}
  arm: {{address: {arm}}}
components:
  near: {{program: sleep, args: ["600"], host: onboard}}
"""


@pytest.fixture(scope="module")
def hosts(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Deployment]:
    """A program runs on the first host. The node of the other host was started by hand if necessary."""
    pytest.importorskip("IceGrid", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    root = tmp_path_factory.mktemp("faults")
    with three_hosts() as hosts:
        deployment = Deployment(hosts, root)
        patched = pytest.MonkeyPatch()
        patched.setenv("ROBOT_TOKEN", "correct-horse-battery")  # for commands, and for the node of the other host
        try:
            write_document(deployment, "far: {program: sleep, args: ['600'], host: arm}")
            if hosts.prefix:
                deployment.deploy("up", code=1)
                deployment.start_node("arm")
            deployment.deploy("up")
            yield deployment
        finally:
            patched.undo()
            deployment.clean_up()


def write_document(deployment: Deployment, *entries: str) -> None:
    text = HEAD.format(**deployment.hosts.addresses) + "".join(f"  {entry}\n" for entry in entries)
    write_tree(deployment.root, {"talk.ddsl.yaml": text})


def fails(hosts: Deployment, entry: str, *words: str) -> str:
    """The output of `up` for a failing process `bad` on the other host. What ran before goes on."""
    before = hosts.pids()["near"]
    write_document(hosts, entry, "behind: {program: sleep, args: ['600'], host: onboard, after: [bad]}")
    said = hosts.deploy("up", *words, code=1)
    assert "\nTraceback" not in said
    after = hosts.status()
    assert after["near"]["pid"] == before
    assert after["behind"]["pid"] == 0 == after["bad"]["pid"] and hosts.copies("bad") == 0
    return said


def need_another_machine(hosts: Deployment) -> None:
    if not hosts.hosts.prefix:
        pytest.skip(f"all hosts are this machine, because there are no network namespaces: {hosts.hosts.why}")


@pytest.mark.parametrize(
    ("program", "reason"), [("./no-such-program", "No such file or directory"), ("./text", "Permission denied")]
)
def test_a_program_that_cannot_be_run(hosts: Deployment, program: str, reason: str) -> None:
    need_another_machine(hosts)
    write_tree(hosts.root, {"text": "no program\n"})
    said = fails(hosts, f"bad: {{program: {hosts.root}/{program}, host: arm, restart: 'no'}}")
    assert re.search(r"error\[RC700[24]\]", said) and reason in said, said


def test_a_port_that_another_program_uses(hosts: Deployment, free_port: Ports) -> None:
    need_another_machine(hosts)
    port = free_port()
    inside = ["ip", "netns", "exec", f"{hosts.hosts.prefix}arm"]
    script = LISTEN.replace("'127.0.0.1'", "''")
    other = subprocess.Popen([*inside, sys.executable, "-c", script, str(port)])
    try:
        ask = ["bash", "-c", f"</dev/tcp/127.0.0.1/{port}"]
        until(lambda: hosts.hosts.run("arm", ask).returncode == 0, "it listens")
        said = fails(hosts, f"bad: {{program: {sys.executable}, args: [-c, \"{script}\", '{port}'], host: arm, "
                            f"endpoints: {{Laser: tcp -p {port}}}, restart: 'no'}}")  # fmt: skip
    finally:
        other.kill()
        other.wait()
    assert f"error[RC7001]: 'bad' needs port {port}, which another program uses: a program on the host 'arm'" in said


def test_a_process_that_is_never_ready(hosts: Deployment, free_port: Ports) -> None:
    ready = f"ready: {{port: {free_port()}, within: 0.5 s}}"
    said = fails(hosts, f"bad: {{program: sh, args: [-c, 'echo no motor; exec sleep 600'], host: arm, {ready}}}")
    assert "error[RC7003]: 'bad' was not ready within 0.5 s: nothing listens on port" in said
    assert "bad | no motor" in said


def test_a_crash_loop(hosts: Deployment) -> None:
    restart = "restart: {policy: on-failure, tries: 2, delay: 10 ms}, ready: {log: x}"
    said = fails(hosts, f"bad: {{program: sh, args: [-c, 'echo no power; exit 3'], host: arm, {restart}}}")
    assert "error[RC7004]: 'bad' ended before it was ready: exit code 3, after 2 restarts" in said
    assert "given up: it ended 3 times within 60 s" in said
    assert hosts.logs("bad").count("no power") == 3


def test_a_secret_is_not_visible_anywhere(hosts: Deployment) -> None:
    """A secret of the environment or of the document is in no command, because commands are visible to everybody."""
    own = "TOKEN: {env: ROBOT_TOKEN}, PASSWORD: 'swordfish $HOME \\\\ ''q'''"
    script = 'echo $(printf %s $TOKEN | wc -c) $(printf %s "$PASSWORD" | wc -c); exec sleep 600'
    write_document(hosts, f"bad: {{program: sh, args: [-c, '{script}'], host: arm, env: {{{own}}}}}",
                   f"good: {{program: sh, args: [-c, '{script}'], host: onboard, env: {{{own}}}}}")  # fmt: skip
    said = hosts.deploy("up", code=None)
    lengths = f"{len('correct-horse-battery')} {len('swordfish $HOME ' + chr(92) * 2 + ' ' + chr(39) + 'q' + chr(39))}"
    until(lambda: hosts.logs("bad", "good").count(lengths) == 2, lambda: hosts.logs("bad", "good"))
    said += hosts.deploy("status") + hosts.deploy("plan", "--format", "json")
    seen = subprocess.run(["ps", "-eww", "-o", "args"], capture_output=True, text=True, check=True).stdout + said
    assert "correct-horse" not in seen and "swordfish" not in seen
    texts = [path for path in Path(hosts.folder).rglob("*") if path.is_file() and b"correct-horse" in path.read_bytes()]
    assert not texts


def test_an_address_that_does_not_resolve(hosts: Deployment) -> None:
    need_another_machine(hosts)  # `moon` is no neighbour of hosts on loopback
    before = hosts.pids()
    text = (hosts.root / "talk.ddsl.yaml").read_text(encoding="utf-8")
    lost = text.replace("hosts:\n", "hosts:\n  moon: {address: nowhere.invalid}\n")
    write_tree(hosts.root, {"talk.ddsl.yaml": f"{lost}  lost: {{program: sleep, args: ['600'], host: moon}}\n"})
    said = hosts.deploy("up", code=1)
    assert "error[RC7021]: the host 'moon' (nowhere.invalid) has no IceGrid node" in said and "Traceback" not in said
    write_tree(hosts.root, {"talk.ddsl.yaml": text})
    assert hosts.pids() == before
