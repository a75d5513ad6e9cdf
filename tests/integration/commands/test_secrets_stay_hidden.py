"""A canary is in every value that can be secret, and no command prints it for people."""

from __future__ import annotations

import os
import pty
import stat
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from conftest import write_tree
from processes import killed_on_failure

CDSL = "component: SpeechComp\nlanguage: python\n"
PDSL = """\
component: speech.cdsl.yaml
types:
  Account: {struct: {user: string, key: {type: string, secret: true}}}
  Mode: {enum: [one, two]}
parameters:
  wifi: {type: string, secret: true}
  pin: {type: int, range: [0, 9999999], secret: true, optional: true}
  gain: {type: double, secret: true, optional: true}
  mode: {type: Mode, secret: true, optional: true}
  locks: {list: string, unique: true, secret: true, optional: true, editable: true}
  table: {list: {list: string}, secret: true, optional: true}
  accounts: {list: Account, optional: true}
  password: {type: string, default: canaryDefault}
  mail: {group: {token: {type: string, optional: true}}}
  headers: {map: string, optional: true}
  url: {type: string, optional: true}
  name: {type: string, default: x}
legacy:
  accounts: {key: "Account{i}", columns: [user, key]}
"""
BASE = """\
parameters: {wifi: canaryBase, locks: [canaryOld], mail: {token: canaryOldToken}}
"""
VALUES = """\
component: ../speech.cdsl.yaml
extends: [base.config.yaml]
parameters:
  wifi: canaryWifi
  pin: 4711471
  gain: 47114.71
  locks: [canaryA, canaryB]
  table: [[canaryC], [canaryD]]
  accounts: [{user: bob, key: canaryKey}]
  mail: {token: canaryToken}
  headers: {Authorization: canaryHeader}
  url: "http://bob:canaryUrl@host/x"
properties: {db.password: canaryProperty}
"""
DDSL = """\
deployment: Robot
components:
  speech:
    component: speech
    args: ["--wifi=canaryArgument"]
    env: {API_TOKEN: canaryVariable, SERVER: "amqp://bob:canaryServer@host"}
    set: {wifi: canarySet, "accounts[0].key": canarySetKey, mail.token: canarySetToken}
  other:
    program: /bin/sleep
    args: [--password, canaryWord, --api-key=canaryOption, "curl https://b:canaryCurl@h", "1"]
"""
FILES = {
    "speech/speech.cdsl.yaml": CDSL, "speech/speech.pdsl.yaml": PDSL, "speech/etc/base.config.yaml": BASE,
    "speech/etc/config.yaml": VALUES, "robot.ddsl.yaml": DDSL,
}  # fmt: skip
CANARIES = ("canary", "4711471", "47114.71")
CONFIG = "speech/etc/config.yaml"
COMMANDS = [
    "check", "check --format json", "check --format sarif", "compile --dry-run", "compile --diff", "-v compile",
    "compile --diff --target config", "compile --format json", f"config check {CONFIG}", f"config show {CONFIG}",
    f"config show {CONFIG} --format json", f"config get {CONFIG} wifi", f"config get {CONFIG} accounts",
    f"config get {CONFIG} locks --format json", f"config get {CONFIG} url",
    f"config get {CONFIG} headers.Authorization",
    f"config set {CONFIG} wifi canaryNew", f"config set {CONFIG} pin 47114711 --format json",
    f"config set {CONFIG} locks [canaryE,canaryE]", f"config set {CONFIG} pin canary",
    f"config set {CONFIG} mode canaryThree",
    f"config set {CONFIG} gain [canary", f"config set {CONFIG} url http://bob:canary2@h",
    "graph", "graph --as json", "graph --as dot", "graph --as mermaid", "graph --as svg", "deploy plan robot.ddsl.yaml",
    "-v deploy plan robot.ddsl.yaml --format json", "deploy status robot.ddsl.yaml --format json",
    "run speech --dry-run", "run SpeechComp --alone --dry-run --format json", "run speech", "run other --dry-run",
    "run speech --dry-run -- --password=canaryTyped", "run speech --dry-run --set wifi=canaryNew",
    "run speech --dry-run --set pin=47114711 --format json", "run speech --dry-run --set mode=canaryThree",
    "run SpeechComp --alone --dry-run --set wifi=canaryNew", "run SpeechComp --alone --dry-run --set mode=canary3",
]  # fmt: skip


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for path, text in FILES.items():
        target = tmp_path / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text, encoding="utf-8")
    return tmp_path


