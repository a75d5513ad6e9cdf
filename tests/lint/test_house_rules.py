"""The rules of the house: the size of modules, what is imported when, docstrings."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

from conftest import ROOT

# What is copied into components has rules of its own: it runs without rcyaml, and with an older Python.
MODULES = sorted(path for path in (ROOT / "robocomp_yaml").rglob("*.py") if "templates" not in path.parts)
HEAVY = {"jinja2", "jsonschema_rs", "jsonschema", "networkx", "lark", "ruamel", "cerberus", "hypothesis"}


def named(path: Path) -> str:
    return str(path.relative_to(ROOT))


@pytest.mark.parametrize("path", MODULES, ids=named)
def test_a_module_is_small_and_says_its_subject(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert text.count("\n") <= 400
    assert ast.get_docstring(ast.parse(text)), "a module starts with a docstring"


def test_modules_of_tests_have_names_of_their_own() -> None:
    """pytest imports them by these."""
    names = Counter(path.name for path in (ROOT / "tests").rglob("test_*.py"))
    assert [name for name, count in names.items() if count > 1] == []


def test_paths_are_texts() -> None:
    """One dialect: `os.path`, which tells what a link leads to from what its path says."""
    for path in MODULES:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            assert "pathlib" not in names, f"{named(path)}:{node.lineno}: use os.path"


SPEAKING = {
    *("click.echo", "click.secho", "click.style", "click.echo_via_pager", "click.confirm", "print"),
    *("sys.stdout.write", "sys.stderr.write", "sys.stdout.buffer.write", "sys.stderr.buffer.write"),
}
ASKING = {"click.prompt", "click.progressbar"}


def test_text_meets_a_terminal_in_one_place() -> None:
    """Elsewhere nothing is printed, whoever would have to escape it; what click asks or draws is a text of ours."""
    for path in MODULES:
        if named(path) == "robocomp_yaml/diag/terminal.py":
            continue
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Attribute | ast.Name):
                assert ast.unparse(node) not in SPEAKING, f"{named(path)}:{node.lineno}: use diag.terminal"
            if isinstance(node, ast.Call) and ast.unparse(node.func) in ASKING:
                words = [*node.args, *(k.value for k in node.keywords if k.arg in ("label", "text", "default"))]
                for word in words:
                    is_ours = isinstance(word, ast.Constant | ast.Name)
                    assert is_ours, f"{named(path)}:{node.lineno}: what is asked is a text of ours"


def test_nothing_is_kept_by_the_address_of_an_object() -> None:
    """Another object has it as soon as the first is gone. What has no name of its own gets a number."""
    for path in MODULES:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call):
                assert ast.unparse(node.func) != "id", f"{named(path)}:{node.lineno}: `id()`"


# What these read is the project's own, has been looked at, or was named by the user.
READING_OTHERWISE = {"legacy/settings/corrections.py", "link/options.py"}


def test_only_what_has_an_end_is_opened() -> None:
    """A pipe in somebody's folder, or a link to /dev/zero, would be waited for."""
    for layer in ("source", "transactions", "parameters", "link", "network", "check", "emit", "legacy"):
        for path in sorted((ROOT / "robocomp_yaml" / layer).rglob("*.py")):
            if str(path.relative_to(ROOT / "robocomp_yaml")) in READING_OTHERWISE:
                continue
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.Call):
                    assert is_bounded(node), f"{named(path)}:{node.lineno}: use source.regular as the opener"


def is_bounded(call: ast.Call) -> bool:
    what = ast.unparse(call.func)
    if what != "open":
        return not what.endswith((".read_text", ".read_bytes")) or what == "text.read_bytes"
    mode = ast.unparse(call.args[1]) if len(call.args) > 1 else "'r'"
    return bool(set(mode) & set("wax")) or any(keyword.arg == "opener" for keyword in call.keywords)


def test_help_imports_nothing_heavy() -> None:
    script = (
        "import sys\nfrom robocomp_yaml.cli import group\n"
        "try: group(['--help'])\nexcept SystemExit: pass\n"
        "print(*sys.modules, file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert not HEAVY & {name.partition(".")[0] for name in done.stderr.split()}


def test_networkx_is_not_imported_by_a_check(tmp_path: Path) -> None:
    (tmp_path / "Speech.idsl.yaml").write_text("module: RoboCompSpeech\n", encoding="utf-8")
    script = (
        "import sys\nfrom robocomp_yaml.cli import group\n"
        "try: group(['check'])\nexcept SystemExit: pass\n"
        "print(*sys.modules, file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, cwd=tmp_path, check=True)
    assert not {"networkx", "jinja2", "lark", "difflib"} & set(done.stderr.split())


def test_units_have_no_random_examples() -> None:
    """`-m unit` leaves out Hypothesis, and with it the settings by which all runs have the same examples."""
    for path in (ROOT / "tests" / "unit").rglob("*.py"):
        assert "hypothesis" not in path.read_text(encoding="utf-8"), f"{named(path)}: tests/properties is for that"
