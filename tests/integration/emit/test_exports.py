"""Exports of networks, each read by its tool or by a similar one."""

from __future__ import annotations

import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from msgspec.structs import replace
from ruamel.yaml import YAML

from conftest import write_tree
from networks import large, speaking
from rcmanager_facts import facts
from robocomp_yaml.emit.exports import export, forms, noted
from robocomp_yaml.emit.exports.icegrid import _DROP_LAST, _MAKE_FOLDERS
from robocomp_yaml.model.deployment import ResourceLimits
from robocomp_yaml.network.network import LOOPBACK, PROGRAM, Network, NetworkHost, Process

Golden = Callable[[str, Mapping[str, str]], None]
ODD = ("a b", ";", "$HOME", "${x}", "100%", '"', "'", "\\", "\\n", "*", "", "&&", "ñ", "--", "%i", "#")


def one(*arguments: str, program: str = "/bin/true", **more: Any) -> Network:
    """A network of one program."""
    network = Network("One", "/one.ddsl.yaml", "/f", {LOOPBACK: NetworkHost(LOOPBACK)})
    network.processes["p"] = Process("p", LOOPBACK, (program, *arguments), "/", PROGRAM, is_ice=False, **more)
    return network


@pytest.mark.parametrize("form", forms())
def test_golden(golden: Golden, form: str) -> None:
    golden(f"exports/{form}", export(speaking(), form))


def test_the_forms() -> None:
    assert forms() == ["compose", "icegrid", "rcmanager", "systemd"]
    with pytest.raises(ValueError, match="unknown form 'helm'"):
        export(speaking(), "helm")


@pytest.mark.parametrize("form", forms())
def test_many_processes(form: str) -> None:
    assert len("".join(export(large(200), form).values())) > 200


def test_the_argument_that_a_node_appends_is_removed() -> None:
    """As IceGrid starts it: the words of the descriptor, then an option."""
    descriptor = ElementTree.fromstring(export(one(*ODD, program="printf"), "icegrid")["One.xml"])
    server = descriptor.find(".//server")
    assert server is not None and server.get("exe") == "/bin/sh"
    words = [(option.text or "").replace("$${", "${") for option in server.findall("option")]
    assert words[:4] == ["-c", _DROP_LAST, "p", "printf"]
    words[3:4] = ["printf", "%s\\n"]
    done = subprocess.run(["/bin/sh", *words, "--Ice.Config=/x"], capture_output=True, text=True, check=True)
    assert done.stdout.split("\n")[:-1] == list(ODD)


def test_folders_are_created_before_a_server_starts(tmp_path: Path) -> None:
    folders = [str(tmp_path / "a b" / "c"), str(tmp_path / "d")]
    done = subprocess.run(["/bin/sh", "-c", _MAKE_FOLDERS, "name", *folders, "--", "echo", "x y", "--z"],
                          capture_output=True, text=True, check=True)  # fmt: skip
    assert done.stdout == "x y --z\n" and all(Path(folder).is_dir() for folder in folders)


def test_a_unit_keeps_every_word() -> None:
    unit = export(one(*ODD), "systemd")["One-p.service"]
    found = re.search("^ExecStart=(.*)$", unit, re.MULTILINE)
    assert found is not None
    assert [unescaped(word) for word in systemd_words(found[1])] == ["/bin/true", *ODD]


def systemd_words(line: str) -> list[str]:
    """The words of a command, as systemd splits it: all are in quotes, except a single semicolon."""
    return [found[0] for found in re.finditer(r'"(?:[^"\\]|\\.)*"|\\;', line)]


def unescaped(word: str) -> str:
    if word == r"\;":
        return ";"
    plain = re.sub(r"\\(.)", lambda found: {"n": "\n", "t": "\t", "r": "\r"}.get(found[1], found[1]), word[1:-1])
    return plain.replace("$$", "$").replace("%%", "%")


@pytest.mark.skipif(shutil.which("systemd-analyze") is None, reason="systemd-analyze is not installed")
@pytest.mark.parametrize("network", [speaking(), one(*ODD)], ids=["head", "odd"])
def test_systemd_accepts_the_units(tmp_path: Path, network: Network) -> None:
    processes = {name: replace(process, command=("/bin/true", *process.command[1:]))
                 for name, process in network.processes.items()}  # fmt: skip
    network = replace(network, processes=processes)
    write_tree(tmp_path, export(network, "systemd"))
    for target in tmp_path.rglob("*.target"):
        units = [str(path) for path in target.parent.iterdir() if path.suffix in (".service", ".target")]
        done = subprocess.run(["systemd-analyze", "verify", *units], capture_output=True, text=True)
        about = [line for line in done.stderr.splitlines() if str(tmp_path) in line or target.stem in line]
        assert not about, done.stderr


def test_compose() -> None:
    files = export(speaking(), "compose")
    documents = {path: YAML(typ="safe", pure=True).load(text) for path, text in files.items() if path.endswith(".yaml")}
    assert list(documents) == ["onboard/compose.yaml", "head/compose.yaml"]
    laser = documents["onboard/compose.yaml"]["services"]["laser"]
    assert laser["command"] == ["a b;c", ";", "$$HOME", "100%", 'say "hi"', "back\\slash"]
    assert laser["environment"] == {"DISPLAY": ":0", "TOKEN": "${ROBOT_TOKEN}"}
    assert laser["restart"] == "no"
    head = documents["head/compose.yaml"]["services"]
    assert head["mouth"]["depends_on"] == {"motors": {"condition": "service_healthy"}}  # storm is on another host
    assert head["viewer"]["profiles"] == ["disabled"] and "volumes" not in head["viewer"]
    assert files["head/config/mouth"] == speaking().processes["mouth"].config.text  # type: ignore[union-attr]


