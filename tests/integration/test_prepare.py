"""What `make demo` and `make test` install first, and what they print; apt and sudo are replaced by scripts."""

from __future__ import annotations

import ast
import importlib.util
import re
import shlex
import subprocess
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

from conftest import ROOT

NOISE = "WARNING: Running pip as the 'root' user\nWARNING: Location 'file:///no/where' is ignored\n"
RECORD = 'echo "${0##*/} $*" >> "$LOG"\n'


class Machine:
    """A machine with only the programs of a test."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder / "bin"
        self.folder.mkdir()
        self.log = folder / "log"
        for name in ("env", "sh"):
            (self.folder / name).symlink_to(f"/usr/bin/{name}")

    def has(self, name: str, script: str = "") -> None:
        (self.folder / name).write_text(f"#!/bin/sh\n{RECORD}{script}\n")
        (self.folder / name).chmod(0o755)

    @property
    def called(self) -> list[str]:
        return self.log.read_text().splitlines() if self.log.exists() else []


@pytest.fixture
def machine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Machine:
    """A Debian on which nothing is installed."""
    made = Machine(tmp_path)
    made.has("dpkg-query", "exit 1")
    made.has("apt-get", "echo Unpacking lots of things; echo $DEBIAN_FRONTEND >> $LOG")
    monkeypatch.setenv("PATH", str(made.folder))
    monkeypatch.setenv("LOG", str(made.log))
    return made


@pytest.fixture
def prepare(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """tools/prepare.py, run by root, for an environment in another folder."""
    spec = importlib.util.spec_from_file_location("prepare", ROOT / "tools" / "prepare.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    monkeypatch.setattr(module, "ENVIRONMENT", tmp_path / "venv")
    monkeypatch.setattr(module, "PYTHON", tmp_path / "venv" / "bin" / "python")
    monkeypatch.setattr(module, "has_ice", lambda: False)
    monkeypatch.setattr(module.os, "geteuid", lambda: 0)
    return module


def test_root_installs_them(prepare: ModuleType, machine: Machine, capsys: pytest.CaptureFixture[str]) -> None:
    prepare.main("system", "demo", "python3-zeroc-ice", "cowsay")
    words = shlex.join(prepare.APT)
    assert [line for line in machine.called if not line.startswith("dpkg")] == [
        f"apt-get {words} update", "noninteractive",
        f"apt-get {words} install -y --no-install-recommends python3-zeroc-ice cowsay", "noninteractive",
    ]  # fmt: skip
    output = capsys.readouterr().out
    assert output.startswith("make demo needs packages of Debian, and installs them: python3-zeroc-ice cowsay\n")
    assert "installing 2 packages, which takes about half a minute ...\n  done after " in output
    assert "Unpacking" not in output, "what apt says is of interest where it fails"


def test_installed_packages_are_not_requested(
    prepare: ModuleType, machine: Machine, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Node and Ice may come from elsewhere."""
    machine.has("dpkg-query", '[ "$4" = cmake ] && printf "install ok installed"')
    machine.has("node")
    monkeypatch.setattr(prepare, "has_ice", lambda: True)
    prepare.main("system", "test", "cmake", "nodejs", "python3-zeroc-ice")
    assert not any(line.startswith("apt-get") for line in machine.called) and not capsys.readouterr().out


def test_the_output_of_apt_is_shown_if_it_fails(prepare: ModuleType, machine: Machine) -> None:
    machine.has("apt-get", 'case "$*" in *install*) echo E: Unable to locate package cowsay; exit 100;; esac')
    with pytest.raises(prepare.Failed) as failed:
        prepare.main("system", "demo", "cowsay")
    output = str(failed.value)
    assert output.startswith("E: Unable to locate package cowsay\n\ninstalling cowsay failed, see above: env apt-get ")


@pytest.mark.parametrize("sudo", [True, False], ids=["may", "may not"])
@pytest.mark.parametrize("goal", ["demo", "test"])
def test_others_install_them_by_sudo_without_password(
    prepare: ModuleType, machine: Machine, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str],
    sudo: bool, goal: str,
) -> None:  # fmt: skip
    monkeypatch.setattr(prepare.os, "geteuid", lambda: 1000)
    machine.has("sudo", 'shift; "$@"' if sudo else "echo sudo: a password is required >&2; exit 1")
    prepare.main("system", goal, "cowsay")
    output = capsys.readouterr()
    assert not output.err
    if sudo:
        assert machine.called[-2].endswith(" install -y --no-install-recommends cowsay")
        assert machine.called[-1] == "noninteractive"
    else:
        assert not any(line.startswith("apt-get") for line in machine.called)
        skipped = "some tests will be skipped; to run them all: sudo apt install cowsay\n"
        assert output.out == (skipped if goal == "test" else ""), "the demo says it where it ends"


