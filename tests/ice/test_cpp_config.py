"""The config of a C++ component: its location, its two spellings, and its errors in one line."""

from __future__ import annotations

import shutil
import socket
import subprocess
from pathlib import Path
from typing import Any

import pytest

from cpp_programs import Program, Programs, needs_cpp
from processes import Ports, Start, answers

pytestmark = [pytest.mark.slow, needs_cpp]


@pytest.fixture
def server(programs: Programs) -> Program:
    return programs("Server")


@pytest.fixture
def endpoints(free_port: Ports) -> dict[str, str]:
    return {f"{name}.Endpoints": f"tcp -h 127.0.0.1 -p {free_port()}" for name in ("Arm", "Hand")}


def fails(start: Start, program: Program, folder: Path, *arguments: str) -> str:
    """The only line of output before the component ends, without the time."""
    running = start([program.path, *arguments], cwd=folder)
    assert running.exit_code() == 1, running.output
    (line,) = running.output.splitlines()
    return line.partition(f"ERROR {program.name}: ")[2]


def write(folder: Path, text: str | bytes) -> None:
    (folder / "my.config").write_bytes(text if isinstance(text, bytes) else text.encode())


def test_toml_dialect(server: Program, start: Start, free_port: Ports, ice: Any, tmp_path: Path) -> None:
    """Keys in the other spelling, values in double quotes."""
    arm = free_port()
    properties = {
        "Endpoints.Arm": f'"tcp -h 127.0.0.1 -p {arm}"',
        "Endpoints.Hand": f'"tcp -h 127.0.0.1 -p {free_port()}"',
        "Period.Compute": "20",
        "Ice.Warn.Connections": '"0"',
    }
    start(server.command(tmp_path, properties)).wait_for("Server is running")
    assert answers(ice, f"arm:tcp -h 127.0.0.1 -p {arm}")


def test_tables_of_toml(server: Program, start: Start, free_port: Ports, ice: Any, tmp_path: Path) -> None:
    """`etc/config.toml` is read if there is no `etc/config`; without both, the others are listed."""
    arm, copy = free_port(), Program("Server", tmp_path / "copy")
    for folder in ("bin", "etc"):
        (copy.root / folder).mkdir(parents=True)
    shutil.copy(server.path, copy.path)
    (copy.root / "etc/config_real").write_text("")
    (copy.root / "etc/config_real.config.yaml").write_text("")
    told = "No such file or directory; name one that exists: etc/config_real"
    assert fails(start, copy, copy.root) == f"cannot read the config file etc/config: {told}"
    (copy.root / "etc/config.toml").write_text(
        f"[Endpoints]\nArm = 'tcp -h 127.0.0.1 -p {arm}' # of the arm\nHand = \"tcp -h 127.0.0.1 -p {free_port()}\"\n"
        '[Ice]\nTrace.Network = "1"\n'
    )
    running = start([copy.path]).wait_for("Server is running")
    assert answers(ice, f"arm:tcp -h 127.0.0.1 -p {arm}") and "INFO Ice: Network: " in running.output


def test_the_command_line_wins(
    server: Program, start: Start, endpoints: dict[str, str], free_port: Ports, ice: Any, tmp_path: Path
) -> None:
    port = free_port()
    command = server.command(tmp_path, {**endpoints, "Ice.Trace.Network": "0"})
    running = start([*command, f"--Arm.Endpoints=tcp -h 127.0.0.1 -p {port}", "--Ice.Trace.Network=1"])
    running.wait_for("Server is running")
    assert answers(ice, f"arm:tcp -h 127.0.0.1 -p {port}")
    assert "INFO Ice: Network: " in running.output, "Ice speaks through the component's log"


def test_ice_config_names_the_file(server: Program, start: Start, endpoints: dict[str, str], tmp_path: Path) -> None:
    _, config = server.command(tmp_path, endpoints)
    start([server.path, f"--Ice.Config={Path(config).name}"], cwd=tmp_path).wait_for("Server is running")


def test_the_current_folder_does_not_matter(
    server: Program, start: Start, endpoints: dict[str, str], tmp_path: Path
) -> None:
    """The default config is the component's own, also if the program is started through a link."""
    copy = Program("Server", tmp_path / "copy")
    (copy.root / "bin").mkdir(parents=True)
    shutil.copy(server.path, copy.path)
    (copy.root / "etc").mkdir()
    shutil.move(str(server.command(tmp_path, endpoints)[1]), copy.root / "etc" / "config")
    (tmp_path / "link").symlink_to(copy.path)
    start([tmp_path / "link"], cwd=Path("/")).wait_for("Server is running")


def test_parameters_that_begin_like_an_adapter(
    server: Program, start: Start, endpoints: dict[str, str], tmp_path: Path
) -> None:
    properties = {**endpoints, "Arm.Device": "/dev/ttyUSB0", "Server.x": "1"}
    running = start(server.command(tmp_path, properties)).wait_for("Server is running")
    assert "WARNING" not in running.output


