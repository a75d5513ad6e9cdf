"""A C++ component whose servers are absent: waiting, failing, ignoring, and its messages."""

from __future__ import annotations

import signal
import socket
from pathlib import Path

import pytest

from cpp_programs import Program, Programs, needs_cpp
from processes import Ports, Running, Start, until

pytestmark = [pytest.mark.slow, needs_cpp]


@pytest.fixture
def client(programs: Programs) -> Program:
    """Waits for Arm, and for Late at most half a second; fails without Arm2; ignores Hand."""
    return programs("Client")


@pytest.fixture
def served(programs: Programs, start: Start, free_port: Ports, tmp_path: Path) -> str:
    """A running Arm."""
    endpoint, other = (f"tcp -h 127.0.0.1 -p {free_port()}" for _ in range(2))
    start(programs("Server").command(tmp_path, {"Arm.Endpoints": endpoint, "Hand.Endpoints": other}))
    return f"arm:{endpoint}"


@pytest.fixture
def nobody(free_port: Ports) -> str:
    return f"arm:tcp -h 127.0.0.1 -p {free_port()}"


def proxies(address: str, **others: str) -> dict[str, str]:
    """Proxies of the client to one address, except for `proxies`."""
    return {f"{name}Proxy": others.get(name, address) for name in ("Arm", "Arm2", "Hand", "Late")}


def last_line(running: Running) -> str:
    return running.output.splitlines()[-1].partition(" ")[2]


def test_it_waits_and_reports_it(
    client: Program, programs: Programs, start: Start, nobody: str, free_port: Ports, tmp_path: Path
) -> None:
    server = programs("Server")
    waiting = start(client.command(tmp_path, proxies(nobody)))
    waiting.wait_for(f"INFO Client: waiting for Arm at {nobody} ... (connection refused)\n")
    until(lambda: waiting.output.count("waiting for") > 1, "a second line after 5 s")
    assert waiting.process.poll() is None
    properties = {"Arm.Endpoints": nobody.partition(":")[2], "Hand.Endpoints": f"tcp -p {free_port()}"}
    start(server.command(tmp_path, properties))
    waiting.wait_for("Client is running")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_the_wait(client: Program, start: Start, nobody: str, tmp_path: Path, number: int) -> None:
    waiting = start(client.command(tmp_path, proxies(nobody))).wait_for("waiting for Arm")
    assert waiting.stop(number) == 0
    assert len(waiting.output.splitlines()) == 1


def test_a_signal_ends_the_wait_for_a_silent_host(client: Program, start: Start, tmp_path: Path) -> None:
    """A server that accepts the connection and never answers."""
    with socket.create_server(("127.0.0.1", 0)) as silent:
        address = f"arm:tcp -h 127.0.0.1 -p {silent.getsockname()[1]}"
        waiting = start(client.command(tmp_path, proxies(address))).wait_for("(no answer in time)")
        assert waiting.stop() == 0
        assert "ERROR" not in waiting.output


def test_it_waits_no_longer_than_its_timeout(
    client: Program, start: Start, served: str, nobody: str, tmp_path: Path
) -> None:
    waiting = start(client.command(tmp_path, proxies(served, Late=nobody)))
    assert waiting.exit_code() == 1
    expected = f"ERROR Client: Late at {nobody} did not answer within 0.5 s (connection refused)"
    assert last_line(waiting) == expected


def test_it_fails_at_once(client: Program, start: Start, served: str, nobody: str, tmp_path: Path) -> None:
    failing = start(client.command(tmp_path, proxies(served, Arm2=nobody)))
    assert failing.exit_code() == 1
    assert last_line(failing) == f"ERROR Client: Arm2 at {nobody} does not answer (connection refused)"


def test_it_does_not_mind(client: Program, start: Start, served: str, nobody: str, tmp_path: Path) -> None:
    """The wait for other proxies does not block it either; a call then fails with an exception of Ice."""
    running = start(client.command(tmp_path, proxies(served, Hand=nobody))).wait_for("Client is running")
    assert "nobody grasps\n" in running.output


@pytest.mark.parametrize(
    ("address", "why"),
    [
        ("hand:{endpoint}", "the process answers, but has no such object"),
        ("arm:tcp -h no-such-host.invalid -p 1", "host no-such-host.invalid is unknown"),
        ("arm", "it has no endpoint, and no locator is configured"),
    ],
)
def test_why_it_is_absent(client: Program, start: Start, served: str, tmp_path: Path, address: str, why: str) -> None:
    text = address.format(endpoint=served.partition(":")[2])
    failing = start(client.command(tmp_path, proxies(served, Arm2=text)))
    assert failing.exit_code() == 1
    assert last_line(failing) == f"ERROR Client: Arm2 at {text} does not answer ({why})"
