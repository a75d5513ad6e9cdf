"""No document, name or argument can control the terminal, whatever the command; data is unchanged in a pipe."""

from __future__ import annotations

import json
import os
import re
import subprocess
from pathlib import Path

import pytest

from conftest import write_tree
from terminals import COMMAND, environment, foreign, on_terminal

EVIL = "\x1b]0;pwned\x07\x1b[2J\u202e\u009b31m\u200b\x7f"
"""Text as values of documents have it: in YAML with escapes, and as it stands where that may be."""

IN_YAML = r"\e]0;pwned\a\e[2J\u202e\x9b31m\u200b\x7f"
FOLDER = "robot \x1b[31m\nnext line\u2066 " + os.fsdecode(b"\x9b\xff")

RIGHT = {
    "rcyaml.yaml": "interfaces: [interfaces]\n",
    "interfaces/Speech.idsl.yaml": "module: RoboCompSpeech\ninterfaces: {Speech: {methods: {say: {in: {text: string}}}}}\n",
    f"{FOLDER}/speech.cdsl.yaml": (
        "component: SpeechComp\nlanguage: python\nimports: [Speech]\nimplements: [Speech]\nparameters: speech.pdsl.yaml\n"
    ),
    f"{FOLDER}/speech.pdsl.yaml": (
        "component: speech.cdsl.yaml\nparameters:\n"
        f'  voice: {{type: string, default: "{IN_YAML}", doc: "{IN_YAML}"}}\n'
        "  texts: {list: string, default: []}\n"
    ),
    f"{FOLDER}/etc/config.yaml": f'component: ../speech.cdsl.yaml\nparameters:\n  voice: "b{IN_YAML}"\n  texts: ["{IN_YAML}"]\n',
    f"{FOLDER}/robot.ddsl.yaml": (
        "deployment: Robot\ncomponents:\n  speech: {component: speech.cdsl.yaml, endpoints: {Speech: tcp -p 10011}}\n"
        f'  tool: {{program: /bin/true, args: ["{IN_YAML}\\n"], env: {{WHO: "{IN_YAML}"}}, doc: "{IN_YAML}"}}\n'
    ),
}
WRONG = {
    "a.idsl.yaml": f'module: "{IN_YAML}"\n',
    "b.idsl.yaml": f'"{IN_YAML}\\nerror[RC9999]: forged": 1\n',
    "c.cdsl.yaml": f'component: C\nlanguage: "{IN_YAML}\\n"\nimports: ["{IN_YAML}\\r"]\nrequires: ["{IN_YAML}"]\n',
    "d.idsl.yaml": f"module: RoboCompD  # {EVIL.replace(chr(27), '').replace(chr(7), '')}\ninterfaces: [\n",
    "e.idsl.yaml": f"module: RoboCompE{EVIL}\n",
    "f\x1b[31m\n\u202e.idsl.yaml": "module: [\n",
    "g.ddsl.yaml": f'deployment: G\ncomponents: {{"{IN_YAML}\\n": {{program: "{IN_YAML}"}}}}\ngroups: {{"{IN_YAML}": [x]}}\n',
    "h.pdsl.yaml": f'component: "{IN_YAML}.cdsl.yaml"\nparameters: {{x: {{type: int, default: "{IN_YAML}"}}}}\n',
    "i.config.yaml": f'for: "{IN_YAML}"\nbase: "{IN_YAML}"\nparameters: {{"{IN_YAML}": "{IN_YAML}"}}\n',
    "rcyaml.yaml": f'lint: {{"{IN_YAML}": off}}\ninterfaces: ["{IN_YAML}"]\noutput: {{slice: "{IN_YAML}"}}\n',
    "old.idsl": f"module {EVIL} {{\n",
    "old.cdsl": f'import "{EVIL}.idsl";\nComponent {EVIL} {{ language {EVIL}; }};\n',
    "etc/config": f"{EVIL} = {EVIL}\n",
}
CONFIG = f"{FOLDER}/etc/config.yaml"


@pytest.fixture
def right(tmp_path: Path) -> Path:
    return write_tree(tmp_path, RIGHT)


@pytest.fixture
def wrong(tmp_path: Path) -> Path:
    return write_tree(tmp_path, WRONG)


def on_pipe(folder: Path, *args: str, **more: str) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run([*COMMAND, *args], cwd=folder, capture_output=True, timeout=60, env=environment(**more))


OF_WRONG = [
    ("check",), ("check", "c.cdsl.yaml"), ("compile",), ("compile", "--dry-run"), ("-v", "compile"),
    ("migrate", ".", "--dry-run", "-o", f"out{EVIL}"), ("graph",), ("graph", "g.ddsl.yaml"), ("deploy", "plan", "g.ddsl.yaml"),
    ("config", "check", "i.config.yaml"), ("config", "show", "i.config.yaml"), ("config", "new", "h.pdsl.yaml"),
    (EVIL,), ("check", EVIL), ("check", f"--{EVIL}"), ("explain", EVIL), ("schema", EVIL), ("new", "interface", EVIL),
    ("new", EVIL), ("new", "component", EVIL, "--implements", EVIL), ("new", "deployment", EVIL), ("compile", "--target", EVIL),
    ("migrate", EVIL), ("migrate", "etc", "--names", EVIL), ("config", "get", "i.config.yaml", EVIL), ("deploy", "up", EVIL),
    ("deploy", "up", "--timeout", EVIL, "g.ddsl.yaml"), ("init", f"w{EVIL}"), ("check", "f\x1b[31m\n\u202e.idsl.yaml"),
    ("check", f"a\n{EVIL}"), ("explain", "RC2003\nforged"),
]  # fmt: skip


