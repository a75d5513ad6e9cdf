"""The case study, from an empty folder in at most ten commands: SpeechComp in Python speaks and moves the mouth of
MouthComp in C++, which drives the motor of JointMotorComp in Python; then a proxy, a parameter and a method are added.

What is not a command is edited: documents, and code in `src/`. The CPU time is that of all commands. What only the test
asks for is not counted: addresses, and whether the change has arrived.
"""

from __future__ import annotations

import json
import resource
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from conftest import write_tree
from cpp_programs import needs_cpp
from processes import kill_left

pytestmark = [pytest.mark.slow, needs_cpp]

COMMANDS = 10
CPU = 120.0  # seconds: two C++ builds of one component, with the run time in the user's cache or not

INTERFACES = {
    "interfaces/Speech.idsl.yaml": """\
module: RoboCompSpeech
interfaces:
  Speech:
    methods:
      say: {in: {text: string}, returns: int}
""",
    "interfaces/Mouth.idsl.yaml": """\
module: RoboCompMouth
interfaces:
  Mouth:
    methods:
      open: {in: {width: float}, returns: float}
""",
    "interfaces/JointMotor.idsl.yaml": """\
module: RoboCompJointMotor
interfaces:
  JointMotor:
    methods:
      move: {in: {joint: string, position: float}}
      position: {in: {joint: string}, returns: float}
""",
}
DEPLOYMENT = """\
deployment: Head
components:
  narrator: {component: components/speechcomp}
  lips: {component: components/mouthcomp}
  jaw: {component: components/jointmotorcomp}
"""
LOOK = """\
import sys, Ice
Ice.loadSlice("", ["-Islice", "--all", "slice/Speech.ice", "slice/Mouth.ice"])
import RoboCompMouth, RoboCompSpeech
with Ice.initialize(["--Ice.Default.InvocationTimeout=10000"]) as ice:
    speech = RoboCompSpeech.SpeechPrx.checkedCast(ice.stringToProxy(sys.argv[1]))
    print(*map(speech.say, sys.argv[2:]))
"""


