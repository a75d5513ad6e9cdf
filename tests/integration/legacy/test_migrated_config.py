"""Flat configs: sections, types, records and lists, comments, and the parameters that they imply."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree
from robocomp_yaml.legacy.formats import recognize
from robocomp_yaml.legacy.reading import SourceText

Run = Callable[..., Result]

SPEECH = "module RoboCompSpeech { interface Speech { void say(string text); }; };\n"
CDSL = (
    'import "Speech.idsl";\nComponent SpeechComp { Communications { implements Speech; requires Speech; }; '
    "language python; };\n"
)
REPOSITORY = {"interfaces/Speech.idsl": SPEECH, "speech/speech.cdsl": CDSL}
PARAMETERS = "speech/SpeechComp.pdsl.yaml"


def migrated(rcyaml: Run, folder: Path, *arguments: str, code: int = 0, **configs: str) -> Callable[[str], str]:
    """Migrate a component with configs in its `etc/`, and return a function for the text of a document without
    modeline."""
    write_tree(folder, {**REPOSITORY, **{f"speech/etc/{name}": text for name, text in configs.items()}})
    result = rcyaml("migrate", ".", "--report", "ledger.json", *arguments)
    assert result.exit_code == code, result.output
    if code == 0:
        checked = rcyaml("check", ".")
        assert checked.exit_code == 0, checked.output
    return lambda name: (folder / name).read_text(encoding="utf-8").split("\n", 1)[1]


def test_each_setting_is_in_its_section(rcyaml: Run, tmp_path: Path) -> None:
    text = migrated(
        rcyaml,
        tmp_path,
        config="""\
# where it is
Speech.Endpoints=tcp -p 10001
CommonBehavior.Endpoints = tcp -p 11001
SpeechProxy = speech:tcp -h localhost -p 10002
other = agent:tcp -p 3
TopicManager.Proxy=IceStorm/TopicManager:default -p 9999
EventsTopic = EventsTopic
Ice.Warn.Connections=0
IceStorm.Trace = 1
Device = /dev/ttyUSB0   # the mouth
#Device = /dev/ttyUSB1
Rate=2000.
Gain = 0.10
Debug = True
Serial = 049522250171
Zero = 0,5
Mode = on
; Old = 1
""",
    )
    assert (
        text("speech/etc/config.yaml")
        == """\
component: ../speech.cdsl.yaml
parameters:
  Device: /dev/ttyUSB0  # the mouth
  # Device = /dev/ttyUSB1
  Rate: 2000.
  Gain: 0.10
  Debug: True
  Serial: "049522250171"
  Zero: 0,5
  Mode: on
endpoints:
  # where it is
  Speech: tcp -p 10001
  CommonBehavior: tcp -p 11001
proxies:
  Speech: speech:tcp -h localhost -p 10002
  other: {proxy: "agent:tcp -p 3", key: other}
topics:
  manager: IceStorm/TopicManager:default -p 9999
  name:
    EventsTopic: EventsTopic
ice:
  Warn.Connections: "0"
properties:
  IceStorm.Trace: "1"
  ; Old: "1"
legacy: {file: config}
"""
    )
    assert (
        text(PARAMETERS)
        == """\
component: speech.cdsl.yaml
parameters:
  Device: string
  Rate: float
  Gain: float
  Debug: bool
  Serial: string
  Zero: string
  Mode: string
"""
    )


def test_flat_toml_is_detected_by_its_keys_and_keeps_its_quotes(rcyaml: Run, tmp_path: Path) -> None:
    text = migrated(
        rcyaml,
        tmp_path,
        config="""\
