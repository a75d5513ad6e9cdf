"""A network on three hosts, run by IceGrid: components call each other, and each part of the network is killed once."""

from __future__ import annotations

import json
import os
import re
import signal
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from processes import until
from robocomp_yaml.deploy.local import procfs
from seen import NEEDS_ICEGRID
from three_hosts import Deployment, talking_head

pytestmark = [
    pytest.mark.slow,
    NEEDS_ICEGRID,
]

WORDS = "module: RoboCompWords\ntopics:\n  Words: {methods: {word: {in: {number: int}}}}\n"
TELLER = """\
from generated.genericworker import GenericWorker


class SpecificWorker(GenericWorker):
    def initialize(self):
        self.number = 0

    def compute(self):
        self.number += 1
        self.words_proxy.word(self.number)
"""
HEARER = """\
import os

from generated.genericworker import GenericWorker


class SpecificWorker(GenericWorker):
    def initialize(self):
        self.log.info("was told %r", os.environ["GREETING"])

    def compute(self):
        pass

    def Words_word(self, number):
        self.log.info("heard word %d", number)
"""
NETWORK = """\
deployment: Talk
hosts:
  onboard: {{address: {onboard}}}
  head: {{address: {head}}}
  arm: {{address: {arm}}}
services:
  storm: {{icestorm: {{host: onboard}}}}
components:
  mouth: {{component: talkinghead/components/mouth, host: arm, ready: 20 s}}
  speech: {{component: talkinghead/components/speech, host: head, ready: 20 s}}
  hearer: {{component: words/hearer, host: arm, ready: 20 s, env: {{GREETING: {{file: words/greeting}}}}}}
  teller: {{component: words/teller, host: head, after: [hearer], ready: 20 s}}
"""


