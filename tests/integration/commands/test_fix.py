"""`rcyaml check --fix`: what is fixed, what is left, and that no other byte changes."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import Tree, write_tree
from robocomp_yaml.api import fixing
from robocomp_yaml.transactions import whole_file

Run = Callable[..., Result]
SPEECH = (
    "module: RoboCompSpeech\ntypes: {Mood: {enum: [calm, angry]}}\ninterfaces:\n  Speech:\n    methods:\n"
    "      say: {in: {text: string}}\n"
)
LASER = "module: RoboCompLaser\ntypes: {Scan: {sequence: float}}\n"
HEAD = "component: SpeechComp\nlanguage: python\n"
PDSL = (
    "component: speech.cdsl.yaml\nparameters:\n  speed: {type: float, default: 1}\n  name: {type: string, default: a}\n"
    "  loud: {type: bool, default: false}\n"
)
VALUES = "component: ../speech.cdsl.yaml\nparameters:\n"
DDSL = "deployment: Robot\ncomponents:\n  speech: {component: speech.cdsl.yaml}\n"


def fixed(rcyaml: Run, folder: Path, files: Tree, name: str, *options: str) -> str:
    write_tree(folder, files)
    rcyaml("check", *(options or ("--fix",)))
    return (folder / name).read_bytes().decode()


IDSL = "Speech.idsl.yaml"
CDSL = "speech.cdsl.yaml"
BESIDE = {IDSL: SPEECH, CDSL: HEAD + "imports: [Speech]\nimplements: [Speech]\n"}
SAFE = {
    "a doubled import": (IDSL, "module: M\nimports: [Laser, Laser]\n", "module: M\nimports: [Laser]\n"),
    "three of them": (IDSL, "module: M\nimports: [Laser, Laser, 'Laser']\n", "module: M\nimports: [Laser]\n"),
    "on lines": (IDSL, "module: M\nimports:\n  - Laser\n  - Laser\n", "module: M\nimports:\n  - Laser\n"),
    "with a comment": (
        IDSL,
        "module: M\nimports:\n- Laser # one\n- Laser  # two\n",
        "module: M\nimports:\n- Laser # one\n# two\n",
    ),
    "brackets on lines": (
        IDSL,
        "module: M\nimports: [\n  Laser, # one\n  Laser, # two\n]\n",
        "module: M\nimports: [\n  Laser, # one\n  # two\n]\n",
    ),
    "the same by its path": (IDSL, "module: M\nimports: [Laser, ./Laser]\n", "module: M\nimports: [Laser]\n"),
    "the last line without an end": (
        IDSL,
        "module: M\nimports:\n  - Laser\n  - Laser",
        "module: M\nimports:\n  - Laser\n",
    ),
    "an import's case": (CDSL, HEAD + "imports: [speech]\n", HEAD + "imports: [Speech]\n"),
    "a key's case": (IDSL, "Module: M\n", "module: M\n"),
    "a key's case, quoted": (IDSL, "'MODULE': M\n", "'module': M\n"),
    "a language's case": (CDSL, "component: A\nlanguage: Python\n", "component: A\nlanguage: python\n"),
    "a repeated entry": (IDSL, "module: M\ndoc: x\ndoc: x # y\n", "module: M\ndoc: x\n# y\n"),
    "a repeated block": (
        IDSL,
        "module: M\ntypes:\n  A:\n    struct:\n      x: int\n  # both\n  A:\n    struct:\n      x: int\n# end\n",
        "module: M\ntypes:\n  A:\n    struct:\n      x: int\n  # both\n# end\n",
    ),
    "in brackets": (IDSL, "module: M\nx-a: {b: 1, c: [2], b: 1}\n", "module: M\nx-a: {b: 1, c: [2]}\n"),
    "without a value": (IDSL, "module: M\ntypes:\ntypes:\n", "module: M\ntypes:\n"),
    "tags": (
        IDSL,
        "module: !!str M\ndoc: !!str 5  # five\nx-a: !!map {b: &c !!int 5}\n",
        'module: "M"\ndoc: "5"  # five\nx-a: {b: &c 5}\n',
    ),
    "what every component does": (
        CDSL,
        HEAD + "imports: [CommonBehavior]\nimplements: [CommonBehavior]\n",
        HEAD + "imports: [CommonBehavior]\nimplements: []\n",
    ),
    "an exception thrown twice": (
        IDSL,
        "module: M\nexceptions: {E: {}}\ninterfaces: {I: {methods: {m: {throws: [E, E]}}}}\n",
        "module: M\nexceptions: {E: {}}\ninterfaces: {I: {methods: {m: {throws: [E]}}}}\n",
    ),
    "a text that begins as none can": (IDSL, "module: M\ndoc: @home  # why\n", 'module: M\ndoc: "@home"  # why\n'),
    "a text with a colon": (IDSL, "module: M\ndoc: Moves: fast\n", 'module: M\ndoc: "Moves: fast"\n'),
    "a blank behind a colon": (
        IDSL,
        "module: M\ntypes:\n  A: {sequence:string}\n",
        "module: M\ntypes:\n  A: {sequence: string}\n",
    ),
    "text that is a number": (IDSL, "module: M\ndoc: 2026\n", 'module: M\ndoc: "2026"\n'),
    "a truth of YAML 1.1": (
        IDSL,
        "module: M\ninterfaces: {I: {methods: {m: {idempotent: yes}}}}\n",
        "module: M\ninterfaces: {I: {methods: {m: {idempotent: true}}}}\n",
    ),
    "one for a list": (CDSL, HEAD + "imports: Speech\n", HEAD + "imports: [Speech]\n"),
    "some for a list": (CDSL, HEAD + "imports: Speech, Laser\n", HEAD + "imports: [Speech, Laser]\n"),
    "quotes around a number": (
        "speech.pdsl.yaml",
        PDSL.replace("default: 1", 'default: "1.5"'),
        PDSL.replace("default: 1", "default: 1.5"),
    ),
    "no quotes around a text": (
        "speech.pdsl.yaml",
        PDSL.replace("default: a", "default: 7"),
        PDSL.replace("default: a", 'default: "7"'),
    ),
    "values": (
        "etc/config.yaml",
        VALUES + "  speed: '2'\n  name: true\n  Loud: off\n",
        VALUES + '  speed: 2\n  name: "true"\n  loud: false\n',
    ),
    "a constant": (
        IDSL,
        "module: M\nconstants:\n  a: {type: string, value: 5}\n  b: {type: int, value: '5'}\n",
        'module: M\nconstants:\n  a: {type: string, value: "5"}\n  b: {type: int, value: 5}\n',
    ),
    "a path that lacks its end": (
        "speech.pdsl.yaml",
        PDSL.replace("speech.cdsl.yaml", "speech.cdsl"),
        PDSL,
    ),
    "operators of C": (
        "speech.pdsl.yaml",
        PDSL + "constraints: ['speed > 1 && !loud']\n",
        PDSL + "constraints: ['speed > 1 and not loud']\n",
    ),
    "a deployment's key": ("robot.ddsl.yaml", DDSL.replace("components:", "Components:"), DDSL),
}


@pytest.mark.parametrize(("name", "before", "after"), SAFE.values(), ids=SAFE)
def test_safe_fixes(rcyaml: Run, tmp_path: Path, name: str, before: str, after: str) -> None:
    others = {
        "Laser.idsl.yaml": LASER,
        "CommonBehavior.idsl.yaml": "module: RoboCompCommonBehavior\ninterfaces: {CommonBehavior: {}}\n",
        "speech.pdsl.yaml": PDSL,
        **BESIDE,
    }
    assert fixed(rcyaml, tmp_path, {**others, name: before}, name) == after


UNSAFE = {
    "an interface": (
        CDSL,
        HEAD + "imports: [Speech]\nrequires: [Speach]\n",
        HEAD + "imports: [Speech]\nrequires: [Speech]\n",
    ),
    "with its module": (
        CDSL,
        HEAD + "imports: [Speech]\nrequires: [Speech.Speach]\n",
        HEAD + "imports: [Speech]\nrequires: [Speech.Speech]\n",
    ),
    "an import that is missing": (
        CDSL,
        HEAD + "implements: [Speech]\n",
        HEAD + "imports: [Speech]\nimplements: [Speech]\n",
    ),
    "behind others": (
        CDSL,
        HEAD.replace("python", "python  # ours") + "imports: [ Laser ]\nimplements: [Speech]\n",
        HEAD.replace("python", "python  # ours") + "imports: [ Laser, Speech ]\nimplements: [Speech]\n",
    ),
    "on a line": (
        CDSL,
        HEAD + "imports:\n- Laser  # first\n# then\nimplements: [Speech]\n",
        HEAD + "imports:\n- Laser  # first\n- Speech\n# then\nimplements: [Speech]\n",
    ),
    "with a name": (
        IDSL,
        "# M.\r\nmodule: M # m\r\ntypes: {A: {sequence: Scan}, B: {sequence: Laser.Scan}}",
        "# M.\r\nmodule: M # m\r\nimports: [Laser]\r\ntypes: {A: {sequence: Laser.Scan}, B: {sequence: Laser.Scan}}",
    ),
    "an import": (CDSL, HEAD + "imports: [Speach]\n", HEAD + "imports: [Speech]\n"),
    "a key": (IDSL, "modul: M\n", "module: M\n"),
    "a type": (IDSL, 'module: M\ntypes: {A: {sequence: "strng"}}\n', 'module: M\ntypes: {A: {sequence: "string"}}\n'),
    "of C++": (IDSL, "module: M\ntypes: {A: {sequence: int32_t}}\n", "module: M\ntypes: {A: {sequence: int}}\n"),
    "an enumerator": (
        IDSL,
        "module: M\ntypes: {A: {enum: [on, no]}}\nconstants: {c: {type: A, value: onn}}\n",
        "module: M\ntypes: {A: {enum: [on, no]}}\nconstants: {c: {type: A, value: on}}\n",
    ),
    "a parameter's type": ("speech.pdsl.yaml", PDSL.replace("float", "flaot"), PDSL),
    "a parameter": ("etc/config.yaml", VALUES + "  sped: 2\n", VALUES + "  speed: 2\n"),
    "in an expression": (
        "speech.pdsl.yaml",
        PDSL + "constraints: [speed > sped, sped < 5]\n",
        PDSL + "constraints: [speed > speed, speed < 5]\n",
    ),
    "a function": (
        "speech.pdsl.yaml",
        PDSL + 'constraints: ["abss(speed) > 1"]\n',
        PDSL + 'constraints: ["abs(speed) > 1"]\n',
    ),
    "a path": ("robot.ddsl.yaml", DDSL.replace("speech.cdsl", "speach.cdsl"), DDSL),
    "an option of Ice": (
        "etc/config.yaml",
        VALUES.replace("parameters:\n", "") + "endpoints: {Speech: tpc -p 10001}\n",
        VALUES.replace("parameters:\n", "") + "endpoints: {Speech: tcp -p 10001}\n",
    ),
    "a port": (
        "etc/config.yaml",
        VALUES.replace("parameters:\n", "") + "endpoints: {Speach: tcp -p 10001}\n",
        VALUES.replace("parameters:\n", "") + "endpoints: {Speech: tcp -p 10001}\n",
    ),
    "a state": (
        CDSL,
        HEAD + "statemachine: {initial: open, states: {open: {}, shut: {}}, transitions: {open: shutt, shut: 'opn'}}\n",
        HEAD + "statemachine: {initial: open, states: {open: {}, shut: {}}, transitions: {open: shut, shut: 'open'}}\n",
    ),
    "a connection": (
        "robot.ddsl.yaml",
        DDSL.replace(".yaml}", ".yaml, after: [cmaera]}") + "  camera: {program: 'true'}\n",
        DDSL.replace(".yaml}", ".yaml, after: [camera]}") + "  camera: {program: 'true'}\n",
    ),
    "an anchor": (
        CDSL,
        HEAD + "imports: [Speech]\nimplements: [&a Speach]\nrequires: [*a]\n",
        HEAD + "imports: [Speech]\nimplements: [&a Speech]\nrequires: [*a]\n",
    ),
    "quotes and brackets": (
        CDSL,
        HEAD + "imports: ['Speech']\nrequires:\n  [ 'Speach' ,]  # all\n",
        HEAD + "imports: ['Speech']\nrequires:\n  [ 'Speech' ,]  # all\n",
    ),
    "two meanings": (
        IDSL,
        "module: M\nconstants: {a: {type: string, value: 0495}}\n",
        'module: M\nconstants: {a: {type: string, value: "0495"}}\n',
    ),
}


@pytest.mark.parametrize(("name", "before", "after"), UNSAFE.values(), ids=UNSAFE)
def test_unsafe_fixes(rcyaml: Run, tmp_path: Path, name: str, before: str, after: str) -> None:
    files = {"Laser.idsl.yaml": LASER, "speech.pdsl.yaml": PDSL, **BESIDE, name: before}
    assert fixed(rcyaml, tmp_path, files, name) == before  # not with --fix
    assert fixed(rcyaml, tmp_path, {}, name, "--unsafe-fixes") == after


def test_errors_that_a_safe_fix_reveals_are_fixed_too(rcyaml: Run, tmp_path: Path) -> None:
    """A document is understood only when its keys are right; then its other errors are reported."""
    text = "Module: M\nImports: [Laser, Laser]\ntypes: {A: {sequence: strng, doc: 5}}\n"
    files = {"Laser.idsl.yaml": LASER, IDSL: text}
    after = 'module: M\nimports: [Laser]\ntypes: {A: {sequence: strng, doc: "5"}}\n'
    assert fixed(rcyaml, tmp_path, files, IDSL) == after
    assert fixed(rcyaml, tmp_path, {}, IDSL, "--unsafe-fixes") == after.replace("strng", "string")
    assert rcyaml("check").exit_code == 0


def test_a_guess_that_reveals_errors_without_fixes_is_not_applied(rcyaml: Run, tmp_path: Path) -> None:
    """As long as the shape of the document is wrong, it is unknown whether the guess is right."""
    text = "module: M\nintefaces: {I: {qqqqqq: 5, wwwwww: 3}}\n"
    write_tree(tmp_path, {IDSL: text})
    result = rcyaml("check", "--unsafe-fixes")
    assert (tmp_path / IDSL).read_text() == text and result.exit_code == 1
    assert "write 'interfaces' (RC0202): there would be 2 errors instead of 1" in result.stdout


def test_a_guess_after_which_the_document_is_understood_is_applied(rcyaml: Run, tmp_path: Path) -> None:
    """A misspelled key hid another error, which is reported now."""
    text = "module: M\nintefaces: {I: {methods: {a: {in: {x: Quux, y: Zork}}}}}\n"
    write_tree(tmp_path, {IDSL: text})
    result = rcyaml("check", "--unsafe-fixes")
    assert (tmp_path / IDSL).read_text() == text.replace("intefaces", "interfaces") and result.exit_code == 1
    assert "unknown type 'Quux'" in result.stdout and "unknown type 'Zork'" in result.stdout


def test_one_error_hides_another(rcyaml: Run, tmp_path: Path) -> None:
    """In a text that is no YAML, only the first error is reported."""
    text = "module: M\ndoc: @home\nx-more: {a: 1}\nimports: [Laser, Laser]\nx-own: @there\nx-last:\n  - a\n  - `b`\n"
    after = text.replace("@home", '"@home"').replace("@there", '"@there"').replace("`b`", '"`b`"')
    files = {"Laser.idsl.yaml": LASER, IDSL: text}
    assert fixed(rcyaml, tmp_path, files, IDSL) == after.replace("Laser, Laser", "Laser")


def test_a_number_in_quotes_is_no_name(rcyaml: Run, tmp_path: Path) -> None:
    text = "module: 42\ntypes: {A: {enum: [1]}}\n"
    assert fixed(rcyaml, tmp_path, {IDSL: text}, IDSL, "--unsafe-fixes") == text


def test_a_document_is_no_suggestion_for_itself(rcyaml: Run, tmp_path: Path) -> None:
    files = {
        **BESIDE,
        "speech.pdsl.yaml": PDSL,
        "a.config.yaml": "component: speech.cdsl.yaml\nextends: [b.config.yaml]\n",
        "robot.ddsl.yaml": "deployment: R\ngroups: {g: {include: robots.ddsl.yaml}}\n",
    }
    write_tree(tmp_path, files)
    assert "did you mean" not in rcyaml("check").stdout


def test_the_workspace_s_own_document(rcyaml: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    files = {"rcyaml.yaml": "Lint: {RC1104: off}\ninterface: [a]  # here\n", "a/Laser.idsl.yaml": LASER}
    write_tree(tmp_path, files)
    monkeypatch.chdir(tmp_path / "a")
    rcyaml("check", "--unsafe-fixes", ".")
    assert (tmp_path / "rcyaml.yaml").read_text() == files["rcyaml.yaml"]  # it was not requested
    monkeypatch.chdir(tmp_path)
    rcyaml("check", "--fix")
    assert (tmp_path / "rcyaml.yaml").read_text() == "lint: {RC1104: off}\ninterface: [a]  # here\n"
    rcyaml("check", "--unsafe-fixes")
    assert (tmp_path / "rcyaml.yaml").read_text() == "lint: {RC1104: off}\ninterfaces: [a]  # here\n"


def test_a_guess_that_causes_errors_is_not_applied(rcyaml: Run, tmp_path: Path) -> None:
    """With the import, the names of its module are known, and two of them are missing."""
    files = {
        "Arm.idsl.yaml": "module: RoboCompArm\n",
        IDSL: "module: M\nimports: [Armm]\ntypes: {A: {sequence: Armm.X}, B: {sequence: Armm.Y}}\n",
    }
    write_tree(tmp_path, files)
    result = rcyaml("check", "--unsafe-fixes")
    assert (tmp_path / IDSL).read_text() == files[IDSL]
    assert "write 'Arm' (RC1101): there would be 2 errors instead of 1" in result.stdout


@pytest.mark.parametrize("bom", [b"", b"\xef\xbb\xbf"])
@pytest.mark.parametrize("end", [b"\n", b"\r\n", b"\r"])
def test_everything_else_is_kept_byte_by_byte(rcyaml: Run, tmp_path: Path, bom: bytes, end: bytes) -> None:
    lines = [
        b"# caf\xc3\xa9 \xe2\x80\xa8 one line", b"", b"module:   M   # here", b"imports:", b"  - Laser\t# tab", b"  - Laser",
        b"doc: |", b"  kept  ", b"", b"types: { 'A':{sequence: &x strng} , \"B\": {sequence: *x}}  ", b"x-own: {b: 1,a: 2}", b"",
    ]  # fmt: skip
    write_tree(tmp_path, {"Laser.idsl.yaml": LASER, IDSL: bom + end.join(lines)})
    result = rcyaml("check", "--unsafe-fixes")
    del lines[5]
    lines[8] = lines[8].replace(b"strng", b"string")
    assert (tmp_path / IDSL).read_bytes() == bom + end.join(lines)
    assert result.exit_code == 0


def test_many_at_once(rcyaml: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Hundreds of fixes need a few checks, also if some of them cannot be applied."""
    looks = []
    real = fixing.Fixing._look
    monkeypatch.setattr(fixing.Fixing, "_look", lambda self, changed: looks.append(1) or real(self, changed))
    types = "".join(f"  T{n}: {{sequence: strng}}\n" for n in range(200))
    files = {f"D{n}.idsl.yaml": f"module: M{n}\ntypes:\n{types}" for n in range(2)}
    bad = "module: M\nintefaces: {I: {qqqqqq: 5, wwwwww: 3}}\n"
    write_tree(tmp_path, {**files, IDSL: bad})
    rcyaml("check", "--unsafe-fixes")
    assert "strng" not in "".join((tmp_path / name).read_text() for name in files)
    assert len(looks) < 40 and (tmp_path / IDSL).read_text() == bad


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_fixes_that_undo_each_other_are_left(rcyaml: Run, tmp_path: Path, end: str) -> None:
    """One value is used as a number and as a text. All else is fixed, and a second run changes nothing."""
    values = f'{VALUES}  speed: &s "1"\n  name: *s  # as it is\n  loud: yes\n'.replace("\n", end)
    files = {CDSL: HEAD, "speech.pdsl.yaml": PDSL, "etc/config.yaml": values}
    for option in ("--fix", "--unsafe-fixes"):
        after = fixed(rcyaml, tmp_path, files, "etc/config.yaml", option)
        assert after == values.replace("yes", "true")
        said = rcyaml("check", option).stdout
        assert said.count("left ") == 1 and "whose fix undoes this one" in said and "fixed" not in said