Endpoints.Speech = "tcp -p 10001"
Proxies.Speech = "speech:tcp -h localhost -p 10002"
Proxies.TopicManager = "IceStorm/TopicManager:default -p 9999"
Proxies.EventsPubPrefix = ""
Period.Compute = 100
Agent.2d = true
Agent.name = "head"
Stream.Host = localhost
Ice.Warn.Connections = "0"
Ice.Trace.Network = 0
Ice.Trace.Protocol = " ""0"
""",
    )
    values = text("speech/etc/config.yaml")
    assert (
        "period:\n    compute: 100\n  Agent:\n    2d: true\n    name: head\n  Stream:\n    Host: localhost\n" in values
    )
    assert 'prefix:\n    EventsPub: ""\n' in values
    assert 'Warn.Connections: "0"\n  Trace.Network: 0\n' in values
    assert values.endswith("legacy:\n  file: config\n  dialect: flat-toml\n  exact:\n    Stream.Host: localhost\n")
    assert "2d: {type: bool, as: p2d}" in text(PARAMETERS)
    assert "legacy:\n  period.compute: Period.Compute\n" in text(PARAMETERS)
    exported = rcyaml("config", "export", "speech/etc/config.yaml").stdout
    assert 'Proxies.EventsPubPrefix=""\n' in exported and "Stream.Host=localhost\n" in exported
    assert 'Ice.Warn.Connections="0"\nIce.Trace.Network=0\nIce.Trace.Protocol=" ""0"\n' in exported


def test_a_hash_in_the_quotes_of_flat_toml_is_text(rcyaml: Run, tmp_path: Path) -> None:
    text = migrated(rcyaml, tmp_path, config='Period.Compute = 5\nTitle = "a # b" # said\n')
    assert '  Title: "a # b"  # said\n' in text("speech/etc/config.yaml")
    assert _codes(tmp_path) == {"RC5005"}


def _codes(folder: Path) -> set[str]:
    files = json.loads((folder / "ledger.json").read_text(encoding="utf-8"))["files"]
    return {diagnostic["code"] for file in files for diagnostic in file["diagnostics"]}


def test_rows_are_records_named_by_the_comment_above_them(rcyaml: Run, tmp_path: Path) -> None:
    text = migrated(
        rcyaml,
        tmp_path,
        config="""\
Arm.NumMotors = 3
# Arm.M = a, b
# Motor: name, id, zero (in radians), Positive Range
#Arm.M0 = old,0,0,0
Arm.M0 = left, 1,\t0.5, true
Arm.M1 = right, 2, 1, false  # the bad one
""",
    )
    assert (
        text("speech/etc/config.yaml")
        == """\
component: ../speech.cdsl.yaml
parameters:
  Arm:
    NumMotors: 3
    M:
      # Arm.M = a, b
      # Motor: name, id, zero (in radians), Positive Range
      # Arm.M0 = old,0,0,0
      - {name: left, id: 1, zero: 0.5, positive_range: true}
      - {name: right, id: 2, zero: 1, positive_range: false}  # the bad one
legacy: {file: config}
"""
    )
    parameters = text(PARAMETERS)
    assert "      zero: {type: float, doc: in radians}\n      positive_range: {type: bool, doc: Positive" in parameters
    assert "M: {list: M}  # rcyaml: guessed\n" in parameters
    assert 'Arm.M: {key: "Arm.M{i}", columns: [name, id, zero, positive_range], separator: ", "}' in parameters
    assert _codes(tmp_path) == {"RC5028"}


def test_blanks_in_rows_are_kept_only_on_request(rcyaml: Run, tmp_path: Path) -> None:
    config = "# name, id\nM0 = a,1\nM1 = b,2\nM2 = c,\t3\n"
    text = migrated(rcyaml, tmp_path, config=config)
    assert text("speech/etc/config.yaml").endswith("legacy: {file: config}\n")
    assert "M2=c,3\n" in rcyaml("config", "export", "speech/etc/config.yaml").stdout
    text = migrated(rcyaml, tmp_path, "--exact", config=config)
    assert text("speech/etc/config.yaml").endswith('  exact:\n    M2: "c,\\t3"\n')
    assert "M2=c,\t3\n" in rcyaml("config", "export", "speech/etc/config.yaml").stdout


def test_the_user_names_columns_and_types(rcyaml: Run, tmp_path: Path) -> None:
    config = "Joint0 = a,1,7\nJoint1 = b,2,8\nNames = x,y,z\nVolume = 3\n"
    text = migrated(rcyaml, tmp_path, config=config)
    assert "- {f1: a, f2: 1, f3: 7}" in text("speech/etc/config.yaml")
    assert _codes(tmp_path) == {"RC5028", "RC5029"}
    (tmp_path / "rules.yaml").write_text("types: {Volume: float, Joint.gear: string}\ntext: [Names]\n")
    text = migrated(rcyaml, tmp_path, "--names", "Joint=name,id,gear", "--rules", "rules.yaml", config=config)
    assert '- {name: a, id: 1, gear: "7"}' in text("speech/etc/config.yaml")
    assert "  Names: x,y,z\n  Volume: 3\n" in text("speech/etc/config.yaml")
    assert "  Volume: float\n" in text(PARAMETERS)
    assert _codes(tmp_path) == set()


@pytest.mark.parametrize(("arguments", "problem"), [
    (["--names", "Joint"], "--names requires KEY=a,b,c, not 'Joint'"),
    (["--names", "Joint=a,b c"], "must be a list of names"),
    (["--names", "Joint=a,a"], "has the same name twice"),
    (["--rules", "bad.yaml"], "bad.yaml has the unknown key 'name'; the keys are names, types and text"),
    (["--rules", "worse.yaml"], "worse.yaml: Volume cannot have the type 'number'"),
    (["--rules", "worst.yaml"], "worst.yaml is not a YAML mapping"),
])  # fmt: skip
def test_invalid_corrections_are_usage_errors(rcyaml: Run, tmp_path: Path, arguments: list[str], problem: str) -> None:
    write_tree(tmp_path, {
        "bad.yaml": "name: {a: b}\n", "worse.yaml": "types: {Volume: number}\n", "worst.yaml": "- {\n", "config": "a=1\n",
    })  # fmt: skip
    result = rcyaml("migrate", "config", *arguments)
    assert result.exit_code == 2 and problem in result.output, result.output
    assert not (tmp_path / "config.yaml").exists()


def test_parallel_families_are_one_list(rcyaml: Run, tmp_path: Path) -> None:
    text = migrated(rcyaml, tmp_path, config="num_cameras = 2\nrx_0=0.5\nname_0=a\nrx_1=1\nname_1=b\n")
    assert "  cameras:\n    - {rx: 0.5, name: a}\n    - {rx: 1, name: b}\n" in text("speech/etc/config.yaml")
    assert 'cameras: {fields: {rx: "rx_{i}", name: "name_{i}"}}' in text(PARAMETERS)
    assert "  num_cameras: int\n" in text(PARAMETERS)


def test_ranges_in_keys_and_lists_in_values(rcyaml: Run, tmp_path: Path) -> None:
    text = migrated(
        rcyaml,
        tmp_path,
        config="""\
