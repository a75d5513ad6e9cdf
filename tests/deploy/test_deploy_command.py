"""The command `rcyaml deploy`."""

from __future__ import annotations

import asyncio
import json
import os
import pty
import pwd
import re
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree
from processes import Ports, killed_on_failure, read_until, until
from robocomp_yaml.deploy.local import procfs
from robocomp_yaml.languages import language
from small_networks import Place
from terminals import foreign

ROBOT = """\
deployment: Robot
components:
  base:
    program: sh
    args: [-c, "echo hello; exec sleep 600"]
    ready: {log: hello}
  arm: {program: sleep, args: ["600"], after: [base]}
"""
FAILING = ROBOT + '  hand: {program: sh, args: [-c, "echo oh; exit 3"], after: [arm], restart: "no"}\n'

Rcyaml = Callable[..., Result]


@pytest.fixture
def robot(place: Place, tmp_path: Path, rcyaml: Rcyaml) -> Path:
    return write_tree(tmp_path, {"robot.ddsl.yaml": ROBOT})


def deploy(rcyaml: Rcyaml, what: str, *args: str) -> Result:
    return rcyaml("deploy", what, "robot.ddsl.yaml", *args)


def test_up_status_and_down(robot: Path, rcyaml: Rcyaml) -> None:
    assert deploy(rcyaml, "plan").stdout.endswith("2 to start\n")
    assert deploy(rcyaml, "up").stdout == "base  ready\narm   ready\nRobot: 2 processes as desired\n"
    assert deploy(rcyaml, "up").stdout == "Robot: nothing to do, 2 processes as desired\n"
    assert deploy(rcyaml, "plan").stdout == "nothing to do\n"
    status = deploy(rcyaml, "status")
    assert status.exit_code == 0
    assert [line.split()[:2] for line in status.stdout.splitlines()[1:]] == [["base", "ready"], ["arm", "ready"]]
    assert "base | hello\n" in deploy(rcyaml, "logs").stdout
    assert deploy(rcyaml, "restart", "arm").stdout == "arm   stopped\narm   ready\nRobot: 2 processes as desired\n"
    assert deploy(rcyaml, "down").stdout == "arm   stopped\nbase  stopped\n"
    assert deploy(rcyaml, "down").stdout == "Robot: nothing was running\n"


def test_down_of_what_does_not_run_names_it(robot: Path, rcyaml: Rcyaml) -> None:
    deploy(rcyaml, "up")
    assert deploy(rcyaml, "down", "arm").stdout == "arm   stopped\n"
    assert deploy(rcyaml, "down", "arm").stdout == "Robot: arm was not running\n", "base runs"
    assert deploy(rcyaml, "down").stdout == "base  stopped\n"
    assert deploy(rcyaml, "down", "arm", "base").stdout == "Robot: base, arm were not running\n"
    assert deploy(rcyaml, "down").stdout == "Robot: nothing was running\n"


COUNTS = """\
deployment: Robot
components:
  base: {program: sh, args: [-c, "for i in 1 2 3 4 5 6 7 8; do echo base $i; done; echo 'a b'; exec sleep 600"]}
  arm: {program: sh, args: [-c, "for i in 1 2 3 4 5 6 7 8; do echo arm $i; done; exec sleep 600"], after: [base]}
"""


def test_logs_since_a_time_and_with_a_pattern(robot: Path, rcyaml: Rcyaml) -> None:
    write_tree(robot, {"robot.ddsl.yaml": COUNTS})
    deploy(rcyaml, "up")
    until(lambda: "arm 8" in deploy(rcyaml, "logs").stdout, "the last line")
    assert deploy(rcyaml, "logs", "--grep", "[me] [57]$").stdout.splitlines() == [
        "base | base 5", "base | base 7", "arm  | arm 5", "arm  | arm 7",
    ]  # fmt: skip
    assert deploy(rcyaml, "logs", "--grep", "[me] [57]$", "-n", "1").stdout == "base | base 7\narm  | arm 7\n"
    assert deploy(rcyaml, "logs", "base", "--grep", "nothing").stdout == ""
    every = deploy(rcyaml, "logs", "-n", "1000", "-t").stdout
    for since in ("1h", "2020-01-01", "2020-01-01T00:00:00Z", "90 min"):
        assert deploy(rcyaml, "logs", "--since", since, "-t").stdout == every
    assert deploy(rcyaml, "logs", "--since", "2100-01-01").stdout == ""
    last = every.splitlines()[-1].split()[0]
    assert every.splitlines()[-1] in deploy(rcyaml, "logs", "--since", last, "-t").stdout.splitlines()
    command = [sys.executable, "-m", "robocomp_yaml", "deploy", "logs", "-f", "--grep", "arm [12]$"]
    with killed_on_failure(subprocess.Popen(command, cwd=robot, stdout=subprocess.PIPE, text=True)) as following:
        assert following.stdout
        assert [following.stdout.readline() for _ in range(2)] == ["arm  | arm 1\n", "arm  | arm 2\n"]
        following.terminate()
    deploy(rcyaml, "down")