def test_a_safe_fix_may_reveal_what_is_fixed_too(rcyaml: Run, tmp_path: Path) -> None:
    wrong = "module: M\nInterfaces:\n  A: {methods: {go: {idempotent: yes}, stop: {idempotent: yes}}}\n"
    right = wrong.replace("Interfaces", "interfaces").replace("yes", "true")
    assert fixed(rcyaml, tmp_path, {IDSL: wrong}, IDSL) == right
    worse = wrong.replace("yes", "maybe")
    assert fixed(rcyaml, tmp_path, {IDSL: worse}, IDSL) == worse, "there would be more errors"


def test_diff_shows_and_writes_nothing(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(
        tmp_path, {"Laser.idsl.yaml": LASER, IDSL: "module: M\r\nimports: [Laser, Laser]\r\ntypes: {A: {sequence: x}}"}
    )
    result = rcyaml("check", "--diff")
    assert result.stdout.splitlines()[:2] == ["--- a/Speech.idsl.yaml", "+++ b/Speech.idsl.yaml"]
    assert "+imports: [Laser]\r\n" in result.stdout_bytes.decode()
    assert "1 fix to apply: 1 error would remain" in result.stderr
    assert result.exit_code == 1
    assert "Laser, Laser" in (tmp_path / IDSL).read_text()
    (tmp_path / IDSL).write_text("module: M\nimports: [Laser, Laser]\n")
    assert rcyaml("check", "--diff", "--fail-on", "warning").exit_code == 0


def test_json_has_what_was_fixed_and_what_remains(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"Laser.idsl.yaml": LASER, IDSL: "module: M\nimports: [Laser, Laser, Lasr]\n"})
    printed = json.loads(rcyaml("check", "--format", "json").stdout)["diagnostics"]
    place = {"file": IDSL, "line": 2, "column": 26, "end_line": 2, "end_column": 30}
    assert printed[1]["facts"] == {"meant": "Laser", "name": "Lasr"} or printed[1]["facts"] == {"name": "Lasr"}
    data = json.loads(rcyaml("check", "--fix", "--format", "json").stdout)
    assert [one["code"] for one in data["diagnostics"]] == ["RC1101"] and data["documents"] == 2
    assert data["fixed"] == [{
        "code": "RC1104", "file": IDSL, "line": 2, "column": 18, "title": "remove it", "safe": True,
        "edits": [{**place, "column": 16, "end_column": 23, "text": ""}],
    }]  # fmt: skip
    assert data["files"] == [{"path": IDSL, "action": "fixed"}] and data["not_fixed"] == []
    write_tree(tmp_path, {IDSL: "module: M\nimports: [Laser, Laser]\n"})
    data = json.loads(rcyaml("check", "--fix", "--diff", "--format", "json").stdout)
    assert data["files"][0]["action"] == "fix" and data["files"][0]["diff"].startswith("--- a/Speech.idsl.yaml\n")


