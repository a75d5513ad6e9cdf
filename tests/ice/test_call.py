"""`rcyaml call`: methods of real components in three languages, called without generated code."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import pytest
from click.testing import Result

from components import Build
from conftest import write_tree
from cpp_programs import Programs as CppPrograms
from cpp_programs import needs_cpp
from java_programs import needs_java
from processes import Ports, Running, Start, until
from scenario import INTERFACES, cdsl
from test_java import Program, built, program  # noqa: F401 (fixtures)
from test_python_calls import SERVER

Rcyaml = Callable[..., Result]
RCYAML = os.path.join(os.path.dirname(sys.executable), "rcyaml")
WORKSPACE = {**INTERFACES, "rcyaml.yaml": "interfaces: [.]\n"}
POSES = "path: [{x: 1, y: 2, side: left}, {x: 3, y: 4.1, side: right}]"


class Server:
    """A running component that serves Arm and Hand, with a deployment that has it as `arm`."""

    def __init__(self, running: Running, arm: int, hand: int) -> None:
        self.running, self.arm, self.hand = running, arm, hand


DEPLOYMENT = """\
deployment: Robot
components:
  arm: {{component: server, ports: {{Arm: {arm}, Hand: {hand}, CommonBehavior: {common}}}}}
  twin{{i}}: {{component: server, instances: 2}}
