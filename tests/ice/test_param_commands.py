"""`rcyaml param`: the parameters of real components, in each language."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

import of_languages
from components import Build, Built
from conftest import write_tree
from processes import Ports, Start, until
from test_parameters import CDSL, PDSL, Component, built, component  # noqa: F401 (fixtures)

Rcyaml = Callable[..., Result]
RCYAML = os.path.join(os.path.dirname(sys.executable), "rcyaml")
CONFIG = """\
# The arm of the left robot.
parameters:
  mode: slow     # careful
  device: /dev/usb
  token: {env: PARA_TOKEN}
  motors:
  - {name: a, min: -1, max: 1}
  pin: {env: PIN}
"""


def set_and_read(rcyaml: Rcyaml, name: str, path: str, value: str) -> object:
    done = rcyaml("param", "set", name, path, value)
    assert done.exit_code == 0, done.output
    assert "for now: the next start does not have it" in done.output
    done = rcyaml("param", "get", name, path, "--format", "json")
    assert done.exit_code == 0, done.output
    return json.loads(done.stdout)["value"]


def test_in_each_language(component: Component, start: Start, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    """Listed, read and set; by the component's documents, and without them, by its port."""
    component.run(start).wait_for("ParaComp is running")
    at = f"127.0.0.1:{component.port}"
    rows = {
        one["path"]: one for one in json.loads(rcyaml("param", "list", at, "--format", "json").stdout)["parameters"]
    }
    assert rows["basicPeriod"] == {"path": "basicPeriod", "value": 220, "type": "int", "unit": "", "editable": True}
    assert rows["token"]["value"] == "***"
    assert set_and_read(rcyaml, at, "basicPeriod", "100") == 100
    assert rcyaml("param", "set", at, "basicPeriod", "soon").exit_code == 2
    assert rcyaml("param", "set", at, "basicPeriod", "2000").exit_code == 1  # only the component knows its range

    endpoint = f"CommonBehavior.Endpoints = tcp -h 127.0.0.1 -p {component.port}\n"
    write_tree(component.built.root, {"etc/config": endpoint})
    monkeypatch.chdir(component.built.root)
    done = rcyaml("param", "list", "ParaComp", "--format", "json")
    assert done.exit_code == 0, done.output
    rows = {one["path"]: one for one in json.loads(done.stdout)["parameters"]}
    assert rows["motors[1].vel"] == {
        "path": "motors[1].vel",
        "value": 2.0,
        "type": "float",
        "unit": "rad/s",
        "editable": True,
    }
    assert rows["token"]["value"] == "***" and 'offsets["y.z"]' in rows
    for path, value, now in (
        ("basicPeriod", "7", 7),
        ("mode", "fast", "fast"),
        ("gains", "[1, 2.5]", [1, 2.5]),
        ("gains[2]", "-3", -3),
        ("offsets", '{a: 1, "b c": -0.1}', {"a": 1, "b c": -0.1}),
        ('offsets["d.e"]', "4", 4),
        ("Yolo.useGpu", "false", False),
        ("server", "a b: c", "a b: c"),
        ("motors[0].min", "-2.5", -2.5),
        ("motors", "[{name: z, min: 0, max: 1}]", [{"name": "z", "min": 0, "max": 1, "vel": 0.9}]),
        ("pin", "1234", "***"),
    ):
        assert set_and_read(rcyaml, "ParaComp", path, value) == now, path
    for path, whole in (("gains", [1, 2.5, -3]), ("offsets", {"a": 1, "b c": -0.1, "d.e": 4})):
        assert json.loads(rcyaml("param", "get", "ParaComp", path, "--format", "json").stdout)["value"] == whole


@pytest.fixture
def python(build: Build, start: Start, free_port: Ports, tmp_path: Path) -> Built:
    """A running component of a workspace, with a values document."""
    write_tree(tmp_path, {
        "rcyaml.yaml": "{}\n", "para/para.pdsl.yaml": PDSL.split("legacy:")[0],
        "para/etc/config.yaml": f"{CONFIG}endpoints: {{CommonBehavior: tcp -h 127.0.0.1 -p {free_port()}}}\n",
    })  # fmt: skip
    made = build({"para/para.cdsl.yaml": CDSL.format(language="python")})["ParaComp"]
    (made.root / of_languages.spoken("python").worker).write_text(of_languages.spoken("python").parameters)
    environment = {"PARA_TOKEN": "s3cret#1", "PIN": "4711"}
    config = Path(tmp_path, "para/etc/config")
    export = subprocess.run([RCYAML, "config", "export", "ParaComp"], cwd=tmp_path, check=True, capture_output=True)
    config.write_bytes(export.stdout)
    start(made.command, env=environment).wait_for("ParaComp is running")
    return made