@pytest.fixture(scope="module")
def talk(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Deployment]:
    """The running network on three hosts. Two of the nodes were started by hand if necessary."""
    pytest.importorskip("IceGrid", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    words = {
        "words/rcyaml.yaml": "interfaces: [interfaces/]\n",
        "words/interfaces/Words.idsl.yaml": WORDS,
        **{
            f"words/{name}/{name}.cdsl.yaml": (
                f"component: {name.title()}\nlanguage: python\nimports: [Words]\n{key}: [Words]\nperiod: 20 ms\n"
            )
            for name, key in (("teller", "publishes"), ("hearer", "subscribes"))
        },
        "words/greeting": "good $morning\n",
        "words/teller/src/specificworker.py": TELLER,
        "words/hearer/src/specificworker.py": HEARER,
    }
    with talking_head(tmp_path_factory.mktemp("talk"), NETWORK, _start_by_hand, words) as deployment:
        yield deployment


def _start_by_hand(deployment: Deployment) -> None:
    """Without SSH, `up` has a hint for each node, and starts nothing else."""
    said = deployment.deploy("up", code=1)
    assert "error[RC7021]" in said and "'head'" in said
    assert re.search(r"ssh 10\.99\.0\.2 bash -s < \S*hosts/head\.sh", said)
    assert not any((deployment.state / "status").glob("*"))
    for host in ("head", "arm"):
        deployment.start_node(host)


@pytest.fixture(autouse=True)
def ready(talk: Deployment) -> dict[str, int]:
    """The pids at the start of a test, when all processes are ready."""
    return {name: one["pid"] for name, one in talk.until_ready().items()}


def test_components_on_different_hosts_call_each_other(talk: Deployment, ready: dict[str, int]) -> None:
    until(lambda: "says 'Shelly' with the mouth" in talk.logs("speech"), lambda: talk.logs())
    assert {name: one["host"] for name, one in talk.status().items()} == {
        "storm": "onboard", "mouth": "arm", "speech": "head", "hearer": "arm", "teller": "head",
    }  # fmt: skip
    if talk.hosts.prefix:
        networks = {name: os.readlink(f"/proc/{pid}/ns/net") for name, pid in ready.items()}
        assert networks["mouth"] == networks["hearer"] != networks["speech"] == networks["teller"] != networks["storm"]


def test_a_topic_crosses_hosts(talk: Deployment) -> None:
    def heard() -> list[int]:
        return [int(number) for number in re.findall(r"heard word (\d+)", talk.logs("hearer"))]

    first = until(heard, lambda: talk.logs())[-1]
    until(lambda: heard()[-1] > first, lambda: talk.logs())


def test_a_variable_comes_from_a_file_of_its_host(talk: Deployment) -> None:
    assert "was told 'good $morning'" in talk.logs("hearer")
    kept = [path for path in talk.state.rglob("*") if path.is_file() and path.suffix != ".log"]
    assert kept and not [path for path in kept if b"$morning" in path.read_bytes()]


def test_a_second_up_changes_nothing(talk: Deployment, ready: dict[str, int]) -> None:
    assert "nothing to do" in talk.deploy("up")
    assert talk.pids() == ready


def test_the_second_start_of_a_node_changes_no_running_script(talk: Deployment, ready: dict[str, int]) -> None:
    """Bash reads a script while it runs: a new version of the script is another file."""
    if not talk.hosts.prefix:
        pytest.skip("nodes of this machine are not started by hand")
    script = talk.state / "nodes" / "arm" / "run"
    before = script.stat().st_ino
    talk.start_node("arm")
    assert script.stat().st_ino != before and script.stat().st_mode & 0o777 == 0o700
    assert talk.pids() == ready


def test_a_killed_component_is_restarted(talk: Deployment, ready: dict[str, int]) -> None:
    before = talk.status()["mouth"]["restarts"]
    os.kill(ready["mouth"], signal.SIGKILL)
    until(lambda: talk.pids()["mouth"] not in (0, ready["mouth"]), lambda: talk.logs())
    now = talk.until_ready()
    assert now["mouth"]["restarts"] == before + 1
    assert {name: one["pid"] for name, one in now.items() if name != "mouth"} == _without(ready, "mouth")
    assert "ended by itself: SIGKILL; restarting" in talk.logs("mouth")
    assert talk.copies("mouth") == 1


def test_a_killed_icestorm_is_restarted_with_its_subscribers(talk: Deployment, ready: dict[str, int]) -> None:
    os.kill(ready["storm"], signal.SIGKILL)
    until(lambda: talk.pids()["storm"] not in (0, ready["storm"]), lambda: talk.logs())
    now = talk.until_ready()
    assert {name: one["pid"] for name, one in now.items() if name != "storm"} == _without(ready, "storm")
    test_a_topic_crosses_hosts(talk)


def test_a_killed_runner_ends_its_component_and_both_are_restarted(talk: Deployment, ready: dict[str, int]) -> None:
    runner = int((talk.state / "status" / "speech").read_text().split("|")[1])
    os.kill(runner, signal.SIGKILL)
    until(lambda: talk.pids()["speech"] not in (0, ready["speech"]), lambda: talk.logs())
    assert talk.copies("speech") == 1
    assert _without(talk.pids(), "speech") == _without(ready, "speech")


def test_a_lost_host_is_reported_and_comes_back(talk: Deployment, ready: dict[str, int]) -> None:
    """Its processes end with its node, and each runs once when the host is back."""
    talk.kill_daemon("nodes/arm", for_good=True)
    until(lambda: talk.copies("mouth") == 0 == talk.copies("hearer"), "the processes of a dead node end")
    status = talk.status()
    assert {name for name, one in status.items() if one["state"] == "lost"} == {"mouth", "hearer"}
    assert "lost" in talk.deploy("status", code=1)
    talk.start_node("arm")
    pids = {name: one["pid"] for name, one in talk.until_ready().items()}
    assert _without(pids, "mouth", "hearer") == _without(ready, "mouth", "hearer")
    assert talk.copies("mouth") == 1 == talk.copies("hearer")


def test_a_killed_node_is_restarted_on_its_host(talk: Deployment, ready: dict[str, int]) -> None:
    talk.kill_daemon("nodes/head", for_good=False)
    until(lambda: talk.pids()["teller"] not in (0, ready["teller"]), lambda: talk.logs())
    talk.until_ready()
    assert talk.copies("teller") == 1 == talk.copies("speech")


def test_a_host_without_a_connection_works_on(talk: Deployment, ready: dict[str, int]) -> None:
    """Its state is unknown until it is back. Then its processes are unchanged, and each runs once."""
    talk.hosts.need_a_network("so no cable to pull")
    talk.hosts.link("arm", "down")
    try:
        until(lambda: talk.status()["hearer"]["state"] == "lost", "the host does not answer")
        assert talk.copies("hearer") == 1
    finally:
        talk.hosts.link("arm", "up")
    assert {name: one["pid"] for name, one in talk.until_ready().items()} == ready


@pytest.mark.parametrize("for_good", [False, True], ids=["restarted by its guard", "with its guard"])
def test_without_the_registry_all_processes_go_on(talk: Deployment, ready: dict[str, int], for_good: bool) -> None:
    """A component that is killed in the meantime is restarted by its own host."""
    talk.kill_daemon("registry", for_good=for_good)
    os.kill(ready["mouth"], signal.SIGKILL)

    def mouth() -> int:
        return int((talk.state / "status" / "mouth").read_text().split("|")[2])

    until(lambda: mouth() not in (0, ready["mouth"]), lambda: talk.logs())
    pids = {name: one["pid"] for name, one in talk.until_ready().items()}
    assert _without(pids, "mouth") == _without(ready, "mouth")
    assert talk.copies("mouth") == 1


def test_a_halted_component_is_restarted_without_the_registry(talk: Deployment, ready: dict[str, int]) -> None:
    """Its own host asks it."""
    talk.kill_daemon("registry", for_good=True)
    os.kill(ready["mouth"], signal.SIGSTOP)

    def told() -> list[str]:
        return (talk.state / "status" / "mouth").read_text().splitlines()[0].split("|")

    until(lambda: int(told()[2]) not in (0, ready["mouth"]), lambda: "|".join(told()))
    assert told()[6].strip() == "not alive: it does not answer"
    pids = {name: one["pid"] for name, one in talk.until_ready().items()}
    assert _without(pids, "mouth") == _without(ready, "mouth")
    assert talk.copies("mouth") == 1
    assert "rcyaml: not alive: it does not answer" in talk.logs("mouth")


def test_a_killed_watch_is_started_again_and_works(talk: Deployment, ready: dict[str, int]) -> None:
    script = str(talk.state / "nodes" / talk.status()["mouth"]["host"] / "watch")

    def watches() -> list[int]:
        return [pid for pid in procfs.pids() if procfs.command(pid)[:2] == ["perl", script]]

    (old,) = watches()
    os.kill(old, signal.SIGKILL)
    until(lambda: len(watches()) == 1 and watches() != [old], "the guard starts it again")
    time.sleep(5)  # one that has not answered yet may be starting: it is given the time to start
    test_a_halted_component_is_restarted_without_the_registry(talk, ready)


def test_a_killed_keeper_is_restarted_and_works(talk: Deployment, ready: dict[str, int]) -> None:
    def keepers() -> list[int]:
        return [int(path.parent.name) for path in Path("/proc").glob("[0-9]*/cmdline") if _is_keeper(path, talk.folder)]

    (old,) = keepers()
    os.kill(old, signal.SIGKILL)
    until(lambda: len(keepers()) == 1 and keepers() != [old], "IceGrid restarts the keeper")
    test_a_killed_runner_ends_its_component_and_both_are_restarted(talk, ready)


def _is_keeper(path: Path, folder: str) -> bool:
    try:
        words = path.read_bytes().split(b"\0")
    except OSError:
        return False
    return b"robocomp_yaml.deploy.icegrid.keeper" in words and folder.encode() in words


def test_only_a_changed_component_restarts(talk: Deployment, ready: dict[str, int]) -> None:
    document = talk.root / "talk.ddsl.yaml"
    text = document.read_text()
    document.write_text(text.replace("components/mouth, host: arm", "components/mouth, args: [--N=1], host: arm"))
    talk.deploy("up")
    pids = talk.pids()
    assert pids["mouth"] != ready["mouth"]
    assert pids["hearer"] == ready["hearer"] and pids["storm"] == ready["storm"]
    document.write_text(text)
    talk.deploy("up")


def test_only_the_owner_can_read_the_files(talk: Deployment) -> None:
    for folder, _, files in os.walk(talk.folder):
        for path in (Path(folder), *(Path(folder, name) for name in files)):
            assert path.stat().st_mode & 0o077 == 0, path


def test_without_the_key_no_connection(talk: Deployment) -> None:
    place = json.loads((talk.state / "registry.json").read_text())
    said = talk.hosts.run("arm", [
        "icegridadmin", f"--Ice.Default.Locator=rcyaml/Locator:ssl -h {place['address']} -p {place['port']}",
        "--Ice.Plugin.IceSSL=IceSSL:createIceSSL", "--IceSSL.VerifyPeer=0", "-u", "x", "-p", "y", "-e", "node list",
    ])  # fmt: skip
    assert said.returncode != 0 and "head" not in said.stdout


def test_down_leaves_nothing_and_up_starts_again(talk: Deployment) -> None:
    talk.deploy("down")
    assert [name for name in ("mouth", "speech", "teller", "hearer", "storm") if talk.copies(name)] == []
    talk.deploy("up")
    assert all(one["restarts"] == 0 for one in talk.until_ready().values())


def _without(pids: dict[str, int], *names: str) -> dict[str, int]:
    return {name: pid for name, pid in pids.items() if name not in names}
