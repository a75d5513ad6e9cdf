"""Who may control a component: with and without the token, from its own host and from another one, in every language."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import control_client
from components import build
from conftest import ROOT
from cpp_programs import FAST, cmake, locked, needs_cpp
from java_programs import java_build, needs_java
from processes import Ports, Start
from robocomp_yaml.deploy.authority import Authority, properties
from three_hosts import Hosts, three_hosts

LANGUAGES = [
    pytest.param("python", id="python"),
    pytest.param("cpp", id="cpp", marks=[pytest.mark.slow, needs_cpp]),
    pytest.param("java", id="java", marks=[pytest.mark.slow, needs_java]),
]
CONTROLS = ("setPeriod", "setParameterList", "reloadConfig", "killYourSelf")
READS = ("getPeriod", "timeAwake", "getParameterList", "getState")
TOKEN = "5c1e7f"
SLICE = ROOT / "templates" / "slice" / "CommonBehavior.ice"
Root = Callable[[str], Path]


@pytest.fixture(scope="session")
def root(tmp_path_factory: pytest.TempPathFactory) -> Root:
    """The folder of a component in a language, built by the first test that needs it."""
    base = tmp_path_factory.getbasetemp()
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "controlled"

    def built(language: str) -> Path:
        folder.mkdir(exist_ok=True)
        with locked(folder / f"{language}.lock"):
            component = folder / language
            if not component.is_dir():
                build({"c.cdsl.yaml": f"component: Tame\nlanguage: {language}\nperiod: 50 ms\n"}, component)
                if language == "cpp":
                    cmake(component, *FAST)
                elif language == "java":
                    java_build(component)
        return component

    return built


class Tame:
    """The component in one language, with a configuration of its own."""

    def __init__(self, root: Path, folder: Path, port: int, host: str, properties: dict[str, str]) -> None:
        self.config = folder / "tame.config"
        own = {"CommonBehavior.Endpoints": f"tcp -h {host} -p {port}", "api.key": "hidden", **properties}
        self.config.write_text("".join(f"{key} = {value}\n" for key, value in own.items()))
        self.proxy = f"commonbehavior:tcp -h {host} -p {port}"
        self.command = [root / "bin" / "Tame", self.config]

    def call(self, operation: str, *more: str, hosts: Hosts | None = None, host: str = "") -> str:
        command = [sys.executable, control_client.__file__, str(SLICE), self.proxy, operation, *more]
        if hosts is not None:
            return hosts.run(host, command).stdout.strip()
        return subprocess.run(command, capture_output=True, text=True, check=False, timeout=60).stdout.strip()


@pytest.mark.parametrize("language", LANGUAGES)
def test_with_a_token(language: str, root: Root, tmp_path: Path, start: Start, free_port: Ports) -> None:
    """Without the right token, nothing changes, and the answer says what to do; what reads is open."""
    tame = Tame(root(language), tmp_path, free_port(), "127.0.0.1", {"RcYaml.Token": TOKEN})
    running = start(tame.command).wait_for("Tame is running")
    for operation in CONTROLS:
        for wrong in ("", "5c1e7e", TOKEN + "0", TOKEN[:-1], "ü"):
            answer = tame.call(operation, wrong)
            assert answer.startswith(f"rejected (see the log of the component) {operation} rejected: "), answer
            assert "token of its deployment" in answer and "control: open" in answer
    assert tame.call("getPeriod") == "ok 50"
    for operation in READS:
        assert tame.call(operation).startswith("ok"), operation
    assert tame.call("setPeriod", TOKEN) == "ok NoneType"
    assert tame.call("getPeriod") == "ok 70"
    assert tame.call("setParameterList", TOKEN) == "ok NoneType"
    assert tame.call("reloadConfig", TOKEN) == "ok NoneType"
    assert tame.call("killYourSelf", TOKEN) == "ok NoneType"
    assert running.exit_code() == 0
    assert TOKEN not in running.output
    assert running.output.count("rejected: ") <= 6, "a line in some seconds, not for each call"


@pytest.mark.parametrize("language", LANGUAGES)
def test_outside_of_a_deployment(
    language: str, root: Root, tmp_path: Path, start: Start, free_port: Ports
) -> None:  # fmt: skip
    tame = Tame(root(language), tmp_path, free_port(), "127.0.0.1", {})
    running = start(tame.command).wait_for("Tame is running")
    assert tame.call("setPeriod") == "ok NoneType"
    assert tame.call("setPeriod", "a token of something else") == "ok NoneType"
    assert tame.call("killYourSelf") == "ok NoneType"
    assert running.exit_code() == 0


@pytest.mark.slow
@pytest.mark.parametrize("language", LANGUAGES[:2])
def test_over_tls(
    language: str, root: Root, hosts: Hosts, tmp_path: Path, free_port: Ports, monkeypatch: pytest.MonkeyPatch
) -> None:
    """From another host: nothing without a certificate; with one, the token decides."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    address, port = hosts.addresses["onboard"], free_port()
    authority = Authority(str(tmp_path))
    authority.make({"onboard": [address], "client": []})
    secured = {**properties(authority.path("onboard")), "RcYaml.Token": TOKEN}
    tame = Tame(root(language), tmp_path, port, address, secured)
    tame.config.write_text(tame.config.read_text().replace("tcp -h", "ssl -h"))
    tame.proxy = tame.proxy.replace(":tcp", ":ssl")
    certificate = [f"{key}={value}" for key, value in properties(authority.path("client")).items()]
    without = ["Ice.Plugin.IceSSL=IceSSL:createIceSSL", "IceSSL.VerifyPeer=0"]
    process = hosts.begin("onboard", [str(word) for word in tame.command], stderr=subprocess.DEVNULL)
    try:
        for _ in range(100):
            if tame.call("getState", "", *certificate, hosts=hosts, host="head").startswith("ok"):
                break
        for operation in CONTROLS:
            assert tame.call(operation, TOKEN, *without, hosts=hosts, host="head").startswith("failed")
            answer = tame.call(operation, "", *certificate, hosts=hosts, host="head")
            assert answer.startswith("rejected") and "token of its deployment" in answer
            assert tame.call(operation, TOKEN, *certificate, hosts=hosts, host="head") == "ok NoneType"
        assert process.wait(10) == 0
    finally:
        process.kill()
        process.communicate()