@pytest.mark.parametrize(
    ("args", "said"),
    [
        (("--grep", "("), "'(' is not a regular expression"),
        (("--since", "yesterday"), "neither a duration, such as 5min, nor a time, such as 10:30"),
    ],
)
def test_wrong_selections_of_lines(robot: Path, rcyaml: Rcyaml, args: tuple[str, ...], said: str) -> None:
    result = deploy(rcyaml, "logs", *args)
    assert result.exit_code == 2 and said in result.stderr


def test_cpu_and_hosts_in_the_output(robot: Path, rcyaml: Rcyaml, free_port: Ports) -> None:
    port = free_port()
    busy = f"import socket,time; s = socket.create_server(('127.0.0.1', {port})); sum(range(10**7)); time.sleep(600)"
    write_tree(robot, {"robot.ddsl.yaml": (
        "deployment: Robot\ncomponents:\n"
        f'  busy: {{program: python3, args: [-c, "{busy}"], endpoints: {{Laser: tcp -h 127.0.0.1 -p {port}}}}}\n'
    )})  # fmt: skip
    deploy(rcyaml, "up")
    (one,) = json.loads(deploy(rcyaml, "status", "--format", "json").stdout)["processes"]
    assert one["endpoints"][0]["host"] == "localhost" and one["endpoints"][0]["port"] == port and one["cpu"] > 0
    head, row = deploy(rcyaml, "status").stdout.splitlines()
    assert head.split()[-2:] == ["CPU", "SERVES"] and row.split()[-2] == "s" and float(row.split()[-3]) > 0
    deploy(rcyaml, "down")


def test_an_up_that_failed_leaves_no_supervisor(robot: Path, rcyaml: Rcyaml, place: Place) -> None:
    write_tree(robot, {"robot.ddsl.yaml": FAILING})
    deploy(rcyaml, "up")
    place.wait_gone()
    with_config = ROBOT.replace(
        "components:\n", "components:\n  hand: {program: cat, args: ['{config}'], config: hand.conf}\n"
    )
    write_tree(
        robot, {".rcyaml/deployments/Robot/state/next": "in the way", "robot.ddsl.yaml": with_config, "hand.conf": ""}
    )
    assert "error[RC7005]" in deploy(rcyaml, "up").stderr
    place.wait_gone()


def test_all_output_as_json(robot: Path, rcyaml: Rcyaml) -> None:
    def data(what: str, *args: str) -> dict[str, object]:
        return json.loads(deploy(rcyaml, what, *args, "--format", "json").stdout)

    plan = data("plan")["plan"]
    assert [(step["name"], step["action"]) for step in plan] == [("base", "start"), ("arm", "start")]
    result = {"ready": ["base", "arm"], "failed": [], "skipped": [], "undone": "", "not_restored": []}
    assert data("up")["result"] == result
    processes = data("status")["processes"]
    assert all(one["ready"] and one["pid"] > 1 and one["memory"] > 0 for one in processes)
    lines = deploy(rcyaml, "logs", "base", "--format", "json").stdout.splitlines()
    assert [json.loads(line)["text"] for line in lines][-1] == "hello"
    assert data("down", "base", "--dry-run") | {"deployment": "", "engine": ""} == {
        "deployment": "", "engine": "", "stop": ["arm", "base"], "reasons": {"arm": "it is after base"},
        "diagnostics": [],
    }  # fmt: skip
    said = deploy(rcyaml, "down", "base", "--dry-run").stdout
    assert said == "- arm   stop: it is after base\n- base  stop\n2 to stop\n"
    restarting = deploy(rcyaml, "restart", "arm", "--dry-run").stdout
    assert restarting.splitlines()[0] == "~ arm   restart: its restart was requested"
    assert all(one["ready"] for one in data("status")["processes"])  # nothing was done
    assert data("down")["stopped"] == ["arm", "base"]
    assert deploy(rcyaml, "down", "--dry-run").stdout == "nothing to do\n"