def sings(text: str) -> list[str]:
    return [line for line in text.splitlines() if any(canary in line for canary in CANARIES)]


@pytest.mark.parametrize("command", COMMANDS)
def test_nothing_is_shown(robot: Path, rcyaml: Callable[..., Any], command: str) -> None:
    result = rcyaml(*command.split())
    assert result.exit_code in ((0, 1, 2) if command.startswith("run") else (0, 1)), result.output
    assert not sings(result.output)
    assert "Traceback" not in result.output


BROKEN = [
    "parameters: {wifi: 'canaryWifi', nam: 3, pin: canary, locks: [canaryA, canaryA, 7], mode: canaryX}\n",
    "parameters: {wifi: [canaryWifi], accounts: [{user: 3, key: {x: canaryKey}}], mail: {token: [canaryT]}}\n",
    "parameters: {wifi: 'canaryWifi, pin: 5x, password: canaryPassword}\n",
    "parameters: {wifi: @canaryWifi, password:canaryPassword, pin: 04711471}\n",
    "parameters: {wifi: !canaryWifi x, password: *canaryAlias}\n",
    "parameters:\n  wifi: canary Wifi: x\n",
    "parameters:\n  locks:\n    - canaryA\n     - canaryB\n",
    "parameters:\n  mail:\n    token: |\n    canaryToken\n",
    "parametres: {wifi: canaryWifi, password: canaryPassword}\n",
    "parameters: [{wifi: canaryWifi}]\n",
    "parameters: {wifi: canaryWifi}\nendpoints: {A: 'tcp', password: [canaryP]}\n",
    "parameters: {wifi: canaryWifi}\nproperties: {db.password: [canaryP], db.token: {x: canaryT}}\n",
    "parameters: {wifi: canaryWifi, accounts: [{user: 'a,b', key: canaryKey}]}\n",
    'parameters: {wifi: "canary\\nWifi", name: 3}\n',
    'parameters: {wifi: "${env:canaryWifi}", name: 3}\n',
    "parameters: {wiffi: canaryWifi, Wifi: canaryB, name: 3}\n",
    "parameters: {wifi: {env: canary-wifi}, password: {env: 'canary Password'}, name: 3}\n",
    "parameters: {wifi: {env: [canaryWifi]}, password: {file: [canaryP]}, locks: [{env: 4711471}, {file: {x: canaryP}}]}\n",
    "parameters: {wifi: {env: canaryWifi, file: canaryP}, password: {file: canaryP/}, name: 3}\n",
    "parameters: {wifi: {evn: canaryWifi}, password: {env: }, locks: [{env: canary-lock}], mail: {token: {env: canary.token}}}\n",
    "parameters: {wifi: {env: canary-wifi, password: {env: 'canary Password'}, name: 3}\n",
    "parameters: {wifi: " + "canary" * 20 + ", name: 3, url: 'x://a:canary@b'}\n",
]


@pytest.mark.parametrize("text", BROKEN)
@pytest.mark.parametrize("form", ["text", "json", "sarif"])
def test_wrong_values_do_not_show_it(robot: Path, rcyaml: Callable[..., Any], text: str, form: str) -> None:
    (robot / CONFIG).write_text(f"component: ../speech.cdsl.yaml\n{text}", encoding="utf-8")
    for command in (("check", "--format", form), ("config", "check", CONFIG, "--format", form)):
        result = rcyaml(*command)
        assert result.exit_code == 1, result.output
        assert not sings(result.output)


