"""The config of a Python component: its location, its two spellings, and its errors in one line."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from components import Build, Built
from processes import Ports, Start, answers
from scenario import INTERFACES, cdsl


@pytest.fixture
def arm(build: Build) -> Built:
    return build({**INTERFACES, "a/a.cdsl.yaml": cdsl("ArmComp", implements=["Arm"], period=50)})["ArmComp"]


@pytest.fixture
def both(build: Build) -> Built:
    """Implements and requires."""
    return build({**INTERFACES, "b/b.cdsl.yaml": cdsl("Both", implements=["Arm"], requires=["Hand"])})["Both"]


def fails(start: Start, component: Built, *arguments: str, code: int = 1) -> str:
    """The only line of output before the component ends, without the time."""
    running = start([*component.command, *arguments], cwd=component.root)
    assert running.exit_code() == code, running.output
    (line,) = running.output.splitlines()
    return line.partition(f"ERROR {component.name}: ")[2]


def test_toml_dialect(both: Built, start: Start, free_port: Ports, ice: Any) -> None:
    """Keys in the other spelling, values in double quotes."""
    arm = free_port()
    both.configure(
        {
            "Endpoints.Arm": f'"tcp -p {arm}"',
            "Proxies.Hand": f'"arm:tcp -h 127.0.0.1 -p {arm}"',
            "Period.Compute": "20",
            "Ice.Warn.Connections": '"0"',
            "Ice.ThreadPool.Server.Size": '"2"',
        }
    )
    start(both.command).wait_for("Both is running")
    assert answers(ice, f"arm:tcp -h 127.0.0.1 -p {arm}")


TABLES = """\
# The newest generation of RoboComp's tool reads this.
Speed = 2.5   # m/s
[Endpoints]
Arm = "tcp -h 127.0.0.1 -p {}"
[Period]
Compute = 20
[Ice]
Warn.Connections = "0"
Trace.Network = '1'
"""


def test_tables_of_toml(arm: Built, start: Start, free_port: Ports, ice: Any) -> None:
    """`etc/config.toml` is read if there is no `etc/config`."""
    port = free_port()
    (arm.root / "etc").mkdir(exist_ok=True)
    (arm.root / "etc/config").unlink(missing_ok=True)
    (arm.root / "etc/config.toml").write_text(TABLES.format(port))
    running = start(arm.command).wait_for("ArmComp is running")
    assert answers(ice, f"arm:tcp -h 127.0.0.1 -p {port}") and "INFO Ice: Network: " in running.output


def test_a_missing_config_lists_the_others(arm: Built, start: Start) -> None:
    etc = arm.root / "etc"
    etc.mkdir(exist_ok=True)
    (etc / "config").unlink(missing_ok=True)
    for name in ("config_real", "sim.conf", "config_real.config.yaml", "notes.txt", "config.orig"):
        (etc / name).write_text("")
    told = "No such file or directory; name one that exists: etc/config_real, etc/sim.conf"
    assert fails(start, arm) == f"cannot read the config file etc/config: {told}"


def test_the_command_line_wins(arm: Built, start: Start, free_port: Ports, ice: Any) -> None:
    arm.configure({"Arm.Endpoints": "tcp -p 1", "Ice.Trace.Network": "0"})
    port = free_port()
    running = start([*arm.command, f"--Arm.Endpoints=tcp -p {port}", "--Ice.Trace.Network=1"])
    running.wait_for("ArmComp is running")
    assert answers(ice, f"arm:tcp -h 127.0.0.1 -p {port}")
    assert "INFO Ice: Network: " in running.output, "Ice speaks through the component's log"


def test_ice_config_names_the_file(arm: Built, start: Start, free_port: Ports, tmp_path: Path) -> None:
    (tmp_path / "other.cfg").write_text(f"Arm.Endpoints=tcp -p {free_port()}\n")
    start([*arm.command, "--Ice.Config=other.cfg"], cwd=tmp_path).wait_for("ArmComp is running")


def test_parameters_that_begin_like_an_adapter(arm: Built, start: Start, free_port: Ports) -> None:
    arm.configure({"Arm.Endpoints": f"tcp -p {free_port()}", "Arm.Device": "/dev/ttyUSB0", "ArmComp.x": "1"})
    running = start(arm.command).wait_for("ArmComp is running")
    assert "WARNING" not in running.output


def test_no_config(arm: Built, start: Start) -> None:
    assert fails(start, arm) == "cannot read the config file etc/config: No such file or directory"
    assert fails(start, arm, "x.cfg") == "cannot read the config file x.cfg: No such file or directory"
    assert fails(start, arm, "src") == "cannot read the config file src: Is a directory"


def test_the_oldest_name_of_an_endpoint(arm: Built, start: Start, free_port: Ports, ice: Any) -> None:
    """As the first version of RoboComp's tool had it. A newer name wins."""
    old, new = free_port(), free_port()
    arm.configure({"ArmComp.Endpoints": f"tcp -h 127.0.0.1 -p {old}"})
    start(arm.command).wait_for("ArmComp is running")
    assert answers(ice, f"arm:tcp -h 127.0.0.1 -p {old}")
    arm.configure({"ArmComp.Endpoints": "tcp -h 127.0.0.1 -p 1", "Endpoints.Arm": f"tcp -h 127.0.0.1 -p {new}"})
    start(arm.command).wait_for("ArmComp is running")
    assert answers(ice, f"arm:tcp -h 127.0.0.1 -p {new}")