def test_no_config(server: Program, start: Start, tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    for name, why in (("x.cfg", "No such file or directory"), ("folder", "Is a directory")):
        assert fails(start, server, tmp_path, name) == f"cannot read the config file {name}: {why}"


def test_the_oldest_name_of_an_endpoint(
    server: Program, start: Start, free_port: Ports, ice: Any, tmp_path: Path
) -> None:
    arm, hand = free_port(), free_port()
    write(tmp_path, f"ArmComp.Endpoints = tcp -h 127.0.0.1 -p {arm}\nHandComp.Endpoints=tcp -h 127.0.0.1 -p {hand}\n")
    start([server.path, "my.config"], cwd=tmp_path).wait_for("Server is running")
    assert answers(ice, f"arm:tcp -h 127.0.0.1 -p {arm}")


def test_a_missing_endpoint(server: Program, start: Start, tmp_path: Path) -> None:
    write(tmp_path, 'Arm.Endpoints = ""\n')
    message = "the endpoint of Arm is not configured: set Arm.Endpoints or Endpoints.Arm in my.config"
    assert fails(start, server, tmp_path, "my.config") == message


def test_a_missing_proxy(programs: Programs, start: Start, tmp_path: Path) -> None:
    write(tmp_path, "Other = 1\n")
    message = "the proxy to Arm is not configured: set ArmProxy or Proxies.Arm in my.config"
    assert fails(start, programs("Client"), tmp_path, "my.config") == message


def test_no_topic_manager(programs: Programs, start: Start, tmp_path: Path) -> None:
    write(tmp_path, "Other = 1\n")
    message = "IceStorm's topic manager is not configured: set TopicManager.Proxy or Proxies.TopicManager in my.config"
    assert fails(start, programs("Radio"), tmp_path, "my.config") == message


@pytest.mark.parametrize("wrong", ["tcp -p", "nonsense", "tcp -p seventy", "tcp -h 192.0.2.1 -p 1"])
def test_a_wrong_endpoint(server: Program, start: Start, tmp_path: Path, wrong: str) -> None:
    write(tmp_path, f"Arm.Endpoints = {wrong}\n")
    assert fails(start, server, tmp_path, "my.config").startswith(f"cannot serve Arm at '{wrong}' (my.config): ")


def test_a_port_in_use(server: Program, start: Start, tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        endpoint = f"tcp -h 127.0.0.1 -p {other.getsockname()[1]}"
        write(tmp_path, f"Arm.Endpoints = {endpoint}\n")
        message = f"cannot serve Arm at '{endpoint}' (my.config): Address already in use"
        assert fails(start, server, tmp_path, "my.config") == message


@pytest.mark.parametrize("wrong", ["arm:tcp -p x", ":tcp -p 1", '"'])
def test_a_wrong_proxy(programs: Programs, start: Start, tmp_path: Path, wrong: str) -> None:
    write(tmp_path, f"ArmProxy = {wrong}\n")
    message = f"the proxy to Arm is '{wrong}' in my.config, which is not a proxy ("
    assert fails(start, programs("Client"), tmp_path, "my.config").startswith(message)


@pytest.mark.parametrize("wrong", ["soon", "0", "-3", "1.5", "99999999999"])
def test_a_wrong_period(server: Program, start: Start, tmp_path: Path, wrong: str) -> None:
    write(tmp_path, f"period.compute = {wrong}\n")
    said = {
        "0": "is 0 ms, and must be at least 1 ms",
        "-3": "is -3 ms, and must be at least 1 ms",
        "99999999999": "is 99999999999 ms, and must be from -2147483648 to 2147483647 (int)",
    }.get(wrong, f"must be a whole number (ms), and is '{wrong}'")
    assert fails(start, server, tmp_path, "my.config") == f"my.config: period.compute {said}"


def test_bytes_that_are_no_text(server: Program, start: Start, endpoints: dict[str, str], tmp_path: Path) -> None:
    """Such bytes are allowed in comments; so are a BOM and CRLF."""
    write(tmp_path, b"# \xe1rbol\nArm.Endpoints = tcp -p \xff\xfe\n")
    assert fails(start, server, tmp_path, "my.config") == "my.config:2: this line is not UTF-8"
    lines = [f"{key} = {value}".encode() for key, value in endpoints.items()]
    write(tmp_path, b"\xef\xbb\xbf" + b"\r\n".join([*lines, b"name = \xc3\xb1", b"# \xe1rbol", b""]))
    start([server.path, "my.config"], cwd=tmp_path).wait_for("Server is running")


def test_wrong_usage(server: Program, start: Start) -> None:
    for arguments, said in ((["a", "b"], "expected one CONFIG, got 2: a b"), (["-x"], "unknown option -x")):
        running = start([server.path, *arguments])
        assert running.exit_code() == 2
        assert running.output.startswith(f"Server: {said}\n\nusage: bin/Server [CONFIG]")


def test_help(server: Program) -> None:
    for option in ("-h", "--help"):
        done = subprocess.run([server.path, option], capture_output=True, text=True)
        assert done.returncode == 0 and done.stdout.startswith("usage: bin/Server [CONFIG]") and not done.stderr