"""


@pytest.fixture
def server(build: Build, start: Start, free_port: Ports, tmp_path: Path) -> Server:
    write_tree(tmp_path, {"rcyaml.yaml": "interfaces: [.]\n"})
    made = build({**INTERFACES, "server/server.cdsl.yaml": cdsl("Server", implements=["Arm", "Hand"])})["Server"]
    (made.root / "src" / "specificworker.py").write_text(SERVER)
    arm, hand, common = free_port(), free_port(), free_port()
    made.configure(
        {
            "Arm.Endpoints": f"tcp -p {arm}",
            "Hand.Endpoints": f"tcp -p {hand}",
            "CommonBehavior.Endpoints": f"tcp -p {common}",
        }
    )
    write_tree(tmp_path, {"robot.ddsl.yaml": DEPLOYMENT.format(arm=arm, hand=hand, common=common)})
    running = start(made.command).wait_for("Server is running")
    return Server(running, arm, hand)


def result(done: Result) -> object:
    assert done.exit_code == 0, done.output
    return json.loads(done.stdout)


def test_addresses_of_one_component(server: Server, rcyaml: Rcyaml) -> None:
    """By entry, with and without interface and module, by component, folder, document, host and port."""
    expected = {"returns": 2}
    for address in (
        "arm.Arm.move", "arm.move", "arm.RoboCompArm.Arm.move", "Server.Arm.move", "server.Arm.move",
        "server/server.cdsl.yaml.Arm.move", f"localhost:{server.arm}.Arm.move", f"127.0.0.1:{server.arm}/Arm/move",
        f"localhost:{server.arm}.move", "./server.Arm.move", "server/.Arm.move",
        f"{os.path.abspath('server')}.Arm.move",
    ):  # fmt: skip
        assert result(rcyaml("call", address, f"{{{POSES}, fast: false}}", "--format", "json")) == expected, address
    words = ("call", "arm.move", "path=[]", "fast=false", "--deployment", "robot.ddsl.yaml", "--format", "json")
    assert result(rcyaml(*words)) == {"returns": 0}


def test_values_are_spelled_as_in_documents(server: Server, rcyaml: Rcyaml) -> None:
    """Both ways: what is printed can be sent again."""
    done = rcyaml("call", "arm.state")
    assert done.stdout == (
        "returns: right\n"
        'out: {pose: {x: 1.0, "y": 2.0, side: left}, named: {home: {x: 3.0, "y": 4.0, side: left}}}\n'
    )  # fmt: skip
    assert rcyaml("call", "arm.grasp", "image=[1, 2, 255]").stdout == "returns: [255, 2, 1]\n"
    assert rcyaml("call", "arm.grasp", "-", stdin="image:\n- 7\n- 8\n").stdout == "returns: [8, 7]\n"
    assert rcyaml("call", "arm.Arm.block", "seconds=0").stdout == ""


def test_exceptions_are_values(server: Server, rcyaml: Rcyaml) -> None:
    done = rcyaml("call", "arm.move", f"{{{POSES}}}", "fast=true")
    assert done.exit_code == 1
    assert done.stdout == 'throws: {Blocked: {where: {x: 1.0, "y": 2.0, side: left}, force: 9.5}}\n', done.output
    done = rcyaml("call", "arm.breakDown", "--format", "json")
    assert done.exit_code == 1
    (name, members), = json.loads(done.stdout)["throws"].items()  # fmt: skip
    assert name == "UnknownException" and members["unknown"].endswith("ZeroDivisionError: division by zero")
    assert rcyaml("call", "arm.betray").exit_code == 1


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (
            ["path=[{x: a, side: left}]", "fast=no"],
            ["argument 1:1:11", "'path[0].x' must be a number", "argument 2:1:6"],
        ),
        (["{path: [{side: rihgt, x: 1}], fast: true}"], ["argument 1:1:16", "did you mean 'right'?"]),
        (["fast=true"], ["arguments:1:1", "'path' is missing"]),
        (["path=[]", "fast=true", "slow=1"], ["argument 3:1:1", "'slow' is unknown"]),
        (["path=[]", "fast=true", "fast=false"], ["argument 3:1:1", "'fast' is set twice"]),
        (["path=[", "fast=true"], ["argument 1:1:"]),
        (["path: []", "fast: maybe"], ["argument 2:1:7", "'fast' must be true or false, but is maybe"]),
        (["path=[]\n- x", "fast=true"], ["argument 1:"]),
        (["path=", "fast=true"], ["argument 1:1:6", "'path' must be a list, but is missing"]),
        (["path=[{x: 1e400, side: left}]", "fast=no"], ["argument 1:1:11", "a number that a ", "but is 1e400"]),
        (["-"], ["standard input:2:1", "'fats' is unknown", "did you mean 'fast'?"]),
    ],
)
def test_wrong_arguments_are_not_sent(tmp_path: Path, rcyaml: Rcyaml, words: list[str], said: list[str]) -> None:
    """Nobody is there: so nothing can have been sent."""
    write_tree(tmp_path, {**INTERFACES, "rcyaml.yaml": "interfaces: [.]\n"})
    done = rcyaml("call", "localhost:9.Arm.move", *words, stdin="path: []\nfats: true\n")
    assert done.exit_code == 1
    for part in said:
        assert part in done.output
    assert "cannot be reached" not in done.output


def test_a_misspelled_argument_is_one_fault(tmp_path: Path, rcyaml: Rcyaml) -> None:
    write_tree(tmp_path, {**INTERFACES, "rcyaml.yaml": "interfaces: [.]\n"})
    done = rcyaml("call", "localhost:9.Arm.move", "path=[{x: 1, sied: left}]", "fats=true")
    assert done.output.count("error[RC9001]") == 2, done.output
    assert "did you mean 'side'?" in done.output and "did you mean 'fast'?" in done.output
    for stdin, said in (("", "'path' is missing"), ("[1]\n", "the value as a whole must be a mapping of arguments")):
        done = rcyaml("call", "localhost:9.Arm.move", "-", stdin=stdin)
        assert done.exit_code == 1 and said in done.output


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["arn.Arm.move"], "robot.ddsl.yaml has no component 'arn'; did you mean 'arm'?"),
        (["arm.Amr.move"], "arm does not serve 'Amr'; did you mean 'Arm'?"),
        (["arm.Arm.moove"], "Arm has no method 'moove'; did you mean 'move'?"),
        (["arm.moove"], "arm has no method 'moove'; did you mean 'move'?"),
        (["arm"], "name a method of arm; known are arm.Arm.move"),
        (["arm.Hand"], "name a method of Hand: arm.Hand.grasp"),
        (["twin.Arm.move"], "robot.ddsl.yaml has no component 'twin'; did you mean 'twin"),
        (["twin{i}.Arm.move"], "'twin{i}' means several processes; name one of twin0, twin1"),
        (["arm.Hand.grasp", "x"], "'x' is neither NAME=VALUE nor a mapping of arguments; write image=…"),
        (["arm.Hand.grasp", "image=[]", "--timeout", "soon"], "'soon' is not a duration"),
        (["arm.Hand.grasp", "image=[]", "--timout", "3s"], "No such option '--timout'. Did you mean '--timeout'?"),
        (["arm.Hand.grasp", "--image=[]"], "No such option '--image': write image=[], without `--`"),
        (["arm.Hand.grasp", "-1"], "write image=…"),
        (["nowhere.Arm.move"], "known are arm, twin0, twin1, Server, and HOST:PORT"),
        (["./arn.Arm.move"], "has no component './arn.Arm.move'"),
        (["localhost:70000.Arm.move"], "'70000' is not a TCP port: they are from 1 to 65535"),
        (["localhost:9.Amr.move"], "these documents have no interface 'Amr'; did you mean 'Arm'?"),
        (["nowhere.Arm.move", "--deployment", "other.ddsl.yaml"], "other.ddsl.yaml"),
    ],
)
def test_what_is_not_known(build: Build, tmp_path: Path, rcyaml: Rcyaml, words: list[str], said: str) -> None:
    build({**INTERFACES, "server/server.cdsl.yaml": cdsl("Server", implements=["Arm", "Hand"])})
    write_tree(
        tmp_path, {"rcyaml.yaml": "interfaces: [.]\n", "robot.ddsl.yaml": DEPLOYMENT.format(arm=19, hand=10, common=11)}
    )
    done = rcyaml("call", *words)
    assert done.exit_code == 2
    assert said in done.output


def test_several_deployments_must_be_told_apart(build: Build, tmp_path: Path, rcyaml: Rcyaml) -> None:
    build({**WORKSPACE, "server/server.cdsl.yaml": cdsl("Server", implements=["Arm"])})
    for name in "ab":
        write_tree(
            tmp_path, {f"{name}.ddsl.yaml": f"deployment: D{name}\ncomponents: {{{name}: {{component: server}}}}\n"}
        )
    assert "name one with --deployment b.ddsl.yaml" in rcyaml("call", "b.Arm.state").output
    assert "b cannot be reached" in rcyaml("call", "b.Arm.state", "--deployment", "b.ddsl.yaml").output


def test_components_with_the_same_name(build: Build, tmp_path: Path, rcyaml: Rcyaml) -> None:
    write_tree(tmp_path, WORKSPACE)
    for folder in ("left", "right"):
        write_tree(tmp_path, {f"{folder}/arm.cdsl.yaml": cdsl("Both", implements=["Arm"])})
    assert (
        "several components have the name 'Both'; name one of the folders left, right"
        in rcyaml("call", "Both.state").output
    )
    assert "cannot be reached" in rcyaml("call", "left.Arm.state").output


def test_nobody_is_there(server: Server, rcyaml: Rcyaml, free_port: Ports) -> None:
    server.running.stop()
    done = rcyaml("call", "arm.state")
    assert done.exit_code == 1
    assert f"arm cannot be reached at tcp -h 127.0.0.1 -p {server.arm}: nothing listens there" in done.output
    assert "`rcyaml deploy up robot.ddsl.yaml` starts it" in done.output
    done = rcyaml("call", f"localhost:{free_port()}.Arm.state", "--format", "json")
    assert done.exit_code == 1 and json.loads(done.stdout)["error"].endswith("nothing listens there")
    assert "unknown host 'no.invalid'" in rcyaml("call", "no.invalid:77.Arm.state").output


def test_somebody_else_is_there(server: Server, rcyaml: Rcyaml) -> None:
    done = rcyaml("call", f"localhost:{server.arm}.Hand.grasp", "image=[]")
    assert done.exit_code == 1 and "has no object 'hand' for Hand; what serves there is Arm" in done.output
    done = rcyaml("call", f"localhost:{server.arm}.Hand.grasp", "image=[]", "--identity", "arm")
    assert done.exit_code == 1
    assert "it has no method 'grasp'; what serves there is RoboCompArm.Arm" in done.output


def test_another_version_is_there(server: Server, rcyaml: Rcyaml, tmp_path: Path) -> None:
    changed = INTERFACES["Arm.idsl.yaml"].replace("block: {in: {seconds: float}}", "block: {}\n      added: {}")
    write_tree(tmp_path, {"Arm.idsl.yaml": changed})
    done = rcyaml("call", "arm.added")
    assert done.exit_code == 1 and "it has no method 'added'; compile and build both sides" in done.output


def test_one_that_hangs(server: Server, rcyaml: Rcyaml) -> None:
    began = time.monotonic()
    done = rcyaml("call", "arm.block", "seconds=300", "--timeout", "500ms")
    assert done.exit_code == 1 and "did not return within 0.5 s; it hangs, or needs more time" in done.output
    server.running.process.send_signal(signal.SIGSTOP)
    done = rcyaml("call", "arm.state", "--timeout", "500ms")
    assert done.exit_code == 1 and "it does not answer within 0.5 s" in done.output
    assert "or one with TLS (ssl:HOST:PORT) listens there" in done.output
    assert time.monotonic() - began < 100  # a busy machine takes its time, too


def test_what_is_not_utf8(tmp_path: Path) -> None:
    write_tree(tmp_path, WORKSPACE)
    for words, stdin in (([b"{path: [], fast: '\xff'}"], b""), ([b"-"], b"path: []\nfast: \xfe\n")):
        command = [RCYAML, "call", "localhost:9.Arm.move", *words]
        done = subprocess.run(command, cwd=tmp_path, input=stdin, capture_output=True)
        assert done.returncode == 2 and b"is not UTF-8" in done.stderr


def test_something_that_does_not_speak_ice(tmp_path: Path, rcyaml: Rcyaml) -> None:
    write_tree(tmp_path, INTERFACES)

    def greet() -> None:
        connection, _ = listener.accept()
        connection.sendall(b"220 mail ready\r\n" * 4)
        with suppress(ConnectionError), connection:
            connection.recv(100)

    with socket.create_server(("127.0.0.1", 0)) as listener:
        thread = threading.Thread(target=greet)
        thread.start()
        done = rcyaml("call", f"127.0.0.1:{listener.getsockname()[1]}.Arm.state", "--timeout", "5s")
        thread.join()
    assert done.exit_code == 1 and "what listens there does not speak Ice" in done.output


def test_again_and_again(server: Server, rcyaml: Rcyaml, start: Start, tmp_path: Path) -> None:
    done = rcyaml("call", "arm.getState", "--repeat", "3")
    assert done.stdout == "---\n".join(["returns: Running\n"] * 3), done.output
    done = rcyaml("call", "arm.breakDown", "--repeat", "2", "--format", "json")
    assert done.exit_code == 1 and len(done.stdout.splitlines()) == 2
    running = start([RCYAML, "call", "arm.timeAwake", "--every", "50ms", "--format", "json"], cwd=tmp_path)
    until(lambda: running.output.count("\n") >= 5, lambda: running.output)
    assert running.stop(signal.SIGINT) == 130
    values = [json.loads(line)["returns"] for line in running.output.splitlines()[:5]]
    assert values == sorted(values) and values[4] - values[0] >= 150


def test_ctrl_c_while_it_waits(server: Server, start: Start, tmp_path: Path) -> None:
    running = start([RCYAML, "call", "arm.block", "seconds=30", "--timeout", "1min"], cwd=tmp_path)
    until(lambda: "2" in (count := connections(server.arm)) or count, "a connection")
    time.sleep(0.3)
    assert running.stop(signal.SIGINT) == 130


def connections(port: int) -> str:
    """The established connections to a port, by their states in /proc."""
    rows = [row.split() for row in Path("/proc/net/tcp").read_text().splitlines()[1:]]
    return "".join("2" for row in rows if int(row[2].rpartition(":")[2], 16) == port and row[3] == "01")


DIALS = "parameters:\n  mode: {type: Mode, default: slow}\n  on: {type: bool, default: true}\n"


@pytest.mark.parametrize(
    ("words", "names"),
    [
        ("call fo", [f"fore.Arm.{method}" for method in ("move", "state", "breakDown", "betray", "block")]),
        ("call ar", [f"arm.Arm.{method}" for method in ("move", "state", "breakDown", "betray", "block")]),
        ("call arm.CommonBehavior.getP", ["arm.CommonBehavior.getPeriod", "arm.CommonBehavior.getParameterList"]),
        ("topic echo ", ["ArmEvents"]),
        ("topic pub Arm", ["ArmEvents.moved", "ArmEvents.count"]),
        ("record ", ["ArmEvents"]),
        ("param get ", ["arm", "Server"]),
        ("param set arm mo", ["mode"]),
        ("param set arm mode ", ["slow", "fast"]),
        ("param set arm on f", ["false"]),
        ("param set arm nothing ", []),
        ("top ", ["storm", "arm", "fore.gate"]),
    ],
)
def test_names_complete(tmp_path: Path, words: str, names: list[str]) -> None:
    keys = {"implements": ["Arm"], "publishes": ["ArmEvents"], "parameters": "server.pdsl.yaml"}
    write_tree(tmp_path, {
        **WORKSPACE,
        "server/server.cdsl.yaml": cdsl("Server", **keys),
        "server/server.pdsl.yaml": f"component: server.cdsl.yaml\ntypes: {{Mode: {{enum: [slow, fast]}}}}\n{DIALS}",
        "robot.ddsl.yaml": "deployment: R\nservices: {storm: {icestorm: }}\ncomponents: {arm: {component: server}}\n"
        "groups: {fore: {components: [arm], expose: {Arm: {member: arm, rate: 5}}}}\n",
    })  # fmt: skip
    typed = f"rcyaml {words}"
    environment = {**os.environ, "_RCYAML_COMPLETE": "bash_complete", "COMP_WORDS": typed,
                   "COMP_CWORD": str(len(typed.split(" ")) - 1)}  # fmt: skip
    done = subprocess.run([RCYAML], cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert [line.partition(",")[2] for line in done.stdout.splitlines() if line] == names, done.stderr


OPENSSL = """openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -days 9 -subj /CN=robot \\
    -addext subjectAltName=IP:127.0.0.1,DNS:localhost -keyout robot.key -out robot.pem