def test_a_plan_shows_each_changed_field(robot: Path, rcyaml: Rcyaml) -> None:
    deploy(rcyaml, "up")
    write_tree(robot, {"robot.ddsl.yaml": ROBOT.replace("[base]}", '[base], env: {SPEED: "2"}, restart: always}')})
    said = deploy(rcyaml, "plan").stdout
    assert said.splitlines()[0] == "~ arm   restart: env SPEED: 2 (new), and 1 more"
    assert said.splitlines()[-1] == "1 to restart, 1 to keep"
    (step,) = (
        step for step in json.loads(deploy(rcyaml, "plan", "--format", "json").stdout)["plan"] if step["name"] == "arm"
    )
    assert step["changes"][0] == {"field": "env SPEED", "old": "", "new": "2", "needs_restart": True}


def test_a_failure_is_reported_with_the_log(robot: Path, rcyaml: Rcyaml) -> None:
    write_tree(robot, {"robot.ddsl.yaml": FAILING})
    result = deploy(rcyaml, "up")
    assert result.exit_code == 1
    assert result.stdout.endswith("Robot: failed; the started processes were stopped\n")
    assert "error[RC7004]: 'hand' ended before it was ready: exit code 3" in result.stderr
    assert "robot.ddsl.yaml:8:3" in result.stderr and "hand | oh\n" in result.stderr
    assert deploy(rcyaml, "status").stdout.count("not started") == 3


def test_status_fails_if_a_process_does_not_run(robot: Path, rcyaml: Rcyaml) -> None:
    write_tree(robot, {"robot.ddsl.yaml": FAILING})
    assert deploy(rcyaml, "up", "--on-failure", "keep").exit_code == 1
    status = deploy(rcyaml, "status")
    assert status.exit_code == 1 and "given up: exit code 3" in status.stdout
    deploy(rcyaml, "down")


@pytest.mark.parametrize(
    ("args", "said"),
    [
        (("up", "."), "has no deployment document"),
        (("up", "robot.ddsl.yaml", "amr"), "has no process or group 'amr'; did you mean 'arm'?"),
        (("probe", "robot.ddsl.yaml", "moon"), "has no host 'moon'"),
        (("up", "nowhere.ddsl.yaml"), "does not exist"),
    ],
)
def test_wrong_usage(robot: Path, rcyaml: Rcyaml, args: tuple[str, ...], said: str) -> None:
    if args[1] == ".":
        (robot / "robot.ddsl.yaml").unlink()
    result = rcyaml("deploy", *args)
    assert result.exit_code == 2 and said in result.stderr


def test_a_document_with_errors_starts_nothing(robot: Path, rcyaml: Rcyaml) -> None:
    write_tree(robot, {"robot.ddsl.yaml": ROBOT.replace("[base]", "[bsae]")})
    result = deploy(rcyaml, "up")
    assert result.exit_code == 1 and "did you mean 'base'" in result.stdout
    assert not (robot / ".rcyaml").exists()


def test_a_component_that_is_not_compiled_has_a_hint(rcyaml: Rcyaml, tmp_path: Path) -> None:
    document = "deployment: Robot\ncomponents: {mouth: {component: mouth}}\n"
    component = "component: MouthComp\nlanguage: python\n"
    write_tree(tmp_path, {"robot.ddsl.yaml": document, "mouth/mouth.cdsl.yaml": component})
    told = deploy(rcyaml, "plan")
    assert told.exit_code == 1 and "`rcyaml compile mouth/mouth.cdsl.yaml` writes it" in told.stderr


