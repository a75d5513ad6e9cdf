"""Parameters of a running component, in each language: read from the config, listed and changed by another process."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

import of_languages
from components import Built, build
from conftest import ROOT
from processes import Ports, Running, Start, until

PDSL = """\
types:
  Mode: {enum: [slow, fast]}
  Motor:
    struct:
      name: string
      min: {type: float, range: [-3.15, 3.15], unit: rad}
      max: {type: float, range: [-3.15, 3.15], unit: rad}
      vel: {type: float, range: [0, 2], default: 0.9, unit: rad/s}
parameters:
  mode: {type: Mode, default: slow, editable: true}
  device: {type: string, default: /dev/tty}
  basicPeriod: {type: int, range: [1, 1000], unit: ms, default: 220, editable: true}
  token: {type: string, optional: true}
  gains: {list: double, default: [0.5], editable: true}
  offsets: {map: float, default: {}, editable: true}
  motors: {list: Motor, size: [1, 4], editable: true}
  Yolo: {group: {useGpu: {type: bool, default: true, editable: true}}}
  pin: {type: int, range: [1000, 9999], secret: true, optional: true, editable: true}
  locks: {list: string, unique: true, secret: true, optional: true, editable: true}
  password: {type: string, pattern: "[a-z0-9]+", optional: true, editable: true}
  server: {type: string, optional: true, editable: true}
  door: {type: string, values: [unter2, sesame], secret: true, optional: true}
  speed: {type: Mode, secret: true, optional: true}
