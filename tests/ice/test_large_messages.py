"""A message of 2 MB arrives, with a configuration that says nothing about its size: run times set Ice's limit."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from components import Build
from conftest import ROOT
from cpp_programs import Programs, needs_cpp
from java_programs import needs_java
from processes import Ports, Start
from robocomp_yaml.semantics.connections import ICE_DEFAULTS
from scenario import INTERFACES, cdsl
from test_cpp_calls import Addresses
from test_java import Program, built, program  # noqa: F401 - fixtures
from test_python_calls import SERVER

LARGE = """
from generated.genericworker import GenericWorker

class SpecificWorker(GenericWorker):
    def initialize(self):
        answer = self.hand_proxy.grasp(bytes(2_000_000) + b"end")
        print("large", len(answer), answer[:3])
"""


def told(build: Build, addresses: Addresses, start: Start) -> str:
    """What a Python component says that calls the server."""
    documents = {**INTERFACES, "big/big.cdsl.yaml": cdsl("Big", requires=["Hand"])}
    client = build(documents)["Big"]
    (client.root / "src" / "specificworker.py").write_text(LARGE)
    proxies = {"HandProxy": addresses.proxies["HandProxy"]}
    return start(client.configure(proxies).command).wait_for("Big is running").output


@pytest.fixture
def addresses(free_port: Ports) -> Addresses:
    return Addresses(free_port)


def test_python(build: Build, addresses: Addresses, start: Start) -> None:
    server = build({**INTERFACES, "server/server.cdsl.yaml": cdsl("Server", implements=["Arm", "Hand"])})["Server"]
    (server.root / "src" / "specificworker.py").write_text(SERVER)
    start(server.configure(addresses.endpoints).command).wait_for("Server is running")
    assert "large 2000003 b'dne'" in told(build, addresses, start)


@pytest.mark.slow
@needs_cpp
def test_cpp(programs: Programs, build: Build, addresses: Addresses, start: Start, tmp_path: Path) -> None:
    start(programs("Server").command(tmp_path, addresses.endpoints)).wait_for("Server is running")
    assert "large 2000003 b'dne'" in told(build, addresses, start)


@pytest.mark.slow
@needs_java
def test_java(program: Program, build: Build, addresses: Addresses, start: Start) -> None:  # noqa: F811
    start(program("Server", addresses.endpoints)).wait_for("Server is running")
    assert "large 2000003 b'dne'" in told(build, addresses, start)


@pytest.mark.parametrize("path", ["cpp/templates/runtime/application.cpp", "java/templates/runtime/Application.java"])
def test_all_run_times_have_the_same_defaults(path: str) -> None:
    text = (ROOT / "robocomp_yaml/languages" / path).read_text(encoding="utf-8")
    assert dict(re.findall(r'\{?"([\w.]+)", "(\d+)"', text)) == ICE_DEFAULTS