ID:0-10 = 100   # tag size
ID:11-20 = 170   # tag size
Pairs = a,b;c,d;
Arm = one;two
Agents = x,y,z
Two = a,b
Decimal = 1,5
Path = /a b/c,d,e
""",
    )
    values = text("speech/etc/config.yaml")
    assert "    - {from: 0, to: 10, size: 100}  # tag size\n    - {from: 11, to: 20, size: 170}  # tag size\n" in values
    assert "  Pairs: [[a, b], [c, d]]\n  Arm: [one, two]\n  Agents: [x, y, z]\n  Two: [a, b]\n" in values
    assert "  Decimal: 1,5\n  Path: /a b/c,d,e\n" in values
    assert 'ID: {key: "ID:{from}-{to}", columns: [size]}' in text(PARAMETERS)
    assert 'Pairs: {key: Pairs, separators: [;, ","], trailing: true}' in text(PARAMETERS)


def test_lines_without_effect_are_kept_as_comments(rcyaml: Run, tmp_path: Path) -> None:
    text = migrated(
        rcyaml,
        tmp_path,
        "--strict",
        config="""\
Volume = 1
This property is used by the clients.
Volume = 2
Name =
Speed = 3
Speed =
Last = 1
""",
    )
    assert (
        text("speech/etc/config.yaml")
        == """\
component: ../speech.cdsl.yaml
parameters:
  # Volume = 1
  # This property is used by the clients.
  Volume: 2
  # Name =
  # Speed = 3
  # Speed =
  Last: 1
legacy: {file: config}
"""
    )
    (ledger,) = [f for f in json.loads((tmp_path / "ledger.json").read_text())["files"] if f["format"] == "config"]
    assert ledger["lines"] | {"total": 7, "repaired": 5, "converted": 2, "lost": 0} == ledger["lines"]
    assert ledger["outputs"] == ["speech/etc/config.yaml", PARAMETERS]


def test_all_configs_of_a_component_imply_its_parameters(rcyaml: Run, tmp_path: Path) -> None:
    text = migrated(
        rcyaml,
        tmp_path,
        config="Volume = 1\nName = a\nList = a,b\nDevice = x\n",
        config_side="Volume = 1.5\nName = 3\nList = a\n",
        **{"real.conf": "Volume = 2\nName = true\nList = x,y\n"},
    )
    assert text(PARAMETERS).startswith("""\
component: speech.cdsl.yaml
parameters:
  Volume: float
  Name: string
  List: {list: string}  # rcyaml: guessed
  Device: {type: string, optional: true}