constraints:
  - {that: "all(m.min < m.max for m in motors)", else: a motor's min must be below its max}
legacy:
  device: Arm.Device
  period.compute: Period.Compute
  motors: {key: "Arm.M{i}", columns: [name, min, max, vel], count: Arm.NumMotors}
"""
CDSL = "component: ParaComp\nlanguage: {language}\nparameters: para.pdsl.yaml\nperiod: 20 ms\n"
CONFIG = {
    "Arm.Device": "/dev/usb", "Arm.NumMotors": "2", "Arm.M0": "a, -1, 1, .5", "Arm.M1": "b,0,1,2",
    "token": "${env:PARA_TOKEN}", "offsets.keys": "x y%2Ez", "offsets.x": "1", "offsets.y%2Ez": "2.5e0",
}  # fmt: skip
FIRST = "[-] slow /dev/usb 220 s3cret#1 1 a:0.5 b:2 3.5 1 20"


@dataclass(frozen=True)
class Component:
    built: Built
    folder: Path
    port: int

    @property
    def config(self) -> Path:
        return self.folder / "my.config"

    def write(self, **changes: str | None) -> None:
        """The config; '_' in keys stands for '.'; None removes a property."""
        held = {**CONFIG, "CommonBehavior.Endpoints": f"tcp -h 127.0.0.1 -p {self.port}"}
        for key, value in changes.items():
            held[key.replace("_", ".")] = value  # type: ignore[assignment]
        lines = [f"{key} = {value}\n" for key, value in held.items() if value is not None]
        self.config.write_text("".join(lines))

    def run(self, start: Start, *options: str) -> Running:
        return start([*self.built.command, self.config, *options], env={"PARA_TOKEN": "s3cret#1"})


LANGUAGES = of_languages.each()


@pytest.fixture(scope="module", params=LANGUAGES)
def built(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Built:
    folder = tmp_path_factory.mktemp(request.param)
    documents = {"para.pdsl.yaml": PDSL, "para.cdsl.yaml": CDSL.format(language=request.param)}
    made = build(documents, folder)["ParaComp"]
    spoken = of_languages.spoken(request.param)
    (made.root / spoken.worker).write_text(spoken.parameters)
    spoken.build(made.root)
    return made


@pytest.fixture
def component(built: Built, tmp_path: Path, free_port: Ports) -> Component:
    made = Component(built, tmp_path, free_port())
    made.write()
    return made


Ask = Callable[[int], Any]


def changed(asked: Any, **changes: str) -> dict[str, Any]:
    """The parameter list with other values; '_' in keys stands for '.'."""
    listed = asked.getParameterList()
    made = type(next(iter(listed.values())))
    for key, value in changes.items():
        listed[key.replace("_", ".")] = made(True, value, "")
    return listed


def test_values_of_the_config(component: Component, start: Start) -> None:
    component.run(start).wait_for(FIRST)


def test_robocomps_spelling_of_the_period(component: Component, start: Start) -> None:
    component.write(Period_Compute="30")
    running = component.run(start).wait_for("ParaComp is running")
    assert f"{FIRST[:-2]}30\n" in running.output
    assert "WARNING" not in running.output


def test_the_command_line_has_the_last_word(component: Component, start: Start) -> None:
    options = ["--motors.0.vel=1", "--Arm.Device=/dev/a#b=c\\d", "--basicPeriod=1e", "--basicPeriod=30"]
    component.run(start, *options).wait_for("[-] slow /dev/a#b=c\\d 30 s3cret#1 1 a:1 b:2")


@pytest.mark.parametrize(
    ("option", "said"),
    [
        ("--basicPeriod=2000", "basicPeriod is 2000 ms, and must be from 1 to 1000 ms"),
        ("--basicPeriod=soon", "basicPeriod must be a whole number (ms), and is 'soon'"),
        ("--motors.1.vel=2.5", "motors[1].vel is 2.5 rad/s, and must be from 0 to 2 rad/s"),
        ("--mode=fst", "mode is 'fst', and must be one of slow, fast"),
        ("--Arm.NumMotors=0", "motors has 0 elements, and must have 1 to 4"),
        ("--motors.0.min=2", "a motor's min must be below its max"),
        (
            "--token=${env:NOBODY_HAS_THIS}",
            "token comes from the environment variable NOBODY_HAS_THIS, which is not set",
        ),
    ],
)
def test_it_does_not_start_with_wrong_values(component: Component, start: Start, option: str, said: str) -> None:
    running = component.run(start, option)
    assert running.exit_code() == 1
    (line,) = running.output.splitlines()
    assert line.endswith(f"ERROR ParaComp: {option.partition('=')[0]} on the command line: {said}")


def test_file_and_options_are_distinguished(component: Component, start: Start) -> None:
    component.write(basicPeriod="2000", Arm_M0="a,-1,1,.5")
    running = component.run(start, "--motors.0.vel=9", "--mode=fast")
    assert running.exit_code() == 1
    said = "basicPeriod is 2000 ms, and must be from 1 to 1000 ms; motors[0].vel is 9 rad/s, and must be from 0 to 2"
    where = f"{component.config} and --motors.0.vel on the command line"
    assert f"2 parameters have invalid values in {where}: {said} rad/s\n" in running.output


def test_a_file_that_is_wrong_by_itself(component: Component, start: Start) -> None:
    component.write(basicPeriod="2000")
    running = component.run(start, "--mode=fast")
    assert running.exit_code() == 1
    assert f"ParaComp: {component.config}: basicPeriod is 2000 ms" in running.output


def test_options_that_do_not_fit_together(component: Component, start: Start) -> None:
    running = component.run(start, "--motors.0.min=2", "--motors.0.max=1.5", "--mode=fast")
    assert running.exit_code() == 1
    assert "ParaComp: --motors.0.min on the command line: a motor's min must be below its max" in running.output


def test_a_misspelled_property_is_reported(component: Component, start: Start) -> None:
    component.write(motors_0_speed="1", offsets_z="1", other_thing="1")
    options = ["--motors.0.velo=1", "--moters.0.vel=1", "--BasicPeriod=1", "--bsaicPeriod=1", "--Ice.Trace.Network=0"]
    running = component.run(start, *options, "--Endpoints.Arm=", "--basics=1").wait_for("ParaComp is running")
    for key in ("motors.0.speed", "offsets.z"):
        running.wait_for(f"WARNING ParaComp: {component.config}: unknown parameter '{key}'")
    running.wait_for("WARNING ParaComp: --motors.0.velo on the command line: unknown parameter 'motors.0.velo'")
    for key, meant in (("moters.0.vel", "motors"), ("BasicPeriod", "basicPeriod"), ("bsaicPeriod", "basicPeriod")):
        where = f"WARNING ParaComp: --{key} on the command line: "
        running.wait_for(f"{where}unknown parameter '{key}' (did you mean '{meant}'?)")
    assert running.output.count("unknown parameter") == 6


def test_no_half_of_a_change_is_seen_by_another_thread(component: Component, start: Start) -> None:
    component.write(Arm_Device="/dev/race")
    output = component.run(start).wait_for("seen:").wait_for("ParaComp is running").output
    (seen,) = (line for line in output.splitlines() if line.startswith("seen:"))
    assert {*seen.removeprefix("seen: | ").split(" | ")} == {"0.5 0.5 0.5 0.5", "1 1 1 1"}, "both, whole"


def test_the_list_of_parameters(component: Component, start: Start, behavior: Ask) -> None:
    component.run(start).wait_for("ParaComp is running")
    listed = behavior(component.port).getParameterList()
    got = {key: (entry.editable, entry.value, entry.type) for key, entry in listed.items()}
    assert got["basicPeriod"] == (True, "220", "int")
    assert got["mode"] == (True, "slow", "Mode")
    assert got["device"] == (False, "/dev/usb", "string")
    assert got["motors.1.vel"] == (True, "2.0", "float")
    assert (got["gains.size"], got["gains.0"]) == ((True, "1", "int"), (True, "0.5", "double"))
    assert got["offsets.y%2Ez"] == (True, "2.5", "float")
    assert got["Yolo.useGpu"] == (True, "true", "bool")
    assert got["token"] == (False, "${env:PARA_TOKEN}", "string"), "no secret is shown"
    assert (got["period.compute"], got["period.emergency"]) == ((True, "20", "int"), (True, "500", "int"))
    assert got["CommonBehavior.Endpoints"] == (False, f"tcp -h 127.0.0.1 -p {component.port}", "string")
    assert not {key for key in got if key.startswith("Arm.")}, "they are read, and listed by their paths"


def test_changes_from_another_process(component: Component, start: Start, behavior: Ask) -> None:
    running = component.run(start).wait_for("ParaComp is running")
    asked = behavior(component.port)
    asked.setParameterList(changed(asked, basicPeriod="50", mode="fast", motors_1_vel="0.25"))
    running.wait_for("[mode,basicPeriod,motors[1].vel] fast /dev/usb 50 s3cret#1 1 a:0.5 b:0.25 3.5 1 20")
    asked.setParameterList(changed(asked, gains_size="2", gains_1="7", Yolo_useGpu="False", period_compute="33"))
    running.wait_for("[gains,Yolo.useGpu,period.compute] fast /dev/usb 50 s3cret#1 2 a:0.5 b:0.25 3.5 0 33")
    assert asked.getPeriod() == 33
    asked.setPeriod(44)
    running.wait_for("[period.compute] fast")
    asked.setParameterList(changed(asked, basicPeriod="9"))
    running.wait_for("[basicPeriod] fast /dev/usb 10 ")  # by a listener


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("basicPeriod", "0", "basicPeriod is 0 ms, and must be from 1 to 1000 ms"),
        ("basicPeriod", "", "basicPeriod must be a whole number (ms), and is ''"),
        ("motors_0_min", "1", "a motor's min must be below its max"),
        ("device", "/dev/x", "device cannot be changed while the component runs: it is not editable"),
        ("motors_9_vel", "1", "unknown parameter 'motors.9.vel'"),
        ("CommonBehavior_Endpoints", "tcp", "unknown parameter 'CommonBehavior.Endpoints'"),
        ("gains_size", "-1", "gains must be a list, and is '-1'"),
    ],
)
def test_a_bad_value_is_rejected_and_all_others_with_it(
    component: Component, start: Start, behavior: Ask, key: str, value: str, said: str
) -> None:
    running = component.run(start).wait_for("ParaComp is running")
    asked = behavior(component.port)
    before = asked.getParameterList()
    asked.setParameterList(changed(asked, **{"mode": "fast", key: value}))
    running.wait_for(f"WARNING ParaComp: setParameterList rejected: {said}")
    assert asked.getParameterList() == before
    assert "[mode" not in running.output


def test_the_users_code_is_rejected_too(component: Component, start: Start, behavior: Ask) -> None:
    running = component.run(start).wait_for("ParaComp is running")
    asked = behavior(component.port)
    asked.setParameterList(changed(asked, basicPeriod="7"))
    running.wait_for("refused: motors[0].vel is 9")
    assert asked.getParameterList()["basicPeriod"].value == "7", "all, or none"


def test_reading_the_config_again(component: Component, start: Start, behavior: Ask) -> None:
    running = component.run(start, "--mode=fast").wait_for("ParaComp is running")
    asked = behavior(component.port)
    component.write(basicPeriod="77", mode="slow", Arm_M0="a,-1,1,.75")
    asked.reloadConfig()
    running.wait_for("[basicPeriod,motors[0].vel] fast /dev/usb 77 s3cret#1 1 a:0.75 b:2")
    component.write(basicPeriod="78", Arm_M0="a,-1,1,9")
    asked.reloadConfig()
    running.wait_for("reloadConfig rejected: ").wait_for("motors[0].vel is 9 rad/s, and must be from 0 to 2 rad/s")
    component.write(basicPeriod="78", Arm_Device="/dev/other")
    asked.reloadConfig()
    running.wait_for("device cannot be changed while the component runs: it is not editable")
    assert asked.getParameterList()["basicPeriod"].value == "77"
    component.config.unlink()
    asked.reloadConfig()
    until(lambda: running.output.count("reloadConfig rejected") == 3, "the third refusal")
    assert asked.getParameterList()["basicPeriod"].value == "77"


SAFE = {"Arm_Device": "/dev/safe", "pin": "4711", "locks_0": "oak", "locks_1": "elm", "password": "hunter2",
        "server": "http://bob:beech@there/x", "Mail_Password": "birch", "Mail_Url": "imap://bob:larch@there"}  # fmt: skip
SECRETS = ("4711", "oak", "elm", "hunter2", "beech", "birch", "larch")


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--pin=17",), "pin is ***, and must be from 1000 to 9999"),
        (("--pin=hunter2",), "pin must be a whole number, and is ***"),
        (("--locks.0=hunter2", "--locks.1=hunter2"), "locks contains *** twice"),
        (("--password=HUNTER2",), "password is ***, and must match [a-z0-9]+"),
        (("--door=unter2x",), "door is ***, and must be one of the 2 values allowed"),
        (("--speed=unter2",), "speed is ***, and must be one of the 2 values allowed"),
        (
            ("--pin=${file:/nowhere/pin}",),
            "comes from the file /nowhere/pin, which cannot be read: No such file or directory",
        ),
        (("--mode=${file:/}",), "mode is '${file:/}', and must be one of slow, fast"),
        (("--mode=${file:/etc}",), "mode comes from the file /etc, which is not a regular file"),
        (("--mode=${file:/dev/zero}",), "mode comes from the file /dev/zero, which is not a regular file"),
    ],
)
def test_a_secret_that_is_wrong_is_not_shown(
    component: Component, start: Start, options: tuple[str, ...], said: str
) -> None:
    running = component.run(start, *options)
    assert running.exit_code() == 1
    assert said in running.output
    assert "unter2" not in running.output and "17," not in running.output and "HUNTER2" not in running.output


def test_secrets_are_hidden_in_the_list(component: Component, start: Start, behavior: Ask) -> None:
    component.write(**SAFE)
    component.run(start).wait_for("ParaComp is running")
    listed = {key: entry.value for key, entry in behavior(component.port).getParameterList().items()}
    hidden = ("pin", "locks.0", "locks.1", "password", "Mail.Password")
    assert [listed[key] for key in hidden] == ["***"] * 5
    assert (listed["locks.size"], listed["server"]) == ("2", "http://bob:***@there/x")
    assert listed["Mail.Url"] == "imap://bob:***@there"
    assert not [key for key, value in listed.items() for secret in SECRETS if secret in value]


def test_what_is_hidden_stays_when_it_comes_back(component: Component, start: Start, behavior: Ask) -> None:
    component.write(**SAFE)
    running = (
        component.run(start).wait_for("safe: 4711 oak elm hunter2 http://bob:beech@there/x").wait_for("is running")
    )
    asked = behavior(component.port)
    asked.setParameterList(changed(asked, basicPeriod="50"))
    running.wait_for("[basicPeriod] ").wait_for("parameters changed by setParameterList: basicPeriod\n")
    until(lambda: running.output.count("safe: 4711 oak elm hunter2 http://bob:beech@there/x\n") == 2, "all as before")
    asked.setParameterList(changed(asked, pin="8000"))
    running.wait_for("parameters changed by setParameterList: pin\n")
    asked.setParameterList(changed(asked, locks_1="ash"))
    running.wait_for("safe: 8000 oak ash hunter2 http://bob:beech@there/x\n")
    running.wait_for("parameters changed by setParameterList: locks.1\n")
    for key, value in (("locks_2", "***"), ("server", "http://bob:***@elsewhere")):
        asked.setParameterList(changed(asked, locks_size="3" if key == "locks_2" else "2", **{key: value}))
        running.wait_for(f"rejected: {key.replace('_', '.')} cannot be ***, which is shown instead of a secret")
    told = [line for line in running.output.splitlines() if not line.startswith("safe:")]
    assert not [line for line in told for secret in (*SECRETS, "ash", "8000") if secret in line]


@pytest.mark.parametrize(
    ("content", "told"),
    [(b"s3cret", "s3cret"), (b"s3cret\n", "s3cret"), (b"s3cret\r\n", "s3cret"), ("schön".encode(), "schön"), (b"", "")],
)
def test_a_value_from_a_file(component: Component, start: Start, content: bytes, told: str) -> None:
    (component.folder / "a b").mkdir()
    (component.folder / "a b" / "key").write_bytes(content)
    component.write(token="${file:a b/key}")
    component.run(start).wait_for(f"[-] slow /dev/usb 220 {told} 1 a:0.5")


def test_any_plain_value_can_come_from_a_file(component: Component, start: Start, behavior: Ask) -> None:
    (component.folder / "period").write_text("77\n")
    (component.folder / "vel").write_text("1.25")
    component.write(basicPeriod="${file:period}", Arm_M1="b,0,1,${file:./vel}")
    running = component.run(start).wait_for("[-] slow /dev/usb 77 s3cret#1 1 a:0.5 b:1.25").wait_for("is running")
    asked = behavior(component.port)
    assert asked.getParameterList()["basicPeriod"].value == "${file:period}"
    (component.folder / "vel").unlink()
    asked.setParameterList(changed(asked, mode="fast"))  # references are not read again
    running.wait_for("[mode] fast /dev/usb 77")
    (component.folder / "vel").write_text("0.25")
    (component.folder / "period").write_text("88")
    asked.reloadConfig()
    running.wait_for("[mode,basicPeriod,motors[1].vel] slow /dev/usb 88 s3cret#1 1 a:0.5 b:0.25")


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"a\0b", "which contains a NUL character"),
        (b"x" * ((1 << 20) + 1), "which is larger than 1 MiB"),
        (b"\xff\xfe", "which is not in UTF-8"),
        (b"\xed\xa0\x80", "which is not in UTF-8"),
        (None, "which cannot be read: No such file or directory"),
    ],
)
def test_a_file_without_a_value(component: Component, start: Start, content: bytes | None, said: str) -> None:
    if content is not None:
        (component.folder / "key").write_bytes(content)
    component.write(token="${file:key}")
    running = component.run(start)
    assert running.exit_code() == 1
    assert (
        f"ParaComp: {component.config}: token comes from the file {component.folder / 'key'}, {said}\n"
        in running.output
    )


def test_a_value_in_a_file_is_judged_and_not_shown(component: Component, start: Start) -> None:
    (component.folder / "period").write_text("2000\n")
    component.write(basicPeriod="${file:period}")
    running = component.run(start)
    assert running.exit_code() == 1
    assert "basicPeriod is ${file:period} ms, and must be from 1 to 1000 ms" in running.output
    assert "2000" not in running.output


PAPER = ROOT / "examples" / "jointmotor"


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_papers_component(rcyaml: Callable[..., Any], tmp_path: Path, start: Start, language: str) -> None:
    """JointMotorComp of the paper: compiled with its values, it reads them."""
    shutil.copytree(PAPER, tmp_path, dirs_exist_ok=True)
    root, spoken = tmp_path / language, of_languages.spoken(language)
    if not root.is_dir():  # the example is in two languages
        shutil.copytree(tmp_path / "python", root, ignore=lambda *_: ["src"])
        document = root / "jointmotor.cdsl.yaml"
        document.write_text(document.read_text().replace("language: python", f"language: {language}"))
    result = rcyaml("compile", f"{language}/jointmotor.cdsl.yaml")
    assert result.exit_code == 0, result.output
    worker = root / spoken.worker
    worker.write_text(spoken.paper + spoken.stubs(worker.read_text()))
    spoken.build(root)
    (program,) = (root / "bin").glob("[!.]*")  # not the .gitignore
    running = start([*spoken.command(program), "--startup-check"])
    running.wait_for("Dunkermotoren /dev/ttyUSB0 115200 220 2\n")
    running.wait_for("dunker0 A 1 -3.14 3.14 0 0.9\ndunker1 B 0 -3.14 3.14 0 0.9\n")
    assert running.exit_code() == 0
