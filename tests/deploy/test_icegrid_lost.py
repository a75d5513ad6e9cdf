"""A network on three hosts that is never lost: `down` while a host does not answer, without its folder, and no keys."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from processes import hanging, until
from robocomp_yaml.deploy.local import procfs
from seen import NEEDS_ICEGRID
from three_hosts import Deployment, talking

pytestmark = [
    pytest.mark.slow,
    NEEDS_ICEGRID,
]

NETWORK = """\
deployment: Talk
hosts: {{onboard: {{address: {onboard}}}, head: {{address: {head}}}, arm: {{address: {arm}}}}}
components:
  watch: {{program: sleep, args: ["600"], host: onboard}}
  blink: {{program: sleep, args: ["600"], host: head}}
  pan: {{program: sh, args: [-c, "test -s {{config}} && exec sleep 600"], config: pan.conf, host: arm}}
"""


@pytest.fixture
def talk(tmp_path: Path) -> Iterator[Deployment]:
    with talking(tmp_path, NETWORK, {"pan.conf": "password=hunter2\n"}) as deployment:
        yield deployment


def marked(talk: Deployment) -> set[str]:
    """The commands of all processes of the deployment, without arguments."""
    return {procfs.command(pid)[0] for pid in procfs.marked(talk.folder)}


def containing(folder: Path, secret: bytes) -> list[Path]:
    return [path for path in folder.rglob("*") if path.is_file() and secret in path.read_bytes()]


def test_down_while_a_host_does_not_answer(talk: Deployment) -> None:
    """It is named, and is ended as soon as it is back; then the registry ends, too."""
    talk.hosts.need_a_network("so no cable to pull")
    pan = talk.status()["pan"]["pid"]
    talk.hosts.link("arm", "down")
    try:
        until(lambda: talk.status()["pan"]["state"] == "lost", "the host does not answer")
        said = talk.deploy("down", code=1)
        assert "the host 'arm'" in said and "'pan' there is ended as soon as it does" in said
        assert talk.copies("pan") == 1 and talk.copies("blink") == 0
        assert "ending: arm" in talk.rcyaml("deploy", "ls")
    finally:
        talk.hosts.link("arm", "up")
    until(lambda: procfs.entry(pan) is None, lambda: str(marked(talk)))
    until(lambda: "no deployment" in talk.rcyaml("deploy", "ls"), lambda: talk.rcyaml("deploy", "ls"))
    until(lambda: "icegridregistry" not in marked(talk), lambda: str(marked(talk)))


def test_an_up_after_such_a_down_adopts_the_host(talk: Deployment) -> None:
    talk.hosts.need_a_network("so no cable to pull")
    talk.hosts.link("arm", "down")
    try:
        until(lambda: talk.status()["pan"]["state"] == "lost", "the host does not answer")
        talk.deploy("down", code=1)
    finally:
        talk.hosts.link("arm", "up")
    talk.deploy("up")
    until(lambda: talk.copies("pan") == 1, lambda: str(talk.copies("pan")))
    talk.until_ready()
    assert "running" in talk.rcyaml("deploy", "ls")
    talk.deploy("down")


def test_a_node_that_hangs(talk: Deployment) -> None:
    """It counts as a host that does not answer: its processes go on, and `down` ends them as soon as it does."""
    talk.hosts.need_a_network("so a node of this machine, which `down` kills")
    pan = talk.status()["pan"]["pid"]
    (node,) = [
        pid for pid in procfs.marked(talk.folder)
        if procfs.command(pid)[0] == "icegridnode" and "/nodes/arm/" in procfs.command_line(pid)
    ]  # fmt: skip
    with hanging(node):
        until(lambda: talk.status()["pan"]["state"] == "lost", "its node does not answer")
        said = talk.deploy("down", code=1)
        assert "the host 'arm'" in said and "'pan' there is ended as soon as it does" in said
        assert procfs.entry(pan) is not None and talk.copies("blink") == 0
    until(lambda: procfs.entry(pan) is None, lambda: str(marked(talk)))
    until(lambda: "no deployment" in talk.rcyaml("deploy", "ls"), lambda: talk.rcyaml("deploy", "ls"))


def test_without_its_folder(talk: Deployment) -> None:
    before = talk.pids()
    shutil.rmtree(f"{talk.root}/.rcyaml")
    (talk.root / "talk.ddsl.yaml").unlink()
    assert "running" in talk.rcyaml("deploy", "ls")
    said = talk.rcyaml("deploy", "status", "Talk", code=None)
    assert all(f"{name} " in said for name in before) and said.count("running") == 3 + said.count("are used")
    talk.rcyaml("deploy", "down", "Talk")
    assert [talk.copies(name) for name in before] == [0, 0, 0]
    until(lambda: "icegridregistry" not in marked(talk), lambda: str(marked(talk)))
    assert "no deployment" in talk.rcyaml("deploy", "ls")


def test_after_down_no_configuration_is_left(talk: Deployment) -> None:
    assert containing(talk.root / ".rcyaml", b"hunter2") and containing(talk.root / ".rcyaml", b"PRIVATE KEY")
    talk.deploy("down")
    assert not containing(talk.root / ".rcyaml", b"hunter2")
    if not talk.hosts.prefix:  # no node that was started by hand needs the key
        assert not containing(talk.root / ".rcyaml", b"PRIVATE KEY")
    assert not list((talk.root / "own" / "rcyaml" / "deployments").iterdir())
    talk.deploy("up")
    talk.until_ready()


def test_what_another_host_lacks_is_told_before_anything_starts(talk: Deployment) -> None:
    talk.hosts.need_a_network("so no other host")
    before = talk.pids()
    document = talk.root / "talk.ddsl.yaml"
    text = document.read_text()
    lacking = (
        "  a: {program: no-such-program, host: head}\n"
        "  b: {program: /no/such/file, host: head}\n"
        "  c: {program: sleep, args: [1], cwd: gone, host: arm}\n"
        "  d: {program: sleep, args: [600], host: arm}\n"
    )
    document.write_text(text + lacking)
    assert f" {talk.folder}, registry 10.99.0.1:" in (talk.state / "nodes" / "arm" / "owner").read_text()
    said = talk.deploy("up", code=1)
    assert said.count("error[RC7002]") == 3 and "nothing was changed" in said
    assert "PATH contains no program 'no-such-program'" in said and "on the host 'head'" in said
    assert "the file '/no/such/file' is missing" in said and f"its folder '{talk.root}/gone' does not exist" in said
    assert talk.pids() == {**before, **dict.fromkeys("abcd", 0)}
    document.write_text(text.replace("blink: {program: sleep", "blink: {program: no-such-program"))
    assert "error[RC7002]" in talk.deploy("plan", code=1)
    document.write_text(text)
    status = talk.status()
    assert all(status[name]["memory"] > 0 and status[name]["cpu"] is not None for name in before)
    assert "unknown" not in talk.deploy("status")


def test_a_process_that_moves_leaves_no_configuration_behind(talk: Deployment) -> None:
    """With a folder of its own on each host, which the namespaces here share, the file on the old host is removed."""
    talk.hosts.need_a_network("so no other host")
    config = Path(talk.folder, "config", "pan")
    assert config.read_text() == "password=hunter2\n"
    document = talk.root / "talk.ddsl.yaml"
    document.write_text(document.read_text().replace(", config: pan.conf, host: arm", ", config: pan.conf, host: head"))
    talk.deploy("up")
    assert talk.until_ready()["pan"]["host"] == "head" and config.read_text() == "password=hunter2\n"
    document.write_text("".join(line for line in document.read_text().splitlines(True) if "pan:" not in line))
    talk.deploy("up")
    assert not config.exists()