def test_no_debian_and_no_sudo(
    prepare: ModuleType, machine: Machine, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in ("apt-get", "dpkg-query"):
        (machine.folder / name).unlink()
    prepare.main("system", "demo", "cowsay")
    monkeypatch.setattr(prepare.os, "geteuid", lambda: 1000)
    prepare.main("system", "demo", "cowsay")
    assert not capsys.readouterr().out


@pytest.fixture
def pip(prepare: ModuleType) -> Callable[[int], None]:
    """An environment whose Python prints many lines instead of running pip, and exits with this code."""

    def make(code: int) -> None:
        prepare.PYTHON.parent.mkdir(parents=True)
        noise = f'case "$*" in *install*) printf "{NOISE}Collecting lark\\nERROR: no lark\\n" >&2; exit {code};; esac'
        prepare.PYTHON.write_text(f"#!/bin/sh\n{noise}\n")
        prepare.PYTHON.chmod(0o755)

    return make


def test_the_output_of_pip_is_hidden_if_it_succeeds(
    prepare: ModuleType, pip: Callable[[int], None], capsys: pytest.CaptureFixture[str]
) -> None:
    pip(0)
    prepare.main("environment", "test")
    output = capsys.readouterr()
    assert not output.err and re.fullmatch(
        r"installing rcyaml and what its tests need into \S+venv \.\.\.\n  done after \d+ s\n", output.out
    )


def test_the_output_of_pip_is_shown_if_it_fails(prepare: ModuleType, pip: Callable[[int], None]) -> None:
    pip(1)
    with pytest.raises(prepare.Failed) as failed:
        prepare.main("environment")
    assert str(failed.value).startswith(f"{NOISE}Collecting lark\nERROR: no lark\n\ninstalling rcyaml into ")


def test_a_python_that_is_too_old(prepare: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(prepare, "OLDEST", (9, 9))
    with pytest.raises(prepare.Failed, match=r"rcyaml needs Python 9.9 or later, and \S+ is 3\.\d+: make PYTHON=/path"):
        prepare.main("environment")


def test_without_rights_two_ways_are_printed(
    prepare: ModuleType, machine: Machine, capsys: pytest.CaptureFixture[str]
) -> None:
    machine.has("g++")
    prepare.main("advise")
    output = capsys.readouterr().out
    assert "\n  sudo apt install python3-zeroc-ice\n" in output and "\n  make ice demo\n" in output
    assert "some ten minutes" in output and "headers" not in output
    machine.has("g++", "exit 1")
    prepare.main("advise")
    assert "needs g++ and the headers of Python, OpenSSL and bzip2, some of which are missing (g++ python3-dev" in (
        capsys.readouterr().out
    )
    with pytest.raises(prepare.Failed, match="installs these:\n  sudo apt install g\\+\\+ python3-dev"):
        prepare.main("ice")


def test_compiling_shows_progress(
    prepare: ModuleType, machine: Machine, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    machine.has("g++")
    prepare.PYTHON.parent.mkdir(parents=True)
    prepare.PYTHON.write_text(
        "#!/bin/sh\ncase $* in *Ice*) exit 1;; esac\necho '  x86_64-linux-gnu-g++ -O2 -c a.cpp -o a.o'\n"
        "echo '  gcc -O2 -c b.c -o b.o'\nread line < /dev/null; /bin/sleep 0.1\n"
    )
    prepare.PYTHON.chmod(0o755)
    notes: list[str] = []
    note = property(lambda self: "", lambda self, note: notes.append(note))
    monkeypatch.setattr(prepare.Progress, "note", note, raising=False)
    prepare.main("ice")
    assert [note for note in notes if note] == ["1 of about 250 files", "2 of about 250 files"]
    assert "Compiling Ice for this Python takes some ten minutes.\n" in capsys.readouterr().out


def test_on_a_terminal_one_line_is_updated(
    prepare: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(prepare.sys.stdout, "isatty", lambda: True, raising=False)
    prepare.call(["/bin/sh", "-c", "echo one; sleep 0.5"], "counting", str.strip)
    output = capsys.readouterr().out
    assert "\rcounting ... 0 s  one\x1b[K" in output and re.search(r"\r\x1b\[Kcounting: done after \d s\n$", output)


def test_help_lists_the_goals() -> None:
    help_ = subprocess.run(["make", "-C", ROOT, "--no-print-directory", "help"], capture_output=True, text=True).stdout
    named = set(re.findall(r"^make ([\w-]+) ", help_, re.MULTILINE))
    text = (ROOT / "Makefile").read_text(encoding="utf-8")
    (phony,) = re.findall(r"^\.PHONY: (.*)", text, re.MULTILINE)
    assert named == {goal for goal in phony.split() if not goal.startswith("system")} - {"help"}
    pages = (ROOT / name for name in ("README.md", "CONTRIBUTING.md", "examples/demo.py", "tools/prepare.py"))
    command = re.compile(r"^ *(?:\w+=\S+ )*make ((?:[a-z-]+ ?)+)(?:$| *#)", re.MULTILINE)
    goals = {goal for page in pages for goal in command.findall(page.read_text(encoding="utf-8"))}
    assert {word for goal in goals for word in goal.split()} <= named


RUNTIME = "robocomp_yaml/languages/python/templates/runtime"


def test_it_parses_with_old_pythons() -> None:
    """An older Python must parse it, to print that it is too old."""
    for path in ("tools/prepare.py", f"{RUNTIME}/interpreter.py", f"{RUNTIME}/main.py"):
        ast.parse((ROOT / path).read_text(encoding="utf-8"), feature_version=(3, 7))


def test_a_machine_without_hosts_gets_localhost(
    prepare: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(prepare, "knows_localhost", lambda: False)
    monkeypatch.setattr(prepare, "rights", lambda: ["env"])
    prepare.name_this_machine(tmp_path / "hosts")
    assert (tmp_path / "hosts").read_text() == "127.0.0.1 localhost\n"
    with pytest.raises(prepare.Failed, match="adds this line"):
        prepare.name_this_machine(tmp_path / "hosts")  # nobody's file is changed
