"""What we emit, through the real compilers of Slice."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from robocomp_yaml import pipeline, resources
from robocomp_yaml.emit import slice as target
from robocomp_yaml.emit.slice import quoted
from slice_compilers import complaints, needs_compilers

pytestmark = needs_compilers

GOLDEN = Path(__file__).resolve().parent.parent / "golden" / "slice"


def test_the_golden_files(tmp_path: Path) -> None:
    for file in GOLDEN.iterdir():
        (tmp_path / file.name).write_bytes(file.read_bytes())
    assert complaints(tmp_path, sorted(file.name for file in GOLDEN.iterdir())) == {}


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("g++") is None, reason="g++ is not installed")
def test_the_cpp_of_the_golden_files_compiles(tmp_path: Path) -> None:
    names = sorted(str(file) for file in GOLDEN.iterdir())
    subprocess.run(["slice2cpp", f"-I{GOLDEN}", "--output-dir", ".", *names], cwd=tmp_path, check=True)
    command = ["g++", "-std=c++17", "-DICE_CPP11_MAPPING", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", "-I."]
    for file in tmp_path.glob("*.cpp"):
        done = subprocess.run([*command, file.name], cwd=tmp_path, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr


def test_common_behavior(tmp_path: Path) -> None:
    (tmp_path / "CommonBehavior.ice").write_text(resources.text("templates/slice/CommonBehavior.ice"), encoding="utf-8")
    assert complaints(tmp_path, ["CommonBehavior.ice"]) == {}


def test_values_arrive_as_they_were_written(tmp_path: Path) -> None:
    texts = ['"', "\\", "a\nb\tc\r", "\x01\x7f\x1b", "é€\x85\u2028", "what??! ??/ ??", "/* a */ // b", "x" * 10_000]
    values = "".join(f"  s{n}: {{type: string, value: {json.dumps(text)}}}\n" for n, text in enumerate(texts))
    document = (
        f"module: RoboCompValues\nconstants:\n{values}  r: {{type: double, value: 2.5e-3}}\n"
        "  b: {type: bool, value: TRUE}\n  n: {type: long, value: -9223372036854775808}\n"
        "  e: {type: Side, value: right}\n"
        "types:\n  Side: {enum: {left: 3, right: }}\n"
        "  S: {struct: {e: {type: Side, default: right}, x: {type: int, default: -7}}}\n"
    )
    (tmp_path / "Values.idsl.yaml").write_text(document, encoding="utf-8")
    analysis = pipeline.analyse([str(tmp_path)])
    assert not analysis.diagnostics
    (tmp_path / "Values.ice").write_text(target.text(next(iter(analysis.program.modules.values()))), encoding="utf-8")
    assert complaints(tmp_path, ["Values.ice"]) == {}
    show = (
        "import Ice, json; Ice.loadSlice('', ['Values.ice']); import RoboCompValues as v; s = v.S();"
        f"texts = [getattr(v, f's{{n}}') for n in range({len(texts)})];"
        "print(json.dumps([texts, v.r, v.b, v.n, v.e.value, s.e.value, s.x]))"
    )
    said = subprocess.run([sys.executable, "-c", show], cwd=tmp_path, capture_output=True, text=True, check=True).stdout
    assert json.loads(said) == [texts, 0.0025, True, -(2**63), 4, 4, -7]


def test_the_longest_line_is_far_from_bursting_the_preprocessor(tmp_path: Path) -> None:
    text = f"module M\n{{\n  const string s = {quoted(chr(1) * 10_000)};\n}};\n"
    (tmp_path / "Long.ice").write_text(text, encoding="utf-8")
    assert complaints(tmp_path, ["Long.ice"]) == {}


def test_underscores_do_not_change_checksums(tmp_path: Path) -> None:
    """What [["underscore"]] allows is the same to Ice as what --underscore does."""
    inner = "module M\n{\n  struct a_b { int c_d; };\n  interface i_j { a_b f_g(int h_k); };\n};\n"
    (tmp_path / "Plain.ice").write_text(inner, encoding="utf-8")
    (tmp_path / "Meta.ice").write_text('[["underscore"]]\n' + inner, encoding="utf-8")
    show = "import Ice, json, sys; Ice.loadSlice('', sys.argv[1:]); print(json.dumps(Ice.sliceChecksums))"
    sums = []
    for arguments in (["--underscore", "Plain.ice"], ["Meta.ice"]):
        command = [sys.executable, "-c", show, "--checksum", *arguments]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
        sums.append({name: digest for name, digest in json.loads(done.stdout).items() if name.startswith("::M::")})
    assert sums[0] == sums[1] != {}
