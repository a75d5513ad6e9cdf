"""The Python that runs a component: real interpreters and virtual environments, some with a module Ice."""

from __future__ import annotations

import ast
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from robocomp_yaml.languages import language

RULE = language("python").text("runtime/interpreter.py")
PROGRAM = """\
#!/usr/bin/env python3
import os, sys
ROOT = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))
sys.path[:0] = [ROOT, ROOT + "/src"]
import interpreter
try:
    interpreter.settle(ROOT, sys.argv)
except interpreter.NoPython as error:
    sys.exit(f"Arm: {error}")
import Ice
print(sys.executable, *sys.argv[1:], *(name for name in os.environ if name.startswith("_RCYAML")))
"""
ICE = "def intVersion(): return 30710\ndef stringVersion(): return '3.7.10'\n"
FOR_ANOTHER = "import IcePy\n"


class Place:
    """A workspace with the component `arm`; `path` is the first folder of PATH."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.root = folder / "ws" / "arm"
        self.path = folder / "front" / "bin"
        self.debian = folder / "debian" / "bin" / "python3"
        (self.root / "bin").mkdir(parents=True)
        (folder / "ws" / "rcyaml.yaml").touch()
        (self.root / "interpreter.py").write_text(RULE.replace('"/usr/bin/python3"', repr(str(self.debian))))
        self.program = self.root / "bin" / "Arm"
        self.program.write_text(PROGRAM)
        self.program.chmod(0o755)
        self.python(folder / "front")

    def python(self, home: Path, ice: str = "") -> Path:
        """A virtual environment as of `python -m venv`, made in less time; `ice` is its module."""
        (home / "bin").mkdir(parents=True)
        base = os.path.realpath(sys.executable)
        (home / "pyvenv.cfg").write_text(f"home = {os.path.dirname(base)}\ninclude-system-site-packages = false\n")
        for name in ("python", "python3"):
            (home / "bin" / name).symlink_to(base)
        library = home / "lib" / "python{}.{}".format(*sys.version_info[:2]) / "site-packages"
        library.mkdir(parents=True)
        if ice:
            (library / "Ice.py").write_text(ice)
        return home / "bin" / "python"

    def start(self, *arguments: str, by: Path | None = None, **variables: str) -> subprocess.CompletedProcess[str]:
        command = [*([by] if by else []), self.program, *arguments]
        environment = {"PATH": f"{self.path}:{os.environ['PATH']}", "HOME": str(self.folder), **variables}
        return subprocess.run(command, env=environment, cwd=self.folder, capture_output=True, text=True, timeout=60)

    def runs_in(self, **variables: str) -> Path:
        """The folder of the Python that runs the component."""
        done = self.start(**variables)
        assert done.returncode == 0 and not done.stderr, done.stderr
        return Path(done.stdout.strip()).parent.parent


@pytest.fixture
def place(tmp_path: Path) -> Place:
    return Place(tmp_path)


def test_the_order(place: Place, tmp_path: Path) -> None:
    place.python(place.debian.parent.parent, ICE)
    assert place.runs_in() == tmp_path / "debian"
    shutil.rmtree(tmp_path / "front")
    place.python(tmp_path / "front", ICE)
    assert place.runs_in() == tmp_path / "front"
    place.python(tmp_path / "ws" / ".venv", ICE)
    assert place.runs_in() == tmp_path / "ws" / ".venv"
    own = place.python(tmp_path / "own", ICE)
    assert place.runs_in(RCYAML_PYTHON=str(own)) == tmp_path / "own"
    assert place.runs_in(RCYAML_PYTHON="~/own/bin/python") == tmp_path / "own"
    assert place.runs_in(RCYAML_PYTHON="own/bin/python3") == tmp_path / "own"
    assert place.runs_in(RCYAML_PYTHON="") == tmp_path / "ws" / ".venv"
    (tmp_path / "own" / "bin" / "python-of-arm").symlink_to("python")
    assert place.runs_in(RCYAML_PYTHON="python-of-arm", PATH=f"{place.path}:{own.parent}:/usr/bin:/bin").name == "own"


def test_only_arguments_are_passed_on(place: Place, tmp_path: Path) -> None:
    place.python(tmp_path / "ws" / ".venv")
    python = place.python(place.debian.parent.parent, ICE).with_name("python3")
    done = place.start("etc/config", "--Text= a\n b", "")
    assert done.stdout == f"{python} etc/config --Text= a\n b \n"


@pytest.mark.parametrize("name", ["ws", "elsewhere and é"])
def test_the_workspace_may_have_moved(place: Place, tmp_path: Path, name: str) -> None:
    place.python(tmp_path / "ws" / ".venv", ICE)
    (tmp_path / "ws").rename(tmp_path / name)
    place.program = tmp_path / name / "arm" / "bin" / "Arm"
    assert place.runs_in() == tmp_path / name / ".venv"


def test_nested_workspaces(place: Place, tmp_path: Path) -> None:
    (tmp_path / "rcyaml.yaml").touch()
    place.python(tmp_path / ".venv", ICE)
    assert place.runs_in() == tmp_path / ".venv", "the inner one has none"
    place.python(tmp_path / "ws" / ".venv", ICE)
    assert place.runs_in() == tmp_path / "ws" / ".venv"
    (tmp_path / "ws" / "rcyaml.yaml").unlink()
    assert place.runs_in() == tmp_path / ".venv", "no workspace's"


def test_a_link_to_the_program(place: Place, tmp_path: Path) -> None:
    place.python(tmp_path / "ws" / ".venv", ICE)
    (tmp_path / "far").mkdir()
    (tmp_path / "far" / "start-arm").symlink_to(place.program)
    place.program = tmp_path / "far" / "start-arm"
    assert place.runs_in() == tmp_path / "ws" / ".venv"


def test_an_environment_that_sees_the_systems_modules(place: Place, tmp_path: Path) -> None:
    """Of the same Python: it is identified by its folder, because its program is a link to the same file."""
    with_ice = place.python(place.debian.parent.parent, ICE)
    environment = place.python(tmp_path / "ws" / ".venv")
    library = next((tmp_path / "ws" / ".venv" / "lib").glob("*/site-packages"))
    (library / "system.pth").write_text(f"{next((with_ice.parent.parent / 'lib').glob('*/site-packages'))}\n")
    assert place.runs_in() == environment.parent.parent


@pytest.mark.parametrize(
    ("script", "ice"),
    [
        ('exec "{python}" "$@"', ""),  # as pyenv's
        ('exec "{python}" -S "$@"', ICE),
        ('"{python}" "$@"; exit $?', ""),
    ],
)
def test_a_wrapper_script(place: Place, tmp_path: Path, script: str, ice: str) -> None:
    place.python(place.debian.parent.parent, ICE)
    python = place.python(tmp_path / "shimmed", ice).with_name("python3")
    (place.path / "python3").unlink()
    (place.path / "python3").write_text(f"#!/bin/sh\n{script.format(python=python)}\n")
    (place.path / "python3").chmod(0o755)
    assert place.runs_in() == tmp_path / "debian"


def test_the_calling_python_is_preferred(place: Place, tmp_path: Path) -> None:
    called = place.python(tmp_path / "called", ICE)
    place.python(place.debian.parent.parent, ICE)
    assert place.start(by=called).stdout.strip() == str(called)
    place.python(tmp_path / "ws" / ".venv", ICE)
    assert place.start(by=called).stdout.strip() == str(tmp_path / "ws/.venv/bin/python")


def test_all_rejected_pythons_are_named(place: Place, tmp_path: Path) -> None:
    place.python(tmp_path / "ws" / ".venv", FOR_ANOTHER)
    place.debian.parent.mkdir(parents=True)
    place.debian.write_text("")
    done = place.start()
    assert done.returncode == 1 and not done.stdout
    environment = tmp_path / "ws/.venv/bin/python"
    assert (
        done.stderr
        == f"""\