def test_a_missing_endpoint(arm: Built, start: Start) -> None:
    arm.configure({"Other": "1"})
    message = "the endpoint of Arm is not configured: set Arm.Endpoints or Endpoints.Arm in etc/config"
    assert fails(start, arm) == message
    arm.configure({"Arm.Endpoints": '""'})
    assert fails(start, arm) == message


def test_a_missing_proxy(both: Built, start: Start, free_port: Ports) -> None:
    both.configure({"Arm.Endpoints": f"tcp -p {free_port()}"})
    message = "the proxy to Hand is not configured: set HandProxy or Proxies.Hand in etc/config"
    assert fails(start, both) == message


@pytest.mark.parametrize("wrong", ["tcp -p", "nonsense", "tcp -p seventy", "tcp -h 192.0.2.1 -p 1"])
def test_a_wrong_endpoint(arm: Built, start: Start, wrong: str) -> None:
    arm.configure({"Arm.Endpoints": wrong})
    assert fails(start, arm).startswith(f"cannot serve Arm at '{wrong}' (etc/config): ")


def test_a_port_in_use(arm: Built, start: Start) -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        endpoint = f"tcp -h 127.0.0.1 -p {other.getsockname()[1]}"
        arm.configure({"Arm.Endpoints": endpoint})
        assert fails(start, arm) == f"cannot serve Arm at '{endpoint}' (etc/config): Address already in use"
        arm.configure({"CommonBehavior.Endpoints": endpoint})  # which has threads of its own
        assert fails(start, arm) == f"cannot serve CommonBehavior at '{endpoint}' (etc/config): Address already in use"


@pytest.mark.parametrize("wrong", ["hand:tcp -p x", ":tcp -p 1", '"'])
def test_a_wrong_proxy(both: Built, start: Start, free_port: Ports, wrong: str) -> None:
    both.configure({"Arm.Endpoints": f"tcp -p {free_port()}", "HandProxy": wrong})
    assert fails(start, both).startswith(f"the proxy to Hand is '{wrong}' in etc/config, which is not a proxy (")


def test_a_proxy_without_endpoint(both: Built, start: Start, free_port: Ports) -> None:
    both.configure({"Arm.Endpoints": f"tcp -p {free_port()}", "HandProxy": "hand"})
    start(both.command).wait_for("waiting for Hand at hand ... (it has no endpoint, and no locator is configured)")


@pytest.mark.parametrize("wrong", ["soon", "0", "-3", "1.5"])
def test_a_wrong_period(arm: Built, start: Start, wrong: str) -> None:
    arm.configure({"period.compute": wrong})
    if wrong in ("0", "-3"):
        assert fails(start, arm) == f"etc/config: period.compute is {wrong} ms, and must be at least 1 ms"
    else:
        assert fails(start, arm) == f"etc/config: period.compute must be a whole number (ms), and is '{wrong}'"