@pytest.mark.parametrize("type_", [
    "{type: string, values: [canaryA, canaryB]}", "{type: int, values: [4711471, 7]}", "{type: Kind, secret: true}",
    "{list: {type: string, values: [canaryA, canaryB]}}",
])  # fmt: skip
@pytest.mark.parametrize("value", ["canaryX", "8", "[canaryX]", "{x: canaryX}", "true", "null"])
def test_limits_of_a_secret_are_not_shown(robot: Path, rcyaml: Callable[..., Any], type_: str, value: str) -> None:
    types = "types: {Kind: {enum: [canaryA, canaryB]}}\n" if "Kind" in type_ else ""
    write_tree(robot, {
        "speech/speech.pdsl.yaml": f"component: speech.cdsl.yaml\n{types}parameters: {{password: {type_}}}\n",
        CONFIG: f"component: ../speech.cdsl.yaml\nparameters: {{password: {value}}}\n",
    })  # fmt: skip
    for path in ("speech/etc/base.config.yaml", "robot.ddsl.yaml"):
        (robot / path).unlink()
    for command in (("check",), ("config", "check", CONFIG), ("config", "set", CONFIG, "password", value)):
        assert not sings(rcyaml(*command).output)


DEPLOYMENTS = [
    "  a: {component: speech, set: {wifi: canaryA, pin: 4711471}, args: ['--wifi=canaryB']}\n",
    "  a: {program: /bin/true, args: [--token, canaryA, {token: canaryB}], env: {PASSWORD: [canaryC]}, port: x}\n",
    "  a: {program: /bin/true, env: {PASSWORD: 4711471, TOKEN: 'canary}\n",
    "  a: {component: speech, set: {wifi: [canaryA], pin: canaryB, name: 3, 'accounts[4].key': canaryC}}\n",
    "  a: {component: nowhere, set: {wifi: canaryA, password: canaryB}, env: {X: 'x://a:canary@b'}}\n",
    "  a:\n    program: /bin/true\n    args:\n    - --password\n    - 'canaryA\n",
    '  a:\n    component: speech\n    set: {mode: "canaryA"x}\n',
    "  [a, {program: /bin/true, env: {PASSWORD: canaryA}, args: [--token, canaryB]}]\n",
    "  a: {program: /bin/true, env: [PASSWORD=canaryA, {PASSWORD: canaryB}]}\n",
    "  a: {program: '/bin/x --password canaryA'}\nhosts: {h: {address: a, password: canaryB}}\n",
    "  a: {component: speech, set: {wifi: {env: canary-a}, password: {file: [canaryB]}, pin: {env: canaryC, file: canaryD}}}\n",
    "  a: {program: /bin/true, env: {PASSWORD: {env: canary-a}, TOKEN: {env: [canaryB]}, SECRET: {env: canaryC, file: canaryD}}}\n",
    "  a: {program: /bin/true, env: {PASSWORD: {file: canaryA/}, TOKEN: {file: }, SECRET: {file: {x: canaryD}}, API_KEY: {evn: canary}}}\n",
    "  a: {program: sh, args: [--password, {env: canary-a}, '--token={env: canary-b}', -c]}\n",
    "  a: {program: sh, args: [-c, 'PASSWORD=canaryA run --password canaryB'], prot: 1}\n",
]


@pytest.mark.parametrize("text", DEPLOYMENTS)
@pytest.mark.parametrize("command", ["check", "check --format json", "graph", "deploy plan robot.ddsl.yaml"])
def test_wrong_deployments_do_not_show_it(robot: Path, rcyaml: Callable[..., Any], text: str, command: str) -> None:
    (robot / "robot.ddsl.yaml").write_text(f"deployment: Robot\ncomponents:\n{text}", encoding="utf-8")
    result = rcyaml(*command.split())
    assert not sings(result.output)
    assert "Traceback" not in result.output


