"""A Python component whose code exits: it stops in order, and its exit code and text are those of Python itself."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from typing import Any

import pytest

from components import Build, Built
from processes import Ports, Start, Storm
from scenario import INTERFACES, cdsl
from test_python_stop import WORKER

IN_COMPUTE = "    def compute(self):\n        {}\n"
EXITS = [
    "sys.exit()",
    "sys.exit(0)",
    "sys.exit(5)",
    "sys.exit(-1)",
    "sys.exit(True)",
    "sys.exit('no camera')",
    "exit(7)",
]
EXITS += ["raise SystemExit", "raise SystemExit(6)", "sys.exit(2.5)", "sys.exit(['no', 'camera'])"]


@pytest.fixture
def port(free_port: Ports) -> int:
    return free_port()


@pytest.fixture
def arm(build: Build, port: int) -> Built:
    document = cdsl("ArmComp", implements=["Arm"], period="20 ms")
    built = build({**INTERFACES, "a/a.cdsl.yaml": document})["ArmComp"]
    return built.configure({"Arm.Endpoints": f"tcp -h 127.0.0.1 -p {port}"})


def write(component: Built, methods: str, before: str = "") -> None:
    (component.root / "src" / "specificworker.py").write_text(before + WORKER + methods)


@pytest.mark.parametrize("statement", EXITS)
def test_as_python_itself(arm: Built, start: Start, statement: str) -> None:
    expected = subprocess.run(
        [sys.executable, "-c", f"import sys\n{statement}"], capture_output=True, text=True, check=False, timeout=60
    )
    write(arm, IN_COMPUTE.format(statement))
    running = start(arm.command)
    assert running.exit_code() == expected.returncode
    for line in expected.stderr.splitlines():
        assert f"ERROR ArmComp: {line}\n" in running.output
    assert "Traceback" not in running.output and "ends anyway" not in running.output


@pytest.mark.parametrize(
    "methods",
    [
        "    def initialize(self):\n        sys.exit(5)\n",
        "    def __init__(self, *arguments):\n        sys.exit(5)\n",
        "    def initialize(self):\n        self.parameters.listen(lambda change: sys.exit(5))\n"
        "        self.setPeriod(30)\n",
        "    def compute(self):\n        try:\n            sys.exit(5)\n        except Exception:\n            pass\n",
    ],
    ids=["initialize", "constructor", "listener", "compute"],
)
def test_wherever_it_exits(arm: Built, start: Start, methods: str) -> None:
    write(arm, methods)
    running = start(arm.command)
    assert running.exit_code() == 5
    assert "Traceback" not in running.output and "sys.exit(5)" in running.output


@pytest.mark.parametrize(
    ("statement", "code", "text"),
    [("sys.exit(5)", 5, "sys.exit(5)"), ("sys.exit('no camera')", 1, "no camera"), ("raise KeyboardInterrupt", 0, "")],
)
def test_while_it_is_imported(arm: Built, start: Start, statement: str, code: int, text: str) -> None:
    write(arm, "    pass\n", f"import sys\n{statement}\n")
    running = start(arm.command)
    assert running.exit_code() == code
    assert text in running.output and "Traceback" not in running.output


@pytest.mark.parametrize("hook", ["initialize", "compute"])
def test_keyboard_interrupt_is_ctrl_c(arm: Built, start: Start, hook: str) -> None:
    write(arm, f"    def {hook}(self):\n        raise KeyboardInterrupt\n")
    running = start(arm.command)
    assert running.exit_code() == 0, "as after SIGINT"
    assert "Traceback" not in running.output and "ERROR" not in running.output


def test_ctrl_c_with_a_library_that_handles_it(arm: Built, start: Start) -> None:
    """Such a library restores Python's own handler, which raises KeyboardInterrupt in the main thread."""
    before = "import signal\nsignal.signal(signal.SIGINT, signal.default_int_handler)\n"
    write(arm, "    pass\n", before)
    running = start(arm.command).wait_for("ArmComp is running")
    assert running.stop(signal.SIGINT) == 0
    assert "Traceback" not in running.output


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_handler_of_the_user(arm: Built, start: Start, number: int) -> None:
    """It runs in the main thread, which waits; a second signal does not interrupt the stop."""
    before = f"import signal, sys\nsignal.signal({int(number)}, lambda *_: sys.exit(12))\n"
    write(arm, "    def compute(self):\n        time.sleep(0.3)\n", before)
    running = start(arm.command).wait_for("ArmComp is running")
    running.process.send_signal(number)
    time.sleep(0.1)
    assert running.stop(number) == 12
    assert "Traceback" not in running.output and "ends anyway" not in running.output


@pytest.mark.parametrize("error", ["GeneratorExit", "asyncio.CancelledError", "ValueError"])
def test_others_are_failures(arm: Built, start: Start, error: str) -> None:
    """An exception that is no Exception is a failure of one turn, as any other."""
    methods = "    n = 0\n    def compute(self):\n        self.n += 1\n"
    methods += f"        if self.n == 3:\n            sys.exit(4)\n        raise {error}\n"
    write(arm, methods, "import asyncio\n")
    running = start(arm.command)
    assert running.exit_code() == 4
    assert running.output.count("compute() failed") == 2


def test_initialize_fails_with_another(arm: Built, start: Start) -> None:
    write(arm, "    def initialize(self):\n        raise GeneratorExit('over')\n")
    running = start(arm.command)
    assert running.exit_code() == 1
    assert "cannot start" in running.output and "GeneratorExit: over" in running.output


def proxy(ice: Any, port: int) -> Any:
    import RoboCompArm

    return RoboCompArm.ArmPrx.uncheckedCast(ice.stringToProxy(f"arm:tcp -h 127.0.0.1 -p {port}"))