def test_lines_that_are_no_properties(arm: Built, start: Start, free_port: Ports) -> None:
    """Ice warns and continues; a BOM and CRLF are allowed."""
    arm.configure({})
    text = f"\ufeffArm.Endpoints = tcp -p {free_port()}\r\nno property\r\n# é\r\nname = ñ\r\n"
    (arm.root / "etc" / "config").write_bytes(text.encode())
    running = start(arm.command).wait_for("ArmComp is running")
    assert "Traceback" not in running.output


def test_bytes_that_are_no_text(arm: Built, start: Start, free_port: Ports) -> None:
    """Such bytes are allowed in comments."""
    arm.configure({})
    config = arm.root / "etc" / "config"
    config.write_bytes(b"# \xe1rbol\nArm.Endpoints = tcp -p \xff\xfe\n")
    assert fails(start, arm) == "etc/config:2: this line is not UTF-8"
    config.write_bytes(b"# \xe1rbol\nArm.Endpoints = tcp -p %d # \xe1\n" % free_port())
    start(arm.command).wait_for("ArmComp is running")


def test_wrong_usage(arm: Built, start: Start) -> None:
    for arguments, said in ((["a", "b"], "expected one CONFIG, got 2: a b"), (["-x"], "unknown option -x")):
        running = start([*arm.command, *arguments])
        assert running.exit_code() == 2
        assert running.output.startswith(f"ArmComp: {said}\n\nusage: bin/ArmComp [CONFIG]")


def test_help_needs_no_ice(arm: Built) -> None:
    for option in ("-h", "--help"):
        done = subprocess.run([sys.executable, "-S", arm.command[1], option], capture_output=True, text=True)
        assert done.returncode == 0 and done.stdout.startswith("usage: bin/ArmComp [CONFIG]") and not done.stderr


def test_a_newer_python_in_front(arm: Built, free_port: Ports, tmp_path: Path) -> None:
    """That Python has no Ice: the component runs with the workspace's."""
    arm.configure({"Arm.Endpoints": f"tcp -p {free_port()}"})
    (tmp_path / "front").mkdir()
    front = tmp_path / "front" / "python3"
    front.write_text(f'#!/bin/sh\nexec {sys.executable} -S -I "$@"\n')
    front.chmod(0o755)
    (arm.root / ".venv").symlink_to(sys.prefix)
    environment = {**os.environ, "PATH": f"{front.parent}:{os.environ['PATH']}"}
    program = [arm.command[1], "--startup-check"]
    done = subprocess.run(program, env=environment, capture_output=True, text=True)
    assert done.returncode == 0 and "ArmComp: the startup check has passed" in done.stdout + done.stderr


def test_without_ice(arm: Built) -> None:
    """If the variable is set, no other Python is tried."""
    environment = {**os.environ, "RCYAML_PYTHON": "/no/such/python"}
    done = subprocess.run(arm.command, env=environment, capture_output=True, text=True)
    assert done.returncode == 1 and not done.stdout
    (line,) = done.stderr.splitlines()
    assert line.startswith("ArmComp: RCYAML_PYTHON names /no/such/python, which does not exist: set it to a Python")


def test_a_missing_slice_folder(arm: Built, start: Start) -> None:
    arm.configure({})
    (arm.root / "slice" / "Arm.ice").unlink()
    assert fails(start, arm) == "slice/Arm.ice is missing: compile the component again"


def test_slice_that_ice_rejects(arm: Built, start: Start) -> None:
    arm.configure({})
    (arm.root / "slice" / "Arm.ice").write_text("module M { nonsense }\n")
    running = start(arm.command, cwd=arm.root)
    assert running.exit_code() == 1
    said = "Ice rejects slice/Arm.ice (see above): compile the component again"
    assert running.output.splitlines()[-1].endswith(said)
    assert "Traceback" not in running.output