def test_a_component_that_was_compiled_before_its_interface_changed(rcyaml: Rcyaml, tmp_path: Path) -> None:
    interface = "module: RoboCompMouth\ninterfaces: {Mouth: {methods: {open: }}}\n"
    component = "component: MouthComp\nlanguage: python\nimports: [../Mouth]\nimplements: [Mouth]\n"
    document = "deployment: Robot\ncomponents:\n  mouth{i}: {component: mouth, instances: 2}\n"
    tree = {"robot.ddsl.yaml": document, "Mouth.idsl.yaml": interface, "mouth/mouth.cdsl.yaml": component}
    write_tree(tmp_path, tree)
    assert rcyaml("compile").exit_code == 0
    assert deploy(rcyaml, "plan").stderr == ""
    write_tree(tmp_path, {"Mouth.idsl.yaml": interface.replace("open:", "close:")})
    told = deploy(rcyaml, "plan")
    assert told.exit_code == 0 and told.stderr.count("warning[RC7012]") == 1
    assert "'mouth0' was compiled before Mouth.idsl.yaml changed" in told.stderr
    assert "`rcyaml compile mouth/mouth.cdsl.yaml`" in told.stderr


def test_a_deployment_with_a_broken_document_can_be_stopped(robot: Path, rcyaml: Rcyaml) -> None:
    broken = {"robot.ddsl.yaml": ROBOT + "x: [\n"}
    write_tree(robot, broken)
    assert deploy(rcyaml, "down").exit_code == 1  # nothing runs of it
    write_tree(robot, {"robot.ddsl.yaml": ROBOT})
    deploy(rcyaml, "up")
    write_tree(robot, broken)
    status = deploy(rcyaml, "status")
    assert [line.split()[:2] for line in status.stdout.splitlines()[1:]] == [["base", "ready"], ["arm", "ready"]]
    assert (
        status.stderr == "robot.ddsl.yaml cannot be read (see `rcyaml check`): the running processes are used instead\n"
    )
    assert "base | hello\n" in deploy(rcyaml, "logs", "base").stdout
    assert deploy(rcyaml, "up").exit_code == 1
    assert deploy(rcyaml, "down", "arm").stdout == "arm   stopped\n"
    down = deploy(rcyaml, "down")
    assert (down.exit_code, down.stdout) == (0, "base  stopped\n")


def test_a_second_name_means_the_same_process(robot: Path, rcyaml: Rcyaml, free_port: Ports) -> None:
    more = f"  hand: {{process: arm, endpoints: {{Hand: tcp -p {free_port()}}}}}\n"
    write_tree(robot, {"robot.ddsl.yaml": ROBOT + more})
    result = deploy(rcyaml, "plan", "hand")
    assert result.stdout.endswith("2 to start\n"), result.output


def test_output_of_a_process_cannot_control_the_terminal(robot: Path, rcyaml: Rcyaml) -> None:
    script = r"printf '\033[31mred\033[0m \033]0;title\007 \033[2Jgone\n'; exec sleep 600"
    document = {"deployment": "Robot", "components": {"base": {"program": "sh", "args": ["-c", script]}}}
    write_tree(robot, {"robot.ddsl.yaml": json.dumps(document)})
    deploy(rcyaml, "up")
    until(lambda: "gone" in deploy(rcyaml, "logs").stdout, "the line")
    assert "\x1b" not in deploy(rcyaml, "logs").stdout
    colored = rcyaml("--color", "always", "deploy", "logs", "robot.ddsl.yaml").stdout
    assert r"\e[31mred\e[0m \e]0;title\a \e[2Jgone" in colored and not foreign(colored)
    deploy(rcyaml, "down")


def start(folder: Path, *args: str, **more: object) -> subprocess.Popen[bytes]:
    return subprocess.Popen([sys.executable, "-m", "robocomp_yaml", "deploy", *args], cwd=folder, **more)  # type: ignore[call-overload, no-any-return]


NEVER = ROBOT.replace("after: [base]}", "after: [base], ready: {log: never, within: 60 s}}")


