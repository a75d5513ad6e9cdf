"""Java components over real Ice: they call components in other languages and are called, publish, subscribe, stop."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from components import Build, Built, build
from cpp_programs import Programs as CppPrograms
from cpp_programs import locked, needs_cpp
from java_programs import java_build, needs_java
from java_sources import DOCUMENTS, SOURCES
from processes import Ports, Start, Storm, answers, until
from scenario import INTERFACES, cdsl
from test_cpp_calls import MUTUAL, Addresses
from test_python_calls import CLIENT, SERVER
from test_python_topics import PUBLISHER, SUBSCRIBER

pytestmark = [pytest.mark.slow, needs_java]
Program = Callable[[str, dict[str, str]], list[str | Path]]
BOTH = pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=["INT", "TERM"])


@pytest.fixture(scope="session")
def built(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """The folder of a component, which the first test that needs it builds."""
    base = tmp_path_factory.getbasetemp()
    shared = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base
    folder = shared / "java ñ"  # with a blank and more
    folder.mkdir(exist_ok=True)
    with locked(shared / "java.documents.lock"):
        if not (folder / "Arm.idsl.yaml").is_file():
            for component in build(DOCUMENTS, folder).values():
                (component.root / "src" / "SpecificWorker.java").write_text(SOURCES[component.name])

    def root(name: str) -> Path:
        with locked(shared / f"java {name}.lock"):
            if not (folder / name.lower() / "bin" / name).is_file():
                java_build(folder / name.lower())
        return folder / name.lower()

    return root


@pytest.fixture
def program(built: Callable[[str], Path], tmp_path: Path) -> Program:
    """`program("Server", {key: value})`: the command that runs it with a config with these properties."""

    def command(name: str, properties: dict[str, str]) -> list[str | Path]:
        config = tmp_path / f"{name}.config"
        config.write_text("".join(f"{key} = {value}\n" for key, value in properties.items()))
        return [built(name) / "bin" / name, config]

    return command


@pytest.fixture
def addresses(free_port: Ports) -> Addresses:
    return Addresses(free_port)


def in_python(build: Build, name: str, source: str, **keys: object) -> Built:
    made = build({**INTERFACES, "py/py.cdsl.yaml": cdsl(name, **keys)})[name]
    (made.root / "src" / "specificworker.py").write_text(source)
    return made


ANSWERS = (
    "move 2 0", "state right 2.0 1 3.0", "blocked at 1.0 9.5", "timed out", "grasp cba",
)  # fmt: skip


def test_java_calls_java(program: Program, addresses: Addresses, start: Start) -> None:
    server = start(program("Server", addresses.endpoints)).wait_for("Server is running")
    said = start(program("Client", addresses.proxies)).wait_for("Client is running").output
    assert all(line in said.splitlines() for line in ANSWERS), said
    assert "unknown: (see the log of the component) Arm_breakDown: ArithmeticException: / by zero\n" in said
    assert "unknown: (see the log of the component) Arm_betray: UnsupportedOperationException: Broken\n" in said
    assert server.output.count("ERROR Server: Arm_breakDown() failed\njava.lang.ArithmeticException: / by zero") == 1
    server.wait_for("turn 5 40\n")
    assert "ERROR Server: compute() failed\njava.lang.IllegalStateException: the third one fails" in server.output


def test_java_calls_python(program: Program, build: Build, addresses: Addresses, start: Start) -> None:
    server = in_python(build, "PyServer", SERVER, implements=["Arm", "Hand"])
    start(server.configure(addresses.endpoints).command).wait_for("PyServer is running")
    said = start(program("Client", addresses.proxies)).wait_for("Client is running").output
    assert all(line in said.splitlines() for line in ANSWERS), said
    assert "Arm_breakDown: ZeroDivisionError: division by zero" in said


def test_python_calls_java(program: Program, build: Build, addresses: Addresses, start: Start) -> None:
    start(program("Server", addresses.endpoints)).wait_for("Server is running")
    client = in_python(build, "PyClient", CLIENT, requires=["Arm", {"Arm2": "Arm"}, "Hand"])
    said = start(client.configure(addresses.proxies).command).wait_for("PyClient is running").output
    for line in ("move 2 0", "state right 2.0 {'home': 3.0}", "grasp b'cba'", "blocked at 1.0 9.5"):
        assert f"{line}\n" in said, said


@needs_cpp
def test_java_and_cpp_call_each_other(
    program: Program, programs: CppPrograms, addresses: Addresses, start: Start, tmp_path: Path
) -> None:
    server = start(programs("Server").command(tmp_path, addresses.endpoints)).wait_for("Server is running")
    said = start(program("Client", addresses.proxies)).wait_for("Client is running").output
    assert all(line in said.splitlines() for line in ANSWERS), said
    assert server.stop() == 0
    start(program("Server", addresses.endpoints)).wait_for("Server is running")
    said = start(programs("Client").command(tmp_path, addresses.proxies)).wait_for("Client is running").output
    assert "move 2 0\n" in said and "state right 2 1 3\n" in said and "blocked at 1 9.5\n" in said, said


@pytest.mark.parametrize("prefix", ["", "javaleft"])
def test_events_arrive_in_order(
    program: Program, build: Build, addresses: Addresses, start: Start, icestorm: Storm, prefix: str
) -> None:
    """From Java to Python, from Python to Java, and from Java to itself."""
    of_topics = {"TopicManager.Proxy": icestorm.manager, "ArmEvents": f"Java{prefix}"}
    if prefix:
        of_topics |= {"Proxies.ArmEventsPrefix": f'"{prefix}"', "Proxies.ArmEventsPubPrefix": prefix}
    hand = in_python(build, "Hand", "from generated.genericworker import GenericWorker\n"
                     "class SpecificWorker(GenericWorker):\n    pass\n", implements=["Hand"])  # fmt: skip
    start(hand.configure(addresses.endpoints).command).wait_for("Hand is running")
    hearing = in_python(build, "Subscriber", SUBSCRIBER, subscribes=["ArmEvents"])
    hears = start(hearing.configure(of_topics).command).wait_for("Subscriber is running")
    properties = {"HandProxy": addresses.proxies["HandProxy"], "Arm.Endpoints": addresses.endpoints["Arm.Endpoints"]}
    radio = start(program("Radio", {**properties, **of_topics})).wait_for("Radio is running")
    hears.wait_for("in order: True\n")
    assert "moved to 4.0 right\n" in hears.output
    telling = in_python(build, "Publisher", PUBLISHER, publishes=["ArmEvents"])
    start(telling.configure(of_topics).command)
    radio.wait_for("all in order\n")
    assert "expected" not in radio.output and "moved to 4.0 right\n" in radio.output
    assert radio.stop() == 0


def test_two_that_require_each_other(
    program: Program, build: Build, addresses: Addresses, start: Start, icestorm: Storm
) -> None:
    """Both answer pings from the start; a call waits until the other side has initialized. One stops the other."""
    other = in_python(build, "Other", MUTUAL, implements=["Hand"], requires=["Arm"])
    of_topics = {"TopicManager.Proxy": icestorm.manager, "ArmEvents": "JavaMutual"}
    both = {**addresses.proxies, **addresses.endpoints}
    radio = start(program("Radio", {**both, **of_topics})).wait_for("waiting for Hand")
    said = start(other.configure(both).command).wait_for("Other is running").output
    assert "the other one said 1\n" in said
    assert radio.exit_code(3) == 0


@BOTH
def test_a_signal_stops_it(program: Program, addresses: Addresses, start: Start, number: int) -> None:
    running = start(program("Server", addresses.endpoints)).wait_for("Server is running")
    assert running.stop(number) == 0
    assert "the process ends anyway" not in running.output, "at once: nothing holds it up"


def test_with_a_method_that_is_stuck(
    program: Program, addresses: Addresses, start: Start, ice: Any, slices: None
) -> None:
    import RoboCompArm

    running = start(program("Server", addresses.endpoints)).wait_for("Server is running")
    proxy = ice.stringToProxy(addresses.proxies["ArmProxy"])
    call = RoboCompArm.ArmPrx.uncheckedCast(proxy).blockAsync(60)
    running.wait_for("blocking")
    assert running.stop(signal.SIGTERM, within=2.0) == 0
    assert "WARNING stop: a method is still running after 1.5 s: the process ends anyway" in running.output
    assert call.exception(5) is not None


def test_while_it_waits_for_others(program: Program, addresses: Addresses, start: Start) -> None:
    running = start(program("Client", addresses.proxies)).wait_for("INFO Client: waiting for Arm at arm:tcp")
    assert "(connection refused)" in running.output
    assert running.stop() == 0


@pytest.mark.parametrize(
    ("properties", "words", "code", "said"),
    [
        ({}, [], 1, "the endpoint of Arm is not configured: set Arm.Endpoints or Endpoints.Arm in "),
        ({"Arm.Endpoints": "tpc"}, [], 1, "cannot serve Arm at 'tpc' ("),
        ({}, ["one", "two"], 2, "Server: expected one CONFIG, got 3: "),
        ({}, ["-x"], 2, "Server: unknown option -x\n"),
        ({"period.compute": "often"}, [], 1, "period.compute must be a whole number (ms), and is 'often'"),
        ({}, ["--help"], 0, "usage: bin/Server [CONFIG]"),
    ],
)
def test_what_cannot_start_reports_why(
    program: Program, start: Start, properties: dict[str, str], words: list[str], code: int, said: str
) -> None:
    running = start([*program("Server", properties), *words])
    assert running.exit_code() == code
    assert said in running.output and "Exception" not in running.output, running.output


@pytest.mark.parametrize("word", ["own config", "./own config", "--Ice.Config=own config"])
def test_the_path_of_a_configuration_is_relative_to_the_working_folder(
    built: Callable[[str], Path], tmp_path: Path, word: str
) -> None:
    (tmp_path / "own config").write_text("period.compute=often\n")
    done = subprocess.run([built("Server") / "bin/Server", word], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 1 and "period.compute must be a whole number (ms), and is 'often'" in done.stderr


def test_what_the_launcher_lacks_is_reported(built: Callable[[str], Path], tmp_path: Path) -> None:
    """Without Java, without Ice, without a build; each message has a hint."""
    root = tmp_path / "server"
    shutil.copytree(built("Server"), root)
    program = root / "bin" / "Server"

    def said(**variables: str) -> str:
        done = subprocess.run([program], env={**os.environ, **variables}, capture_output=True, text=True)
        assert done.returncode == 1
        return done.stderr

    assert said(JAVA_HOME="/nowhere") == (
        "Server: Java is not installed: apt install openjdk-17-jre-headless, or set JAVA_HOME\n"
    )
    assert "Server: Ice 3.7 for Java is not installed: apt install libzeroc-ice3.7-java" in said(ICE_JAVA="/nowhere")
    (root / "build" / "Server.jar").unlink()
    assert said() == f"Server: it is not built yet: run {root}/generated/build\n"


def test_a_build_that_is_older_than_its_code_is_reported(built: Callable[[str], Path], tmp_path: Path) -> None:
    root = tmp_path / "server"
    shutil.copytree(built("Server"), root)
    os.utime(root / "src" / "SpecificWorker.java", (2e9, 2e9))
    done = subprocess.run([root / "bin" / "Server", "--help"], capture_output=True, text=True)
    assert done.stderr == f"Server: its sources have changed since it was built: run {root}/generated/build\n"


def test_a_missing_method_is_named_by_the_build(built: Callable[[str], Path], tmp_path: Path) -> None:
    root = tmp_path / "server"
    shutil.copytree(built("Server"), root)
    worker = root / "src" / "SpecificWorker.java"
    worker.write_text(worker.read_text().replace("Hand_grasp", "Hand_grip").replace("    @Override\n", ""))
    done = subprocess.run([root / "generated" / "build"], capture_output=True, text=True)
    assert done.returncode == 1
    assert "does not override abstract method Hand_grasp(byte[])" in done.stderr
    assert done.stderr.endswith("Server: javac cannot compile the code, see above\n")


def test_a_build_rejects_what_it_cannot_do(built: Callable[[str], Path], tmp_path: Path) -> None:
    """A file of another program, an old compiler, no compiler; a failed build keeps the last program."""
    root = tmp_path / "server"
    shutil.copytree(built("Server"), root)
    program, build_ = root / "bin" / "Server", root / "generated" / "build"
    before = program.read_bytes(), (root / "build" / "Server.jar").read_bytes()

    def said(**variables: str) -> str:
        done = subprocess.run([build_], env={**os.environ, **variables}, capture_output=True, text=True)
        assert done.returncode == 1
        assert (program.read_bytes(), (root / "build" / "Server.jar").read_bytes()) == before
        assert sorted(path.name for path in (root / "build").iterdir()) == [".gitignore", "Server.jar"]
        return done.stderr

    assert said(JAVA_HOME="/nowhere").startswith("Server: javac is not installed: apt install openjdk-17-jdk-headless")
    old = tmp_path / "old" / "bin" / "javac"
    old.parent.mkdir(parents=True)
    old.write_text("#!/bin/sh\necho javac 11.0.2\n")
    old.chmod(0o755)
    assert said(JAVA_HOME=str(tmp_path / "old")).endswith("has version 11: Java 17 or later is required\n")
    (root / "src" / "Odd.java").write_text("class {")
    assert said().endswith("Server: javac cannot compile the code, see above\n")
    program.write_text("#!/bin/sh\necho mine\n")
    before = program.read_bytes(), before[1]
    assert said() == f"Server: {program} was not created by a build: move it away\n"


def test_common_behavior(program: Program, addresses: Addresses, start: Start, ice: Any, free_port: Ports) -> None:
    from Ice import loadSlice

    from robocomp_yaml.resources import folder

    loadSlice(f"'{folder('templates')}/slice/CommonBehavior.ice'")
    import RoboCompCommonBehavior as behavior

    endpoint = f"tcp -h 127.0.0.1 -p {free_port()}"
    running = start(program("Server", {**addresses.endpoints, "CommonBehavior.Endpoints": endpoint, "stray": "1"}))
    until(lambda: answers(ice, f"commonbehavior:{endpoint}"), "CommonBehavior answers")
    asked = behavior.CommonBehaviorPrx.uncheckedCast(ice.stringToProxy(f"commonbehavior:{endpoint}"))
    running.wait_for("Server is running")
    until(lambda: asked.getState() == behavior.State.Running, "it says that it runs")
    assert asked.getPeriod() == 40 and asked.timeAwake() > 0
    asked.setPeriod(7)
    assert asked.getPeriod() == 7 and asked.getParameterList()["period.compute"].value == "7"
    assert asked.getParameterList()["stray"].value == "1"
    asked.killYourSelf()
    assert running.exit_code(2) == 0