@pytest.mark.parametrize("text", [
    "parameters: {pin: {type: int, secret: true, default: 4711471}}\n",
    "parameters: {password: {type: int, default: canaryA}}\n",
    "parameters: {password: {type: string, pattern: '[a-z]', default: canaryA, optional: true}}\n",
    "parameters: {token: {list: string, default: [canaryA, {x: canaryB}]}, x: flaot}\n",
    "parameters: {wifi: {type: string, secret: true, default: canaryA, patern: x}}\n",
    "parameters: {db: {group: {password: {type: string, default: canaryA, rnge: 1}}}}\n",
    'parameters: {wifi: {type: string, secret: true, default: "canaryA"x}}\n',
    "parameters: {wifi: {type: string, secret: true, values: [canaryA, canaryB], rnge: 1}}\n",
    "parameters: {password: {type: string, one-of: [canaryA, canaryB]}, x: flaot}\n",
    "parameters: {db: {group: {password: {type: string, values: [canaryA, 4711471], optional: 3}}}}\n",
    "parameters: {pin: {type: int, secret: true, values: [4711471, canaryA]}}\n",
    "parameters: {wifi: {enum: [canaryA, canaryB], secret: true, optinal: true}}\n",
])  # fmt: skip
def test_wrong_defaults_do_not_show_it(robot: Path, rcyaml: Callable[..., Any], text: str) -> None:
    (robot / "speech/speech.pdsl.yaml").write_text(f"component: speech.cdsl.yaml\n{text}", encoding="utf-8")
    for path in (CONFIG, "speech/etc/base.config.yaml", "robot.ddsl.yaml"):
        (robot / path).unlink()
    result = rcyaml("check", "speech")
    assert result.exit_code == 1
    assert not sings(result.output)


def test_programs_get_the_values(robot: Path, rcyaml: Callable[..., Any]) -> None:
    for form in ("ice", "toml"):
        printed = rcyaml("config", "export", CONFIG, "--as", form).output
        assert "canaryWifi" in printed and "canaryUrl" in printed and "4711471" in printed
    assert "canaryWifi" in rcyaml("config", "show", CONFIG, "--reveal").output
    assert rcyaml("config", "get", CONFIG, "wifi", "--reveal").output == "canaryWifi\n"
    assert "canarySet" in rcyaml("deploy", "export", "robot.ddsl.yaml", "--as", "systemd").output


@pytest.mark.parametrize("form", ["ice", "toml"])
def test_a_terminal_does_not_get_the_values(robot: Path, form: str) -> None:
    assert not sings(on_a_terminal("config", "export", CONFIG, "--as", form))
    assert sings(on_a_terminal("config", "export", CONFIG, "--as", form, "--reveal"))


@pytest.mark.parametrize("more", [(), ("--format", "json")])
@pytest.mark.parametrize("form", ["systemd", "compose", "icegrid", "rcmanager"])
def test_an_export_on_a_terminal_does_not_show_it(robot: Path, form: str, more: tuple[str, ...]) -> None:
    (robot / "etc").mkdir()
    (robot / "etc/flat.conf").write_text(FLAT)
    (robot / "own.json").write_text('{"db": {"password": "canaryJson",\n "user": "x"}}\n')
    more_entries = (
        "  flat: {component: speech, config: ../etc/flat.conf, ready: {command: [x, --password=canaryReady]}}\n"
        "  own: {program: /bin/true, config: own.json, args: ['{config}'],\n"
        "    x-rcmanager: {upCommand: 'own --password canaryUp', dbPassword: canaryX, list: [{token: canaryL}]}}\n"
    )
    (robot / "robot.ddsl.yaml").write_text(DDSL + more_entries)
    command = ("deploy", "export", "robot.ddsl.yaml", "--as", form, *more)
    assert not sings(on_a_terminal(*command))
    run = subprocess.run([sys.executable, "-m", "robocomp_yaml", *command], capture_output=True, text=True)
    assert sings(run.stdout) and not sings(run.stderr)


FLAT = "# password=none\nx=1\nwifi = canaryFlat\nPW\\=a b.password=canaryOdd\nmail=smtp://bob:canaryMail@h\n"