@pytest.fixture
def hosts() -> Iterator[Hosts]:
    with three_hosts() as found:
        found.need_a_network("so that a call comes from another host")
        yield found


@pytest.mark.slow
@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("listening", ["own address", "all addresses"])
def test_from_another_host(
    language: str, listening: str, root: Root, hosts: Hosts, tmp_path: Path, free_port: Ports
) -> None:  # fmt: skip
    """With and without a token: the right one does not help over plain TCP. From the own host, over its own address, it
    does."""
    address, port = hosts.addresses["onboard"], free_port()
    for own, says in (
        ({"RcYaml.Token": TOKEN}, "needs TLS"),
        ({}, "outside of a deployment"),
        ({"RcYaml.Control": "open", "RcYaml.Token": TOKEN}, ""),
    ):
        if listening == "all addresses":
            own = {**own, "CommonBehavior.Endpoints": f"tcp -p {port}"}
        tame = Tame(root(language), tmp_path, port, address, own)
        process = hosts.begin("onboard", [str(word) for word in tame.command], stderr=subprocess.DEVNULL)
        try:
            for _ in range(100):
                if tame.call("getState", hosts=hosts, host="head").startswith("ok"):
                    break
            for operation in CONTROLS[:-1]:
                answer = tame.call(operation, TOKEN, hosts=hosts, host="head")
                if not says:
                    assert answer == "ok NoneType"
                    continue
                assert answer.startswith("rejected") and says in answer, answer
                assert hosts.addresses["head"] in answer
                assert tame.call(operation, TOKEN, hosts=hosts, host="onboard") == "ok NoneType"
        finally:
            process.kill()
            process.communicate()
