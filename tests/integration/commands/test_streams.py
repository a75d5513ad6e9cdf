"""Output to the standard streams arrives, or an error is reported: closed and full streams, old encodings, odd names."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from conftest import write_tree

FAULTY = "module: RoboCompSpeech\ninterfaces:\n  Speech:\n    methods:\n      say: {in: {text: strin}}\n"
ODD = os.fsdecode(b"caf\xe9")  # a folder's name in Latin-1


def run(folder: Path, command: str, **environ: str) -> subprocess.CompletedProcess[bytes]:
    """Runs a shell command in which `rcyaml` is the tested one."""
    shell = f'rcyaml() {{ "{sys.executable}" -m robocomp_yaml "$@"; }}; {command}'
    root = str(Path(__file__).parents[3])
    return subprocess.run(
        ["sh", "-c", shell], cwd=folder, env={**os.environ, "PYTHONPATH": root, **environ}, capture_output=True,
        timeout=60, check=False,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("command", "code"),
    [
        ("rcyaml check >&-", 1),
        ("rcyaml compile --format json >&- 2>&-", 1),
        ("rcyaml explain >&-", 0),
        ("rcyaml chek >&- 2>&-", 2),
    ],
)
def test_closed_streams_discard_their_output(command: str, code: int, tmp_path: Path) -> None:
    write_tree(tmp_path, {"Speech.idsl.yaml": FAULTY})
    done = run(tmp_path, command)
    assert (done.returncode, b"Traceback" in done.stderr) == (code, False)


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="this system has no /dev/full")
@pytest.mark.parametrize("command", ["check", "check --format sarif", "compile", "explain", "--help", "schema idsl"])
def test_a_full_disk_behind_the_output_is_reported(command: str, tmp_path: Path) -> None:
    write_tree(tmp_path, {"Speech.idsl.yaml": FAULTY})
    done = run(tmp_path, f"rcyaml {command} > /dev/full")
    assert done.returncode == 1
    assert done.stderr.decode() == "Error: cannot write to standard output: no space left on device\n"


def test_an_old_encoding_gets_question_marks(tmp_path: Path) -> None:
    write_tree(tmp_path, {"Speech.idsl.yaml": FAULTY})
    done = run(tmp_path, "rcyaml check", PYTHONIOENCODING="latin-1")
    assert done.stdout.decode("latin-1").splitlines()[1] == "  ?? Speech.idsl.yaml:5:24"


def test_a_name_that_is_no_utf8_is_shown_by_its_bytes(tmp_path: Path) -> None:
    write_tree(tmp_path, {f"{ODD}/Speech.idsl.yaml": FAULTY})
    done = run(tmp_path, "rcyaml check", PYTHONIOENCODING="utf-8:strict")
    assert rb" caf\xe9/Speech.idsl.yaml:5:24" in done.stdout.splitlines()[1]


@pytest.mark.parametrize("command", ["check --format json", "check --format sarif", "compile --format json"])
def test_json_is_valid_whatever_a_name_is(command: str, tmp_path: Path) -> None:
    write_tree(tmp_path, {f"{ODD}/Speech.idsl.yaml": FAULTY})
    done = run(tmp_path, f"rcyaml {command}", PYTHONIOENCODING="utf-8:strict")
    data = json.loads(done.stdout.decode("utf-8", "strict"))
    if "sarif" in command:
        place = data["runs"][0]["results"][0]["locations"][0]["physicalLocation"]
        assert place["artifactLocation"]["uri"] == "caf%E9/Speech.idsl.yaml"
    else:
        assert data["diagnostics"][0]["file"] == f"{ODD}/Speech.idsl.yaml"


@pytest.mark.processes
def test_a_reader_that_goes_away_leaves_a_whole_workspace(tmp_path: Path) -> None:
    for number in range(5):
        words = [sys.executable, "-m", "robocomp_yaml", "init", "--bare", str(tmp_path / str(number))]
        with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
            assert process.stdout and process.stderr
            process.stdout.close()
            assert process.stderr.read() == b"" and process.wait() == 141
        assert (tmp_path / str(number) / "interfaces").is_dir()
        assert (tmp_path / str(number) / ".vscode" / "settings.json").is_file()