@pytest.mark.parametrize(
    ("text", "line"),
    [
        (FLAT, 3), ("x=1\n# password=none\n", 0), ("password=\nwifi=${env:WIFI}\n", 0), ('{"token": "canary"}', 1),
        ("mail:\n  password: |\n    canary\n", 2), ("url=http://bob:canary@h\n", 1), ("max_tokens=3\nmy.keys=3\n", 0),
        ("; password = x\n// token: x\n", 0), ("gains=1\nlocks=canary\n", 2),
    ],
)  # fmt: skip
@pytest.mark.usefixtures("umask")
def test_a_configuration_that_is_no_document(robot: Path, rcyaml: Callable[..., Any], text: str, line: int) -> None:
    (robot / "speech/flat.conf").write_text(text)
    (robot / "robot.ddsl.yaml").write_text(
        "deployment: Robot\ncomponents:\n  speech{i}: {component: speech, instances: 2, config: flat.conf}\n"
    )
    printed = rcyaml("check", "robot.ddsl.yaml").output
    assert printed.count("RC4311") == (1 if line else 0), printed
    assert not sings(printed)
    if line:
        assert f"speech/flat.conf contains a secret in line {line}, and other users can read it" in printed
        assert "robot.ddsl.yaml:3:56" in printed and "`chmod 600 speech/flat.conf`" in printed
    (robot / "speech/flat.conf").chmod(0o600)
    assert "RC4311" not in rcyaml("check", "robot.ddsl.yaml").output


def test_keys_of_the_user_do_not_show_it(robot: Path, rcyaml: Callable[..., Any]) -> None:
    entry = "{program: /bin/true, prot: 3, x-a: {up: 'run --password canaryA', token: [canaryB]}, x-secret: canaryC}"
    (robot / "robot.ddsl.yaml").write_text(f"deployment: Robot\ncomponents:\n  a: {entry}\n")
    (robot / "speech/speech.cdsl.yaml").write_text("{component: S, languag: python, x-a: {password: canaryD}}\n")
    for form in ("text", "json", "sarif"):
        printed = rcyaml("check", "--format", form).output
        assert "prot" in printed and "languag" in printed
        assert not sings(printed)


def on_a_terminal(*words: str) -> str:
    ours, theirs = pty.openpty()
    showing = subprocess.Popen([sys.executable, "-m", "robocomp_yaml", *words], stdout=theirs, stderr=theirs)
    with killed_on_failure(showing) as running:
        os.close(theirs)
        printed = b""
        while True:
            try:
                part = os.read(ours, 1 << 16)
            except OSError:
                break
            printed += part
        assert running.wait() == 0
    os.close(ours)
    return printed.decode()


def test_other_values_are_shown(robot: Path, rcyaml: Callable[..., Any]) -> None:
    """A message that hides too much hides the error."""
    (robot / CONFIG).write_text("component: ../speech.cdsl.yaml\nparameters: {wifi: canary, nam: 3, name: 7}\n")
    printed = rcyaml("check", CONFIG).output
    line = "2 │ parameters: {wifi: ***, nam: 3, name: 7}"
    assert f"{line}\n  │                         ^^^ 'name' is already present" in printed
    assert "name must be text, and is 7" in printed


def test_generated_documents_and_schemas_have_none(robot: Path, rcyaml: Callable[..., Any]) -> None:
    assert rcyaml("compile", "speech", "--target", "docs", "--target", "config").exit_code == 0
    made = [path for path in (robot / "speech/generated").rglob("*") if path.is_file()]
    assert {"parameters.md", "config.schema.json", "example.config.yaml"} <= {path.name for path in made}
    assert not [path for path in made if sings(path.read_text())]
    example = (robot / "speech/generated/example.config.yaml").read_text()
    assert "\n  wifi: {env: WIFI}\n" in example and "# password: {env: PASSWORD}" in example


def mode(path: Path) -> int:
    return stat.S_IMODE(path.stat().st_mode)


OPEN = 0o644


@pytest.fixture
def umask() -> Any:
    before = os.umask(0o022)
    yield
    os.umask(before)