@pytest.mark.parametrize(
    ("statement", "code", "text"),
    [
        ("sys.exit(3)", 3, "sys.exit(3)"),
        ("sys.exit('no\\nhand')", 1, "no hand"),
        ("raise KeyboardInterrupt", 0, "KeyboardInterrupt"),
    ],
)
def test_a_served_method(
    arm: Built, start: Start, ice: Any, slices: None, port: int, statement: str, code: int, text: str
) -> None:
    """The caller gets an error at once, and the component ends."""
    import Ice

    write(arm, f"    def Arm_block(self, seconds):\n        {statement}\n")
    running = start(arm.command).wait_for("ArmComp is running")
    with pytest.raises(Ice.UnknownException, match="Arm_block: .*") as caught:
        proxy(ice, port).block(1)
    assert text in caught.value.unknown
    assert running.exit_code(2) == code
    assert "Traceback" not in running.output and "ends anyway" not in running.output


def test_a_call_that_came_early(arm: Built, start: Start, ice: Any, slices: None, port: int) -> None:
    """It is executed in the worker's thread, after initialize()."""
    methods = "    def initialize(self):\n        print('busy')\n        time.sleep(1)\n"
    write(arm, f"{methods}    def Arm_block(self, seconds):\n        sys.exit(3)\n")
    running = start(arm.command).wait_for("busy")
    call = proxy(ice, port).blockAsync(1)
    assert "sys.exit(3)" in call.exception(5).unknown
    assert running.exit_code(2) == 3


def test_a_served_method_with_another(arm: Built, start: Start, ice: Any, slices: None, port: int) -> None:
    import Ice

    write(arm, "    def Arm_block(self, seconds):\n        raise GeneratorExit('over')\n")
    running = start(arm.command).wait_for("ArmComp is running")
    with pytest.raises(Ice.UnknownException, match="Arm_block: GeneratorExit: over"):
        proxy(ice, port).block(1)
    running.wait_for("Arm_block() failed")
    assert running.stop() == 0


def test_a_listener_in_a_thread_of_ice(
    build: Build, start: Start, ice: Any, behavior: Any, free_port: Ports, slices: None
) -> None:
    built = build({**INTERFACES, "a/a.cdsl.yaml": cdsl("One")})["One"]
    served = free_port()
    built.configure({"CommonBehavior.Endpoints": f"tcp -h 127.0.0.1 -p {served}"})
    write(built, "    def initialize(self):\n        self.parameters.listen(lambda change: sys.exit('too fast'))\n")
    running = start(built.command).wait_for("One is running")
    behavior(served).setPeriod(30)
    assert running.exit_code(2) == 1
    assert "ERROR One: too fast\n" in running.output


def test_a_topic(build: Build, start: Start, icestorm: Storm, free_port: Ports) -> None:
    """A subscriber exits: the subscription is cancelled as on any stop."""
    keys: dict[str, Any] = {"publishes": ["ArmEvents"], "subscribes": ["ArmEvents"], "period": "50 ms"}
    built = build({**INTERFACES, "a/a.cdsl.yaml": cdsl("One", **keys)})["One"]
    name = f"Exit{free_port()}"
    built.configure({"TopicManager.Proxy": icestorm.manager, "ArmEvents": name})
    methods = "    def compute(self):\n        self.armevents_proxy.count(1)\n"
    write(built, f"{methods}    def ArmEvents_count(self, n):\n        sys.exit(9)\n")
    running = start(built.command)
    assert running.exit_code() == 9, running.output
    assert "ends anyway" not in running.output


MACHINE: dict[str, Any] = {
    "period": "20 ms",
    "statemachine": {
        "initial": "outer",
        "states": {"outer": {"initial": "first", "states": {"first": {"entry": {"raise": "go"}}, "second": {}}}},
        "transitions": {"first": {"to": "second", "event": "go"}},
    },
}
SAYS = "".join(
    f"    def sm_{name}_exit(self):\n        print('left {name}', flush=True)\n{{{name}}}"
    for name in ("outer", "first", "second")
)


@pytest.mark.parametrize("hook", ["sm_outer", "sm_first", "sm_second", "sm_second_period", "compute", "first_exit"])
def test_a_state_machine(build: Build, start: Start, hook: str) -> None:
    """All states that are active are left, each once."""
    built = build({**INTERFACES, "a/a.cdsl.yaml": cdsl("One", **MACHINE)})["One"]
    built.configure({})
    more = {"outer": "", "first": "", "second": ""}
    methods = "".join(f"    def sm_{name}(self): pass\n" for name in more)
    if hook == "first_exit":
        more["first"] = "        sys.exit(8)\n"
    else:
        methods += f"    def {hook}(self):\n        sys.exit(8)\n"
    write(built, methods + SAYS.format(**more))
    running = start(built.command)
    assert running.exit_code() == 8, running.output
    left = [line.partition(" ")[2] for line in running.output.splitlines() if line.startswith("left ")]
    expected = {"sm_outer": ["outer"], "sm_first": ["first", "outer"], "first_exit": ["first", "outer"]}
    assert left == expected.get(hook, ["first", "second", "outer"])
    assert "Traceback" not in running.output


def test_a_state_machine_that_exits_while_it_stops(build: Build, start: Start) -> None:
    built = build({**INTERFACES, "a/a.cdsl.yaml": cdsl("One", **MACHINE)})["One"]
    built.configure({})
    methods = "".join(
        f"    def sm_{name}(self): print('in {name}', flush=True)\n" for name in ("outer", "first", "second")
    )
    write(built, methods + SAYS.format(outer="", first="", second="        sys.exit(8)\n"))
    running = start(built.command).wait_for("in second")
    assert running.stop() == 8
    assert "left outer" in running.output and running.output.count("left second") == 1
