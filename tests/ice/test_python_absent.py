"""A Python component whose servers are absent: waiting, failing, ignoring, and its messages."""

from __future__ import annotations

import signal
import socket
from datetime import datetime

import pytest

from components import Build, Built
from processes import Ports, Start, until
from scenario import INTERFACES, cdsl


def client(build: Build, port: int, **keys: object) -> Built:
    """Requires Arm at this port."""
    built = build({**INTERFACES, "c/c.cdsl.yaml": cdsl("Client", requires=[{"Arm": {"interface": "Arm", **keys}}])})
    return built["Client"].configure({"ArmProxy": f"arm:tcp -h 127.0.0.1 -p {port}"})


def test_it_waits_and_reports_it(build: Build, start: Start, free_port: Ports) -> None:
    port = free_port()
    server = build({**INTERFACES, "s/s.cdsl.yaml": cdsl("Server", implements=["Arm"])})["Server"]
    server.configure({"Arm.Endpoints": f"tcp -p {port}"})
    waiting = start(client(build, port).command)
    waiting.wait_for(f"waiting for Arm at arm:tcp -h 127.0.0.1 -p {port} ... (connection refused)\n")
    assert waiting.process.poll() is None
    assert waiting.output.count("waiting for") == 1, "one line at first, the next after 5 s"
    start(server.command)
    waiting.wait_for("Client is running")


def test_it_reminds_every_five_seconds(build: Build, start: Start, free_port: Ports) -> None:
    waiting = start(client(build, free_port()).command).wait_for("waiting for Arm")
    until(lambda: waiting.output.count("waiting for") > 1, "a second line")
    clocks = [line.split()[0] for line in waiting.output.splitlines() if "waiting for" in line]
    first, second = (datetime.strptime(clock, "%H:%M:%S") for clock in clocks)  # noqa: DTZ007 - of one day
    assert 4 <= (second - first).seconds <= 15


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_the_wait(build: Build, start: Start, free_port: Ports, number: int) -> None:
    waiting = start(client(build, free_port()).command).wait_for("waiting for Arm")
    assert waiting.stop(number) == 0
    assert "Traceback" not in waiting.output


def test_a_signal_ends_the_wait_for_a_silent_host(build: Build, start: Start) -> None:
    """A server that accepts the connection and never answers."""
    with socket.create_server(("127.0.0.1", 0)) as silent:
        waiting = start(client(build, silent.getsockname()[1]).command)
        waiting.wait_for("(no answer in time)")
        assert waiting.stop() == 0
        assert "Traceback" not in waiting.output


def test_it_waits_no_longer_than_its_timeout(build: Build, start: Start, free_port: Ports) -> None:
    port = free_port()
    waiting = start(client(build, port, timeout="500 ms").command)
    assert waiting.exit_code() == 1
    last = waiting.output.splitlines()[-1]
    at = f"arm:tcp -h 127.0.0.1 -p {port}"
    assert last.endswith(f"ERROR Client: Arm at {at} did not answer within 0.5 s (connection refused)")


def test_it_fails_at_once(build: Build, start: Start, free_port: Ports) -> None:
    port = free_port()
    failing = start(client(build, port, absent="fail").command)
    assert failing.exit_code() == 1
    (line,) = failing.output.splitlines()
    assert line.endswith(f"ERROR Client: Arm at arm:tcp -h 127.0.0.1 -p {port} does not answer (connection refused)")


def test_it_does_not_mind(build: Build, start: Start, free_port: Ports) -> None:
    ignoring = start(client(build, free_port(), absent="ignore").command).wait_for("Client is running")
    assert "waiting" not in ignoring.output


def test_a_process_without_that_object(build: Build, start: Start, free_port: Ports) -> None:
    port = free_port()
    server = build({**INTERFACES, "s/s.cdsl.yaml": cdsl("Server", implements=["Hand"])})["Server"]
    start(server.configure({"Hand.Endpoints": f"tcp -p {port}"}).command).wait_for("Server is running")
    failing = start(client(build, port, absent="fail").command)
    assert failing.exit_code() == 1
    assert "the process answers, but has no such object" in failing.output


def test_an_unknown_host(build: Build, start: Start) -> None:
    failing = client(build, 1, absent="fail").configure({"ArmProxy": "arm:tcp -h no-such-host.invalid -p 1"})
    running = start(failing.command)
    assert running.exit_code() == 1
    assert "host no-such-host.invalid is unknown" in running.output


def test_a_timeout_applies_to_each_call(build: Build, start: Start, free_port: Ports) -> None:
    """A call that takes longer than the proxy's timeout fails with an exception of Ice."""
    port = free_port()
    server = build({**INTERFACES, "s/s.cdsl.yaml": cdsl("Server", implements=["Arm"])})["Server"]
    worker = server.root / "src" / "specificworker.py"
    worker.write_text(
        "from generated.genericworker import GenericWorker\nimport time\n\nclass SpecificWorker(GenericWorker):\n"
        "    def Arm_block(self, seconds):\n        time.sleep(seconds)\n"
    )
    start(server.configure({"Arm.Endpoints": f"tcp -p {port}"}).command).wait_for("Server is running")
    caller = client(build, port, timeout="1 s")
    (caller.root / "src" / "specificworker.py").write_text(
        "from generated.genericworker import GenericWorker\nimport Ice\n\nclass SpecificWorker(GenericWorker):\n"
        "    def initialize(self):\n        try:\n            self.arm_proxy.block(5)\n"
        "        except Ice.InvocationTimeoutException:\n            print('timed out')\n"
    )
    start(caller.command).wait_for("timed out")
