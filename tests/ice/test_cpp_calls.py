"""C++ components that serve and call each other and Python components over real Ice."""

from __future__ import annotations

from pathlib import Path

import pytest

from components import Build, Built
from cpp_programs import Programs, needs_cpp
from processes import Ports, Start
from scenario import INTERFACES, cdsl
from test_python_calls import CLIENT, SERVER

pytestmark = [pytest.mark.slow, needs_cpp]


class Addresses:
    """The address of a test's server."""

    def __init__(self, free_port: Ports) -> None:
        arm, hand = free_port(), free_port()
        self.endpoints = {
            "Arm.Endpoints": f"tcp -h 127.0.0.1 -p {arm}",
            "Hand.Endpoints": f"tcp -h 127.0.0.1 -p {hand}",
        }
        to_arm = f"arm:tcp -h 127.0.0.1 -p {arm}"
        self.proxies = {"ArmProxy": to_arm, "Arm2Proxy": to_arm, "LateProxy": to_arm}
        self.proxies["HandProxy"] = f"hand:tcp -h 127.0.0.1 -p {hand}"


@pytest.fixture
def addresses(free_port: Ports) -> Addresses:
    return Addresses(free_port)


@pytest.fixture
def python(build: Build) -> dict[str, Built]:
    """The same components in Python."""
    built = build(
        {
            **INTERFACES,
            "server/server.cdsl.yaml": cdsl("PyServer", implements=["Arm", "Hand"]),
            "client/client.cdsl.yaml": cdsl("PyClient", requires=["Arm", {"Arm2": "Arm"}, "Hand"]),
        }
    )
    (built["PyServer"].root / "src" / "specificworker.py").write_text(SERVER)
    (built["PyClient"].root / "src" / "specificworker.py").write_text(CLIENT)
    return built


def says_all(said: str) -> bool:
    """The lines of a C++ client for correct answers."""
    lines = said.splitlines()
    for line in ("move 2 0", "state right 2 1 3", "blocked at 1 9.5", "timed out", "grasp cba"):
        assert line in lines, said
    return True


def test_cpp_calls_cpp(programs: Programs, addresses: Addresses, start: Start, tmp_path: Path) -> None:
    server = start(programs("Server").command(tmp_path, addresses.endpoints)).wait_for("Server is running")
    said = start(programs("Client").command(tmp_path, addresses.proxies)).wait_for("Client is running").output
    assert says_all(said)
    assert "unknown: (see the log of the component) Arm_breakDown: division by zero\n" in said
    assert "unknown: (see the log of the component) Arm_betray: Broken\n" in said
    assert "ERROR Server: Arm_breakDown() failed: division by zero\n" in server.output
    assert server.output.count("division by zero") == 1, "logged once, not again by Ice"


def test_cpp_calls_python(
    programs: Programs, python: dict[str, Built], addresses: Addresses, start: Start, tmp_path: Path
) -> None:
    start(python["PyServer"].configure(addresses.endpoints).command).wait_for("PyServer is running")
    said = start(programs("Client").command(tmp_path, addresses.proxies)).wait_for("Client is running").output
    assert says_all(said)
    assert "Arm_breakDown: ZeroDivisionError: division by zero" in said


def test_python_calls_cpp(
    programs: Programs, python: dict[str, Built], addresses: Addresses, start: Start, tmp_path: Path
) -> None:
    start(programs("Server").command(tmp_path, addresses.endpoints)).wait_for("Server is running")
    client = python["PyClient"].configure(addresses.proxies)
    said = start(client.command).wait_for("PyClient is running").output
    assert "move 2 0\n" in said
    assert "state right 2.0 {'home': 3.0}\n" in said
    assert "grasp b'cba'\n" in said
    assert "blocked at 1.0 9.5\n" in said
    assert "unknown: (see the log of the component) Arm_breakDown: division by zero\n" in said
    assert "unknown: (see the log of the component) Arm_betray: Broken\n" in said


MUTUAL = """
from generated.genericworker import GenericWorker

class SpecificWorker(GenericWorker):
    def initialize(self):
        print("the other one said", self.arm_proxy.move([], False))
        self.arm_proxy.breakDown()

    def Hand_grasp(self, image):
        return image
"""


def test_two_that_require_each_other(
    programs: Programs, build: Build, addresses: Addresses, start: Start, tmp_path: Path
) -> None:
    """Both answer pings from the start; a call waits until the other side has initialized. One stops the other."""
    documents = {**INTERFACES, "b/b.cdsl.yaml": cdsl("Other", implements=["Hand"], requires=["Arm"])}
    other = build(documents)["Other"].configure({**addresses.proxies, **addresses.endpoints})
    (other.root / "src" / "specificworker.py").write_text(MUTUAL)
    mutual = start(programs("Mutual").command(tmp_path, {**addresses.proxies, **addresses.endpoints}))
    assert "the other one said 1\n" in start(other.command).wait_for("Other is running").output
    assert mutual.exit_code(2) == 0