REJECTED = (
    ("basicPeriod", "1001", 1, "basicPeriod is 1001 ms, and must be from 1 to 1000 ms"),
    ("mode", "fsat", 1, "did you mean 'fast'?"),
    ("motors[0].vell", "1", 2, "did you mean 'motors[0].vel'?"),
    ("motors[0].vel", "fast", 1, "motors[0].vel must be"),
    ("motors", "[{name: z, min: 0}]", 1, "motors[0].max"),
    ("basicPerod", "1", 2, "did you mean 'basicPeriod'?"),
    ("device", "/dev/x", 1, "it is not editable"),
    ("motors[0].min", "2", 1, "a motor's min must be below its max"),
    ("nothing", "1", 2, "known are mode, device"),
    ("gains[7]", "1", 2, "ParaComp cannot set gains[7]: gains has 1 element"),
    ("motors[1].vel", "1", 2, "motors has 1 element"),
    ("motors[1]", "{name: b}", 1, "motors[1].min"),
    (
        "motors",
        "[{name: a, min: 0, max: 1}, {name: a, min: 0, max: 1}, {name: a, min: 0, max: 1}, "
        "{name: a, min: 0, max: 1}, {name: a, min: 0, max: 1}]",
        1,
        "motors has 5 elements",
    ),
    ("CommonBehavior.Endpoints", "tcp", 1, "it is a property of Ice"),
    ("gains", "[1", 1, "value:1:1"),
    ("pin", "12345", 1, "pin is ***"),
    ("basicPeriod", "null", 2, "needs the value itself"),
)


def test_what_is_rejected_changes_nothing(python: Built, rcyaml: Rcyaml) -> None:
    before = rcyaml("param", "list", "ParaComp").stdout
    document = Path("para/etc/config.yaml").read_text()
    for path, value, code, said in REJECTED:
        done = rcyaml("param", "set", "ParaComp", path, value)
        assert done.exit_code == code, done.output
        assert said in done.output and "12345" not in done.output
        assert rcyaml("param", "set", "ParaComp", path, value, "--save").exit_code in (1, 2)
    assert rcyaml("param", "list", "ParaComp").stdout == before
    assert Path("para/etc/config.yaml").read_text() == document


def test_a_list_has_no_more_elements_than_it_may_have(python: Built, rcyaml: Rcyaml) -> None:
    for number in (1, 2, 3):
        assert rcyaml("param", "set", "ParaComp", f"motors[{number}]", "{name: x, min: 0, max: 1}").exit_code == 0
    done = rcyaml("param", "set", "ParaComp", "motors[4]", "{name: x, min: 0, max: 1}")
    assert done.exit_code == 1 and "motors has 5 elements, and must have 1 to 4" in done.output


def test_what_has_no_value(python: Built, rcyaml: Rcyaml) -> None:
    for path in ("motors[9]", "motors[9].vel", "offsets.nothing", "server"):
        done = rcyaml("param", "get", "ParaComp", path)
        assert (done.exit_code, done.output) == (1, f"{path} has no value\n")
    assert "offsets = {}" in (listed := rcyaml("param", "list", "ParaComp").stdout) and "# map, editable" in listed


def test_a_document_that_cannot_be_saved(python: Built, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch) -> None:
    """The document has errors, is not there, or cannot be written; the last is known only after the value was set."""
    document = Path("para/etc/config.yaml")
    before = document.read_text()
    at = f"127.0.0.1:{before.rpartition('-p ')[2].strip(' }' + chr(10))}"
    write_tree(Path(), {"r.ddsl.yaml": "deployment: R\ncomponents:\n  arm: {component: para, "
                        f"ports: {{CommonBehavior: {at.rpartition(':')[2]}}}}}\n"})  # fmt: skip
    document.write_text("parameters: [\n")
    done = rcyaml("param", "set", "arm", "mode", "fast", "--save")
    assert done.exit_code == 1 and "error[RC0101]" in done.output and "etc/config.yaml:1:14" in done.output
    document.unlink()
    done = rcyaml("param", "set", "arm", "mode", "fast", "--save")
    assert done.exit_code == 2 and "write one with `rcyaml config new para`" in done.output
    assert '"slow"' in rcyaml("param", "get", "arm", "mode", "--format", "json").stdout
    document.write_text(before)

    def full(path: str, data: bytes) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("robocomp_yaml.transactions.whole_file.replace", full)
    done = rcyaml("param", "set", "ParaComp", "mode", "fast", "--save")
    assert done.exit_code == 2 and "ParaComp has mode = fast until it ends, but cannot write" in done.output
    assert document.read_text() == before


