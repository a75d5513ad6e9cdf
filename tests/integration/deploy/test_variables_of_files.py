"""`{file: PATH}` as an environment variable: read on the host of the process, when it starts, by every engine."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from ruamel.yaml import YAML

from robocomp_yaml.deploy.local.program import LONGEST
from robocomp_yaml.deploy.local.program import variables as from_files
from robocomp_yaml.emit.exports import Unwritable, export, noted
from robocomp_yaml.network.network import LOOPBACK, PROGRAM, EnvironmentVariable, Network, NetworkHost, Process

SHOWN = "import os; print(ascii(os.fsencode(os.environ['TOKEN'])), os.environ.get('OTHER'))"
ENDS = [(b"a b\n", b"a b"), (b"a\r\n", b"a"), (b"\n\n", b"\n"), (b"", b""), (b"a\r", b"a\r"), (b"$x `y` %s \\n '\"", None),
        (b"a\r\n\r\n", b"a\r\n"), (b"\xc3\xa9\xff\n", b"\xc3\xa9\xff"), (b".", b"."), (b"a\n.\n", b"a\n.")]  # fmt: skip


def network_of(path: str, **more: Any) -> Network:
    network = Network("One", "/one.ddsl.yaml", "/f", {LOOPBACK: NetworkHost(LOOPBACK)})
    env = (EnvironmentVariable("TOKEN", file=path), EnvironmentVariable("OTHER", "plain"))
    network.processes["p"] = Process(
        "p", LOOPBACK, (sys.executable, "-c", SHOWN), "/", PROGRAM, env=env, is_ice=False, **more
    )  # fmt: skip
    return network


def of_systemd(network: Network) -> list[str]:
    line = re.search("^ExecStart=(.*)$", export(network, "systemd")["One-p.service"], re.MULTILINE)
    assert line
    words = [found[0][1:-1] for found in re.finditer(r'"(?:[^"\\]|\\.)*"', line[1])]
    return [re.sub(r"\\(.)", r"\1", word).replace("$$", "$").replace("%%", "%") for word in words]


def of_compose(network: Network) -> list[str]:
    service = YAML(typ="safe", pure=True).load(export(network, "compose")["compose.yaml"])["services"]["p"]
    mount = service["volumes"][-1]
    assert mount["source"].replace("$$", "$") == network.processes["p"].env[0].file
    assert mount["read_only"] is True and mount["bind"] == {"create_host_path": False}
    return [word.replace("$$", "$") for word in (*service["entrypoint"], *service["command"])]


def of_icegrid(network: Network) -> list[str]:
    server = ElementTree.fromstring(export(network, "icegrid")["One.xml"]).find(".//server")
    assert server is not None
    assert [one.text for one in server.findall("env")] == ["OTHER=plain"]
    options = [(option.text or "").replace("$${", "${") for option in server.findall("option")]
    return [server.get("exe", ""), *options, "--Ice.Config=/x"]


FORMS: dict[str, Callable[[Network], list[str]]] = {"systemd": of_systemd, "compose": of_compose, "icegrid": of_icegrid}


@pytest.mark.parametrize("form", FORMS)
def test_an_export_reads_it_when_it_starts(tmp_path: Path, form: str) -> None:
    path = tmp_path / "a token $HOME"
    command = FORMS[form](network_of(str(path)))
    for raw, meant in ENDS:
        path.write_bytes(raw)
        done = subprocess.run(command, capture_output=True, text=True, env={"OTHER": "plain", "PATH": "/usr/bin:/bin"})
        assert done.stdout == f"{raw if meant is None else meant!a} plain\n", (raw, done.stderr)
    for raw in (b"a\0b", None):
        path.write_bytes(raw) if raw else path.unlink()
        done = subprocess.run(command, capture_output=True, text=True, env={"PATH": "/usr/bin:/bin"})
        assert done.returncode == 1 and not done.stdout and f"TOKEN is the text of {path}" in done.stderr


@pytest.mark.parametrize("form", FORMS)
def test_no_export_contains_it(tmp_path: Path, form: str) -> None:
    (tmp_path / "token").write_text("canary\n")
    assert "canary" not in "".join(export(network_of(str(tmp_path / "token")), form).values())


def test_a_form_without_files_of_variables() -> None:
    with pytest.raises(Unwritable, match="no home"):
        export(network_of("~/token"), "compose")
    with noted() as notes:
        export(network_of("/token"), "rcmanager")
    assert [str(one) for one in notes] == ["RCManager sets no variables for its commands: TOKEN, OTHER"]


def test_the_local_engine_reads_it_alike(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "token"
    monkeypatch.setenv("HOME", str(tmp_path))
    for raw, meant in ENDS:
        path.write_bytes(raw)
        read = from_files([("TOKEN", "~/token")])
        assert read["TOKEN"].encode("utf-8", "surrogateescape") == (raw if meant is None else meant)


@pytest.mark.parametrize(
    ("make", "why"),
    [
        (lambda path: None, "cannot be read: no such file"), (lambda path: path.mkdir(), "not a regular file"),
        (lambda path: path.write_bytes(b"a\0"), "a NUL"), (lambda path: path.write_bytes(b"a" * LONGEST), "longer"),
        (lambda path: path.symlink_to("/dev/zero"), "not a regular file"),
    ],
)  # fmt: skip
def test_an_unreadable_file_is_reported(tmp_path: Path, make: Callable[[Path], Any], why: str) -> None:
    make(tmp_path / "token")
    with pytest.raises(OSError, match=f"TOKEN is the text of .*token, which .*{why}"):
        from_files([("TOKEN", str(tmp_path / "token"))])


DDSL = "deployment: Robot\ncomponents:\n  a: {program: /bin/true, env: {TOKEN: VALUE}}\n"


@pytest.mark.parametrize(
    ("value", "place", "told"),
    [
        ("{file: secrets/token}", "", ""), ("{file: '~/a b'}", "", ""), ("{env: X, x-why: y}", "", ""),
        ("{file: a, env: X}", "3:40", "has one source"), ("{file: secrets/}", "3:47", "the path of a file"),
        ('{file: "a\\nb"}', "3:47", "one line"), ("{path: a}", "3:41", "{env: NAME} or {file: PATH}"),
        ("{}", "3:40", "{env: NAME} or {file: PATH}"), ("{file: [a]}", "3:47", "file"),
    ],
)  # fmt: skip
def test_documents(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, rcyaml: Callable[..., Any], value: str, place: str, told: str
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("robot.ddsl.yaml").write_text(DDSL.replace("VALUE", value))
    result = rcyaml("check")
    assert result.exit_code == bool(told), result.output
    assert told in result.output and (not place or f"robot.ddsl.yaml:{place}" in result.output), result.output


def test_paths_are_relative_to_the_document_that_contains_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, rcyaml: Callable[..., Any]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("arm").mkdir()
    Path("arm/arm.ddsl.yaml").write_text(
        "deployment: Arm\ncomponents:\n"
        "  a{i}: {program: /bin/true, instances: 2, env: {T: {file: '../sec/t{i}'}, U: {file: ~/u}}}\n"
    )
    Path("robot.ddsl.yaml").write_text("deployment: Robot\ninclude: {left: arm/arm.ddsl.yaml}\n")
    text = rcyaml("deploy", "export", "robot.ddsl.yaml", "--as", "systemd").stdout
    for number in (0, 1):
        assert f'"T" "{tmp_path}/sec/t{number}" "U" "~/u" "--" "/bin/true"' in text