def test_sarif_has_the_fixes(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"Laser.idsl.yaml": LASER, IDSL: "module: M\nimports: [Laser, Laser]\n"})
    (result,) = json.loads(rcyaml("check", "--format", "sarif").stdout)["runs"][0]["results"]
    (change,) = result["fixes"][0]["artifactChanges"]
    assert change["artifactLocation"] == {"uri": IDSL}
    assert change["replacements"] == [{
        "deletedRegion": {"startLine": 2, "startColumn": 16, "endLine": 2, "endColumn": 23}, "insertedContent": {"text": ""},
    }]  # fmt: skip


WRONG = "module: M\nimports: [Laser, Laser]\n"
RIGHT = "module: M\nimports: [Laser]\n"


def test_a_read_only_document_is_kept(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"Laser.idsl.yaml": LASER, IDSL: WRONG, "Other.idsl.yaml": WRONG})
    (tmp_path / IDSL).chmod(0o444)
    result = rcyaml("check", "--fix")
    assert (tmp_path / IDSL).read_text() == WRONG and (tmp_path / "Other.idsl.yaml").read_text() == RIGHT
    assert "left   Speech.idsl.yaml: it is read-only" in result.stdout
    assert "Speech.idsl.yaml:2:18" in result.stdout and result.exit_code == 1  # it was requested, and is not fixed


