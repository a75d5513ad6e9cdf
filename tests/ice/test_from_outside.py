"""The clients of docs/from-outside.md, as the page has them, against the lamp of docs/talking.md."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from components import Build, Built
from conftest import ROOT, write_tree
from cpp_programs import needs_cpp
from java_programs import needs_java
from processes import Ports, Start

PAGE = (ROOT / "docs" / "from-outside.md").read_text()
LAMP = (ROOT / "docs" / "talking.md").read_text()
FILES = dict(re.findall(r"<!-- file: (\S+) -->\n```\w+\n(.*?)^```$", LAMP, re.MULTILINE | re.DOTALL))
CLIENTS = dict(re.findall(r"<!-- client: (\S+) -->\n```\w+\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL))
BUILDS = dict(re.findall(r"<!-- build: (\S+) -->\n```sh\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL))


@pytest.fixture
def proxy(build: Build, start: Start, free_port: Ports, tmp_path: Path) -> str:
    """The proxy of a lamp, and the clients with the Slice in the test's folder."""
    cdsl = FILES["lamp/lamp.cdsl.yaml"].replace("publishes: [Lit]\n", "")
    built: Built = build({"Lamp.idsl.yaml": FILES["Lamp.idsl.yaml"], "lamp/lamp.cdsl.yaml": cdsl, "lamp/lamp.pdsl.yaml": FILES["lamp/lamp.pdsl.yaml"]})["LampComp"]  # fmt: skip
    code = FILES["lamp/src/specificworker.py"].replace("self.lit_proxy.now(self.light)", "pass")
    (built.root / "src" / "specificworker.py").write_text(code)
    port = free_port()
    start(built.configure({"Lamp.Endpoints": f"tcp -p {port}"}).command).wait_for("LampComp is running")
    shutil.copytree(built.root / "slice", tmp_path / "slice")
    write_tree(tmp_path, CLIENTS)
    return f"lamp:tcp -h localhost -p {port}"


def printed(script: str, proxy: str, folder: Path) -> str:
    script = script.replace("lamp:tcp -h localhost -p 10810", proxy)
    done = subprocess.run(["bash", "-ec", script], cwd=folder, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_each_is_ten_lines() -> None:
    assert CLIENTS.keys() == {"client.py", "client.cpp", "Client.java"}
    for text in CLIENTS.values():
        assert len([line for line in text.splitlines() if line.strip()]) <= 10


def test_python(proxy: str, tmp_path: Path) -> None:
    assert printed(f"'{sys.executable}' client.py '{proxy}'", proxy, tmp_path) == "10.0\n"


@needs_cpp
@pytest.mark.slow
def test_cpp(proxy: str, tmp_path: Path) -> None:
    assert printed(BUILDS["cpp"], proxy, tmp_path) == "10\n"


@needs_java
@pytest.mark.slow
def test_java(proxy: str, tmp_path: Path) -> None:
    assert printed(BUILDS["java"], proxy, tmp_path) == "10.0\n"