Arm: no Python on this machine has Ice 3.7, which the component needs
  {environment} (the workspace's) has an Ice that was compiled for another Python (No module named 'IcePy')
  {place.path}/python3 (python3 on the path) has no Ice
  {place.debian} (Debian's) is not executable
Install it for Debian's Python: sudo apt install python3-zeroc-ice
Without root privileges, compile it, which takes minutes: {environment} -m pip install 'zeroc-ice>=3.7.8,<3.8'
If another Python has it: RCYAML_PYTHON=/path/to/python
"""
    )


def test_without_an_environment_the_hint_creates_one(place: Place, tmp_path: Path) -> None:
    said = place.start().stderr
    environment = tmp_path / "ws" / ".venv"
    assert f"  {environment}/bin/python (the workspace's) does not exist\n" in said
    assert f"takes minutes: python3 -m venv {environment} && {environment}/bin/python -m pip install 'zero" in said


@pytest.mark.parametrize(
    ("ice", "why"),
    [
        ("def intVersion(): return 30800\ndef stringVersion(): return '3.8.0'\n", "has Ice 3.8.0, not 3.7"),
        ("import no_such\n", "has an Ice that was compiled for another Python (No module named 'no_such')"),
        ("raise ImportError('libIce.so.37: cannot open')\n", "cannot load its Ice (libIce.so.37: cannot open)"),
        ("syntax error\n", "cannot load its Ice (invalid syntax (Ice.py, line 1))"),
        ("raise SystemError('broken')\n", "cannot load its Ice (broken)"),
        ("cold = True\n", "has another module named Ice ("),
    ],
)
def test_an_ice_that_is_not_accepted(place: Place, tmp_path: Path, ice: str, why: str) -> None:
    place.python(tmp_path / "ws" / ".venv", ice)
    assert f"/.venv/bin/python (the workspace's) {why}" in place.start().stderr
    place.python(place.debian.parent.parent, ICE)
    assert place.runs_in() == tmp_path / "debian"


def test_a_folder_of_the_component_is_not_ice(place: Place) -> None:
    (place.root / "src" / "Ice").mkdir(parents=True)
    assert "(python3 on the path) has another module named Ice (a folder)" in place.start().stderr


def broken(place: Place, how: str) -> str:
    """The path of a Python that cannot be used."""
    path = place.folder / "broken"
    if how == "a link":
        path.symlink_to("/no/such/python")
    elif how == "a folder":
        place.python(path)
    elif how != "nothing":
        path.write_text(how)
        path.chmod(0o644 if how == "not executable" else 0o755)
    return str(path)


BROKEN = {
    "nothing": "does not exist",
    "a link": "is a link to /no/such/python, which does not exist",
    "a folder": "is a folder (did you mean {path}/bin/python?)",
    "not executable": "is not executable",
    "#!/no/such/interpreter\n": "cannot be started (No such file or directory)",
    "\x7fELF nonsense": "cannot be started (Exec format error)",
    "#!/bin/sh\n": "does not work as Python (exit code 0)",
    "#!/bin/sh\necho oh >&2; exit 3\n": "does not work as Python (oh)",
    "#!/bin/sh\necho Python 3 8\n": "is Python 3.8, older than 3.9",
}


@pytest.mark.parametrize("how", BROKEN, ids=range(len(BROKEN)))
def test_a_configured_python_that_cannot_be_used_is_an_error(place: Place, tmp_path: Path, how: str) -> None:
    """It is never skipped, even if others can be used."""
    place.python(tmp_path / "ws" / ".venv", ICE)
    path = broken(place, how)
    done = place.start(RCYAML_PYTHON=path)
    assert done.returncode == 1 and not done.stdout
    assert done.stderr == (
        f"Arm: RCYAML_PYTHON names {path}, which {BROKEN[how].format(path=path)}: "
        "set it to a Python that has Ice 3.7, or unset it\n"
    )


def test_a_configured_python_without_ice_is_an_error(place: Place, tmp_path: Path) -> None:
    place.python(tmp_path / "ws" / ".venv", ICE)
    without = place.python(tmp_path / "without")
    for given, named in ((str(without), without), ("no-such-python", "no-such-python")):
        done = place.start(RCYAML_PYTHON=given)
        why = "has no Ice" if named == without else "is not on the path"
        assert done.returncode == 1 and done.stderr.startswith(f"Arm: RCYAML_PYTHON names {named}, which {why}: set it")


@pytest.mark.parametrize("how", BROKEN, ids=range(len(BROKEN)))
def test_a_detected_python_that_cannot_be_used_is_skipped(place: Place, tmp_path: Path, how: str) -> None:
    path = broken(place, how)
    (tmp_path / "ws" / ".venv" / "bin").mkdir(parents=True)
    (tmp_path / "ws" / ".venv" / "bin" / "python").symlink_to(path)
    said = place.start().stderr
    if "link" not in how and how != "nothing":
        assert f"(the workspace's) {BROKEN[how].partition(' (did')[0]}" in said
    place.python(place.debian.parent.parent, ICE)
    assert place.runs_in() == tmp_path / "debian"


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can make files of another user")
def test_an_environment_of_another_user_is_not_run(place: Place, tmp_path: Path) -> None:
    """A workspace may be in a folder that all users can write."""
    place.python(tmp_path / "ws" / ".venv", ICE)
    os.chown(tmp_path / "ws" / ".venv", 12345, -1)
    assert "(the workspace's) belongs to another user" in place.start().stderr
    os.chown(place.root, 12345, -1)
    assert place.runs_in() == tmp_path / "ws" / ".venv", "whose component it is, too"


def test_a_variable_of_another_user_is_ignored(place: Place, tmp_path: Path) -> None:
    place.python(tmp_path / "ws" / ".venv", ICE)
    for text in ("", "[", "1", "[[], 1]", "[[], [[1]]]", "null"):
        assert place.runs_in(_RCYAML_PYTHONS=text) == tmp_path / "ws" / ".venv"


def test_no_python_is_started_without_need(place: Place, tmp_path: Path) -> None:
    """The Python with Ice is started by the first one; if it is the first one itself, it continues."""
    environment = place.python(tmp_path / "ws" / ".venv", ICE)
    starts = tmp_path / "starts"
    note = f"print(sys.executable, file=open({str(starts)!r}, 'a'))"
    text = PROGRAM.replace("import os, sys\n", f"import os, sys\n{note}\n")
    place.program.write_text(text)
    place.runs_in()
    assert starts.read_text().splitlines() == [f"{place.path}/python3", str(environment)]
    starts.unlink()
    place.program.write_text(text.replace("#!/usr/bin/env python3", f"#!{environment}"))
    place.runs_in()
    assert starts.read_text().splitlines() == [str(environment)]


LAUNCHER = (
    PROGRAM.partition("import interpreter")[0]
    + """\
from generated.runtime.main import main
main()
"""
)


def old_python(place: Place) -> None:
    """The first Python of PATH reports version 3.6; the launcher and its run time are generated."""
    site = next((place.path.parent / "lib").glob("*/site-packages"))
    (site / "old.pth").write_text("import sys; sys.version_info = (3, 6, 9, 'final', 0)\n")
    place.program.write_text(LAUNCHER)
    runtime = place.root / "generated" / "runtime"
    runtime.mkdir(parents=True)
    (place.root / "interpreter.py").rename(runtime / "interpreter.py")
    (runtime / "__init__.py").write_text(language("python").text("runtime/__init__.py"))
    (runtime / "main.py").write_text("import sys\ndef main():\n    print(sys.executable, *sys.argv[1:])\n")


def test_a_python_that_cannot_read_the_run_time_starts_another(place: Place) -> None:
    python = place.python(place.debian.parent.parent, ICE).with_name("python3")
    old_python(place)
    assert place.start("etc/config", "--x= a").stdout == f"{python} etc/config --x= a\n"


def test_the_required_version_is_reported(place: Place) -> None:
    old_python(place)
    done = place.start()
    assert done.returncode == 1 and "Traceback" not in done.stderr
    assert "Arm: no Python on this machine has Ice 3.7" in done.stderr
    assert "(python3 on the path) is Python 3.6, older than 3.9\n" in done.stderr


@pytest.mark.parametrize("name", ["__init__.py", "interpreter.py"])
def test_the_launcher_has_the_syntax_of_old_pythons(name: str) -> None:
    text = language("python").text(f"runtime/{name}")
    tree = ast.parse(text, feature_version=(3, 5))
    assert not [node for node in ast.walk(tree) if isinstance(node, ast.JoinedStr | ast.AnnAssign | ast.NamedExpr)]
    hints = [node.annotation for node in ast.walk(tree) if isinstance(node, ast.arg)]
    hints += [node.returns for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    assert all(isinstance(hint, ast.Name | ast.Constant) for hint in hints), "evaluated when it is read"
