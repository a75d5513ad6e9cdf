"""Plug-ins that are not there, not what they should be, or fail: told at the name in rcyaml.yaml, never a traceback."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest

from conftest import write_tree
from plugins.wheels import Run

COMPONENT = {"clock.cdsl.yaml": "component: ClockComp\nlanguage: python\n"}
NETWORK = {"net.ddsl.yaml": "deployment: net\ncomponents:\n  ping: {program: /bin/sleep}\n"}
CHECK = "KIND = 'cdsl'\ndef check(program):\n    return []\n"
PAGE = """
from robocomp_yaml.api.plugins import Family
ODD = Family('''
## {code}

*warning*

```message
{name} is odd
```

Odd.

Wrong:

Right:
''').code('{code}')
KIND = 'cdsl'
def check(program):
    for one in program.components.values():
        yield ODD.at(one.component.span, name=one.component.name)
"""


@pytest.fixture
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("site")


def installed(site: Path, name: str, entries: dict[str, str], files: dict[str, str]) -> None:
    """A distribution as an installer leaves it; `entries` are modules by `GROUP/NAME`."""
    groups: dict[str, list[str]] = {}
    for path, module in entries.items():
        group, _, entry = path.partition("/")
        groups.setdefault(group, []).append(f"{entry} = {module}\n")
    text = "".join(f"[rcyaml.{group}]\n{''.join(lines)}" for group, lines in groups.items())
    folder = f"{name.replace('-', '_')}-1.0.dist-info"
    metadata = f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n"
    write_tree(site, {f"{folder}/METADATA": metadata, f"{folder}/entry_points.txt": text, **files})


def workspace(folder: Path, *plugins: str, **files: str) -> None:
    write_tree(folder, {"rcyaml.yaml": f"plugins: [{', '.join(plugins)}]\n", **COMPONENT, **files})


def found(done: subprocess.CompletedProcess[str]) -> dict[str, dict[str, object]]:
    return {one["code"]: one for one in json.loads(done.stdout)["diagnostics"]}


@pytest.mark.parametrize(
    ("entry", "text", "reason"),
    [
        ("checks/a", "import nowhere_at_all\n", "ModuleNotFoundError: No module named 'nowhere_at_all'"),
        ("checks/a", "1 / 0\n", "ZeroDivisionError: division by zero"),
        ("checks/a", "def check(:\n", "SyntaxError: invalid syntax (mod.py, line 1)"),
        ("checks/a", "raise SystemExit(3)\n", "SystemExit: 3"),
        ("checks/a", "KIND = 'cdsl'\n", "mod has no check"),
        ("checks/a", "KIND = 'cdsl'\ncheck = 1\n", "check is not a function"),
        ("checks/a", "KIND = 'yaml'\ndef check(program): ...\n", "KIND is 'yaml', which is not one of"),
        ("exports/a", "", "mod has no export"),
        ("exports/A b", "def export(network): ...\n", "its name has characters other than"),
        ("graphs/a", "draw = None\n", "draw is not a function"),
        ("formats/a", "RULES = ''\n", "mod has no convert"),
        ("languages/a", "LANGUAGE = 'a'\n", "LANGUAGE is not a TargetLanguage"),
        ("checks/a", PAGE.replace("{code}", "odd1"), "'odd1' is not a code"),
        ("checks/a", PAGE.replace("code('{code}')", "code('ODD002')").replace("{code}", "ODD001"), "ODD002"),
    ],
)
def test_a_broken_one_is_told(rcyaml: Run, site: Path, tmp_path: Path, entry: str, text: str, reason: str) -> None:
    installed(site, "acme-broken", {entry: "mod"}, {"mod.py": text})
    workspace(tmp_path, "acme-broken")
    done = rcyaml("check", "--format", "json")
    told = found(done)
    assert [*told] == ["RC0081"] and done.returncode == 1
    assert reason in str(told["RC0081"]["message"])
    assert (told["RC0081"]["file"], told["RC0081"]["column"]) == ("rcyaml.yaml", 11)


def test_an_entry_point_that_is_no_module(rcyaml: Run, site: Path, tmp_path: Path) -> None:
    installed(site, "acme-broken", {"checks/a": "mod:check"}, {"mod.py": CHECK})
    workspace(tmp_path, "acme-broken")
    assert "does not name a module" in rcyaml("check").stdout


def test_the_rest_of_a_broken_one_counts(rcyaml: Run, site: Path, tmp_path: Path) -> None:
    odd = PAGE.replace("{code}", "ODD001")
    installed(site, "acme", {"checks/a": "good", "checks/b": "bad"}, {"good.py": odd, "bad.py": "1 / 0\n"})
    workspace(tmp_path, "acme")
    assert {*found(rcyaml("check", "--format", "json"))} == {"RC0081", "ODD001"}


@pytest.mark.parametrize(
    ("entry", "text", "what"),
    [
        ("exports/systemd", "def export(network): ...\n", "export 'systemd'"),
        ("graphs/dot", "def draw(picture): ...\n", "picture 'dot'"),
        ("formats/idsl", "RULES = ''\ndef convert(reader): ...\n", "legacy format 'idsl'"),
        ("checks/a", PAGE.replace("{code}", "RC2003"), "diagnostic RC2003"),
        ("checks/a", PAGE.replace("{code}", "RC9999"), "diagnostic RC9999"),
    ],
)
def test_what_is_built_in_is_not_replaced(
    rcyaml: Run, site: Path, tmp_path: Path, entry: str, text: str, what: str
) -> None:  # fmt: skip
    installed(site, "acme", {entry: "mod"}, {"mod.py": text})
    workspace(tmp_path, "acme")
    message = found(rcyaml("check", "--format", "json"))["RC0082"]["message"]
    assert message == f"plug-in 'acme' has the {what}, and so has rcyaml"


@pytest.mark.parametrize("language", ["python", "slice", "docs"])
def test_the_name_of_a_language_that_is_taken(rcyaml: Run, site: Path, tmp_path: Path, language: str) -> None:
    record = f"name='{language}', title='x', package=__name__, description='x', has=frozenset()"
    text = f"from robocomp_yaml.api.plugins import TargetLanguage\nLANGUAGE = TargetLanguage({record})\n"
    installed(site, "acme", {f"languages/{language}": "mod"}, {"mod.py": text})
    workspace(tmp_path, "acme")
    assert [*found(rcyaml("check", "--format", "json"))] == ["RC0082"]


def test_two_that_have_the_same(rcyaml: Run, site: Path, tmp_path: Path) -> None:
    """The code of a diagnostic, and the name of an export; each of the two alone is fine."""
    for name in ("one", "two"):
        page = PAGE.replace("{code}", "ODD001").replace("is odd", f"is odd, says {name}")
        files = {f"{name}_c.py": page, f"{name}_e.py": "def export(network):\n    return {}\n"}
        installed(site, name, {"checks/a": f"{name}_c", "exports/table": f"{name}_e"}, files)
    for name in ("one", "two"):
        workspace(tmp_path, name)
        (only,) = found(rcyaml("check", "--format", "json")).values()
        assert only["message"] == f"ClockComp is odd, says {name}"
    workspace(tmp_path, "one", "two")
    told = json.loads(rcyaml("check", "--format", "json").stdout)["diagnostics"]
    assert [one["message"] for one in told if one["code"] == "RC0082"] == [
        "plug-in 'two' has the diagnostic ODD001, and so has plug-in 'one'",
        "plug-in 'two' has the export 'table', and so has plug-in 'one'",
    ]


def test_one_that_is_not_installed(rcyaml: Run, site: Path, tmp_path: Path) -> None:
    installed(site, "acme-naming", {"checks/names": "mod"}, {"mod.py": CHECK})
    workspace(tmp_path, "acme-namign", "names", "wholly-unlike")
    done = rcyaml("check", "--format", "json")
    hints = [one["hint"] for one in json.loads(done.stdout)["diagnostics"]]
    assert hints[0] == "did you mean 'acme-naming'?"
    assert hints[1] == "did you mean 'acme-naming'?"  # which has a check of that name
    assert hints[2].startswith("`pip install wholly-unlike` installs it")
    assert done.returncode == 1
    (edit,) = json.loads(done.stdout)["diagnostics"][0]["fixes"][0]["edits"]
    assert (edit["file"], edit["column"], edit["text"]) == ("rcyaml.yaml", 11, "acme-naming")


def test_one_that_is_none(rcyaml: Run, tmp_path: Path) -> None:
    workspace(tmp_path, "jinja2")
    assert "'jinja2' is installed, and is not a plug-in of rcyaml" in rcyaml("check").stdout


@pytest.mark.parametrize("text", ["plugins: acme", "plugins: {acme: 1}", "plugins: [../acme]", "plugins: [a, a]"])
def test_the_shape_of_the_setting(rcyaml: Run, tmp_path: Path, text: str) -> None:
    write_tree(tmp_path, {**COMPONENT, "rcyaml.yaml": f"{text}\n"})
    assert [*found(rcyaml("check", "--format", "json"))] == ["RC0204"]


def test_what_a_missing_one_would_know_is_not_told_again(rcyaml: Run, tmp_path: Path) -> None:
    """Its language, its codes in `lint:` and in comments; and the schema of the repository stays as it is."""
    schema = {".rcyaml/schemas/cdsl.schema.json": "{}"}
    workspace(tmp_path, "acme", **schema)
    (tmp_path / "rcyaml.yaml").write_text("plugins: [acme]\nlint: {ACME001: off}\n")
    (tmp_path / "clock.cdsl.yaml").write_text(
        "# rcyaml: allow ACME001 -- for now\ncomponent: ClockComp\nlanguage: shell\n"
    )
    assert [*found(rcyaml("check", "--format", "json"))] == ["RC0080"]
    assert rcyaml("compile").returncode == 1
    assert (tmp_path / ".rcyaml/schemas/cdsl.schema.json").read_text() == "{}"
    for command in (("schema", "cdsl"), ("explain", "ACME001"), ("new", "component", "A", "--language", "shell")):
        done = rcyaml(*command)
        assert done.returncode == 1 and "RC0080" in done.stderr, command


def test_installing_it_makes_a_stamp_stale(rcyaml: Run, site: Path, tmp_path: Path) -> None:
    workspace(tmp_path, "acme")
    assert rcyaml("compile").returncode == 1
    installed(site, "acme", {"checks/a": "mod"}, {"mod.py": CHECK})
    assert rcyaml("compile").returncode == 0


@pytest.mark.parametrize(
    ("fails", "reason"),
    [("raise KeyError('no such thing')", "KeyError: 'no such thing'"), ("raise SystemExit(3)", "SystemExit: 3")],
)
def test_a_check_that_fails_is_told_with_the_rest(
    rcyaml: Run, site: Path, tmp_path: Path, fails: str, reason: str
) -> None:
    """What it found before, what others find, and where it failed."""
    text = PAGE.replace("{code}", "ODD001") + f"    {fails}\n"
    installed(site, "acme", {"checks/a": "mod"}, {"mod.py": text})
    workspace(tmp_path, "acme", **{"other.idsl.yaml": "module: M\nimports: [Nowhere]\n"})
    told = found(rcyaml("check", "--format", "json"))
    assert {*told} == {"RC0083", "ODD001", "RC1101"}
    assert told["RC0083"]["message"] == f"plug-in 'acme' failed: check 'a': {reason}"
    assert f"mod.py:{len(text.splitlines())}" in str(told["RC0083"]["hint"])


@pytest.mark.parametrize("answer", ["None", "[1]", "'text'", "1"])
def test_a_check_that_gives_no_diagnostics(rcyaml: Run, site: Path, tmp_path: Path, answer: str) -> None:
    installed(site, "acme", {"checks/a": "mod"}, {"mod.py": CHECK.replace("[]", answer)})
    workspace(tmp_path, "acme")
    assert [*found(rcyaml("check", "--format", "json"))] == ["RC0083"]


@pytest.mark.parametrize(
    "answer",
    [
        "network.nothing", "None", "{'a': 1}", "{'/etc/x': ''}", "{'../x': ''}", "{'b/': ''}",
        "{'a/b.txt': '', 'a': ''}", "{'a': '', './a/b/../b/c.txt': ''}", "{'b': '', 'a/../b': ''}",
        r"{'b': '', 'a\0': ''}", r"{'b': '', 'a': '\ud800'}",
    ],
)  # fmt: skip
def test_an_export_that_fails(rcyaml: Run, site: Path, tmp_path: Path, answer: str) -> None:
    installed(site, "acme", {"exports/odd": "mod"}, {"mod.py": f"def export(network):\n    return {answer}\n"})
    workspace(tmp_path, "acme", **NETWORK)
    done = rcyaml("deploy", "export", "--as", "odd", "-o", "out")
    assert done.returncode == 1 and "RC0083" in done.stderr
    assert "plug-in 'acme' failed: export 'odd'" in done.stderr
    assert not (tmp_path / "out").exists()


def test_a_picture_that_fails(rcyaml: Run, site: Path, tmp_path: Path) -> None:
    installed(site, "acme", {"graphs/odd": "mod"}, {"mod.py": "def draw(picture):\n    return picture\n"})
    workspace(tmp_path, "acme", **NETWORK)
    done = rcyaml("graph", "--as", "odd")
    assert done.returncode == 1 and "it returns no text" in done.stderr


@pytest.mark.parametrize(
    "plan", ["", "def plan(linked):\n    return [linked.nothing]\n", "def plan(linked):\n    1 / 0\n"]
)
def test_a_language_that_fails(rcyaml: Run, site: Path, tmp_path: Path, plan: str) -> None:
    record = "name='odd', title='Odd', package=__name__, description='odd', has=frozenset()"
    text = f"from robocomp_yaml.api.plugins import TargetLanguage\nLANGUAGE = TargetLanguage({record})\n"
    installed(site, "acme", {"languages/odd": "odd"}, {"odd/__init__.py": text, "odd/plan.py": plan})
    workspace(tmp_path, "acme", **{"clock.cdsl.yaml": "component: ClockComp\nlanguage: odd\n"})
    assert rcyaml("check").returncode == 0
    done = rcyaml("compile")
    assert done.returncode == 1 and "plug-in 'acme' failed: language 'odd'" in done.stderr
    assert not (tmp_path / "bin").exists()


@pytest.mark.parametrize(
    "text",
    [
        "RULES = 'title: ['\ndef convert(reader): ...\n",
        "RULES = '{extends: idsl, suffixes: [.odd], signature: (}'\ndef convert(reader): ...\n",
        "RULES = '{extends: idsl, suffixes: [.odd], signature: odd}'\nGRAMMAR = 'start: nowhere'\n"
        "def convert(reader): ...\n",
        "RULES = '{extends: idsl, suffixes: [.odd], signature: odd}'\n"
        "GRAMMAR = 'start: /odd/'\ndef convert(reader):\n    return reader.nothing\n",
    ],
)
def test_a_legacy_format_that_fails(rcyaml: Run, site: Path, tmp_path: Path, text: str) -> None:
    installed(site, "acme", {"formats/odd": "mod"}, {"mod.py": text})
    workspace(tmp_path, "acme", **{"old/a.odd": "odd"})
    done = rcyaml("migrate", "old")
    assert done.returncode == 1 and "plug-in 'acme' failed: legacy format 'odd'" in done.stderr
    assert not [*tmp_path.glob("old/*.yaml")]


def test_what_failed_is_tried_again(rcyaml: Run, site: Path, tmp_path: Path) -> None:
    """It may have failed of something that no stamp remembers."""
    text = CHECK.replace("    return []", "    open('needed')\n    return []")
    installed(site, "acme", {"checks/a": "mod"}, {"mod.py": text})
    workspace(tmp_path, "acme")
    assert rcyaml("compile").returncode == 1
    (tmp_path / "needed").touch()
    assert rcyaml("compile").returncode == 0


def test_elsewhere_it_does_not_matter(rcyaml: Run, site: Path, tmp_path: Path) -> None:
    """What is installed and not named is not even imported."""
    installed(site, "acme", {"checks/a": "mod"}, {"mod.py": "open('imported', 'w')\n"})
    write_tree(tmp_path, {**COMPONENT, "rcyaml.yaml": ""})
    for command in ("check", "compile", "explain", "schema"):
        assert rcyaml(command).returncode == 0
    assert not (tmp_path / "imported").exists()