def test_save_changes_the_document_too(python: Built, rcyaml: Rcyaml) -> None:
    document = Path("para/etc/config.yaml")
    before = document.read_text()
    assert rcyaml("param", "set", "ParaComp", "mode", "fast").exit_code == 0
    assert document.read_text() == before
    done = rcyaml("param", "set", "ParaComp", "mode", "fast", "--save")
    assert done.output == "ParaComp: mode = fast (was fast); also in para/etc/config.yaml\n"
    assert document.read_text() == before.replace("mode: slow ", "mode: fast ")


def test_a_reference_is_not_replaced_by_its_value(python: Built, rcyaml: Rcyaml) -> None:
    """A secret would be in a document."""
    before = Path("para/etc/config.yaml").read_text()
    done = rcyaml("param", "set", "ParaComp", "pin", "8642", "--save")
    assert done.exit_code == 2 and "reads pin from {env: PIN}: change it there, or leave --save out" in done.output
    assert Path("para/etc/config.yaml").read_text() == before
    assert rcyaml("param", "set", "ParaComp", "pin", "8642").exit_code == 0


def test_what_the_deployment_sets_is_not_saved_elsewhere(python: Built, rcyaml: Rcyaml, tmp_path: Path) -> None:
    port = Path("para/etc/config.yaml").read_text().rpartition("-p ")[2].strip(" }\n")
    entry = (
        f"{{component: para, ports: {{CommonBehavior: {port}}}, set: {{'motors[0].vel': 1, Yolo: {{useGpu: false}}}}}}"
    )
    write_tree(tmp_path, {"r.ddsl.yaml": f"deployment: R\ncomponents:\n  arm: {entry}\n"})
    done = rcyaml("param", "set", "arm", "motors[0].vel", "1.5", "--save")
    assert done.exit_code == 2 and "r.ddsl.yaml:3 sets motors[0].vel for arm" in done.output
    assert rcyaml("param", "set", "arm", "motors[0].vel", "1.5").exit_code == 0
    assert rcyaml("param", "set", "arm", "mode", "fast", "--save").exit_code == 0


def test_secrets_stay_masked(python: Built, rcyaml: Rcyaml) -> None:
    for words in (["list", "ParaComp"], ["get", "ParaComp", "token"], ["get", "ParaComp", "pin"],
                  ["set", "ParaComp", "pin", "8642"], ["list", "ParaComp", "--format", "json"]):  # fmt: skip
        done = rcyaml("param", *words)
        assert done.exit_code == 0 and "***" in done.output
        assert not [secret for secret in ("s3cret", "4711", "8642") if secret in done.output]


def test_watch_prints_changes(python: Built, rcyaml: Rcyaml, start: Start, tmp_path: Path) -> None:
    command = [RCYAML, "param", "watch", "ParaComp", "motors", "mode", "--every", "50ms", "--format", "json"]
    watching = start(command, cwd=tmp_path).wait_for('"mode"')
    for path, value, seen in (("basicPeriod", "8", ""), ("motors[0].vel", "1.25", "1.25"), ("mode", "fast", '"fast"')):
        assert rcyaml("param", "set", "ParaComp", path, value).exit_code == 0
        watching.wait_for(seen and f'"value": {seen}')  # two changes at once would come in the order of the values
    assert watching.stop(2) == 130
    rows = [json.loads(line) for line in watching.output.splitlines() if line]
    changes = [(one["path"], one["value"], one["was"]) for one in rows if one["was"] is not None]
    assert changes == [("motors[0].vel", 1.25, 0.9), ("mode", "fast", "slow")]


def test_nobody_is_there(python: Built, rcyaml: Rcyaml, free_port: Ports) -> None:
    done = rcyaml("param", "list", f"localhost:{free_port()}")
    assert done.exit_code == 1 and "nothing listens there" in done.output
    assert rcyaml("param", "list", "ParComp").exit_code == 2
    done = rcyaml("param", "list", "ParaComp.CommonBehavior")
    assert done.exit_code == 2 and "write ParaComp" in done.output
    until(lambda: rcyaml("param", "get", "ParaComp", "mode").stdout == "slow\n", "the value")
