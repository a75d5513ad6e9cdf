"""The values of a flat `etc/config` that rcyaml wrote are judged at their lines; others are the user's business."""

from __future__ import annotations

from pathlib import Path

import pytest

from conftest import write_tree
from robocomp_yaml.api import load
from robocomp_yaml.api.values import Values
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.pipeline import analyse

PDSL = """\
component: arm.cdsl.yaml
types:
  Joint: {struct: {name: string, max: {type: float, range: [0, 2], default: 1}}}
parameters:
  speed: {type: float, range: {from: 0, below: 1}, default: 0.5, unit: m/s}
  side: {type: string, values: [left, right], default: left}
  grip: {group: {force: {type: int, range: [1, 9], default: 3}}}
  joints: {list: Joint, default: []}
  gains: {map: float, default: {}}
"""
FACE = "module: RoboCompFace\ninterfaces: {Speech: {methods: {say: }}, Mouth: {methods: {open: }}}\n"
CDSL = "component: ArmComp\nlanguage: python\nimports: [Face]\nimplements: [Speech]\nrequires: [Mouth]\n"
HEAD = "# Configuration of ArmComp: one KEY=VALUE per line, as Ice reads it. rcyaml wrote it once; it is yours.\n"


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def found(flat: str, **others: str) -> list[Diagnostic]:
    write_tree(
        Path(), {"Face.idsl.yaml": FACE, "arm.cdsl.yaml": CDSL, "arm.pdsl.yaml": PDSL, "etc/config": flat, **others}
    )
    return [one for one in analyse(["arm.cdsl.yaml"]).diagnostics if one.span.file == "etc/config"]


@pytest.mark.parametrize(
    ("line", "code", "column", "message", "hint"),
    [
        ("speed=1", "RC3303", 7, "speed is 1 m/s, and must be at least 0 and below 1 m/s", ""),
        ("  speed =  1.5  # fast", "RC3303", 12, "speed is 1.5 m/s, and must be at least 0 and below 1 m/s", ""),
        ("speed=fast", "RC3302", 7, "speed must be a number (m/s), and is the text 'fast'", ""),
        ("side=leftt", "RC3303", 6, "side is 'leftt', and must be one of left, right", "did you mean 'left'?"),
        ("grip.force=0", "RC3303", 12, "grip.force is 0, and must be from 1 to 9", ""),
        ("joints.0.max=3", "RC3303", 14, "joints[0].max is 3, and must be from 0 to 2", ""),
        ("period.compute=0", "RC3303", 16, "period.compute is 0 ms, and must be at least 1 ms", ""),
        ("sped=0.3", "RC3301", 1, "unknown parameter 'sped'", "did you mean 'speed'?"),
        ("Speed=0.3", "RC3301", 1, "unknown parameter 'Speed'", "did you mean 'speed'?"),
        ("grip.forze=3", "RC3301", 1, "unknown parameter 'grip.forze'", "did you mean 'grip.force'?"),
        ("period.computer=3", "RC3301", 1, "unknown parameter 'period.computer'", "did you mean 'period.compute'?"),
        (
            "Speach.Endpoints=tcp -p 1",
            "RC3324",
            1,
            "component ArmComp has no interface 'Speach'",
            "did you mean 'Speech'?",
        ),
        ("MouthPrxy=mouth:tcp -p 1", "RC3301", 1, "unknown parameter 'MouthPrxy'", "did you mean 'MouthProxy'?"),
    ],
)
def test_an_error_at_its_line(line: str, code: str, column: int, message: str, hint: str) -> None:
    (one,) = found(f"{HEAD}\n{line}\n")
    assert (one.code, one.span.line, one.span.column, one.message) == (code, 3, column, message)
    assert hint in one.hint and one.severity == ("warning" if code == "RC3324" else "error")


@pytest.mark.parametrize(
    "line",
    [
        "speed=0.3", "side=right", "grip.force=9", "joints.size=1\njoints.0.name=x", "gains.keys=a\ngains.a=1",
        "speed=${env:SPEED}", "Ice.Trace.Network=1", "Speech.ThreadPool.Size=3", "CommonBehavior.Endpoints=tcp -p 1",
        "MouthProxy.ConnectionTimeout=5", "Endpoints.Speech=tcp -p 1", "Proxies.Mouth=mouth:tcp -p 1", "speed=",
        "IceSSL.DefaultDir=certs", "TopicManager.Proxy=x:tcp -p 1", "Extra.Endpoints=tcp -p 1",
    ],
)  # fmt: skip
def test_what_a_component_reads_is_right(line: str) -> None:
    assert not found(f"{HEAD}{line}\n")


@pytest.mark.parametrize("name", ["Period.Compute", "Period.Emergency"])
def test_the_names_of_robocomp_for_periods_are_read(name: str) -> None:
    assert not found(f"{HEAD}{name}=50\n")
    (one,) = found(f"{HEAD}{name}=0\n")
    assert (one.code, one.span.line, one.span.column) == ("RC3303", 2, len(name) + 2)


