"""`rcyaml config`: new, check, show, get, set, export."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree

PDSL = """\
component: speech.cdsl.yaml
types:
  Motor:
    struct:
      name: string
      vel: {type: float, range: [0, 2], default: 0.9, unit: rad/s}
parameters:
  device: {type: string, default: /dev/ttyUSB0, doc: The bus.}
  speed: {type: float, range: {from: 0, below: 1}, unit: m/s}
  mode: {type: string, values: [slow, fast], default: slow, editable: true}
  Yolo: {group: {use_gpu: {type: bool, default: false}, model: {type: string, optional: true}}}
  motors: {list: Motor, size: [1, 4]}
  offsets: {map: float, default: {}}
constraints:
  - {that: "unique(m.name for m in motors)", else: two motors have the same name}
"""
BASE = """\
component: ../speech.cdsl.yaml
parameters:
  speed: .5   # half
  motors:
    - {name: a}
    - name: b   # the second
      vel: 1
"""
TREE = {
    "speech.pdsl.yaml": PDSL,
    "speech.cdsl.yaml": "component: SpeechComp\nlanguage: python\nperiod: 50 ms\n",
    "etc/config.yaml": BASE,
    "sim.config.yaml": "extends: [etc/config.yaml]\nparameters:\n  speed: 0.25\n  Yolo: {model: {env: MODEL}}\n",
}
Run = Callable[..., Result]


@pytest.fixture
def run(rcyaml: Run, tmp_path: Path) -> Run:
    write_tree(tmp_path, TREE)
    return rcyaml


def test_show_says_where_each_value_comes_from(run: Run) -> None:
    result = run("config", "show", "sim.config.yaml")
    assert result.exit_code == 0, result.output
    lines = {line.split(" = ")[0]: line for line in result.output.splitlines()}
    assert lines["speed"].endswith("# sim.config.yaml:3, overrides .5 (etc/config.yaml:3)")
    assert lines["speed"].startswith("speed = 0.25 m/s")
    assert lines["device"].endswith("# default, speech.pdsl.yaml:8")
    assert lines["motors[0].vel"].startswith("motors[0].vel = 0.9 rad/s")
    assert lines["motors[1].vel"].endswith("# etc/config.yaml:7")
    assert lines["period.compute"].startswith("period.compute = 50 ms")


def test_references_are_never_resolved(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MODEL", "a-secret")
    for command in ("show", "check", "export"):
        assert "a-secret" not in run("config", command, "sim.config.yaml").output
    assert run("config", "get", "sim.config.yaml", "Yolo.model").output == "{env: MODEL}\n"


def test_show_as_json(run: Run) -> None:
    rows = json.loads(run("config", "show", "sim.config.yaml", "--format", "json").output)["values"]
    speed = next(row for row in rows if row["path"] == "speed")
    assert speed == {
        "path": "speed",
        "value": 0.25,
        "unit": "m/s",
        "editable": False,
        "default": False,
        "file": "sim.config.yaml",
        "line": 3,
        "overrode": [{"value": 0.5, "file": "etc/config.yaml", "line": 3}],
    }


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("speed", "0.25"),
        ("motors[1].vel", "1"),
        ("motors.1.name", "b"),
        ("Yolo", "{use_gpu: false, model: {env: MODEL}}"),
        ("motors", "[{name: a, vel: 0.9}, {name: b, vel: 1}]"),
    ],
)
def test_get(run: Run, path: str, value: str) -> None:
    assert run("config", "get", "sim.config.yaml", path).output == f"{value}\n"


@pytest.mark.parametrize(
    ("path", "value", "before", "after"),
    [
        ("speed", "0.75", "  speed: .5   # half\n", "  speed: 0.75   # half\n"),
        ("motors[1].vel", "1.5", "      vel: 1\n", "      vel: 1.5\n"),
        ("motors[0].vel", "0", "    - {name: a}\n", "    - {name: a, vel: 0}\n"),
        ("motors[1].name", "c d", "    - name: b   # the second\n", "    - name: c d   # the second\n"),
        ("motors[1].name", "7", "    - name: b   # the second\n", '    - name: "7"   # the second\n'),
        ("device", "/dev/x #1", "      vel: 1\n", '      vel: 1\n  device: "/dev/x #1"\n'),
        ("Yolo.use_gpu", "true", "      vel: 1\n", "      vel: 1\n  Yolo:\n    use_gpu: true\n"),
        ('offsets["a b"]', "1", "      vel: 1\n", "      vel: 1\n  offsets:\n    a b: 1\n"),
        ("speed", "{env: SPEED}", "  speed: .5   # half\n", "  speed: {env: SPEED}   # half\n"),
        ("device", "{env: BUS}", "      vel: 1\n", "      vel: 1\n  device: {env: BUS}\n"),
        ("motors[1].vel", "null", "      vel: 1\n", "      vel: null\n"),
        ("motors[2]", "{name: c}", "      vel: 1\n", "      vel: 1\n    - {name: c}\n"),
        ("motors[2].name", "c", "      vel: 1\n", "      vel: 1\n    - {name: c}\n"),
    ],
)
@pytest.mark.parametrize("line_end", ["\n", "\r\n"])
def test_set_changes_one_place(
    run: Run, tmp_path: Path, path: str, value: str, before: str, after: str, line_end: str
) -> None:
    file = tmp_path / "etc/config.yaml"
    file.write_bytes(BASE.replace("\n", line_end).encode())
    result = run("config", "set", "etc/config.yaml", path, value)
    assert result.exit_code == 0, result.output
    assert before in BASE
    assert file.read_bytes().decode() == BASE.replace(before, after).replace("\n", line_end)


@pytest.mark.parametrize(
    ("before", "path", "value", "after"),
    [
        ("motors: [{name: a}]", "motors[1]", "{name: b}", "motors: [{name: a}, {name: b}]"),
        ("ids: []", "ids[0]", "a # b", 'ids: ["a # b"]'),
        ("grid:\n  - - 1  # one\n", "grid[0][1]", "2", "grid:\n  - - 1  # one\n    - 2\n"),
        ("grid:\n  - - 1  # one\n", "grid[1]", "[2]", "grid:\n  - - 1  # one\n  - [2]\n"),
    ],
)
def test_set_adds_behind_the_last_entry(
    rcyaml: Run, tmp_path: Path, before: str, path: str, value: str, after: str
) -> None:
    write_tree(
        tmp_path,
        {
            "c.cdsl.yaml": "component: C\nlanguage: python\n",
            "c.pdsl.yaml": "component: c.cdsl.yaml\ntypes: {Motor: {struct: {name: string}}}\nparameters:\n"
            "  motors: {list: Motor, default: []}\n  ids: {list: string, default: []}\n"
            "  grid: {list: {list: int}, default: []}\n",
            "x.config.yaml": f"component: c.cdsl.yaml\nparameters:\n  {before.replace(chr(10), chr(10) + '  ').rstrip()}\n",
        },
    )
    result = rcyaml("config", "set", "x.config.yaml", path, value)
    assert result.exit_code == 0, result.output
    written = (tmp_path / "x.config.yaml").read_text().partition("parameters:\n")[2]
    assert written == f"  {after.replace(chr(10), chr(10) + '  ').rstrip()}\n"


def test_get_and_set_as_json(run: Run) -> None:
    def answer(*words: str, code: int = 0) -> dict[str, object]:
        result = run("config", *words, "--format", "json")
        assert result.exit_code == code, result.output
        return json.loads(result.output)  # type: ignore[no-any-return]

    assert answer("get", "etc/config.yaml", "motors[1].vel") == {"path": "motors[1].vel", "value": 1.0}
    changed = answer("set", "etc/config.yaml", "speed", "0.75")
    assert changed == {"path": "speed", "value": "0.75", "was": ".5"}
    [wrong] = answer("set", "etc/config.yaml", "speed", "7", code=1)["diagnostics"]  # type: ignore[misc]
    assert (wrong["code"], wrong["file"], wrong["line"]) == ("RC3303", "value", 1)


def test_set_does_not_make_a_list_that_a_layer_holds(run: Run) -> None:
    result = run("config", "set", "sim.config.yaml", "motors[0].vel", "1")
    assert result.exit_code == 2
    assert "there is no list to append to; set the whole list" in result.stderr


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        ("device", "{env: MY-BUS}", "RC3309"),
        ("device", "{env: }", "RC3309"),
        ("device", "{file: dev/}", "RC3309"),
        ("device", "{env: BUS, file: bus}", "RC3309"),
        ("device", "{file: [bus]}", "RC3309"),
        ("device", "{env: BUS, x}", "RC3309"),
        ("speed", "1", "error[RC3303]: speed is 1 m/s, and must be at least 0 and below 1 m/s"),
        ("motors[1].vel", "fast", "error[RC3302]: motors[1].vel must be a number (rad/s), and is the text 'fast'"),
        ("mode", "slo", "did you mean 'slow'?"),
        ("motors[1].name", "a", "error[RC3308]: two motors have the same name"),
        ("speed", "[", "'[' is not a value"),
        ("motors", "[]", "error[RC3305]: motors has 0 elements, and must have 1 to 4"),
        ("sped", "1", "unknown parameter 'sped'; did you mean 'speed'?"),
        ("Ice.MessageSizeMax", "3", "write `ice: {MessageSizeMax: …}` in a values document"),
        ("motors[7].vel", "1", "the list has 2 elements"),
        ("speed", "0.1, device: x", "speed must be a number (m/s), and is a mapping"),
    ],
)
def test_set_refuses(run: Run, tmp_path: Path, path: str, value: str, message: str) -> None:
    result = run("config", "set", "etc/config.yaml", path, value)
    assert result.exit_code != 0
    assert message in result.stderr
    assert (tmp_path / "etc/config.yaml").read_text() == BASE


def test_check_tells_all_at_once(run: Run, tmp_path: Path) -> None:
    (tmp_path / "bad.config.yaml").write_text(
        "component: speech.cdsl.yaml\nparameters:\n  speed: 3\n  mode: 1\n  motors: [{nam: x}]\n  Yolo: {use_gpu: 1}\n"
    )
    result = run("config", "check", "bad.config.yaml", "--format", "json")
    told = json.loads(result.output)["diagnostics"]
    assert [(d["code"], d["line"], d["column"]) for d in told] == [
        ("RC3303", 3, 10),
        ("RC3302", 4, 9),
        ("RC3301", 5, 13),
        ("RC3302", 6, 19),
    ]
    assert result.exit_code == 1


def test_new_checks_and_says_what_there_is(run: Run, tmp_path: Path) -> None:
    (tmp_path / "etc/config.yaml").unlink()
    (tmp_path / "sim.config.yaml").unlink()
    assert run("config", "new", "speech.cdsl.yaml").exit_code == 0
    text = (tmp_path / "etc/config.yaml").read_text()
    assert text.startswith("# yaml-language-server: $schema=../generated/config.schema.json\n")
    assert "  # The bus.\n  # text\n  # device: /dev/ttyUSB0\n" in text
    assert run("config", "check", "etc/config.yaml").exit_code == 0
    uncommented = "".join(
        f"{line.replace('# ', '', 1)}\n" if ": " in line.partition("# ")[2] and line.startswith("  ") else f"{line}\n"
        for line in text.splitlines()
    )
    (tmp_path / "etc/config.yaml").write_text(uncommented)
    assert run("config", "check", "etc/config.yaml").exit_code == 0, uncommented
    assert run("config", "new", "speech.cdsl.yaml").exit_code == 2  # it is there already


def test_export_as_toml_is_toml(run: Run) -> None:
    import tomllib

    read = tomllib.loads(run("config", "export", "--as", "toml", "sim.config.yaml").output)
    assert read["speed"] == 0.25
    assert read["motors"] == [{"name": "a", "vel": 0.9}, {"name": "b", "vel": 1.0}]
    assert read["Yolo"] == {"use_gpu": False, "model": "${env:MODEL}"}


def test_export_as_properties(run: Run) -> None:
    lines = run("config", "export", "sim.config.yaml").output.splitlines()
    assert {"speed=0.25", "motors.size=2", "motors.1.vel=1", "Yolo.model=${env:MODEL}", "period.compute=50"} <= set(
        lines
    )


def test_a_document_without_component(run: Run, tmp_path: Path) -> None:
    (tmp_path / "lone.config.yaml").write_text("parameters: {speed: 1}\n")
    assert "RC3323" in run("config", "check", "lone.config.yaml").output
    assert run("config", "show", "lone.config.yaml").exit_code == 1


def test_what_is_wrong_in_another_document_is_none_of_its_business(run: Run, tmp_path: Path) -> None:
    """The component's own etc/config.yaml is no layer of one that does not extend it."""
    (tmp_path / "etc/config.yaml").write_text(BASE.replace("speed: .5", "speed: 7"))
    (tmp_path / "own.config.yaml").write_text(
        "component: speech.cdsl.yaml\nparameters: {speed: 0.1, motors: [{name: a}]}\n"
    )
    assert run("config", "check", "own.config.yaml").exit_code == 0
    assert run("config", "get", "own.config.yaml", "speed").output == "0.1\n"
    assert run("config", "check", "sim.config.yaml").exit_code == 1
