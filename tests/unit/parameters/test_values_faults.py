"""What is wrong with values: each at its place, all at once, one for each cause."""

from __future__ import annotations

from pathlib import Path

import pytest

from conftest import write_tree
from robocomp_yaml.pipeline import analyse

PDSL = """\
component: c.cdsl.yaml
types:
  Mode: {enum: [slow, fast]}
  Motor:
    struct:
      name: string
      vel: {type: float, range: [0, 2], default: 1, unit: rad/s}
      pose: {list: int, size: 2, default: [0, 0]}
parameters:
  volume: {type: int, range: [0, 100], default: 50, unit: percent}
  ratio: {type: double, range: {above: 0, below: 1}, default: 0.5}
  big: {type: long, default: 0}
  mode: {type: Mode, default: slow}
  device: {type: string, pattern: "/dev/\\\\w+", optional: true}
  baud: {type: int, values: [9600, 115200], default: 9600}
  motors: {list: Motor, size: [1, 2]}
  ids: {list: string, unique: true, default: []}
  offsets: {map: float, size: {to: 2}, default: {}}
  Yolo: {group: {gpu: bool, model: {type: string, optional: true}}}
constraints:
  - {that: "sum(m.vel for m in motors) < 3", else: together too fast}
"""
GOOD = "component: c.cdsl.yaml\nparameters:\n  motors: [{name: a}]\n  Yolo: {gpu: true}\n"


def faults(folder: Path, text: str, **layers: str) -> list[str]:
    write_tree(
        folder,
        {
            "c.cdsl.yaml": "component: C\nlanguage: python\n",
            "c.pdsl.yaml": PDSL,
            "x.config.yaml": text,
            **{f"{name}.config.yaml": content for name, content in layers.items()},
        },
    )
    found = analyse([str(folder / "x.config.yaml")]).diagnostics
    return [f"{d.span.line}:{d.span.column} {d.code} {d.message}" + (f" ({d.hint})" if d.hint else "") for d in found]


def test_good_values_have_no_faults(tmp_path: Path) -> None:
    assert faults(tmp_path, GOOD) == []


def test_what_extends_nothing_is_told_once(tmp_path: Path) -> None:
    """That it belongs to no component follows from that."""
    assert [fault.split()[1] for fault in faults(tmp_path, "extends: [nope.config.yaml]\n")] == ["RC3321"]
    assert [fault.split()[1] for fault in faults(tmp_path, "extends: [x.config.yaml]\n")] == ["RC3322"]


@pytest.mark.parametrize(
    ("line", "fault"),
    [
        ("volume: 101", "5:11 RC3303 volume is 101 percent, and must be from 0 to 100 percent"),
        ("volume: 1.5", "5:11 RC3302 volume must be a whole number (percent), and is 1.5"),
        ("volume: true", "5:11 RC3302 volume must be a whole number (percent), and is true"),
        (
            'volume: "7"',
            "5:11 RC3302 volume must be a whole number (percent), and is the text '7' (write it without quotes: 7)",
        ),
        ("volume: [1]", "5:11 RC3302 volume must be a whole number (percent), and is a list"),
        (
            "volume: {env: 1A}",
            "5:17 RC3309 volume does not name an environment variable (a variable's name has letters, "
            "digits and underscores, and does not start with a digit)",
        ),
        ("ratio: 1", "5:10 RC3303 ratio is 1, and must be above 0 and below 1"),
        ("ratio: .nan", "5:10 RC3302 ratio must be a number, and is .nan"),
        ("ratio: 1e999", "5:10 RC3302 ratio must be a number, and is 1e999"),
        (
            "big: 9223372036854775808",
            "5:8 RC3303 big is 9223372036854775808, and must be from -9223372036854775808 to "
            "9223372036854775807 (long)",
        ),
        ("mode: fats", "5:9 RC3303 mode is 'fats', and must be one of slow, fast (did you mean 'fast'?)"),
        ("device: x/dev/a", "5:11 RC3304 device is 'x/dev/a', and must match /dev/\\w+"),
        ("device: 7", '5:11 RC3302 device must be text, and is 7 (text needs quotes here: "7")'),
        ("baud: 9601", "5:9 RC3303 baud is 9601, and must be one of 9600, 115200"),
        ("ids: [a, b, a]", "5:15 RC3306 ids contains the text 'a' twice"),
        ("offsets: {a: 1, b: 2, c: 3}", "5:12 RC3305 offsets has 3 elements, and must have at most 2"),
        ("offsets: {a b: x}", "5:18 RC3302 offsets[\"a b\"] must be a number, and is the text 'x'"),
        ("volum: 1", "5:3 RC3301 unknown parameter 'volum' (did you mean 'volume'?)"),
        (
            "<<: {volume: 1}",
            "5:3 RC3301 unknown parameter '[\"<<\"]' (YAML 1.2 has no merge keys: write the keys themselves)",
        ),
        (
            f"big: {10**50}",
            f"5:8 RC3303 big is 1{38 * '0'}…, and must be from -9223372036854775808 to 9223372036854775807 (long)",
        ),
        ("volume: 1\n  volumee: 1", "6:3 RC3301 unknown parameter 'volumee' ('volume' is already present)"),
        ("period: {compute: 0}", "5:21 RC3303 period.compute is 0 ms, and must be at least 1 ms"),
    ],
)
def test_one_fault(tmp_path: Path, line: str, fault: str) -> None:
    assert faults(tmp_path, f"{GOOD}  {line}\n") == [fault]