def test_a_document_that_has_changed_is_kept(rcyaml: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_tree(tmp_path, {"Laser.idsl.yaml": LASER, IDSL: WRONG})
    real = fixing.apply_fixes

    def meanwhile(*args: object, **options: bool) -> object:
        done = real(*args, **options)  # type: ignore[arg-type]
        (tmp_path / IDSL).write_text(WRONG + "# mine\n")
        return done

    monkeypatch.setattr(fixing, "apply_fixes", meanwhile)
    result = rcyaml("check", "--fix")
    assert (tmp_path / IDSL).read_text() == WRONG + "# mine\n"
    assert "it has changed meanwhile: run the check again" in result.stdout and result.exit_code == 1


def test_a_full_disk_loses_nothing(rcyaml: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_tree(tmp_path, {"Laser.idsl.yaml": LASER, IDSL: WRONG})

    def full(path: str, content: bytes) -> None:
        raise OSError(28, "No space left on device", path)

    monkeypatch.setattr(whole_file, "replace", full)
    result = rcyaml("check", "--fix")
    assert (tmp_path / IDSL).read_text() == WRONG and result.exit_code == 1
    assert "left   Speech.idsl.yaml: no space left on device" in result.stdout
    assert sorted(os.listdir(tmp_path)) == ["Laser.idsl.yaml", IDSL]


def test_links(rcyaml: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The target of a link inside the requested folders is written; one outside is left, unless it is named."""
    write_tree(tmp_path, {
        "robot/Laser.idsl.yaml": LASER, "robot/real/In.idsl.yaml": WRONG.replace("Laser", "../Laser"),
        "robot/In.idsl.yaml": "-> real/In.idsl.yaml", "Out.idsl.yaml": "module: M\nmodule: M\n",
        "robot/Out.idsl.yaml": "-> ../Out.idsl.yaml",
    })  # fmt: skip
    monkeypatch.chdir(tmp_path / "robot")
    result = rcyaml("check", "--fix")
    assert f"a link leads to {tmp_path / 'Out.idsl.yaml'}" in result.stdout
    assert (tmp_path / "Out.idsl.yaml").read_text().count("module") == 2
    assert result.exit_code == 1
    rcyaml("check", "--fix", "Out.idsl.yaml")
    assert (tmp_path / "Out.idsl.yaml").read_text() == "module: M\n"
    assert (tmp_path / "robot/Out.idsl.yaml").is_symlink() and (tmp_path / "robot/In.idsl.yaml").is_symlink()


def test_only_requested_documents_change(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"Laser.idsl.yaml": "Module: M\n", IDSL: "module: S\nimports: [Laser, Laser]\n"})
    rcyaml("check", "--fix", IDSL)
    assert (tmp_path / "Laser.idsl.yaml").read_text() == "Module: M\n"
    assert (tmp_path / IDSL).read_text() == "module: S\nimports: [Laser]\n"


def test_permissions_are_kept(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"Laser.idsl.yaml": LASER, IDSL: WRONG})
    (tmp_path / IDSL).chmod(0o640)
    rcyaml("check", "--fix")
    assert (tmp_path / IDSL).stat().st_mode & 0o777 == 0o640


def test_a_fix_does_not_show_a_secret(rcyaml: Run, tmp_path: Path) -> None:
    pdsl = PDSL + "  mode: {type: string, values: [red, green]}\n  password: {type: string, optional: true}\n"
    write_tree(tmp_path, {
        **BESIDE, "speech.pdsl.yaml": pdsl,
        "etc/config.yaml": VALUES + "  password: hunter2hunter2\n  mode: grene\n  Name: grene\n",
    })  # fmt: skip
    for format_ in ("text", "json", "sarif"):
        for options in ((), ("--fix", "--diff"), ("--unsafe-fixes", "--diff"), ("--unsafe-fixes",)):
            printed = rcyaml("check", *options, "--format", format_)
            assert "hunter2" not in printed.stdout + printed.stderr
    assert (tmp_path / "etc/config.yaml").read_text().count("hunter2hunter2") == 1


def test_nothing_to_fix(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"Laser.idsl.yaml": LASER})
    before = (tmp_path / "Laser.idsl.yaml").stat().st_mtime_ns
    for option in ("--fix", "--unsafe-fixes"):
        result = rcyaml("check", option)
        assert (result.exit_code, result.stdout) == (0, "1 document: nothing wrong\n")
    assert (tmp_path / "Laser.idsl.yaml").stat().st_mtime_ns == before
    assert rcyaml("check", "--fix", "--diff").stdout == ""
