"""A migrated network of RCManager: `deploy up` starts it in order, with the same commands."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from conftest import write_tree
from processes import Ports
from robocomp_yaml.cli import group
from small_networks import Place

SERVER = """import json, os, socket, sys, time
name, port, *words = sys.argv[1:]
if words[:1] == ["after"]:
    socket.create_connection(("127.0.0.1", int(words[1]))).close()
with open(f"{name}.told", "w") as file:
    json.dump([sys.argv[1:], os.getcwd()], file)
server = socket.create_server(("127.0.0.1", int(port)))
time.sleep(600)
"""


def rcyaml(*words: str) -> Result:
    result = CliRunner().invoke(group, list(words), prog_name="rcyaml")
    assert result.exit_code == 0, result.output
    return result


@pytest.fixture
def manager(place: Place, free_port: Ports) -> Path:
    """Two programs in Python. The first one in the file depends on the second."""
    folder = place.root
    base, js = free_port(), free_port()
    python = sys.executable
    node = ('<node alias="{0}" endpoint="{0}:tcp -h localhost -p {1}">{2}'
            '<upCommand command="rcremote localhost {0} {3} {4} server.py {0} {1}{5}"/></node>\n')  # fmt: skip
    return write_tree(folder, {
        "server.py": SERVER,
        "Robot.xml": "<rcmanager>\n"
        + node.format("js", js, '<dependence alias="base"/>', folder, python, f" after {base} 'a b'")
        + node.format("base", base, "", folder, python, "") + "</rcmanager>\n",
    })  # fmt: skip


def test_it_runs(manager: Path) -> None:
    rcyaml("migrate", str(manager / "Robot.xml"))
    document = str(manager / "Robot.ddsl.yaml")
    try:
        rcyaml("deploy", "up", document, "--format", "json")
        told = json.loads((manager / "js.told").read_text(encoding="utf-8"))
        assert told[0][2:] == ["after", json.loads((manager / "base.told").read_text(encoding="utf-8"))[0][1], "a b"]
        assert told[1] == os.path.realpath(manager)
        assert rcyaml("deploy", "status", document).output.count("ready") == 2
    finally:
        rcyaml("deploy", "down", document)