def coming_up(robot: Path) -> subprocess.Popen[bytes]:
    """An `up` that waits for `arm`, which never becomes ready."""
    write_tree(robot, {"robot.ddsl.yaml": NEVER})
    up = start(robot, "up", "robot.ddsl.yaml", stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    assert up.stdout and up.stdout.readline() == b"base  ready\n"
    return up


def test_an_interrupted_up_leaves_processes_running(robot: Path, place: Place) -> None:
    up = coming_up(robot)
    until(lambda: place.pids().get("arm"), "arm is started")
    up.send_signal(signal.SIGINT)
    with up.stdout as rest:
        assert b"running processes keep running" in rest.read()
    assert up.wait(20) == 130
    assert all(place.pids().values())


def test_an_interrupted_up_is_said_in_json(robot: Path, place: Place) -> None:
    write_tree(robot, {"robot.ddsl.yaml": NEVER})
    up = start(robot, "up", "robot.ddsl.yaml", "--format", "json", stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    until(lambda: place.pids().get("arm"), "arm is started")
    up.send_signal(signal.SIGINT)
    with up.stdout as rest:
        assert "running processes keep running" in json.loads(rest.read())["interrupted"]
    assert up.wait(20) == 130


SLOW = """\
deployment: Robot
components:
  arm: {program: bash, args: [-c, "trap 'sleep 2; exit 0' TERM; echo up; while :; do sleep 0.1; done"], role: server, ready: {log: up}}
  base: {program: sleep, args: ["600"], role: server}
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_up_after_an_interrupted_down_waits_for_its_stops(
    robot: Path, place: Place, rcyaml: Rcyaml, number: int
) -> None:
    """Else it would find a process as desired that ends a moment later."""
    write_tree(robot, {"robot.ddsl.yaml": SLOW})
    deploy(rcyaml, "up")
    before = place.pids()
    down = start(robot, "down", "robot.ddsl.yaml", stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    with down.stdout as output:  # type: ignore[union-attr]
        assert output.readline() == b"base  stopped\n"
        down.send_signal(number)
        assert down.wait(20) == (130 if number == signal.SIGINT else -signal.SIGKILL)
    status = rcyaml("deploy", "status", "robot.ddsl.yaml")
    assert status.exit_code == 1 and "it is being stopped" in status.stdout
    assert "2 to start" in rcyaml("deploy", "plan", "robot.ddsl.yaml").stdout
    deploy(rcyaml, "up")
    after = place.pids()
    assert all(after.values()) and not {*before.values()} & {*after.values()}
    deploy(rcyaml, "down")


def test_up_after_a_killed_up(robot: Path, place: Place, rcyaml: Rcyaml) -> None:
    up = coming_up(robot)
    up.kill()
    up.stdout.close()
    up.wait(20)
    base = place.pids()["base"]
    write_tree(robot, {"robot.ddsl.yaml": ROBOT})
    assert deploy(rcyaml, "up").exit_code == 0
    assert place.pids()["base"] == base and place.observe()["arm"].state == "running"


def test_the_supervisor_is_killed_during_up(robot: Path, place: Place) -> None:
    up = coming_up(robot)
    os.kill(place.keeper_and_supervisor()[1], signal.SIGKILL)
    with up.stdout as rest:
        said = rest.read().decode()
    assert up.wait(20) == 1
    assert "error[RC7007]" in said and "Traceback" not in said
    place.wait_gone()


def test_an_attached_up_ends_with_ctrl_c(robot: Path, place: Place) -> None:
    attached = start(robot, "up", "robot.ddsl.yaml", "--attach", stdout=subprocess.PIPE)
    assert attached.stdout
    read_until(attached.stdout.fileno(), b"Ctrl-C stops it", b"base | hello")
    assert start(robot, "restart", ".", "arm").wait(60) == 0  # meanwhile others may work on it
    attached.send_signal(signal.SIGINT)
    with attached.stdout as rest:
        rest.read()
    assert attached.wait(20) == 130
    place.wait_gone()


def test_an_attached_up_is_interrupted_while_processes_start(robot: Path, place: Place) -> None:
    write_tree(robot, {"robot.ddsl.yaml": ROBOT.replace("ready: {log: hello}", "ready: {log: never, within: 60 s}")})
    attached = start(robot, "up", "robot.ddsl.yaml", "--attach", stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    assert attached.stdout
    read_until(attached.stdout.fileno(), b"base | hello")
    attached.send_signal(signal.SIGINT)
    with attached.stdout as rest:
        assert b"interrupted: all processes were stopped" in rest.read()
    assert attached.wait(20) == 130
    place.wait_gone()


def test_an_attached_up_ends_with_its_processes(robot: Path, rcyaml: Rcyaml, place: Place) -> None:
    write_tree(robot, {"robot.ddsl.yaml": "deployment: Robot\ncomponents:\n  a: {program: echo, args: [done]}\n"})
    result = deploy(rcyaml, "up", "--attach")
    assert result.exit_code == 0 and "a | done" in result.stdout
    place.wait_gone()


def test_an_attached_up_says_which_entry_was_given_up(robot: Path, rcyaml: Rcyaml, place: Place) -> None:
    entry = 'a: {program: sh, args: [-c, "sleep 1; exit 4"], restart: "no"}'
    write_tree(robot, {"robot.ddsl.yaml": f"deployment: Robot\ncomponents:\n  {entry}\n"})
    result = deploy(rcyaml, "up", "--attach")
    assert result.exit_code == 1 and "RC7009" in result.stderr and "─ robot.ddsl.yaml:3:3" in result.stderr
    place.wait_gone()


def test_logs_are_followed(robot: Path, rcyaml: Rcyaml) -> None:
    deploy(rcyaml, "up")
    following = start(robot, "logs", "robot.ddsl.yaml", "-f", "-n", "0", stdout=subprocess.PIPE)
    assert following.stdout
    os.set_blocking(following.stdout.fileno(), False)
    seen = b""

    def printed() -> bool:
        nonlocal seen
        deploy(rcyaml, "restart", "base")
        seen += following.stdout.read() or b""
        return b"base | hello" in seen

    until(printed, lambda: f"what the restarted one prints, in {seen!r}")
    following.send_signal(signal.SIGINT)
    following.stdout.close()
    following.wait(20)
    deploy(rcyaml, "down")


def test_on_a_terminal_the_user_chooses(robot: Path, place: Place) -> None:
    write_tree(robot, {"robot.ddsl.yaml": FAILING})
    ours, theirs = pty.openpty()
    up = start(robot, "up", "robot.ddsl.yaml", stdin=theirs, stdout=theirs, stderr=theirs)
    os.close(theirs)
    seen = read_until(ours, b"[stop]: ")
    text = seen.decode()
    assert "hand | oh" in text, "the log is shown before the question"
    assert re.search(r"arm +starting", text)
    os.write(ours, b"keep\n")
    try:
        while chunk := os.read(ours, 1000):
            seen += chunk
    except OSError:
        pass  # the other end is closed
    os.close(ours)
    assert up.wait(20) == 1
    assert b"the started processes keep running" in seen and seen.count(b"RC7004") == 1
    assert place.observe()["arm"].state == "running"
    place.down()


def test_an_address_that_does_not_resolve(robot: Path, rcyaml: Rcyaml) -> None:
    write_tree(
        robot,
        {"robot.ddsl.yaml": ROBOT.replace("components:", "hosts: {moon: {address: nowhere.invalid}}\ncomponents:")},
    )
    result = deploy(rcyaml, "up", "--engine", "local")
    assert result.exit_code == 1
    assert "error[RC7008]: 'base' runs on the host 'moon' (nowhere.invalid)" in result.stderr


@pytest.fixture
def of_another_user(robot: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """The name of the user whose deployment it is, for the one who calls the commands."""
    (robot / ".rcyaml" / "deployments" / "Robot").mkdir(parents=True)
    owner, access = os.getuid(), os.access
    monkeypatch.setattr(os, "getuid", lambda: owner + 1)
    monkeypatch.setattr(os, "access", lambda path, mode: "/deployments/" not in str(path) and access(path, mode))
    return pwd.getpwuid(owner).pw_name


UNREADABLE = "deployment: Robot\ncomponents: [\n"
WITHOUT_DOCUMENT = ["deploy status", "deploy logs", "deploy down", "top --count 2", "top --once"]


@pytest.mark.parametrize(
    ("command", "document"),
    [
        *((command, ROBOT) for command in ("deploy plan", "deploy up", *WITHOUT_DOCUMENT)),
        *((command, UNREADABLE) for command in WITHOUT_DOCUMENT),
    ],
)
def test_the_deployment_of_another_user(
    robot: Path, rcyaml: Rcyaml, of_another_user: str, command: str, document: str
) -> None:
    """`status` of another user does not say that nothing runs, whether the document can be read or not."""
    (robot / "robot.ddsl.yaml").write_text(document)
    failed = rcyaml(*command.split(), "robot.ddsl.yaml")
    assert failed.exit_code == 1 and "error[RC7005]" in failed.stderr and not failed.stdout
    assert f"it is of the user '{of_another_user}', who alone sees and changes what runs" in failed.stderr
    assert "documents: " not in failed.stderr, "they are not at fault"


def test_the_manager_of_the_deployment_of_another_user(robot: Path, of_another_user: str) -> None:
    from robocomp_yaml.manager.managed import ManagedDeployment
    from robocomp_yaml.manager.watching import Watcher

    watcher = Watcher(ManagedDeployment("robot.ddsl.yaml"))
    asyncio.run(watcher.begin())
    assert watcher.states == {} and f"it is of the user '{of_another_user}'" in watcher.problem


def test_only_one_command_changes_a_deployment_at_a_time(robot: Path, rcyaml: Rcyaml, place: Place) -> None:
    from robocomp_yaml.deploy import folder

    with folder.locked(place.folder):
        result = deploy(rcyaml, "up")
    assert result.exit_code == 1 and "another rcyaml is changing this deployment" in result.stderr
    assert procfs.marked(place.folder) == []


def test_a_host_is_probed_over_ssh(robot: Path, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch) -> None:
    """A fake `ssh` that runs the command on this machine."""
    document = ROBOT.replace("components:", "hosts:\n  arm: {address: 192.0.2.7, user: robot}\ncomponents:")
    fake = '#!/bin/sh\nfor last; do :; done\necho "$@" | head -1 > ssh.log\nexec sh -c "$last"\n'
    write_tree(robot, {"robot.ddsl.yaml": document, "bin/ssh": fake})
    (robot / "bin/ssh").chmod(0o755)
    monkeypatch.setenv("PATH", f"{robot}/bin:{os.environ['PATH']}")
    found = json.loads(deploy(rcyaml, "probe", "arm", "--format", "json").stdout)["hosts"]["arm"]
    assert [(one["program"], one["used_by"], bool(one["path"])) for one in found] == [
        ("sh", ["base"], True), ("sleep", ["arm"], True),
    ]  # fmt: skip
    assert "-- robot@192.0.2.7" in (robot / "ssh.log").read_text(encoding="utf-8")


def test_several_hosts_need_icegrid_too(robot: Path, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch) -> None:
    from robocomp_yaml.deploy.probe import NODE, ProgramQuery

    hosts = "hosts: {one: 127.0.0.1, two: 127.0.0.2}\ncomponents:\n"
    entries = "  a: {program: sh, host: one}\n  b: {program: sh, host: two}\n"
    write_tree(robot, {"robot.ddsl.yaml": f"deployment: Robot\n{hosts}{entries}"})
    result = deploy(rcyaml, "probe", "one", "--format", "json")
    assert [one["program"] for one in json.loads(result.stdout)["hosts"]["one"]] == ["sh", "icegridnode"]
    monkeypatch.setattr("robocomp_yaml.deploy.probe.programs", lambda network: {ProgramQuery("no-node"): (NODE,)})
    assert deploy(rcyaml, "probe", "one").exit_code == 1


def test_a_program_that_a_host_lacks(robot: Path, rcyaml: Rcyaml) -> None:
    write_tree(robot, {"robot.ddsl.yaml": ROBOT.replace("program: sleep", "program: no-such-sleep")})
    result = deploy(rcyaml, "probe")
    assert result.exit_code == 1 and "no-such-sleep  missing, or not executable, for arm" in result.stdout
    lines = result.stdout.splitlines()
    assert lines[0] == "localhost:" and re.search(
        r" sh +there, of \d{4}-\d\d-\d\d, digest [0-9a-f]+, for base$", result.stdout, re.MULTILINE
    )


def test_a_program_that_lacks_something(robot: Path, rcyaml: Rcyaml) -> None:
    programs = {
        "lost": "#!/usr/bin/env no-such-interpreter\n",
        "tool": "#!/usr/bin/env python3\nimport sys, no_such_module\n",
        "arm/bin/ArmComp": "#!/usr/bin/env python3\nfrom generated.main import main\n",
        "arm/src/worker.py": (
            "import sys\nsys.path.append('more')\nimport there, no_such.part\ntry:\n    import perhaps\n"
            "except ImportError:\n    pass\nimport Ice\nIce.loadSlice('X.ice')\nimport RoboCompX\n"
        ),
    }
    more = {"arm/generated/main.py": "", "more/there.py": "", "more/Ice.py": ""}
    started = [name for name in programs if not name.endswith(".py")]
    entries = "".join(f"  p{number}: {{program: ./{name}}}\n" for number, name in enumerate(started))
    write_tree(robot, {**programs, **more, "robot.ddsl.yaml": f"deployment: Robot\ncomponents:\n{entries}"})
    for name in started:
        (robot / name).chmod(0o755)
    (found,) = json.loads(deploy(rcyaml, "probe", "--format", "json").stdout)["hosts"].values()
    assert {os.path.relpath(one["program"], robot): one["missing"] for one in found} == {
        "lost": ["no-such-interpreter"], "tool": ["no_such_module"], "arm/bin/ArmComp": ["no_such"],
    }  # fmt: skip


OF_TWO_PYTHONS = """\
deployment: Robot
components:
  arm: {{program: ./arm/bin/ArmComp, env: {{RCYAML_PYTHON: "{0}"}}}}
  hand: {{program: ./arm/bin/ArmComp, env: {{RCYAML_PYTHON: "{0}"}}}}
  leg: {{program: ./arm/bin/ArmComp, env: {{RCYAML_PYTHON: "$(touch broken) 'x"}}}}
  wing: {{program: ./arm/bin/ArmComp, cwd: arm, env: {{RCYAML_PYTHON: ../.venv/bin/python}}}}
"""


def test_a_component_is_probed_with_its_own_python(
    robot: Path, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The Python of the workspace, which has Ice and another module."""
    rule = language("python").text("runtime/interpreter.py")
    write_tree(robot, {
        "robot.ddsl.yaml": "deployment: Robot\ncomponents:\n  arm: {program: ./arm/bin/ArmComp}\n",
        "rcyaml.yaml": "",
        "arm/bin/ArmComp": "#!/usr/bin/env python3\nfrom generated.main import main\n",
        "arm/generated/runtime/interpreter.py": rule, "arm/generated/main.py": "", "arm/src/worker.py": "import only_there\n",
        ".venv/pyvenv.cfg": f"home = {Path(sys.executable).resolve().parent}\ninclude-system-site-packages = false\n",
        ".venv/lib/python{}.{}/site-packages/only_there.py".format(*sys.version_info[:2]): "",
        ".venv/lib/python{}.{}/site-packages/Ice.py".format(*sys.version_info[:2]): "def intVersion(): return 30708\n",
    })  # fmt: skip
    (robot / ".venv/bin").mkdir()
    (robot / ".venv/bin/python").symlink_to(Path(sys.executable).resolve())
    (robot / "arm/bin/ArmComp").chmod(0o755)

    def missing() -> object:
        (found,) = json.loads(deploy(rcyaml, "probe", "--format", "json").stdout)["hosts"].values()
        return found[0]["missing"]

    assert missing() == []
    monkeypatch.setenv("RCYAML_PYTHON", "/no/such/python")
    assert missing() == ["Ice", "only_there"]
    write_tree(robot, {"robot.ddsl.yaml": OF_TWO_PYTHONS.format(robot / ".venv/bin/python")})
    (found,) = json.loads(deploy(rcyaml, "probe", "--format", "json").stdout)["hosts"].values()
    assert [(one["used_by"], one["missing"]) for one in found] == [
        (["arm", "hand"], []), (["leg"], ["Ice", "only_there"]), (["wing"], []),
    ]  # fmt: skip


def test_export(robot: Path, rcyaml: Rcyaml) -> None:
    assert 'server id="arm"' in deploy(rcyaml, "export", "--as", "icegrid").stdout
    assert "wrote out/Robot-arm.service" in deploy(rcyaml, "export", "--as", "systemd", "-o", "out").stdout
    assert (robot / "out/Robot-arm.service").stat().st_mode & 0o077 == 0


def test_an_export_overwrites_only_what_it_wrote(robot: Path, rcyaml: Rcyaml) -> None:
    def run() -> Result:
        return deploy(rcyaml, "export", "--as", "rcmanager", "-o", ".")

    write_tree(robot, {"Robot.xml": "<rcmanager/>"})  # what the deployment was migrated from
    refused = run()
    assert refused.exit_code == 1 and "'Robot.xml' exists, and rcyaml did not write it" in refused.stderr
    assert (robot / "Robot.xml").read_text(encoding="utf-8") == "<rcmanager/>"
    (robot / "Robot.xml").unlink()
    assert run().exit_code == 0
    write_tree(robot, {"robot.ddsl.yaml": ROBOT.replace("600", "601")})
    assert run().exit_code == 0 and "601" in (robot / "Robot.xml").read_text(encoding="utf-8")
    again = deploy(rcyaml, "export", "--as", "rcmanager", "-o", ".", "--format", "json")
    assert json.loads(again.stdout)["written"] == ["Robot.xml"]
    write_tree(robot, {"Robot.xml": "edited"})
    assert run().exit_code == 1
