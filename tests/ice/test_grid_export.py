"""The application that is exported for IceGrid, on a real registry with a node: it is taken, and its programs run."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from networks import speaking
from processes import Ports, Start, until
from robocomp_yaml.emit.exports import export
from robocomp_yaml.network.network import (
    CONFIG,
    LOOPBACK,
    PROGRAM,
    ConfigFile,
    EnvironmentVariable,
    Network,
    NetworkHost,
    Process,
)

pytestmark = pytest.mark.skipif(
    not (shutil.which("icegridnode") and shutil.which("icegridadmin")),
    reason="IceGrid is not installed (Debian: zeroc-icegrid, zeroc-ice-utils)",
)
ODD = ("a b", ";", "$HOME", "${x}", "100%", 'say "hi"', "back\\slash", "", "=", "--end")
TITLE = 'a "title" of $HOME, ${x}, 1$, $$ and \\$y'
SCRIPT = """import json, os, sys, time
with open("told.new", "w") as file:
    json.dump([sys.argv[1:], [os.environ[name] for name in ("TITLE", "NONE", "FROM")], os.getcwd()], file)
os.rename("told.new", "told")
time.sleep(600)
"""


Admin = Callable[[str], "subprocess.CompletedProcess[str]"]


@pytest.fixture
def admin(start: Start, free_port: Ports, tmp_path: Path) -> Admin:
    """`admin(COMMAND)` of icegridadmin, at a node with a registry in it."""
    port = free_port()
    for name in ("registry", "node"):
        (tmp_path / name).mkdir()
    settings = {
        "Ice.Default.Locator": f"Grid/Locator:tcp -h 127.0.0.1 -p {port}", "IceGrid.InstanceName": "Grid",
        "IceGrid.Registry.Client.Endpoints": f"tcp -h 127.0.0.1 -p {port}",
        "IceGrid.Registry.Server.Endpoints": "tcp -h 127.0.0.1",
        "IceGrid.Registry.Internal.Endpoints": "tcp -h 127.0.0.1",
        "IceGrid.Registry.AdminPermissionsVerifier": "Grid/NullPermissionsVerifier",
        "IceGrid.Registry.LMDB.Path": str(tmp_path / "registry"), "IceGrid.Registry.LMDB.MapSize": "10",
        "IceGrid.Node.Name": LOOPBACK, "IceGrid.Node.Endpoints": "tcp -h 127.0.0.1",
        "IceGrid.Node.Data": str(tmp_path / "node"), "IceGrid.Node.CollocateRegistry": "1",
    }  # fmt: skip
    (tmp_path / "grid.cfg").write_text("".join(f"{key}={value}\n" for key, value in settings.items()), encoding="utf-8")
    start(["icegridnode", f"--Ice.Config={tmp_path / 'grid.cfg'}"])
    locator = f"--Ice.Default.Locator={settings['Ice.Default.Locator']}"

    def run(command: str) -> subprocess.CompletedProcess[str]:
        words = ["icegridadmin", locator, "-u", "x", "-p", "x", "-e", command]
        return subprocess.run(words, capture_output=True, text=True)

    until(lambda: f"{LOOPBACK}\n" in run("node list").stdout, "the node to be there")
    return run


@pytest.fixture
def open_folder() -> Iterator[Path]:
    """A folder where everybody may write: a node that root runs starts servers as nobody."""
    with tempfile.TemporaryDirectory() as folder:
        os.chmod(folder, 0o777)
        yield Path(folder)


def test_a_program_runs_with_its_own_words(admin: Admin, tmp_path: Path, open_folder: Path) -> None:
    network = Network("Small", "/small.ddsl.yaml", str(tmp_path), {LOOPBACK: NetworkHost(LOOPBACK)})
    network.processes["echo"] = Process(
        "echo", LOOPBACK, ("python3", "-c", SCRIPT, *ODD), str(open_folder), PROGRAM, is_ice=False,
        env=(EnvironmentVariable("TITLE", TITLE), EnvironmentVariable("NONE"), EnvironmentVariable("FROM", source="PATH")),
    )  # fmt: skip
    (tmp_path / "small.xml").write_text(export(network, "icegrid")["Small.xml"], encoding="utf-8")
    assert admin(f"application add {tmp_path / 'small.xml'}").stderr == ""
    until(lambda: (open_folder / "told").exists(), lambda: admin("server state echo").stdout)
    told = json.loads((open_folder / "told").read_text(encoding="utf-8"))
    assert told == [list(ODD), [TITLE, "", os.environ["PATH"]], str(open_folder)]
    assert admin("application remove Small").stderr == ""


def test_a_program_reads_a_configuration_of_its_own(admin: Admin, tmp_path: Path, open_folder: Path) -> None:
    text = "a = \"b\" # no property\n${x} $HOME 100% \\ 'c'\n" * 200
    script = SCRIPT.replace("sys.argv[1:]", "[open(word.rpartition('=')[2]).read() for word in sys.argv[1:]]")
    script = script.replace('[os.environ[name] for name in ("TITLE", "NONE", "FROM")]', "len(sys.argv)")
    network = Network("Small", "/small.ddsl.yaml", str(tmp_path), {LOOPBACK: NetworkHost(LOOPBACK)})
    network.processes["read"] = Process(
        "read", LOOPBACK, ("python3", "-c", script, CONFIG, f"--file={CONFIG}"), str(open_folder), PROGRAM,
        config=ConfigFile("config/read", text),
    )  # fmt: skip
    (tmp_path / "small.xml").write_text(export(network, "icegrid")["Small.xml"], encoding="utf-8")
    assert admin(f"application add {tmp_path / 'small.xml'}").stderr == ""
    until(lambda: (open_folder / "told").exists(), lambda: admin("server state read").stdout)
    assert json.loads((open_folder / "told").read_text(encoding="utf-8")) == [[text, text], 3, str(open_folder)]


def test_everything_is_accepted(admin: Admin, tmp_path: Path) -> None:
    (tmp_path / "head.xml").write_text(export(speaking(), "icegrid")["Head.xml"], encoding="utf-8")
    added = admin(f"application add {tmp_path / 'head.xml'}")
    assert added.returncode == 0 and not added.stderr, added.stderr
    assert set(admin("server list").stdout.split()) == {"storm", "laser", "motors", "mouth", "speech", "viewer"}