@pytest.mark.parametrize("line", ["period.Compute=50", "Period.compute=50", "PERIOD.COMPUTE=50", "Period.Computer=50"])
def test_other_spellings_of_periods_are_not_read(line: str) -> None:
    (one,) = found(f"{HEAD}{line}\n")
    assert (one.code, one.severity) == ("RC3301", "error") and "did you mean 'period.compute'?" in one.hint


def test_a_property_of_ones_own_is_only_a_warning() -> None:
    (one,) = found(f"{HEAD}Vendor.Serial=A17\n")
    assert (one.code, one.severity) == ("RC3301", "warning") and "properties:" in one.hint


def test_the_last_line_of_a_property_counts() -> None:
    assert [one.code for one in found(f"{HEAD}speed=7\nspeed=0.7\n")] == ["RC3336"]
    assert not found(f"{HEAD}speed=0.7\nspeed=0.7\n")


def test_a_file_that_rcyaml_did_not_write_is_not_judged() -> None:
    assert not found("speed=7\nsped=1\n")


@pytest.mark.parametrize("text", ["0x10", "0o7", "5e0", "4.9999999999999999999", "1_0", "+3", "true", ".5e1"])
def test_numbers_are_judged_as_the_component_reads_them(text: str) -> None:
    """YAML has more ways to write them."""
    from robocomp_yaml.semantics.plain import PlainKind  # the judge of the component

    judged = found(f"{HEAD}grip.force={text}\n")
    kind = PlainKind("int")
    assert [one.code for one in judged] == (["RC3302"] if kind.read(text) is None else [])


def test_constraints_are_judged_without_a_deployment() -> None:
    pdsl = PDSL + "constraints: [{that: speed < 0.9 or side == 'left', else: too fast}]\n"
    (one,) = found(f"{HEAD}side=right\nspeed=0.95\n", **{"arm.pdsl.yaml": pdsl})
    assert (one.code, one.message) == ("RC3308", "too fast")
    assert not found(f"{HEAD}side=right\nspeed=0.5\n", **{"arm.pdsl.yaml": pdsl})
    needed = pdsl.replace("default: 0.5, unit", "unit")
    assert not found(f"{HEAD}side=right\n", **{"arm.pdsl.yaml": needed}), "it may be set elsewhere"


NEEDED = """\
component: arm.cdsl.yaml
types: {Joint: {struct: {name: string, max: float}}}
parameters: {speed: float, grip: {group: {force: int}}, joints: {list: Joint, default: []}}
"""


def missing(flat: str, *paths: str, **others: str) -> list[tuple[str, str, str, int]]:
    files = {"Face.idsl.yaml": FACE, "arm.cdsl.yaml": CDSL, "arm.pdsl.yaml": NEEDED, "etc/config": flat, **others}
    write_tree(Path(), files)
    shown = [one for one in load(*(paths or ["arm.cdsl.yaml"])).check() if one.code in ("RC3301", "RC3307")]
    return [(one.severity, one.code, str(one.fact("path")), one.span.line) for one in shown]


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        ("", ["grip.force", "speed"]),
        ("speed=1\n", ["grip.force"]),
        ("speed=1\ngrip.force=\n", ["grip.force"]),
        ("speed=1\ngrip.force=2\njoints.0.max=1\njoints.1.name=x\n", ["joints[1].max"]),
        ("speed=${env:SPEED}\ngrip.force=2\n", []),
    ],
)
def test_missing_values_are_reported_without_a_deployment(lines: str, expected: list[str]) -> None:
    assert [(one[0], one[2]) for one in missing(f"{HEAD}{lines}")] == [("warning", path) for path in expected]
    assert not missing(f"# mine\n{lines}"), "a file that rcyaml did not write is not judged"


def test_a_misspelled_value_is_not_missing_as_well() -> None:
    assert missing(f"{HEAD}sped=1\ngrip.force=2\n") == [("error", "RC3301", "sped", 2)]


def test_what_a_deployment_starts_is_judged_with_what_it_sets() -> None:
    deployment = "deployment: D\ncomponents: {arm: {component: ., set: {speed: 1}}}\n"
    paths = ["arm.cdsl.yaml", "d.ddsl.yaml"]
    assert missing(f"{HEAD}grip.force=2\n", *paths, **{"d.ddsl.yaml": deployment}) == []
    assert missing(HEAD, *paths, **{"d.ddsl.yaml": deployment}) == [("error", "RC3307", "grip.force", 2)]


def test_config_check_of_a_flat_config_needs_all_values() -> None:
    assert missing(f"{HEAD}speed=1\n")
    assert [(one.severity, one.code) for one in Values("etc/config").diagnostics] == [("error", "RC3307")]


def test_no_fix_edits_it() -> None:
    assert not found(f"{HEAD}Speed=0.3\n")[0].fixes


def test_beside_a_values_document_it_is_judged_if_it_counts() -> None:
    values = {"etc/config.yaml": "component: ../arm.cdsl.yaml\nparameters: {speed: 0.1}\n"}
    (one,) = found(f"{HEAD}speed=7\n", **values)
    assert one.code == "RC3303"