@pytest.mark.usefixtures("umask")
@pytest.mark.parametrize("closed", [CONFIG, "speech/etc/base.config.yaml", "speech/speech.pdsl.yaml"])
def test_files_generated_from_a_private_file_are_private(robot: Path, rcyaml: Callable[..., Any], closed: str) -> None:
    made = robot / "speech/etc/config"
    assert rcyaml("compile", "speech").exit_code == 0
    assert mode(made) == OPEN
    (robot / closed).chmod(0o600)
    assert "updated" in rcyaml("compile", "speech").output, "though its text is the same"
    assert mode(made) == 0o600
    before = made.read_text()
    (robot / CONFIG).write_text(VALUES.replace("canaryWifi", "canaryNew"))
    assert rcyaml("compile", "speech").exit_code == 0
    assert "canaryNew" in made.read_text() != before
    assert mode(made) == 0o600
    made.write_text(made.read_text() + "x=1\n")  # edited: --adopt keeps it
    made.chmod(OPEN)
    rcyaml("compile", "--adopt", "speech")
    assert mode(made) == mode(robot / "speech/etc/config.orig") == 0o600
    made.chmod(OPEN)
    rcyaml("compile", "speech")
    assert mode(made) == 0o600
    mine = {path for path in robot.rglob("*") if path.is_file() and "canary" in path.read_text(errors="replace")}
    theirs = {robot / path for path in FILES} | {robot / "speech/generated/parameters.py"}
    assert not [path for path in mine - theirs if mode(path) & 0o077]
    assert mode(robot / "speech/generated/parameters.py") == (0o600 if "pdsl" in closed else OPEN)


@pytest.mark.usefixtures("umask")
def test_groups_keep_read_access(robot: Path, rcyaml: Callable[..., Any]) -> None:
    (robot / CONFIG).chmod(0o640)
    assert rcyaml("compile", "speech").exit_code == 0
    assert mode(robot / "speech/etc/config") == 0o640
    assert "RC3311" in rcyaml("check", CONFIG).output, "a group is others, too"


@pytest.mark.usefixtures("umask")
def test_the_warning_disappears_with_its_cause(robot: Path, rcyaml: Callable[..., Any]) -> None:
    for path in FILES:
        (robot / path).chmod(0o600)
    assert "RC3311" not in rcyaml("compile", "speech").output
    assert "RC4310" not in rcyaml("check").output
    (robot / CONFIG).chmod(OPEN)
    assert rcyaml("compile", "speech").output.count("RC3311") > 5
    assert rcyaml("compile", "speech").output.count("RC3311") > 5, "reported again, although nothing is to be written"


@pytest.mark.usefixtures("umask")
def test_config_set_keeps_a_file_private(robot: Path, rcyaml: Callable[..., Any]) -> None:
    (robot / CONFIG).chmod(0o600)
    assert rcyaml("config", "set", CONFIG, "wifi", "canaryNew").output == "wifi = *** (was ***)\n"
    assert mode(robot / CONFIG) == 0o600
    printed = rcyaml("config", "set", CONFIG, "wifi", "{file: secrets/wifi}").output
    assert printed == "wifi = {file: secrets/wifi} (was ***)\n"


@pytest.mark.usefixtures("umask")
def test_documents_migrated_from_a_private_file_are_private(robot: Path, rcyaml: Callable[..., Any]) -> None:
    (robot / "old/etc").mkdir(parents=True)
    (robot / "old/old.cdsl").write_text("Component Old\n{\n\tlanguage Cpp11;\n};\n")
    (robot / "old/etc/config").write_text("mail.password=canaryOld\nEndpoints.X=tcp -p 1\n")
    (robot / "old/etc/config").chmod(0o600)
    printed = rcyaml("migrate", "old", "--diff")
    assert not sings(printed.output)
    made = [path for path in (robot / "old").rglob("*.yaml") if "canary" in path.read_text()]
    assert made and not [path for path in made if mode(path) & 0o077]


@pytest.mark.usefixtures("umask")
def test_exports_are_readable_only_for_their_owner(robot: Path, rcyaml: Callable[..., Any]) -> None:
    assert rcyaml("deploy", "export", "robot.ddsl.yaml", "--as", "compose", "-o", "out").exit_code == 0
    made = [path for path in (robot / "out").rglob("*") if path.is_file() and "canary" in path.read_text()]
    assert made and not [path for path in made if mode(path) & 0o077]