@pytest.mark.parametrize("args", OF_WRONG, ids=lambda args: ascii(" ".join(args))[:40])
def test_words_are_escaped_on_a_terminal(args: tuple[str, ...], wrong: Path) -> None:
    code, output = on_terminal(wrong, *args)
    assert code in (0, 1, 2) and "Traceback" not in output
    assert foreign(output) == []


@pytest.mark.parametrize("args", [("check",), ("compile",), (EVIL,)], ids=["check", "compile", "usage"])
def test_without_colours_there_is_no_escape_at_all(args: tuple[str, ...], wrong: Path) -> None:
    for more, options in (({"NO_COLOR": "1"}, ()), ({}, ("--color", "never"))):
        assert foreign(on_terminal(wrong, *options, *args, **more)[1], colors=False) == []


@pytest.mark.parametrize("args", OF_WRONG[:4], ids=lambda args: ascii(" ".join(args))[:40])
def test_words_are_escaped_in_a_pipe_too(args: tuple[str, ...], wrong: Path) -> None:
    done = on_pipe(wrong, *args)
    assert foreign(done.stdout.decode() + done.stderr.decode(), colors=False) == []
    colored = on_pipe(wrong, "--color", "always", *args)
    assert foreign(colored.stdout.decode() + colored.stderr.decode()) == []


def test_a_newline_in_a_name_forges_no_line(wrong: Path) -> None:
    output = on_pipe(wrong, "check").stdout.decode()
    assert r"\nerror[RC9999]: forged" in output
    assert not re.search(r"^error\[RC9999\]", output, re.MULTILINE)


OF_RIGHT = [
    ("check",), ("compile",), ("-v", "compile"), ("compile", "--diff"), ("--color", "never", "compile", "--diff"),
    ("deploy", "plan", FOLDER), ("-v", "deploy", "plan", FOLDER), ("deploy", "status", FOLDER), ("deploy", "probe", FOLDER),
    ("config", "check", CONFIG), ("config", "show", CONFIG), ("config", "show", CONFIG, "--format", "json"),
    ("config", "get", CONFIG, "voice"), ("config", "get", CONFIG, "voice", "--format", "json"),
    ("config", "export", CONFIG), ("config", "export", CONFIG, "--as", "toml"), ("config", "set", CONFIG, "voice", EVIL),
    ("graph", FOLDER), ("graph", FOLDER, "--as", "json"), ("graph", FOLDER, "--as", "svg"), ("graph", FOLDER, "--as", "dot"),
    ("deploy", "export", FOLDER, "--as", "systemd"), ("deploy", "export", FOLDER, "--as", "icegrid"),
    ("deploy", "export", FOLDER, "--as", "systemd", "--format", "json"), ("schema",), ("schema", "idsl"), ("explain",),
    ("explain", "RC0003"), ("explain", "--format", "json"), ("deploy", "plan", FOLDER, "--format", "json"),
    ("schema", f"{FOLDER}/speech.cdsl.yaml"), ("check", "--format", "sarif"), ("new", "deployment", "Other"),
]  # fmt: skip


@pytest.mark.parametrize("args", OF_RIGHT, ids=lambda args: ascii(" ".join(args))[:60])
def test_data_is_escaped_on_a_terminal(args: tuple[str, ...], right: Path) -> None:
    code, output = on_terminal(right, *args)
    assert code in (0, 1) and "Traceback" not in output, output
    assert foreign(output) == []
    if "json" in args or "sarif" in args:
        json.loads(output)


def test_data_is_unchanged_in_a_pipe(right: Path) -> None:
    value = f"b{EVIL}"
    assert on_pipe(right, "config", "get", CONFIG, "voice").stdout.decode() == f"{value}\n"
    assert json.loads(on_pipe(right, "config", "get", CONFIG, "voice", "--format", "json").stdout)["value"] == value
    shown = json.loads(on_pipe(right, "config", "show", CONFIG, "--format", "json").stdout)
    assert [row["value"] for row in shown["values"] if row["path"] == "voice"] == [value]
    exported = on_pipe(right, "config", "export", CONFIG).stdout
    assert f"voice = {value}\n".replace(" = ", "=").encode() in exported.replace(b" = ", b"=")
    assert on_pipe(right, "compile").returncode == 0
    entries = [line for line in (right / FOLDER / "etc/config").read_bytes().split(b"\n") if line.startswith(b"voice")]
    assert entries and entries[0] in exported.split(b"\n")


@pytest.mark.parametrize(
    "args",
    [
        ("config", "export", CONFIG), ("config", "show", CONFIG), ("graph", FOLDER), ("compile", "--diff"),
        ("deploy", "export", FOLDER, "--as", "compose"), ("config", "show", CONFIG, "--format", "json"),
    ],
    ids=lambda args: " ".join(args).replace(FOLDER, "F"),
)  # fmt: skip
def test_a_pipe_and_a_file_get_the_same_bytes_in_each_encoding(args: tuple[str, ...], right: Path) -> None:
    ours = on_pipe(right, *args)
    with open(right / "out", "wb") as file:
        other = environment(PYTHONIOENCODING="latin-1", FORCE_COLOR="1")
        subprocess.run([*COMMAND, *args], cwd=right, stdout=file, timeout=60, env=other)
    data = ours.stdout.partition(b"warning[")[0]  # messages follow the data of --diff
    assert ours.returncode == 0 and (right / "out").read_bytes().startswith(data) and data