""")
    assert 'Name: "3"\n  List: [a]\n' in text("speech/etc/config_side.config.yaml")
    assert "component: ../speech.cdsl.yaml\n" in text("speech/etc/real.config.yaml")


def test_a_pair_of_configs_becomes_two_documents(rcyaml: Run, tmp_path: Path) -> None:
    text = migrated(
        rcyaml,
        tmp_path,
        generic_config="Speech.Endpoints = tcp -p 1\nVolume = 1\n",
        specific_config="Volume = 2\nDevice = x\n",
    )
    values = text("speech/etc/specific_config.config.yaml")
    assert values.endswith("legacy: {file: specific_config, after: generic_config.config.yaml}\n")
    exported = rcyaml("config", "export", "speech/etc/specific_config.config.yaml").stdout
    assert "Speech.Endpoints=tcp -p 1\n" in exported and "Volume=2\n" in exported


def test_a_config_without_a_component_becomes_a_component(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"a/side.conf": "Volume = 1\n", "a/config": "Name = x\n"})
    assert rcyaml("migrate", "a", "--report", "ledger.json").exit_code == 0
    assert _codes(tmp_path) == {"RC5027"}
    assert "component: side.pdsl.yaml\n" in (tmp_path / "a/side.config.yaml").read_text()
    assert "component: side\n" in (tmp_path / "a/side.pdsl.yaml").read_text()
    assert "component: config.pdsl.yaml\n" in (tmp_path / "a/config.yaml").read_text()
    assert rcyaml("check", "a").exit_code == 0


def test_parameters_that_the_user_declared_are_kept(rcyaml: Run, tmp_path: Path) -> None:
    own = "component: speech.cdsl.yaml\nparameters:\n  Volume: {type: float, default: 1}\n"
    write_tree(tmp_path, {"speech/own.pdsl.yaml": own})
    text = migrated(rcyaml, tmp_path, config="Volume = 3\nOther = x\n")
    assert (tmp_path / "speech/own.pdsl.yaml").read_text() == own and not (tmp_path / PARAMETERS).exists()
    assert "parameters:\n  Volume: 3\nproperties:\n  Other: x\n" in text("speech/etc/config.yaml")


def test_a_second_run_changes_nothing_and_edits_are_kept(rcyaml: Run, tmp_path: Path) -> None:
    text = migrated(rcyaml, tmp_path, config="Volume = 3\n")
    before = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*.yaml")}
    assert rcyaml("migrate", ".").exit_code == 0
    assert before == {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*.yaml")}
    parameters = tmp_path / PARAMETERS
    parameters.write_text(parameters.read_text().replace("Volume: int", "Volume: {type: int, range: [0, 9]}"))
    text = migrated(rcyaml, tmp_path, config="Volume = 4\n")
    assert "range" in text(PARAMETERS) and "Volume: 4" in text("speech/etc/config.yaml")


@pytest.mark.parametrize("text", [
    "initial = {\n  x = 1;\n}\n", '{\n  "type": "x",\n  "a=b": 1\n}\n', '"type": "x",\n', "<a b='c'/>\n",
    "cd ~/a\nsrc/x.py etc/config\nx = 1\n", "/usr/local/lib\n/opt/lib\n", "listener 1883\nallow_anonymous true\n",
    "export A=b\n", "f = deg2rad(57.0);\n", "# nothing\n", "",
])  # fmt: skip
def test_files_that_are_not_configs_are_rejected(rcyaml: Run, tmp_path: Path, text: str) -> None:
    write_tree(tmp_path, {"x.conf": text, "good.conf": "Volume = 1\n"})
    result = rcyaml("migrate", "x.conf")
    assert result.exit_code == 1 and "error[RC500" in result.output and "x.conf" in result.output
    result = rcyaml("migrate", ".")
    assert result.exit_code == 0 and "note[RC50" in result.output and "x.conf" in result.output
    assert not (tmp_path / "x.config.yaml").exists() and (tmp_path / "good.config.yaml").exists()


@pytest.mark.parametrize("path", ["speech/etc/config", "speech/etc/config_real", "a.conf"])
def test_files_that_configure_components_are_rejected(rcyaml: Run, tmp_path: Path, path: str) -> None:
    """A folder is migrated without them, and the exit code says so."""
    write_tree(tmp_path, {path: "Arm.Endpoints = tcp -p 1\nmore\nand more\nand more\n", "good.conf": "Volume = 1\n"})
    result = rcyaml("migrate", ".")
    assert result.exit_code == 1 and "error[RC5004]" in result.output and path in result.output


def test_other_files_of_a_folder_are_skipped(rcyaml: Run, tmp_path: Path) -> None:
    others = {"config.h": "#define A\n", "config.yaml": "a: 1\n", "tsconfig.json": "{}\n", "etc/readme": "hello\n",
              "etc/pyproject.toml": "[project]\nname = 'x'\n", "a.xml": "<a/>\n", "b.toml": "[a]\n"}  # fmt: skip
    write_tree(tmp_path, {**others, "etc/robot": "Volume = 1\n"})
    assert rcyaml("migrate", ".", "--report", "ledger.json").exit_code == 0
    files = json.loads((tmp_path / "ledger.json").read_text())["files"]
    assert [file["source"] for file in files] == ["etc/robot"]


def test_a_file_name_that_is_not_valid_text_is_rejected() -> None:
    rules, (told,) = recognize(SourceText("config_\udce9", "A = 1\n"))
    assert rules is None and told.code == "RC5004" and "rename the file" in told.message