class Case:
    """The folder of the case study. It counts commands, and the CPU time that they take."""

    def __init__(self, root: Path) -> None:
        self.root, self.commands = root, list[tuple[str, float]]()

    def run(self, *words: str) -> str:
        """The output of a command of rcyaml."""
        return self._run(" ".join(words), [sys.executable, "-m", "robocomp_yaml", *words])

    def look(self, proxy: str, *texts: str) -> str:
        """What a client outside of the network gets."""
        return self._run("look", [sys.executable, "look.py", proxy, *texts])

    def _run(self, name: str, command: list[str]) -> str:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run(command, cwd=self.root, capture_output=True, text=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        self.commands.append((name, cpu))
        assert done.returncode == 0, f"{name}:\n{done.stdout}{done.stderr}"
        return done.stdout

    def edit(self, path: str, old: str, new: str) -> None:
        file = self.root / path
        text = file.read_text()
        assert text.count(old) == 1, f"{old!r} in {path}:\n{text}"
        file.write_text(text.replace(old, new))

    def proxy(self, name: str) -> str:
        """The proxy of a running process's first interface, which `deploy status` also shows."""
        words = [sys.executable, "-m", "robocomp_yaml", "deploy", "status", "--format", "json"]
        status = json.loads(subprocess.run(words, cwd=self.root, capture_output=True, check=True).stdout)
        served = next(one for one in status["processes"] if one["name"] == name)["endpoints"][0]
        return f"{served['identity']}:{served['endpoint']}"


@pytest.fixture
def case(tmp_path: Path) -> Iterator[Case]:
    yield Case(tmp_path)
    kill_left(str(tmp_path / ".rcyaml" / "deployments" / "Head"))


def test_from_an_empty_folder_in_ten_commands(case: Case) -> None:
    pytest.importorskip("Ice", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    case.run("new", "interface", "Speech", "Mouth", "JointMotor")
    write_tree(case.root, {**INTERFACES, "head.ddsl.yaml": DEPLOYMENT, "look.py": LOOK})
    case.run("new", "component", "SpeechComp", "--implements", "Speech", "--requires", "Mouth")
    case.run("new", "component", "MouthComp", "--language", "cpp", "--implements", "Mouth", "--requires", "JointMotor")
    case.run("new", "component", "JointMotorComp", "--implements", "JointMotor")
    case.run("compile")
    write_the_code(case)
    assert case.run("deploy", "up", "--build").endswith("Head: 3 processes as desired\n")
    assert case.look(case.proxy("narrator"), "Hello", "I am Shelly") == "5 11\n"

    change_the_documents(case)
    case.run("compile", "--merge")
    change_the_code(case)
    assert case.run("deploy", "up", "--build").endswith("Head: 3 processes as desired\n")
    subprocess.run(
        [sys.executable, "look.py", case.proxy("narrator"), "Hello"],
        cwd=case.root,
        check=True,
        stdout=subprocess.DEVNULL,
    )
    logs = subprocess.run(
        [sys.executable, "-m", "robocomp_yaml", "deploy", "logs", "narrator"],
        cwd=case.root,
        capture_output=True,
        text=True,
    ).stdout
    assert "smiles with 2.5; the motor is at 7.5" in logs
    case.run("deploy", "down")

    table = "\n".join(f"{cpu:6.2f} s  {name}" for name, cpu in case.commands)
    print(f"\n{table}")
    assert len(case.commands) <= COMMANDS, table
    assert sum(cpu for _, cpu in case.commands) < CPU, table


def write_the_code(case: Case) -> None:
    """Each component gets what it is for."""
    speech, motor = "components/speechcomp/src/specificworker.py", "components/jointmotorcomp/src/specificworker.py"
    case.edit(
        speech,
        'self.log.info("Speech_say() is still to be written")\n        return 0',
        "return round(self.mouth_proxy.open(len(text)))",
    )
    case.edit(motor, 'self.log.info("initializing")', "self.positions = {}")
    case.edit(motor, 'self.log.info("JointMotor_move() is still to be written")', "self.positions[joint] = position")
    case.edit(
        motor, 'self.log.info("JointMotor_position() is still to be written")\n        return 0.0', "return self.positions[joint]",
    )  # fmt: skip
    case.edit(
        "components/mouthcomp/src/specificworker.cpp",
        'float SpecificWorker::Mouth_open(float /*width*/)\n{\n    log.info("Mouth_open() is still to be written");\n    return {};',
        'float SpecificWorker::Mouth_open(float width)\n{\n    jointmotor_proxy->move("jaw", width);\n    return jointmotor_proxy->position("jaw");',
    )


def change_the_documents(case: Case) -> None:
    """A method of Mouth, a parameter of MouthComp, and a proxy of SpeechComp."""
    case.edit("interfaces/Mouth.idsl.yaml", "returns: float}\n", "returns: float}\n      smile: {returns: float}\n")
    case.edit(
        "components/speechcomp/speechcomp.cdsl.yaml", "imports: [Speech, Mouth]", "imports: [Speech, Mouth, JointMotor]"
    )
    case.edit("components/speechcomp/speechcomp.cdsl.yaml", "requires: [Mouth]", "requires: [Mouth, JointMotor]")
    write_tree(case.root, {
        "components/mouthcomp/mouthcomp.pdsl.yaml":
            "component: mouthcomp.cdsl.yaml\nparameters:\n  smile: {type: float, range: [0, 10], default: 2.5}\n",
    })  # fmt: skip


def change_the_code(case: Case) -> None:
    case.edit(
        "components/mouthcomp/src/specificworker.cpp",
        'log.info("Mouth_smile() is still to be written");\n    return {};',
        'jointmotor_proxy->move("jaw", 3 * parameters.smile());\n    return parameters.smile();',
    )
    case.edit(
        "components/speechcomp/src/specificworker.py", "return round(",
        'self.log.info("smiles with %s; the motor is at %s", self.mouth_proxy.smile(), self.jointmotor_proxy.position("jaw"))\n'
        "        return round(",
    )  # fmt: skip