LIMITS = ResourceLimits(memory=300 << 20, cpu=50, cores="0", nice=7, core=0, files=333)
LIMITED = one(
    "-c", "ulimit -d; ulimit -n; ulimit -c; nice; taskset -cp $$ | sed 's/.*: //'", program="bash", limits=LIMITS
)
ITS_LIMITS = [str(300 << 10), "333", "0", "7", "0"]


def test_compose_carries_limits() -> None:
    service = YAML(typ="safe", pure=True).load(export(LIMITED, "compose")["compose.yaml"])["services"]["p"]
    assert service["deploy"] == {"resources": {"limits": {"cpus": "0.5", "memory": f"{300 << 20}b"}}}
    assert service["cpuset"] == "0" and service["ulimits"] == {"core": 0, "nofile": 333} and "cap_add" not in service
    command = [word.replace("$$", "$") for word in (*service["entrypoint"], *service["command"])]
    assert subprocess.run(command, capture_output=True, text=True, check=True).stdout.split()[-2] == "7"
    urgent = one(limits=ResourceLimits(realtime=40))
    service = YAML(typ="safe", pure=True).load(export(urgent, "compose")["compose.yaml"])["services"]["p"]
    assert service["cap_add"] == ["SYS_NICE"] and service["entrypoint"] == ["chrt"] and "deploy" not in service


def test_commands_carry_limits() -> None:
    """As IceGrid and RCManager start them. What they cannot limit is noted."""
    with noted() as notes:
        server = ElementTree.fromstring(export(LIMITED, "icegrid")["One.xml"]).find(".//server")
        made = element_of(export(LIMITED, "rcmanager")["One.xml"], "upCommand")
    assert server is not None
    words = [server.attrib["exe"], *((option.text or "").replace("$${", "${") for option in server.findall("option"))]
    for command in ([*words, "--Ice.Config=/x"], shlex.split(made)[4:]):
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        assert done.stdout.split() == ITS_LIMITS, command
    assert [str(note) for note in notes] == [
        f"{form} cannot enforce `cpu: 50 %`: systemd and compose can" for form in ("IceGrid", "RCManager")
    ]
    assert {note.name for note in notes} == {"p"}


@pytest.mark.parametrize(
    "network", [speaking(), one(*ODD), large(50), LIMITED], ids=["head", "odd", "large", "limited"]
)
def test_compose_matches_the_specification(tmp_path: Path, network: Network) -> None:
    pytest.importorskip("check_jsonschema", reason="the schema of compose files comes with check-jsonschema")
    write_tree(tmp_path, export(network, "compose"))
    files = sorted(tmp_path.rglob("compose.yaml"))
    judge = [sys.executable, "-m", "check_jsonschema", "--builtin-schema", "vendor.compose-spec"]
    done = subprocess.run([*judge, *files], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    files[0].write_text(files[0].read_text(encoding="utf-8").replace("network_mode:", "net_mode:"), encoding="utf-8")
    assert subprocess.run([*judge, *files], capture_output=True).returncode == 1


def test_a_secret_is_named_but_not_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROBOT_TOKEN", "swordfish")
    for form in forms():
        assert "swordfish" not in "".join(export(speaking(), form).values())


def test_rcmanager() -> None:
    (text,) = export(speaking(), "rcmanager").values()
    nodes, _ = facts(text)
    assert list(nodes) == ["storm", "laser", "base", "motors", "mouth", "speech", "viewer"]
    assert dict(nodes["base"][0])["endpoint"] == "differentialrobot:tcp -h 10.0.0.2 -p 10004"
    command = next(dict(attributes)["command"] for name, attributes in nodes["laser"][1] if name == "upCommand")
    assert shlex.split(command) == ["rcremote", "10.0.0.2", "laser", "/robot/etc sim",
                                    *speaking().processes["laser"].command]  # fmt: skip


def test_kept_commands_are_written_while_they_match() -> None:
    network = one("-f", "100", program="/opt/x")
    kept = {"upCommand": "rcremote localhost t / ./opt/x -f 100", "xpos": "1.50", "dependence": ["gone"]}
    network.processes["p"] = replace(network.processes["p"], extra=tuple(kept.items()))
    nodes, _ = facts(export(network, "rcmanager")["One.xml"])
    elements = {name: dict(attributes) for name, attributes in nodes["p"][1]}
    assert elements["upCommand"] == {"command": kept["upCommand"]}
    assert elements["xpos"] == {"value": "1.50"} and elements["dependence"] == {"alias": "gone"}
    network.processes["p"] = replace(network.processes["p"], command=("/opt/y",))
    nodes, _ = facts(export(network, "rcmanager")["One.xml"])
    elements = {name: dict(attributes) for name, attributes in nodes["p"][1]}
    assert elements["upCommand"] == {"command": "rcremote localhost p / /opt/y"}


def test_rcmanager_stops_only_its_own_process() -> None:
    made = element_of(export(one("600", "(a|b)"), "rcmanager")["One.xml"], "downCommand")
    program, option, pattern = shlex.split(made)
    assert (program, option) == ("pkill", "-f")
    assert re.search(pattern, "/bin/true 600 (a|b)") and re.search(pattern, "sh /bin/true 600 (a|b)")
    assert not re.search(pattern, "/bin/true 600 (a|b)c") and not re.search(pattern, "/bin/true 6")
    configured = export(speaking(), "rcmanager")["Head.xml"]
    assert "config/mouth( |$)" in configured  # and not the process with the configuration mouth2


def element_of(text: str, name: str) -> str:
    found = ElementTree.fromstring(text).find(f".//{name}")
    assert found is not None
    return found.attrib["command"]
