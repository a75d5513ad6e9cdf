"""Checks of deployments: ports of one machine, addresses, executables, and repetitions by includes and instances."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree
from deployments import Tree, deployed

Run = Callable[..., Result]
Check = Callable[..., list[dict[str, object]]]
HOSTS = "hosts: {onboard: 10.0.0.2, head: 10.0.0.3}\n"
BUILT = {f"{name}/bin/{name.title()}Comp": "-> /bin/true" for name in ("speech", "mouth")}


@pytest.fixture
def found(diagnostics: Check) -> Callable[[Tree], list[tuple[object, ...]]]:
    """(code, severity, file, line, column) of all diagnostics of a tree whose components are built."""

    def check(files: Tree, *args: str) -> list[tuple[object, ...]]:
        missing = {path: content for path, content in BUILT.items() if not Path(path).exists()}
        told = diagnostics({**files, **missing}, *(args or ("robot.ddsl.yaml",)))
        return [tuple(one[key] for key in ("code", "severity", "file", "line", "column")) for one in told]

    return check


def two(first: str, second: str, before: str = "") -> Tree:
    return deployed(f"{before}components:\n  a: {{component: mouth, {first}}}\n  b: {second}\n")


@pytest.mark.parametrize(
    ("second", "column"),
    [
        ("{component: mouth, port: 10001}", 31),
        ("{component: mouth, ports: {CommonBehavior: 10001}}", 49),
        ("{program: sh, endpoints: {Laser: tcp -p 10001}}", 39),
        ("{program: sh, endpoints: {Laser: ssl -p 10001}}", 39),
        ('{program: sh, endpoints: {Laser: "tcp -h 127.0.0.1 -p 10001"}}', 39),
        ("{program: sh, ready: {port: 10001}}", 3),
    ],
)
def test_two_processes_on_one_port(found: Check, second: str, column: int) -> None:
    assert found(two("port: 10001", second)) == [("RC4303", "error", "robot.ddsl.yaml", 4, column)]


@pytest.mark.parametrize(
    "second",
    [
        "{component: mouth, port: 10002}",
        "{program: sh, endpoints: {Laser: udp -p 10001}}",
        '{program: sh, endpoints: {Laser: "tcp -h 127.0.0.5 -p 10001"}}',
        "{component: mouth, port: 10001, enabled: false}",
    ],
)
def test_processes_without_a_port_conflict(found: Check, second: str) -> None:
    assert not found(two("port: 10001", second))


def test_one_port_on_two_hosts(found: Check) -> None:
    assert not found(two("port: 10001, host: onboard", "{component: mouth, port: 10001, host: head}", HOSTS))


def test_the_same_machine_under_two_names(found: Check) -> None:
    hosts = "hosts: {a: 10.0.0.2, b: 10.0.0.2}\n"
    (fault,) = found(two("port: 10001, host: a", "{component: mouth, port: 10001, host: b}", hosts))
    assert fault[0] == "RC4303"


def test_a_port_of_icestorm(found: Check) -> None:
    files = deployed(
        "services: {storm: {icestorm: {port: 10001}}}\n"
        "components: {a: {component: mouth, port: 10001, after: [storm]}}\n"
    )
    (fault,) = found(files)
    assert fault == ("RC4303", "error", "robot.ddsl.yaml", 3, 42)


def test_instances_whose_ports_reach_that_of_another_process(found: Check) -> None:
    files = deployed(
        'components:\n  "a{i}": {component: mouth, instances: 3, port: 10001}\n  b: {component: mouth, port: 10003}\n'
    )
    assert found(files) == [("RC4303", "error", "robot.ddsl.yaml", 4, 31)]


@pytest.mark.parametrize("address", ["localhost", "127.0.0.1", "127.1.2.3"])
def test_a_loopback_address_among_hosts(found: Check, address: str) -> None:
    hosts = f"hosts:\n  here: {{address: {address}}}\n  head: 10.0.0.3\n"
    files = two("host: here", "{component: mouth, host: head}", hosts)
    assert found(files) == [("RC4304", "error", "robot.ddsl.yaml", 3, 19)]


def test_one_machine_may_be_several_hosts(found: Check) -> None:
    hosts = "hosts: {here: 127.0.0.2, there: 127.0.0.3}\n"
    assert not found(two("host: here, port: 10001", "{component: mouth, host: there, port: 10001}", hosts))


@pytest.mark.parametrize("address", ["10.0.0.256", "10.0.0", "0.0.0.0", "224.0.0.1", "fe80::zz", "a..b", "a-.b"])
def test_wrong_addresses(found: Check, address: str) -> None:
    assert found(deployed(f'hosts: {{a: "{address}"}}\ncomponents: {{m: {{component: mouth, host: a}}}}\n')) == [
        ("RC4305", "error", "robot.ddsl.yaml", 2, 12)
    ]


@pytest.mark.parametrize("address", ["robot", "robot-1.local", "10.0.0.2", "fd00::2", "fe80::1%eth0", "a_b"])
def test_addresses(found: Check, address: str) -> None:
    assert not found(deployed(f'hosts: {{a: "{address}"}}\ncomponents: {{m: {{component: mouth, host: a}}}}\n'))


def test_a_host_name_is_resolved_only_on_request(rcyaml: Run, tmp_path: Path) -> None:
    files = deployed("hosts: {a: no-such-host.invalid}\ncomponents: {m: {component: mouth, host: a}}\n")
    write_tree(tmp_path, files)
    assert "RC4306" not in rcyaml("check", "robot.ddsl.yaml").output
    asked = rcyaml("check", "--environment", "robot.ddsl.yaml")
    assert "warning[RC4306]" in asked.output and asked.exit_code == 0


def check(rcyaml: Run, tmp_path: Path, files: Tree, *args: str) -> str:
    write_tree(tmp_path, files)
    return rcyaml("check", "robot.ddsl.yaml", *args).output


def test_a_component_that_is_not_compiled(rcyaml: Run, tmp_path: Path) -> None:
    output = check(rcyaml, tmp_path, deployed("components: {m: {component: mouth}}\n"))
    assert "warning[RC4403]: 'm' has no executable: mouth/bin/MouthComp is missing" in output
    assert "`rcyaml compile mouth/mouth.cdsl.yaml` writes it" in output


def test_an_executable_that_compile_does_not_write(rcyaml: Run, tmp_path: Path) -> None:
    output = check(rcyaml, tmp_path, deployed("components: {m: {component: mouth, executable: bin/mouth}}\n"))
    assert "build it, or correct `executable: bin/mouth`" in output


def test_instances_of_a_program_with_one_port(rcyaml: Run, tmp_path: Path) -> None:
    entry = 'components:\n  watch{i}: {program: sh, instances: 2, endpoints: {Laser: "tcp -p 14000"}}\n'
    output = check(rcyaml, tmp_path, deployed(entry))
    assert "use {i}, the number of the instance, in the port: `-p 1400{i}`" in output
    assert "RC4303" not in check(rcyaml, tmp_path, deployed(entry.replace("14000", "1400{i}")))


def test_a_component_that_is_not_built(rcyaml: Run, tmp_path: Path) -> None:
    files = deployed("components: {m: {component: mouth}}\n")
    cpp = str(files["mouth/mouth.cdsl.yaml"]).replace("python", "cpp")
    output = check(rcyaml, tmp_path, {**files, "mouth/mouth.cdsl.yaml": cpp})
    assert "then `rcyaml build mouth/mouth.cdsl.yaml`" in output, "there is no workspace to find a name in"


@pytest.mark.parametrize(
    ("entry", "problem"),
    [
        ("{component: mouth, executable: bin/text}", "mouth/bin/text is not executable"),
        ("{component: mouth, executable: bin}", "mouth/bin is a folder"),
        ("{program: ./viewer}", "there is no viewer"),
        ("{program: sh, cwd: nowhere}", "there is no folder nowhere to run in"),
    ],
)
def test_programs_that_cannot_be_started(rcyaml: Run, tmp_path: Path, entry: str, problem: str) -> None:
    files = {**deployed(f"components: {{m: {entry}}}\n"), "mouth/bin/text": ""}
    assert f"warning[RC4404]: 'm' cannot be started: {problem}\n" in check(rcyaml, tmp_path, files)


def test_programs_are_looked_up_in_path_only_on_request(rcyaml: Run, tmp_path: Path) -> None:
    files = deployed("components: {m: {program: no-such-program}}\n")
    assert "RC4404" not in check(rcyaml, tmp_path, files)
    assert "PATH finds no 'no-such-program'" in check(rcyaml, tmp_path, files, "--environment")


def test_files_of_other_machines_are_not_checked(rcyaml: Run, tmp_path: Path) -> None:
    files = deployed("hosts: {far: 192.0.2.7}\ncomponents: {m: {component: mouth, host: far}}\n")
    assert check(rcyaml, tmp_path, files) == "3 documents: nothing wrong\n"


def test_an_include_is_checked_as_part_of_the_including_deployment(found: Check) -> None:
    arm = "deployment: Arm\ncomponents:\n  speech: {component: speech, port: 10001}\n"
    files = deployed(
        "components: {mouth: {component: mouth, port: 10002}}\ninclude: [arm.ddsl.yaml]\n", **{"arm.ddsl.yaml": arm}
    )
    assert not found(files, ".")


def test_repetitions_by_several_includes_are_reported_once(found: Check) -> None:
    arm = "deployment: Arm\ncomponents:\n  mouth: {component: mouth, port: 10001, set: {period.compute: 0}}\n"
    files = deployed("include: {left: arm.ddsl.yaml, right: arm.ddsl.yaml}\n", **{"arm.ddsl.yaml": arm})
    codes = [fault[0] for fault in found(files, ".")]
    assert sorted(codes) == ["RC3303", "RC4303"]


@pytest.mark.parametrize(("more", "severity"), [("", "error"), (", x-rcmanager: {xpos: 1}", "warning")])
def test_an_object_that_a_process_does_not_serve(found: Check, more: str, severity: str) -> None:
    """What RCManager started can be planned."""
    speech = f'{{component: speech, connect: {{Mouth: "mouht:tcp -p 10001"}}{more}}}'
    files = deployed(f"components:\n  mouth: {{component: mouth, port: 10001}}\n  speech: {speech}\n")
    assert found(files) == [("RC4313", severity, "robot.ddsl.yaml", 4, 48)]


def test_lint_may_lower_the_severity(found: Check) -> None:
    files = deployed("components: {speech: {component: speech}}\n")
    assert [fault[0] for fault in found(files)] == ["RC4201"]
    assert not found({**files, "rcyaml.yaml": "lint: {RC4201: 'off'}\n"})
