"""The writer of units for systemd: a value never becomes a second line."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import pytest
from click.testing import Result
from msgspec.structs import replace
from test_exports import one, systemd_words

from conftest import write_tree
from robocomp_yaml.emit.exports import Unwritable, export, noted
from robocomp_yaml.emit.exports.systemd import UnitFile, folder, quoted
from robocomp_yaml.emit.xml_text import element


@pytest.mark.parametrize("value", ["a\nb", "a\rb", "a\0b", "\x1b[0m", "a\x85b", "a\u2029b", "a\tb", "a\\"])
def test_a_value_is_one_line(value: str) -> None:
    unit = UnitFile()
    for write in (lambda: unit.put("Key", value), lambda: unit.comment(value), lambda: unit.put(value, "x\\")):
        with pytest.raises(Unwritable):
            write()
    assert unit.text == ""


@pytest.mark.parametrize("word", ["a\nb\r\t", "\x1b\x07\x7f", "\x85\u2028é", 'a "b" \\', "100%"])
def test_a_word_in_quotes_is_read_back(word: str) -> None:
    """With the escapes of systemd, which are those of C."""
    text = quoted(word)
    assert text.isprintable()
    told = text[1:-1].replace("%%", "%").encode("latin-1", "backslashreplace").decode("unicode_escape")
    assert told == word
    with pytest.raises(Unwritable):
        quoted("a\0")


def test_folders_whose_end_would_get_lost() -> None:
    assert [folder(path) for path in ("/a b", "/a ", "/a\\", "/a%i")] == ["/a b", "/a /.", "/a\\/.", "/a%%i"]


@pytest.mark.parametrize("program", ["@sh", "-sh", "+sh", "!sh", ":sh", "/opt/$x/run"])
def test_a_program_never_becomes_a_prefix(program: str) -> None:
    unit = export(one("$HOME", program=program), "systemd")["One-p.service"]
    line = next(line for line in unit.splitlines() if line.startswith("ExecStart="))
    words = systemd_words(line.removeprefix("ExecStart="))
    if program.startswith("/"):
        assert line.startswith('ExecStart=:"/opt/$x/run" "$HOME"')  # nothing is replaced
    else:
        assert words[0] == '"/bin/sh"' and words[-2:] == [f'"{program}"', '"$$HOME"']


@pytest.mark.parametrize("name", ["a b", 'a="1" b', "1a", "", "a>", "a/", "é\n", "-a"])
def test_no_name_breaks_an_element(name: str) -> None:
    with noted() as notes:
        (line,) = element(name, {name: "x\x1b"})
    made = ElementTree.fromstring(line)
    assert list(made.attrib.values()) == ["x\ufffd"] and len(notes) == 3
    assert any("U+001B" in str(note) for note in notes) and any(
        f"'{name}' is not a legal name" in str(note) for note in notes
    )


def test_what_a_form_cannot_express_is_reported(rcyaml: Callable[..., Result], tmp_path: Path) -> None:
    rings = 'deployment: Robot\ncomponents:\n  arm: {program: sleep, args: ["\\a"]}\n'
    write_tree(tmp_path, {"robot.ddsl.yaml": rings})
    result = rcyaml("deploy", "export", "robot.ddsl.yaml", "--as", "icegrid", "-o", "out")
    assert result.exit_code == 0 and "robot.ddsl.yaml:3:3" in result.stderr and "U+0007" in result.stderr
    shown = rcyaml("deploy", "export", "robot.ddsl.yaml", "--as", "icegrid")
    assert shown.stdout == (tmp_path / "out" / "Robot.xml").read_text(encoding="utf-8") and "RC4018" in shown.stderr
    assert rcyaml("deploy", "export", "robot.ddsl.yaml", "--as", "systemd").exit_code == 0
    write_tree(tmp_path, {"robot.ddsl.yaml": 'deployment: Robot\nx-rcmanager: {"a b": c}\n'})
    result = rcyaml("deploy", "export", "robot.ddsl.yaml", "--as", "rcmanager")
    assert result.exit_code == 0 and "RC4018" in result.stderr and "a_b" in result.stdout


@pytest.mark.skipif(shutil.which("systemd-analyze") is None, reason="systemd-analyze is not installed")
@pytest.mark.parametrize("cwd", ["/tmp/a\\", "/tmp/b ", "/tmp/%i"])
def test_systemd_accepts_odd_folders(tmp_path: Path, cwd: str) -> None:
    network = one("a\nb\x1b\u2028")
    network.processes["p"] = replace(network.processes["p"], cwd=cwd)
    files = export(network, "systemd")
    write_tree(tmp_path, files)
    units = [str(tmp_path / path) for path in files]
    done = subprocess.run(["systemd-analyze", "verify", *units], capture_output=True, text=True)
    assert "One" not in done.stderr, done.stderr