def test_words_that_were_truths_in_yaml_1_1(tmp_path: Path) -> None:
    (fault,) = faults(tmp_path, GOOD.replace("true", "Off"))
    assert fault == "4:15 RC3302 Yolo.gpu must be true or false, and is the text 'Off' (write false)"


def test_faults_deep_inside_and_all_at_once(tmp_path: Path) -> None:
    text = "component: c.cdsl.yaml\nparameters:\n  motors:\n    - {nam: a, vel: 3}\n    - {vel: 1, pose: [1, x, 2]}\n"
    assert faults(tmp_path, text) == [
        "2:1 RC3307 Yolo.gpu has no value, and no default (set it to true or false)",
        "4:8 RC3301 unknown parameter 'motors[0].nam' (did you mean 'name'?)",
        "4:21 RC3303 motors[0].vel is 3 rad/s, and must be from 0 to 2 rad/s",
        "5:7 RC3307 motors[1].name has no value, and no default (set it to text)",
        "5:22 RC3305 motors[1].pose has 3 elements, and must have exactly 2",
        "5:26 RC3302 motors[1].pose[1] must be a whole number, and is the text 'x'",
    ]


def test_a_constraint_is_told_at_the_value(tmp_path: Path) -> None:
    text = GOOD.replace("[{name: a}]", "[{name: a, vel: 2}, {name: b, vel: 1.5}]")
    assert faults(tmp_path, text) == ["3:3 RC3308 together too fast (sum(m.vel for m in motors) < 3)"]


def test_a_layer_has_its_faults_at_its_own_lines(tmp_path: Path) -> None:
    base = "parameters:\n  volume: 200\n  offsets: {a: 1, b: 2}\n"
    text = GOOD.replace("parameters:", "extends: [base.config.yaml]\nparameters:\n  offsets: {c: 3}")
    assert faults(tmp_path, text, base=base) == [
        "2:11 RC3303 volume is 200 percent, and must be from 0 to 100 percent",
        "4:12 RC3305 offsets has 3 elements, and must have at most 2",
    ]


def test_layers_merge_replace_and_return_to_defaults(tmp_path: Path) -> None:
    from robocomp_yaml.parameters.layers.effective import effective

    base = "parameters:\n  volume: 20\n  offsets: {a: 1, b: 2}\n  ids: [x, y]\n  device: /dev/a\n"
    top = "extends: [base.config.yaml]\nparameters:\n  volume: null\n  offsets: {b: 3}\n  ids: [z]\n  device:\n"
    write_tree(
        tmp_path,
        {
            "c.cdsl.yaml": "component: C\nlanguage: python\n",
            "c.pdsl.yaml": PDSL,
            "base.config.yaml": base,
            "x.config.yaml": GOOD.replace("parameters:\n", top),
        },
    )
    analysis = analyse([str(tmp_path / "x.config.yaml")])
    assert not analysis.diagnostics
    found, _ = effective(analysis.program.values[str(tmp_path / "x.config.yaml")])
    assert found is not None
    data = found.data
    assert (data["volume"], data["offsets"], data["ids"], "device" in data) == (50, {"a": 1, "b": 3}, ["z"], False)


@pytest.mark.parametrize(
    "text",
    [
        "parameters: {motors: {env: HOME}}\n",
        "parameters: []\n",
        "extends: [x.config.yaml]\n",
        "parameters: {Yolo: 3}\n",
        "extends: [c.pdsl.yaml]\n",
        "component: x.config.yaml\n",
        "parameters: {motors: [[[[]]]]}\n",
        "component: ..\n",
        "parameters: {offsets: {? a : b}}\n",
        "parameters: {big: 1" + "0" * 5000 + "}\n",
    ],
)
def test_nothing_gives_a_traceback(tmp_path: Path, text: str) -> None:
    assert faults(tmp_path, ("component: c.cdsl.yaml\n" if "component" not in text else "") + text)


@pytest.mark.parametrize(
    "pdsl",
    [
        "types: {M: {struct: {a: int}}}\nparameters: {m: {list: M}}\nlegacy: {m: {key: 'M{no}', columns: [a]}}\n",
        "parameters: {m: {list: {list: int}, default: [[1, 0: 0]]}}\n",
        "parameters: {m: {type: int, default: [1]}}\n",
        "parameters: {m: {type: int, default: {env: X}}}\n",
        "parameters: {m: {type: int, range: [.inf, 1e999]}}\n",
        "parameters: {m: {type: int, values: [.nan, 1e400]}}\n",
        "parameters: {m: {type: strnig}}\n",
        "parameters: {m: {map: int, size: [3, 1], default: {a: x}}}\n",
        "parameters: {m: {}}\nconstraints: ['(((', '1', m]\n",
        "types: {A: {list: B}, B: {list: A}}\nparameters: {m: A}\n",
        "types: {"
        + ", ".join(f"T{n}: {{list: T{n + 1}}}" for n in range(90))
        + ", T90: {type: int}}\nparameters: {m: T0}\n",
    ],
)
def test_values_of_faulty_parameters_give_no_traceback(tmp_path: Path, pdsl: str) -> None:
    write_tree(
        tmp_path,
        {
            "c.cdsl.yaml": "component: C\nlanguage: python\n",
            "c.pdsl.yaml": f"component: c.cdsl.yaml\n{pdsl}",
            "x.config.yaml": "component: c.cdsl.yaml\nparameters: {m: [{a: 1}]}\n",
            "rcyaml.yaml": "lint: {RC3113: warning, RC3121: warning}\n",
        },
    )
    assert analyse([str(tmp_path)]).diagnostics
