"""`listen:` with the names of network interfaces, which are resolved on their own hosts."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from conftest import write_tree
from processes import Ports, until
from robocomp_yaml.deploy.interfaces import address_of, known, with_address
from seen import NEEDS_ICEGRID
from three_hosts import Deployment, three_hosts

pytestmark = [
    pytest.mark.slow,
    NEEDS_ICEGRID,
    pytest.mark.skipif(os.geteuid() != 0, reason="only root adds interfaces"),
]
DOCUMENTS = {
    "Eye.idsl.yaml": "module: RoboCompEye\ninterfaces:\n  Eye: {methods: {look: {returns: int}}}\n",
    "eye/eye.cdsl.yaml": "component: Eye\nlanguage: python\nimports: [../Eye]\nimplements: [Eye]\n",
    "user/user.cdsl.yaml": "component: User\nlanguage: python\nimports: [../Eye]\nrequires: [Eye]\n",
    "eye/src/specificworker.py": (
        "from generated.genericworker import GenericWorker\n\n\n"
        "class SpecificWorker(GenericWorker):\n    def Eye_look(self):\n        return 7\n"
    ),
}
NETWORK = """\
deployment: Talk
hosts: {{onboard: {{address: {onboard}, listen: [address, wifi]}}, head: {{address: {head}}}, arm: {{address: {arm}}}}}
components:
  near: {{component: eye, host: onboard, ports: {{Eye: 10001}}}}
  far: {{component: eye, host: head, ports: {{Eye: 10002}}, listen: [address, eth0, wifi]}}
"""


@pytest.fixture
def talk(tmp_path: Path) -> Iterator[Deployment]:
    pytest.importorskip("IceGrid", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    with three_hosts() as hosts:
        hosts.need_a_network("so no interfaces of their own")
        talk = Deployment(hosts, tmp_path, {"XDG_STATE_HOME": f"{tmp_path}/own"})
        write_tree(tmp_path, {**DOCUMENTS, "talk.ddsl.yaml": NETWORK.format(**hosts.addresses)})
        try:
            for number, host in enumerate(("onboard", "head"), 1):
                ip(talk, host, "link add wifi type bridge")
                ip(talk, host, "link set wifi up")
                ip(talk, host, f"address add 10.98.{number}.1/24 dev wifi")
            talk.rcyaml("compile")
            talk.deploy("up", code=1)
            talk.start_node("head")
            yield talk
        finally:
            talk.clean_up()


def ip(talk: Deployment, host: str, words: str) -> None:
    done = talk.hosts.run(host, ["ip", *words.split()])
    assert done.returncode == 0, done.stderr


def listens(talk: Deployment, host: str, port: int) -> set[str]:
    rows = [line.split()[3] for line in talk.hosts.run(host, ["ss", "-Hltn"]).stdout.splitlines()]
    return {row.rpartition(":")[0] for row in rows if row.endswith(f":{port}")}


def test_on_several_hosts(talk: Deployment) -> None:
    """Here and on another host; an interface whose address is the host's own is not used twice."""
    talk.deploy("up")
    assert listens(talk, "onboard", 10001) == {"10.99.0.1", "10.98.1.1"}
    assert listens(talk, "head", 10002) == {"10.99.0.2", "10.98.2.1"}
    assert "returns: 7" in talk.rcyaml("call", "far.look") + talk.rcyaml("call", "near.look")
    assert "nothing to do" in talk.deploy("plan")

    # After a change of its address, the next start uses the new one.
    ip(talk, "head", "address flush dev wifi")
    before = talk.pids()["far"]
    os.kill(before, 9)
    until(lambda: "has no address: waiting until it has" in talk.logs("far"), lambda: talk.logs("far"))
    ip(talk, "head", "address add 10.98.2.9/24 dev wifi")
    until(lambda: listens(talk, "head", 10002) == {"10.99.0.2", "10.98.2.9"}, lambda: talk.logs("far"))

    # On this host, it is in the configuration, which the next `up` changes.
    ip(talk, "onboard", "address flush dev wifi")
    assert "'near' cannot listen on 'wifi' of this machine: that interface has no address" in talk.deploy(
        "plan", code=1
    )
    ip(talk, "onboard", "address add 10.98.1.7/24 dev wifi")
    assert "10.98.1.7" in talk.deploy("plan")


def test_what_another_host_does_not_have(talk: Deployment) -> None:
    document = talk.root / "talk.ddsl.yaml"
    text = document.read_text()
    unknown = "'far' cannot listen on 'wlan7' of the host 'head': neither an interface nor an address"
    unknowable = "others cannot know the address of that interface: write `listen: [address, wifi]`"
    for listen, said in (("[address, wlan7]", (unknown, "eth0, lo, wifi")), ("[wifi]", (unknowable,))):
        document.write_text(text.replace("[address, eth0, wifi]", listen))
        output = talk.deploy("up", code=1)
        assert "RC7051" in output and all(words in output for words in said)
    ip(talk, "head", "address flush dev wifi")
    document.write_text(text)
    assert "that interface has no address: is it connected?" in talk.deploy("up", code=1)
    assert talk.pids() == {"near": 0, "far": 0}


def test_on_one_machine(tmp_path: Path, free_port: Ports) -> None:
    """A process that listens only on an interface: others of the deployment, and the commands, call it there."""
    own = next((name for name in known() if name != "lo" and re.fullmatch("[0-9.]+", address_of(name))), "")
    if not own:
        pytest.skip("this machine has no interface with an address besides lo")
    port, environment = free_port(), {**os.environ, "XDG_STATE_HOME": str(tmp_path / "own")}
    write_tree(tmp_path, {
        **DOCUMENTS, "one.ddsl.yaml": (
            "deployment: One\ncomponents:\n"
            f"  eye: {{component: eye, listen: {own}, ports: {{Eye: {port}}}}}\n  user: {{component: user}}\n"
        ),
    })  # fmt: skip

    def rcyaml(*words: str) -> str:
        done = subprocess.run(
            [sys.executable, "-m", "robocomp_yaml", *words],
            cwd=tmp_path,
            env=environment,
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    rcyaml("compile")
    try:
        rcyaml("deploy", "up")
        rows = subprocess.run(["ss", "-Hltn"], capture_output=True, text=True, check=True).stdout
        assert [row.split()[3] for row in rows.splitlines() if f":{port} " in row] == [f"{address_of(own)}:{port}"]
        assert "returns: 7" in rcyaml("call", "eye.look")
    finally:
        rcyaml("deploy", "down")


def test_addresses_instead_of_interfaces() -> None:
    changes = {("wlan0", 100): "10.0.0.5", ("lo", 0): "127.0.0.1"}
    assert with_address("tcp -h 10.0.0.2 -p 100:tcp -h wlan0 -p 100", changes) == (
        "tcp -h 10.0.0.2 -p 100:tcp -h 10.0.0.5 -p 100"
    )
    assert with_address("ssl -h wlan0 -p 100:ssl -h 10.0.0.5 -p 100", changes) == "ssl -h 10.0.0.5 -p 100"
    assert with_address("tcp -h 10.0.0.5 -p 100:tcp -h wlan0 -p 100", changes) == "tcp -h 10.0.0.5 -p 100"
    assert with_address("eye:tcp -h wlan0 -p 1000", changes) == "eye:tcp -h wlan0 -p 1000"
    assert with_address("tcp -h wlan01 -p 100", changes) == "tcp -h wlan01 -p 100"