"""
TLS = """Ice.Plugin.IceSSL = IceSSL:createIceSSL
IceSSL.DefaultDir = {folder}
IceSSL.CAs = robot.pem
IceSSL.CertFile = robot.pem
IceSSL.KeyFile = robot.key
IceSSL.VerifyPeer = 2
"""


@pytest.fixture
def tls(tmp_path: Path) -> dict[str, str]:
    """Ice's properties of TLS: both sides need the robot's certificate. `tls.cfg` has them, too."""
    folder = tmp_path / "tls"
    folder.mkdir()
    subprocess.run(["bash", "-c", OPENSSL], cwd=folder, check=True, capture_output=True)
    text = TLS.format(folder=folder)
    write_tree(tmp_path, {"tls.cfg": text})
    return dict(line.split(" = ") for line in text.splitlines())


def test_tls_in_python(
    build: Build, start: Start, free_port: Ports, rcyaml: Rcyaml, tmp_path: Path, tls: dict[str, str]
) -> None:
    write_tree(tmp_path, WORKSPACE)
    made = build({**WORKSPACE, "server/server.cdsl.yaml": cdsl("Server", implements=["Arm", "Hand"])})["Server"]
    (made.root / "src" / "specificworker.py").write_text(SERVER)
    endpoints = {
        f"{name}.Endpoints": f"ssl -h 127.0.0.1 -p {free_port()}" for name in ("Arm", "Hand", "CommonBehavior")
    }
    start(made.configure({**tls, **endpoints}).command).wait_for("Server is running")
    secure(rcyaml, "Server")
    done = rcyaml("param", "set", "Server", "period.compute", "77", "--ice-config", "tls.cfg")
    assert done.exit_code == 0, done.output
    assert rcyaml("param", "get", "Server", "period.compute", "--ice-config", "tls.cfg").stdout == "77\n"


@needs_cpp
@pytest.mark.slow
def test_tls_in_cpp(
    programs: CppPrograms, start: Start, free_port: Ports, rcyaml: Rcyaml, tmp_path: Path, tls: dict[str, str]
) -> None:
    write_tree(tmp_path, WORKSPACE)
    port = free_port()
    endpoints = {"Arm.Endpoints": f"ssl -h 127.0.0.1 -p {port}", "Hand.Endpoints": f"ssl -h 127.0.0.1 -p {free_port()}"}
    start(programs("Server").command(tmp_path, {**tls, **endpoints})).wait_for("Server is running")
    secure(rcyaml, f"ssl:127.0.0.1:{port}")


def secure(rcyaml: Rcyaml, address: str) -> None:
    done = rcyaml("call", f"{address}.Arm.move", "path=[]", "fast=false", "--ice-config", "tls.cfg")
    assert done.stdout == "returns: 0\n", done.output
    done = rcyaml("call", f"{address}.Arm.move", "path=[]", "fast=false")
    assert done.exit_code == 2 and "needs a plug-in of Ice" in done.output and "--ice-config FILE" in done.output
    Path("other.cfg").write_text("Ice.Plugin.IceSSL = IceSSL:createIceSSL\n")
    done = rcyaml(
        "call", f"{address}.Arm.move", "path=[]", "fast=false", "--ice-config", "other.cfg", "--timeout", "3s"
    )
    assert done.exit_code == 1 and "cannot be reached at ssl -h 127.0.0.1" in done.output


@needs_cpp
@pytest.mark.slow
def test_a_component_in_cpp(
    programs: CppPrograms, start: Start, free_port: Ports, rcyaml: Rcyaml, tmp_path: Path
) -> None:
    write_tree(tmp_path, INTERFACES)
    arm, hand = free_port(), free_port()
    properties = {"Arm.Endpoints": f"tcp -p {arm}", "Hand.Endpoints": f"tcp -p {hand}"}
    start(programs("Server").command(tmp_path, properties)).wait_for("Server is running")
    calls(rcyaml, arm, hand)


@needs_java
@pytest.mark.slow
def test_a_component_in_java(program: Program, start: Start, free_port: Ports, rcyaml: Rcyaml, tmp_path: Path) -> None:  # noqa: F811
    write_tree(tmp_path, INTERFACES)
    arm, hand = free_port(), free_port()
    properties = {"Arm.Endpoints": f"tcp -p {arm}", "Hand.Endpoints": f"tcp -p {hand}"}
    start(program("Server", properties)).wait_for("Server is running")
    calls(rcyaml, arm, hand)


def calls(rcyaml: Rcyaml, arm: int, hand: int) -> None:
    done = rcyaml("call", f"localhost:{arm}.move", f"{{{POSES}, fast: false}}", "--format", "json")
    assert result(done) == {"returns": 2}
    done = rcyaml("call", f"localhost:{arm}.move", f"{{{POSES}, fast: true}}")
    assert done.exit_code == 1 and done.stdout.startswith('throws: {Blocked: {where: {x: 1.0, "y": 2.0')
    assert rcyaml("call", f"localhost:{arm}.state").stdout.startswith("returns: right\nout: {pose: {x: 1.0")
    assert rcyaml("call", f"localhost:{hand}.grasp", "image=[1, 2, 255]").stdout == "returns: [255, 2, 1]\n"
    done = rcyaml("call", f"localhost:{arm}.breakDown", "--format", "json")
    assert done.exit_code == 1 and list(json.loads(done.stdout)["throws"]) == ["UnknownException"]


def test_a_call_imports_nothing_that_it_does_not_need(tmp_path: Path) -> None:
    """It is typed by hand, and waited for: importing Ice is half of its time."""
    write_tree(tmp_path, WORKSPACE)
    script = (
        "import sys\nfrom robocomp_yaml.cli import group\n"
        "try: group(['call', 'localhost:9.Arm.state'])\nexcept SystemExit: pass\n"
        "print(*sys.modules, file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, cwd=tmp_path, check=True)
    imported = set(done.stderr.split())
    assert "Ice" in imported and "nothing listens there" in done.stderr
    assert not {"jinja2", "lark", "networkx", "cerberus", "tree_sitter", "IceStorm", "IceGrid", "mcap"} & imported
