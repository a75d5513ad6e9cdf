"""A plug-in of each kind, from its own wheel, through the command line: what it adds counts in the workspaces that name
it, and nowhere else."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from conftest import read_tree, write_tree
from plugins.wheels import ROOT, SAMPLES, Run, build, install
from processes import killed_on_failure
from robocomp_yaml.plugins import KINDS

pytestmark = pytest.mark.slow

SPEECH = {"rcyaml.yaml": "plugins: [acme-naming]\n", "speech.cdsl.yaml": "component: Speech\nlanguage: python\n"}
NETWORK = {
    "rcyaml.yaml": "plugins: [acme-tables]\n",
    "net.ddsl.yaml": "deployment: net\ncomponents:\n  ping: {program: /bin/sleep, args: [1 h]}\n",
}
CLOCK = {
    "rcyaml.yaml": "plugins: [acme-shell]\n",
    "clock.cdsl.yaml": "component: ClockComp\nlanguage: shell\nperiod: 50 ms\n",
}
POSE = {"rcyaml.yaml": "plugins: [acme-rosmsg]\n", "old/Pose.msg": "# Where it is.\nfloat64 x  # metres\nuint8 kind\n"}


PAGE = (ROOT / "docs" / "plugins.md").read_text(encoding="utf-8")
SHOWN = re.findall(r"^<!-- sample: (\S+) -->\n(`{3,})\w+\n(.*?)^\2$", PAGE, re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize(("path", "text"), [(path, text) for path, _, text in SHOWN])
def test_the_page_shows_what_is_tested(path: str, text: str) -> None:
    assert (SAMPLES / path).read_text(encoding="utf-8") == text


def test_the_page_shows_a_plugin_of_each_kind() -> None:
    shown = "".join(text for _, _, text in SHOWN)
    groups = {kind.group for kind in KINDS}
    assert {*re.findall(r'entry-points\."(rcyaml\.\w+)"', shown)} == groups
    assert {*re.findall(r"^\| `(rcyaml\.\w+)` \|", PAGE, re.MULTILINE)} == groups


def codes(done: subprocess.CompletedProcess[str]) -> list[str]:
    return [one["code"] for one in json.loads(done.stdout)["diagnostics"]]


def test_a_check_finds_something(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, SPEECH)
    done = rcyaml("check", "--format", "json")
    (found,) = json.loads(done.stdout)["diagnostics"]
    assert (found["code"], found["severity"], done.returncode) == ("ACME001", "warning", 0)
    assert (found["file"], found["line"], found["column"]) == ("speech.cdsl.yaml", 1, 12)
    assert found["message"] == "the name of component Speech does not follow Acme's rule"
    assert found["facts"] == {"meant": "SpeechComp", "name": "Speech"}
    assert found["fixes"] == [
        {
            "title": "write 'SpeechComp'", "safe": False,
            "edits": [{
                "file": "speech.cdsl.yaml", "line": 1, "column": 12, "end_line": 1, "end_column": 18,
                "text": "SpeechComp",
            }],
        }
    ]  # fmt: skip
    assert '"id": "ACME001"' in rcyaml("check", "--format", "sarif").stdout


def test_its_fixes_are_applied(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, SPEECH)
    assert rcyaml("check", "--unsafe-fixes").returncode == 0
    assert (tmp_path / "speech.cdsl.yaml").read_text() == "component: SpeechComp\nlanguage: python\n"


@pytest.mark.parametrize(("lint", "severity"), [("error", ["error"]), ("note", ["note"]), ("off", [])])
def test_its_severity_is_the_workspaces(rcyaml: Run, tmp_path: Path, lint: str, severity: list[str]) -> None:
    write_tree(tmp_path, {**SPEECH, "rcyaml.yaml": f"plugins: [acme-naming]\nlint: {{ACME001: {lint}}}\n"})
    done = rcyaml("check", "--format", "json")
    assert [one["severity"] for one in json.loads(done.stdout)["diagnostics"]] == severity
    assert done.returncode == (lint == "error")


def test_lint_knows_its_codes_and_no_others(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {**SPEECH, "rcyaml.yaml": "plugins: [acme-naming]\nlint: {ACME001: off, ACME002: off}\n"})
    assert "unknown code ACME002" in rcyaml("check").stdout


def test_a_comment_allows_it(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, SPEECH)
    (tmp_path / "speech.cdsl.yaml").write_text(
        "component: Speech  # rcyaml: allow ACME001 -- it was called so\nlanguage: python\n"
    )
    assert codes(rcyaml("check", "--format", "json")) == []
    (tmp_path / "speech.cdsl.yaml").write_text(
        "component: SpeechComp  # rcyaml: allow ACME001 -- it was called so\nlanguage: python\n"
    )
    assert codes(rcyaml("check", "--format", "json")) == ["RC0060"]


def test_it_can_fail_a_run(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, SPEECH)
    assert rcyaml("check", "--fail-on", "acme001").returncode == 1
    assert rcyaml("check", "--fail-on", "ACME002").returncode == 2


def test_it_is_explained_where_it_counts(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {f"here/{path}": text for path, text in SPEECH.items()} | {"elsewhere/rcyaml.yaml": ""})
    explained = rcyaml("explain", "acme001", below="here").stdout
    assert explained.startswith("ACME001 (warning): the name of component NAME does not follow")
    assert "Wrong:" in explained and "component: SpeechComp" in explained
    assert rcyaml("explain", below="here").stdout.splitlines()[-1].startswith("ACME001")
    assert "ACME001" not in rcyaml("explain", below="elsewhere").stdout
    elsewhere = rcyaml("explain", "ACME001", below="elsewhere")
    assert elsewhere.returncode == 2 and "in a workspace that names the plug-in" in elsewhere.stderr


@pytest.mark.parametrize("named", ["acme-naming", "acme_naming", "Acme.Naming"])
def test_it_is_named_as_installers_take_it(rcyaml: Run, tmp_path: Path, named: str) -> None:
    write_tree(tmp_path, {**SPEECH, "rcyaml.yaml": f"plugins: [{named}]\n"})
    assert codes(rcyaml("check", "--format", "json")) == ["ACME001"]


def test_it_speaks_of_no_other_workspace(rcyaml: Run, tmp_path: Path) -> None:
    """One run reads both."""
    there = {f"a/{path}": text for path, text in SPEECH.items()}
    write_tree(tmp_path, {**there, "b/rcyaml.yaml": "", "b/other.cdsl.yaml": "component: Other\nlanguage: python\n"})
    found = json.loads(rcyaml("check", "--format", "json").stdout)["diagnostics"]
    assert [(one["code"], one["file"]) for one in found] == [("ACME001", "a/speech.cdsl.yaml")]


def test_an_export_writes(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, NETWORK)
    assert rcyaml("deploy", "export", "--as", "csv", "-o", "out").returncode == 0
    table = (tmp_path / "out/net.csv").read_text()
    assert table == "process,host,command,after\nping,localhost,/bin/sleep '1 h',\n"
    assert rcyaml("deploy", "export", "--as", "csv").stdout == table
    assert "|csv]" in rcyaml("deploy", "export", "--help").stdout


def test_an_export_refuses_in_the_documents_words(rcyaml: Run, tmp_path: Path) -> None:
    text = "deployment: net\ncomponents:\n  ping: {program: /bin/sleep, env: {A: b}}\n"
    write_tree(tmp_path, {**NETWORK, "net.ddsl.yaml": text})
    done = rcyaml("deploy", "export", "--as", "csv")
    assert done.returncode == 1
    assert "a table cannot express an environment" in done.stderr and "net.ddsl.yaml:3" in done.stderr


def test_a_picture_is_drawn(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, NETWORK)
    assert rcyaml("graph", "--as", "outline").stdout == "# net\n- this machine\n  - ping\n"
    assert "outline" in rcyaml("graph", "--help").stdout


def test_choices_are_those_of_the_workspace_that_is_meant(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {f"net/{path}": text for path, text in NETWORK.items()} | {"other/rcyaml.yaml": ""})
    assert rcyaml("deploy", "export", "--as", "csv", "../net", below="other").returncode == 0
    refused = rcyaml("deploy", "export", "--as", "csv", below="other")
    assert refused.returncode == 2 and "'csv' is not one of" in refused.stderr
    assert "csv" not in rcyaml("deploy", "export", "--help", below="other").stdout


def test_a_language_compiles(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, CLOCK)
    done = rcyaml("compile")
    assert done.returncode == 0, done.stdout
    tree = read_tree(tmp_path)
    assert "sleep 0.05" in tree["bin/ClockComp"] and "compute()" in tree["src/compute.sh"]
    assert {"etc/config", "slice/CommonBehavior.ice"} <= {*tree}
    with killed_on_failure(
        subprocess.Popen([tmp_path / "bin/ClockComp"], stdout=subprocess.PIPE, text=True)
    ) as process:
        assert process.stdout is not None
        assert [process.stdout.readline() for _ in range(2)] == ["ClockComp\n", "ClockComp\n"]
        process.terminate()
    assert process.returncode == 0
    assert "0 files written" in rcyaml("compile").stdout
    assert "0 files written" in rcyaml("compile", "--target", "shell").stdout


def test_a_language_is_in_schemas_and_choices(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {f"here/{path}": text for path, text in CLOCK.items()} | {"other/rcyaml.yaml": ""})
    rcyaml("compile", below="here")
    installed = (tmp_path / "here/.rcyaml/schemas/cdsl.schema.json").read_text()
    assert '"shell"' in installed and '"shell"' in rcyaml("schema", "cdsl", below="here").stdout
    assert '"shell"' not in rcyaml("schema", "cdsl", below="other").stdout
    assert "outdated" not in rcyaml("schema", "clock.cdsl.yaml", below="here").stdout
    assert "|shell]" in rcyaml("new", "component", "--help", below="here").stdout
    assert "shell" in rcyaml("compile", "--help", below="here").stdout
    assert "shell" not in rcyaml("compile", "--help", below="other").stdout
    assert rcyaml("new", "component", "TickComp", "--language", "shell", below="here").returncode == 0
    assert rcyaml("check", below="here").returncode == 0


def test_a_language_has_what_its_record_says(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, CLOCK)
    (tmp_path / "clock.cdsl.yaml").write_text("component: ClockComp\nlanguage: shell\nrequires: [Speech]\n")
    assert "RC2060" in codes(rcyaml("check", "--format", "json"))


def test_a_language_is_refused_where_it_is_not_named(rcyaml: Run, tmp_path: Path) -> None:
    """Also where the same run knows it from another workspace."""
    write_tree(tmp_path, {f"{folder}/{path}": text for folder in "ab" for path, text in CLOCK.items()})
    (tmp_path / "b/rcyaml.yaml").write_text("")
    found = json.loads(rcyaml("check", "--format", "json").stdout)["diagnostics"]
    assert [(one["code"], one["file"]) for one in found] == [("RC0204", "b/clock.cdsl.yaml")]
    rcyaml("compile")
    assert '"shell"' in (tmp_path / "a/.rcyaml/schemas/cdsl.schema.json").read_text()
    assert '"shell"' not in (tmp_path / "b/.rcyaml/schemas/cdsl.schema.json").read_text()


def test_a_legacy_format_migrates(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, POSE)
    done = rcyaml("migrate", "old", "--report", "report.json")
    assert done.returncode == 0, done.stdout
    assert re.search(r"^ROS message +1 +0 +0 +0 +0$", done.stdout, re.MULTILINE)
    text = (tmp_path / "old/Pose.idsl.yaml").read_text()
    assert "# Where it is." in text and "x: double  # metres" in text
    assert rcyaml("check").returncode == 0
    assert "is it is" not in rcyaml("migrate", "old").stdout


def test_a_legacy_format_refuses_in_its_own_words(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {**POSE, "old/Scan.msg": "float32[] ranges\nuint64 stamp\n"})
    done = rcyaml("migrate", "old")
    assert done.returncode == 1
    assert "an array has no name in a ROS message" in done.stdout and "Scan.msg:1:8" in done.stdout
    assert "no type for uint64" in done.stdout
    (tmp_path / "rcyaml.yaml").write_text("")
    assert "Pose.msg" not in rcyaml("migrate", "old", "--dry-run", "-o", "again").stdout


def test_without_plugins_none_counts(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {**SPEECH, "rcyaml.yaml": ""})
    assert codes(rcyaml("check", "--format", "json")) == []


def test_another_build_compiles_again(tmp_path: Path, site: Path, rcyaml: Run) -> None:
    """Of the same version: what its installer recorded tells it apart."""
    write_tree(tmp_path, CLOCK)
    rcyaml("compile")
    assert "0 files written" in rcyaml("compile").stdout
    sources = Path(shutil.copytree(SAMPLES / "shell", tmp_path / ".sources"))
    main = sources / "acme_shell/templates/main.sh.j2"
    main.write_text(main.read_text().replace("trap 'exit 0'", "trap 'exit 3'"))
    (tmp_path / ".wheels").mkdir()
    install(build(sources, tmp_path / ".wheels"), site)
    assert "updated  bin/ClockComp" in rcyaml("compile").stdout
    assert "exit 3" in (tmp_path / "bin/ClockComp").read_text()
    assert "0 files written" in rcyaml("compile").stdout


def test_what_changes_in_place_compiles_again(tmp_path: Path, site: Path, rcyaml: Run) -> None:
    """As in an editable install."""
    write_tree(tmp_path, CLOCK)
    rcyaml("compile")
    main = site / "acme_shell/templates/main.sh.j2"
    main.write_text(main.read_text().replace("sleep", "exec sleep"))
    assert "exec sleep" not in (tmp_path / "bin/ClockComp").read_text()
    assert "1 file written" in rcyaml("compile").stdout
    assert "exec sleep" in (tmp_path / "bin/ClockComp").read_text()


def test_what_was_told_is_told_again(tmp_path: Path, rcyaml: Run) -> None:
    """A compile with nothing to do reads no document, and knows the words of plug-ins all the same."""
    write_tree(tmp_path, SPEECH)
    first = rcyaml("compile").stdout
    again = rcyaml("compile")
    assert "0 files written" in again.stdout and again.returncode == 0
    told = "warning[ACME001]: the name of component Speech does not follow Acme's rule"
    assert told in first and told in again.stdout
